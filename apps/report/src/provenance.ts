// What is needed to make the same report again.
import type { Report } from "./data";
import { find, make } from "./text";

/** As a shell reads it back. */
function quoteWord(word: string): string {
  return /^[\w@%+=:,./-]+$/.test(word) ? word : `'${word.replaceAll("'", "'\\''")}'`;
}

function copyable(text: string): HTMLElement {
  const button = make("button", { type: "button" }, "Copy");
  const pre = make("pre", { tabindex: "0" }, text);
  button.addEventListener("click", async () => {
    try {
      await navigator.clipboard.writeText(text);
      button.textContent = "Copied";
    } catch {
      getSelection()?.selectAllChildren(pre); // where a browser gives files from disk no clipboard
      button.textContent = "Selected";
    }
  });
  return make("div", { class: "copy" }, pre, button);
}

export function showProvenance(report: Report) {
  const { provenance } = report;
  const body = find("provenance-body");
  body.append(copyable(provenance.command.map(quoteWord).join(" ")));
  const facts: [string, string][] = [
    ["in the folder", provenance.folder],
    ["with", provenance.version],
    ["on", `${provenance.processor || "a processor of unknown name"}, ${provenance.processors} processors, ${provenance.threads} threads, vector unit ${provenance.isa}, ${provenance.system}`],
    ["when", provenance.made],
    ["frames", `${report.frames.length}: ${report.frames[0]}–${report.frames.at(-1)}`],
    ...provenance.inputs.map(({ input, files }): [string, string] => [`input ${input}`, files]),
  ];
  if (report.reference) facts.push(["reference", report.reference]);
  const list = make("dl");
  for (const [name, text] of facts) list.append(make("dt", {}, name), make("dd", {}, text));
  body.append(list);
  for (const graph of report.graphs) {
    const details = make("details", {}, make("summary", {}, `${graph.label}: graph and parameters`));
    details.append(make("p", {}, `hash of what it computes: `, make("code", {}, graph.hash)));
    if (graph.edits.length) details.append(make("ul", {}, ...graph.edits.map((edit) => make("li", {}, edit))));
    for (const file of graph.files) details.append(make("h4", {}, file.name), copyable(file.text));
    const rows = graph.nodes.map((node) => {
      const params = Object.entries(node.params).map(([name, value]) => `${name} = ${value}`);
      return make("tr", {}, make("th", { scope: "row" }, node.name), make("td", {}, `${node.pass} ${node.version}`), make("td", {}, params.join(", ")));
    });
    const head = make("tr", {}, ...["Node", "Pass, version", "Parameters"].map((text) => make("th", { scope: "col" }, text)));
    details.append(make("div", { class: "scroll" }, make("table", { class: "params" }, make("thead", {}, head), make("tbody", {}, ...rows))));
    body.append(details);
  }
  const licenses = document.getElementById("licenses")?.textContent;
  if (licenses) body.append(make("details", {}, make("summary", {}, "Licenses of the libraries in this page"), make("pre", { tabindex: "0" }, licenses)));
}
