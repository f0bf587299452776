// SPDX-License-Identifier: Apache-2.0
// The course of a run: from where its sensors have seen the field, how well the tensor is known by now, and what disturbed it.
// Numbers and sentences are those of mgt run course --json.
import { by, draw, fill, make, rows, table } from "./elements.js";
import { bySensor, logTicks, sig, ticks } from "./numbers.js";
import { mollweide } from "./skies.js";

const kComponents = ["xx", "yy", "zz", "xy", "xz", "yz"];
const kParameters = [["offset_sd_nT", "worst offset ±, nT"], ["scale_sd_ppm", "worst scale ±, ppm"], ["angle_sd_deg", "worst angle ±, deg"]];
const kWidth = 410, kHeight = 236;  // of a drawing; its page scales it
const kManyPoses = 600;
const kNames = { measured: "measured", next: "under way", planned: "planned" };

const picture = (label, parts) => draw("svg", { viewBox: `0 0 ${kWidth} ${kHeight}`, role: "img", "aria-label": label }, parts);
const text = (x, y, words, anchor = "middle", css = "") => draw("text", { x, y, "text-anchor": anchor, class: css }, words);
const line = (points, css) => draw("polyline", { points: points.map(([x, y]) => `${x.toFixed(1)},${y.toFixed(1)}`).join(" "), class: css });
const number = (key, value) => make("span", { "data-key": key }, value);

/** The directions at an angle from one, as a circle on the sphere. */
export function circleAround([x, y, z], radius_deg, steps = 120) {
  const across = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
  const unit = (v) => { const length = Math.hypot(...v); return v.map((c) => c / length); };
  const n = unit([x, y, z]), u = unit(across(n, Math.abs(n[2]) < 0.9 ? [0, 0, 1] : [1, 0, 0])), v = across(n, u), r = (radius_deg * Math.PI) / 180;
  return Array.from({ length: steps + 1 }, (_, i) => (2 * Math.PI * i) / steps)
    .map((t) => n.map((c, k) => Math.cos(r) * c + Math.sin(r) * (Math.cos(t) * u[k] + Math.sin(t) * v[k])));
}

/** Mollweide's map of the directions: planned ones open, measured ones filled, the largest hole dashed. */
function sky({ pose, state, direction, hole }) {
  const a = 192, cx = kWidth / 2, cy = kHeight / 2, at = (d) => { const [x, y] = mollweide(d); return [cx + a * x, cy - a * y]; };
  const toward = (longitude_deg, latitude_deg) => {
    const [l, b] = [longitude_deg, latitude_deg].map((v) => (v * Math.PI) / 180);
    return at([Math.cos(b) * Math.cos(l), Math.cos(b) * Math.sin(l), Math.sin(b)]);
  };
  const steps = Array.from({ length: 37 }, (_, i) => -90 + 5 * i);
  const grid = [[-120, -60, 60, 120, 0].map((l) => line(steps.map((b) => toward(l, b)), "grid")),
                [-60, -30, 0, 30, 60].map((b) => line([-179.99, 179.99].map((l) => toward(l, b)), "grid"))];
  const rim = draw("ellipse", { cx, cy, rx: a, ry: a / 2, class: "rim" });
  const axes = [["+x", [cx, cy + 13]], ["+y", [cx + a / 2, cy + 13]], ["−y", [cx - a / 2, cy + 13]], ["+z", [cx, cy - a / 2 - 5]], ["−z", [cx, cy + a / 2 + 13]]]
    .map(([name, [x, y]]) => text(x, y, name));
  const parts = [[]];
  let before = null;
  for (const p of hole ? circleAround(hole.direction, hole.radius_deg).map(at) : []) {
    if (before !== null && Math.abs(p[0] - before) > a) parts.push([]);  // over the edge of the map it begins anew on the other side
    parts.at(-1).push(p);
    before = p[0];
  }
  const small = pose.length > kManyPoses;
  const mark = (wanted, r) => pose.map((p, i) => {
    if (state[i] !== wanted || !direction[i]) return null;
    const [x, y] = at(direction[i]);
    return draw("circle", { cx: x.toFixed(1), cy: y.toFixed(1), r, class: wanted }, draw("title", {}, `pose ${p}, ${kNames[wanted]}`));
  });
  const [done, known] = [state.filter((s) => s === "measured").length, direction.filter((d) => d).length];
  return picture(`Map of the directions of the field: ${done} of ${pose.length} poses are measured`,
                 [grid, rim, axes, parts.map((p) => line(p, "hole")), mark("planned", small ? 1.6 : 3), mark("measured", small ? 1.6 : 3.2), mark("next", 5.5),
                  known === 0 && pose.length > 0 ? text(cx, cy - 20, "where the others lie is known with the first pose") : null]);
}

