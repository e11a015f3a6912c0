// The weights of a filter's taps at a pixel, from the formulas that the passes document (quell passes NAME), in double precision.
// They are made of what the report holds of the pass's inputs; whoever shows them compares what they give with what the pass gave.
import type { GraphNode } from "./data";
import type { Pixels } from "./pixels";

export interface Tap {
  x: number;
  y: number;
  weight: number; // all of a pixel sum to 1
}
export interface Taps {
  taps: Tap[];
  port: string; // the input that they are weights of
  output: string; // the output that the mean is
}
export interface Inputs {
  /** The images of a port: none where it is absent. */
  all(port: string): Pixels[];
}

type Weight = (qx: number, qy: number) => number;

const farAway = 1e10;
const luminanceOf = [0.2126, 0.7152, 0.0722];

class Filter {
  constructor(
    readonly node: GraphNode,
    readonly inputs: Inputs,
    readonly x: number,
    readonly y: number,
    readonly image: Pixels,
  ) {}
  number(name: string): number {
    return Number(this.node.params[name]);
  }
  text(name: string): string {
    return JSON.parse(this.node.params[name] ?? '""') as string;
  }
  input(port: string): Pixels | undefined {
    return this.inputs.all(port)[0];
  }
  inside(x: number, y: number): boolean {
    return x >= 0 && y >= 0 && x < this.image.width && y < this.image.height;
  }
  /** The window's taps that have a weight. */
  window(radius: number, weight: Weight, step = 1): Tap[] {
    const taps: Tap[] = [];
    for (let dy = -radius; dy <= radius; ++dy)
      for (let dx = -radius; dx <= radius; ++dx) {
        const [x, y] = [this.x + dx * step, this.y + dy * step];
        if (!this.inside(x, y)) continue;
        const w = weight(x, y);
        if (w > 0) taps.push({ x, y, weight: w });
      }
    return taps;
  }
  squared(image: Pixels, qx: number, qy: number): number {
    return dot(minus(image.all(qx, qy), image.all(this.x, this.y)));
  }
}

function dot(a: number[], b = a): number {
  return a.reduce((sum, value, i) => sum + value * b[i]!, 0);
}
function minus(a: number[], b: number[]): number[] {
  return a.map((value, i) => value - b[i]!);
}
function angle(a: number[], b: number[]): number {
  return Math.acos(Math.min(1, Math.max(-1, dot(a, b) / Math.sqrt(dot(a) * dot(b)))));
}
function isZero(vector: number[] | undefined): boolean {
  return vector !== undefined && dot(vector) === 0;
}

// How the weights of each pass are made; as its documentation and its test have it.

function gaussian(f: Filter): Tap[] {
  const sigma = f.number("sigma");
  const radius = f.number("radius") >= 0 ? f.number("radius") : Math.ceil(3 * sigma);
  return f.window(radius, (x, y) => Math.exp(-((x - f.x) ** 2 + (y - f.y) ** 2) / (2 * sigma ** 2)));
}

function varianceBlur(f: Filter): Tap[] | null {
  if (f.text("border") !== "renormalize") return null; // the weights of a pixel at the border do not sum to 1
  return f.window(1, (x, y) => (x === f.x ? 2 : 1) * (y === f.y ? 2 : 1));
}

/** The squared tangent-plane distance of GAMES202. */
function planeTerm(normal: number[], way: number[]): number {
  return dot(way) > 0 ? dot(normal, way) ** 2 / dot(way) : 0;
}

