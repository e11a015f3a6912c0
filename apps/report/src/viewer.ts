// The images: two at a time, with one zoom and place for both.
import { type ImageSeries, type Report, title } from "./data";
import type { Picture, Pictures } from "./pictures";
import { numbered, type Mode, type State, type Store } from "./state";
import { find, make, valueText } from "./text";
import { View } from "./view";

const kHandle = 22; // CSS pixels beside the line of the wipe that still take hold of it
const kValues = 44; // CSS pixels a pixel from which on values are written into it

interface Shown {
  left: Picture | null;
  right: Picture | null;
}

export class Viewer {
  private readonly canvas = find<HTMLCanvasElement>("canvas");
  private readonly context = this.canvas.getContext("2d")!;
  private readonly view = new View();
  private readonly report: Report;
  private shown: Shown = { left: null, right: null };
  private hover: [number, number] | null = null;
  private drawing = 0;
  private loading = 0;
  private playing = false;
  private timer = 0;
  private turns = 0; // of playing

  constructor(
    private readonly store: Store,
    private readonly pictures: Pictures,
  ) {
    this.report = store.report;
    this.fillControls();
    this.listenToControls();
    this.listenToPointers();
    this.listenToKeys();
    store.listen((state, before) => this.update(state, before));
    new ResizeObserver(() => this.resize()).observe(this.canvas.parentElement!);
    this.update(store.state, store.state);
  }

  // --- what is there to choose ---

  private fillControls() {
    const groups: [string, (image: ImageSeries) => boolean][] = [
      ["Sequence", (image) => image.kind === "noisy" || image.kind === "reference"],
      ["Results", (image) => image.kind === "result"],
      ...this.report.graphs.map((graph, index): [string, (image: ImageSeries) => boolean] => [
        `Inner images of ${graph.label}`,
        (image) => image.kind === "inner" && image.graph === index,
      ]),
      ["Other inputs", (image) => image.kind === "input"],
    ];
    for (const id of ["left", "right"]) {
      const select = find<HTMLSelectElement>(id);
      for (const [label, isIn] of groups) {
        const group = make("optgroup", { label });
        this.report.images.forEach((image, index) => {
          if (isIn(image)) group.append(make("option", { value: String(index) }, title(this.report, image)));
        });
        if (group.children.length) select.append(group);
      }
    }
    numbered(this.report).forEach((index, place) => {
      const button = make("button", { type: "button", "data-image": String(index) }, make("kbd", {}, String(place + 1)));
      button.append(" " + title(this.report, this.report.images[index]!));
      button.addEventListener("click", (event) => this.choose(event.shiftKey ? "right" : "left", index));
      find("numbers").append(make("li", {}, button));
    });
    const frame = find<HTMLInputElement>("frame");
    frame.max = String(this.report.kept.length - 1);
    frame.disabled = find<HTMLButtonElement>("play").disabled = this.report.kept.length < 2;
    if (!this.reference) {
      const errors = document.querySelector<HTMLInputElement>("#modes input[value=errors]")!;
      errors.disabled = true;
      errors.parentElement!.title = "There is no reference.";
    }
  }

  private get reference() {
    return this.report.images.find((image) => image.kind === "reference");
  }
  private choose(side: "left" | "right", index: number) {
    const image = this.report.images[index];
    if (!image) return;
    const frames = Object.keys(image.frames).map(Number).filter((frame) => this.report.kept.includes(frame));
    const frame = image.frames[this.store.state.frame] === undefined ? frames.at(-1) : this.store.state.frame;
    this.store.set({ [side]: index, ...(frame === undefined ? {} : { frame }) });
  }
  private setMode(mode: Mode) {
    if (!document.querySelector<HTMLInputElement>(`#modes input[value=${mode}]`)!.disabled) this.store.set({ mode });
  }
  private step(by: number, around = false) {
    const { kept } = this.report;
    const at = kept.indexOf(this.store.state.frame) + by;
    const next = around ? (at + kept.length) % kept.length : Math.max(0, Math.min(kept.length - 1, at));
    this.store.set({ frame: kept[next]! });
  }
  private setExposure(exposure: number) {
    this.store.set({ exposure: Math.max(-8, Math.min(8, exposure)) });
  }
  private play(on: boolean) {
    clearTimeout(this.timer);
    this.playing = on;
    find("play").setAttribute("aria-pressed", String(on));
    find("play").textContent = on ? "Pause" : "Play";
    const turn = ++this.turns;
    const next = () => {
      this.step(1, true);
      // A frame is shown before the next one is asked for, however long that takes; meanwhile it may be stopped and started again.
      void this.ready().then(() => {
        if (this.playing && turn === this.turns) this.timer = window.setTimeout(next, 1000 / 8);
      });
    };
    if (on) next();
  }
  private exchange() {
    const { left, right } = this.store.state;
    this.store.set({ left: right, right: left });
  }

