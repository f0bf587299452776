// SPDX-License-Identifier: Apache-2.0
// That everybody can use the page and the report: axe-core has no serious and no critical finding in any screen of the
// console, in the workbench with what stands behind each of its buttons, and in the report; each in every theme, and small.
//
//   node tests/browser/access.mjs build/bin
//
// Exit code 0: so it is. 1: it is not. 77: not run, because chromium or axe-core is missing.
import { execFileSync, spawn } from "node:child_process";
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { dirname, join } from "node:path";
import { fileURLToPath, pathToFileURL } from "node:url";
import { findings, needAxe } from "./axe.mjs";
import { Browser, needBrowser, until } from "./browser.mjs";
import { Rig } from "./rig.mjs";

const bin = process.argv[2];
if (!bin) {
  console.error("usage: node tests/browser/access.mjs BIN");
  process.exit(2);
}
needBrowser();
needAxe();
const kSpeed = 10, kWide = [1280, 800], kSmall = [390, 844], kThemes = ["light", "dark", "sun"];
const here = dirname(fileURLToPath(import.meta.url)), folder = mkdtempSync(join(tmpdir(), "mgtd-access-"));
let views = 0, found = 0, browser = null, rig = null, server = null, failed = false;

async function judged(what) {
  ++views;
  for (const finding of await findings(browser)) {
    console.error(`${what}: ${finding}`);
    ++found;
  }
}
const theme = (name) => browser.run(`while ((document.documentElement.dataset.theme ?? "") !== "${name}") document.getElementById("theme").click()`);

async function console_(size) {
  await browser.open(rig.ask("console").url, ...size);
  await until(async () => (await browser.text("link")) === "live", "a live stream");
  await until(() => browser.run("document.querySelector('#cards table') !== null"), "the instruments");
  for (const colours of kThemes) {
    await theme(colours);
    for (const screen of ["live", "run", "calibrations", "workbench"]) {
      await browser.click(`tab-${screen}`);
      await judged(`console, ${screen}, ${size[0]} px, ${colours}`);
    }
  }
}

const opened = (run) => browser.run(`document.querySelector('[data-run="${run}"]').click()`)
  .then(() => until(() => browser.run("'shown' in document.getElementById('bench-run').dataset"), `the run ${run}`));
const listed = (run) => until(() => browser.run(`document.querySelector('[data-run="${run}"]') !== null`), `${run} in the list`);

async function workbench(size, address) {
  await browser.open(address, ...size);
  await listed("hidden.mgtrun");
  await judged(`workbench, the runs, ${size[0]} px`);
  await opened("hidden.mgtrun");
  await browser.run("document.querySelector('.candidate').click()");
  await until(() => browser.run("document.getElementById('try') !== null"), "the evidence");
  await browser.run("for (const e of document.querySelectorAll('details')) e.open = true");
  await browser.run("document.querySelector('#panels figure button').click()");
  for (const colours of kThemes) {
    await theme(colours);
    await judged(`workbench, ${size[0]} px, ${colours}`);
  }
  for (const tool of ["next", "formula", "law", "alike", "limits", "parameters", "history"]) {
    await browser.click(`tool-${tool}`);
    await judged(`workbench, ${tool}, ${size[0]} px`);
  }
  await browser.click("bench-runs");
  await listed("flat.csv");
  await opened("flat.csv");
  await judged(`workbench, a refused fit, ${size[0]} px`);
}

try {
  const run = join(folder, "hidden.mgtrun"), poses = join(folder, "poses.csv"), report = join(folder, "report.html");
  execFileSync(join(bin, "mgt-rig"), ["table", "--scenario", join(here, "../scenarios/hidden_temperature.toml"), "-o", poses]);
  execFileSync(join(bin, "mgt"), ["import", poses, "-o", run], { stdio: "ignore" });
  writeFileSync(join(folder, "flat.csv"), readFileSync(poses, "utf8").split("\n").slice(0, 31).join("\n") + "\n");
  execFileSync(join(bin, "mgt"), ["report", run, "--with", "axis.offset.temperature@s3.z", "-o", report], { stdio: "ignore" });
  let address = "";
  server = spawn(join(bin, "mgt"), ["serve", folder], { stdio: ["ignore", "pipe", "ignore"] });
  server.stdout.on("data", (bytes) => { address += bytes; });
  await until(() => address.includes("\n"), "the address");
  rig = await Rig.start(bin, kSpeed);
  await rig.startDaemon();
  browser = await Browser.start();
  for (const size of [kWide, kSmall]) {
    await workbench(size, address.trim());
    await console_(size);
    await browser.open(pathToFileURL(report).href, ...size, "document.readyState === 'complete' && document.querySelector('figure') !== null");
    await browser.run("for (const e of document.querySelectorAll('details')) e.open = true");
    for (const [media, colours] of [["screen", "light"], ["screen", "dark"], ["print", "light"]]) {
      await browser.media(media, colours);
      await judged(`report, ${size[0]} px, ${media}, ${colours}`);
    }
    await browser.media("screen", "light");
  }
  await browser.run("document.body.append(document.createElement('button'))");
  if ((await findings(browser)).length === 0) throw new Error("a button without a name was planted, and not found");
  console.log(`${views} views, ${found} serious or critical findings`);
} catch (error) {
  failed = true;
  console.error(error.message);
  if (browser) console.error(browser.log.join("\n"));
} finally {
  if (browser) await browser.close();
  if (rig) await rig.stop();
  if (server) {
    const ended = new Promise((resolve) => server.once("exit", resolve));
    server.kill("SIGINT");
    await ended;
  }
  rmSync(folder, { recursive: true, force: true });
}
process.exit(failed || found > 0 ? 1 : 0);
