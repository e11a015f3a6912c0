// The edge-avoiding wavelet and the filtered color of variance, as the passes' documentation and tests have them.
import { angle, dot, farAway, type Filter, isZero, luminance, minus, planeTerm, type Tap, type Weight } from "./filter";
import type { Pixels } from "./pixels";

/** Of the depth along an axis: the smaller of the differences to the neighbors that have a surface. */
function slope(f: Filter, depth: Pixels, ax: number, ay: number): number {
  let smaller = Infinity;
  for (const side of [-1, 1]) {
    const [x, y] = [f.x + side * ax, f.y + side * ay];
    if (!f.inside(x, y) || depth.at(x, y, 0) >= farAway) continue;
    const change = side * (depth.at(x, y, 0) - depth.at(f.x, f.y, 0));
    if (Math.abs(change) < Math.abs(smaller)) smaller = change;
  }
  return Number.isFinite(smaller) ? smaller : 0;
}

function blurredVariance(f: Filter, variance: Pixels): number {
  let [sum, weights] = [0, 0];
  for (let y = f.y - 1; y <= f.y + 1; ++y)
    for (let x = f.x - 1; x <= f.x + 1; ++x) {
      if (!f.inside(x, y)) continue;
      const w = (x === f.x ? 2 : 1) * (y === f.y ? 2 : 1);
      sum += w * variance.at(x, y, 0);
      weights += w;
    }
  return sum / weights;
}

function svgfStops(f: Filter): Weight {
  const [color, normal, depth, gradient] = [f.input("color")!, f.input("normal"), f.input("depth"), f.input("depth_gradient")];
  const [variance, blurred] = [f.input("variance"), f.input("blurred_variance")];
  const spread = blurred ? blurred.at(f.x, f.y, 0) : variance ? blurredVariance(f, variance) : null;
  const tolerated = spread === null ? null : f.number("sigma_l") * Math.sqrt(spread + f.number("eps_variance")) + f.number("eps_l");
  const own = luminance(color.all(f.x, f.y));
  return (x, y) => {
    let w = 1;
    if (depth) {
      const z = depth.at(f.x, f.y, 0);
      const explained = gradient
        ? gradient.at(f.x, f.y, 0) * Math.hypot(x - f.x, y - f.y)
        : Math.abs(slope(f, depth, 1, 0) * (x - f.x) + slope(f, depth, 0, 1) * (y - f.y));
      w *= Math.exp(-Math.abs(z - depth.at(x, y, 0)) / (f.number("sigma_z") * explained + f.number("eps_z") * z));
    }
    if (normal) w *= Math.max(0, dot(normal.all(f.x, f.y), normal.all(x, y))) ** f.number("sigma_n");
    if (tolerated !== null) w *= Math.exp(-Math.abs(own - luminance(color.all(x, y))) / tolerated);
    return w;
  };
}

function dammertzStops(f: Filter): Weight {
  const [color, normal, position] = [f.input("color")!, f.input("normal"), f.input("position")];
  const level = f.number("level");
  const halvings = { same: 0, halved: 1, quartered: 2 }[f.text("phi_color_per_level")] ?? 2;
  return (x, y) => {
    let e = f.squared(color, x, y) / (f.number("phi_color") * 0.5 ** (halvings * level));
    if (normal) e += f.squared(normal, x, y) / 4 ** level / f.number("phi_normal");
    if (position) e += f.squared(position, x, y) / f.number("phi_position");
    return Math.exp(-e);
  };
}

function gamesStops(f: Filter): Weight {
  const [color, normal, position] = [f.input("color")!, f.input("normal"), f.input("position")];
  const over = (name: string) => 1 / (2 * f.number(name) ** 2);
  return (x, y) => {
    let e = ((x - f.x) ** 2 + (y - f.y) ** 2) * over("sigma_coord") + f.squared(color, x, y) * over("sigma_color");
    if (normal) e += angle(normal.all(f.x, f.y), normal.all(x, y)) ** 2 * over("sigma_normal");
    if (normal && position) e += planeTerm(normal.all(f.x, f.y), minus(position.all(x, y), position.all(f.x, f.y))) * over("sigma_plane");
    return Math.exp(-e);
  };
}

export function atrous(f: Filter): Tap[] {
  const [normal, depth] = [f.input("normal"), f.input("depth")];
  const stops = f.text("stops");
  const counts = (x: number, y: number) => !isZero(normal?.all(x, y)) && (stops !== "svgf" || !depth || depth.at(x, y, 0) < farAway);
  if (!counts(f.x, f.y)) return f.alone();
  const stop = stops === "svgf" ? svgfStops(f) : stops === "dammertz" ? dammertzStops(f) : gamesStops(f);
  const spline = [3 / 8, 1 / 4, 1 / 16];
  const step = 2 ** f.number("level");
  const weight: Weight = (x, y) => {
    if (!counts(x, y)) return 0;
    const h = spline[Math.abs(x - f.x) / step]! * spline[Math.abs(y - f.y) / step]!;
    return h * (x === f.x && y === f.y ? 1 : stop(x, y));
  };
  return f.window(2, weight, step);
}

export function variance(f: Filter): Tap[] {
  const [color, length, depth, gradient, normal] = ["color", "length", "depth", "depth_gradient", "normal"].map((port) => f.input(port));
  const isShort = !length || length.at(f.x, f.y, 0) < f.number("min_length");
  const hasSurface = !depth || depth.at(f.x, f.y, 0) < farAway;
  if (!f.is("filter_color") || !isShort || !hasSurface) return f.alone();
  return f.window(f.number("radius"), (x, y) => {
    if (depth && depth.at(x, y, 0) >= farAway) return 0;
    let e = f.number("sigma_l") > 0 ? Math.abs(luminance(color!.all(x, y)) - luminance(color!.all(f.x, f.y))) / f.number("sigma_l") : 0;
    if (depth && gradient && (x !== f.x || y !== f.y))
      e +=
        Math.abs(depth.at(x, y, 0) - depth.at(f.x, f.y, 0)) /
        (f.number("sigma_z") * Math.max(gradient.at(f.x, f.y, 0), 1e-8) * Math.hypot(x - f.x, y - f.y));
    const cosine = normal ? Math.max(0, dot(normal.all(f.x, f.y), normal.all(x, y))) : 1;
    return Math.exp(-e) * cosine ** f.number("sigma_n");
  });
}

