// Blurs of a window, as the passes' documentation and tests have them: gaussian, variance_blur, bilateral, joint_bilateral.
import { angle, dot, type Filter, isZero, mean, minus, planeTerm, type Tap, type Weight } from "./filter";

export function gaussian(f: Filter): Tap[] {
  const sigma = f.number("sigma");
  const radius = f.number("radius") >= 0 ? f.number("radius") : Math.ceil(3 * sigma);
  return f.window(radius, (x, y) => Math.exp(-((x - f.x) ** 2 + (y - f.y) ** 2) / (2 * sigma ** 2)));
}

export function varianceBlur(f: Filter): Tap[] {
  const weight: Weight = (x, y) => (x === f.x ? 2 : 1) * (y === f.y ? 2 : 1);
  const taps = f.window(1, weight);
  const left = 16 - taps.reduce((sum, tap) => sum + tap.weight, 0);
  // Pixels outside the image weigh as others do, and are 0.
  return f.text("border") === "zero" && left > 0 ? [...taps, { x: f.x, y: f.y, weight: left, port: "outside", values: [0] }] : taps;
}

/** The weights of the taps of a pixel, by the color that stands at each of them. */
function stops(f: Filter, [cx, cy]: [number, number], color: (x: number, y: number) => number[]): Weight {
  const [normal, position] = [f.input("normal"), f.input("position")];
  const isAngle = f.text("normal_measure") !== "difference";
  const isZ = f.text("surface") === "z";
  const over = (name: string) => 1 / (2 * f.number(name) ** 2);
  const [c, n] = [color(cx, cy), normal?.all(cx, cy)];
  return (x, y) => {
    if (x === cx && y === cy) return 1;
    const m = normal?.all(x, y);
    if (isZero(n) || isZero(m)) return 0; // no surface
    const way = position ? minus(position.all(x, y), position.all(cx, cy)) : [0, 0, 0];
    const distance = f.text("coord") === "world" ? dot(way) : (x - cx) ** 2 + (y - cy) ** 2;
    let e = distance * over("sigma_coord") + dot(minus(color(x, y), c)) * over("sigma_color");
    if (n && m) e += (isAngle ? angle(n, m) ** 2 : dot(minus(n, m))) * over("sigma_normal");
    if (isZ && position) e += way[2]! ** 2 * over("sigma_z");
    if (!isZ && n && position) e += planeTerm(n, way) * over("sigma_plane");
    return Math.exp(-e);
  };
}

/** Over a row, and then what rows made over the column: a tap weighs what its row does, times what it does in that. */
function separable(f: Filter, radius: number): Tap[] {
  const color = (x: number, y: number) => f.image.all(x, y);
  const rows = new Map<number, { taps: Tap[]; color: number[] }>();
  for (let y = Math.max(0, f.y - radius); y <= Math.min(f.image.height - 1, f.y + radius); ++y) {
    const weight = stops(f, [f.x, y], color);
    const [from, to] = [Math.max(0, f.x - radius), Math.min(f.image.width - 1, f.x + radius)];
    const taps = Array.from({ length: to - from + 1 }, (_, i) => ({ x: from + i, y, weight: weight(from + i, y) }));
    const sum = taps.reduce((total, tap) => total + tap.weight, 0);
    rows.set(y, { taps: taps.map((tap) => ({ ...tap, weight: tap.weight / sum })), color: mean(taps.map((tap) => ({ weight: tap.weight, values: color(tap.x, y) }))) });
  }
  const down = stops(f, [f.x, f.y], (_, y) => rows.get(y)!.color);
  return [...rows].flatMap(([y, row]) => row.taps.map((tap) => ({ ...tap, weight: tap.weight * down(f.x, y) }))).filter((tap) => tap.weight > 0);
}

/** Also of bilateral, which has none of the guides. */
export function jointBilateral(f: Filter): Tap[] {
  const radius = f.number("radius");
  if (f.is("separable")) return separable(f, radius);
  return f.window(radius, stops(f, [f.x, f.y], (x, y) => f.image.all(x, y)));
}
