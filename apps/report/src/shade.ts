// How values become colors on the screen.
import { interpolateMagma, interpolateViridis } from "d3-scale-chromatic";
import { halfValues, type Pixels } from "./pixels";

type Curve = (x: number) => number;

const srgb: Curve = (x) => (x <= 0.0031308 ? 12.92 * x : 1.055 * x ** (1 / 2.4) - 0.055);

// As core/metrics/display.h defines them.
const curves: Record<string, Curve> = {
  reinhard: (x) => (x === Infinity ? 1 : (x / (1 + x)) ** (1 / 2.2)),
  gamma: (x) => Math.min(x, 1) ** (1 / 2.2),
  srgb: (x) => srgb(Math.min(x, 1)),
  aces: (x) => (x === Infinity ? 1 : srgb(Math.min(1, (x * (2.51 * x + 0.03)) / (x * (2.43 * x + 0.59) + 0.14)))),
  none: (x) => Math.min(x, 1),
};

function toByte(value: number): number {
  return Math.max(0, Math.min(255, Math.round(255 * value)));
}

/** What is not finite is shown as magenta by the callers. */
export function displayCurve(display: string, exposure: number): Curve {
  const curve = curves[display] ?? curves["reinhard"]!;
  const gain = 2 ** exposure;
  return (x) => curve(Math.max(0, x) * gain);
}

function colorTable(interpolate: (t: number) => string): Uint32Array {
  const table = new Uint32Array(256);
  for (let i = 0; i < 256; ++i) {
    const text = interpolate(i / 255);
    const [r, g, b] = text.startsWith("#")
      ? [1, 3, 5].map((at) => parseInt(text.slice(at, at + 2), 16))
      : (text.match(/\d+/g) ?? []).map(Number);
    table[i] = (r! | (g! << 8) | (b! << 16) | (255 << 24)) >>> 0;
  }
  return table;
}
const viridis = colorTable(interpolateViridis);
const magma = colorTable(interpolateMagma);

const wrong = 0xffff00ff; // magenta: NaN or infinite
const nothing = 0xff302018; // no surface

/** Bytes of each half float under a curve. */
let table = new Uint8Array(65536);
let tableOf = "";
function tableFor(display: string, exposure: number): Uint8Array {
  const key = `${display} ${exposure}`;
  if (tableOf === key) return table;
  const curve = displayCurve(display, exposure);
  table = new Uint8Array(65536);
  for (let bits = 0; bits < 65536; ++bits) table[bits] = toByte(curve(halfValues[bits]!) || 0);
  tableOf = key;
  return table;
}

// Of floats the bits behind the 9th of the fraction do not matter to a byte: a quarter of its step at most.
const kFloatRest = 14;
const isInfinite = (top: number) => (top & 0x1fe00) === 0x1fe00; // or NaN: all bits of the exponent
let floatTable = new Uint8Array(0);
let floatTableOf = "";
function floatTableFor(display: string, exposure: number): Uint8Array {
  const key = `${display} ${exposure}`;
  if (floatTableOf === key) return floatTable;
  const curve = displayCurve(display, exposure);
  const middles = Uint32Array.from({ length: 1 << (32 - kFloatRest) }, (_, top) => (top << kFloatRest) | (1 << (kFloatRest - 1)));
  floatTable = Uint8Array.from(new Float32Array(middles.buffer), (value) => toByte(curve(value) || 0));
  floatTableOf = key;
  return floatTable;
}

function shadeColor(pixels: Pixels, display: string, exposure: number, out: Uint32Array) {
  const count = out.length;
  if (pixels.about.format === "f16") {
    const bytes = tableFor(display, exposure);
    const data = pixels.data;
    for (let i = 0; i < count; ++i) {
      const r = data[i]!;
      const g = data[count + i]!;
      const b = data[2 * count + i]!;
      const isWrong = (r & 0x7c00) === 0x7c00 || (g & 0x7c00) === 0x7c00 || (b & 0x7c00) === 0x7c00;
      out[i] = isWrong ? wrong : bytes[r]! | (bytes[g]! << 8) | (bytes[b]! << 16) | (255 << 24);
    }
    return;
  }
  const bytes = floatTableFor(display, exposure);
  const bits = new Uint32Array(pixels.data.buffer, pixels.data.byteOffset, pixels.data.length);
  for (let i = 0; i < count; ++i) {
    const [r, g, b] = [bits[i]! >>> kFloatRest, bits[count + i]! >>> kFloatRest, bits[2 * count + i]! >>> kFloatRest];
    out[i] = isInfinite(r) || isInfinite(g) || isInfinite(b) ? wrong : bytes[r]! | (bytes[g]! << 8) | (bytes[b]! << 16) | (255 << 24);
  }
}

const farAway = 1e10; // the depth of no surface

/** Between which most of the values lie. */
function usualRange(pixels: Pixels): [number, number] {
  const values: number[] = [];
  const count = pixels.data.length;
  const step = Math.max(1, Math.floor(count / 20000));
  const { width, height } = pixels;
  for (let i = 0; i < count; i += step) {
    const value = pixels.at(i % width, Math.floor(i / width) % height, Math.floor(i / (width * height)));
    if (Number.isFinite(value) && Math.abs(value) < farAway) values.push(value);
  }
  values.sort((a, b) => a - b);
  return values.length ? [values[Math.floor(values.length * 0.005)]!, values[Math.ceil((values.length - 1) * 0.995)]!] : [0, 1];
}

