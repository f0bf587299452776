// SPDX-License-Identifier: Apache-2.0
// Pictures of every screen of a running console, in three sizes and three themes, to be looked at:
//
//   node tests/browser/look.mjs "$(mgt console)" docs/console
//   node tests/browser/look.mjs ADDRESS-OF-MGT-SERVE FOLDER RUN.mgtrun [add]
//
// Of a run also what stands behind each button of the workbench; nothing is changed in it, unless the word add has the first
// suspect added, and taken out again. Says where an element leaves the
// page, is cut, or lies over another.
import { mkdirSync } from "node:fs";
import { Browser, until } from "./browser.mjs";

const [url, folder, run, add] = process.argv.slice(2);
if (!url || !folder) {
  console.error("usage: node tests/browser/look.mjs URL FOLDER [RUN]");
  process.exit(2);
}
mkdirSync(folder, { recursive: true });
const browser = await Browser.start();
let wrong = 0;

/** Texts that leave the page or their button, and cards that lie over each other. */
const faults = (width) => `(() => {
  const out = [], seen = (e) => e.getClientRects().length > 0, name = (e) => e.id || e.dataset.panel || e.textContent.slice(0, 30);
  if (document.documentElement.scrollWidth > ${width}) out.push((document.documentElement.scrollWidth - ${width}) + " px beyond the right edge");
  for (const e of document.querySelectorAll("button, h1, h2, h3, p, figure, .card, li")) {
    if (!seen(e) || e.closest("#tool")) continue;
    const box = e.getBoundingClientRect();
    if (box.right > ${width} + 1) out.push(name(e) + ": leaves the page");
    if (e.scrollWidth > e.clientWidth + 2 && e.clientWidth > 0) out.push(name(e) + ": its text is cut");
  }
  const boxes = [...document.querySelectorAll("figure, .card")].filter(seen).filter((e) => !e.parentElement.closest("figure, .card")).map((e) => [name(e), e.getBoundingClientRect()]);
  for (const [i, [a, p]] of boxes.entries()) for (const [b, q] of boxes.slice(i + 1))
    if (p.left < q.right - 1 && q.left < p.right - 1 && p.top < q.bottom - 1 && q.top < p.bottom - 1) out.push(a + " and " + b + " overlap");
  return out;
})()`;

async function picture(name) {
  await browser.run("scrollTo(0, 0)");
  await new Promise((resolve) => setTimeout(resolve, 300));  // points have come to rest
  for (const fault of await browser.run(faults(Number(/\d{3,}/.exec(name)[0])))) {
    console.log(`${name}: ${fault}`);
    ++wrong;
  }
  await browser.picture(`${folder}/${name}.png`);
}
/** By the button, so that everything that is drawn gets its colours. */
const theme = (name) => browser.run(`while ((document.documentElement.dataset.theme ?? "") !== "${name}") document.getElementById("theme").click()`);

async function rig(width) {
  await until(async () => (await browser.text("link")) === "live", "a live stream");
  await new Promise((resolve) => setTimeout(resolve, 5000));  // the lanes fill
  for (const colours of ["light", "dark", "sun"]) {
    await theme(colours);
    for (const screen of ["live", "run", "calibrations", "workbench"]) {
      await browser.click(`tab-${screen}`);
      await new Promise((resolve) => setTimeout(resolve, 1200));
      await picture(`${screen}-${width}-${colours}`);
    }
  }
}

async function workbench(width) {
  await until(() => browser.run(`document.querySelector('[data-run="${run}"]') !== null`), `${run} in the list`);
  await picture(`runs-${width}-light`);
  await browser.run(`document.querySelector('[data-run="${run}"]').click()`);
  await until(() => browser.run("'shown' in document.getElementById('bench-run').dataset"), "the run");
  await browser.run("document.querySelector('.suspect').click()");
  await until(() => browser.run("document.getElementById('try') !== null"), "the evidence");
  for (const colours of ["light", "dark", "sun"]) {
    await theme(colours);
    await browser.click("tool-alike");
    await picture(`workbench-${width}-${colours}`);
  }
  for (const tool of ["next", "formula", "limits", "parameters", "history"]) {
    await browser.click(`tool-${tool}`);
    await picture(`workbench-${tool}-${width}`);
  }
  if (!add) return;
  const changed = async (id) => {
    const before = await browser.run("document.getElementById('bench-run').dataset.shown");
    await browser.click(id);
    await until(() => browser.run(`![undefined, "${before}"].includes(document.getElementById("bench-run").dataset.shown)`), id);
  };
  await browser.click("tool-history");
  await changed("add");
  for (const colours of ["light", "dark", "sun"]) {
    await theme(colours);
    await picture(`workbench-added-${width}-${colours}`);
  }
  await changed("undo");
}

for (const [width, height] of [[1280, 800], [1024, 768], [390, 844]]) {
  await browser.open(url, width, height);
  await (run ? workbench(width) : rig(width));
}
for (const line of browser.log) console.log(`the browser says: ${line}`);
await browser.close();
process.exit(wrong + browser.log.length > 0 ? 1 : 0);
