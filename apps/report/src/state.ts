// What the viewer shows, and who wants to know when that changes.
import type { Report } from "./data";

export type Mode = "wipe" | "side" | "left" | "difference" | "flip" | "errors";

export interface State {
  left: number; // of Report.images
  right: number;
  mode: Mode;
  frame: number;
  exposure: number; // stops
  wipe: number; // 0..1 of the picture's width
  pixel: [number, number] | null; // that was chosen, of a picture of `pictureSize`
}

export class Store {
  private readonly told: ((state: State, before: State) => void)[] = [];
  constructor(
    readonly report: Report,
    public state: State,
  ) {}
  listen(listener: (state: State, before: State) => void) {
    this.told.push(listener);
  }
  set(change: Partial<State>) {
    const before = this.state;
    const after = { ...before, ...change };
    const [from, to] = [pictureSize(this.report, before), pictureSize(this.report, after)];
    const isResized = from.width !== to.width || from.height !== to.height;
    if (after.pixel && !change.pixel && isResized) after.pixel = samePlace(after.pixel, from, to);
    this.state = after;
    for (const listener of this.told) listener(this.state, before);
  }
}

/** Images by number keys: what is compared most. */
export function numbered(report: Report): number[] {
  const order = ["noisy", "reference", "result"];
  return report.images
    .map((image, index) => ({ index, place: order.indexOf(image.kind) }))
    .filter(({ place }) => place >= 0)
    .sort((a, b) => a.place - b.place || a.index - b.index)
    .map(({ index }) => index)
    .slice(0, 9);
}

export function firstState(report: Report): State {
  const of = (kind: string) => report.images.findIndex((image) => image.kind === kind);
  const results = report.images.flatMap((image, index) => (image.kind === "result" ? [index] : []));
  const right = results.at(-1) ?? 0;
  const left = of("noisy") >= 0 ? of("noisy") : of("reference") >= 0 ? of("reference") : (results[0] ?? 0);
  const frame = report.inner.at(-1) ?? report.kept.at(-1) ?? 0;
  return { left, right, mode: "wipe", frame, exposure: 0, wipe: 0.5, pixel: null };
}

interface Size {
  width: number;
  height: number;
}
/** Of the picture that zoom, place and pixels are told of: the left image, or the right one in frames that lack it. */
export function pictureSize(report: Report, { left, right, frame }: State): Size {
  const series = [left, right].map((index) => report.images[index]!.frames);
  const number = series[0]![frame] ?? series[1]![frame] ?? Object.values(series[0]!)[0];
  return number === undefined ? { width: 1, height: 1 } : report.packed[number]!;
}
/** The pixel of an image that stands where another one does in an image of another size. */
export function samePlace([x, y]: [number, number], from: Size, to: Size): [number, number] {
  const along = (at: number, of: number, size: number) => Math.min(size - 1, Math.floor((at * size) / of));
  return [along(x, from.width, to.width), along(y, from.height, to.height)];
}

/** One picture of two images. */
export function isBetween(mode: Mode): boolean {
  return mode === "difference" || mode === "flip";
}
export function referenceOf(report: Report) {
  return report.images.find((image) => image.kind === "reference");
}
