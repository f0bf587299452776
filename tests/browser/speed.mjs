// SPDX-License-Identifier: Apache-2.0
// How fast and how light the console is: size of the page, time until it can be used, what the lanes and the viewers cost, how
// long the workbench takes to open. Measured on a simulated rig that sends 90 samples a second (what the line of a digitiser carries), in Chromium without a GPU.
//
//   node tests/browser/speed.mjs build/release/bin                          measures, and prints the table
//   node tests/browser/speed.mjs build/release/bin docs/console/speed.md    and writes the page
//   node tests/browser/speed.mjs build/bin --smoke                          does everything once, briefly, with a smaller array
//                                                                           of poses: that it can be measured, not how fast it is
//
// Exit code 0: measured. 1: something could not be done. 77: not measured, because chromium is missing.
import { execFileSync, spawn } from "node:child_process";
import { randomBytes } from "node:crypto";
import { existsSync, mkdirSync, mkdtempSync, readFileSync, readdirSync, rmSync, writeFileSync } from "node:fs";
import { connect } from "node:net";
import { cpus, tmpdir } from "node:os";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";
import { gzipSync } from "node:zlib";
import { Browser, needBrowser, until } from "./browser.mjs";
import { Rig } from "./rig.mjs";

const [bin, target] = process.argv.slice(2), smoke = target === "--smoke";
if (!bin) {
  console.error("usage: node tests/browser/speed.mjs BIN [FILE.md | --smoke]");
  process.exit(2);
}
needBrowser();
const here = dirname(fileURLToPath(import.meta.url)), page = join(here, "../../daemon/serve/console/page");
const kRate_hz = 90, kViewers = 4, kFill_s = smoke ? 2 : 65, kWatch_s = smoke ? 1 : 20, kOpenings = smoke ? 1 : 5;
const scratch = mkdtempSync(join(tmpdir(), "mgtd-speed-")), folder = join(scratch, "runs");
const pause = (s) => new Promise((resolve) => setTimeout(resolve, 1000 * s));
const table = [];
function measured(what, value, limit, how) {
  table.push({ what, value, limit, how });
  console.log(`${what}: ${value}${limit ? ` (limit ${limit})` : ""}`);
}

/** Seconds of processor time that a process and all it began have taken so far, of those that still live. */
function cpu_s(pid) {
  const stats = new Map();
  for (const name of readdirSync("/proc").filter((n) => /^\d+$/.test(n))) {
    try {
      const text = readFileSync(`/proc/${name}/stat`, "utf8"), field = text.slice(text.lastIndexOf(")") + 2).split(" ");
      stats.set(Number(name), { parent: Number(field[1]), ticks: Number(field[11]) + Number(field[12]) });
    } catch { /* it ended meanwhile */ }
  }
  const mine = (p) => p === pid || (stats.has(p) && stats.get(p).parent > 1 && mine(stats.get(p).parent));
  return [...stats].filter(([p]) => mine(p)).reduce((sum, [, s]) => sum + s.ticks / 100, 0);
}
/** Share of one core, in per cent, over a while. */
async function share(pid) {
  const before = cpu_s(pid), began = performance.now();
  await pause(kWatch_s);
  return (100 * (cpu_s(pid) - before)) / ((performance.now() - began) / 1000);
}

/** A viewer of the stream, as the page is one: a WebSocket that takes what comes and keeps nothing. */
async function viewer(address) {
  const { hostname, port } = new URL(address), socket = connect(Number(port), hostname);
  let bytes = 0, head = "";
  socket.on("error", () => {});
  socket.write(`GET /stream HTTP/1.1\r\nHost: ${hostname}:${port}\r\nOrigin: http://${hostname}:${port}\r\nConnection: Upgrade\r\nUpgrade: websocket\r\n` +
               `Sec-WebSocket-Version: 13\r\nSec-WebSocket-Key: ${randomBytes(16).toString("base64")}\r\n\r\n`);
  socket.on("data", (chunk) => { bytes += chunk.length; if (head.length < 100) head += chunk.toString("latin1"); });
  await until(() => head.includes("\r\n"), "an answer to a viewer");
  if (!head.startsWith("HTTP/1.1 101")) throw new Error(`a viewer was refused: ${head}`);
  // {"watch":{"class":["TENSOR","GAP","STATUS","RUN","SENSORS"]}} in a frame with a mask of zeros
  const wish = Buffer.from(`{"watch":{"class":["TENSOR","GAP","STATUS","RUN","SENSORS"]}}\n`);
  socket.write(Buffer.concat([Buffer.from([0x81, 0x80 | wish.length, 0, 0, 0, 0]), wish]));
  return { end: () => socket.destroy(), bytes: () => bytes };
}

