// The figures of all frames, in a table that can be sorted.
import { median, type Report } from "./data";
import { bytesText, figureText, find, make, millisecondsText } from "./text";

interface Column {
  name: string;
  unit: string;
  summary: string;
  higher: boolean | null; // null: no order of worth
  text: (value: number) => string;
}
interface Row {
  name: string;
  values: (number | null)[];
}

export function graphSeconds(report: Report, index: number): number {
  const { nodes } = report.graphs[index]!;
  const frames = Math.max(0, ...nodes.map((node) => node.seconds.length));
  return median(Array.from({ length: frames }, (_, frame) => nodes.reduce((sum, node) => sum + (node.seconds[frame] ?? 0), 0)));
}

function makeTable(report: Report): { columns: Column[]; rows: Row[] } {
  const metrics = report.metrics ?? [];
  const columns: Column[] = metrics.map(({ name, unit, higher, summary }) => ({ name, unit, summary, higher, text: figureText }));
  columns.push(
    { name: "time", unit: "a frame", summary: "of all nodes of a frame, one after the other; the median of the frames", higher: false, text: millisecondsText },
    { name: "memory", unit: "planned", summary: "images of a frame and of history", higher: false, text: bytesText },
  );
  const rows: Row[] = Object.entries(report.noisy).map(([name, figures]) => ({ name: `noisy (${name})`, values: [...figures.all, null, null] }));
  report.graphs.forEach((graph, index) => {
    const outputs = Object.entries(graph.figures);
    const more = [graphSeconds(report, index), graph.memory.frame + graph.memory.history];
    for (const [output, figures] of outputs)
      rows.push({ name: outputs.length > 1 ? `${graph.label}: ${output}` : graph.label, values: [...figures.all, ...more] });
    if (outputs.length === 0) rows.push({ name: graph.label, values: [...metrics.map(() => null), ...more] });
  });
  return { columns, rows };
}

function bestOf(column: Column, values: (number | null)[]): number | null {
  const known = values.filter((value): value is number => value !== null);
  if (known.length < 2 || column.higher === null) return null;
  if (column.name === "warped") return known.reduce((a, b) => (Math.abs(b) < Math.abs(a) ? b : a)); // signed: nearest to 0
  return column.higher ? Math.max(...known) : Math.min(...known);
}

export function showFigures(report: Report) {
  const { columns, rows } = makeTable(report);
  const body = make("tbody");
  const order = { column: -1, ascending: true };
  const heads = [{ name: "image", unit: "", summary: "" }, ...columns].map((column, index) => {
    const button = make("button", { type: "button" }, column.name, ...(column.unit ? [make("small", {}, ` ${column.unit}`)] : []));
    button.addEventListener("click", () => sort(index - 1));
    return make("th", { scope: "col", title: column.summary }, button);
  });
  const fill = () => {
    const sorted = [...rows];
    if (order.column >= -1 && heads.some((head) => head.ariaSort)) {
      const sign = order.ascending ? 1 : -1;
      sorted.sort((a, b) => {
        if (order.column < 0) return sign * a.name.localeCompare(b.name);
        const [x, y] = [a.values[order.column] ?? null, b.values[order.column] ?? null];
        return x === null || y === null ? Number(x === null) - Number(y === null) : x === y ? 0 : sign * (x - y); // what is not known comes last
      });
    }
    body.replaceChildren(
      ...sorted.map((row) => {
        const cells = columns.map((column, index) => {
          const value = row.values[index] ?? null;
          const isBest = value !== null && value === bestOf(column, rows.map((other) => other.values[index] ?? null));
          const text = value === null ? "–" : column.text(value);
          return make("td", { class: "number" }, isBest ? make("b", { title: "the best" }, text) : text);
        });
        return make("tr", {}, make("th", { scope: "row" }, row.name), ...cells);
      }),
    );
  };
  const sort = (column: number) => {
    const head = heads[column + 1]!;
    const ascending = head.ariaSort !== "ascending";
    for (const other of heads) other.ariaSort = null;
    head.ariaSort = ascending ? "ascending" : "descending";
    Object.assign(order, { column, ascending });
    fill();
  };
  fill();
  const about = report.metrics
    ? `Over all frames, against ${report.reference ?? "the reference"}, as the display transform '${report.display}' shows them. The best is bold; choose a column's head to sort.`
    : "There is no reference, and so there are no figures of errors.";
  const table = make("table", { "aria-describedby": "figures-about" }, make("thead", {}, make("tr", {}, ...heads)), body);
  find("figures-body").append(make("div", { class: "scroll" }, table), make("p", { id: "figures-about", class: "quiet" }, about));
}
