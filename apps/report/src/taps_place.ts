// Means of pixels that lie elsewhere, as the passes' documentation and tests have them: reproject, scale; and mix.
import { dot, type Filter, type Found, minus, type Tap } from "./filter";

const noObject = 0xffffffff;

/** Whether what stands at the pixel may have been what stood at the tap. */
function tests(f: Filter): (x: number, y: number) => boolean {
  const both = (name: string) => [f.input(name), f.input(`previous_${name}`)] as const;
  const [[id, oldId], [depth, oldDepth], [normal, oldNormal], [position, oldPosition]] = [both("id"), both("depth"), both("normal"), both("position")];
  const n = normal?.all(f.x, f.y);
  const bend = f.number("normal_slope") * (f.own("normal_gradient") ?? 0) + f.number("normal_absolute");
  const z = depth?.at(f.x, f.y, 0) ?? 0;
  const step = f.number("depth_slope") * (f.own("depth_gradient") ?? 0) + f.number("depth_relative") * Math.abs(z) + f.number("depth_absolute");
  return (x, y) => {
    if (!f.inside(x, y)) return false;
    if (id && oldId && id.at(f.x, f.y, 0) !== oldId.at(x, y, 0)) return false;
    if (depth && oldDepth && !(Math.abs(z - oldDepth.at(x, y, 0)) <= step)) return false;
    if (n && oldNormal && !(dot(minus(n, oldNormal.all(x, y))) <= bend ** 2)) return false;
    return !(n && position && oldPosition) || Math.abs(dot(n, minus(position.all(f.x, f.y), oldPosition.all(x, y)))) <= f.number("plane_absolute");
  };
}

/** Catmull and Rom's spline at the four pixels around a point that lies t behind the second. */
function spline(t: number): number[] {
  return [t * (-0.5 + t * (1 - 0.5 * t)), 1 + t * t * (1.5 * t - 2.5), t * (0.5 + t * (2 - 1.5 * t)), t * t * (0.5 * t - 0.5)];
}
/** Of the pixels around (x, y) along both axes, the first of which lies at `from`. */
function around(x: number, y: number, from: number, [across, down]: [number[], number[]]): Tap[] {
  return down.flatMap((h, j) => across.map((w, i) => ({ x: x + from + i, y: y + from + j, weight: w * h }))).filter((tap) => tap.weight !== 0);
}
/** The pixel that contains a point, t behind pixel `at`; with truncate as C converts, so that -1 is on the border, too. */
function contains(at: number, t: number, truncates: boolean): number {
  const pixel = t >= 0.5 ? at + 1 : at;
  return truncates && pixel === -1 && t !== 0.5 ? 0 : pixel;
}

export function reproject(f: Filter): Found {
  const [mx, my] = f.input("motion")!.all(f.x, f.y) as [number, number];
  const nothing = "no history was found here";
  if (f.inputs.list("history").includes(null)) return "there is no history in this frame";
  if (!(Math.abs(mx) < 2 ** 20 && Math.abs(my) < 2 ** 20) || f.own("id") === noObject) return nothing;
  const [x, y, tx, ty] = [f.x + Math.floor(mx), f.y + Math.floor(my), mx - Math.floor(mx), my - Math.floor(my)];
  const [fetch, passes] = [f.text("fetch"), tests(f)];
  const four = around(x, y, 0, [[1 - tx, tx], [1 - ty, ty]]);
  if (fetch === "catmull_rom") {
    const window = Array(4).fill(1) as number[];
    if (around(x, y, -1, [window, window]).every((tap) => passes(tap.x, tap.y))) {
      const middle = around(x, y, 0, [[1, 1], [1, 1]]).map((tap) => f.image.all(tap.x, tap.y));
      const limit = (values: number[]) =>
        values.map((value, c) => Math.min(Math.max(value, Math.min(...middle.map((color) => color[c]!))), Math.max(...middle.map((color) => color[c]!))));
      return { taps: around(x, y, -1, [spline(tx), spline(ty)]), center: [x, y], limit };
    }
  }
  const isPoint = fetch === "nearest" || fetch === "truncate";
  const point = { x: contains(x, tx, fetch === "truncate"), y: contains(y, ty, fetch === "truncate"), weight: 1 };
  const taps = (isPoint ? [point] : four).filter((tap) => passes(tap.x, tap.y));
  if (taps.length > 0 && taps.reduce((sum, tap) => sum + tap.weight, 0) >= f.number("min_weight")) return { taps, center: isPoint ? [point.x, point.y] : [x, y] };
  if (f.text("rescue") === "none") return nothing;
  const center: [number, number] = [contains(x, tx, false), contains(y, ty, false)];
  const rescued = around(...center, -1, [[1, 1, 1], [1, 1, 1]]).filter((tap) => passes(tap.x, tap.y));
  return rescued.length > 0 ? { taps: rescued, center } : nothing;
}