/** The worst component against the poses, on log axes: measured, expected of the plan, wanted, and 1/sqrt(n). */
function fall({ poses, worst_nT_per_m: worst, expected, wanted_nT_per_m: wanted }, planned) {
  const left = 66, right = kWidth - 12, top = 12, bottom = kHeight - 42, known = poses.length > 0;
  const frame = [draw("rect", { x: left, y: top, width: right - left, height: bottom - top, class: "rim" }), text((left + right) / 2, kHeight - 5, "poses measured"),
                 draw("text", { transform: `translate(16 ${(top + bottom) / 2}) rotate(-90)`, "text-anchor": "middle" }, "standard error, nT/m")];
  const all = [...worst, ...expected.worst_nT_per_m];
  if (all.length === 0) return picture("The accuracy is not known yet", [frame, text((left + right) / 2, (top + bottom) / 2, "not known yet")]);
  const n = poses.at(-1), last = worst.at(-1), end = Math.max(planned, ...poses, ...expected.poses), guide = (p) => last * Math.sqrt(n / p);
  const ys = [...all, ...(known ? [guide(end)] : []), ...(wanted === null ? [] : [wanted])], y0 = 0.85 * Math.min(...ys), y1 = 1.2 * Math.max(...ys);
  const x0 = Math.min(...poses, ...expected.poses, 0.8 * end);
  const X = (p) => left + 8 + (Math.log(p / x0) / Math.log(end / x0)) * (right - left - 16), Y = (v) => bottom - (Math.log(v / y0) / Math.log(y1 / y0)) * (bottom - top);
  const xt = end / x0 < 20 ? ticks(x0, end, 5).at : logTicks(x0, end), mark = (p, v, css) => draw("circle", { cx: X(p).toFixed(1), cy: Y(v).toFixed(1), r: 3, class: css }, draw("title", {}, `${p} poses: ${sig(v)} nT/m`));
  const words = known ? `Standard error of the worst component: ${sig(last)} nT/m after ${n} poses` : "The standard error that the plan leads one to expect; none is measured yet";
  return picture(words, [logTicks(y0, y1).map((v) => [line([[left, Y(v)], [right, Y(v)]], "grid"), text(left - 5, Y(v) + 4, String(v), "end")]),
                         xt.map((v) => [line([[X(v), bottom], [X(v), bottom + 4]], "rim"), text(X(v), bottom + 18, String(v))]), frame,
                         line(expected.poses.map((p, i) => [X(p), Y(expected.worst_nT_per_m[i])]), "expected"),
                         known ? line([Math.max(x0, n * (last / y1) ** 2), end].map((p) => [X(p), Y(guide(p))]), "guide") : null,
                         wanted === null ? null : [line([[left, Y(wanted)], [right, Y(wanted)]], "wanted"), text(left + 6, Y(wanted) - 5, `wanted ${wanted}`, "start", "wanted")],
                         line(poses.map((p, i) => [X(p), Y(worst[i])]), "curve"), poses.map((p, i) => mark(p, worst[i], "known"))]);
}

const figure = (title, drawing, caption, good, more = null) =>
  make("figure", { class: "card" }, make("h3", {}, title), drawing, make("figcaption", { class: "caption" }, caption, good ? make("span", { class: "good-one" }, ` A good one: ${good}`) : null), more);

function coverage(c) {
  const done = c.state.filter((s) => s === "measured").length;
  return figure("Coverage", sky(c), [number("coverage.measured", String(done)), ` of ${c.pose.length} directions of the field in the platform, on an equal-area map. Filled: measured; open: planned; ring: under way`,
                                     c.hole ? ". Dashed: the largest hole." : "."], c.good);
}

