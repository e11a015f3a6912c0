// The weights that the page shows of a filter's taps: they sum to 1 and reproduce what the pass gave, for every pass that is a mean.
//   node weights.test.mjs QUELL SOURCE_DIR
import assert from "node:assert/strict";
import { writeFileSync } from "node:fs";
import { join } from "node:path";
import { test } from "node:test";
import { choosePixel, folder, open, run, sample } from "./page.mjs";

const color = "color";
const guides = { normal: "normal", position: "position" };
const past = (from) => ({ from, delay: 1, initial: "none" });
const inputs = Object.fromEntries(["color", "albedo", "normal", "position", "depth", "id", "motion"].map((name) => [name, name]));

const spatial = {
  moments: { pass: "moments", in: { color } },
  slope: { pass: "depth_gradient", in: { depth: "depth" } },
  variance: { pass: "variance", in: { moments: "moments.moments", color, depth: "depth", depth_gradient: "slope.gradient", normal: "normal" },
    params: { filter_color: true, sigma_l: 2 } },
  variance_blur: { pass: "variance_blur", in: { variance: "variance.variance" } },
  variance_zero: { pass: "variance_blur", in: { variance: "variance.variance" }, params: { border: "zero" } },
  gaussian: { pass: "gaussian", in: { image: color }, params: { sigma: 1.5 } },
  bilateral: { pass: "bilateral", in: { color } },
  bilateral_separable: { pass: "bilateral", in: { color }, params: { separable: true } },
  joint: { pass: "joint_bilateral", in: { color, ...guides }, params: { radius: 5 } },
  joint_separable: { pass: "joint_bilateral", in: { color, ...guides }, params: { radius: 5, separable: true } },
  joint_world: { pass: "joint_bilateral", in: { color, ...guides }, params: { radius: 4, coord: "world", sigma_coord: 0.5, normal_measure: "difference" } },
  joint_z: { pass: "joint_bilateral", in: { color, ...guides }, params: { radius: 4, surface: "z", sigma_color: 3 } },
  joint_alone: { pass: "joint_bilateral", in: { color }, params: { radius: 3 } },
  svgf: { pass: "atrous", in: { color: "variance.color", normal: "normal", depth: "depth", variance: "variance.variance" }, params: { level: 1 } },
  svgf_given: { pass: "atrous", in: { color: "variance.color", normal: "normal", depth: "depth", variance: "variance.variance", depth_gradient: "slope.gradient",
    blurred_variance: "variance_blur.variance" }, params: { level: 2, sigma_l: 10, eps_variance: 1e-4 } },
  dammertz: { pass: "atrous", in: { color, ...guides }, params: { stops: "dammertz", level: 1, phi_normal: 1 } },
  games: { pass: "atrous", in: { color, ...guides }, params: { stops: "joint_bilateral", level: 1 } },
  nlm: { pass: "nlm", in: { color, variance: "variance.variance", feature: ["albedo", "normal"] }, params: { radius: 4, patch_radius: 1 } },
  half: { pass: "scale", in: { image: color } },
  half_depth: { pass: "scale", in: { image: "depth" } },
  half_normal: { pass: "scale", in: { image: "normal" } },
  half_motion: { pass: "scale", in: { image: "motion" }, params: { method: "average" } },
  double: { pass: "scale", in: { image: "half.image" }, params: { to: "double" } },
  double_guided: { pass: "scale", in: { image: "half.image", depth: "half_depth.image", normal: "half_normal.image", full_depth: "depth", full_normal: "normal" },
    params: { to: "double" } },
  mix: { pass: "mix", in: { a: color, b: "gaussian.image" }, params: { amount: 0.3 } },
};

