// SPDX-License-Identifier: Apache-2.0
// How the parameters moved from calibration to calibration, and who decided what. Numbers and sentences are those of
// mgt history --json.
import { draw, make, table } from "./elements.js";
import { plusMinus, sig, ticks } from "./numbers.js";

const kWidth = 410, kHeight = 170, kFar = 4;  // standard errors beyond which a dot is named
const text = (x, y, words, anchor = "middle", css = "") => draw("text", { x, y, "text-anchor": anchor, class: css }, words);
const line = (points, css) => draw("polyline", { points: points.map(([x, y]) => `${x.toFixed(1)},${y.toFixed(1)}`).join(" "), class: css });

/** Of each sensor its moves, those of the first sensor first: {s1: [{t_ms, when, parameter, sigmas, moved, moved_sd, unit}]}. */
export function movesBySensor(moves) {
  const out = {};
  for (const { t_utc, parameters } of moves)
    for (const p of parameters) {
      const [, sensor, parameter] = /^(s\d+) (\w+)$/.exec(p.name) ?? [];
      if (sensor && p.moved_sd > 0) (out[sensor] ??= []).push({ ...p, t_ms: Date.parse(t_utc), when: t_utc.slice(0, 16).replace("T", " "), parameter, sigmas: p.moved / p.moved_sd });
    }
  return Object.fromEntries(Object.entries(out).sort(([a], [b]) => Number(a.slice(1)) - Number(b.slice(1))));
}

/** Those whose names do not lie over each other: the first have precedence. */
export function apart(list, at, wide = 60, high = 14) {
  const out = [];
  for (const one of list) {
    const [x, y] = at(one);
    if (out.every((other) => { const [u, v] = at(other); return Math.abs(x - u) > wide || Math.abs(y - v) > high; })) out.push(one);
  }
  return out;
}

/** One sensor: a dot for each parameter of each calibration, in standard errors against the one before. */
function strip(sensor, dots, t0, t1, most) {
  const left = 44, right = kWidth - 12, top = 10, bottom = kHeight - 34;
  const X = (t) => (t1 > t0 ? left + 14 + ((t - t0) / (t1 - t0)) * (right - left - 28) : (left + right) / 2), Y = (s) => (top + bottom) / 2 - (s / most) * ((bottom - top) / 2 - 4);
  const band = (s, css) => draw("rect", { x: left, y: Y(s).toFixed(1), width: right - left, height: (Y(-s) - Y(s)).toFixed(1), class: css });
  const days = [...new Set(dots.map((d) => d.t_ms))].sort((a, b) => a - b), label = (t) => new Date(t).toISOString().slice(0, t1 - t0 < 4 * 86400e3 ? 16 : 10).replace("T", " ");
  const far = (d) => Math.abs(d.sigmas) > kFar;
  const dot = (d) => draw("circle", { cx: X(d.t_ms).toFixed(1), cy: Y(d.sigmas).toFixed(1), r: far(d) ? 4 : 2.6, class: far(d) ? "far" : "known" },
                          draw("title", {}, `${d.when}Z ${d.parameter}: ${plusMinus(d.moved, d.moved_sd, d.unit)}, ${sig(d.sigmas, 2)} standard errors`));
  const named = apart(dots.filter(far).sort((a, b) => Math.abs(b.sigmas) - Math.abs(a.sigmas)), (d) => [X(d.t_ms), Y(d.sigmas)])
    .map((d) => { const end = X(d.t_ms) > kWidth / 2; return text(X(d.t_ms) + (end ? -8 : 8), Y(d.sigmas) + 4, d.parameter, end ? "end" : "start", "far"); });
  return draw("svg", { viewBox: `0 0 ${kWidth} ${kHeight}`, role: "img", "aria-label": `Sensor ${sensor}: ${dots.filter(far).length} of ${dots.length} shifts beyond four standard errors` },
              [band(kFar, "band-far"), band(2, "band-near"), ticks(-most, most, 4).at.map((s) => [line([[left - 4, Y(s)], [left, Y(s)]], "rim"), text(left - 7, Y(s) + 4, String(s), "end")]),
               line([[left, Y(0)], [right, Y(0)]], "guide"), draw("rect", { x: left, y: top, width: right - left, height: bottom - top, class: "rim" }),
               days.map((t) => line([[X(t), bottom], [X(t), bottom + 4]], "rim")), text(X(days[0]), bottom + 18, label(days[0]), days.length > 1 ? "start" : "middle"),
               days.length > 1 ? text(X(days.at(-1)), bottom + 18, label(days.at(-1)), "end") : null, dots.map(dot), named]);
}

/** The figure with its sentences and, folded away, its numbers; a word where there is nothing to compare. */
export function historyFigure({ moves, figure }) {
  if (!figure) return make("p", { class: "caption" }, "How the parameters move shows as soon as there are two calibrations that were not rejected.");
  const sensors = movesBySensor(moves), all = Object.values(sensors).flat();
  const times = all.map((d) => d.t_ms), t0 = Math.min(...times), t1 = Math.max(...times), most = Math.max(5, 1.08 * Math.max(...all.map((d) => Math.abs(d.sigmas))));
  const strips = Object.entries(sensors).map(([sensor, dots]) => make("div", {}, make("h4", {}, sensor), strip(sensor, dots, t0, t1, most)));
  const words = moves.map((m) => make("pre", {}, m.text)).reverse();
  return make("figure", { class: "card" }, make("h3", {}, figure.title), make("div", { class: "strips" }, strips),
              make("figcaption", { class: "caption" }, figure.caption, make("span", { class: "good-one" }, ` A good one: ${figure.good}`)),
              make("details", {}, make("summary", {}, "The shifts as numbers, newest first"), make("div", { class: "scrolls", tabindex: "0", role: "region", "aria-label": "shifts of the parameters" }, words)));
}

const kWhat = { "rolled-back": "rolled back to" };
export function decisionTable(decisions) {
  return table("Decisions, newest first", ["when", "calibration", "what", "by whom", "because"],
               [...decisions].reverse().map((d) => [`${d.t.slice(0, 19)}Z`, d.id, (kWhat[d.event] ?? d.event) + (d.forced ? ", although it failed its checks" : ""), d.by || "not recorded", d.why || (d.origin ? `from ${d.origin}` : "")]));
}