  private listenToControls() {
    const listen = (id: string, event: string, act: (element: HTMLInputElement) => void) => {
      const element = find<HTMLInputElement>(id);
      element.addEventListener(event, () => act(element));
    };
    listen("left", "change", (select) => this.choose("left", Number(select.value)));
    listen("right", "change", (select) => this.choose("right", Number(select.value)));
    listen("exchange", "click", () => this.exchange());
    for (const radio of document.querySelectorAll<HTMLInputElement>("#modes input"))
      radio.addEventListener("change", () => this.setMode(radio.value as Mode));
    listen("play", "click", () => this.play(!this.playing));
    listen("frame", "input", (range) => this.store.set({ frame: this.report.kept[Number(range.value)]! }));
    listen("exposure", "input", (range) => this.setExposure(Number(range.value)));
    listen("wipe", "input", (range) => this.store.set({ wipe: Number(range.value) / 100 }));
    listen("fit", "click", () => this.zoom(() => this.view.fit()));
    listen("actual", "click", () => this.zoom(() => this.view.zoomTo(1)));
    listen("zoom-in", "click", () => this.zoom(() => this.view.zoomTo(this.view.zoom * 2)));
    listen("zoom-out", "click", () => this.zoom(() => this.view.zoomTo(this.view.zoom / 2)));
  }
  private zoom(change: () => void) {
    change();
    this.draw();
  }

  // --- pointers ---

  private listenToPointers() {
    const canvas = this.canvas;
    const down = new Map<number, { x: number; y: number }>();
    let dragged: "wipe" | "picture" | null = null;
    let moved = 0;
    let pinch = 0;
    const place = (event: MouseEvent) => {
      const box = canvas.getBoundingClientRect();
      return { x: event.clientX - box.left, y: event.clientY - box.top };
    };
    const apart = () => {
      const [a, b] = [...down.values()];
      return Math.hypot(a!.x - b!.x, a!.y - b!.y);
    };
    canvas.addEventListener("pointerdown", (event) => {
      canvas.setPointerCapture(event.pointerId);
      const at = place(event);
      down.set(event.pointerId, at);
      if (down.size === 2) pinch = apart();
      moved = 0;
      const isOnLine = this.hasLine && Math.abs(at.x - this.lineX()) <= kHandle;
      dragged = isOnLine ? "wipe" : "picture";
    });
    canvas.addEventListener("pointermove", (event) => {
      const at = place(event);
      const before = down.get(event.pointerId);
      if (!before) {
        this.hover = this.pixelAt(at.x, at.y);
        const isOnLine = this.hasLine && Math.abs(at.x - this.lineX()) <= kHandle / 2;
        canvas.style.cursor = isOnLine ? "ew-resize" : "crosshair";
        return this.readOut();
      }
      moved += Math.hypot(at.x - before.x, at.y - before.y);
      down.set(event.pointerId, at);
      if (down.size === 2) {
        const now = apart();
        const points = [...down.values()];
        if (pinch > 0)
          this.view.zoomTo((this.view.zoom * now) / pinch, this.paneX((points[0]!.x + points[1]!.x) / 2), (points[0]!.y + points[1]!.y) / 2);
        pinch = now;
        this.draw();
      } else if (dragged === "wipe") {
        const [x] = this.view.toPicture(at.x, at.y);
        this.store.set({ wipe: Math.max(0, Math.min(1, x / this.view.width)) });
      } else if (moved > 3) {
        this.view.pan(at.x - before.x, at.y - before.y);
        this.draw();
      }
    });
    const up = (event: PointerEvent) => {
      if (!down.delete(event.pointerId) || event.type === "pointercancel") return;
      const at = place(event);
      const pixel = this.pixelAt(at.x, at.y);
      if (moved <= 3 && pixel) this.store.set({ pixel });
    };
    canvas.addEventListener("pointerup", up);
    canvas.addEventListener("pointercancel", up);
    canvas.addEventListener("pointerleave", () => {
      this.hover = null;
      this.readOut();
    });
    canvas.addEventListener(
      "wheel",
      (event) => {
        event.preventDefault();
        const at = place(event);
        this.zoom(() => this.view.zoomTo(this.view.zoom * 2 ** (-event.deltaY / (event.deltaMode ? 6 : 200)), this.paneX(at.x), at.y));
      },
      { passive: false },
    );
  }

