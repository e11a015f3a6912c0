// Makes page.html of what Vite built: the script comes last, behind the data, nothing but it may run, the licenses of the libraries
// in it come with it, and a stamp of the source tells when the page is out of date (sources.cmake computes the same).
import { createHash } from "node:crypto";
import { readdirSync, readFileSync, writeFileSync } from "node:fs";
import { execFileSync } from "node:child_process";

/** Of the libraries that the page uses, and of those that they use: each text once, below the names it is for. */
function collectLicenses(names) {
  const found = new Map();
  const seen = new Set();
  for (const queue = [...names]; queue.length; ) {
    const name = queue.pop();
    if (seen.has(name)) continue;
    seen.add(name);
    const folder = `node_modules/${name}`;
    const { version, dependencies } = JSON.parse(readFileSync(`${folder}/package.json`, "utf8"));
    const file = readdirSync(folder).find((entry) => /^licen[cs]e/i.test(entry));
    if (!file) throw new Error(`${name} has no license file`);
    const text = readFileSync(`${folder}/${file}`, "utf8").trim();
    found.set(text, [...(found.get(text) ?? []), `${name} ${version}`]);
    queue.push(...Object.keys(dependencies ?? {}));
  }
  return [...found].map(([text, all]) => `${all.sort().join(", ")}\n\n${text}\n`).sort().join(`\n${"-".repeat(72)}\n\n`);
}

const built = readFileSync("dist/index.html", "utf8");
const script = /<script type="module"[^>]*>([\s\S]*?)<\/script>\s*/.exec(built);
if (!script) throw new Error("Vite built no script into the page");
const hash = createHash("sha256").update(script[1]).digest("base64");
const policy = `default-src 'none'; script-src 'sha256-${hash}'; style-src 'unsafe-inline'; img-src data: blob:; base-uri 'none'; form-action 'none'`;
const source = /[0-9a-f]{64}/.exec(execFileSync("cmake", ["-P", "sources.cmake"], { encoding: "utf8" }));
if (!source) throw new Error("sources.cmake tells no stamp");
const licenses = collectLicenses(["@observablehq/plot", "d3-scale-chromatic"]);
if (/<[/!]/.test(licenses)) throw new Error("a license's text would end its element");
const page = built
  .replace(script[0], () => "")
  .replace("<head>", () => `<head>\n    <!-- made from apps/report by npm run build; source ${source[0]} -->\n    <meta http-equiv="Content-Security-Policy" content="${policy}" />`)
  .replace("</body>", () => `<script type="text/plain" id="licenses">${licenses}</script>\n    <script type="module">${script[1]}</script>\n  </body>`);
if (!page.startsWith("<!doctype html>\n<!-- quell report -->\n")) throw new Error("the page has another beginning than quell expects");
writeFileSync("page.html", page);
