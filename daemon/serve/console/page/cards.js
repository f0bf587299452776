// SPDX-License-Identifier: Apache-2.0
// The cards beside the lanes: the tensor, the instruments, what the stream says of its calibration, what is recorded.
import { make, table } from "./elements.js";
import { shown } from "./lanes.js";
import { sig } from "./numbers.js";
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
    const row = [d.name, make("span", { class: good ? "good" : "bad" }, good ? "live" : d.state), d.frames, rejected];
    return trouble ? [row, [{ wide: trouble, columns: row.length }]] : [row];
  });
  return card(table("Instruments", ["", "state", "frames", "rejected"], body.flat()));
}

function judged(status) {
  const { state, measured, limit, remedy } = status.criticism;
  if (state === "none") return null;
  const bad = ["suspect", "identity", "near source"].includes(state);
  return card(make("h2", {}, "The stream says of its calibration: ", make("span", { class: bad ? "bad" : "good" }, state)),
              measured ? make("p", {}, `${measured}; limit: ${limit}. ${remedy}`) : null);
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
