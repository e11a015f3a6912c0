// Pictures that are ready to be drawn: shaded images and maps, kept while nothing they depend on changes.
import type { ImageSeries, Report } from "./data";
import { flipMap, usualPixelsPerDegree } from "./flip";
import { type Pixels, PixelStore } from "./pixels";
import { displayLight, shade, shadeDifference, shadeMap } from "./shade";

export interface Picture {
  canvas: HTMLCanvasElement;
  pixels: Pixels | null; // of a series; null for maps and differences
}

// Pixels of all pictures that are ready, 10 bytes each with their values: two images of 24 frames of 1920 x 1080 where there is
// room for them. Browsers tell 8 GB for all that is more.
const memory = (navigator as { deviceMemory?: number }).deviceMemory ?? 8;
const mostPixels = memory >= 8 ? 110e6 : 25e6;

function toCanvas(image: ImageData): HTMLCanvasElement {
  const canvas = document.createElement("canvas");
  canvas.width = image.width;
  canvas.height = image.height;
  canvas.getContext("2d")!.putImageData(image, 0, 0);
  return canvas;
}

export class Pictures {
  private readonly ready = new Map<string, Promise<Picture | null>>();
  private pixelsReady = 0;
  private wanted = new Set<string>();
  readonly store: PixelStore;
  constructor(private readonly report: Report) {
    this.store = new PixelStore(report);
  }

  private get display() {
    return this.report.display ?? "reinhard";
  }
  /** Nothing where the frame has no image. */
  series(image: ImageSeries, frame: number, exposure: number): Promise<Picture | null> {
    const number = image.frames[frame];
    if (number === undefined) return Promise.resolve(null);
    const key = `series ${number} ${image.type === "color" ? exposure : 0}`;
    return this.keep(key, async () => {
      const pixels = await this.store.get(number);
      return { canvas: toCanvas(shade(pixels, image.type, this.display, exposure)), pixels };
    });
  }
  /** What is asked for from now on is wanted, and nothing that was before: long work on that is given up. */
  forgetWanted() {
    this.wanted.clear();
  }
  /** FLIP between two images of colors, as the display shows them without more exposure. Nothing where sizes differ. */
  flip(a: ImageSeries, b: ImageSeries, frame: number): Promise<Picture | null> {
    const [left, right] = [a.frames[frame], b.frames[frame]];
    const areColors = [a, b].every(({ type }) => type === "color" || type === "albedo");
    if (left === undefined || right === undefined || !areColors) return Promise.resolve(null);
    const key = `flip ${Math.min(left, right)} ${Math.max(left, right)}`;
    this.wanted.add(key);
    return this.keep(key, async () => {
      const errors = await this.flipErrors(a, b, frame, () => this.wanted.has(key));
      if (!errors) this.ready.delete(key); // it may have been given up, and be wanted later
      const { width, height } = this.report.packed[left]!;
      return errors && { canvas: toCanvas(shadeMap(errors, width, height)), pixels: null };
    });
  }
  /** NaN where one of the pixels is not finite. */
  async flipErrors(a: ImageSeries, b: ImageSeries, frame: number, isWanted = () => true): Promise<Float32Array | null> {
    const [p, q] = await Promise.all([a, b].map((image) => this.store.get(image.frames[frame]!)));
    const { width, height } = p!;
    if (width !== q!.width || height !== q!.height) return null;
    const light = [displayLight(p!, a.type, this.display), displayLight(q!, b.type, this.display)] as const;
    const errors = await flipMap(light, { width, height }, this.report.pixelsPerDegree ?? usualPixelsPerDegree, isWanted);
    if (!errors) return null;
    for (const image of [p!, q!])
      for (let i = 0; i < image.data.length; ++i) if (!Number.isFinite(image.value(i))) errors[i % errors.length] = NaN;
    return errors;
  }
  difference(a: ImageSeries, b: ImageSeries, frame: number, exposure: number): Promise<Picture | null> {
    const [left, right] = [a.frames[frame], b.frames[frame]];
    if (left === undefined || right === undefined) return Promise.resolve(null);
    return this.keep(`difference ${left} ${right} ${exposure}`, async () => {
      const image = shadeDifference(await this.store.get(left), await this.store.get(right), exposure);
      return image && { canvas: toCanvas(image), pixels: null };
    });
  }

  /** Whether there is room for more pictures than these. */
  hasRoomFor(pictures: number, pixels: number): boolean {
    return pictures * pixels <= mostPixels;
  }

  private keep(key: string, make: () => Promise<Picture | null>): Promise<Picture | null> {
    const known = this.ready.get(key);
    if (known) {
      this.ready.delete(key);
      this.ready.set(key, known);
      return known;
    }
    const made = make().then((picture) => {
      this.pixelsReady += picture ? picture.canvas.width * picture.canvas.height : 0;
      this.forgetOldest(key);
      return picture;
    });
    this.ready.set(key, made);
    return made;
  }
  private forgetOldest(youngest: string) {
    for (const [key, picture] of this.ready) {
      if (this.pixelsReady <= mostPixels || key === youngest) return;
      this.ready.delete(key);
      void picture.then((old) => (this.pixelsReady -= old ? old.canvas.width * old.canvas.height : 0));
      return;
    }
  }
}
