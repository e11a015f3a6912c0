// What tests of the page need: a folder, the program, and a browser that opens what it wrote.
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { existsSync, mkdtempSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after, before } from "node:test";
import { pathToFileURL } from "node:url";

export const [quell, source] = process.argv.slice(2);
const browserFile = ["/usr/bin/chromium", "/usr/bin/chromium-browser", "/usr/bin/google-chrome"].find(existsSync);
const skip = (why) => {
  console.log(`skipped: ${why}`);
  process.exit(77);
};
if (!browserFile) skip("there is no chromium");
const { chromium } = await import("playwright-core").catch(() => skip("playwright-core is not installed: npm ci in tests/apps/report"));

const kFlags = ["--headless", "--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run", "--disable-background-networking", "--disable-component-update", "--disable-sync"];
export const folder = mkdtempSync(join(tmpdir(), "quell-report-"));
export const sample = join(source, "graphs/sample");
export const run = (...words) => execFileSync(quell, [...words, "-q"], { cwd: folder, stdio: ["ignore", "pipe", "pipe"] });
let browser;

before(async () => {
  browser = await chromium.launch({ executablePath: browserFile, args: kFlags });
});
after(async () => {
  await browser?.close();
  rmSync(folder, { recursive: true });
});

/** A page whose complaints and requests are told at the end. */
export async function open(file = "report.html", options = {}, timeout = 30_000) {
  const page = await browser.newPage({ viewport: { width: 1280, height: 900 }, ...options });
  const troubles = [];
  page.on("console", (message) => ["error", "warning"].includes(message.type()) && troubles.push(message.text()));
  page.on("pageerror", (error) => troubles.push(error.message));
  page.on("request", (request) => /^(file|data|blob):/.test(request.url()) || troubles.push(`asks for ${request.url()}`));
  await page.goto(pathToFileURL(join(folder, file)).href, { timeout });
  await page.evaluate(() => window.reportReady());
  const ready = () => page.evaluate(() => window.reportReady());
  return {
    page,
    ready,
    press: async (...keys) => {
      for (const key of keys) await page.keyboard.press(key);
      await ready();
    },
    /** The color of the canvas at a part of its width and height. */
    color: (x, y) =>
      page.evaluate(
        ([u, v]) => {
          const canvas = document.querySelector("canvas");
          const context = new OffscreenCanvas(1, 1).getContext("2d", { willReadFrequently: true });
          context.drawImage(canvas, -Math.floor(u * canvas.width), -Math.floor(v * canvas.height));
          return [...context.getImageData(0, 0, 1, 1).data].slice(0, 3);
        },
        [x, y],
      ),
    /** What the readout says of an image. */
    values: async (name) => {
      const text = await page.locator("#readout .values", { hasText: name }).locator("code").textContent();
      return text.replaceAll("−", "-").split(/\s+/).map(Number);
    },
    picture: () => page.evaluate(() => document.querySelector("canvas").toDataURL()),
    end: async () => {
      await page.close();
      assert.deepEqual(troubles, []);
    },
  };
}

export async function choosePixel({ page, ready }, x, y, [middleX, middleY] = [160, 90]) {
  await page.focus("#canvas");
  await page.keyboard.press("ArrowLeft"); // chooses the middle of the picture
  for (const [from, to, less, more] of [[middleX, x, "ArrowLeft", "ArrowRight"], [middleY, y, "ArrowUp", "ArrowDown"]]) {
    const key = to < from ? less : more;
    for (let i = 0; i < Math.floor(Math.abs(to - from) / 10); ++i) await page.keyboard.press(`Shift+${key}`);
    for (let i = 0; i < Math.abs(to - from) % 10; ++i) await page.keyboard.press(key);
  }
  await ready();
}
