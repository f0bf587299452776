// SPDX-License-Identifier: Apache-2.0
import { calibrationWords, cards, kWarmer_K, warmer_K } from "./cards.js";
import { Bench } from "./bench.js";
import { Calibrations } from "./calibrations.js";
import { showCourse } from "./course.js";
import { by, fill, make, rows } from "./elements.js";
import { Jobs } from "./jobs.js";
import { Lanes, windows } from "./lanes.js";
import { Control, openStream, takeToken } from "./link.js";
import { active, chip, showRun, wanted } from "./run.js";
import { sensorCards } from "./sensors.js";

const token = takeToken(), control = new Control(token);
const lanes = new Lanes(by("canvas"), (text) => { by("cursor").textContent = text; });
let status = null, run = null, sample = null, sensors = null, heard_ms = 0, sampled_ms = 0, screen = "live", alarms = 0, judged = 0, numbers_ms = 0;

function banner(text, note = false) {
  by("banner").textContent = text;
  by("banner").className = note ? "note" : "";
  by("banner").hidden = !text;
}
const inWords = (error) => `${error.message ?? error}${error.remedy ? `: ${error.remedy}` : ""}`;

/** What is being computed, with a way to end it. */
function tellJobs(list) {
  by("jobs").hidden = list.length === 0;
  fill(by("jobs"), list.map((job) => make("span", {}, job.state === "running" ? `${job.elapsed_s.toFixed(1)} s: ` : "waits: ", make("code", {}, job.command), job.said ? ` ${job.said} ` : " ",
                                          make("button", { class: "small", onclick: () => jobs.cancel(job.id) }, "Cancel"))));
}
const jobs = new Jobs(token, tellJobs), bench = new Bench(jobs, (text) => banner(text, true), () => (rigged ? measure : null));
let rigged = false, listed = null;  // a list of poses in the place of a plan
/** What the workbench wants to be measured next becomes the run of the form. */
function measure(step) {
  listed = step?.run ?? null;
  by("listed").hidden = by("plan-instead").hidden = !listed;
  by("plan-fields").hidden = Boolean(listed);
  by("plan").textContent = "";
  by("listed").textContent = step ? `${step.poses} poses: ${step.action}` : "";
  if (listed) show("run");
}

/** Asks the daemon to do something; what it refuses is said in its own words. */
async function act(cmd, args = {}) {
  try {
    const result = await control.ask(cmd, args);
    banner("");
    return result;
  } catch (error) {
    banner(inWords(error), true);
    return null;
  }
}

const calibrations = new Calibrations(control, (error) => banner(error ? inWords(error) : "", true), () => takeRun(run));
let proposed = null, held = false, seenHeld = false;  // the proposal whose state was asked for; whether this page keeps control

/** Keeps control for this page until it releases it, is closed, or says nothing for ten minutes. */
async function takeControl() {
  const wish = { why: "kept on the page", idle_s: 600 };
  try {
    await control.ask("control.take", wish);
  } catch (error) {
    if (error.code !== "state" || !confirm(`${error.message}. Take it away?`)) return banner(inWords(error), true);
    if (!(await act("control.break")) || !(await act("control.take", wish))) return;
  }
  banner("");
  showHold(true);
}
function showHold(now) {
  held = now;
  seenHeld = false;
  by("hold").textContent = held ? "Release control" : "Take control";
  by("hold").setAttribute("aria-pressed", String(held));
}
control.ended = () => showHold(false);

const kScreens = ["live", "run", "calibrations", "workbench"];
function show(name) {
  screen = name;
  for (const id of kScreens) {
    by(id).hidden = id !== name;
    id === name ? by(`tab-${id}`).setAttribute("aria-current", "page") : by(`tab-${id}`).removeAttribute("aria-current");
  }
  if (name === "calibrations") calibrations.refresh();
  if (name === "live") lanes.redraw();
  if (name === "workbench" && !bench.open) bench.list().catch((error) => banner(inWords(error), true));
}

