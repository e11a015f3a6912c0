// Makes page.html of what Vite built: the script comes last, behind the data, nothing but it may run, and a stamp of the source
// tells when the page is out of date (sources.cmake computes the same).
import { createHash } from "node:crypto";
import { readFileSync, writeFileSync } from "node:fs";
import { execFileSync } from "node:child_process";

const built = readFileSync("dist/index.html", "utf8");
const script = /<script type="module"[^>]*>([\s\S]*?)<\/script>\s*/.exec(built);
if (!script) throw new Error("Vite built no script into the page");
const hash = createHash("sha256").update(script[1]).digest("base64");
const policy = `default-src 'none'; script-src 'sha256-${hash}'; style-src 'unsafe-inline'; img-src data: blob:; base-uri 'none'; form-action 'none'`;
const source = /[0-9a-f]{64}/.exec(execFileSync("cmake", ["-P", "sources.cmake"], { encoding: "utf8" }));
if (!source) throw new Error("sources.cmake tells no stamp");
const page = built
  .replace(script[0], () => "")
  .replace("<head>", () => `<head>\n    <!-- made from apps/report by npm run build; source ${source[0]} -->\n    <meta http-equiv="Content-Security-Policy" content="${policy}" />`)
  .replace("</body>", () => `<script type="module">${script[1]}</script>\n  </body>`);
if (!page.startsWith("<!doctype html>\n<!-- quell report -->\n")) throw new Error("the page has another beginning than quell expects");
writeFileSync("page.html", page);