/** As many samples as a line of 19200 Bd carries. */
const kScenario = `[rig]\nname = "fast"\nparameters = "table6"\n[sensors]\nrate_hz = ${kRate_hz}\n`;

async function live() {
  const rig = await Rig.start(bin, 1, kScenario), browser = await Browser.start();
  try {
    await rig.startDaemon();
    const { address } = rig.ask("console");
    await browser.before(`addEventListener("DOMContentLoaded", () => new MutationObserver((_, observer) => {
      if ("ready" in document.body.dataset) { window.usable_ms = performance.now(); observer.disconnect(); } }).observe(document.body, { attributes: true }));`);
    const times = [];
    for (let i = 0; i < kOpenings; ++i) {
      await browser.open(address);
      times.push(await browser.run("window.usable_ms"));
    }
    measured("page usable", `${Math.round(Math.min(...times))} ms`, "1 s", `least of ${kOpenings} loads on loopback, from the navigation until every control answers`);
    await until(() => browser.run("document.querySelector('#cards table') !== null"), "a live stream");
    const lanes = await browser.run("document.getElementById('canvas').clientHeight");
    if (!(lanes > 500)) throw new Error(`the lanes are ${lanes} px high`);
    await pause(kFill_s);
    measured(`12 lanes at ${kRate_hz} Hz, last minute`, `${(await share(browser.pid)).toFixed(0)} % of a core`, "30 %", `all processes of Chromium, 1280 x 800, ${kWatch_s} s with full lanes`);
    const rate = rig.ask("status").sampler.rate_hz;
    if (!smoke && Math.abs(rate - kRate_hz) > 5) throw new Error(`the rig sends ${rate} samples a second`);
    await browser.open("about:blank", 1280, 800, "true");
    const alone = await share(rig.pid), viewers = [];
    for (let i = 0; i < kViewers; ++i) viewers.push(await viewer(address));
    const watched = await share(rig.pid);
    if (!viewers.every((v) => v.bytes() > 10000 * kWatch_s)) throw new Error(`the viewers got ${viewers.map((v) => v.bytes())} bytes`);
    measured(`${kViewers} viewers`, `${(watched - alone).toFixed(1)} % of a core`, "2 %", `mgtd with every sample to each, less the ${alone.toFixed(1)} % that it takes without, ${kWatch_s} s each`);
    for (const v of viewers) v.end();
  } finally {
    await browser.close();
    await rig.stop();
  }
}

async function workbench() {
  mkdirSync(folder);
  const make = (name, ...words) => execFileSync(join(bin, "mgt-rig"), ["table", ...words, "-o", join(folder, name)], { stdio: "ignore" });
  make("usual.csv", "--scenario", join(here, "../scenarios/hidden_temperature.toml"));
  execFileSync(join(bin, "mgt"), ["import", join(folder, "usual.csv"), "-o", join(folder, "usual.mgtrun")], { stdio: "ignore" });
  if (!smoke) make("large.csv", "--poses", "grid5832");
  let said = "";
  const server = spawn(join(bin, "mgt"), ["serve", folder], { stdio: ["ignore", "pipe", "ignore"] }), browser = await Browser.start();
  server.stdout.on("data", (bytes) => { said += bytes; });
  try {
    await until(() => said.includes("\n"), "the address");
    /** From the click until the panels are drawn, and until the verdict stands beside them. */
    const opening = async (run) => {
      await browser.open(said.trim());
      await until(() => browser.run(`document.querySelector('[data-run="${run}"]') !== null`), run);
      return browser.run(`new Promise((done) => {
        const began = performance.now(), out = {}, bench = document.getElementById("bench-run");
        const look = () => {
          if (out.panels === undefined && document.getElementById("channel").options.length > 0) out.panels = performance.now() - began;
          if ("shown" in bench.dataset) out.verdict = performance.now() - began;
          out.verdict === undefined ? requestAnimationFrame(look) : requestAnimationFrame(() => done(out));
        };
        document.querySelector('[data-run="${run}"]').click();
        look();
      })`);
    };
    const openings = [];
    for (let i = 0; i < kOpenings; ++i) {
      // Another content: nothing of it is known from the opening before.
      const text = readFileSync(join(folder, "usual.csv"), "utf8"), name = `usual${i}.csv`;
      writeFileSync(join(folder, name), text.replace(/\n1,/, `\n${900 + i},`));
      openings.push(await opening(name));
    }
    const least = (key) => Math.min(...openings.map((o) => o[key])) / 1000;
    measured("workbench opens a run of 157 poses", `panels after ${least("panels").toFixed(1)} s, verdict after ${least("verdict").toFixed(1)} s`, "2 s", `least of ${kOpenings}, each never seen before`);
    if (!smoke) {
      // The page asks before it searches for effects in so many poses; the panels do not wait for that.
      await browser.open(said.trim());
      await until(() => browser.run(`document.querySelector('[data-run="large.csv"]') !== null`), "the large run");
      const drawn = await browser.run(`new Promise((done) => {
        const began = performance.now();
        document.querySelector('[data-run="large.csv"]').click();
        const look = () => (document.getElementById("channel").options.length > 0 ? done(performance.now() - began) : requestAnimationFrame(look));
        look();
      })`);
      const again = await browser.run(`new Promise((done) => requestAnimationFrame(() => { const began = performance.now(); document.getElementById("bench-fit").click();
        requestAnimationFrame(() => requestAnimationFrame(() => done(performance.now() - began))); }))`);
      measured("nine panels of 5832 poses", `drawn in ${(again / 1000).toFixed(2)} s; ${(drawn / 1000).toFixed(1)} s with the fit`, "2 s to draw", "as density");
    }
  } finally {
    await browser.close();
    const ended = new Promise((resolve) => server.once("exit", resolve));
    server.kill("SIGINT");
    await ended;
  }
}

