// Numbers and elements as text.

/** Five significant digits, and powers of ten where they are shorter. */
export function valueText(value: number): string {
  if (!Number.isFinite(value)) return Number.isNaN(value) ? "NaN" : value > 0 ? "∞" : "−∞";
  if (value === 0) return "0";
  const size = Math.abs(value);
  const text = Number.isInteger(value) && size < 1e9 ? String(value) : size >= 1e6 || size < 1e-4 ? value.toExponential(4) : value.toPrecision(5);
  return text.replace("-", "−");
}

export function figureText(value: number | null | undefined): string {
  if (value === null || value === undefined) return "–";
  if (!Number.isFinite(value)) return valueText(value);
  const size = Math.abs(value);
  return value.toFixed(size >= 10 ? 2 : size >= 0.1 ? 4 : 5).replace("-", "−");
}

export function millisecondsText(seconds: number): string {
  const ms = seconds * 1000;
  return `${ms.toFixed(ms < 9.995 ? 2 : ms < 99.95 ? 1 : 0)} ms`;
}

export function bytesText(bytes: number): string {
  return bytes < 1e6 ? `${(bytes / 1024).toFixed(0)} KiB` : `${(bytes / 1048576).toFixed(1)} MiB`;
}

type Child = Node | string;

/** An element; attributes are set, never parsed, so that no text becomes markup. */
export function make<Tag extends keyof HTMLElementTagNameMap>(
  tag: Tag,
  attributes: Record<string, string> = {},
  ...children: Child[]
): HTMLElementTagNameMap[Tag] {
  const element = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) element.setAttribute(name, value);
  element.append(...children);
  return element;
}

export function find<T extends HTMLElement>(id: string): T {
  const element = document.getElementById(id);
  if (!element) throw new Error(`the page lacks #${id}`);
  return element as T;
}
