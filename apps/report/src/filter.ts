// What the weights of filters are told by: the inputs of a node, and the pixel.
import type { GraphNode } from "./data";
import type { Pixels } from "./pixels";

export interface Tap {
  x: number;
  y: number;
  weight: number;
  port?: string; // whose pixel it is, where that is not the filter's image: "history", "frames[1]"
  values?: number[]; // that are weighed, where they are not the pixel's own: a history that was limited
}
export interface Inputs {
  /** The images of a port; null for one that is not there in this frame, as a history is in the first. */
  list(port: string): (Pixels | null)[];
  /** Of the port: "color", "motion", ... */
  type(port: string): string;
}
/** What a filter makes of a pixel, or why that has no weights. */
export type Found = Tap[] | { taps: Tap[]; center?: [number, number]; limit?: (values: number[]) => number[] } | string;
export type Weight = (qx: number, qy: number) => number;

export const farAway = 1e10; // the depth of no surface
const luminanceOf = [0.2126, 0.7152, 0.0722];

export class Filter {
  constructor(
    readonly node: GraphNode,
    readonly inputs: Inputs,
    readonly x: number, // of what it yields
    readonly y: number,
    readonly image: Pixels, // that it is a mean of
    readonly size: { width: number; height: number } = image, // of what it yields
  ) {}
  number(name: string): number {
    return Number(this.node.params[name]);
  }
  text(name: string): string {
    return JSON.parse(this.node.params[name] ?? '""') as string;
  }
  is(name: string): boolean {
    return this.node.params[name] === "true";
  }
  input(port: string): Pixels | undefined {
    return this.inputs.list(port)[0] ?? undefined;
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
  alone(): Tap[] {
    return [{ x: this.x, y: this.y, weight: 1 }];
  }
  /** Of one plane at the pixel; nothing without the image. */
  own(port: string): number | undefined {
    return this.input(port)?.at(this.x, this.y, 0);
  }
  squared(image: Pixels, qx: number, qy: number): number {
    return dot(minus(image.all(qx, qy), image.all(this.x, this.y)));
  }
}

export function dot(a: number[], b = a): number {
  return a.reduce((sum, value, i) => sum + value * b[i]!, 0);
}
export function minus(a: number[], b: number[]): number[] {
  return a.map((value, i) => value - b[i]!);
}
export function luminance(color: number[]): number {
  return dot(color, luminanceOf);
}
export function angle(a: number[], b: number[]): number {
  return Math.acos(Math.min(1, Math.max(-1, dot(a, b) / Math.sqrt(dot(a) * dot(b)))));
}
export function isZero(vector: number[] | undefined): boolean {
  return vector !== undefined && dot(vector) === 0;
}
/** The squared tangent-plane distance of GAMES202. */
export function planeTerm(normal: number[], way: number[]): number {
  return dot(way) > 0 ? dot(normal, way) ** 2 / dot(way) : 0;
}
/** Sums of values by weights that need not sum to 1. */
export function mean(weighed: { weight: number; values: number[] }[]): number[] {
  const total = weighed.reduce((sum, { weight }) => sum + weight, 0);
  return weighed[0]!.values.map((_, c) => weighed.reduce((sum, { weight, values }) => sum + weight * values[c]!, 0) / total);
}
