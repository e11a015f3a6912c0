// The values of a pixel that is pointed at or was chosen.
import { title } from "./data";
import type { Pictures } from "./pictures";
import type { Store } from "./state";
import { find, make, valueText } from "./text";

export class Readout {
  private hover: [number, number] | null = null;
  constructor(
    private readonly store: Store,
    private readonly pictures: Pictures,
  ) {}
  point(at: [number, number] | null) {
    this.hover = at;
    this.show();
  }
  show() {
    const { pixel, left, right, frame } = this.store.state;
    const at = this.hover ?? pixel;
    const box = find("readout");
    if (!at) {
      box.textContent = "Point at a pixel to read its values; click it for its story.";
      return;
    }
    const lines = [left, ...(right === left ? [] : [right])].map((index) => {
      const image = this.store.report.images[index]!;
      const number = image.frames[frame];
      return number === undefined ? null : this.pictures.store.get(number).then((pixels) => ({ image, pixels }));
    });
    void Promise.all(lines).then((found) => {
      if ((this.hover ?? this.store.state.pixel)?.join() !== at.join()) return;
      box.replaceChildren(make("span", { class: "place" }, `x ${at[0]}, y ${at[1]}`));
      for (const line of found) {
        if (!line || at[0] >= line.pixels.width || at[1] >= line.pixels.height) continue;
        const values = line.pixels.all(at[0], at[1]).map(valueText).join("  ");
        box.append(make("span", { class: "values" }, make("b", {}, title(this.store.report, line.image)), " ", make("code", {}, values)));
      }
    });
  }
}
