// The controls around the images: what there is to choose, and what is chosen.
import type { Actions } from "./actions";
import { type ImageSeries, type Report, title } from "./data";
import type { Stage } from "./stage";
import { type Mode, numbered, referenceOf, type State, type Store } from "./state";
import { find, make } from "./text";
import { displayRatio } from "./view";

function fillChoices(report: Report) {
  const groups: [string, (image: ImageSeries) => boolean][] = [
    ["Sequence", (image) => image.kind === "noisy" || image.kind === "reference"],
    ["Results", (image) => image.kind === "result"],
    ...report.graphs.map((graph, index): [string, (image: ImageSeries) => boolean] => [
      `Inner images of ${graph.label}`,
      (image) => image.kind === "inner" && image.graph === index,
    ]),
    ["Other inputs", (image) => image.kind === "input"],
  ];
  for (const id of ["left", "right"]) {
    const select = find<HTMLSelectElement>(id);
    for (const [label, isIn] of groups) {
      const group = make("optgroup", { label });
      report.images.forEach((image, index) => {
        if (isIn(image)) group.append(make("option", { value: String(index) }, title(report, image)));
      });
      if (group.children.length) select.append(group);
    }
  }
}

export function fillControls(report: Report, actions: Actions) {
  fillChoices(report);
  numbered(report).forEach((index, place) => {
    const button = make("button", { type: "button", "data-image": String(index) }, make("kbd", {}, String(place + 1)));
    button.append(" " + title(report, report.images[index]!));
    button.addEventListener("click", (event) => actions.choose(event.shiftKey ? "right" : "left", index));
    find("numbers").append(make("li", {}, button));
  });
  const frame = find<HTMLInputElement>("frame");
  frame.max = String(report.kept.length - 1);
  frame.disabled = find<HTMLButtonElement>("play").disabled = report.kept.length < 2;
  if (referenceOf(report)) return;
  const errors = document.querySelector<HTMLInputElement>("#modes input[value=errors]")!;
  errors.disabled = true;
  errors.parentElement!.title = "There is no reference.";
}

export function listenToControls(store: Store, actions: Actions, stage: Stage) {
  const listen = (id: string, event: string, act: (element: HTMLInputElement) => void) => {
    const element = find<HTMLInputElement>(id);
    element.addEventListener(event, () => act(element));
  };
  listen("left", "change", (select) => actions.choose("left", Number(select.value)));
  listen("right", "change", (select) => actions.choose("right", Number(select.value)));
  listen("exchange", "click", () => actions.exchange());
  for (const radio of document.querySelectorAll<HTMLInputElement>("#modes input"))
    radio.addEventListener("change", () => actions.setMode(radio.value as Mode));
  listen("play", "click", () => actions.play());
  listen("frame", "input", (range) => store.set({ frame: store.report.kept[Number(range.value)]! }));
  listen("exposure", "input", (range) => actions.setExposure(Number(range.value)));
  listen("wipe", "input", (range) => store.set({ wipe: Number(range.value) / 100 }));
  listen("fit", "click", () => stage.zoom((view) => view.fit()));
  listen("actual", "click", () => stage.zoom((view) => view.zoomTo(1 / displayRatio())));
  listen("zoom-in", "click", () => stage.zoom((view) => view.zoomTo(view.zoom * 2)));
  listen("zoom-out", "click", () => stage.zoom((view) => view.zoomTo(view.zoom / 2)));
}

/** What stands over the picture, one text or two, and what is said of it. */
function showNames(report: Report, { left, right, mode, frame }: State) {
  const [a, b] = [left, right].map((index) => title(report, report.images[index]!)) as [string, string];
  const tags: Record<Mode, string[]> = {
    wipe: [a, b],
    side: [a, b],
    left: [a],
    difference: [`| ${a} − ${b} |`],
    flip: [`FLIP of ${a} and ${b}`],
    errors: [`errors of ${a}`, `errors of ${b}`],
  };
  find("left-name").textContent = tags[mode][0]!;
  find("right-name").textContent = tags[mode][1] ?? "";
  find("right-name").hidden = tags[mode].length < 2;
  const what = { wipe: "wiped over", side: "beside", left: "hides", difference: "less", flip: "FLIP between it and", errors: "errors by FLIP, beside those of" }[mode];
  find("canvas").setAttribute("aria-label", `Picture of frame ${frame}: ${a}, ${what} ${b}`);
}

export function showControls(report: Report, state: State, hasLine: boolean) {
  find<HTMLSelectElement>("left").value = String(state.left);
  find<HTMLSelectElement>("right").value = String(state.right);
  document.querySelector<HTMLInputElement>(`#modes input[value=${state.mode}]`)!.checked = true;
  find<HTMLInputElement>("frame").value = String(report.kept.indexOf(state.frame));
  find<HTMLInputElement>("frame").setAttribute("aria-valuetext", `frame ${state.frame}`);
  find("frame-text").textContent = `${state.frame}`;
  find<HTMLInputElement>("exposure").value = String(state.exposure);
  find("exposure-text").textContent = `${state.exposure > 0 ? "+" : ""}${state.exposure}`.replace("-", "−");
  find<HTMLInputElement>("wipe").value = String(Math.round(100 * state.wipe));
  find("wipe-label").hidden = !hasLine;
  find<HTMLInputElement>("exposure").disabled = state.mode === "flip" || state.mode === "errors"; // which are about the display as it is
  showNames(report, state);
  for (const button of document.querySelectorAll<HTMLElement>("#numbers button")) {
    const index = Number(button.dataset["image"]);
    button.dataset["side"] = index === state.left ? "left" : index === state.right ? "right" : "";
  }
}
