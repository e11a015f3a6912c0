// Packed images, made into numbers: apps/quell/report_pixels.h tells how they are packed.
import type { Packed, Report } from "./data";

/** The value of every half float, by its bits. */
export const halfValues: Float32Array = (() => {
  const values = new Float32Array(65536);
  for (let bits = 0; bits < 65536; ++bits) {
    const exponent = (bits >> 10) & 31;
    const fraction = bits & 1023;
    const magnitude =
      exponent === 31 ? (fraction ? NaN : Infinity) : exponent === 0 ? fraction * 2 ** -24 : (1 + fraction / 1024) * 2 ** (exponent - 15);
    values[bits] = bits & 32768 ? -magnitude : magnitude;
  }
  return values;
})();

export class Pixels {
  constructor(
    readonly about: Packed,
    /** Plane after plane; halves as their bits. */
    readonly data: Uint16Array | Uint32Array | Float32Array,
  ) {}
  get width() {
    return this.about.width;
  }
  get height() {
    return this.about.height;
  }
  get bytes() {
    return this.data.byteLength;
  }
  /** A value as a number, by its place in `data`. */
  value(place: number): number {
    const raw = this.data[place]!;
    return this.about.format === "f16" ? halfValues[raw]! : raw;
  }
  at(x: number, y: number, channel: number): number {
    return this.value((channel * this.height + y) * this.width + x);
  }
  all(x: number, y: number): number[] {
    return Array.from({ length: this.about.channels }, (_, channel) => this.at(x, y, channel));
  }
}

async function decodeBase64(text: string): Promise<Uint8Array> {
  const native = (Uint8Array as unknown as { fromBase64?: (text: string) => Uint8Array }).fromBase64;
  if (native) return native(text);
  const raw = atob(text);
  const bytes = new Uint8Array(raw.length);
  for (let i = 0; i < raw.length; ++i) bytes[i] = raw.charCodeAt(i);
  return bytes;
}

async function inflate(bytes: Uint8Array): Promise<Uint8Array> {
  const stream = new Blob([bytes as BlobPart]).stream().pipeThrough(new DecompressionStream("deflate"));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

function join(bytes: Uint8Array, about: Packed): Pixels["data"] {
  const count = about.width * about.height * about.channels;
  if (about.format === "f16") {
    const values = new Uint16Array(count);
    for (let i = 0; i < count; ++i) values[i] = bytes[i]! | (bytes[count + i]! << 8);
    return values;
  }
  const values = new Uint32Array(count);
  for (let i = 0; i < count; ++i)
    values[i] = bytes[i]! | (bytes[count + i]! << 8) | (bytes[2 * count + i]! << 16) | (bytes[3 * count + i]! << 24);
  return about.format === "f32" ? new Float32Array(values.buffer) : values;
}

/** Reads packed images; the ones used last stay, up to a number of bytes. */
export class PixelStore {
  private readonly kept = new Map<number, Promise<Pixels>>();
  private readonly sizes = new Map<number, number>();
  private bytes = 0;
  constructor(
    private readonly report: Report,
    private readonly limit = 768 << 20,
  ) {}

  get(number: number): Promise<Pixels> {
    const known = this.kept.get(number);
    if (known) {
      this.kept.delete(number);
      this.kept.set(number, known); // the youngest again
      return known;
    }
    const read = this.read(number);
    this.kept.set(number, read);
    return read;
  }

  private async read(number: number): Promise<Pixels> {
    const about = this.report.packed[number]!;
    const text = document.getElementById(`image-${number}`)?.textContent ?? "";
    const pixels = new Pixels(about, join(await inflate(await decodeBase64(text)), about));
    this.sizes.set(number, pixels.bytes);
    this.bytes += pixels.bytes;
    for (const oldest of this.kept.keys()) {
      if (this.bytes <= this.limit || oldest === number) break;
      this.bytes -= this.sizes.get(oldest) ?? 0;
      this.sizes.delete(oldest);
      this.kept.delete(oldest);
    }
    return pixels;
  }
}
