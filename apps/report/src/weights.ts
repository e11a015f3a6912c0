// The weights of a filter's taps, as a picture and in words.
import { interpolateViridis } from "d3-scale-chromatic";
import type { Taps } from "./taps";
import { make, valueText } from "./text";

const kMostListed = 8;

/** Each tap as a square, brighter the more it weighs; the pixel itself has a frame. */
function drawTaps({ taps }: Taps, [x, y]: [number, number]): HTMLElement {
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
    context.fillStyle = interpolateViridis(tap.weight / most);
    context.fillRect(place[0], place[1], cell - (cell > 6 ? 1 : 0), cell - (cell > 6 ? 1 : 0));
  }
  context.strokeStyle = "#f33";
  context.lineWidth = 2;
  context.strokeRect(((side - 1) / 2) * cell, ((side - 1) / 2) * cell, cell, cell);
  return canvas;
}

function listTaps({ taps }: Taps, [x, y]: [number, number]): HTMLElement {
  const heaviest = [...taps].sort((a, b) => b.weight - a.weight).slice(0, kMostListed);
  const signed = (value: number) => (value > 0 ? `+${value}` : String(value).replace("-", "−"));
  const rows = heaviest.map((tap) =>
    make("tr", {}, make("td", {}, `${signed(tap.x - x)}, ${signed(tap.y - y)}`), make("td", { class: "number" }, `${(100 * tap.weight).toFixed(3)} %`)),
  );
  const head = make("tr", {}, make("th", { scope: "col" }, "from the pixel"), make("th", { scope: "col" }, "weight"));
  return make("table", {}, make("thead", {}, head), make("tbody", {}, ...rows));
}

export function describeWeights(taps: Taps, at: [number, number], made: number[], given: number[]): HTMLElement {
  const sum = taps.taps.reduce((total, tap) => total + tap.weight, 0);
  const off = Math.max(...made.map((value, i) => Math.abs(value - given[i]!)));
  const words = `They sum to ${sum.toFixed(6)} and make ${made.map(valueText).join("  ")} of '${taps.port}'; the pass gave ${given
    .map(valueText)
    .join("  ")}: ${off === 0 ? "the same" : `${off.toExponential(1).replace("-", "−")} apart`}.`;
  return make("div", { class: "taps" }, drawTaps(taps, at), listTaps(taps, at), make("p", {}, words));
}
