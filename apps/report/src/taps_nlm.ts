// Non-local means, as the pass's documentation and test have them.
import { dot, type Filter, luminance, minus, type Tap } from "./filter";
import type { Pixels } from "./pixels";

/** Squared central differences of all planes. */
function squaredGradient(f: Filter, feature: Pixels): number {
  const [left, right] = [Math.max(f.x - 1, 0), Math.min(f.x + 1, f.image.width - 1)];
  const [above, below] = [Math.max(f.y - 1, 0), Math.min(f.y + 1, f.image.height - 1)];
  let sum = 0;
  if (right > left) sum += dot(minus(feature.all(right, f.y), feature.all(left, f.y))) / (right - left) ** 2;
  if (below > above) sum += dot(minus(feature.all(f.x, below), feature.all(f.x, above))) / (below - above) ** 2;
  return sum;
}

export function nlm(f: Filter): Tap[] {
  const [color, noise] = [f.input("color")!, f.input("variance")!];
  const isByChannel = noise.about.channels === 3;
  const [k, alpha, patch] = [f.number("k"), f.number("alpha"), f.number("patch_radius")];
  const isSymmetric = f.text("cancellation") === "symmetric";
  const values = (x: number, y: number) => (isByChannel ? color.all(x, y) : [luminance(color.all(x, y))]);
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
  const features = f.inputs.list("feature").filter((image) => image !== null);
  const variances = f.inputs.list("feature_variance");
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

