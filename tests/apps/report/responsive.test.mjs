// A report of 24 frames of 1920 x 1080 stays responsive: every step of scrubbing and zooming is on the screen within 50 ms.
//   node responsive.test.mjs QUELL SOURCE
// Steps are told, and judged by their median: a machine that does other things at the same time must not fail it.
import assert from "node:assert/strict";
import { mkdirSync, statSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { test } from "node:test";
import { writeExr } from "./exr.mjs";
import { folder, open, run } from "./page.mjs";

const kMost = 50; // ms
const [width, height, count] = [1920, 1080, 24];

/** Uniform noise within 1/4 to 1, as its half floats' bits, the same in every run: nothing is easy to pack or to draw of it. */
function makeNoise(seed) {
  let state = seed; // of xorshift32, Marsaglia 2003
  return () => {
    const bits = new Uint16Array(3 * width);
    for (let i = 0; i < bits.length; ++i) {
      state ^= state << 13;
      state ^= state >>> 17;
      state ^= state << 5;
      bits[i] = 0x3400 + ((state >>> 8) & 0x7ff);
    }
    return bits;
  };
}

function writeReport() {
  mkdirSync(join(folder, "shot"));
  for (let frame = 1; frame <= count; ++frame)
    writeExr(join(folder, `shot/color.${String(frame).padStart(4, "0")}.exr`), width, height, makeNoise(frame));
  const graph = { quell: 1, inputs: { color: "color" }, nodes: { blur: { pass: "gaussian", in: { image: "color" }, params: { sigma: 1 } } }, outputs: { color: "blur.image" } };
  writeFileSync(join(folder, "blur.json"), JSON.stringify(graph));
  run("report", "shot", "blur.json", "-o", "report.html");
  console.log(`a report of ${(statSync(join(folder, "report.html")).size / 1e6).toFixed(0)} MB`);
}

/** Of each key: from its press to the frame that shows its effect, in ms, and what the page then says. */
async function measure(page, keys, text) {
  return page.evaluate(
    async ([all, id]) => {
      const drawn = () => new Promise((done) => requestAnimationFrame(() => setTimeout(done)));
      const steps = [];
      for (const key of all) {
        await drawn();
        const start = performance.now();
        document.getElementById("canvas").dispatchEvent(new KeyboardEvent("keydown", { key, bubbles: true }));
        await window.reportDrawn();
        const { dataset } = document.getElementById("canvas");
        steps.push({ ms: performance.now() - start, text: document.getElementById(id).textContent, frame: dataset.frame });
      }
      return steps;
    },
    [keys, text],
  );
}

/** Every step changes what is shown, and is fast. */
function judge(what, before, steps) {
  const texts = [before, ...steps.map((step) => step.text)];
  for (let i = 1; i < texts.length; ++i) assert.notEqual(texts[i], texts[i - 1], `${what}: step ${i} of ${texts} does nothing`);
  const times = steps.map((step) => step.ms).sort((a, b) => a - b);
  const median = times[times.length >> 1];
  console.log(`${what}: median ${median.toFixed(1)} ms, longest ${times.at(-1).toFixed(1)} ms of ${times.length} steps`);
  assert.ok(median < kMost, `${what}: ${times}`);
}

test("scrubbing and zooming 24 frames of 1920 x 1080", async () => {
  writeReport();
  const { page, end } = await open("report.html", {}, 120_000);
  await page.waitForFunction(() => document.querySelector("canvas").dataset.prefetched, null, { timeout: 120_000 });
  const frames = await measure(page, Array(count - 1).fill(","), "frame-text");
  assert.deepEqual(frames.map((step) => step.frame), frames.map((step) => step.text), "another frame is drawn than told");
  judge("scrubbing", String(count), frames);
  const zoom = await page.textContent("#zoom-text");
  const zoomed = await measure(page, ["+", "+", "+", "+", "+", "-", "-", "-", "-", "-"], "zoom-text");
  judge("zooming", zoom, zoomed);
  await end();
});
