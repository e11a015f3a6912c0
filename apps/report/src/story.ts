// What became of a pixel, pass by pass.
import { type Graph, type GraphNode, type ImageSeries, type NodeOutput, title } from "./data";
import { imageOf, readInputs } from "./node_inputs";
import type { Pictures } from "./pictures";
import type { Pixels } from "./pixels";
import { displayCurve } from "./shade";
import { pictureSize, samePlace, type Store } from "./state";
import { findTaps, meanOf } from "./taps";
import { find, make, valueText } from "./text";
import { describeWeights, type Weights } from "./weights";

interface Value {
  image: ImageSeries;
  values: number[];
}

export class Story {
  private graph = 0;
  private turn = 0;
  constructor(
    private readonly store: Store,
    private readonly pictures: Pictures,
  ) {
    store.listen((state, before) => {
      const graph = [state.left, state.right].map((index) => store.report.images[index]?.graph);
      if (state.left !== before.left && graph[0] !== undefined) this.graph = graph[0];
      else if (state.right !== before.right && graph[1] !== undefined) this.graph = graph[1];
      if (state.pixel !== before.pixel || state.frame !== before.frame || state.left !== before.left || state.right !== before.right)
        void this.show();
    });
    this.graph = store.report.images[store.state.right]?.graph ?? 0;
    void this.show();
  }

  private get frame() {
    const { inner } = this.store.report;
    const { frame } = this.store.state;
    return inner.includes(frame) ? frame : inner.at(-1);
  }

  private async value(image: ImageSeries | undefined, frame: number): Promise<Value | null> {
    const number = image?.frames[frame];
    const pixel = this.store.state.pixel;
    if (!image || number === undefined || !pixel) return null;
    const pixels = await this.pictures.store.get(number);
    const [x, y] = this.place(pixel, pixels);
    return { image, values: pixels.all(x, y) };
  }
  /** The same place in an image of another size. */
  private place(pixel: [number, number], pixels: Pixels): [number, number] {
    return samePlace(pixel, pictureSize(this.store.report, this.store.state), pixels);
  }

  private showing: Promise<void> = Promise.resolve();
  /** When what was asked for last is shown. */
  async ready(): Promise<void> {
    for (let last; last !== this.showing; ) {
      last = this.showing;
      await last;
    }
  }
  private show(): Promise<void> {
    return (this.showing = this.showNow());
  }
  private async showNow() {
    const turn = ++this.turn;
    const { report, state } = this.store;
    const body = find("story-body");
    const graph = report.graphs[this.graph];
    const frame = this.frame;
    if (!graph) return;
    if (frame === undefined) {
      body.replaceChildren(make("p", {}, "This report has no inner images; quell report keeps those of one frame without --inner none."));
      return;
    }
    if (!state.pixel) {
      body.replaceChildren(make("p", {}, "Click a pixel of the picture above, or choose one with the arrow keys, to see what each pass made of it."));
      return;
    }
    const rows = await this.rows(graph, frame);
    if (turn !== this.turn) return;
    const head = make("tr", {}, ...["Pass", "Yields", "Value"].map((text) => make("th", { scope: "col" }, text)), make("th", { scope: "col" }, make("span", { class: "hidden" }, "Color")));
    const table = make("table", { class: "story" }, make("thead", {}, head), make("tbody", {}, ...rows));
    body.replaceChildren(this.choice(frame), make("div", { class: "scroll" }, table));
  }

  private choice(frame: number): HTMLElement {
    const { report, state } = this.store;
    const select = make("select", { id: "story-graph" });
    report.graphs.forEach((graph, index) => select.append(make("option", { value: String(index) }, graph.label)));
    select.value = String(this.graph);
    select.addEventListener("change", () => {
      this.graph = Number(select.value);
      void this.show().then(() => find("story-graph").focus());
    });
    const [x, y] = state.pixel!;
    const where = make("p", {}, `Pixel x ${x}, y ${y} of frame ${frame}, in `, make("label", { class: "hidden", for: "story-graph" }, "graph"), select);
    if (frame !== state.frame) where.append(` (inner images are of ${report.inner.length > 1 ? "other frames" : "this frame alone"})`);
    return where;
  }

