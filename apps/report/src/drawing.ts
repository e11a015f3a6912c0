// The graphs as Graphviz drew them, with the time of each node.
import { type Graph, median, type Report } from "./data";
import { find, make, millisecondsText } from "./text";

/** An SVG from text, without anything that runs or leads elsewhere. */
function readSvg(text: string): SVGSVGElement | null {
  const root = new DOMParser().parseFromString(text, "image/svg+xml").documentElement;
  if (root.localName !== "svg") return null;
  for (const element of [root, ...root.querySelectorAll("*")]) {
    if (element.localName === "script" || element.localName === "foreignObject") element.remove();
    for (const attribute of [...element.attributes])
      if (/^on/i.test(attribute.name) || /href$/i.test(attribute.name)) element.removeAttribute(attribute.name);
  }
  return document.importNode(root, true) as unknown as SVGSVGElement;
}

function addTimes(svg: SVGSVGElement, graph: Graph) {
  const times = new Map(graph.nodes.map((node) => [node.name, median(node.seconds)]));
  const most = Math.max(...times.values(), 1e-9);
  for (const group of svg.querySelectorAll<SVGGElement>("g.node")) {
    const name = group.querySelector("title")?.textContent ?? "";
    const seconds = times.get(name);
    if (seconds === undefined) continue;
    const box = group.getBBox();
    const text = document.createElementNS("http://www.w3.org/2000/svg", "text");
    text.setAttribute("x", String(box.x + box.width / 2));
    text.setAttribute("y", String(box.y - 4));
    text.setAttribute("text-anchor", "middle");
    text.setAttribute("font-size", "10");
    text.setAttribute("font-family", "Helvetica,Arial,sans-serif");
    text.setAttribute("fill", seconds > most / 2 ? "#b00020" : "#444");
    text.setAttribute("font-weight", seconds > most / 2 ? "bold" : "normal");
    text.textContent = millisecondsText(seconds);
    text.classList.add("time");
    group.append(text);
  }
}

export function showDrawings(report: Report) {
  for (const graph of report.graphs) {
    const place = make("div", { class: "scroll drawing fit", tabindex: "0", role: "region", "aria-label": `drawing of ${graph.label}` });
    const fit = make("button", { type: "button", "aria-pressed": "true" }, "Fit to the width");
    fit.addEventListener("click", () => fit.setAttribute("aria-pressed", String(place.classList.toggle("fit"))));
    const head = make("div", { class: "row" }, make("h3", {}, graph.label), fit);
    find("drawings-body").append(head, ...(graph.doc ? [make("p", {}, graph.doc)] : []), place);
    const svg = graph.drawing ? readSvg(graph.drawing) : null;
    if (!svg) {
      fit.hidden = true;
      const nodes = graph.nodes.map((node) => make("li", {}, `${node.name} (${node.pass}): ${millisecondsText(median(node.seconds))}`));
      place.append(make("p", {}, `There is no drawing: ${graph.noDrawing ?? "it cannot be read"}`), make("ol", {}, ...nodes));
      continue;
    }
    svg.setAttribute("role", "img");
    svg.setAttribute("aria-label", `nodes of ${graph.label}: ${graph.nodes.map((node) => node.name).join(", ")}`);
    place.append(svg);
    addTimes(svg, graph);
  }
}
