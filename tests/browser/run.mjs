// SPDX-License-Identifier: Apache-2.0
// The story of a run in two browsers, one that controls and one that looks: a cable is pulled and plugged again, a run is
// started, watched and its calibration accepted, the daemon is killed and comes back. The rig is simulated, on serial ports.
//
//   node tests/browser/run.mjs build/bin [FOLDER]     FOLDER gets pictures of the screens on the way
//
// Exit code 0: told. 1: something else happened. 77: not told, because chromium is missing.
import { mkdirSync } from "node:fs";
import { join } from "node:path";
import { Browser, needBrowser, until } from "./browser.mjs";
import { Rig } from "./rig.mjs";

const [bin, pictures] = process.argv.slice(2);
if (!bin) {
  console.error("usage: node tests/browser/run.mjs BIN [FOLDER]");
  process.exit(2);
}
needBrowser();
if (pictures) mkdirSync(pictures, { recursive: true });
const kSpeed = 10, kAttempts = 5;
let told = 0;
function holds(what, good, found = "") {
  if (!good) throw new Error(`${what}${found === "" ? "" : `: ${JSON.stringify(found)}`}`);
  console.log(`  ${what}`);
  ++told;
}

let rig = null, controls = null, looks = null, failed = false;
const picture = async (browser, name) => { if (pictures) await browser.picture(join(pictures, `${name}.png`)); };
const both = (ask) => Promise.all([controls, looks].map(ask));
/** Until a condition holds in both browsers. */
const agreed = (expression, what) => both((browser) => until(() => browser.run(expression), what));
const of = (id) => `document.getElementById("${id}")`;
const device = (name) => `[...document.querySelectorAll("#cards tr")].find((r) => r.firstChild.textContent === "${name}")?.children[1].textContent`;
const live = (...names) => names.map((name) => `${device(name)} === "live"`).join(" && ");
const set = (name, value) => controls.run(`{ const e = ${of("run-form")}.elements["${name}"]; e.value = "${value}"; e.dispatchEvent(new Event("input", { bubbles: true })); }`);
try {
  rig = await Rig.start(bin, kSpeed);
  await rig.startDaemon();
  const { url, address } = rig.ask("console");
  controls = await Browser.start();
  looks = await Browser.start();
  await controls.open(url);
  await looks.open(address);
  await agreed(`${of("link")}.innerText === "live"`, "a live stream");
  await agreed(`${device("s2")} === "live"`, "sensor 2 among the instruments");
  holds("two browsers show the rig", (await looks.text("rig")) === (await controls.text("rig")) && (await looks.text("rig")) === "table6");
  holds("the token is gone from the address bar", !(await controls.run("location.href")).includes("token"));
  holds("without the token a page says that it may look", (await looks.text("who")).includes("may look") && (await looks.run(`${of("start")}.disabled`)));

  // By the clock of the daemon, whose STATUS comes once a second and says how old the last frame is: how often the page calls
  // a sensor live that has been silent for more than a second.
  await both((browser) => browser.run(`{ window.heard = window.late = 0; const socket = new WebSocket("ws://" + location.host + "/stream");
    socket.onmessage = (event) => { for (const line of event.data.split("\\n")) {
      if (line.includes('"HELLO"')) socket.send('{"watch":{"class":["STATUS"],"rate_hz":null,"from_seq":null}}');
      if (!line.includes('"STATUS"')) continue;
      ++window.heard;
      const { last_frame_age_s } = JSON.parse(line).devices.find((d) => d.name === "s2");
      if (last_frame_age_s > 1 && ${device("s2")} === "live") ++window.late; } }; }`));
  await agreed("window.heard >= 2", "the status, heard twice");
  await both((browser) => browser.run("window.late = 0"));
  rig.fault("unplug", "fluxgate2");
  await agreed(`${device("s2")} !== "live"`, "the page says that sensor 2 is gone");
  const late = await both((browser) => browser.run("window.late"));
  holds("both say that a cable was pulled, at most three seconds of the daemon later", late.every((n) => n <= 2), late);
  await agreed(`${device("s2")} !== "live" && ${live("s1", "s3", "s4")}`, "the other sensors live");
  holds("the other sensors are live", true);
  await agreed(`${of("cards")}.innerText.includes("last measured")`, "when the last numbers were measured");
  holds("the last numbers say when they were measured", true);
  await both((browser) => browser.run(`${of("lane-numbers")}.open = true`));
  const lanes = `[...document.querySelectorAll("#lane-table tbody tr")].map((r) => [...r.children].map((c) => c.textContent))`;
  await agreed(`${lanes}.length === 12 && ${lanes}.every((r) => Number(r[6]) >= 1)`, "the gap in each of twelve lanes");
  await picture(controls, "unplugged");
  rig.fault("restore", "fluxgate2");
  await agreed(`${device("s2")} === "live" && !${of("cards")}.innerText.includes("last measured")`, "the page says that sensor 2 is back");
  await agreed(`${lanes}.every((r) => r[0].startsWith("closure") || r[1] !== "--")`, "numbers in the lanes again");
  holds("the lanes as numbers show the gap, and the samples behind it", true);
  const [, now, mean, least, greatest] = (await controls.run(lanes)).find((r) => r[0] === "F").map(Number);
  holds("the lane of the field lies about the field of the rig", least <= mean && mean <= greatest && least <= now && now <= greatest && Math.abs(mean - 53908) < 500, [now, mean, least, greatest]);

  await controls.click("hold");
  await agreed(`${of("who")}.innerText.includes("kept on the page")`, "who keeps control");
  const busy = rig.mgt("run", "start");
  holds("while the page keeps control the terminal is told who has it", busy.status !== 0 && busy.stderr.includes("the console, from 127.0.0.1"), busy.stderr);
  holds("who looks has no button for control", await looks.run(`${of("hold")}.hidden`));
  await picture(controls, "kept");
  await controls.click("hold");
  await agreed(`${of("who")}.innerText.includes("Nobody has control")`, "control released");

  await controls.click("tab-run");
  await looks.click("tab-run");
  for (const [name, value] of Object.entries({ step_deg: 20, random: 10, revisits: 2, dwell_short_s: 1, dwell_long_s: 2 })) await set(name, value);
  await controls.click("look");
  const plan = await until(() => controls.text("plan"), "what the run would do");
  holds("the dry run says how many poses, as the terminal does",
        plan.startsWith(`${rig.ask("run", "dry-run", "--step", "20", "--random", "10", "--revisits", "2", "--dwell-short", "1", "--dwell-long", "2").poses} poses`), plan);
  await picture(controls, "form");
  await controls.click("hold");
  await until(() => looks.run(`${of("who")}.innerText.includes("Control is with the console")`), "who has control, on the page that looks");
  holds("who looks reads who has control", true);
  const count = (css) => `document.querySelectorAll("#course ${css}").length`;
  const resume = () => controls.run(`[...document.querySelectorAll("#run-now button")].find((b) => b.textContent === "Resume")?.click()`);
  /** From the button to the end; false where this computer was too busy for the simulated rig. */
  async function measured() {
    const before = rig.ask("run", "status").run_id || "none", ended = `(${of("run-now")}.innerText.includes(": failed") && !${of("run-now")}.innerText.includes("${before}"))`;
    // A pose that this computer had no time for pauses the run in the end; the operator lets it go on.
    const stuck = `(${of("run-now")}.innerText.includes(": paused") && !/by the operator|waiting/.test(${of("run-now")}.innerText))`;
    async function or(expression, what) {
      for (let pauses = 0; pauses < kAttempts; ++pauses) {
        await agreed(`(${expression}) || ${ended} || ${stuck}`, what);
        if (!(await controls.run(stuck))) return;
        console.log(`  (resumed: ${rig.ask("run", "status").message.slice(0, 120)})`);
        await resume();
        await agreed(`!${stuck}`, "the run going on");
      }
      throw new Error(`paused ${kAttempts} times: ${rig.ask("run", "status").message}`);
    }
    await controls.click("start");
    await or(`/^\\d+\\/\\d+ /.test(document.title) && !${of("stops")}.hidden && ${of("run-form")}.hidden`, "a run that goes on");
    await or(`document.querySelector("#run-now progress")?.value >= 3`, "three poses");
    if (await controls.run(ended)) return false;
    holds("who looks cannot stop the run", (await looks.run(`${of("abort")}.disabled && ${of("pause")}.disabled`)) && !(await controls.run(`${of("abort")}.disabled`)));
    await or(`${count("circle.measured")} >= 3 && ${count("circle.planned")} > 0 && ${count("circle.next")} === 1`, "the directions of three poses, of those to come and of the next");
    const early = await controls.run(`[${count("circle.measured")}, ${count("circle.planned")}]`);
    await or(`${count("polyline.expected")} === 1`, "the accuracy that the plan leads one to expect");
    await controls.click("pause");
    await or(`${of("run-now")}.innerText.includes("paused by the operator")`, "the run paused");
    await picture(controls, "paused");
    await resume();
    await or(`document.querySelector("#run-now progress")?.value >= 8 && ${count("circle.measured")} >= 8`, "more poses after the pause");
    const [filled, open] = await looks.run(`[${count("circle.measured")}, ${count("circle.planned")}]`);
    await or(`${count("circle.known")} >= 1`, "the accuracy of the poses so far");
    await picture(controls, "running");
    await or(`${of("run-now")}.innerText.includes(": done") && ${of("chip")}.hidden`, "the end of the run");
    if (await controls.run(ended)) return false;
    holds("while the run goes on the coverage fills", filled > early[0] && open < early[1], [early, filled, open]);
    return true;
  }
  for (let attempt = 1; !(await measured()); ++attempt) {
    const { message } = rig.ask("run", "status");
    if (attempt === kAttempts || !message.includes("too busy")) throw new Error(message);
    console.log(`  (again: ${message.slice(0, 120)})`);
    await agreed(`!${of("run-form")}.hidden`, "the form again");
  }
  const run = rig.ask("run", "status");
  holds("the run ends with a proposal and its checks", run.state === "done" && run.proposed !== null && run.checks.length > 0, run);
  const rows = await both((browser) => browser.run(`[...document.querySelectorAll("#checks tbody tr")].map((r) => [...r.children].map((c) => c.textContent))`));
  holds("both show the checks of the terminal", rows.every((of_one) => of_one.length === run.checks.length &&
        run.checks.every((c) => of_one.some((r) => r[1] === c.name && r[2] === c.measured && r[3] === c.limit))), rows);
  const { coverage, accuracy, disturbances } = rig.ask("run", "course");
  await agreed(`${count("circle.measured")} === ${run.poses} && ${count("circle.planned")} === 0`, "every direction filled");
  const key = (name) => `document.querySelector('#course [data-key="${name}"]').textContent`;
  await agreed(`${key("accuracy.poses")} === "${accuracy.poses.at(-1)}"`, "the accuracy of the whole run");
  const shown = await both((browser) => browser.run(`[${key("coverage.measured")}, ${key("accuracy.worst_nT_per_m")}, ${of("course")}.innerText]`));
  holds("coverage and accuracy on both are those of the terminal", shown.every(([measured, worst, words]) => measured === String(coverage.pose.length) &&
        Number(worst) === Number(accuracy.worst_nT_per_m.at(-1).toFixed((worst.split(".")[1] ?? "").length)) && words.includes(coverage.good) && words.includes(accuracy.good) &&
        words.includes(`Disturbances of the field: ${disturbances.length}`)), [shown, coverage, accuracy, disturbances]);
  const left = await both((browser) => browser.run(key("accuracy.residual_nT")));
  holds("so is the residual of the fit", left.every((nT) => Number(nT) === Number(accuracy.residual_nT.at(-1).toFixed((nT.split(".")[1] ?? "").length))), [left, accuracy.residual_nT]);
  const { name, sd } = accuracy.parameters, at = name.indexOf("s2 theta");
  const theta = await both((browser) => browser.run(`document.querySelector("#course-parameters tbody tr").children[3].textContent`));
  holds("and the standard error of every parameter", sd.length === accuracy.poses.length && sd.at(-1).length === name.length &&
        theta.every((deg) => Number(deg) === Number(sd.at(-1)[at].toFixed((deg.split(".")[1] ?? "").length))), [theta, name, sd.at(-1)]);
  const { events } = rig.ask("run", "events"), log = `[...document.querySelectorAll("#run-events tbody tr")]`;
  await agreed(`${log}.length === ${events.length}`, "the entries of the run");
  const entries = await both((browser) => browser.run(`${log}.map((row) => row.lastChild.textContent)`));
  holds("what the run wrote down is that of the terminal, the newest first", events.length > 0 && entries.every((of_one) => of_one.every((words, i) => words === events.at(-1 - i).what)), [entries, events]);
  holds("the accuracy has shrunk, to what the plan led one to expect", accuracy.poses.length > 1 && accuracy.worst_nT_per_m.at(-1) < accuracy.worst_nT_per_m[0] &&
        Math.abs(Math.log(accuracy.worst_nT_per_m.at(-1) / accuracy.expected.worst_nT_per_m.at(-1))) < Math.log(3), accuracy);
  await picture(controls, "proposed");

  const listed = () => rig.ask("calibrations", "list").calibrations.find((c) => c.id === run.proposed);
  const press = (where, text) => controls.run(`[...document.querySelectorAll("${where} button")].find((b) => b.textContent === "${text}").click()`);
  const because = async (why, name) => {
    await until(() => controls.run(`${of("reason")}.open`), "the question for a reason");
    await controls.run(`${of("reason-why")}.value = ""`);
    await controls.click("reason-act");
    if (!(await controls.run(`${of("reason")}.open`))) throw new Error("an empty reason was taken");
    await controls.run(`${of("reason-why")}.value = ${JSON.stringify(why)}`);
    await picture(controls, name);
    await controls.click("reason-act");
  };
  await until(() => controls.run(`document.querySelectorAll("#proposal button").length === 2`), "what can be decided about the proposal");
  await press("#proposal", "Reject");
  await until(() => controls.run(`${of("reason")}.open`), "the question for a reason");
  await controls.click("reason-cancel");
  holds("who thinks better of it has rejected nothing", listed().state === "proposed");
  await press("#proposal", "Reject");
  await because("a car stood <b>beside</b> the rig", "reject");
  await until(() => controls.run(`${of("run-now")}.innerText.includes("is rejected: a car stood <b>beside</b> the rig")`), "the rejection");
  holds("the proposal is rejected, with the reason", listed().state === "rejected" && listed().why === "a car stood <b>beside</b> the rig", listed());
  await controls.click("tab-calibrations");
  await until(() => controls.run(`${of("calibration-list")}.innerText.includes("rejected")`), "the list of calibrations");
  await picture(controls, "rejected");
  await press("#calibration-list", "Accept");
  await because("it was parked there from the first pose on", "force");
  await agreed(`${of("calibration")}.innerText.includes("${run.proposed}")`, "the accepted calibration");
  holds("one that was rejected is accepted by force, with the reason", rig.ask("status").cal === run.proposed && listed().why.startsWith("it was parked"), listed());
  rig.command("control", "break");
  const refused = rig.mgt("calibrations", "reject", run.proposed, "--why", "in use");
  holds("what is in use is not rejected", refused.status !== 0 && refused.stderr.includes("only a proposal"), refused.stderr);
  await until(() => controls.run(`${of("calibration-list")}.innerText.includes("active")`), "the list of calibrations");
  await picture(controls, "accepted");
  const [decided] = rig.ask("history").decisions.slice(-1);
  holds("the history says who decided", decided.event === "accepted" && decided.by === "the console, from 127.0.0.1", decided);
  await until(() => controls.run(`${of("calibration-history")}.innerText.includes("the console, from 127.0.0.1")`), "who decided, on the page");

  const complaints = () => [...controls.log, ...looks.log];
  holds("the browsers have nothing to complain of", complaints().length === 0, complaints());
  await both((browser) => browser.click("tab-live"));
  await rig.killDaemon();
  await agreed(`${of("link")}.innerText.startsWith("no connection since") && document.body.classList.contains("stale") && ${of("banner")}.innerText.includes("does not answer")`,
               "the page says that the daemon is gone");
  holds("a killed daemon: both say that they are not connected, and that what they show is old", true);
  await picture(controls, "killed");
  await rig.startDaemon();
  await agreed(`${of("link")}.innerText === "live" && !document.body.classList.contains("stale") && ${of("banner")}.hidden`, "the stream again");
  await agreed(`${of("calibration")}.innerText.includes("${run.proposed}")`, "the calibration of before");
  holds("both come back by themselves, with the calibration of before", true);
  await controls.click("tab-calibrations");
  await controls.click("rollback");
  await until(async () => (await controls.text("banner")).includes("mgt console"), "the old token refused");
  holds("the token is new at every start, and the page says where to get it", true);
  await picture(controls, "back");

  const others = complaints().filter((line) => !/ERR_(CONNECTION|EMPTY_RESPONSE|SOCKET)/.test(line));
  holds("nor afterwards, but of the killed daemon", others.length === 0, others);
  console.log(`told: ${told} things`);
} catch (error) {
  failed = true;
  console.error(error.message);
  if (rig) console.error(rig.said.slice(-3000));
  for (const browser of [controls, looks]) {
    if (!browser) continue;
    console.error(browser.log.join("\n"), (await browser.run("document.body.innerText")).slice(0, 3000));
  }
  if (controls) await picture(controls, "failed");
} finally {
  for (const browser of [controls, looks]) if (browser) await browser.close();
  if (rig) await rig.stop();
}
process.exit(failed ? 1 : 0);