  private async rows(graph: Graph, frame: number): Promise<HTMLElement[]> {
    const { report } = this.store;
    const used = new Set(graph.nodes.flatMap((node) => node.inputs.map((input) => input.from)));
    const inputs = report.images.filter((image) => (image.kind === "noisy" || image.kind === "input") && used.has(image.name));
    const entries: { first: HTMLElement; port: string; image: ImageSeries | undefined; isLength?: boolean; node?: GraphNode }[] = [];
    for (const image of inputs) entries.push({ first: make("th", { scope: "row" }, "input"), port: image.name, image });
    for (const node of graph.nodes)
      for (const output of node.outputs) {
        const isLength = output.type === "scalar" && /length/.test(output.port);
        const first = make("th", { scope: "row", title: node.doc || node.summary });
        first.append(make("b", {}, node.name), " ", make("small", {}, node.pass));
        entries.push({ first, port: isLength ? `${output.port} (frames of history)` : this.portText(node, output), image: imageOf(report, this.graph, output), isLength, node });
      }
    const reference = report.images.find((image) => image.kind === "reference");
    entries.push({ first: make("th", { scope: "row" }, "reference"), port: "", image: reference });
    const values = await Promise.all(entries.map(({ image }) => this.value(image, frame)));
    const weights = new Map<GraphNode, HTMLElement>();
    await Promise.all(
      graph.nodes.map(async (node) => {
        const row = await this.weightsRow(node, frame);
        if (row) weights.set(node, row);
      }),
    );
    return entries.flatMap(({ first, port, isLength, node }, index) => {
      const value = values[index];
      if (!value) return [];
      if (node && node === entries[index - 1]?.node) first.classList.add("again");
      const row = make("tr", isLength ? { class: "length" } : {}, first, make("td", {}, port), ...this.cells(value));
      const more = node && node !== entries[index + 1]?.node ? weights.get(node) : undefined;
      return more ? [row, more] : [row];
    });
  }

  /** The weights at a pixel of what a filter yields, and what the pass made there; or why there are none. Null: nothing to tell. */
  private async weights(node: GraphNode, frame: number, pixel?: [number, number]): Promise<Weights | string | null> {
    const mean = meanOf(node);
    if (!mean) return null;
    if ("why" in mean) return mean.why;
    const { report } = this.store;
    const output = node.outputs.find((other) => other.port === mean.output);
    const number = output && imageOf(report, this.graph, output)?.frames[frame];
    const inputs = await readInputs(report, this.pictures.store, this.graph, node, frame);
    if (typeof inputs === "string") return inputs;
    if (number === undefined) return `'${node.name}.${mean.output}' of frame ${frame} is not in this report`;
    const image = await this.pictures.store.get(number);
    const at = pixel ?? this.place(this.store.state.pixel!, image);
    const taps = findTaps(node, inputs, at, image);
    return typeof taps === "string" ? taps : { ...taps, given: image.all(...at) };
  }
  private async weightsRow(node: GraphNode, frame: number): Promise<HTMLElement | null> {
    const found = await this.weights(node, frame);
    if (!found) return null;
    const row = (...what: (Node | string)[]) =>
      make("tr", { class: "weights" }, make("th", { scope: "row", class: "again" }, make("b", {}, node.name)), make("td", { colspan: "3" }, ...what));
    if (typeof found === "string") return row(make("small", {}, `no weights: ${found}`));
    const details = make("details", {}, make("summary", {}, `weights of ${found.taps.length} tap${found.taps.length === 1 ? "" : "s"}`));
    details.addEventListener("toggle", () => details.open && details.children.length === 1 && details.append(describeWeights(found)));
    return row(details);
  }
  /** For tests: of a node by its name. */
  async weightsOf(graph: number, name: string, x: number, y: number) {
    this.graph = graph;
    const node = this.store.report.graphs[graph]!.nodes.find((other) => other.name === name)!;
    return this.weights(node, this.frame!, [x, y]);
  }
  private portText(node: GraphNode, output: NodeOutput): string {
    const port = output.name.slice(node.name.length + 1); // "history[1]" of a port of several images
    return output.result ? `${port} → output ${output.result}` : port;
  }
  private cells({ image, values }: Value): HTMLElement[] {
    const numbers = make("td", { class: "number" }, make("code", {}, values.map(valueText).join("  ")));
    const mark = make("td");
    if (values.length === 3 && (image.type === "color" || image.type === "albedo")) {
      const curve = displayCurve(image.type === "color" ? (this.store.report.display ?? "reinhard") : "srgb", image.type === "color" ? this.store.state.exposure : 0);
      const [r, g, b] = values.map((value) => Math.round(255 * (curve(value) || 0)));
      const swatch = make("span", { class: "swatch", title: title(this.store.report, image) });
      swatch.style.background = `rgb(${r} ${g} ${b})`;
      mark.append(swatch);
    }
    return [numbers, mark];
  }
}
