// The images: two at a time, with one zoom and place for both.
import { Actions } from "./actions";
import { fillControls, listenToControls, showControls } from "./controls";
import { type ImageSeries, title } from "./data";
import { listenToKeys } from "./keys";
import type { Picture, Pictures } from "./pictures";
import { Pointers } from "./pointers";
import { Readout } from "./readout";
import { type Shown, Stage } from "./stage";
import { isBetween, referenceOf, type State, type Store } from "./state";
import { find } from "./text";

const kPatience = 250; // ms, after which FLIP of large images is said to be on its way

export class Viewer {
  private readonly stage: Stage;
  private readonly readout: Readout;
  private loading = 0;
  private pending: Promise<void> = Promise.resolve();

  constructor(
    private readonly store: Store,
    private readonly pictures: Pictures,
  ) {
    this.stage = new Stage(store);
    this.readout = new Readout(store, pictures);
    const actions = new Actions(store, () => this.ready());
    fillControls(store.report, actions);
    listenToControls(store, actions, this.stage);
    listenToKeys(actions, this.stage, store);
    new Pointers(this.stage, store, this.readout);
    store.listen((state, before) => this.update(state, before));
    this.update(store.state, store.state);
  }

  private update(state: State, before: State) {
    showControls(this.store.report, state, this.stage.hasLine);
    const needs: (keyof State)[] = ["left", "right", "mode", "frame", "exposure"];
    if (state === before || needs.some((key) => state[key] !== before[key])) this.pending = this.load();
    if (state.mode !== before.mode) this.stage.resize();
    this.stage.draw();
    this.readout.show();
  }

  /** When what was asked for last is drawn. */
  async drawn(): Promise<void> {
    for (let last; last !== this.pending; ) {
      last = this.pending;
      await last;
    }
    await new Promise((done) => requestAnimationFrame(() => setTimeout(done))); // behind the drawing, which was asked for before
  }
  /** When that is on the screen. */
  async ready(): Promise<void> {
    await this.drawn();
    await new Promise((done) => requestAnimationFrame(done));
  }

  private async load() {
    const turn = ++this.loading;
    const { state } = this.store;
    const patience = setTimeout(() => this.tell("This takes a moment…"), kPatience);
    const shown = await this.read(state);
    clearTimeout(patience);
    if (turn !== this.loading) return; // something else was asked for meanwhile
    this.stage.canvas.dataset["frame"] = String(state.frame);
    this.tellAbsent(shown);
    this.stage.show(shown);
    this.readout.show();
    this.prefetch(shown);
  }
  private async read({ left, right, mode, frame, exposure }: State): Promise<Shown> {
    this.pictures.forgetWanted();
    const { images } = this.store.report;
    const [a, b] = [images[left]!, images[right]!];
    if (mode === "difference") return { left: await this.pictures.difference(a, b, frame, exposure), right: null };
    if (mode === "flip") return { left: await this.pictures.flip(a, b, frame), right: null };
    const of = (image: ImageSeries) =>
      mode === "errors" ? this.pictures.flip(referenceOf(this.store.report)!, image, frame) : this.pictures.series(image, frame, exposure);
    const [first, second] = await Promise.all([of(a), mode === "left" ? null : of(b)]);
    return { left: first, right: second };
  }

  private tellAbsent(shown: Shown) {
    const { left, right, mode, frame } = this.store.state;
    const { report } = this.store;
    const pairs: [number, Picture | null][] = mode === "left" ? [[left, shown.left]] : [[left, shown.left], [right, shown.right]];
    const isMissing = (index: number, picture: Picture | null) => (isBetween(mode) ? report.images[index]!.frames[frame] === undefined : !picture);
    const names = pairs.filter((pair) => isMissing(...pair)).map(([index]) => title(report, report.images[index]!));
    let text = names.length ? `frame ${frame} of ${names.join(" and ")} is not in this report` : "";
    if (mode === "errors" && names.length) text = `no errors of ${names.join(" and ")}`;
    if (isBetween(mode) && !text && !shown.left) text = mode === "flip" ? "FLIP is between colors of one size" : "these have other sizes or channels";
    this.tell(text);
  }
  private tell(text: string) {
    find("absent").hidden = text === "";
    find("absent").textContent = text;
  }

  /** All frames of what is shown, the next ones first, while nothing else is to be done: so that scrubbing waits for nothing. */
  private prefetch({ left: first, right: second }: Shown) {
    const { left, right, mode, frame, exposure } = this.store.state;
    if (isBetween(mode) || mode === "errors") return;
    const { kept, images } = this.store.report;
    const shown = mode === "left" ? [left] : [left, right];
    const picture = first ?? second;
    const pixels = picture ? picture.canvas.width * picture.canvas.height : 0;
    const ahead = this.pictures.hasRoomFor(kept.length * shown.length, pixels) ? kept.length : 2;
    const frames = Array.from({ length: Math.min(ahead, kept.length) }, (_, i) => kept[(kept.indexOf(frame) + i) % kept.length]!);
    const turn = this.loading;
    const idle = window.requestIdleCallback ?? ((act: () => void) => setTimeout(act, 1));
    const next = (place: number) => {
      const index = shown[place % shown.length]!;
      const other = frames[Math.floor(place / shown.length)];
      if (turn !== this.loading || other === undefined) {
        if (other === undefined) this.stage.canvas.dataset["prefetched"] = String(turn);
        return;
      }
      void this.pictures.series(images[index]!, other, exposure).then(() => idle(() => next(place + 1)));
    };
    idle(() => next(0));
  }
}
