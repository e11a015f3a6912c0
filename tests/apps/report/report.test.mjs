// quell report, as a person meets it: made by the program, opened in headless Chromium from disk.
//   node report.test.mjs QUELL SOURCE_DIR
import assert from "node:assert/strict";
import { spawnSync } from "node:child_process";
import { cpSync, mkdirSync, statSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { before, test } from "node:test";
import { readExr } from "./exr.mjs";
import { choosePixel, folder, open, quell, run, sample } from "./page.mjs";

const kFrames = "1-3";
before(() => {
  run("report", sample, "games202", "svgf", "--frames", kFrames, "-o", "report.html");
  run("run", "svgf", sample, "--frames", kFrames, "-o", "svgf", "--compression", "none", "--type", "half");
});

test("opens from disk without a word on the console and without a request", async () => {
  const report = await open();
  assert.equal(await report.page.title(), "games202, svgf on sample");
  assert.equal(await report.page.locator("h1").textContent(), "games202, svgf on sample");
  assert.notDeepEqual(await report.color(0.3, 0.5), await report.color(0.7, 0.5));
  await report.end();
});

test("values read out are those of the EXR file, in every frame", async () => {
  const report = await open();
  await report.page.selectOption("#left", { label: "svgf" });
  for (const [x, y] of [[172, 63], [0, 179]]) {
    await choosePixel(report, x, y);
    assert.match(await report.page.textContent("#readout"), new RegExp(`x ${x}, y ${y}`));
    for (const frame of [3, 2, 1]) {
      const image = readExr(join(folder, `svgf/color.000${frame}.exr`));
      const want = ["R", "G", "B"].map((channel) => image(x, y, channel));
      const got = await report.values("svgf");
      got.forEach((value, i) => assert.ok(Math.abs(value - want[i]) <= 1e-4 * want[i], `frame ${frame}: ${got}, not ${want}`));
      await report.press(",");
    }
    await report.press(".", ".", ".");
    await report.page.reload();
    await report.ready();
    await report.page.selectOption("#left", { label: "svgf" });
  }
  await report.end();
});

test("number keys switch images, and letters how they are shown", async () => {
  const report = await open();
  const chosen = () => report.page.evaluate(() => ["left", "right"].map((id) => document.getElementById(id).selectedOptions[0].text));
  assert.deepEqual(await chosen(), ["noisy (color)", "svgf"]);
  await report.press("2");
  assert.deepEqual(await chosen(), ["reference", "svgf"]);
  await report.press("Shift+Digit3");
  assert.deepEqual(await chosen(), ["reference", "games202"]);
  await report.press("x");
  assert.deepEqual(await chosen(), ["games202", "reference"]);
  const pictures = new Set();
  for (const [key, mode] of [["w", "wipe"], ["s", "side"], ["l", "left"], ["d", "difference"], ["f", "flip"], ["e", "errors"]]) {
    await report.press(key);
    assert.equal(await report.page.locator("#modes input:checked").getAttribute("value"), mode);
    pictures.add(await report.picture());
  }
  assert.equal(pictures.size, 6);
  await report.end();
});

test("the wipe shows one image on its left and the other on its right", async () => {
  const report = await open();
  const wipe = (percent) => report.page.locator("#wipe").fill(String(percent)).then(report.ready);
  await report.press("l");
  const left = await report.color(0.4, 0.3);
  await report.press("x");
  const right = await report.color(0.4, 0.3);
  assert.notDeepEqual(left, right);
  await report.press("x", "w");
  await wipe(90);
  assert.deepEqual(await report.color(0.4, 0.3), left);
  await wipe(10);
  assert.deepEqual(await report.color(0.4, 0.3), right);
  const box = await report.page.locator("#canvas").boundingBox();
  const line = await report.page.evaluate(() => Number(document.getElementById("wipe").value));
  assert.equal(line, 10);
  await wipe(50);
  await report.page.mouse.move(box.x + box.width / 2, box.y + 50); // takes hold of the line
  await report.page.mouse.down();
  await report.page.mouse.move(box.x + box.width * 0.6, box.y + 60);
  await report.page.mouse.up();
  assert.ok(Number(await report.page.inputValue("#wipe")) > 55);
  await report.end();
});

test("an image differs from itself nowhere, and an exposure makes it brighter", async () => {
  const report = await open();
  await report.press("3", "Shift+Digit3", "d");
  assert.deepEqual(await report.color(0.5, 0.5), [0, 0, 0]);
  await report.press("l");
  const dark = await report.color(0.5, 0.5);
  await report.press("]", "]");
  const bright = await report.color(0.5, 0.5);
  assert.ok(bright[0] > dark[0] + 20, `${bright} after ${dark}`);
  assert.equal(await report.page.textContent("#exposure-text"), "+1");
  await report.end();
});

test("FLIP between any two images, and against the reference, is what quell compare measures", async () => {
  run("run", "games202", sample, "--frames", kFrames, "-o", "games", "--compression", "none", "--type", "half");
  const report = await open();
  const { images } = await report.page.evaluate(() => JSON.parse(document.getElementById("report").textContent));
  const index = (kind, graph) => images.findIndex((image) => image.kind === kind && (graph === undefined || image.graph === graph));
  const [reference, games, svgf] = [index("reference"), index("result", 0), index("result", 1)];
  const files = { [reference]: join(sample, "reference.####.exr"), [games]: "games/color.####.exr", [svgf]: "svgf/color.####.exr" };
  for (const [a, b] of [[reference, svgf], [games, svgf]]) {
    const told = run("compare", files[a], `it=${files[b]}`, "--frames", "1-2", "--metrics", "flip", "--csv", "-").toString();
    const lines = told.trim().split("\n").map((line) => line.split(","));
    for (const frame of [1, 2]) {
      const want = Number(lines.find((line) => line[0] === String(frame))[lines[0].indexOf("flip")]);
      const errors = await report.page.evaluate((what) => window.reportFlip(...what), [a, b, frame]);
      assert.equal(errors.length, 320 * 180);
      const got = errors.reduce((sum, error) => sum + error, 0) / errors.length;
      assert.ok(want > 0.02 && Math.abs(got - want) < 1e-4, `frame ${frame} of ${files[b]}: ${got}, not ${want}`);
    }
  }
  await report.press("3", "Shift+Digit3", "f");
  assert.deepEqual(await report.color(0.5, 0.5), [0, 0, 4]); // the color of no error
  assert.match(await report.page.textContent("#left-name"), /FLIP of games202 and games202/);
  const flat = await report.picture();
  await report.page.evaluate(async () => {
    for (const key of [..."22,.,.,.,"]) {
      document.getElementById("canvas").dispatchEvent(new KeyboardEvent("keydown", { key, code: `Digit${key}`, bubbles: true }));
      await new Promise((done) => setTimeout(done, 15)); // in the midst of what was asked for
    }
  });
  await report.ready();
  assert.equal(await report.page.isVisible("#absent"), false, "what is asked for again is not taken for what was given up");
  const hurried = await report.picture();
  assert.notEqual(hurried, flat);
  await report.press("w", "f");
  assert.equal(await report.picture(), hurried);
  await report.press("3", "e", "Shift+Digit2");
  assert.notDeepEqual(await report.color(0.25, 0.5), [0, 0, 4]);
  assert.deepEqual(await report.color(0.75, 0.5), [0, 0, 4]); // of the reference itself
  await report.page.selectOption("#left", { label: "svgf: reproject.valid" });
  await report.press("f");
  assert.equal(await report.page.textContent("#absent"), "FLIP is between colors of one size");
  await report.end();
});

test("figures of equal images are told as infinite", async () => {
  run("report", sample, "games202", "--frames", "1-2", "--reference", "color", "--metrics", "psnr,mse", "--inner", "none", "-o", "equal.html");
  const report = await open("equal.html");
  const row = await report.page.locator("#figures tbody tr", { hasText: "noisy" }).locator("td").allTextContents();
  assert.deepEqual(row.slice(0, 2), ["∞", "0.00000"]);
  assert.equal(await report.page.locator("#plots .plot svg").first().locator("[aria-label=line] path").count(), 1);
  await report.end();
});

test("Play that is pressed twice goes one frame at a time", async () => {
  const report = await open();
  const steps = await report.page.evaluate(async () => {
    for (let i = 0; i < 5; ++i) document.getElementById("play").click();
    let count = 0;
    const observer = new MutationObserver(() => ++count);
    observer.observe(document.getElementById("frame-text"), { childList: true });
    await new Promise((done) => setTimeout(done, 1000));
    document.getElementById("play").click();
    return count;
  });
  assert.ok(steps >= 2 && steps <= 9, `${steps} frames in a second`); // 8 of one timer
  assert.equal(await report.page.textContent("#play"), "Play");
  await report.end();
});

test("what is not finite is shown as such in a difference", async () => {
  const report = await open();
  const difference = await report.page.evaluate(() => window.reportDifference([NaN, 1, Infinity, 2], [1, 1, Infinity, 1.5]));
  assert.deepEqual(difference, [[255, 0, 255], [0, 0, 0], [255, 0, 255], [128, 128, 128]]);
  await report.end();
});

test("three graphs on the sample make less than 40 MB in less than two minutes", () => {
  const start = Date.now();
  const { stderr } = spawnSync(quell, ["report", sample, "games202", "svgf", "best", "-o", "three.html", "-v"], { cwd: folder, encoding: "utf8" });
  const [seconds, bytes] = [(Date.now() - start) / 1000, statSync(join(folder, "three.html")).size];
  const told = 1e6 * Number(/the report will have about (\d+) MB/.exec(stderr)[1]);
  console.log(`${(bytes / 1e6).toFixed(1)} MB in ${seconds.toFixed(1)} s; ${(told / 1e6).toFixed(0)} MB were expected`);
  assert.ok(bytes < 40e6 && seconds < 120);
  assert.ok(told > 0.9 * bytes && told < 1.5 * bytes, "the size is told before, for noise");
});

test("zoom goes down to pixels, keeps its place and is the same for both images", async () => {
  const report = await open();
  await choosePixel(report, 160, 90);
  await report.press("s", "+", "+", "+");
  const zoomed = await report.page.textContent("#zoom-text");
  const box = await report.page.locator("#canvas").boundingBox();
  const under = async (u) => {
    await report.page.mouse.move(box.x + box.width * u, box.y + box.height / 2);
    await report.ready();
    return (await report.page.textContent("#readout .place")).trim();
  };
  assert.equal(await under(0.26), await under(0.76)); // the same places of both panes
  await report.page.mouse.wheel(0, -2000);
  await report.ready();
  assert.equal(await report.page.textContent("#zoom-text"), "9600 %");
  assert.notEqual(zoomed, "9600 %");
  const place = await under(0.76);
  await report.page.mouse.down();
  await report.page.mouse.move(box.x + box.width * 0.76 - 200, box.y + box.height / 2, { steps: 4 });
  await report.page.mouse.up();
  assert.notEqual(await under(0.76), place); // two pixels on
  await report.press("0");
  assert.notEqual(await report.page.textContent("#zoom-text"), "9600 %");
  await report.end();
});

test("scrubbing and playing go through the frames", async () => {
  const report = await open();
  const frame = () => report.page.textContent("#frame-text");
  assert.equal(await frame(), "3");
  const third = await report.picture();
  await report.page.locator("#frame").fill("0");
  await report.ready();
  assert.equal(await frame(), "1");
  assert.notEqual(await report.picture(), third);
  await report.page.click("#play");
  await report.page.waitForFunction(() => document.getElementById("frame-text").textContent === "3");
  await report.page.click("#play");
  assert.equal(await report.page.textContent("#play"), "Play");
  await report.end();
});

test("a pixel's story tells what each pass yields, and how long its history is", async () => {
  const report = await open();
  assert.match(await report.page.textContent("#story-body"), /Click a pixel/);
  await choosePixel(report, 160, 90);
  const rows = await report.page.locator("#story tbody tr").allTextContents();
  for (const node of ["light", "reproject", "moments", "blend", "variance", "level0", "level4", "result"])
    assert.ok(rows.some((row) => row.startsWith(node)), `no ${node} in ${rows}`);
  // This is the third frame, and the pixel was seen in both before.
  const length = await report.page.locator("#story tr.length").allTextContents();
  assert.deepEqual(length.map((row) => row.replaceAll(/\s+/g, " ").trim()), [
    "moments momentslength (frames of history)3",
    "blend temporal_blendlength (frames of history)3",
  ]);
  const result = await report.page.locator("#story tr", { hasText: "output color" }).locator("td.number").textContent();
  assert.equal(result.trim(), (await report.page.locator("#readout .values", { hasText: "svgf" }).locator("code").textContent()).trim());
  await report.page.selectOption("#story-graph", { label: "games202" });
  await report.ready();
  assert.ok((await report.page.locator("#story tbody tr").allTextContents()).some((row) => row.startsWith("filter")));
  await report.end();
});

test("outputs of one port are told apart in a pixel's story", async () => {
  const report = await open();
  await choosePixel(report, 160, 90);
  const yields = await report.page.locator("#story tbody tr:not(.weights) td:nth-child(2)").allTextContents();
  assert.deepEqual(yields.filter((text) => text.startsWith("history")), ["history[0]", "history[1]", "history[2]"]);
  await report.end();
});

test("values stay those of what was chosen last, however late others come", async () => {
  const report = await open();
  const { page } = report;
  await choosePixel(report, 172, 63);
  const want = await page.textContent("#readout");
  const names = await page.evaluate(async () => {
    const read = Response.prototype.arrayBuffer;
    let isAsked = false;
    Response.prototype.arrayBuffer = async function () {
      isAsked = true;
      await new Promise((done) => setTimeout(done, 300));
      return read.call(this);
    };
    const press = (digit) => document.dispatchEvent(new KeyboardEvent("keydown", { key: digit, code: `Digit${digit}`, bubbles: true }));
    press("3"); // which was not read yet
    press("1");
    await new Promise((done) => setTimeout(done, 900));
    Response.prototype.arrayBuffer = read;
    return { isAsked, left: document.getElementById("left").selectedOptions[0].text };
  });
  assert.deepEqual(names, { isAsked: true, left: "noisy (color)" });
  assert.equal(await page.textContent("#readout"), want);
  await report.end();
});

test("images of other sizes are read at the same place", async () => {
  const graph = {
    quell: 1,
    inputs: { color: "color" },
    nodes: { half: { pass: "scale", in: { image: "color" } }, double: { pass: "scale", in: { image: "half.image" }, params: { to: "double" } } },
    outputs: { color: "double.image", small: "half.image" },
  };
  writeFileSync(join(folder, "half.json"), JSON.stringify(graph));
  run("report", sample, "half.json", "--frames", "1", "-o", "half.html");
  const report = await open("half.html");
  await report.page.selectOption("#left", { label: "half: color" });
  await report.page.selectOption("#right", { label: "half: small" });
  await choosePixel(report, 200, 120);
  const beside = await report.values("half: small");
  await report.press("s", ...Array(6).fill("+"));
  const zoomed = await report.picture();
  await report.page.selectOption("#left", { label: "half: small" });
  await report.ready();
  assert.match(await report.page.textContent("#readout"), /x 100, y 60/);
  assert.deepEqual(await report.values("half: small"), beside);
  assert.notEqual(await report.picture(), zoomed);
  await report.page.selectOption("#left", { label: "half: color" });
  await report.ready();
  assert.match(await report.page.textContent("#readout"), /x 20[01], y 12[01]/);
  await report.end();
});

test("1:1 shows a pixel on each of the display's, however dense that is", async () => {
  const report = await open("report.html", { deviceScaleFactor: 3 });
  await report.page.click("#actual");
  await report.ready();
  assert.equal(await report.page.textContent("#zoom-text"), "100 %");
  await report.end();
});

test("keys that other keyboards have behind AltGr mean what is printed on them", async () => {
  const report = await open();
  await report.page.evaluate(() => {
    // ] of a German keyboard, as Linux and as Windows tell it.
    for (const more of [{}, { ctrlKey: true, altKey: true }])
      document.dispatchEvent(new KeyboardEvent("keydown", { key: "]", code: "Digit5", modifierAltGraph: true, bubbles: true, ...more }));
  });
  await report.ready();
  assert.equal(await report.page.textContent("#exposure-text"), "+1");
  await report.page.evaluate(() => document.dispatchEvent(new KeyboardEvent("keydown", { key: "x", code: "KeyX", ctrlKey: true, bubbles: true })));
  await report.ready();
  const chosen = await report.page.evaluate(() => ["left", "right"].map((id) => document.getElementById(id).selectedOptions[0].text));
  assert.deepEqual(chosen, ["noisy (color)", "svgf"]);
  await report.end();
});

test("what is to be copied is selected where there is no clipboard", async () => {
  const report = await open();
  await report.page.evaluate(() => Object.defineProperty(navigator, "clipboard", { value: undefined }));
  await report.page.click("#provenance .copy button");
  assert.match(await report.page.evaluate(() => String(getSelection())), /quell report .*graphs\/sample games202 svgf --frames 1-3 -o report.html/);
  await report.end();
});

test("the time of a frame is the same in the table and above the bars", async () => {
  const report = await open();
  const rows = await report.page.locator("#figures tbody tr td:nth-last-child(2)").allTextContents();
  const heads = await report.page.locator("#times .grid h3 small").allTextContents();
  assert.deepEqual(heads.map((text) => text.trim()), rows.slice(1).map((text) => `${text} a frame`));
  await report.end();
});

test("a frame without a figure leaves a gap in the lines", async () => {
  mkdirSync(join(folder, "gap"));
  for (const frame of [1, 2, 3, 4, 5])
    for (const [from, to] of [["color_1spp", "color"], ["reference", "reference"]]) cpSync(join(sample, `${from}.000${frame}.exr`), join(folder, `gap/${to}.000${frame}.exr`));
  writeFileSync(join(folder, "gap/reference.0003.exr"), "no image");
  const graph = { quell: 1, inputs: { color: "color" }, nodes: { blur: { pass: "gaussian", in: { image: "color" } } }, outputs: { color: "blur.image" } };
  writeFileSync(join(folder, "blur.json"), JSON.stringify(graph));
  run("report", "gap", "blur.json", "--metrics", "psnr", "--inner", "none", "-o", "gap.html");
  const report = await open("gap.html");
  const lines = await report.page.locator("#plots .plot [aria-label=line] path").evaluateAll((paths) => paths.map((path) => path.getAttribute("d")));
  assert.deepEqual(lines.map((line) => line.match(/M/g).length), [2, 2]);
  assert.equal(await report.page.locator("#plots .plot [aria-label=dot] circle").count(), 8);
  await report.end();
});

test("figures can be sorted, plots and drawings are complete", async () => {
  const report = await open();
  const { page } = report;
  const names = () => page.locator("#figures tbody th").allTextContents();
  assert.deepEqual(await names(), ["noisy (color)", "games202", "svgf"]);
  await page.click("#figures thead button:has-text('psnr')");
  await page.click("#figures thead button:has-text('psnr')");
  assert.deepEqual(await names(), ["svgf", "games202", "noisy (color)"]);
  assert.equal(await page.locator("#figures th[aria-sort=descending]").count(), 1);
  assert.equal(await page.locator("#plots .plot svg").count(), 7); // psnr, ssim, relmse, smape, flip, tpsnr, warped
  assert.equal(await page.locator("#plots .plot svg").first().locator("[aria-label=line] path").count(), 3);
  const nodes = [4, 12]; // of games202 and svgf
  for (const [i, count] of nodes.entries())
    assert.equal(await page.locator("#times .plot svg").nth(i).locator("[aria-label=bar] rect").count(), count);
  assert.equal(await page.locator("#times .plot").count(), 3);
  for (const [i, count] of nodes.entries()) {
    const drawing = page.locator("#drawings .drawing").nth(i);
    if (await drawing.locator("svg").count()) assert.equal(await drawing.locator("text.time").count(), count);
    else assert.match(await drawing.textContent(), /no drawing/);
  }
  assert.match(await page.textContent("#provenance pre"), /quell report .*graphs\/sample games202 svgf --frames 1-3 -o report.html/);
  await report.end();
});

test("the keyboard alone reaches everything, and everything has a name", async () => {
  const report = await open();
  const { page } = report;
  const seen = new Set();
  for (let i = 0; i < 60; ++i) {
    await page.keyboard.press("Tab");
    seen.add(await page.evaluate(() => document.activeElement?.id ?? ""));
  }
  for (const id of ["left", "exchange", "right", "canvas", "play", "frame", "exposure", "wipe", "fit", "zoom-in", "zoom-out"])
    assert.ok(seen.has(id), `Tab never comes to #${id}`);
  const nameless = await page.evaluate(() =>
    [...document.querySelectorAll("button, select, input, canvas")]
      .filter((element) => !element.getAttribute("aria-label") && !element.textContent.trim() && !element.labels?.length)
      .map((element) => element.outerHTML),
  );
  assert.deepEqual(nameless, []);
  await page.focus("#modes input");
  await page.keyboard.press("ArrowRight");
  assert.equal(await page.locator("#modes input:checked").getAttribute("value"), "side");
  await report.end();
});

test("fits a phone, light and dark", async () => {
  for (const [colorScheme, isDark] of [["light", false], ["dark", true]]) {
    const report = await open("report.html", { viewport: { width: 360, height: 740 }, colorScheme, hasTouch: true });
    const wide = await report.page.evaluate(() => [document.documentElement.scrollWidth, ...[...document.querySelectorAll("body *")]
      .filter((element) => element.getBoundingClientRect().right > 361 && !element.closest(".scroll, pre, svg"))
      .map((element) => element.outerHTML.slice(0, 99))]);
    assert.deepEqual(wide, [360]);
    const sum = await report.page.evaluate(() =>
      getComputedStyle(document.body).backgroundColor.match(/\d+/g).slice(0, 3).reduce((a, b) => a + Number(b), 0),
    );
    assert.equal(sum < 384, isDark);
    await report.end();
  }
});

test("names and texts neither break the page nor run", async () => {
  const evil = `"><script>window.ran=1</script><!-- ' & ü 漢 \\ `;
  mkdirSync(join(folder, evil.replaceAll("/", "∕"))); // a folder's name has no slash
  const shot = join(evil.replaceAll("/", "∕"), "shot");
  mkdirSync(join(folder, shot));
  for (const frame of ["0001", "0002"]) cpSync(join(sample, `color_1spp.${frame}.exr`), join(folder, shot, `color.${frame}.exr`));
  const graph = {
    quell: 1,
    name: `</script>${evil}`,
    doc: `</title></script>${evil}<img src=x onerror=window.ran=1>`,
    inputs: { color: { type: "color", doc: evil } },
    nodes: { twice: { pass: "gaussian", doc: `]]>${evil}`, in: { image: "color" } } },
    outputs: { color: "twice.image" },
  };
  writeFileSync(join(folder, "evil.json"), JSON.stringify(graph));
  run("report", shot, `<b onclick=window.ran=1>${evil.replaceAll("/", "∕").replaceAll("=", "≡")}=evil.json`.replace("onclick=window.ran=1", "x"), "-o", "evil.html");
  const report = await open("evil.html");
  await choosePixel(report, 160, 90);
  await report.press("s");
  assert.equal(await report.page.evaluate(() => window.ran), undefined);
  assert.equal(await report.page.locator("main img, main script, main b[x]").count(), 0);
  assert.match(await report.page.textContent("h1"), /^<b x>"><script>/);
  assert.match(await report.page.textContent("#about"), /"><script>.* & ü 漢 \\/);
  assert.match(await report.page.textContent("#drawings-body"), /<\/title><\/script>"><script>window\.ran=1<\/script>/);
  assert.match(await report.page.textContent("#provenance-body"), /<\/script>/);
  await report.end();
});
