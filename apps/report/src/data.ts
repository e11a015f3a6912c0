// The data of a report, as apps/quell/report_data.cpp writes it.

export type Kind = "noisy" | "reference" | "result" | "input" | "inner";

export interface ImageSeries {
  name: string; // of an inner image "node.port"
  kind: Kind;
  type: string; // of the port: "color", "normal", ...
  graph?: number;
  frames: Record<string, number>; // numbers of packed images, by frame
}

export interface Packed {
  width: number;
  height: number;
  channels: number;
  format: "f16" | "f32" | "u32";
}

export interface Metric {
  name: string;
  unit: string;
  higher: boolean;
  summary: string;
}

export interface Figures {
  all: (number | null)[]; // null: not known; in JSON "inf" is infinite
  frames: ((number | null)[] | null)[];
}

export interface NodeOutput {
  port: string;
  name: string;
  type: string;
  result?: string;
}

export interface GraphNode {
  name: string;
  pass: string;
  version: number;
  summary: string;
  doc: string;
  params: Record<string, string>;
  inputs: { port: string; from: string; delay?: number; initial?: number[] | string }[]; // initial: a constant or a source; else nothing
  resets?: boolean; // the graph may end what earlier frames left it
  outputs: NodeOutput[];
  seconds: number[]; // of each frame that ended well
}

export interface Graph {
  label: string;
  name: string;
  doc: string;
  hash: string;
  edits: string[];
  files: { name: string; text: string }[];
  nodes: GraphNode[];
  failed: string[];
  figures: Record<string, Figures>;
  seconds: number;
  read: number[];
  memory: { frame: number; history: number; unshared: number };
  drawing?: string;
  noDrawing?: string;
}

export interface Provenance {
  version: string;
  made: string;
  command: string[];
  folder: string;
  processor: string;
  system: string;
  isa: string;
  processors: number;
  threads: number;
  inputs: { input: string; files: string }[];
}

export interface Report {
  title: string;
  sequence: string;
  frames: number[];
  kept: number[];
  inner: number[];
  metrics?: Metric[];
  display?: string;
  pixelsPerDegree?: number;
  reference?: string;
  noisy: Record<string, Figures>;
  graphs: Graph[];
  images: ImageSeries[];
  packed: Packed[];
  provenance: Provenance;
}

export function readReport(): Report {
  const element = document.getElementById("report");
  if (!element) throw new Error("This page holds no report; quell report writes one.");
  const report = JSON.parse(element.textContent ?? "") as Report;
  for (const { all, frames } of [report.noisy, ...report.graphs.map((graph) => graph.figures)].flatMap((figures) => Object.values(figures)))
    for (const values of [all, ...frames]) values?.forEach((value, i) => ((value as unknown) === "inf" ? (values[i] = Infinity) : 0));
  return report;
}

/** What to call an image where those of all graphs stand together. */
export function title(report: Report, image: ImageSeries): string {
  if (image.kind === "noisy") return `noisy (${image.name})`;
  if (image.graph === undefined) return image.kind === "reference" ? image.name : `input ${image.name}`;
  const graph = report.graphs[image.graph]!;
  const results = report.images.filter((other) => other.graph === image.graph && other.kind === "result");
  return image.kind === "result" && results.length === 1 ? graph.label : `${graph.label}: ${image.name}`;
}

export function median(values: number[]): number {
  if (values.length === 0) return 0;
  const sorted = [...values].sort((a, b) => a - b);
  const middle = sorted.length >> 1;
  return sorted.length % 2 ? sorted[middle]! : (sorted[middle - 1]! + sorted[middle]!) / 2;
}
