// SPDX-License-Identifier: Apache-2.0
// The screen of a run: what it does, what it asks a person for, its checks, and the form that begins one.
import { by, fill, make, rows } from "./elements.js";

const kEnded = new Set(["idle", "done", "rejected", "aborted", "failed", "interrupted"]);
export const active = (run) => Boolean(run && run.run_id && !kEnded.has(run.state));
const minutes = (s) => (s === null ? "" : s < 90 ? `${Math.round(s)} s` : `${Math.round(s / 60)} min`);

export function chip(run) {
  return `${run.state} ${run.pose}/${run.poses}${run.remaining_s ? `, ${minutes(run.remaining_s)} left` : ""}`;
}

function progress(run) {
  if (!run || !run.run_id) return [make("h2", {}, "No run yet"), make("p", {}, "A run turns the table through its poses, fits, and proposes a calibration. Nothing changes until a person accepts it.")];
  return [make("h2", {}, `Run ${run.run_id}: ${run.state}`), make("progress", { max: run.poses || 1, value: run.pose }),
          make("p", {}, `${run.pose} of ${run.poses} poses${run.set ? `, set ${run.set}` : ""}${run.remaining_s ? `, ${minutes(run.remaining_s)} left` : ""}` +
               `${run.retries ? `, ${run.retries} repeated` : ""}`),
          make("p", {}, run.message), make("p", { id: "run-field" }), run.judged ? make("p", { id: "run-judged" }, `The poses say: ${run.judged}`) : null];
}

/** How far the field has changed while the table stands, against its limit; null while it is not watched. */
export function fieldChange(run) {
  const seen = run?.field_change;
  return seen ? `The field has changed by ${seen.change_nT.toFixed(2)} nT while the table stands; limit ${seen.limit_nT.toFixed(2)} nT.` : null;
}

/** A hand-turned table: what to do now, and three numbers. */
function asking(run, act) {
  const prompt = run.prompt;
  if (!prompt) return [];
  const field = (name) => make("label", {}, `${name} `, make("input", { type: "number", step: "0.1", name, required: true,
                                                                        value: prompt.target[`${name}_deg`] }), " deg");
  const form = make("form", { onsubmit: (event) => {
    event.preventDefault();
    const read = (name) => Number(event.target.elements[name].value);
    act("run.enter", { azimuth_deg: read("azimuth"), pitch_deg: read("pitch"), roll_deg: read("roll"), pose: prompt.pose, what: prompt.what });
  } }, ["azimuth", "pitch", "roll"].map(field), make("button", {}, "The scales say this"),
                    make("button", { type: "button", onclick: () => act("run.redo") }, "The last entry was wrong"));
  if (prompt.what === "note") return [make("p", {}, prompt.text), make("button", { onclick: () => act("run.resume") }, "Done"),
    run.judged ? make("button", { onclick: () => act("run.finish") }, "End the run as it is") : null];
  return [make("p", {}, prompt.text), prompt.again ? make("p", { class: "warn" }, `Asked again: ${prompt.again}`) : null, form];
}

/** What became of the calibration that the run proposes, or what can be decided about it. */
function proposal(id, calibrations, active) {
  const known = calibrations.of(id);
  if (active === id) return make("p", {}, `Calibration ${id} is in use.`);
  if (known?.state === "rejected") return make("p", {}, `Calibration ${id} is rejected: ${known.why}`);
  return make("p", { id: "proposal" }, `Calibration ${id}: `, calibrations.buttons(id), " Accepted it becomes active at once; roll back returns to the one before.");
}

let shownPrompt = "", shownNow = "";
/** `calibrations`: calibrations.js; `used`: the id of the one in use. */
export function showRun(run, act, calibrations, used) {
  const now = JSON.stringify([{ ...run, elapsed_s: null, field_change: null, checks: null }, calibrations.of(run?.proposed), used]);
  if (now !== shownNow) {  // a button stays the same one while a finger is on it
    shownNow = now;
    fill(by("run-now"), progress(run), run?.proposed ? proposal(run.proposed, calibrations, used) : null,
         run?.state === "paused" ? make("button", { onclick: () => act("run.resume") }, "Resume") : null);
  }
  const field = by("run-field");
  if (field) {
    field.textContent = fieldChange(run) ?? "";
    field.className = run.field_change?.change_nT > run.field_change?.limit_nT ? "warn" : "";
  }
  const prompt = JSON.stringify(run?.prompt ?? null);
  if (prompt !== shownPrompt) {  // what a person types is not overwritten
    shownPrompt = prompt;
    fill(by("run-asking"), asking(run ?? {}, act));
    by("run-asking").className = "card asking";
    by("run-asking").hidden = !run?.prompt;
  }
  const checks = [...(run?.checks ?? [])].sort((a, b) => a.passed - b.passed);
  by("checks").hidden = checks.length === 0;
  fill(by("checks"), make("caption", {}, "Checks: the failed ones first"),
       rows(["", "check", "measured", "limit", "what to do"],
            checks.map((c) => [make("span", { class: c.passed ? "good" : "bad" }, c.passed ? "passed" : "failed"), c.name, c.measured, c.limit, c.remedy])));
}

export function wanted(form) {
  const read = (name) => Number(form.elements[name].value);
  return { step_deg: read("step_deg"), random: read("random"), revisits: read("revisits"), dwell_short_s: read("dwell_short_s"),
           dwell_long_s: read("dwell_long_s"), ...(read("until_explained_min") > 0 ? { until_explained_min: read("until_explained_min") } : {}) };
}