function jointBilateral(f: Filter): Tap[] | null {
  if (f.node.params["separable"] === "true") return null; // a mean of means, whose weights depend on the rows' results
  const [color, normal, position] = [f.input("color")!, f.input("normal"), f.input("position")];
  const isAngle = f.text("normal_measure") !== "difference";
  const isZ = f.text("surface") === "z";
  const over = (name: string) => 1 / (2 * f.number(name) ** 2);
  const n = normal?.all(f.x, f.y);
  if (isZero(n)) return f.window(0, () => 1);
  return f.window(f.number("radius"), (x, y) => {
    const m = normal?.all(x, y);
    if (isZero(m)) return 0;
    const way = position ? minus(position.all(x, y), position.all(f.x, f.y)) : [0, 0, 0];
    const distance = f.text("coord") === "world" ? dot(way) : (x - f.x) ** 2 + (y - f.y) ** 2;
    let e = distance * over("sigma_coord") + f.squared(color, x, y) * over("sigma_color");
    if (n && m) e += (isAngle ? angle(n, m) ** 2 : dot(minus(n, m))) * over("sigma_normal");
    if (isZ && position) e += way[2]! ** 2 * over("sigma_z");
    if (!isZ && n && position) e += planeTerm(n, way) * over("sigma_plane");
    return Math.exp(-e);
  });
}

function bilateral(f: Filter): Tap[] | null {
  if (f.node.params["separable"] === "true") return null;
  const [coord, color] = [f.number("sigma_coord"), f.number("sigma_color")];
  return f.window(f.number("radius"), (x, y) =>
    Math.exp(-((x - f.x) ** 2 + (y - f.y) ** 2) / (2 * coord ** 2) - f.squared(f.input("color")!, x, y) / (2 * color ** 2)),
  );
}

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
  const luminance = dot(color.all(f.x, f.y), luminanceOf);
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
    if (tolerated !== null) w *= Math.exp(-Math.abs(luminance - dot(color.all(x, y), luminanceOf)) / tolerated);
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

