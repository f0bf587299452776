// SPDX-License-Identifier: Apache-2.0
// The cards beside the lanes: the tensor, the instruments, what the stream says of its calibration, what is recorded.
import { make, table } from "./elements.js";
import { shown } from "./lanes.js";
import { ago, sig } from "./numbers.js";
import { fieldChange } from "./run.js";

const kComponents = ["xx", "yy", "zz", "xy", "xz", "yz"];
const megabytes = (bytes) => `${(bytes / 1e6).toFixed(1)} MB`;
const card = (...children) => make("div", { class: "card" }, children);

/** `old`: no sample came since. */
function tensor(sample, old) {
  const since = old ? `, last measured ${sample.t.slice(11, 19)}Z` : "";
  const told = kComponents.filter((c) => sample.g_nT_per_m[c] !== null);
  const value = (v, sd) => (v === null ? "--" : sd === null ? v.toFixed(2) : `${v.toFixed(2)} ± ${sd.toFixed(2)}`);
  const field = table(`Field at the centre${since}`, ["", "nT"], [["x", "y", "z"].map((axis, i) => [axis, shown(sample.b_nT[i], 1)]),
                                                           [["F", shown(sample.f_nT, 1)]]].flat());
  if (told.length === 0) return [card(field)];
  return [card(table(`Gradient${sample.cal === null ? ", raw" : ""}${since}`, ["", "nT/m"],
                     told.map((c) => [c, value(sample.g_nT_per_m[c], sample.g_sd_nT_per_m[c])])), invariants(sample.invariants), field)];
}

/** What does not change when the frame is turned; null where the array cannot tell every component. */
function invariants(told) {
  if (!told) return null;
  return table("Invariants of the tensor", ["", "value", "unit"],
               [["I₁", sig(told.I1_nT2_per_m2, 4), "nT²/m²"], ["I₂", sig(told.I2_nT3_per_m3, 4), "nT³/m³"], ["contraction", sig(told.contraction_nT_per_m, 4), "nT/m"]]);
}

function instruments(status) {
  const body = status.devices.map((d) => {
    const good = d.state === "live";
    const rejected = Object.values(d.rejected).reduce((a, b) => a + b, 0);
    const trouble = d.clock?.trouble || (good ? "" : d.detail);
    const since = d.state_since_s === null ? "" : make("span", { class: "unbroken" }, ago(d.state_since_s)), rate = d.rate_hz === null ? "--" : d.rate_hz.toFixed(1);
    const row = [d.name, make("span", { class: good ? "good" : "bad" }, good ? "live" : d.state), since, rate, rejected];
    return trouble ? [row, [{ wide: trouble, columns: row.length }]] : [row];
  });
  return card(table("Instruments", ["", "state", "for", "Hz", "rejected"], body.flat()));
}

export const kWarmer_K = 5;  // a difference that is told at the top of every screen
const known = (list) => (list ?? []).filter((v) => v !== null);
const range = (list) => (Math.min(...list).toFixed(1) === Math.max(...list).toFixed(1) ? list[0].toFixed(1) : `${Math.min(...list).toFixed(1)} to ${Math.max(...list).toFixed(1)}`);

/** When the calibration was made, and how warm it was then and is now; "" where nothing is known. */
export function conditions({ age_s, made_at_degC, now_degC }) {
  const made = known(made_at_degC), now = known(now_degC);
  const parts = [age_s === null ? "" : `${ago(age_s)} ago`, made.length ? `at ${range(made)} °C` : ""].filter(Boolean).join(" ");
  return parts ? `made ${parts}${made.length && now.length ? `, now ${range(now)} °C` : ""}` : "";
}
/** The largest difference of a sensor's temperature from that of the run; 0 where none is known. */
export function warmer_K({ made_at_degC, now_degC }) {
  return Math.max(0, ...(made_at_degC ?? []).map((made, i) => (made === null || now_degC[i] === null ? 0 : Math.abs(now_degC[i] - made))));
}
/** What stands at the top of every screen. */
export function calibrationWords({ cal, calibration }) {
  if (cal === null) return "no calibration: the stream is raw";
  const far = warmer_K(calibration) >= kWarmer_K, age = calibration.age_s === null ? "" : `, ${ago(calibration.age_s)} old`;
  return `calibration ${cal}${calibration.forced ? ", forced" : ""}${far ? `, ${conditions(calibration)}` : age}`;
}

function judged(status) {
  const { state, measured, limit, remedy } = status.criticism, made = conditions(status.calibration);
  if (state === "none" && !made) return null;
  const bad = ["suspect", "identity", "exchanged", "turned", "near source"].includes(state);
  return card(make("h2", {}, "The stream says of its calibration: ", make("span", { class: bad ? "bad" : "good" }, state === "none" ? "nothing" : state)),
              measured ? make("p", {}, `${measured}; limit: ${limit}. ${remedy}`) : null,
              made ? make("p", { class: warmer_K(status.calibration) >= kWarmer_K ? "warn" : "" }, `It was ${made}.`) : null);
}

function inputs(status) {
  if (status.inputs.length === 0) return null;
  return card(table("Inputs", ["", "value", "unit"], status.inputs.map((i) => [i.name, i.value === null ? "--" : i.value.toFixed(3), i.unit ?? ""])));
}

function recording(status) {
  const body = [["journal", status.journal], ["samples", status.ring]].map(([name, r]) =>
    [name, make("span", { class: r.state === "writing" ? "good" : "warn" }, r.state), megabytes(r.bytes), r.why]);
  const free = status.disk_free_bytes === null ? "" : `, ${(status.disk_free_bytes / 1e9).toFixed(1)} GB free`;
  return card(table(`Recording${free}`, ["", "state", "since the start", ""], body));
}

function field({ run }) {
  const words = fieldChange(run);
  if (!words) return null;
  const over = run.field_change.change_nT > run.field_change.limit_nT;
  return card(make("h2", {}, `Field at pose ${run.pose + 1} of ${run.poses}`), make("p", { class: over ? "warn" : "", id: "field-change" }, words));
}

export function cards(status, sample, old) {
  return [sample ? tensor(sample, old) : [], judged(status), field(status), instruments(status), inputs(status), recording(status)].flat();
}