const averaged = ["color", "albedo", "moments", "variance", "scalar", "alpha"];
const half = (size: number) => (size + 1) >> 1;

/** How the pixels of the small image around a pixel of the large one are weighed, besides by their distance. */
function likeness(f: Filter): (x: number, y: number) => number {
  const pair = (name: string) => [f.input(`full_${name}`), f.input(name)] as const;
  const [[fullDepth, depth], [fullNormal, normal]] = [pair("depth"), pair("normal")];
  if (!(fullDepth && depth) && !(fullNormal && normal)) return () => 1;
  return (x, y) => {
    let w = 1;
    if (fullDepth && depth) {
      const z = fullDepth.at(f.x, f.y, 0);
      w *= Math.exp(-Math.abs(z - depth.at(x, y, 0)) / (f.number("sigma_z") * Math.max(Math.abs(z), 1e-30)));
    }
    // 1 - |n - n'|^2 / 2 is n.n' of unit normals, and 1 where both are 0.
    if (fullNormal && normal) w *= Math.max(1e-37, 1 - dot(minus(fullNormal.all(f.x, f.y), normal.all(x, y))) / 2) ** f.number("sigma_n");
    return Math.min(w, 1) + 1e-6;
  };
}

/** Along an axis: the two small pixels around a large one, and the way from the first to the second. */
function between(at: number, small: number, large: number): [number, number, number] {
  const place = (at + 0.5) * (half(large) === small ? 0.5 : Math.fround(small / large)) - 0.5;
  const first = Math.floor(place);
  const clamp = (pixel: number) => Math.min(Math.max(pixel, 0), small - 1);
  return [clamp(first), clamp(first + 1), place - first];
}

function scaleTaps(f: Filter): Tap[] {
  const { width, height } = f.image;
  const isHalf = f.text("to") === "half";
  const isMean = f.text("method") === "average" || (f.text("method") === "by_type" && averaged.includes(f.inputs.type("image")));
  if (!isMean || f.inputs.type("image") === "id") {
    const place = (at: number, from: number, to: number) =>
      Math.min(isHalf ? 2 * at : half(to) === from ? at >> 1 : Math.floor(((at + 0.5) * from) / to), from - 1);
    return [{ x: place(f.x, width, f.size.width), y: place(f.y, height, f.size.height), weight: 1 }];
  }
  if (isHalf) return around(2 * f.x, 2 * f.y, 0, [[1, 1], [1, 1]]).filter((tap) => f.inside(tap.x, tap.y));
  const [left, right, wayX] = between(f.x, width, f.size.width);
  const [above, below, wayY] = between(f.y, height, f.size.height);
  const like = likeness(f);
  return [[above, 1 - wayY] as const, [below, wayY] as const].flatMap(([y, h]) =>
    [[left, 1 - wayX] as const, [right, wayX] as const].map(([x, w]) => ({ x, y, weight: w * h * like(x, y) })),
  );
}
export function scale(f: Filter): Found {
  const taps = scaleTaps(f);
  if (f.inputs.type("image") !== "motion") return { taps, center: [taps[0]!.x, taps[0]!.y] };
  const gain = (small: number, large: number) => (f.text("to") === "half" ? 0.5 : half(large) === small ? 2 : large / small);
  const gains = [gain(f.image.width, f.size.width), gain(f.image.height, f.size.height)]; // motion is in pixels
  return { taps, center: [taps[0]!.x, taps[0]!.y], limit: (values) => values.map((value, c) => value * gains[c]!) };
}

export function mix(f: Filter): Tap[] {
  const [b, t] = [f.input("b"), f.own("t")];
  const share = b ? f.number("amount") * Math.min(Math.max(t ?? 1, 0), 1) : 0;
  const at = { x: f.x, y: f.y };
  const taps = [{ ...at, weight: 1 - share }, ...(b ? [{ ...at, weight: share, port: "b", values: b.all(f.x, f.y) }] : [])];
  return taps.filter((tap) => tap.weight > 0);
}
