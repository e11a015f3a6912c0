// Means over time, as the passes' documentation and tests have them: temporal_blend, moments, taa, window, history_fix.
import { dot, farAway, type Filter, type Found, luminance, minus, type Tap } from "./filter";
import type { Pixels } from "./pixels";

const noObject = 0xffffffff;
const surely = 1e-30; // what is divided by is at least this

/** The history's values at the pixel, where there is one that can be used. */
function history(f: Filter): number[] | null {
  const image = f.input("history");
  return image && (f.own("valid") ?? 1) > 0.5 ? image.all(f.x, f.y) : null;
}
/** The new frame's share of the mean, and the rest, of a history that may have been limited before. */
function blend(f: Filter, share: number, own: number[], old: number[], limited = old): Tap[] {
  const at = { x: f.x, y: f.y };
  const isLimited = limited.some((value, c) => Math.abs(value - old[c]!) > 1e-9 * Math.abs(old[c]!)); // not by the way to YCoCg and back
  return [
    { ...at, weight: share, values: own },
    { ...at, weight: 1 - share, port: isLimited ? "history, limited" : "history", values: limited },
  ];
}

function toYcocg([r, g, b]: number[]): number[] {
  return [(r! + 2 * g! + b!) / 4, (r! - b!) / 2, (2 * g! - r! - b!) / 4];
}
function toRgb([y, co, cg]: number[]): number[] {
  return [y! + co! - cg!, y! + cg!, y! - co! - cg!];
}
/** Values of the window's pixels that lie in the image, by components. */
function neighbors(f: Filter, radius: number, convert: (color: number[]) => number[]): number[][] {
  const colors = f.window(radius, () => 1).map(({ x, y }) => convert(f.image.all(x, y)));
  return colors[0]!.map((_, c) => colors.map((color) => color[c]!));
}
function clampTo([low, high]: [number, number], value: number): number {
  return Math.min(Math.max(value, low), high);
}
/** Of the smallest and the largest; windows have too many pixels for an argument list. */
function rangeOf(values: number[]): [number, number] {
  return [values.reduce((a, b) => Math.min(a, b)), values.reduce((a, b) => Math.max(a, b))];
}

/** What the history is limited to in a component. */
function blendLimits(f: Filter, values: number[], center: number): [number, number] {
  if (f.text("clamp") === "range") return rangeOf(values);
  const count = f.text("count") === "full" ? (2 * f.number("clamp_radius") + 1) ** 2 : values.length;
  const mean = values.reduce((sum, value) => sum + value, 0) / count;
  const about = f.text("spread") === "center" ? center : mean;
  const reach = f.number("clamp_k") * Math.sqrt(values.reduce((sum, value) => sum + (value - about) ** 2, 0) / count);
  return [mean - reach, mean + reach];
}

export function temporalBlend(f: Filter): Tap[] {
  const old = history(f);
  if (!old) return f.alone();
  const [length, confidence] = [f.own("length"), f.own("confidence")];
  let share = f.number("alpha");
  if (length !== undefined) share = Math.max(share, 1 / Math.min(f.number("max_length"), length + 1));
  if (confidence !== undefined) share = 1 - clampTo([0, 1], confidence) * (1 - share);
  const own = f.image.all(f.x, f.y);
  if (f.text("clamp") === "none") return blend(f, share, own, old);
  const isYcocg = f.text("space") === "ycocg";
  const convert = isYcocg ? toYcocg : (color: number[]) => color;
  const [window, center] = [neighbors(f, f.number("clamp_radius"), convert), convert(own)];
  const limited = convert(old).map((value, c) => clampTo(blendLimits(f, window[c]!, center[c]!), value));
  return blend(f, share, own, old, isYcocg ? toRgb(limited) : limited);
}

/** Of luminance and its square, not of colors. */
export function moments(f: Filter): Tap[] {
  const l = luminance(f.image.all(f.x, f.y));
  const old = history(f);
  if (!old) return [{ x: f.x, y: f.y, weight: 1, values: [l, l * l] }];
  const length = f.own("length");
  const n = length === undefined ? f.number("max_length") : Math.min(f.number("max_length"), length + 1);
  return blend(f, Math.max(f.number("alpha"), f.is("warm_up") ? 1 / n : 0), [l, l * l], old);
}

