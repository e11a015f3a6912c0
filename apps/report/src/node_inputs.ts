// What a node of a graph read in a frame, as far as the report holds it.
import type { Graph, ImageSeries, NodeOutput, Report } from "./data";
import type { GraphNode } from "./data";
import type { Inputs } from "./filter";
import { Pixels, type PixelStore } from "./pixels";

export function imageOf(report: Report, graph: number, output: NodeOutput): ImageSeries | undefined {
  const name = output.result ?? output.name;
  const kind = output.result ? "result" : "inner";
  return report.images.find((image) => image.graph === graph && image.kind === kind && image.name === name);
}

/** What a source of the graph yields. */
function sourceOf(report: Report, graph: number, from: string): ImageSeries | undefined {
  const output = report.graphs[graph]!.nodes.flatMap((node) => node.outputs).find((other) => other.name === from);
  if (output) return imageOf(report, graph, output);
  return report.images.find((image) => (image.kind === "noisy" || image.kind === "input") && image.name === from);
}

function isComputed(report: Report, graph: Graph, frame: number): boolean {
  return report.frames.includes(frame) && !graph.failed.some((text) => text.startsWith(`frame ${frame}: `));
}

function constant(values: number[], like: Pixels): Pixels {
  const size = like.width * like.height;
  const channels = like.about.channels;
  const data = Float32Array.from({ length: size * channels }, (_, i) => values[values.length === 1 ? 0 : Math.floor(i / size)]!);
  return new Pixels({ ...like.about, format: "f32" }, data);
}

/** Every image input; or why one of them is not here. Cameras and values are left out: no weights are made of them. */
export async function readInputs(report: Report, store: PixelStore, index: number, node: GraphNode, frame: number): Promise<Inputs | string> {
  const graph = report.graphs[index]!;
  const ports = new Map<string, { type: string; images: (Pixels | null)[] }>();
  const add = (port: string, type: string, image: Pixels | null) => {
    const list = ports.get(port) ?? { type, images: [] };
    list.images.push(image);
    ports.set(port, list);
  };
  for (const { port, from, delay = 0, initial } of node.inputs) {
    const source = sourceOf(report, index, from);
    if (!source) continue;
    if (delay && node.resets) return "the graph may end the history of this frame (reset), which the report does not hold";
    const then = frame - delay;
    if (isComputed(report, graph, then)) {
      const number = source.frames[then];
      if (number === undefined && !delay) continue;
      if (number === undefined) return `'${from}' of frame ${then} is not in this report`;
      add(port, source.type, await store.get(number));
    } else if (initial === undefined) {
      add(port, source.type, null);
    } else {
      const number = (typeof initial === "string" ? sourceOf(report, index, initial) : source)?.frames[frame];
      if (number === undefined) return `'${from}' of frame ${frame} is not in this report`;
      const image = await store.get(number);
      add(port, source.type, typeof initial === "string" ? image : constant(initial, image));
    }
  }
  return { list: (port) => ports.get(port)?.images ?? [], type: (port) => ports.get(port)?.type ?? "" };
}
