// SPDX-License-Identifier: Apache-2.0
// Every screen of the console in three sizes and three themes, on a simulated rig and on a run with a hidden effect: whether
// something leaves the page, is cut, lies over another, or is too small to read (structure.mjs); and a picture of each, to be
// looked at.
//
//   node tests/browser/look.mjs build/bin             looks at the structure
//   node tests/browser/look.mjs build/bin FOLDER      and takes the pictures, FOLDER/SCREEN-WIDTH-THEME.png
//   node tests/browser/look.mjs build/bin docs/console --shown
//                                                     takes those alone that FOLDER has already, of the top of the page
//
// Exit code 0: nothing is wrong. 1: something is, and printed. 77: not looked, because chromium is missing.
import { execFileSync, spawn } from "node:child_process";
import { existsSync, mkdirSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";
import { Browser, needBrowser, until } from "./browser.mjs";
import { Rig } from "./rig.mjs";
import { kCanvasTexts, kFaults } from "./structure.mjs";

const [bin, pictures, only] = process.argv.slice(2);
if (!bin || (only && only !== "--shown")) {
  console.error("usage: node tests/browser/look.mjs BIN [FOLDER [--shown]]");
  process.exit(2);
}
needBrowser();
if (pictures) mkdirSync(pictures, { recursive: true });
const kSizes = [[1280, 800], [1024, 768], [390, 844]], kThemes = ["light", "dark", "sun"], kSpeed = 10, kPatience_ms = 5000;
const kRandom = pictures ? 30 : 10, kPoses = pictures ? 36 : 24;  // of the run: planned at random, and measured when it is looked at
const here = dirname(fileURLToPath(import.meta.url)), scratch = mkdtempSync(join(tmpdir(), "mgtd-look-")), folder = join(scratch, "magnetics");
let views = 0, wrong = 0, browser = null, rig = null, server = null, failed = false;

const drawn = () => browser.run("new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(() => setTimeout(done, 50))))");
const theme = (name) => browser.run(`while ((document.documentElement.dataset.theme ?? "") !== "${name}") document.getElementById("theme").click()`);
const is = (expression, what) => until(() => browser.run(expression), what);
const press = (where, text) => browser.run(`[...document.querySelectorAll("${where} button")].find((b) => b.textContent === "${text}").click()`);

/** What the page shows now, in all sizes and themes. */
async function look(screen) {
  for (const [width, height] of kSizes) {
    await browser.size(width, height);
    for (const colours of kThemes) {
      const name = `${screen}-${width}-${colours}`, path = pictures ? join(pictures, `${name}.png`) : null;
      await theme(colours);
      await browser.run("scrollTo(0, 0)");
      await drawn();
      let faults = [];  // those that stay: a drawing follows its new size or theme after a moment
      await until(async () => { faults = await browser.run(kFaults); return faults.length === 0; }, "no fault", kPatience_ms).catch(() => {});
      for (const fault of faults) {
        console.error(`${name}: ${fault}`);
        ++wrong;
      }
      ++views;
      if (!path || (only && !existsSync(path))) continue;
      await browser.scrollbars(false);
      if (only) await browser.size(width, 1.5 * height);
      await new Promise((resolve) => setTimeout(resolve, 600));  // points have come to rest
      await browser.picture(path, !only);
      await browser.size(width, height);
      await browser.scrollbars(true);
    }
  }
}

async function workbench(address) {
  const tool = async (name) => { await browser.click(`tool-${name}`); await look(`workbench-${name}`); };
  const opened = async (run) => {
    await is(`document.querySelector('[data-run="${run}"]') !== null`, `${run} in the list`);
    await browser.run(`document.querySelector('[data-run="${run}"]').click()`);
    await is("'shown' in document.getElementById('bench-run').dataset", run);
  };
  await browser.open(address, ...kSizes[0]);
  await is("document.querySelectorAll('[data-run]').length === 3", "the runs");
  await look("runs");
  await opened("hidden.mgtrun");
  await browser.run("document.querySelector('.candidate').click()");
  await is("document.getElementById('add') !== null", "the evidence");
  await browser.click("tool-alike");
  await look("workbench");
  for (const name of ["limits", "parameters"]) await tool(name);
  await browser.click("tool-next");
  await browser.click("ask-next");
  await is("document.getElementById('tool').innerText.includes('minutes')", "what to measure next");
  await look("workbench-next");
  await browser.click("tool-formula");
  await browser.run("{ const e = document.getElementById('formula-form').elements.formula; e.value = 'T_degC - 20'; e.dispatchEvent(new Event('input', { bubbles: true })); }");
  await is("document.getElementById('formula-said').innerText.includes('mine at')", "the formula examined");
  await look("workbench-formula");
  await browser.click("tool-law");
  await browser.click("ask-law");
  await is("document.querySelector('[data-key=\"law-verdict\"]') !== null", "the law");
  await look("workbench-law");
  await browser.click("tool-history");
  const before = await browser.run("document.getElementById('bench-run').dataset.shown");
  await browser.click("add");
  await is(`![undefined, "${before}"].includes(document.getElementById("bench-run").dataset.shown)`, "the run with the effect");
  await look("workbench-added");
  await browser.run("for (const e of document.querySelectorAll('details')) e.open = true");
  await browser.run("document.querySelector('#panels figure button').click()");
  await look("workbench-open");
  await browser.click("bench-runs");
  await opened("flat.csv");
  await look("refused");
}

async function running() {
  const paused = "document.getElementById('run-now').innerText.includes(': paused')";
  await browser.open(rig.ask("console").url, ...kSizes[0]);
  await is("document.getElementById('link').innerText === 'live' && document.querySelector('#cards table') !== null && document.querySelectorAll('#sensors .card').length === 4", "a live stream");
  await look("live-raw");
  await browser.click("tab-run");
  for (const [name, value] of Object.entries({ step_deg: 20, random: kRandom, revisits: 2, dwell_short_s: 1, dwell_long_s: 2 }))
    await browser.run(`{ const e = document.getElementById("run-form").elements["${name}"]; e.value = "${value}"; e.dispatchEvent(new Event("input", { bubbles: true })); }`);
  await browser.click("look");
  await is("document.getElementById('plan').innerText !== ''", "what the run would do");
  await look("form");
  await browser.click("start");
  // Until the accuracy is known; a pose that this computer has no time for pauses the run, which goes on then.
  const enough = "document.querySelectorAll('#course circle.known').length >= 3 && document.querySelectorAll('#course circle.measured').length >= " + kPoses;
  await until(async () => {
    if (await browser.run(paused)) await press("#run-now", "Resume");
    return browser.run(enough);
  }, "the accuracy of the poses so far");
  await browser.click("pause");
  await is(paused, "the run paused");
  await look("run");
  await browser.run("for (const e of document.querySelectorAll('#course details')) e.open = true");
  await look("run-open");
  rig.command("control", "break");  // the page keeps it for a while after what it last asked
  rig.command("run", "finish");
  await is("document.querySelectorAll('#proposal button').length === 2", "the calibration that the run proposes");
  await look("proposed");
  await press("#proposal", "Reject");
  await look("reject");
  await browser.click("reason-cancel");
  rig.command("control", "break");
  rig.command("calibrations", "accept", "latest", "--force", "--why", "the run was ended early");
  earlier();
  await browser.click("tab-calibrations");
  await is("document.getElementById('calibration-list').innerText.includes('active') && document.querySelectorAll('#calibration-history svg').length === 4", "the calibrations and how they moved");
  await look("calibrations");
  await browser.click("tab-workbench");
  await is("document.querySelector('[data-run]') !== null", "the run in the list");
  await look("rig-runs");
  await browser.click("tab-live");
  await is("!document.getElementById('calibration').innerText.includes('no calibration')", "the calibrated stream");
  if (pictures) await new Promise((resolve) => setTimeout(resolve, 20000));  // the lanes fill
  await look("live");
  rig.fault("unplug", "fluxgate2");
  await is("document.getElementById('cards').innerText.includes('gone')", "the sensor that is not there");
  await look("unplugged");
}

/** Another rig in the place of the one before; the page is left first, for it would miss the daemon that ends. */
async function another(scenario) {
  await browser.open("about:blank", ...kSizes[0], "true");
  await rig.stop();
  rig = null;
  rig = await Rig.start(bin, kSpeed, scenario);
  await rig.startDaemon();
}

/** An offset that goes with the temperature makes a calibration suspect that was made in the cool. */
async function suspect() {
  await another(`[rig]\nname = "warming"\nparameters = "table6"\n[temperature]\nstart_degC = 31.0\nramp_degC_per_h = 60.0\n` +
                `[[effect]]\nname = "axis.offset.temperature"\nwhere = "s3.z"\nnT_per_degC = 3.0\n`);
  const poses = join(scratch, "cool.csv"), cal = join(scratch, "cool.json");
  execFileSync(join(bin, "mgt-rig"), ["table", "--rig", "table6", "-o", poses]);
  execFileSync(join(bin, "mgt"), ["fit", poses, "-o", cal], { stdio: "ignore" });
  rig.command("calibrations", "import", cal, "--accept");
  await browser.open(rig.ask("console").url, ...kSizes[0]);
  await is("document.getElementById('cards').innerText.includes('suspect')", "the calibration that is suspect");
  await look("suspect");
}

/** A magnet comes near during a run. */
async function disturbed() {
  await another(`[rig]\nname = "disturbed"\nparameters = "table6"\n`);
  await browser.open(rig.ask("console").url, ...kSizes[0]);
  await browser.click("tab-run");
  rig.command("run", "start", "--step", "20", "--random", "10", "--dwell-short", "8", "--dwell-long", "8", "--detach");
  let near = 0;  // moved in every dwell, until the run has seen it
  await until(() => {
    const { state, pose } = rig.ask("run", "status");
    if (state === "dwelling" && pose >= 2) rig.magnet(near = 1 - near);
    return rig.ask("run", "course").disturbances.length > 0;
  }, "a disturbance");
  rig.magnet(0);
  rig.command("run", "pause");
  await is("/Disturbances of the field: [1-9]/.test(document.getElementById('course').innerText) && document.getElementById('run-now').innerText.includes(': paused')", "the disturbance on the page");
  await look("disturbed");
}

/** A run at a table that is turned by hand: what it asks for. */
async function byHand() {
  await another(`[rig]\nname = "by hand"\nparameters = "table6"\n[table]\nhands = "table"\n`);
  await browser.open(rig.ask("console").url, ...kSizes[0]);
  await browser.click("tab-run");
  rig.command("run", "start", "--random", "10", "--detach");
  await is("!document.getElementById('run-asking').hidden", "what the run asks a hand to do");
  await look("asking");
}

/** Calibrations of the same rig from other days, the later two after a knock against the second sensor. */
function earlier() {
  for (const [day, begin, knock_nT] of [["2026-03-02", 864000, 0], ["2026-07-20", 2864000, 0.02], ["2026-09-07", 4864000, 0.02]]) {
    const table = join(scratch, `${day}.csv`), cal = join(scratch, `${day}.json`);
    execFileSync(join(bin, "mgt-rig"), ["table", "--rig", "table6", "--begin", String(begin), "-o", table]);
    const [head, ...lines] = readFileSync(table, "utf8").trim().split("\n").map((line) => line.split(",")), t = head.indexOf("t_s"), y = head.indexOf("s2_y_nT"), t0 = Number(lines[0][t]);
    const dated = lines.map((line) => {
      line[y] = String(Number(line[y]) + knock_nT);
      line[t] = String(Number(line[t]) - t0);
      return [...line, new Date(Date.parse(`${day}T08:00:00Z`) + 1000 * Number(line[t])).toISOString()];
    });
    writeFileSync(table, [[...head, "t_utc"], ...dated].map((line) => line.join(",")).join("\n") + "\n");
    execFileSync(join(bin, "mgt"), ["fit", table, "-o", cal], { stdio: "ignore" });
    rig.command("calibrations", "import", cal);
  }
}

/** What the check is for is planted in the page, and has to be found. */
async function planted() {
  await browser.size(...kSizes[0]);
  const words = (style) => `const e = document.createElement("p"); e.textContent = "planted words"; e.style.cssText = "${style}"; document.querySelector("h1").append(e);`;
  const canvas = `const e = document.createElement("canvas"); document.querySelector("main").append(e); e.getContext("2d").fillText("planted words", 290, 20);`;
  for (const [fault, script] of [["px wider", words("width:3000px;height:1px")], ["text of 8.0 px", words("font-size:8px")], ["overlap", words("position:absolute;top:0;left:20px")],
                                 ["are cut", words("width:20px;overflow:hidden;white-space:nowrap")], ['words": cut', canvas], ["text of 10.0 px", canvas], ["drawn 300 px wide", canvas]]) {
    await browser.run(`{ ${script} e.id = "planted"; }`);
    const found = await browser.run(kFaults);
    await browser.run("document.getElementById('planted').remove()");
    if (!found.some((line) => line.includes(fault) && (line.includes("planted") || line.includes("px wide")))) throw new Error(`planted, and not found: ${fault}`);
  }
}

try {
  const scenario = join(here, "../scenarios/hidden_temperature.toml"), poses = join(folder, "poses.csv");
  mkdirSync(folder);
  execFileSync(join(bin, "mgt-rig"), ["table", "--scenario", scenario, "-o", poses]);
  execFileSync(join(bin, "mgt"), ["import", poses, "-o", join(folder, "hidden.mgtrun")], { stdio: "ignore" });
  writeFileSync(join(folder, "flat.csv"), readFileSync(poses, "utf8").split("\n").slice(0, 37).join("\n") + "\n");
  browser = await Browser.start();
  await browser.before(kCanvasTexts);
  let address = "";
  server = spawn(join(bin, "mgt"), ["serve", folder], { stdio: ["ignore", "pipe", "ignore"] });
  server.stdout.on("data", (bytes) => { address += bytes; });
  await until(() => address.includes("\n"), "the address");
  await workbench(address.trim());
  await planted();
  rig = await Rig.start(bin, kSpeed);
  await rig.startDaemon();
  await running();
  await suspect();
  await disturbed();
  await byHand();
  for (const line of browser.log) console.error(`the browser says: ${line}`);
  wrong += browser.log.length;
  console.log(`${views} views, ${wrong} faults`);
} catch (error) {
  failed = true;
  console.error(error.message);
  if (browser) console.error(browser.log.join("\n"), (await browser.run("document.body.innerText")).slice(0, 2000));
  if (rig) console.error(rig.said.slice(-2000));
} finally {
  if (browser) await browser.close();
  if (rig) await rig.stop();
  if (server) {
    const ended = new Promise((resolve) => server.once("exit", resolve));
    server.kill("SIGINT");
    await ended;
  }
  rmSync(scratch, { recursive: true, force: true });
}
process.exit(failed || wrong > 0 ? 1 : 0);