  /** Between the left and the right picture, in one pane. */
  private get hasLine() {
    return this.store.state.mode === "wipe" || this.store.state.mode === "errors";
  }
  private get panes() {
    return this.store.state.mode === "side" ? 2 : 1;
  }
  /** A place of the canvas, in its pane. */
  private paneX(x: number) {
    return this.panes === 2 ? x % this.view.paneWidth : x;
  }
  private lineX() {
    return this.view.toPane(this.store.state.wipe * this.view.width, 0)[0];
  }
  private pixelAt(x: number, y: number): [number, number] | null {
    const [px, py] = this.view.toPicture(this.paneX(x), y).map(Math.floor) as [number, number];
    return px >= 0 && py >= 0 && px < this.view.width && py < this.view.height ? [px, py] : null;
  }

  // --- keys ---

  private listenToKeys() {
    document.addEventListener("keydown", (event) => {
      if (event.ctrlKey || event.altKey || event.metaKey) return;
      const { target } = event; // of an event made by a script it may be the document, which matches nothing
      if (target instanceof Element && target.matches("select, textarea, input:not([type=range]):not([type=radio])")) return;
      if (this.onKey(event)) event.preventDefault();
    });
  }
  private onKey(event: KeyboardEvent): boolean {
    const digit = /^(?:Digit|Numpad)([1-9])$/.exec(event.code)?.[1];
    if (digit) {
      const index = numbered(this.report)[Number(digit) - 1];
      if (index !== undefined) this.choose(event.shiftKey ? "right" : "left", index);
      return index !== undefined;
    }
    const acts: Record<string, () => void> = {
      x: () => this.exchange(),
      w: () => this.setMode("wipe"),
      s: () => this.setMode("side"),
      l: () => this.setMode("left"),
      d: () => this.setMode("difference"),
      f: () => this.setMode("flip"),
      e: () => this.setMode("errors"),
      p: () => this.play(!this.playing),
      ",": () => this.step(-1),
      ".": () => this.step(1),
      "[": () => this.setExposure(this.store.state.exposure - 0.5),
      "]": () => this.setExposure(this.store.state.exposure + 0.5),
      "+": () => this.zoom(() => this.view.zoomTo(this.view.zoom * 2)),
      "=": () => this.zoom(() => this.view.zoomTo(this.view.zoom * 2)),
      "-": () => this.zoom(() => this.view.zoomTo(this.view.zoom / 2)),
      "0": () => this.zoom(() => this.view.fit()),
    };
    const act = acts[event.key.toLowerCase()];
    if (act) act();
    return act !== undefined || (event.target === this.canvas && this.movePixel(event));
  }
  private movePixel(event: KeyboardEvent): boolean {
    const steps: Record<string, [number, number]> = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] };
    const step = steps[event.key];
    if (!step) return false;
    const [x, y] = this.store.state.pixel ?? [this.view.width >> 1, this.view.height >> 1];
    const by = this.store.state.pixel ? (event.shiftKey ? 10 : 1) : 0;
    const pixel: [number, number] = [
      Math.max(0, Math.min(this.view.width - 1, x + by * step[0])),
      Math.max(0, Math.min(this.view.height - 1, y + by * step[1])),
    ];
    this.view.show(...pixel);
    this.store.set({ pixel });
    return true;
  }

  // --- what is shown ---

  private update(state: State, before: State) {
    this.showControls(state);
    const needs: (keyof State)[] = ["left", "right", "mode", "frame", "exposure"];
    if (state === before || needs.some((key) => state[key] !== before[key])) void this.load();
    if (state.mode !== before.mode) this.resize();
    this.draw();
    this.readOut();
  }

  private showControls(state: State) {
    const image = (index: number) => this.report.images[index]!;
    find<HTMLSelectElement>("left").value = String(state.left);
    find<HTMLSelectElement>("right").value = String(state.right);
    document.querySelector<HTMLInputElement>(`#modes input[value=${state.mode}]`)!.checked = true;
    find<HTMLInputElement>("frame").value = String(this.report.kept.indexOf(state.frame));
    find<HTMLInputElement>("frame").setAttribute("aria-valuetext", `frame ${state.frame}`);
    find("frame-text").textContent = `${state.frame}`;
    find<HTMLInputElement>("exposure").value = String(state.exposure);
    find("exposure-text").textContent = `${state.exposure > 0 ? "+" : ""}${state.exposure}`.replace("-", "−");
    find<HTMLInputElement>("wipe").value = String(Math.round(100 * state.wipe));
    find("wipe-label").hidden = !this.hasLine;
    const names = { left: title(this.report, image(state.left)), right: title(this.report, image(state.right)) };
    const tags = {
      wipe: [names.left, names.right],
      side: [names.left, names.right],
      left: [names.left],
      difference: [`| ${names.left} − ${names.right} |`],
      flip: [`FLIP of ${names.left} and ${names.right}`],
      errors: [`errors of ${names.left}`, `errors of ${names.right}`],
    }[state.mode];
    find("left-name").textContent = tags[0]!;
    find("right-name").textContent = tags[1] ?? "";
    find("right-name").hidden = tags.length < 2;
    const what = { wipe: "wiped over", side: "beside", left: "hides", difference: "less", flip: "FLIP between it and", errors: "errors by FLIP, beside those of" }[state.mode];
    this.canvas.setAttribute("aria-label", `Picture of frame ${state.frame}: ${names.left}, ${what} ${names.right}`);
    for (const button of document.querySelectorAll<HTMLElement>("#numbers button")) {
      const index = Number(button.dataset["image"]);
      button.dataset["side"] = index === state.left ? "left" : index === state.right ? "right" : "";
    }
  }

  private pending: Promise<void> = Promise.resolve();
  /** When what was asked for last is drawn. */
  async drawn(): Promise<void> {
    for (let last; last !== this.pending; ) {
      last = this.pending;
      await last;
    }
    await new Promise((done) => requestAnimationFrame(() => setTimeout(done))); // behind drawNow, which was asked for before
  }
  /** When that is on the screen. */
  async ready(): Promise<void> {
    await this.drawn();
    await new Promise((done) => requestAnimationFrame(done));
  }

  private load(): Promise<void> {
    return (this.pending = this.loadNow());
  }
  private async loadNow() {
    const turn = ++this.loading;
    const { left, right, mode, frame, exposure } = this.store.state;
    const [a, b] = [this.report.images[left]!, this.report.images[right]!];
    const of = (image: ImageSeries) =>
      mode === "errors" ? this.pictures.flip(this.reference!, image, frame) : this.pictures.series(image, frame, exposure);
    const between = mode === "difference" || mode === "flip";
    const shown = between
      ? { left: await (mode === "flip" ? this.pictures.flip(a, b, frame) : this.pictures.difference(a, b, frame, exposure)), right: null }
      : { left: await of(a), right: mode === "left" ? null : await of(b) };
    if (turn !== this.loading) return; // something else was asked for meanwhile
    this.shown = shown;
    this.canvas.dataset["frame"] = String(frame);
    this.tellAbsent(shown);
    this.resize();
    this.readOut();
    this.prefetch();
  }
  private tellAbsent(shown: Shown) {
    const { left, right, mode, frame } = this.store.state;
    const isMissing = (index: number) => this.report.images[index]!.frames[frame] === undefined;
    const pairs: [number, Picture | null][] = mode === "left" ? [[left, shown.left]] : [[left, shown.left], [right, shown.right]];
    const isBetween = mode === "difference" || mode === "flip";
    const names = pairs.filter(([index, picture]) => (isBetween ? isMissing(index) : !picture)).map(([index]) => title(this.report, this.report.images[index]!));
    let text = names.length ? `frame ${frame} of ${names.join(" and ")} is not in this report` : "";
    if (mode === "errors" && names.length) text = `no errors of ${names.join(" and ")}`;
    if (isBetween && !text && !shown.left) text = mode === "flip" ? "FLIP is between colors of one size" : "these have other sizes or channels";
    find("absent").hidden = text === "";
    find("absent").textContent = text;
  }
  /** All frames of what is shown, the next ones first, while nothing else is to be done: so that scrubbing waits for nothing. */
  private prefetch() {
    const { left, right, mode, frame, exposure } = this.store.state;
    if (mode === "difference" || mode === "flip" || mode === "errors") return;
    const { kept, images } = this.report;
    const shown = mode === "left" ? [left] : [left, right];
    const picture = this.shown.left ?? this.shown.right;
    const pixels = picture ? picture.canvas.width * picture.canvas.height : 0;
    const ahead = this.pictures.hasRoomFor(kept.length * shown.length, pixels) ? kept.length : 2;
    const frames = Array.from({ length: Math.min(ahead, kept.length) }, (_, i) => kept[(kept.indexOf(frame) + i) % kept.length]!);
    const turn = this.loading;
    const idle = window.requestIdleCallback ?? ((act: () => void) => setTimeout(act, 1));
    const next = (place: number) => {
      const index = shown[place % shown.length]!;
      const other = frames[Math.floor(place / shown.length)];
      if (turn !== this.loading || other === undefined) {
        if (other === undefined) this.canvas.dataset["prefetched"] = String(turn);
        return;
      }
      void this.pictures.series(images[index]!, other, exposure).then(() => idle(() => next(place + 1)));
    };
    idle(() => next(0));
  }

  private resize() {
    const picture = this.shown.left ?? this.shown.right;
    const stage = this.canvas.parentElement!;
    if (!picture || !stage.clientWidth) return;
    const { width, height } = picture.canvas;
    const paneWidth = stage.clientWidth / this.panes;
    const most = Math.max(240, window.innerHeight * 0.62);
    const cssHeight = Math.min(most, (paneWidth * height) / width);
    const ratio = window.devicePixelRatio || 1;
    const size = { width: Math.round(stage.clientWidth * ratio), height: Math.round(cssHeight * ratio) };
    if (this.canvas.width !== size.width || this.canvas.height !== size.height) Object.assign(this.canvas, size);
    this.canvas.style.height = `${cssHeight}px`;
    this.view.resize(paneWidth, cssHeight, width, height);
    this.draw();
  }

  draw() {
    if (!this.drawing) this.drawing = requestAnimationFrame(() => this.drawNow());
  }
  private drawNow() {
    this.drawing = 0;
    const { context, view } = this;
    const { mode, pixel } = this.store.state;
    const ratio = this.canvas.width / (view.paneWidth * this.panes || 1);
    context.setTransform(ratio, 0, 0, ratio, 0, 0);
    context.clearRect(0, 0, this.canvas.width, this.canvas.height);
    context.imageSmoothingEnabled = view.zoom * ratio < 1;
    const { left, right } = this.shown;
    const { hasLine } = this;
    const line = hasLine ? this.lineX() : view.paneWidth;
    this.drawPicture(left, 0, 0, hasLine && right ? line : view.paneWidth);
    if (mode === "side") this.drawPicture(right, view.paneWidth, 0, view.paneWidth);
    else if (hasLine) this.drawPicture(right, 0, left ? line : 0, view.paneWidth);
    if (hasLine && left && right) {
      context.fillStyle = "#fff";
      context.fillRect(line - 1, 0, 2, view.paneHeight);
      context.strokeStyle = "#0008";
      context.lineWidth = 1;
      context.strokeRect(line - 1.5, -1, 3, view.paneHeight + 2);
    }
    if (pixel) for (let pane = 0; pane < this.panes; ++pane) this.markPixel(pixel, pane * view.paneWidth);
    find("zoom-text").textContent = `${Math.round(view.zoom * ratio * 100)} %`;
    this.canvas.style.touchAction = view.isFit ? "pan-y" : "none";
  }
  /** The part between two places of the pane that begins at `at`. */
  private drawPicture(picture: Picture | null, at: number, from: number, to: number) {
    if (!picture || to <= from) return;
    const { context, view } = this;
    context.save();
    context.beginPath();
    context.rect(at + Math.max(0, from), 0, Math.min(to, view.paneWidth) - Math.max(0, from), view.paneHeight);
    context.clip();
    const [x, y] = view.toPane(0, 0);
    context.drawImage(picture.canvas, at + x, y, view.width * view.zoom, view.height * view.zoom);
    if (view.zoom >= kValues && picture.pixels) this.writeValues(picture, at);
    context.restore();
  }
  private writeValues(picture: Picture, at: number) {
    const { context, view } = this;
    const pixels = picture.pixels!;
    const size = Math.min(14, view.zoom / 5.5);
    context.font = `${size}px ui-monospace, monospace`;
    context.textAlign = "center";
    const [fromX, fromY] = view.toPicture(0, 0).map((v) => Math.max(0, Math.floor(v))) as [number, number];
    const [toX, toY] = view.toPicture(view.paneWidth, view.paneHeight).map(Math.ceil) as [number, number];
    for (let y = fromY; y < Math.min(pixels.height, toY); ++y)
      for (let x = fromX; x < Math.min(pixels.width, toX); ++x) {
        const [px, py] = view.toPane(x + 0.5, y + 0.5);
        const values = pixels.all(x, y);
        values.forEach((value, i) => {
          const text = Math.abs(value) >= 1e5 ? value.toExponential(1) : String(Number(value.toPrecision(3)));
          const baseline = py + size * (1.15 * (i - (values.length - 1) / 2) + 0.35);
          context.strokeStyle = "#000c";
          context.lineWidth = 3;
          context.strokeText(text, at + px, baseline);
          context.fillStyle = "#fff";
          context.fillText(text, at + px, baseline);
        });
      }
  }
  private markPixel([x, y]: [number, number], at: number) {
    const { context, view } = this;
    const size = Math.max(view.zoom, 9);
    const [px, py] = view.toPane(x + 0.5, y + 0.5);
    context.lineWidth = 3;
    context.strokeStyle = "#000";
    context.strokeRect(at + px - size / 2, py - size / 2, size, size);
    context.lineWidth = 1.5;
    context.strokeStyle = "#fff";
    context.strokeRect(at + px - size / 2, py - size / 2, size, size);
  }

  // --- values ---

  private readOut() {
    const { pixel, left, right, frame } = this.store.state;
    const at = this.hover ?? pixel;
    const box = find("readout");
    if (!at) {
      box.textContent = "Point at a pixel to read its values; click it for its story.";
      return;
    }
    const lines = [left, ...(right === left ? [] : [right])].map((index) => {
      const image = this.report.images[index]!;
      const number = image.frames[frame];
      return number === undefined ? null : this.pictures.store.get(number).then((pixels) => ({ image, pixels }));
    });
    void Promise.all(lines).then((found) => {
      if ((this.hover ?? this.store.state.pixel)?.join() !== at.join()) return;
      box.replaceChildren(make("span", { class: "place" }, `x ${at[0]}, y ${at[1]}`));
      for (const line of found) {
        if (!line || at[0] >= line.pixels.width || at[1] >= line.pixels.height) continue;
        const values = line.pixels.all(at[0], at[1]).map(valueText).join("  ");
        box.append(make("span", { class: "values" }, make("b", {}, title(this.report, line.image)), " ", make("code", {}, values)));
      }
    });
  }
}
