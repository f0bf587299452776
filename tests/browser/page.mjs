// SPDX-License-Identifier: Apache-2.0
// The arithmetic of the page, without a browser: numbers as text, ticks, means of bins, the projection of the skies; and that
// no file of the page has a way to make markup of a text.
import assert from "node:assert/strict";
import { readdirSync, readFileSync } from "node:fs";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";
import { gzipSync } from "node:zlib";

const page = join(dirname(fileURLToPath(import.meta.url)), "../../daemon/serve/console/page");
/** A module of the page; those that only name the document are loaded without one. */
const load = (name) => import(`data:text/javascript,${encodeURIComponent(readFileSync(join(page, name), "utf8").replace(/from "\.\/(\w+)\.js"/g, (_, other) =>
  `from "data:text/javascript,${encodeURIComponent(readFileSync(join(page, `${other}.js`), "utf8").replace(/^import .*$/gm, "const css = () => '';").replace(/^const css = \(name.*$/gm, ""))}"`))}`);
const { ago, binMeans, bySensor, chance, extent, logTicks, plusMinus, sig, ticks } = await load("numbers.js");

assert.deepEqual([0.60506, 0.019, 31.5, 928065, 0, 1e-8, null, NaN].map((v) => sig(v)), ["0.605", "0.0190", "31.5", "928065", "0", "1.00e-8", "--", "--"]);
assert.equal(plusMinus(2.99874, 0.00233, "nT/degC"), "+2.9987 ± 0.0023 nT/°C");
assert.equal(plusMinus(-12.3, 0, "nT"), "-12.3 nT");
assert.deepEqual([-500, -7, -1, null].map(chance), ["< 1e-30", "1e-7", "0.10", "--"]);

assert.deepEqual([-1, 119.9, 120, 7199, 7200, 172799, 172800].map(ago), ["0 s", "119 s", "2 min", "119 min", "2 h", "47 h", "2 days"]);

for (const [low, high, wanted] of [[0, 1, 5], [-2.7, 3.4, 4], [1e-9, 4e-9, 3], [53900, 53910, 6], [-1e6, 1e6, 2]]) {
  const { at, text } = ticks(low, high, wanted);
  assert.ok(at.every((v) => v >= low - 1e-6 * (high - low) && v <= high + 1e-6 * (high - low)), `ticks beyond ${low} to ${high}`);
  assert.ok(at.length >= 1 && at.length <= 2 * wanted + 2, `${at.length} ticks for ${wanted}`);
  assert.equal(new Set(at.map(text)).size, at.length, "two ticks with one text");
}
assert.deepEqual(logTicks(0.8, 30), [1, 2, 5, 10, 20]);
assert.deepEqual(logTicks(0.03, 70), [0.1, 1, 10], "decades where there are many");
assert.deepEqual(extent([[null, 1, 3], [2]]), [0.88, 3.12]);
assert.deepEqual(extent([[]]), [-1, 1]);
const [least, greatest] = extent([[-1, 3]], true);
assert.equal(least, -greatest);

const x = Array.from({ length: 80 }, (_, i) => (i * 37) % 80), bins = binMeans(x, x.map((v) => 2 * v));
assert.equal(bins.length, 8);
for (const bin of bins) assert.ok(Math.abs(bin.y - 2 * bin.x) < 1e-9);
assert.ok(bins.every((b, i) => i === 0 || b.x > bins[i - 1].x));
assert.equal(binMeans([1, null, 2], [1, 2, null]).length, 0, "too few to have a mean");

// Equal area: the share of directions that falls into a part of the map is the share of its area.
const { mollweide } = await load("skies.js");
let inner = 0, all = 0;
for (let i = 0; i < 40; ++i)
  for (let k = 0; k < 80; ++k) {
    const z = -1 + (2 * (i + 0.5)) / 40, longitude = -Math.PI + (2 * Math.PI * (k + 0.5)) / 80, r = Math.sqrt(1 - z * z);
    const [u, v] = mollweide([r * Math.cos(longitude), r * Math.sin(longitude), z]), radius2 = u * u + 4 * v * v;
    assert.ok(radius2 < 1 + 1e-9, "beyond the edge");
    inner += radius2 < 0.25 ? 1 : 0;
    ++all;
  }
assert.ok(Math.abs(inner / all - 0.25) < 0.01, `${inner / all} of the directions on a quarter of the map`);
assert.deepEqual(mollweide([1, 0, 0]).map((v) => Math.abs(v)), [0, 0]);
assert.ok(Math.abs(mollweide([0, 0, 1])[1] - 0.5) < 1e-9);

const { apart, movesBySensor } = await load("history.js");
const moved = movesBySensor([{ t_utc: "2026-05-11T08:00:00.000Z", parameters: [{ name: "s12 cx", moved: -1, moved_sd: 1 }, { name: "s3 iz", moved: 1.5, moved_sd: 0.5, unit: "nT" }, { name: "s3 alpha", moved: 0 }, { name: "site.gradient Gxx", moved: 2, moved_sd: 1 }] }]);
assert.deepEqual(Object.keys(moved), ["s3", "s12"], "an effect is no parameter of a sensor");
assert.deepEqual([moved.s3.length, moved.s3[0].sigmas], [1, 3], "what these runs cannot tell is no dot");
assert.deepEqual([moved.s3[0].parameter, moved.s3[0].when, moved.s3[0].t_ms], ["iz", "2026-05-11 08:00", Date.UTC(2026, 4, 11, 8)]);
assert.deepEqual(apart([[0, 0], [10, 5], [10, 40], [200, 1]], (p) => p), [[0, 0], [10, 40], [200, 1]], "a name over another is left out");