function shadeScalar(pixels: Pixels, type: string, out: Uint32Array) {
  let [low, high] = usualRange(pixels);
  if (type === "mask") [low, high] = [0, 1];
  else if (type !== "depth" && low > 0) low = 0;
  for (let y = 0, i = 0; y < pixels.height; ++y)
    for (let x = 0; x < pixels.width; ++x, ++i) {
      const value = pixels.at(x, y, 0);
      out[i] = !Number.isFinite(value)
        ? wrong
        : type === "depth" && value >= farAway
          ? nothing
          : viridis[toByte(high > low ? (value - low) / (high - low) : value > 0 ? 1 : 0)]!;
    }
}

function shadeIds(pixels: Pixels, out: Uint32Array) {
  for (let i = 0; i < out.length; ++i) {
    const id = pixels.data[i]!;
    const mixed = Math.imul(id + 1, 0x9e3779b1) >>> 0; // neighbors far apart: the golden ratio of 2^32
    out[i] = id === 0xffffffff ? nothing : (0xff404040 | (mixed & 0xbfbfbf)) >>> 0;
  }
}

function shadePlanes(pixels: Pixels, type: string, out: Uint32Array) {
  const [low, high] = usualRange(pixels);
  const most = Math.max(Math.abs(low), Math.abs(high)) || 1;
  const curve: Curve =
    type === "normal" ? (x) => 0.5 + 0.5 * x : type === "motion" ? (x) => 0.5 + (0.5 * x) / most : (x) => (x - low) / (high - low || 1);
  const channels = pixels.about.channels;
  for (let y = 0, i = 0; y < pixels.height; ++y)
    for (let x = 0; x < pixels.width; ++x, ++i) {
      let color = 255 << 24;
      let isWrong = false;
      for (let c = 0; c < 3; ++c) {
        const value = c < channels ? pixels.at(x, y, c) : type === "motion" ? 0 : low;
        isWrong ||= !Number.isFinite(value);
        color |= toByte(curve(value)) << (8 * c);
      }
      out[i] = isWrong ? wrong : color;
    }
}

export function shade(pixels: Pixels, type: string, display: string, exposure: number): ImageData {
  const image = new ImageData(pixels.width, pixels.height);
  const out = new Uint32Array(image.data.buffer);
  if (type === "color") shadeColor(pixels, display, exposure, out);
  else if (type === "albedo") shadeColor(pixels, "srgb", 0, out);
  else if (type === "id") shadeIds(pixels, out);
  else if (pixels.about.channels === 1) shadeScalar(pixels, type, out);
  else shadePlanes(pixels, type, out);
  return image;
}

/** A map of errors of 0..1, in FLIP's colors; NaN where there is none. */
export function shadeMap(errors: Float32Array, width: number, height: number): ImageData {
  const image = new ImageData(width, height);
  const out = new Uint32Array(image.data.buffer);
  for (let i = 0; i < out.length; ++i) out[i] = Number.isNaN(errors[i]!) ? wrong : magma[toByte(errors[i]!)]!;
  return image;
}

/** The light that a display makes of a picture, plane after plane, and 0 of what is not finite. */
export function displayLight(pixels: Pixels, type: string, display: string): Float32Array {
  const curve = displayCurve(type === "albedo" ? "srgb" : display, 0);
  const toLight = (v: number) => (v <= 0.04045 ? v / 12.92 : ((v + 0.055) / 1.055) ** 2.4);
  const light = new Float32Array(pixels.data.length);
  const ofValue = (value: number) => (Number.isFinite(value) ? toLight(curve(value)) : 0);
  if (pixels.about.format === "f16") {
    const table = Float32Array.from(halfValues, ofValue);
    for (let i = 0; i < light.length; ++i) light[i] = table[pixels.data[i]!]!;
  } else {
    for (let i = 0; i < light.length; ++i) light[i] = ofValue(pixels.data[i]!);
  }
  return light;
}

/** |a - b| of each channel, brighter with the exposure; in one channel in Viridis' colors. Nothing where sizes differ. */
export function shadeDifference(a: Pixels, b: Pixels, exposure: number): ImageData | null {
  const channels = Math.min(a.about.channels, b.about.channels);
  if (a.width !== b.width || a.height !== b.height || a.about.channels !== b.about.channels) return null;
  const image = new ImageData(a.width, a.height);
  const out = new Uint32Array(image.data.buffer);
  const gain = 2 ** exposure;
  for (let y = 0, i = 0; y < a.height; ++y)
    for (let x = 0; x < a.width; ++x, ++i) {
      let color = 255 << 24;
      let isWrong = false;
      for (let c = 0; c < channels && c < 3; ++c) {
        const [p, q] = [a.at(x, y, c), b.at(x, y, c)];
        isWrong ||= !Number.isFinite(p) || !Number.isFinite(q);
        color |= toByte(Math.abs(p - q) * gain) << (8 * c);
      }
      out[i] = isWrong ? wrong : channels === 1 ? viridis[color & 255]! : color;
    }
  return image;
}
