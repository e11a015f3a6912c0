// The canvas: what part of the images it shows, and how they are drawn.
import type { Picture } from "./pictures";
import type { Pixels } from "./pixels";
import type { Store } from "./state";
import { find } from "./text";
import { displayRatio, View } from "./view";

const kValues = 44; // CSS pixels a pixel from which on values are written into it

export interface Shown {
  left: Picture | null;
  right: Picture | null;
}

export class Stage {
  readonly canvas = find<HTMLCanvasElement>("canvas");
  readonly view = new View();
  private readonly context = this.canvas.getContext("2d")!;
  private shown: Shown = { left: null, right: null };
  private drawing = 0;

  constructor(private readonly store: Store) {
    new ResizeObserver(() => this.resize()).observe(this.canvas.parentElement!);
  }
  show(shown: Shown) {
    this.shown = shown;
    this.resize();
  }
  zoom(change: (view: View) => void) {
    change(this.view);
    this.draw();
  }

  /** Between the left and the right picture, in one pane. */
  get hasLine() {
    return this.store.state.mode === "wipe" || this.store.state.mode === "errors";
  }
  private get panes() {
    return this.store.state.mode === "side" ? 2 : 1;
  }
  /** A place of the canvas, in its pane. */
  paneX(x: number) {
    return this.panes === 2 ? x % this.view.paneWidth : x;
  }
  lineX() {
    return this.view.toPane(this.store.state.wipe * this.view.width, 0)[0];
  }
  pixelAt(x: number, y: number): [number, number] | null {
    const [px, py] = this.view.toPicture(this.paneX(x), y).map(Math.floor) as [number, number];
    return px >= 0 && py >= 0 && px < this.view.width && py < this.view.height ? [px, py] : null;
  }

  resize() {
    const picture = this.shown.left ?? this.shown.right;
    const stage = this.canvas.parentElement!;
    if (!picture || !stage.clientWidth) return;
    const { width, height } = picture.canvas;
    const paneWidth = stage.clientWidth / this.panes;
    const most = Math.max(240, window.innerHeight * 0.62);
    const cssHeight = Math.min(most, (paneWidth * height) / width);
    const ratio = displayRatio();
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
    if (picture.pixels) this.writeValues(picture.pixels, at);
    context.restore();
  }
  /** Into pixels that are large enough; the image may have another size than the picture that the view tells of. */
  private writeValues(pixels: Pixels, at: number) {
    const { context, view } = this;
    const [across, down] = [view.width / pixels.width, view.height / pixels.height];
    if (view.zoom * across < kValues) return;
    const size = Math.min(14, (view.zoom * across) / 5.5);
    context.font = `${size}px ui-monospace, monospace`;
    context.textAlign = "center";
    const [left, top] = view.toPicture(0, 0);
    const [right, bottom] = view.toPicture(view.paneWidth, view.paneHeight);
    const [fromX, fromY] = [Math.max(0, Math.floor(left / across)), Math.max(0, Math.floor(top / down))];
    const [toX, toY] = [Math.ceil(right / across), Math.ceil(bottom / down)];
    for (let y = fromY; y < Math.min(pixels.height, toY); ++y)
      for (let x = fromX; x < Math.min(pixels.width, toX); ++x) {
        const [px, py] = view.toPane((x + 0.5) * across, (y + 0.5) * down);
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
}
