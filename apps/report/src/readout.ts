// The values of a pixel that is pointed at or was chosen.
import { title } from "./data";
import type { Pictures } from "./pictures";
import { pictureSize, samePlace, type Store } from "./state";
import { find, make, valueText } from "./text";

export class Readout {
  private hover: [number, number] | null = null;
  private turn = 0;
  constructor(
    private readonly store: Store,
    private readonly pictures: Pictures,
  ) {}
  point(at: [number, number] | null) {
    this.hover = at;
    this.show();
  }
  show() {
    const turn = ++this.turn;
    const { pixel, left, right, frame } = this.store.state;
    const size = pictureSize(this.store.report, this.store.state);
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
      if (turn !== this.turn) return; // something else is to be told meanwhile
      box.replaceChildren(make("span", { class: "place" }, `x ${at[0]}, y ${at[1]}`));
      for (const line of found) {
        if (!line) continue;
        const values = line.pixels.all(...samePlace(at, size, line.pixels)).map(valueText).join("  ");
        box.append(make("span", { class: "values" }, make("b", {}, title(this.store.report, line.image)), " ", make("code", {}, values)));
      }
    });
  }
}