/** Of each component of YCoCg. */
function taaBox(f: Filter): [number, number][] {
  const square = neighbors(f, 1, toYcocg);
  const half = (a: [number, number], b: [number, number]): [number, number] => [(a[0] + b[0]) / 2, (a[1] + b[1]) / 2];
  if (f.text("box") === "variance")
    return square.map((values) => {
      const mean = values.reduce((sum, value) => sum + value, 0) / values.length;
      const reach = f.number("k") * Math.sqrt(values.reduce((sum, value) => sum + (value - mean) ** 2, 0) / values.length);
      return [mean - reach, mean + reach];
    });
  if (f.text("box") === "range") return square.map(rangeOf);
  const near = f.window(1, (x, y) => (x === f.x || y === f.y ? 1 : 0)).map(({ x, y }) => toYcocg(f.image.all(x, y)));
  return square.map((values, c) => half(rangeOf(values), rangeOf(near.map((color) => color[c]!))));
}
function taaLimit(f: Filter, old: number[]): number[] {
  if (f.text("limit") === "none") return old;
  const box = taaBox(f);
  if (f.text("limit") === "clamp") return old.map((value, c) => clampTo(box[c]!, value));
  const center = box.map(([low, high]) => (low + high) / 2);
  const excess = old.map((value, c) => Math.abs(value - center[c]!) / Math.max((box[c]![1] - box[c]![0]) / 2, surely));
  const farthest = rangeOf(excess)[1];
  return farthest > 1 ? center.map((middle, c) => middle + (old[c]! - middle) / farthest) : old;
}
export function taa(f: Filter): Tap[] {
  const old = history(f);
  if (!old) return f.alone();
  const own = f.image.all(f.x, f.y);
  const limited = taaLimit(f, toYcocg(old));
  const worth = (luma: number) => (f.is("weigh") ? 1 / (1 + Math.max(luma, 0)) : 1);
  const [now, before] = [f.number("alpha") * worth(toYcocg(own)[0]!), (1 - f.number("alpha")) * worth(limited[0]!)];
  return blend(f, now / (now + before), own, old, toRgb(limited));
}

export function window(f: Filter): Tap[] {
  const variance = f.input("variance");
  const [valid, variances] = [f.inputs.list("valid"), f.inputs.list("variances")];
  const weigh = (frame: Pixels, i: number): number => {
    const isValid = (x: number, y: number) => (valid[i]?.at(x, y, 0) ?? 1) > 0.5;
    if (!isValid(f.x, f.y)) return 0;
    if (!variance) return 1;
    let [difference, expected] = [0, 0];
    for (const { x, y } of f.window(f.number("radius"), (qx, qy) => (isValid(qx, qy) ? 1 : 0))) {
      difference += luminance(minus(frame.all(x, y), f.image.all(x, y)));
      expected += variance.at(x, y, 0) + (variances[i] ?? variance).at(x, y, 0);
    }
    return Math.exp(-(difference ** 2) / (2 * f.number("k") ** 2 * Math.max(expected, surely)));
  };
  const others = f.inputs.list("frames").flatMap((frame, i): Tap[] => {
    const weight = frame ? weigh(frame, i) : 0;
    return frame && weight > 0 ? [{ x: f.x, y: f.y, weight, port: `frames[${i}]`, values: frame.all(f.x, f.y) }] : [];
  });
  return [...f.alone(), ...others];
}

/** To the nearest even number where it lies in the middle. */
function roundEven(value: number): number {
  const below = Math.floor(value);
  return value - below === 0.5 ? below + (below & 1) : Math.round(value);
}
export function historyFix(f: Filter): Found {
  const [depth, gradient, normal, position, id] = ["depth", "depth_gradient", "normal", "position", "id"].map((port) => f.input(port));
  const length = f.own("length")!;
  const stride = roundEven(f.number("stride") / (1 + Math.max(length, 1)));
  const isSurface = (depth?.at(f.x, f.y, 0) ?? 0) < farAway && id?.at(f.x, f.y, 0) !== noObject;
  if (length >= f.number("min_length") || stride === 0 || !isSurface) return f.alone();
  const [z, n] = [depth?.at(f.x, f.y, 0) ?? 0, normal?.all(f.x, f.y)];
  return f.window(
    2,
    (x, y) => {
      if (x === f.x && y === f.y) return 1;
      if ((id && id.at(x, y, 0) !== id.at(f.x, f.y, 0)) || (depth && depth.at(x, y, 0) >= farAway)) return 0;
      let w = n && f.number("sigma_n") > 0 ? Math.max(0, dot(n, normal!.all(x, y))) ** f.number("sigma_n") : 1;
      if (n && position) {
        const height = dot(n, minus(position.all(x, y), position.all(f.x, f.y)));
        if (Math.abs(height) > f.number("plane_relative") * z + f.number("plane_absolute")) w = 0;
      } else if (depth && gradient) {
        const explained = f.number("sigma_z") * Math.max(gradient.at(f.x, f.y, 0), 1e-8) * Math.hypot(x - f.x, y - f.y);
        w *= Math.exp(-Math.abs(z - depth.at(x, y, 0)) / Math.max(explained, surely));
      }
      return Math.min(w, 1); // normals that are a little longer than 1
    },
    stride,
  );
}
