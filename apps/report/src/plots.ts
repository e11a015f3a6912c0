// Plots: figures over frames, times of passes, memory.
import * as Plot from "@observablehq/plot";
import { median, type Report } from "./data";
import { graphSeconds } from "./table";
import { find, make, millisecondsText } from "./text";

// Observable's ten, which are told apart on light and dark; gray is for what was not denoised.
const palette = ["#4269d0", "#ff725c", "#3ca951", "#a463f2", "#efb118", "#6cc5b0", "#ff8ab7", "#97bbf5", "#9c6b4e"];
const gray = "#9498a0";

interface Point {
  frame: number;
  value: number;
  name: string;
}

export function names(report: Report): { name: string; color: string }[] {
  const list = Object.keys(report.noisy).map((name) => ({ name: `noisy (${name})`, color: gray }));
  report.graphs.forEach((graph) => {
    const outputs = Object.keys(graph.figures);
    for (const output of outputs)
      list.push({ name: outputs.length > 1 ? `${graph.label}: ${output}` : graph.label, color: "" });
  });
  let next = 0;
  for (const entry of list) entry.color ||= palette[next++ % palette.length]!;
  return list;
}

/** NaN where there is no figure, or an infinite one (psnr of equal images), which no axis holds: the table tells it. */
function points(report: Report, metric: number): Point[] {
  const found: Point[] = [];
  const add = (name: string, frames: ((number | null)[] | null)[]) =>
    frames.forEach((figures, index) => {
      const value = figures?.[metric] ?? NaN;
      found.push({ frame: report.frames[index]!, value: Number.isFinite(value) ? value : NaN, name });
    });
  for (const [name, figures] of Object.entries(report.noisy)) add(`noisy (${name})`, figures.frames);
  for (const graph of report.graphs) {
    const outputs = Object.entries(graph.figures);
    for (const [output, figures] of outputs) add(outputs.length > 1 ? `${graph.label}: ${output}` : graph.label, figures.frames);
  }
  return found;
}

/** Draws again when the width changes, so that texts keep their size. */
function drawWide(place: HTMLElement, label: string, draw: (width: number) => SVGElement | HTMLElement) {
  let last = 0;
  const redraw = () => {
    const width = Math.floor(place.clientWidth);
    if (!width || width === last) return;
    last = width;
    const plot = draw(width);
    plot.setAttribute("role", "img");
    plot.setAttribute("aria-label", label);
    place.replaceChildren(plot);
  };
  new ResizeObserver(redraw).observe(place);
  redraw();
}

export function showPlots(report: Report) {
  const body = find("plots-body");
  if (!report.metrics) {
    body.append(make("p", {}, "There is no reference, and so there is nothing to plot."));
    return;
  }
  const series = names(report);
  const legend = make("ul", { class: "legend" });
  for (const { name, color } of series) {
    const chip = make("span", { class: "chip" });
    chip.style.background = color;
    legend.append(make("li", {}, chip, name));
  }
  body.append(legend);
  const grid = make("div", { class: "grid" });
  body.append(grid);
  report.metrics.forEach((metric, index) => {
    const all = points(report, index);
    const data = all.filter(({ value }) => !Number.isNaN(value));
    if (data.length === 0) return;
    const place = make("div", { class: "plot" });
    const head = make("h3", { title: metric.summary }, metric.name, make("small", {}, ` ${metric.unit ? metric.unit + ", " : ""}${metric.name === "warped" ? "near 0" : metric.higher ? "higher" : "lower"} is better`));
    grid.append(make("figure", {}, head, place));
    drawWide(place, `${metric.name} over frames: ${series.map(({ name }) => name).join(", ")}`, (width) =>
      Plot.plot({
        width,
        height: 200,
        marginLeft: 48,
        x: { label: "frame", tickFormat: "d", ticks: Math.min(report.frames.length, Math.floor(width / 60)) },
        y: { label: null, grid: true, nice: true },
        color: { domain: series.map(({ name }) => name), range: series.map(({ color }) => color) },
        marks: [
          Plot.lineY(all, { x: "frame", y: "value", z: "name", stroke: "name", strokeWidth: 2 }),
          Plot.dot(data, { x: "frame", y: "value", fill: "name", r: 2.5 }),
          Plot.tip(data, Plot.pointer({ x: "frame", y: "value", stroke: "name", title: (d: Point) => `${d.name}\nframe ${d.frame}\n${d.value.toPrecision(5)}` })),
        ],
      }),
    );
  });
}