const before = { motion: "motion", id: "id", previous_id: past("id"), depth: "depth", previous_depth: past("depth") };
const surfaces = { ...before, normal: "normal", previous_normal: past("normal"), position: "position", previous_position: past("position"), depth_gradient: "slope.gradient" };
const history = [past("blend.color"), past("moments.moments"), past("moments.length")];
const [old, oldMoments, oldLength] = [0, 1, 2].map((i) => `bilinear.history[${i}]`);
const valid = "bilinear.valid";
const blend = (params, more) => ({ pass: "temporal_blend", in: { color, history: old, valid, ...more }, params });
const anti = (params) => ({ pass: "taa", in: { color, history: "catmull.history", valid: "catmull.valid" }, params });
const temporal = {
  slope: { pass: "depth_gradient", in: { depth: "depth" } },
  bilinear: { pass: "reproject", in: { history, ...surfaces }, params: { plane_absolute: 0.5 } },
  catmull: { pass: "reproject", in: { history: [past("blend.color")], ...before }, params: { fetch: "catmull_rom" } },
  nearest: { pass: "reproject", in: { history: [past("blend.color")], motion: "motion" }, params: { fetch: "nearest" } },
  truncate: { pass: "reproject", in: { history: [past("blend.color")], motion: "motion" }, params: { fetch: "truncate" } },
  rescued: { pass: "reproject", in: { history: [past("blend.color")], ...surfaces }, params: { min_weight: 1, rescue: "3x3", depth_relative: 0.012, depth_slope: 0, plane_absolute: 0.5 } },
  light: { pass: "reproject", in: { history: [past("color")], ...before } },
  moments: { pass: "moments", in: { color, history: oldMoments, length: oldLength, valid } },
  blend: blend({}, { length: oldLength }),
  blend_as_it_is: blend({ clamp: "none" }),
  blend_published: blend({ spread: "center", count: "full", clamp_radius: 2 }),
  blend_range: blend({ clamp: "range", alpha: 0.05, clamp_radius: 1 }),
  blend_ycocg: blend({ space: "ycocg", clamp_k: 0.5 }),
  blend_trusted: blend({ clamp: "none" }, { length: oldLength, confidence: "bilinear.rejected" }),
  taa: anti({}),
  taa_range: anti({ box: "range", limit: "clamp" }),
  taa_variance: anti({ box: "variance", k: 0.5, weigh: false }),
  variance: { pass: "variance", in: { moments: "moments.moments", color, depth: "depth", normal: "normal" } },
  window: { pass: "window", in: { color, variance: "variance.variance", frames: ["light.history", old], valid: ["light.valid", valid] }, params: { radius: 2, k: 1 } },
  window_plain: { pass: "window", in: { color, frames: ["light.history"], valid: ["light.valid"] } },
  fix: { pass: "history_fix", in: { image: ["blend.color", "moments.moments"], length: "moments.length", depth: "depth", ...guides, id: "id" } },
  fix_depth: { pass: "history_fix", in: { image: [color], length: "moments.length", depth: "depth", depth_gradient: "slope.gradient", normal: "normal" }, params: { stride: 6 } },
  constant: { pass: "temporal_blend", in: { color, history: { from: "constant.color", delay: 2, initial: { constant: [0.25] } } }, params: { clamp: "none" } },
};
const ports = { gaussian: "image", variance_blur: "variance", scale: "image", mix: "image", reproject: "history", moments: "moments", history_fix: "image" };
const listed = ["reproject", "history_fix"];
const places = [[0, 0], [69, 49], [13, 7], [30, 25], [45, 40], [62, 3]];

/** A report of the graph's last frame, all nodes read. */
function write(name, nodes) {
  const outputs = Object.fromEntries(Object.entries(nodes).map(([node, { pass }]) => {
    const port = ports[pass] ?? (pass === "depth_gradient" ? "gradient" : "color");
    return [`of_${node}`, listed.includes(pass) ? `${node}.${port}[0]` : `${node}.${port}`];
  }));
  writeFileSync(join(folder, `${name}.json`), JSON.stringify({ quell: 1, inputs, nodes, outputs }));
  run("report", sample, `${name}.json`, "--frames", "1-2", "--crop", "200,60,70,50", "-o", `${name}.html`);
}

function judge(name, [x, y], found) {
  const where = `${name} at ${x}, ${y}`;
  const sum = found.taps.reduce((total, tap) => total + tap.weight, 0);
  assert.ok(Math.abs(sum - 1) < 1e-12, `${where}: ${sum}`);
  const most = 1e-5 * Math.max(...found.given.map(Math.abs)); // of its size: variances are small
  found.made.forEach((value, i) => assert.ok(Math.abs(value - found.given[i]) <= most, `${where}: ${found.made}, not ${found.given}`));
}

/** How many taps each place had, by node: 0 where a history was not found. */
async function judgeAll(report, nodes) {
  const counts = {};
  for (const [name, { pass }] of Object.entries(nodes)) {
    if (pass === "depth_gradient") continue;
    counts[name] = [];
    const isSmall = name.startsWith("half");
    for (const place of places) {
      const at = isSmall ? place.map((value) => value >> 1) : place;
      const found = await report.page.evaluate(([node, there]) => window.reportWeights(0, node, ...there), [name, at]);
      if (found === "no history was found here") {
        assert.equal(pass, "reproject");
        counts[name].push(0);
        continue;
      }
      assert.ok(found?.taps, `${name} at ${at}: ${found ?? "has no weights"}`);
      judge(name, at, found);
      counts[name].push(found.taps.length);
    }
    assert.ok(counts[name].filter((count) => count > 0).length >= 3, `${name}: ${counts[name]} taps`);
  }
  return counts;
}

