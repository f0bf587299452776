// SPDX-License-Identifier: Apache-2.0
// A card for each sensor: its calibrated field, what it reads, how that scatters, its temperature; means of about a second.
import { make, table } from "./elements.js";

const kAxes = ["x", "y", "z"];
const fixed = (value, digits) => (value === null || value === undefined ? "--" : value.toFixed(digits));

function card(sensor, calibrated) {
  const { name, raw_nT: raw, sd_nT: sd, b_nT: field, f_nT: f, T_degC: warm } = sensor;
  const body = kAxes.map((axis, i) => [axis, ...(calibrated ? [fixed(field?.[i], 1)] : []), fixed(raw?.[i], 1), fixed(sd?.[i], 2)]);
  if (calibrated) body.push(["F", fixed(f, 1), "", ""]);
  const caption = `${name}${warm === null ? "" : `, ${warm.toFixed(1)} °C`}`;
  return make("div", { class: "card" }, table(caption, ["", ...(calibrated ? ["field, nT"] : []), "reading, nT", "sd, nT"], body));
}

/** What SENSORS says of the table and of the mean, in words. */
export function sensorsWords({ sensors, table: at, cal, t }, old) {
  const n = Math.max(...sensors.map((s) => s.epochs)), stands = at ? `; the table stands at azimuth ${at.azimuth_deg.toFixed(2)}, pitch ${at.pitch_deg.toFixed(2)}, roll ${at.roll_deg.toFixed(2)} deg` : "";
  const frame = cal === null ? "" : " Fields are those of the platform frame, readings those of the sensors' own axes.";
  return `${old ? `Last measured ${t.slice(11, 19)}Z: m` : "M"}eans of ${n} epoch${n === 1 ? "" : "s"}${stands}.${frame}`;
}

export function sensorCards(message, old) {
  const calibrated = message.cal !== null;
  return [make("p", { class: "caption" }, sensorsWords(message, old)), make("div", { class: "sensors" }, message.sensors.map((s) => card(s, calibrated)))];
}