/** Seconds and the most memory that a command takes; its exit code is its answer, not a failure. */
async function effort(argv) {
  const began = performance.now(), child = spawn(argv[0], argv.slice(1), { stdio: "ignore" });
  let most_kB = 0, seconds;
  child.once("exit", () => { seconds = (performance.now() - began) / 1000; });
  while (seconds === undefined) {
    try { most_kB = Math.max(most_kB, Number(readFileSync(`/proc/${child.pid}/status`, "utf8").match(/VmHWM:\s*(\d+)/)?.[1] ?? 0)); } catch { /* it ended */ }
    await pause(0.02);
  }
  return { seconds, most_kB };
}

/** The search for what is missing in thousands of poses, where nothing is and where something is. */
async function search() {
  if (smoke) return;
  const hidden = join(here, "../scenarios/hidden_temperature.toml");
  for (const [what, scenario] of [["nothing is hidden", []], ["a temperature law is hidden", ["--scenario", hidden]]]) {
    const file = join(scratch, "search.csv");
    execFileSync(join(bin, "mgt-rig"), ["table", ...scenario, "--poses", "grid5832", "-o", file]);
    const { seconds, most_kB } = await effort([join(bin, "mgt"), "explain", file]);
    measured(`\`mgt explain\` of 5832 poses, ${what}`, `${seconds.toFixed(1)} s, ${(most_kB / 1000).toFixed(0)} MB`, "20 s, 300 MB", "`mgt-rig table --poses grid5832`");
  }
}

/** From the last byte of a sample to its TENSOR line, by the benchmark that is built beside the release. */
function latency() {
  const bench = join(bin, "bench");
  if (smoke || !existsSync(bench)) return;
  const { benchmarks } = JSON.parse(execFileSync(bench, ["--benchmark_filter=sixteen_clients", "--benchmark_format=json"], { stdio: ["ignore", "pipe", "ignore"] }));
  for (const b of benchmarks) {
    if (b.error_occurred) throw new Error(`${b.name}: ${b.error_message}`);
    const job = b.name.includes("job:1");
    measured(`last byte of a sample to TENSOR, 16 clients${job ? ", a computation runs" : ""}`, `${(b.p99_us / 1000).toFixed(1)} ms in 99 of 100, ${(b.median_us / 1000).toFixed(1)} ms in the median`, "5 ms",
             `\`bench --benchmark_filter=sixteen_clients\`: 50 Hz, 14 read, one is dead, one reads a byte a second${job ? `; \`mgt explain\` of 157 poses over and over, ${b.searches} times` : ""}`);
  }
}

try {
  const gzipped = readdirSync(page).reduce((sum, name) => sum + gzipSync(readFileSync(join(page, name)), { level: 9 }).length, 0);
  measured("size of the page", `${(gzipped / 1000).toFixed(1)} kB gzipped`, "100 kB", "all of its files, level 9");
  await live();
  await workbench();
  await search();
  latency();
  const text = `# How fast the console is

Written by \`node tests/browser/speed.mjs build/release/bin docs/console/speed.md\` on ${cpus().length} cores (${cpus()[0].model.trim()}), Chromium without a GPU, while other work may have been going on: times are upper bounds.

| what | measured | limit | how |
|---|---|---|---|
${table.map((row) => `| ${row.what} | ${row.value} | ${row.limit} | ${row.how} |`).join("\n")}
`;
  if (target && !smoke) writeFileSync(target, text);
} catch (error) {
  console.error(error.message);
  process.exitCode = 1;
} finally {
  rmSync(scratch, { recursive: true, force: true });
}
