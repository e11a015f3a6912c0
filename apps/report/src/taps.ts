// The weights of a filter's taps at a pixel, from the formulas that the passes document (quell passes NAME), in double precision.
// They are made of what the report holds of the pass's inputs; whoever shows them compares what they give with what the pass gave.
import type { GraphNode } from "./data";
import { Filter, type Found, type Inputs, mean, type Tap } from "./filter";
import means from "./means.json";
import type { Pixels } from "./pixels";
import { gaussian, jointBilateral, varianceBlur } from "./taps_blur";
import { nlm } from "./taps_nlm";
import { mix, reproject, scale } from "./taps_place";
import { historyFix, moments, taa, temporalBlend, window } from "./taps_time";
import { atrous, variance } from "./taps_wavelet";

export interface Taps {
  taps: Required<Tap>[]; // whose weights sum to 1
  port: string; // the input that they are weights of
  center: [number, number]; // about which they lie
  made: number[]; // what the weights make of the values
  isLimited: boolean; // afterwards, to what neighbors make plausible
}

interface Mean {
  port: string; // that it is a mean of
  output?: string; // that is the mean; of the same name where none is told
}
/** Passes that are means. quell keeps exactly what these read and yield: the file is built into it, too. */
const filters: Record<string, Mean> = means;

/** The weights of each of them. */
const makers: Record<keyof typeof means, (filter: Filter) => Found> = {
  atrous,
  bilateral: jointBilateral,
  gaussian,
  history_fix: historyFix,
  joint_bilateral: jointBilateral,
  mix,
  moments,
  nlm,
  reproject,
  scale,
  taa,
  temporal_blend: temporalBlend,
  variance,
  variance_blur: varianceBlur,
  window,
};

/** Why other passes that look around or back have no weights. */
const unweighted: Record<string, string> = {
  antilag: "it yields how far a history is trusted, which is no mean",
  depth_gradient: "it yields a difference of neighbors, not a mean",
  dual_motion: "it yields where to look for a history, which is no mean",
  exposure: "it yields one number of the whole frame, by way of logarithms",
  fast_history_clamp: "it limits a history, and weighs nothing",
  firefly: "a pixel is kept, scaled or replaced, not made a mean",
  normal_gradient: "it yields a difference of neighbors, not a mean",
  percentile_alpha: "it yields a share by the order of values in blocks, which is no mean",
  regress: "each block is fitted by least squares, with noise on its features, and kept from below 0: its pixels have no weights of their own",
};
/** Passes that make a pixel of what stands at that pixel alone: there is nothing to weigh. */
const pointwise = [
  "back_project", "demodulate", "luminance", "merge", "modulate", "motion", "previous_position", "sanitize", "split", "tonemap", "tonemap_ocio", "validate",
];

/** For tests: the passes that have weights, and all others that are known here. */
export const passNames = { weighted: Object.keys(filters), unweighted: [...Object.keys(unweighted), ...pointwise] };

/** The output whose weights can be told: nothing for passes without weights, a reason where they are missed. */
export function meanOf(node: GraphNode): { output: string } | { why: string } | null {
  const filter = filters[node.pass];
  if (filter) return { output: filter.output ?? filter.port };
  const why = unweighted[node.pass];
  return why ? { why } : null;
}

/** The weights at a pixel of what the node yields, an image of that size; or why there are none. */
export function findTaps(node: GraphNode, inputs: Inputs, [x, y]: [number, number], size: Pixels): Taps | string {
  const { port } = filters[node.pass]!;
  const image = inputs.list(port)[0];
  if (!image) return `there is no '${port}' in this frame`;
  const found = makers[node.pass as keyof typeof means](new Filter(node, inputs, x, y, image, size));
  if (typeof found === "string") return found;
  const { taps, center, limit } = Array.isArray(found) ? { taps: found, center: undefined, limit: undefined } : found;
  const sum = taps.reduce((total, tap) => total + tap.weight, 0);
  const full = taps.map((tap) => ({ port, ...tap, values: tap.values ?? image.all(tap.x, tap.y), weight: tap.weight / sum }));
  const plain = mean(full);
  const made = limit ? limit(plain) : plain;
  return { taps: full, port, center: center ?? [x, y], made, isLimited: made.some((value, c) => value !== plain[c]) };
}