test("every pass has weights that are tested here, or it is said why not", async () => {
  write("spatial", spatial);
  const report = await open("spatial.html");
  const { weighted, unweighted } = await report.page.evaluate(() => window.reportPasses);
  const tested = new Set([...Object.values(spatial), ...Object.values(temporal)].map(({ pass }) => pass));
  assert.deepEqual(weighted.filter((pass) => !tested.has(pass)), [], "have weights that no test looks at");
  const passes = run("passes").toString().split("\n").map((line) => /^[a-z]\w*/.exec(line)?.[0]).filter(Boolean);
  assert.ok(passes.length > 30, `${passes}`);
  assert.deepEqual(passes.filter((pass) => !weighted.includes(pass) && !unweighted.includes(pass)), [], "have neither weights nor a reason in taps.ts");
  await report.end();
});

test("weights of filters in space reproduce what their passes gave", async () => {
  const report = await open("spatial.html");
  const counts = await judgeAll(report, spatial);
  assert.deepEqual(counts.half, [4, 4, 4, 4, 4, 4]);
  assert.ok(counts.joint_separable[3] > 11, `${counts.joint_separable}`);
  await choosePixel(report, 30, 25, [35, 25]);
  const words = async (row) => {
    await report.page.locator("#story tr.weights", { hasText: row }).first().locator("summary").click();
    return report.page.textContent(`#story tr.weights:has-text("${row}") .taps p`);
  };
  assert.match(await words("joint_separable"), /^They sum to 1\.000000 and make .* of 'color' around x 30, y 25; the pass gave .*: (?:the same|\d\.\de[−]\d+ apart)\.$/);
  assert.match(await report.page.textContent("#story tr.weights:has-text('slope')"), /no weights: it yields a difference of neighbors/);
  await report.end();
});

test("weights of means over time reproduce what their passes gave, with the frame before", async () => {
  write("temporal", temporal);
  const report = await open("temporal.html");
  const counts = await judgeAll(report, temporal);
  assert.ok(counts.catmull.includes(16), `catmull: ${counts.catmull}`);
  assert.ok(counts.rescued.some((count) => count > 4), `rescued: ${counts.rescued}`);
  const grid = Array.from({ length: 70 }, (_, i) => [7 * (i % 10) + 3, 7 * Math.floor(i / 10) + 2]);
  for (const name of ["blend", "blend_range", "blend_ycocg", "blend_published", "taa", "taa_range", "taa_variance"]) {
    const found = await report.page.evaluate(([node, all]) => Promise.all(all.map((at) => window.reportWeights(0, node, ...at))), [name, grid]);
    found.forEach((weights, i) => judge(name, grid[i], weights));
    assert.ok(found.some(({ taps }) => taps.some((tap) => tap.port === "history, limited")), `${name} limits no history here`);
  }
  for (const name of ["blend", "taa", "moments"]) assert.ok(counts[name].includes(2), `${name} never has a history`);
  assert.ok(counts.window.includes(3), `window: ${counts.window}`);
  assert.ok(counts.fix.some((count) => count > 5), `fix: ${counts.fix}`);
  await choosePixel(report, 30, 25, [35, 25]);
  const row = report.page.locator("#story tr.weights", { hasText: "blend_range" }).first();
  await row.locator("summary").click();
  assert.deepEqual(await row.locator("tbody td:first-child").allTextContents(), ["history", "color"]);
  await report.end();
});

test("weights reproduce what passes gave in graphs that ship with quell, too", async () => {
  const graphs = ["best", "relax_lite", "svgf_falcor", "games202"];
  run("report", sample, ...graphs, "--frames", "1-3", "--crop", "120,40,120,100", "-o", "shipped.html");
  const report = await open("shipped.html");
  const { weighted } = await report.page.evaluate(() => window.reportPasses);
  const data = await report.page.evaluate(() => JSON.parse(document.getElementById("report").textContent).graphs);
  let count = 0;
  for (const [graph, { label, nodes }] of data.entries())
    for (const { name, pass } of nodes.filter((node) => weighted.includes(node.pass)))
      for (const [x, y] of places) {
        const found = await report.page.evaluate((what) => window.reportWeights(...what), [graph, name, x, y]);
        if (found === "no history was found here") continue;
        assert.ok(found?.taps, `${name} (${pass}) of ${label} at ${x}, ${y}: ${found}`);
        judge(`${name} of ${label}`, [x, y], found);
        ++count;
      }
  assert.ok(count > 150, `${count} pixels`);
  await report.end();
});