const kQuiet_ms = 900;  // STATUS comes once a second
const kGradient = ["xx", "yy", "zz", "xy", "xz", "yz"];
/** What this array can tell, and no more. */
function channelsOf(array, inputs) {
  const gradient = kGradient.filter((c) => array.gradient.includes(c)).map((c) => ({ name: c, label: `G${c}`, unit: "nT/m", least_span: 0.5 }));
  const field = ["bx", "by", "bz"].map((b) => ({ name: b, label: `B${b[1]}`, unit: "nT", least_span: 0.5 }));
  const closure = array.closure > 0 ? [{ name: "chi2", label: "closure χ²", unit: "", least_span: 20, limit: array.closure_limit }] : [];
  const heads = inputs.filter((i) => i.unit === "degC").slice(0, 1).map((i) => ({ name: i.name, label: i.name, unit: "degC", least_span: 0.2 }));
  return [...gradient, ...field, { name: "f", label: "F", unit: "nT", least_span: 0.5 }, ...closure, ...heads];
}

function takeSample(message) {
  sample = message;
  heard_ms = performance.now();
  const t_s = message.t_ns / 1e9;
  lanes.endGap(t_s);
  const values = { f: message.f_nT, bx: message.b_nT[0], by: message.b_nT[1], bz: message.b_nT[2], chi2: message.closure.chi2,
                   ...message.g_nT_per_m, ...(message.inputs ?? {}) };
  lanes.add(t_s, values);
  if (message.closure.chi2 !== null && status?.array.closure_limit) { judged += 1; alarms += message.closure.chi2 > status.array.closure_limit ? 1 : 0; }
  const now = performance.now();
  if (now - sampled_ms < 500 || screen !== "live" || !status) return;
  sampled_ms = now;
  fill(by("cards"), cards(status, sample, false));
  showNumbers(now);
}

function takeSensors(message) {
  sensors = message;
  if (screen === "live") showSensors(false);
}
function showSensors(old) {
  by("sensors").hidden = !sensors;
  if (sensors) fill(by("sensors"), sensorCards(sensors, old));
}

/** The table behind the lanes, while it is open. */
function showNumbers(now) {
  if (!by("lane-numbers").open || now - numbers_ms < 1000) return;
  numbers_ms = now;
  fill(by("lane-table"), rows(["lane", "now", "mean", "least", "greatest", "unit", "gaps"],
       lanes.summary().map((l) => [l.label, l.now, l.mean, l.least, l.greatest, l.unit, l.gaps])));
}

function takeStatus(message) {
  status = message;
  by("rig").textContent = message.rig;
  by("calibration").textContent = calibrationWords(message);
  by("calibration").className = message.cal === null || message.calibration.forced || warmer_K(message.calibration) >= kWarmer_K ? "warn" : "";
  lanes.channels = channelsOf(message.array, message.inputs);
  lanes.pass(Date.parse(message.t) / 1000);
  const holder = message.control.holder;
  by("hold").hidden = !control.possible;
  if (held && holder?.taken) seenHeld = true;
  else if (seenHeld) showHold(false);  // a status that was under way when control was taken does not know it yet
  by("who").textContent = `${message.software}. ${message.array.sensors} sensor${message.array.sensors > 1 ? "s" : ""}: ${message.array.tells}. ` +
    (holder ? `Control is with ${holder.via || `pid ${holder.pid}`}${holder.why ? `: ${holder.why}` : ""}.` : "Nobody has control.") +
    (control.possible ? "" : " This page may look; mgt console prints the address with which it may control.");
  by("caption").textContent = judged > 0
    ? `A good stream has no hatching, and a closure χ² above ${message.array.closure_limit.toFixed(1)} (${message.array.closure === 1 ? "of one number" : `of ${message.array.closure} numbers`}) in one sample of a thousand; since this page was opened ${(1000 * alarms / judged).toFixed(1)} of a thousand.`
    : "A good stream has no hatching: what was not measured is hatched, with its reason.";
  const now = performance.now();  // without samples, as after a pulled cable, the instruments are told all the same
  if (screen === "live" && now - sampled_ms > kQuiet_ms) {
    fill(by("cards"), cards(status, sample, now - heard_ms > kQuiet_ms));
    if (now - heard_ms > kQuiet_ms) showSensors(true);
    showNumbers(now);
  }
  takeRun(message.run);
}

