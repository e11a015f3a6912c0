// Mouse and touch on the images.
import type { Readout } from "./readout";
import type { Stage } from "./stage";
import type { Store } from "./state";

const kHandle = 22; // CSS pixels beside the line of the wipe that still take hold of it

interface Place {
  x: number;
  y: number;
}

export class Pointers {
  private readonly down = new Map<number, Place>();
  private dragged: "wipe" | "picture" | null = null;
  private moved = 0;
  private pinch = 0;

  constructor(
    private readonly stage: Stage,
    private readonly store: Store,
    private readonly readout: Readout,
  ) {
    const { canvas } = stage;
    canvas.addEventListener("pointerdown", (event) => this.press(event));
    canvas.addEventListener("pointermove", (event) => this.move(event));
    canvas.addEventListener("pointerup", (event) => this.release(event));
    canvas.addEventListener("pointercancel", (event) => this.down.delete(event.pointerId));
    canvas.addEventListener("pointerleave", () => readout.point(null));
    canvas.addEventListener("wheel", (event) => this.turn(event), { passive: false });
  }

  private place(event: MouseEvent): Place {
    const box = this.stage.canvas.getBoundingClientRect();
    return { x: event.clientX - box.left, y: event.clientY - box.top };
  }
  private get fingers(): [Place, Place] {
    return [...this.down.values()] as [Place, Place];
  }
  private apart(): number {
    const [a, b] = this.fingers;
    return Math.hypot(a.x - b.x, a.y - b.y);
  }
  private isOnLine(at: Place, reach: number): boolean {
    return this.stage.hasLine && Math.abs(at.x - this.stage.lineX()) <= reach;
  }

  private press(event: PointerEvent) {
    this.stage.canvas.setPointerCapture(event.pointerId);
    const at = this.place(event);
    this.down.set(event.pointerId, at);
    if (this.down.size === 2) this.pinch = this.apart();
    this.moved = 0;
    this.dragged = this.isOnLine(at, kHandle) ? "wipe" : "picture";
  }
  private move(event: PointerEvent) {
    const at = this.place(event);
    const before = this.down.get(event.pointerId);
    if (!before) return this.hover(at);
    this.moved += Math.hypot(at.x - before.x, at.y - before.y);
    this.down.set(event.pointerId, at);
    const { view } = this.stage;
    if (this.down.size === 2) {
      this.zoomByFingers();
    } else if (this.dragged === "wipe") {
      const [x] = view.toPicture(at.x, at.y);
      this.store.set({ wipe: Math.max(0, Math.min(1, x / view.width)) });
    } else if (this.moved > 3) {
      this.stage.zoom(() => view.pan(at.x - before.x, at.y - before.y));
    }
  }
  private hover(at: Place) {
    this.stage.canvas.style.cursor = this.isOnLine(at, kHandle / 2) ? "ew-resize" : "crosshair";
    this.readout.point(this.stage.pixelAt(at.x, at.y));
  }
  private zoomByFingers() {
    const { stage } = this;
    const now = this.apart();
    const [a, b] = this.fingers;
    if (this.pinch > 0) stage.zoom((view) => view.zoomTo((view.zoom * now) / this.pinch, stage.paneX((a.x + b.x) / 2), (a.y + b.y) / 2));
    this.pinch = now;
  }
  private release(event: PointerEvent) {
    if (!this.down.delete(event.pointerId)) return;
    const at = this.place(event);
    const pixel = this.stage.pixelAt(at.x, at.y);
    if (this.moved <= 3 && pixel) this.store.set({ pixel });
  }
  private turn(event: WheelEvent) {
    event.preventDefault();
    const at = this.place(event);
    const by = 2 ** (-event.deltaY / (event.deltaMode ? 6 : 200)); // lines or pixels
    this.stage.zoom((view) => view.zoomTo(view.zoom * by, this.stage.paneX(at.x), at.y));
  }
}