assert.deepEqual(bySensor(["s1 theta", "s1 cx", "s2 theta", "s2 cx"], ["deg", "", "deg", ""], [0.1, 2, 0.3, 4]),
                 { sensors: ["s1", "s2"], lines: [["theta", "deg", 0.1, 0.3], ["cx", "", 2, 4]] });

const { calibrationWords, conditions, warmer_K } = await load("cards.js");
const made = { forced: false, age_s: 3 * 86400, made_at_degC: [12.31, null, 11.87], now_degC: [31.02, 31.04, 30.98] };
assert.equal(conditions(made), "made 3 days ago at 11.9 to 12.3 °C, now 31.0 °C");
assert.equal(conditions({ ...made, age_s: null, now_degC: [null, null, null] }), "made at 11.9 to 12.3 °C");
assert.equal(conditions({ age_s: null, made_at_degC: null, now_degC: null }), "");
assert.ok(Math.abs(warmer_K(made) - 19.11) < 1e-9);
assert.equal(calibrationWords({ cal: "c1", calibration: made }), "calibration c1, made 3 days ago at 11.9 to 12.3 °C, now 31.0 °C");
assert.equal(calibrationWords({ cal: "c1", calibration: { ...made, forced: true, now_degC: [12, 12, 12] } }), "calibration c1, forced, 3 days old");
assert.equal(calibrationWords({ cal: null, calibration: {} }), "no calibration: the stream is raw");

const { sensorsWords } = await load("sensors.js");
const read = { t: "2026-11-21T10:00:00.123456Z", cal: null, table: null, sensors: [{ epochs: 50 }, { epochs: 49 }] };
assert.equal(sensorsWords(read, false), "Means of 50 epochs.");
assert.ok(sensorsWords({ ...read, cal: "c1", table: { azimuth_deg: 30, pitch_deg: -5, roll_deg: 0 } }, true)
  .startsWith("Last measured 10:00:00Z: means of 50 epochs; the table stands at azimuth 30.00, pitch -5.00, roll 0.00 deg. Fields are"));

// A column covers what a line through all its samples does, with the way from the column before.
const { Columns, kColumn_s } = await load("columns.js");
const columns = new Columns(10), at = (column, part) => (column + part) * kColumn_s;
for (const [t_s, v] of [[at(100, 0.1), 5], [at(100, 0.5), -2], [at(100, 0.9), 1], [at(101, 0.2), 3], [at(102, 0.1), null], [at(102, 0.3), 7], [at(140, 0.5), 8]]) columns.add(t_s, v);
assert.deepEqual(columns.all.map(({ least, greatest, low, high, last, joined }) => [least, greatest, low, high, last, joined]),
                 [[-2, 5, -2, 5, 1, false], [3, 3, 1, 3, 3, true], [7, 7, 7, 7, 7, false], [8, 8, 8, 8, 8, false]], "neither over what was not measured nor over a long silence");
columns.add(at(140, 0.5) + 11, 0);
assert.equal(columns.all.length, 1, "what is older than the span is forgotten");

// The lanes, on a canvas that is not drawn: what their table says of a minute, and of what was not measured.
globalThis.requestAnimationFrame = () => {};
const { Lanes } = await load("lanes.js");
const canvas = { addEventListener() {}, style: {}, clientWidth: 0 }, lanes = new Lanes(canvas, () => {});
lanes.channels = [{ name: "xx", label: "Gxx", unit: "nT/m", least_span: 0.5 }, { name: "f", label: "F", unit: "nT", least_span: 0.5 }];
assert.equal(lanes.summary()[0].mean, "--", "nothing came yet");
const of = (label) => lanes.summary().find((lane) => lane.label === label);
for (let i = 0; i <= 100; ++i) {
  lanes.endGap(1000 + i);
  lanes.add(1000 + i, { xx: i, f: null });
}
assert.deepEqual(of("Gxx"), { label: "Gxx", unit: "nT/m", now: "100.0", mean: "70.0", least: "40.0", greatest: "100.0", gaps: 0 }, "the last minute of the hundred seconds");
assert.deepEqual([of("F").now, of("F").mean], ["--", "--"], "a channel without a value");
lanes.pass(1150);
assert.equal(of("Gxx").least, "40.0", "time passes for the lanes only while nothing is measured");
lanes.gap("s2: silent");
lanes.pass(1110);
lanes.gap("s2: not measuring yet");
lanes.pass(1120);
assert.deepEqual([of("Gxx").gaps, of("Gxx").least, of("Gxx").greatest], [2, "60.0", "100.0"], "the lanes go on while nothing is measured");
lanes.endGap(1121);
lanes.add(1121, { xx: 5, f: 1 });
for (let i = 1122; i <= 1175; ++i) lanes.add(i, { xx: 5, f: 1 });
assert.equal(of("Gxx").gaps, 1, "a gap with another reason ended the one before: only the second lies in the minute");
for (let i = 1176; i <= 1182; ++i) lanes.add(i, { xx: 5, f: 1 });
assert.equal(of("Gxx").gaps, 0, "a gap that is over is none");

let gzipped = 0;
for (const name of readdirSync(page)) {
  const bytes = readFileSync(join(page, name)), found = /innerHTML|outerHTML|insertAdjacentHTML|document\.write|\beval\(|new Function|style=|setAttribute\("style|DOMParser/.exec(bytes.toString());
  assert.equal(found, null, `${name} has ${found}: a text of a file could become markup`);
  gzipped += gzipSync(bytes, { level: 9 }).length;
}
assert.ok(gzipped < 100_000, `the page has ${gzipped} bytes gzipped`);
console.log(`the page: its numbers are right, and it has ${gzipped} bytes gzipped`);