function takeRun(message) {
  run = message;
  const on = active(run);
  by("chip").hidden = by("stops").hidden = !on;
  by("pause").disabled = by("abort").disabled = !control.possible;
  if (on) by("chip").textContent = chip(run);
  document.title = on ? `${run.pose}/${run.poses} ${status?.rig ?? "mgtd"}` : `${status?.rig ?? "mgtd"}`;
  by("run-form").hidden = on;
  by("start").disabled = !control.possible;
  showRun(run, act, calibrations, status?.cal);
  showCourse(run);
  if (run?.proposed && run.proposed !== proposed && control.possible) {
    proposed = run.proposed;
    calibrations.refresh();
  }
}

/** The rig behind the page. */
function followRig(hello) {
  openStream({
    message: (message) => {
      if (message.class === "TENSOR") takeSample(message);
      else if (message.class === "GAP") lanes.gap(message.why);
      else if (message.class === "STATUS") takeStatus(message);
      else if (message.class === "RUN") takeRun(message);
      else if (message.class === "SENSORS") takeSensors(message);
    },
    state: (state, since) => {
      const at = since ? since.toISOString().slice(11, 19) + "Z" : "";
      by("link").textContent = { live: "live", stale: `stale: no word since ${at}`, gone: at ? `no connection since ${at}` : "no connection" }[state];
      by("link").className = state === "live" ? "good" : "bad";
      document.body.classList.toggle("stale", state !== "live");
      if (state !== "live") document.title = `! ${status?.rig ?? "mgtd"}`;
      banner(state === "gone" ? "The daemon does not answer; what is shown is old. A run goes on without this page. This page connects again by itself." : "");
    },
  });
}

/** Files without a rig: the workbench alone. */
function serveFiles(hello) {
  for (const id of ["live", "run", "calibrations"]) by(`tab-${id}`).hidden = true;
  by("rig").textContent = hello.rig;
  document.title = hello.rig;
  by("link").textContent = "files";
  by("who").textContent = `${hello.software}, without a rig: ${hello.path}.` + (token ? "" : " This page may look; open the address that mgt serve prints.");
  show("workbench");
  bench.list(hello.run);
}

for (const name of kScreens) by(`tab-${name}`).addEventListener("click", () => show(name));
for (const [label, seconds] of windows) {
  const button = make("button", { "aria-pressed": String(seconds === lanes.window_s), onclick: () => {
    lanes.window_s = seconds;
    for (const other of by("windows").children) other.setAttribute("aria-pressed", String(other === button));
  } }, label);
  by("windows").append(button);
}
by("pause").addEventListener("click", () => act("run.pause"));
by("abort").addEventListener("click", () => { if (confirm("Abort the run? Its poses stay on disk.")) act("run.abort"); });
by("rollback").addEventListener("click", () => { if (confirm("Roll back to the calibration before?")) calibrations.rollback(); });
by("hold").addEventListener("click", () => (held ? act("control.release").then((done) => { if (done) showHold(false); }) : takeControl()));
by("look").addEventListener("click", async () => {
  const plan = await act("run.dry-run", listed ?? wanted(by("run-form")));
  if (plan) by("plan").textContent = `${plan.poses} poses, ${Math.round(plan.minutes)} minutes.`;
});
by("run-form").addEventListener("submit", (event) => {
  event.preventDefault();
  if (confirm("Start the run? The table moves at once.")) act("run.start", listed ?? wanted(event.target));
});
const kThemes = ["", "light", "dark", "sun"];
by("theme").addEventListener("click", () => {
  const next = kThemes[(kThemes.indexOf(document.documentElement.dataset.theme ?? "") + 1) % kThemes.length];
  next ? (document.documentElement.dataset.theme = next) : delete document.documentElement.dataset.theme;
  by("theme").title = `${next || "as the computer has it"}; light, dark, or black on white for the sun`;
  lanes.redraw();
  bench.recolour();
});
addEventListener("resize", () => lanes.redraw());
matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => { lanes.redraw(); bench.recolour(); });
const hello = await (await fetch("/api/hello")).json();
if (hello.mode === "files") serveFiles(hello);
else { rigged = true; show("live"); followRig(hello); }
by("plan-instead").addEventListener("click", () => measure(null));
document.body.dataset.ready = "";
