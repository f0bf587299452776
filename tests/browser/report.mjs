// SPDX-License-Identifier: Apache-2.0
// The report of 157 poses with an effect in the model: one file of at most 1.5 MB that runs nothing and asks nobody, and
// prints to pages of A4, none of them empty, none with a heading at its foot, whose text can be searched.
//
//   node tests/browser/report.mjs build/bin [FOLDER]     FOLDER gets the report and its print
//
// Exit code 0: so it is. 1: it is not. 77: not run, because chromium or pdftotext is missing.
import { execFileSync, spawnSync } from "node:child_process";
import { mkdirSync, mkdtempSync, rmSync, statSync } from "node:fs";
import { tmpdir } from "node:os";
import { dirname, join } from "node:path";
import { fileURLToPath, pathToFileURL } from "node:url";
import { Browser, needBrowser } from "./browser.mjs";

const [bin, kept] = process.argv.slice(2);
if (!bin) {
  console.error("usage: node tests/browser/report.mjs BIN [FOLDER]");
  process.exit(2);
}
needBrowser();
if (spawnSync("pdftotext", ["-v"]).error) {
  console.log("not run: pdftotext is not installed (apt-get install poppler-utils)");
  process.exit(77);
}
const kLargest_bytes = 1.5e6, kLeastText = 100, kFewestPages = 5, kMostPages = 30;
const here = dirname(fileURLToPath(import.meta.url)), folder = kept ?? mkdtempSync(join(tmpdir(), "mgtd-report-"));
if (kept) mkdirSync(kept, { recursive: true });
const poses = join(folder, "poses.csv"), page = join(folder, "report.html"), print = join(folder, "report.pdf");
execFileSync(join(bin, "mgt-rig"), ["table", "--scenario", join(here, "../scenarios/hidden_temperature.toml"), "-o", poses]);
const made = JSON.parse(execFileSync(join(bin, "mgt"), ["report", poses, "--with", "axis.offset.temperature@s3.z", "-o", page, "--json"], { stdio: ["ignore", "pipe", "ignore"] }));

function holds(what, good, found) {
  if (!good) throw new Error(`${what}: ${JSON.stringify(found)}`);
  console.log(`  ${what}: ${JSON.stringify(found)}`);
}
let browser = null, failed = false;
try {
  const { size } = statSync(page);
  holds(`at most ${kLargest_bytes} bytes, and as many as mgt says`, size <= kLargest_bytes && size === made.bytes, size);
  browser = await Browser.start();
  await browser.open(pathToFileURL(page).href, 1280, 800, "document.readyState === 'complete' && document.querySelector('figure') !== null");
  const active = await browser.run(`[...document.querySelectorAll("script, iframe, object, embed, link, form")].map((e) => e.tagName)
    .concat([...document.querySelectorAll("*")].flatMap((e) => [...e.attributes]).filter((a) => a.name.startsWith("on") || /^\\s*javascript:/i.test(a.value)).map((a) => a.name))`);
  holds("nothing in it runs", active.length === 0, active);
  const loaded = await browser.run("performance.getEntriesByType('resource').map((e) => e.name)");
  holds("it loads nothing", loaded.length === 0, loaded);
  const headings = await browser.run("[...document.querySelectorAll('h2, h3')].map((e) => e.textContent)");
  holds("nine panels are in it", ["Residual against time", "Residual against azimuth", "Are the residuals normal?", "Closure against time"].every((h) => headings.includes(h)), headings.length);

  await browser.print(print);
  const info = execFileSync("pdfinfo", [print], { encoding: "utf8" });
  holds("pages of A4", /Page size: .*\(A4\)/.test(info), /Page size:.*/.exec(info)?.[0]);
  const pages = execFileSync("pdftotext", [print, "-"], { encoding: "utf8" }).split("\f").slice(0, -1);
  holds(`${kFewestPages} to ${kMostPages} pages`, pages.length >= kFewestPages && pages.length <= kMostPages, pages.length);
  const text = pages.map((p) => p.replace(/\s+/g, " ").trim());
  holds("no page is empty", text.every((t) => t.length >= kLeastText), text.map((t) => t.length));
  const foot = pages.map((p) => p.trim().split("\n").at(-1).trim()).filter((line) => headings.includes(line));
  holds("no heading stands at the foot of a page", foot.length === 0, foot);
  holds("the verdict is on the first page, every section on one", text[0].includes(made.verdict) &&
        (await browser.run("[...document.querySelectorAll('h2')].map((e) => e.textContent)")).every((h) => text.some((t) => t.includes(h))), made.verdict);
  holds("the browser has nothing to complain of", browser.log.length === 0, browser.log);
} catch (error) {
  failed = true;
  console.error(error.message);
} finally {
  if (browser) await browser.close();
  if (!kept) rmSync(folder, { recursive: true, force: true });
}
process.exit(failed ? 1 : 0);
