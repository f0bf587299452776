// SPDX-License-Identifier: Apache-2.0
// The panels of a run whose fit is refused: what was measured, so that one sees why. Their sentences are those of mgt.

const some = (values) => values?.some((v) => v !== null) ?? false;
const series = (group) => Object.entries(group).filter(([, values]) => some(values)).map(([name, values], shape) => ({ name, values, shape }));

/** What a panel draws, as panelsOf. `channel`: whose readings are drawn, null: the first. */
export function measuredPanelsOf(measured, channel) {
  const p = measured.poses, sensors = Object.keys(p.raw_nT), name = channel ?? Object.keys(p.reading_nT)[0];
  const timed = some(p.t_h), x = timed ? { label: "time since the start, h", values: p.t_h } : { label: "pose", values: p.pose };
  const of = (label, list, over = x) => ({ spec: { poses: p.pose, x: over, y: { label }, series: list } });
  const reading = (over) => of(`reading of ${name}, nT`, [{ name, values: p.reading_nT[name], shape: Number(name[1]) - 1 }], over);
  const raw = `|reading| − ${measured.less}, nT`;
  const draw = {
    "measured-raw": () => of(raw, series(p.raw_nT)),
    "measured-skies": () => ({ kind: "skies", spec: { poses: p.pose, unit: "nT", skies: sensors.map((sensor) => ({ name: sensor, values: p.raw_nT[sensor],
      directions: p.pose.map((_, k) => ["x", "y", "z"].map((a) => p.direction_S[`${sensor}.${a}`][k])) })) } }),
    "measured-difference": () => of("|reading| − mean, nT", series(p.difference_nT)),
    "measured-time": () => reading(x),
    "measured-azimuth": () => reading({ label: "azimuth of the table, deg", values: p.azimuth_deg }),
    "measured-field": () => of("F, nT", [{ name: "F", values: p.f_nT, shape: 0 }]),
    "measured-temperature": () => of("temperature, °C", series(p.T_degC)),
    "measured-angles": () => of("angle, deg", series({ azimuth: p.azimuth_deg, pitch: p.pitch_deg, roll: p.roll_deg })),
    "measured-spread": () => of("spread, nT", series(p.spread_nT)),
  };
  return measured.panels.map((words) => ({ words, kind: "scatter", ...draw[words.name]() }));
}

/** What was measured at the pose under the cursor, in one line. */
export function measuredLine(measured, pose) {
  const p = measured.poses, k = p.pose.indexOf(pose), text = (value, digits, unit) => (value === null ? null : `${value.toFixed(digits)} ${unit}`);
  if (k < 0) return "";
  const degrees = ["azimuth_deg", "pitch_deg", "roll_deg"].map((a) => p[a][k]).filter((v) => v !== null).map((v) => v.toFixed(1)).join(", ");
  return [`pose ${pose}`, p.set[k], text(p.t_h[k], 3, "h"), degrees && `${degrees} deg`, p.f_nT[k] === null ? null : `F ${text(p.f_nT[k], 2, "nT")}`,
          ...Object.entries(p.raw_nT).map(([sensor, values]) => (values[k] === null ? null : `${sensor} ${text(values[k], 1, "nT")}`))].filter(Boolean).join(" · ");
}