function atrous(f: Filter): Tap[] {
  const [normal, depth] = [f.input("normal"), f.input("depth")];
  const stops = f.text("stops");
  const counts = (x: number, y: number) => !isZero(normal?.all(x, y)) && (stops !== "svgf" || !depth || depth.at(x, y, 0) < farAway);
  if (!counts(f.x, f.y)) return f.window(0, () => 1);
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

function variance(f: Filter): Tap[] {
  const [color, length, depth, gradient, normal] = ["color", "length", "depth", "depth_gradient", "normal"].map((port) => f.input(port));
  const isShort = !length || length.at(f.x, f.y, 0) < f.number("min_length");
  const hasSurface = !depth || depth.at(f.x, f.y, 0) < farAway;
  if (f.node.params["filter_color"] !== "true" || !isShort || !hasSurface) return f.window(0, () => 1);
  const luminance = (x: number, y: number) => dot(color!.all(x, y), luminanceOf);
  return f.window(f.number("radius"), (x, y) => {
    if (depth && depth.at(x, y, 0) >= farAway) return 0;
    let e = f.number("sigma_l") > 0 ? Math.abs(luminance(x, y) - luminance(f.x, f.y)) / f.number("sigma_l") : 0;
    if (depth && gradient && (x !== f.x || y !== f.y))
      e +=
        Math.abs(depth.at(x, y, 0) - depth.at(f.x, f.y, 0)) /
        (f.number("sigma_z") * Math.max(gradient.at(f.x, f.y, 0), 1e-8) * Math.hypot(x - f.x, y - f.y));
    const cosine = normal ? Math.max(0, dot(normal.all(f.x, f.y), normal.all(x, y))) : 1;
    return Math.exp(-e) * cosine ** f.number("sigma_n");
  });
}

/** Squared central differences of all planes. */
function squaredGradient(f: Filter, feature: Pixels): number {
  const [left, right] = [Math.max(f.x - 1, 0), Math.min(f.x + 1, f.image.width - 1)];
  const [above, below] = [Math.max(f.y - 1, 0), Math.min(f.y + 1, f.image.height - 1)];
  let sum = 0;
  if (right > left) sum += dot(minus(feature.all(right, f.y), feature.all(left, f.y))) / (right - left) ** 2;
  if (below > above) sum += dot(minus(feature.all(f.x, below), feature.all(f.x, above))) / (below - above) ** 2;
  return sum;
}

function nlm(f: Filter): Tap[] {
  const [color, noise] = [f.input("color")!, f.input("variance")!];
  const isByChannel = noise.about.channels === 3;
  const [k, alpha, patch] = [f.number("k"), f.number("alpha"), f.number("patch_radius")];
  const isSymmetric = f.text("cancellation") === "symmetric";
  const values = (x: number, y: number) => (isByChannel ? color.all(x, y) : [dot(color.all(x, y), luminanceOf)]);
  const pixel = (px: number, py: number, qx: number, qy: number) => {
    const [u, t, v, w] = [values(px, py), values(qx, qy), noise.all(px, py), noise.all(qx, qy)];
    const terms = u.map((value, i) => {
      const taken = alpha * (v[i]! + (isSymmetric ? w[i]! : Math.min(v[i]!, w[i]!)));
      return ((value - t[i]!) ** 2 - taken) / (1e-10 + k * k * (v[i]! + w[i]!));
    });
    return terms.reduce((a, b) => a + b) / terms.length;
  };
  const patches = (qx: number, qy: number) => {
    let [sum, count] = [0, 0];
    for (let ny = -patch; ny <= patch; ++ny)
      for (let nx = -patch; nx <= patch; ++nx)
        if (f.inside(f.x + nx, f.y + ny) && f.inside(qx + nx, qy + ny)) {
          sum += pixel(f.x + nx, f.y + ny, qx + nx, qy + ny);
          ++count;
        }
    return sum / count;
  };
  const features = f.inputs.all("feature");
  const variances = f.inputs.all("feature_variance");
  const gradients = features.map((feature) => squaredGradient(f, feature));
  return f.window(f.number("radius"), (x, y) => {
    let e = Math.max(0, patches(x, y));
    features.forEach((feature, i) => {
      const v = variances[i]?.at(f.x, f.y, 0) ?? 0;
      const w = variances[i]?.at(x, y, 0) ?? 0;
      const explained = f.number("k_feature") ** 2 * Math.max(f.number("tau"), v, gradients[i]!);
      e = Math.max(e, (f.squared(feature, x, y) - (v + Math.min(v, w))) / explained);
    });
    return Math.exp(-e);
  });
}

const filters: Record<string, { port: string; make: (filter: Filter) => Tap[] | null }> = {
  gaussian: { port: "image", make: gaussian },
  variance_blur: { port: "variance", make: varianceBlur },
  bilateral: { port: "color", make: bilateral },
  joint_bilateral: { port: "color", make: jointBilateral },
  atrous: { port: "color", make: atrous },
  variance: { port: "color", make: variance },
  nlm: { port: "color", make: nlm },
};

export const filterNames = Object.keys(filters);

/** Whether a node's weights can be told, its parameters permitting. */
export function isFilter(node: GraphNode): boolean {
  return filters[node.pass] !== undefined;
}

/** Nothing where the pass is no weighted mean of one image, or its weights cannot be told. */
export function findTaps(node: GraphNode, inputs: Inputs, x: number, y: number): Taps | null {
  const filter = filters[node.pass];
  const image = filter && inputs.all(filter.port)[0];
  if (!filter || !image || x >= image.width || y >= image.height) return null;
  const taps = filter.make(new Filter(node, inputs, x, y, image));
  if (!taps || taps.length === 0) return null;
  const sum = taps.reduce((total, tap) => total + tap.weight, 0);
  return { taps: taps.map((tap) => ({ ...tap, weight: tap.weight / sum })), port: filter.port, output: filter.port };
}

/** What the weights make of the image. */
export function apply(taps: Tap[], image: Pixels): number[] {
  return Array.from({ length: image.about.channels }, (_, c) => taps.reduce((sum, tap) => sum + tap.weight * image.at(tap.x, tap.y, c), 0));
}
