// The weights of a filter's taps, as a picture and in words.
import { interpolateViridis } from "d3-scale-chromatic";
import type { Taps } from "./taps";
import { make, valueText } from "./text";

export type Weights = Taps & { given: number[] };

const kMostListed = 8;

/** Each tap as a square, brighter the more it weighs, red where that is below 0; the pixel itself has a frame. */
function drawTaps({ taps, center: [x, y] }: Taps): HTMLElement {
  const reach = Math.max(1, ...taps.map((tap) => Math.max(Math.abs(tap.x - x), Math.abs(tap.y - y))));
  // Where taps are apart, the steps between them are left out.
  const apart = taps.map((tap) => Math.max(Math.abs(tap.x - x), Math.abs(tap.y - y))).filter((distance) => distance > 0);
  const step = apart.length ? Math.min(...apart) : 1;
  const side = 2 * Math.ceil(reach / step) + 1;
  const cell = Math.max(3, Math.min(22, Math.floor(240 / side)));
  const canvas = make("canvas", { role: "img", "aria-label": `weights of ${taps.length} taps, ${side} by ${side}, ${step} pixels apart` });
  canvas.width = canvas.height = side * cell;
  const context = canvas.getContext("2d")!;
  const most = Math.max(...taps.map((tap) => tap.weight));
  for (const tap of taps) {
    const place = [tap.x - x, tap.y - y].map((offset) => (offset / step + (side - 1) / 2) * cell) as [number, number];
    context.fillStyle = tap.weight < 0 ? "#b00020" : interpolateViridis(tap.weight / most);
    context.fillRect(place[0], place[1], cell - (cell > 6 ? 1 : 0), cell - (cell > 6 ? 1 : 0));
  }
  context.strokeStyle = "#f33";
  context.lineWidth = 2;
  context.strokeRect(((side - 1) / 2) * cell, ((side - 1) / 2) * cell, cell, cell);
  return canvas;
}

/** Taps of several images lie in one place: what differs is whose they are. */
function listTaps({ taps, center: [x, y] }: Taps, hasImages: boolean): HTMLElement {
  const heaviest = [...taps].sort((a, b) => b.weight - a.weight).slice(0, kMostListed);
  const signed = (value: number) => (value > 0 ? `+${value}` : String(value).replace("-", "−"));
  const rows = heaviest.map((tap) => {
    const what = hasImages ? tap.port : `${signed(tap.x - x)}, ${signed(tap.y - y)}`;
    const weight = make("td", { class: "number" }, `${(100 * tap.weight).toFixed(3).replace("-", "−")} %`);
    return make("tr", {}, make("td", {}, what), weight, ...(hasImages ? [make("td", { class: "number" }, tap.values.map(valueText).join("  "))] : []));
  });
  const heads = hasImages ? ["image", "weight", "value"] : ["from the center", "weight"];
  const head = make("tr", {}, ...heads.map((text) => make("th", { scope: "col" }, text)));
  return make("table", {}, make("thead", {}, head), make("tbody", {}, ...rows));
}

/** How far what they make is from what the pass gave. */
function difference({ made, given }: Weights): string {
  const off = Math.max(...made.map((value, i) => Math.abs(value - given[i]!)));
  return off === 0 ? "the same" : `${off.toExponential(1).replace("-", "−")} apart`;
}

export function describeWeights(weights: Weights): HTMLElement {
  const { taps, port, center, made, given, isLimited } = weights;
  const sum = taps.reduce((total, tap) => total + tap.weight, 0);
  const hasImages = taps.some((tap) => tap.port !== port && tap.port !== "outside");
  const what = hasImages ? "" : ` of '${port}' around x ${center[0]}, y ${center[1]}`;
  const words = `They sum to ${sum.toFixed(6)} and make ${made.map(valueText).join("  ")}${what}${isLimited ? ", after it was limited or scaled" : ""}; the pass gave ${given
    .map(valueText)
    .join("  ")}: ${difference(weights)}.`;
  return make("div", { class: "taps" }, ...(hasImages ? [] : [drawTaps(weights)]), listTaps(weights, hasImages), make("p", {}, words));
}
