// What controls and keys do.
import type { Mode, Store } from "./state";
import { find } from "./text";

export class Actions {
  isPlaying = false;
  private timer = 0;
  private turns = 0; // of playing

  /** `isShown` tells when the frame that was asked for last is on the screen. */
  constructor(
    private readonly store: Store,
    private readonly isShown: () => Promise<void>,
  ) {}

  choose(side: "left" | "right", index: number) {
    const { images, kept } = this.store.report;
    const image = images[index];
    if (!image) return;
    const frames = Object.keys(image.frames).map(Number).filter((frame) => kept.includes(frame));
    const frame = image.frames[this.store.state.frame] === undefined ? frames.at(-1) : this.store.state.frame;
    this.store.set({ [side]: index, ...(frame === undefined ? {} : { frame }) });
  }
  exchange() {
    const { left, right } = this.store.state;
    this.store.set({ left: right, right: left });
  }
  setMode(mode: Mode) {
    if (!document.querySelector<HTMLInputElement>(`#modes input[value=${mode}]`)!.disabled) this.store.set({ mode });
  }
  setExposure(exposure: number) {
    this.store.set({ exposure: Math.max(-8, Math.min(8, exposure)) });
  }
  step(by: number, around = false) {
    const { kept } = this.store.report;
    const at = kept.indexOf(this.store.state.frame) + by;
    const next = around ? (at + kept.length) % kept.length : Math.max(0, Math.min(kept.length - 1, at));
    this.store.set({ frame: kept[next]! });
  }
  play(on = !this.isPlaying) {
    if (this.store.report.kept.length < 2) return;
    clearTimeout(this.timer);
    this.isPlaying = on;
    find("play").setAttribute("aria-pressed", String(on));
    find("play").textContent = on ? "Pause" : "Play";
    const turn = ++this.turns;
    const next = () => {
      this.step(1, true);
      // A frame is shown before the next one is asked for, however long that takes; meanwhile it may be stopped and started again.
      void this.isShown().then(() => {
        if (this.isPlaying && turn === this.turns) this.timer = window.setTimeout(next, 1000 / 8);
      });
    };
    if (on) next();
  }
}