function accuracy(a, planned) {
  const known = a.poses.length > 0, at = kComponents.filter((c) => a[c].some((v) => v !== null));
  const value = (v) => (v === null ? "" : sig(v)), residual = a.residual_nT.at(-1);
  const numbers = known ? make("details", {}, make("summary", {}, "Every component in nT/m, the residual in nT, and the parameters"),
    make("div", { class: "data", tabindex: "0", role: "region", "aria-label": "standard errors pose by pose" },
      table("", ["poses", ...at, "residual", ...kParameters.map(([, label]) => label)],
            a.poses.map((p, i) => [p, ...at.map((c) => sig(a[c][i])), value(a.residual_nT[i]), ...kParameters.map(([key]) => value(a[key][i]))]).reverse()))) : null;
  const every = known ? parameters(a) : null;
  const left = known && residual !== null ? ["; the fit of these leaves a residual of ", number("accuracy.residual_nT", sig(residual)), " nT"] : [];
  return figure("Accuracy", fall(a, planned), known
    ? ["The worst component of the tensor is known to ", number("accuracy.worst_nT_per_m", sig(a.worst_nT_per_m.at(-1))), " nT/m by a calibration from ", number("accuracy.poses", String(a.poses.at(-1))), " poses", ...left, ". Dots: after each fit; dashes: expected of the plan; thin dots: 1/√n through the last."]
    : ["The standard error of the tensor's worst component by a calibration from the poses so far. Dashes: expected of the plan.", a.why ? ` Not measured yet: ${a.why}.` : ""], a.good, [numbers, every]);
}

/** The standard error of every parameter after the last fit. */
function parameters({ poses, parameters: { name, unit, sd } }) {
  if (!sd.at(-1)) return null;
  const { sensors, lines } = bySensor(name, unit, sd.at(-1));
  return make("details", { id: "course-parameters" }, make("summary", {}, `Standard error of every parameter after ${poses.at(-1)} poses`),
    make("div", { class: "data", tabindex: "0", role: "region", "aria-label": "standard error of every parameter" },
      table("", ["", "unit", ...sensors], lines.map(([parameter, of, ...values]) => [parameter, of || "ppm", ...values.map((v) => sig(of ? v : 1e6 * v))]))));
}

const kSeen = { array: "array", scalar: "scalar", level: "scalar, against the pose before" };
function disturbances(list) {
  const h3 = make("h3", {}, `Disturbances of the field: ${list.length}`);
  if (list.length === 0) return make("div", { class: "card" }, h3, make("p", { class: "caption" }, "The field stood still at every pose so far."));
  const lasted = (s) => (s === null ? "not over when last seen" : `${s.toFixed(0)} s`);
  return make("div", { class: "card scrolls", tabindex: "0", role: "region", "aria-label": "disturbances" }, h3, make("table", {}, rows(["when", "pose", "change, nT", "limit, nT", "seen by", "lasted", "what the run did"],
    [...list].reverse().map((d) => [`${d.t.slice(11, 19)}Z`, d.pose, sig(d.change_nT, 2), sig(d.limit_nT, 2), kSeen[d.seen_by], lasted(d.lasted_s), d.then]))));
}

/** What the run wrote down, the newest first; folded away. */
function events({ events: list, left_out }) {
  const earlier = left_out ? ` and ${left_out} earlier ones in the run file` : "";
  return make("details", { class: "card", id: "run-events" }, make("summary", {}, `What the run wrote down: ${list.length} entries${earlier}`),
    make("div", { class: "data", tabindex: "0", role: "region", "aria-label": "what the run wrote down" },
      make("table", {}, rows(["when", "what"], [...list].reverse().map((e) => [`${e.t.slice(0, 19).replace("T", " ")}Z`, e.what])))));
}

let shown = { run_id: "", text: "" }, asked = "", asking = false;
async function asObject(path) {
  const answer = await fetch(path);
  if (!answer.ok) throw new Error(String(answer.status));
  return answer.json();
}
/** Asks for the course whenever the run has moved on, one question at a time. */
export async function showCourse(run) {
  const at = JSON.stringify([run?.run_id, run?.state, run?.pose, run?.poses, run?.tensor_sd_nT_per_m, run?.message]);
  by("course").hidden = !run?.run_id || shown.run_id !== run.run_id;
  if (asking || !run?.run_id || at === asked) return;
  asking = true;
  try {
    const [course, log] = await Promise.all(["/run/course", "/run/events"].map(asObject)), text = JSON.stringify([course, log]);
    asked = at;
    if (text === shown.text || course.run_id !== run.run_id) return;
    shown = { run_id: course.run_id, text };
    const open = [...by("course").querySelectorAll("details")].map((d) => d.open);
    fill(by("course"), coverage(course.coverage), accuracy(course.accuracy, course.coverage.pose.length), disturbances(course.disturbances), events(log));
    [...by("course").querySelectorAll("details")].forEach((d, i, all) => { d.open = open.at(i - all.length) ?? false; });
    by("course").hidden = false;
  } catch { /* the daemon does not answer: asked again with its next word */ } finally { asking = false; }
}
