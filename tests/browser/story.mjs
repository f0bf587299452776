// SPDX-License-Identifier: Apache-2.0
// The story of a hidden effect, by clicks alone: a run with an effect that nobody told is opened with mgt serve, the effect
// found, looked at and added, the error on held-out poses falls; undo, a mask, a formula, a veto. Every number of the page is
// held against mgt --json to the digit that is printed. A run whose fit is refused shows what was measured, and why.
//
//   node tests/browser/story.mjs build/bin
//
// Exit code 0: told. 1: something else happened. 77: not told, because chromium is missing.
import { execFileSync, spawn, spawnSync } from "node:child_process";
import { copyFileSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";
import { Browser, needBrowser, until } from "./browser.mjs";

const bin = process.argv[2];
if (!bin) {
  console.error("usage: node tests/browser/story.mjs BIN");
  process.exit(2);
}
needBrowser();
const here = dirname(fileURLToPath(import.meta.url)), folder = mkdtempSync(join(tmpdir(), "mgtd-story-"));
const kHostile = "<img src=x onerror=document.title=1>.csv";
const run = join(folder, "hidden.mgtrun");
execFileSync(join(bin, "mgt-rig"), ["table", "--scenario", join(here, "../scenarios/hidden_temperature.toml"), "-o", join(folder, "poses.csv")]);
execFileSync(join(bin, "mgt"), ["import", join(folder, "poses.csv"), "-o", run], { stdio: "ignore" });
copyFileSync(join(folder, "poses.csv"), join(folder, kHostile));
// The first 36 poses turn the table about the vertical alone: the readings lie on a plane, which is no calibration.
const flat = join(folder, "flat.mgtrun"), kFlatPoses = 36;
writeFileSync(join(folder, "flat.csv"), readFileSync(join(folder, "poses.csv"), "utf8").split("\n").slice(0, kFlatPoses + 1).join("\n") + "\n");
execFileSync(join(bin, "mgt"), ["import", join(folder, "flat.csv"), "-o", flat], { stdio: "ignore" });
rmSync(join(folder, "flat.csv"));

/** What the terminal says; exit code 1 is an answer. */
const mgt = (...words) => JSON.parse(spawnSync(join(bin, "mgt"), [...words, "--json"], { encoding: "utf8", maxBuffer: 1e8 }).stdout);
let told = 0;
function holds(what, good, found = "") {
  if (!good) throw new Error(`${what}${found === "" ? "" : `: ${JSON.stringify(found)}`}`);
  console.log(`  ${what}`);
  ++told;
}
/** Whether a text has the digits of a value, as many as it shows. */
function sameDigits(text, value) {
  const digits = (/\.(\d+)/.exec(text)?.[1] ?? "").length;
  return text.includes("e") ? Number(text) === Number(value.toExponential((/^-?\d\.?(\d*)e/.exec(text)?.[1] ?? "").length)) : text === value.toFixed(digits);
}
const at = (object, path) => path.split(".").reduce((o, key) => o?.[key], object);

const server = spawn(join(bin, "mgt"), ["serve", folder], { stdio: ["ignore", "pipe", "ignore"] });
let address = "", browser = null, failed = false;
server.stdout.on("data", (bytes) => { address += bytes; });
try {
  await until(() => address.includes("\n"), "the address");
  browser = await Browser.start();
  const text = (id) => browser.text(id), exists = (id) => browser.run(`document.getElementById("${id}") !== null`);
  const shown = () => browser.run("document.getElementById('bench-run').dataset.shown ?? ''");
  /** Does something that changes the model, and waits until the page shows the run as it is then. */
  async function changing(what) {
    const before = await shown();
    await what();
    await until(async () => { const now = await shown(); return now !== "" && now !== before; }, "the run with another model");
  }
  const type = (id, value) => browser.run(`{ const e = document.getElementById("${id}"); e.value = ${JSON.stringify(value)}; e.dispatchEvent(new Event("input", { bubbles: true })); }`);
  const key = (name) => browser.run(`document.body.dispatchEvent(new KeyboardEvent("keydown", { key: "${name}", bubbles: true }))`);
  /** Every number of the page that says where it comes from, held against the answers. */
  async function compared(answers, what) {
    const numbers = await browser.run("[...document.querySelectorAll('[data-key]')].filter((e) => e.getClientRects().length).map((e) => [e.dataset.key, e.textContent])");
    let count = 0;
    for (const [path, printed] of numbers) {
      const value = at(answers, path);
      if (value === undefined) continue;
      const same = typeof value === "number" ? sameDigits(printed, value) : printed === value;
      if (!same) throw new Error(`${what}: ${path} is ${printed} on the page and ${value} in the terminal`);
      ++count;
    }
    holds(`${what}: ${count} numbers and texts are those of the terminal`, count > 5, numbers);
  }

  await browser.open(address.trim());
  await until(() => browser.run("document.querySelectorAll('[data-run]').length === 4"), "four files in the list");
  holds("the name of a file is text, whatever it is", (await browser.run("document.querySelectorAll('main img').length")) === 0 && (await text("run-list")).includes("<img"));

  await browser.run("document.querySelector('[data-run=\"hidden.mgtrun\"]').click()");
  await until(async () => (await shown()) !== "", "the run");
  const explained = mgt("explain", run, "--confusion", "--impact");
  holds("the verdict is that something is missing", explained.verdict !== "PASS" && (await text("verdict")).startsWith(explained.verdict), await text("verdict"));
  await compared({ ...explained, compare: mgt("compare", run), fit: mgt("fit", run) }, "the run as it was measured");
  holds("nine panels", (await browser.run("document.querySelectorAll('#panels figure').length")) === 9);

  await key("]");
  holds("] marks a pose in all panels", (await text("pose")).startsWith("pose 1 "), await text("pose"));
  await key("Enter");
  holds("Enter selects it", (await text("selected")).startsWith("1 selected: 1"), await text("selected"));
  await key("Escape");

  await browser.run(`{ const c = document.querySelector("[data-panel=residual-time] canvas"), r = c.getBoundingClientRect(); c.setPointerCapture = () => {};
    const mouse = (what, x, y) => c.dispatchEvent(new PointerEvent(what, { clientX: r.left + x, clientY: r.top + y, pointerId: 1, bubbles: true }));
    mouse("pointerdown", 1, 1); mouse("pointermove", r.width - 1, r.height - 1); mouse("pointerup", r.width - 1, r.height - 1); }`);
  holds("a frame around all poses selects them all", (await text("selected")).startsWith("157 selected"), await text("selected"));
  await key("Escape");

  await browser.run("document.querySelector('.candidate').click()");
  await until(() => exists("add"), "the evidence");
  holds("the evidence is that of mgt why", (await text("evidence")).includes(mgt("why", explained.candidates[0].effect, run, "--at", explained.candidates[0].where, "--poses").figure.good));
  await browser.click("try");
  await until(async () => (await exists("change-state")) && (await text("change-state")).startsWith("tried"), "a try");
  holds("a try keeps nothing", mgt("model", run).model.length === 0);

  await changing(() => browser.click("add"));
  const [step] = mgt("model", run).history;
  holds("the effect is kept", step.action === "add" && (await text("change-state")) === "kept", step);
  holds("the error on held-out poses falls to the noise", step.result.held_out_after_nT < 0.05 * step.result.held_out_before_nT && step.result.held_out_after_nT < 1.1 * step.result.noise_nT);
  const after = mgt("explain", run, "--confusion", "--impact");
  await compared({ ...after, change: step.result, steps: [step.result] }, "with the effect");
  holds("nothing is left", after.verdict === "PASS" && (await text("verdict")).startsWith("PASS"));
  holds("the waterfall has gained a bar", (await browser.run("document.querySelectorAll('#fall li').length")) === 2);

  await browser.run("[...document.querySelectorAll('#candidates details')][0].open = true; [...document.querySelectorAll('.candidate')].find((e) => e.dataset.spec.startsWith('table.wobble')).click()");
  await until(async () => (await exists("add")) && (await text("evidence")).includes("table.wobble"), "the evidence for what is not there");
  await browser.click("add");
  await until(() => exists("force"), "a veto");
  holds("a veto has its reason", (await text("change-state")) === "not kept" && (await text("change")).includes("the limit is"), await text("change"));

  await changing(() => browser.click("undo"));
  holds("undo takes the effect out again", mgt("model", run).model.length === 0 && (await text("verdict")).startsWith(explained.verdict));

  await key("]");
  await key("Enter");
  const pose = Number(/selected: (\d+)/.exec(await text("selected"))[1]);
  await type("mask-why", "a car stood beside the rig");
  await changing(() => browser.click("mask-button"));
  const [masked] = mgt("model", run).masked;
  holds("a pose is masked, with the reason", masked?.pose === pose && masked.because === "a car stood beside the rig", masked);
  await browser.click("tool-history");
  holds("the history tells it", (await text("tool")).includes("a car stood beside the rig"));

  await browser.click("tool-formula");
  await browser.run("{ const f = document.getElementById('formula-form').elements.formula; f.value = 'T_degC - 20'; f.dispatchEvent(new Event('input', { bubbles: true })); }");
  await until(async () => (await text("formula-said")).includes("mine at"), "the formula examined while it is typed");
  holds("nothing is kept while one types", mgt("model", run).formulas.length === 0);
  await changing(() => browser.click("formula-keep"));
  holds("the formula is kept when asked", mgt("model", run).formulas[0]?.name === "mine");

  await browser.click("tool-next");
  await browser.click("ask-next");
  await until(async () => (await text("tool")).includes("minutes"), "what to measure next");
  await browser.click("tool-law");
  await browser.click("ask-law");
  await until(() => browser.run("document.querySelector('[data-key=\"law-verdict\"]') !== null"), "the search for a law");
  const law = mgt("discover", run);
  holds("the law is that of mgt discover", (await text("tool")).startsWith(law.verdict) && (await text("tool")).includes(law.formulas[0].formula) && !(await text("tool")).includes("[object"), await text("tool"));
  await changing(() => browser.click("keep-law"));
  holds("its formula is kept in the model", mgt("model", run).model.some((spec) => spec.startsWith("law1@")), mgt("model", run).model);

  await browser.click("bench-runs");
  await until(() => browser.run("document.querySelector('[data-run=\"poses.csv\"]') !== null"), "the list again");
  await browser.run("document.querySelector('[data-run=\"poses.csv\"]').click()");
  await until(async () => (await shown()) !== "", "the pose table");
  await browser.click("bench-import");
  await until(async () => (await text("run-name")) === "poses.mgtrun" && (await shown()) !== "", "a run file made of it");
  holds("a pose table becomes a run file", mgt("model", join(folder, "poses.mgtrun")).model.length === 0 && !(await browser.run("document.getElementById('mask').hidden")));

  await browser.click("bench-runs");
  await until(() => browser.run("document.querySelector('[data-run=\"flat.mgtrun\"]') !== null"), "the list again");
  await browser.run("document.querySelector('[data-run=\"flat.mgtrun\"]').click()");
  await until(async () => (await shown()) !== "", "the run that is refused");
  const refused = mgt("compare", flat, "--poses");
  holds("a refused fit has its reason, and what to do", refused.error.message.includes("lie on a plane") && (await text("refusal")) === `${refused.error.message}: ${refused.error.remedy}`, await text("refusal"));
  const drawn = await browser.run(`[...document.querySelectorAll("#panels figure")].map((f) => { const c = f.querySelector("canvas");
    return [f.dataset.panel, new Set(new Uint32Array(c.getContext("2d").getImageData(0, 0, c.width, c.height).data.buffer)).size]; })`);
  holds("its panels show what was measured", drawn.length === refused.panels.length && drawn.every(([name, colours], i) => name === refused.panels[i].name && colours > 8), drawn);
  holds("their sentences are those of mgt compare", (await browser.run("document.querySelector('[data-panel=measured-skies]').innerText")).includes(refused.panels[1].good.slice(refused.panels[1].good.indexOf("Here "))));
  holds("no card is empty", await browser.run("[...document.querySelectorAll('#bench-run .card')].every((c) => c.getClientRects().length === 0 || c.innerText.trim() !== '')"));
  await key("]");
  holds("its poses can be walked through", (await text("pose")).startsWith(`pose ${refused.poses.pose[0]} `) && (await text("pose")).includes("F 53"), await text("pose"));
  await browser.click("tool-parameters");
  holds("in the place of parameters stands the reason", (await text("tool")).includes("lie on a plane"));
  holds("the reason is said once", await browser.run("document.getElementById('banner').hidden"), await text("banner"));

  holds("the browser has nothing to complain of", browser.log.length === 0, browser.log);
  console.log(`told: ${told} things`);
} catch (error) {
  failed = true;
  console.error(error.message);
  if (browser) console.error(browser.log.join("\n"), (await browser.run("document.getElementById(\"bench-side\").innerText + document.getElementById(\"banner\").innerText")).slice(0, 3000));
} finally {
  if (browser) await browser.close();
  const ended = new Promise((resolve) => server.once("exit", resolve));
  server.kill("SIGINT");
  if ((await ended) !== 0) { failed = true; console.error("mgt serve did not end with exit code 0"); }
  rmSync(folder, { recursive: true, force: true });
}
process.exit(failed ? 1 : 0);
