// The keyboard.
import type { Actions } from "./actions";
import type { Stage } from "./stage";
import { numbered, type Store } from "./state";

type Acts = Record<string, () => void>;

function listActs(actions: Actions, stage: Stage, store: Store): Acts {
  const zoomBy = (factor: number) => () => stage.zoom((view) => view.zoomTo(view.zoom * factor));
  return {
    x: () => actions.exchange(),
    w: () => actions.setMode("wipe"),
    s: () => actions.setMode("side"),
    l: () => actions.setMode("left"),
    d: () => actions.setMode("difference"),
    f: () => actions.setMode("flip"),
    e: () => actions.setMode("errors"),
    p: () => actions.play(),
    ",": () => actions.step(-1),
    ".": () => actions.step(1),
    "[": () => actions.setExposure(store.state.exposure - 0.5),
    "]": () => actions.setExposure(store.state.exposure + 0.5),
    "+": zoomBy(2),
    "=": zoomBy(2),
    "-": zoomBy(1 / 2),
    "0": () => stage.zoom((view) => view.fit()),
  };
}

/** Whether the key chose a pixel. */
function movePixel(event: KeyboardEvent, { view }: Stage, store: Store): boolean {
  const steps: Record<string, [number, number]> = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] };
  const step = steps[event.key];
  if (!step) return false;
  const [x, y] = store.state.pixel ?? [view.width >> 1, view.height >> 1];
  const by = store.state.pixel ? (event.shiftKey ? 10 : 1) : 0;
  const pixel: [number, number] = [
    Math.max(0, Math.min(view.width - 1, x + by * step[0])),
    Math.max(0, Math.min(view.height - 1, y + by * step[1])),
  ];
  view.show(...pixel);
  store.set({ pixel });
  return true;
}

export function listenToKeys(actions: Actions, stage: Stage, store: Store) {
  const acts = listActs(actions, stage, store);
  const isTaken = (event: KeyboardEvent): boolean => {
    const digit = /^(?:Digit|Numpad)([1-9])$/.exec(event.code)?.[1];
    if (digit && !event.getModifierState("AltGraph")) {
      const index = numbered(store.report)[Number(digit) - 1];
      if (index !== undefined) actions.choose(event.shiftKey ? "right" : "left", index);
      return index !== undefined;
    }
    const act = acts[event.key.toLowerCase()];
    if (act) act();
    return act !== undefined || (event.target === stage.canvas && movePixel(event, stage, store));
  };
  document.addEventListener("keydown", (event) => {
    // Behind AltGr, which Windows tells as Ctrl and Alt, other keyboards have [ and ].
    if (event.metaKey || ((event.ctrlKey || event.altKey) && !event.getModifierState("AltGraph"))) return;
    const { target } = event; // of an event made by a script it may be the document, which matches nothing
    if (target instanceof Element && target.matches("select, textarea, input:not([type=range]):not([type=radio])")) return;
    if (isTaken(event)) event.preventDefault();
  });
}