interface Bar {
  node: string;
  pass: string;
  ms: number;
}

export function showTimes(report: Report) {
  const body = find("times-body");
  const { threads, processor } = report.provenance;
  const frames = Math.max(0, ...report.graphs.flatMap((graph) => graph.nodes.map((node) => node.seconds.length))); // that did not fail
  body.append(
    make("p", {}, `What each node takes of a frame: the median of ${frames} frame${frames === 1 ? "" : "s"}, one node after the other, each on ${threads} thread${threads === 1 ? "" : "s"}${processor ? " of " + processor : ""}.`),
  );
  const bars = report.graphs.map((graph) => graph.nodes.map((node): Bar => ({ node: node.name, pass: node.pass, ms: 1000 * median(node.seconds) })));
  const grid = make("div", { class: "grid" });
  body.append(grid);
  report.graphs.forEach((graph, index) => {
    const data = bars[index]!;
    const place = make("div", { class: "plot" });
    grid.append(make("figure", {}, make("h3", {}, graph.label, make("small", {}, ` ${millisecondsText(graphSeconds(report, index))} a frame`)), place));
    const longest = Math.max(...data.map((bar) => bar.node.length));
    drawWide(place, `time of each node of ${graph.label}: ${data.map((bar) => `${bar.node} ${bar.ms.toFixed(2)} ms`).join(", ")}`, (width) =>
      Plot.plot({
        width,
        height: 40 + 22 * data.length,
        marginLeft: Math.min(width * 0.45, 14 + 6.4 * longest),
        marginRight: 44,
        x: { label: "ms a frame", domain: [0, Math.max(...data.map((bar) => bar.ms), 1e-6)], grid: true, ticks: Math.max(2, Math.floor(width / 110)) },
        y: { label: null, domain: data.map((bar) => bar.node) },
        marks: [
          Plot.barX(data, { x: "ms", y: "node", fill: palette[index % palette.length]!, title: (d: Bar) => `${d.node} (${d.pass}): ${d.ms.toFixed(3)} ms` }),
          Plot.text(data, { x: "ms", y: "node", text: (d: Bar) => d.ms.toFixed(2), dx: 4, textAnchor: "start" }),
          Plot.ruleX([0]),
        ],
      }),
    );
  });
  showMemory(report, body);
}

function showMemory(report: Report, body: HTMLElement) {
  const data = report.graphs.flatMap((graph) => [
    { graph: graph.label, what: "images of a frame", mib: graph.memory.frame / 1048576 },
    { graph: graph.label, what: "history", mib: graph.memory.history / 1048576 },
  ]);
  const place = make("div", { class: "plot" });
  const colors = { "images of a frame": palette[5]!, history: palette[4]! };
  const legend = make("ul", { class: "legend" });
  for (const [name, color] of Object.entries(colors)) {
    const chip = make("span", { class: "chip" });
    chip.style.background = color;
    legend.append(make("li", {}, chip, name));
  }
  body.append(make("figure", { class: "memory" }, make("h3", {}, "memory", make("small", {}, " as planned for one frame")), legend, place));
  const longest = Math.max(...report.graphs.map((graph) => graph.label.length));
  drawWide(place, `memory: ${data.map((bar) => `${bar.graph}, ${bar.what}, ${bar.mib.toFixed(1)} MiB`).join("; ")}`, (width) =>
    Plot.plot({
      width,
      height: 44 + 26 * report.graphs.length,
      marginLeft: Math.min(width * 0.45, 14 + 6.4 * longest),
      x: { label: "MiB", grid: true, ticks: Math.max(2, Math.floor(width / 110)) },
      y: { label: null, domain: report.graphs.map((graph) => graph.label) },
      color: { domain: Object.keys(colors), range: Object.values(colors) },
      marks: [Plot.barX(data, { x: "mib", y: "graph", fill: "what", title: (d: (typeof data)[0]) => `${d.what}: ${d.mib.toFixed(2)} MiB` }), Plot.ruleX([0])],
    }),
  );
}
