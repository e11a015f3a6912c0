// Pictures that are ready to be drawn: shaded images and maps, kept while nothing they depend on changes.
import type { ImageSeries, Report } from "./data";
import { type Pixels, PixelStore } from "./pixels";
import { shade, shadeDifference, shadeMap } from "./shade";

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
  readonly store: PixelStore;
  constructor(private readonly report: Report) {
    this.store = new PixelStore(report);
  }

  /** Nothing where the frame has no image. */
  series(image: ImageSeries, frame: number, exposure: number): Promise<Picture | null> {
    const number = image.frames[frame];
    if (number === undefined) return Promise.resolve(null);
    const key = `series ${number} ${image.type === "color" ? exposure : 0}`;
    return this.keep(key, async () => {
      const pixels = await this.store.get(number);
      return { canvas: toCanvas(shade(pixels, image.type, this.report.display ?? "reinhard", exposure)), pixels };
    });
  }
  flip(image: ImageSeries, frame: number): Promise<Picture | null> {
    const number = image.flip?.[frame];
    if (number === undefined) return Promise.resolve(null);
    return this.keep(`flip ${number}`, async () => ({ canvas: toCanvas(shadeMap(await this.store.get(number))), pixels: null }));
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
