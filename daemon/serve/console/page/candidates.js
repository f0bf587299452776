// SPDX-License-Identifier: Apache-2.0
// What could be missing, the evidence for one of them, and what adding it did.
import { by, fill, make, table } from "./elements.js";
import { chance, kSeen_d, plusMinus, sig, signed } from "./numbers.js";
import { Panel } from "./panel.js";

const kLeast = 5, kMost = 12, kRinged = 4;  // ringed: times its share of the leverage
/** A number that a test holds against mgt: `key` says where in the JSON it stands. */
export const number = (value, key, digits = 3) => make("span", { "data-key": key }, sig(value, digits));
const size = (candidate) => {
  const [first] = [...candidate.coefficients].sort((a, b) => Math.abs(b.value / b.sd) - Math.abs(a.value / a.sd));
  return first ? plusMinus(first.value, first.sd, first.unit) + (candidate.coefficients.length > 1 ? `, ${candidate.coefficients.length} in all` : "") : "";
};

/** Bars of d with the line at which an effect is seen; those that these poses cannot tell apart are hatched alike. */
export function showCandidates(explain, words, chosen, choose) {
  const most = Math.max(1.15 * kSeen_d, ...explain.candidates.map((c) => c.d));
  const list = explain.candidates, above = list.filter((c) => c.d >= kSeen_d).length;
  const strong = list.slice(0, Math.max(kLeast, Math.min(kMost, above)));
  const twins = new Set();
  for (const c of strong) if (explain.named.includes(c.effect))
    for (const r of c.rivals) if (r.possible) { twins.add(c.effect); twins.add(r.effect); }
  const row = (c, i) => {
    const bar = make("i", { class: `bar ${explain.named.includes(c.effect) ? "named" : ""} ${twins.has(c.effect) ? "hatched" : ""}` });
    bar.style.width = `${(100 * c.d) / most}%`;
    const alarm = make("i", { class: "alarm" });
    alarm.style.left = `${(100 * kSeen_d) / most}%`;
    const rivals = c.rivals.filter((r) => r.possible).map((r) => r.effect);
    return make("li", {}, make("button", { class: "candidate", "aria-pressed": String(c.spec === chosen), "data-spec": c.spec, onclick: () => choose(c) },
      make("b", {}, c.effect), make("small", {}, ` ${c.where}`), make("span", { class: "track" }, bar, alarm),
      make("small", {}, "d ", number(c.d, `candidates.${i}.d`), ` · p ${chance(c.log10_p)} · ${size(c)}`,
           c.impact_nT_per_m ? ` · ${sig(c.impact_nT_per_m, 2)} nT/m in ${c.impact_component}` : "",
           c.plausible ? "" : " · beyond what occurs", rivals.length && twins.has(c.effect) ? ` · could also be ${rivals.join(", ")}` : "")));
  };
  const untestable = explain.untestable.map((u) => make("li", { class: "untestable" }, make("b", {}, u.effect), make("small", {}, ` ${u.why}`)));
  const others = list.slice(strong.length).map((c, i) => row(c, i + strong.length));
  return [make("ol", { class: "candidates" }, strong.map(row)),
          words ? make("p", { class: "good-one" }, `Good: ${words.good}`) : null,
          others.length ? make("details", {}, make("summary", {}, `the other ${others.length}`), make("ol", { class: "candidates" }, others)) : null,
          untestable.length ? make("details", {}, make("summary", {}, `${untestable.length} that these poses cannot test`), make("ul", { class: "candidates" }, untestable)) : null];
}

/** Evidence of one: a line through many poses, what it does to the maps, what else it could be. */
export class Evidence {
  #panel = null; #canvas = null;
  constructor(on) { this.on = on; }
  show(why, buttons) {
    const a = why.added_variable, c = why.candidate;
    this.#canvas = make("canvas", { class: "panel", role: "img", "aria-label": `${why.figure.title}. ${why.figure.good}` });
    this.#panel = new Panel(this.#canvas, this.on);
    const lever = a.x.reduce((sum, x) => sum + x * x, 0) / a.x.length;
    this.#panel.show({ poses: a.pose, ringed: new Set(a.pose.filter((_, k) => a.x[k] ** 2 > kRinged * lever)), x: { label: "made of the pose by the effect, noise = 1", values: a.x }, y: { label: "left there, noise = 1", also: [[0]] },
                       line: { slope: a.slope, sd: a.slope_sd }, series: [{ name: c.effect, values: a.y, shape: 0 }] });
    const after = new Map(why.after.maps.map((m) => [m.map, m.log10_p]));
    return [make("h3", {}, why.figure.title), this.#canvas, make("p", { class: "good-one" }, `Good: ${why.figure.good}`), make("p", { class: "row" }, buttons),
            table("The residual against", ["", "p without it", "p with it"], why.before.maps.slice(0, 5).map((m) => [`${m.map} ${m.where}`, ...[m.log10_p, after.get(m.map)].map((p) => make("span", {}, chance(p)))])),
            c.rivals.length ? table("It could also be", ["", "where", "p right", ""], c.rivals.slice(0, 5).map((r) => [r.effect, r.where, sig(r.p_right), r.possible ? "possible" : "no"])) : null,
            why.tells.length ? make("ul", { class: "tells" }, why.tells.map((t) => make("li", {}, make("b", {}, t.effect), ` ${t.by}`))) : null];
  }
  draw(state) { return this.#panel?.draw(state) ?? false; }
  stale() { this.#panel?.stale(); }
}

/** What adding or dropping an effect did, with the reason of a veto. */
export function showChange(change, buttons) {
  const fall = change.action === "add" ? ["fall", change.predicted_fall, change.realised_fall] : ["rise", change.predicted_rise, change.realised_rise];
  const numbers = (before, after, key) => [number(before, `change.${key.replace("*", "before")}`), number(after, `change.${key.replace("*", "after")}`)];
  const body = [["residual, nT", ...numbers(change.rms_before_nT, change.rms_after_nT, "rms_*_nT")],
                ["on poses held out, nT", ...numbers(change.held_out_before_nT, change.held_out_after_nT, "held_out_*_nT")],
                ["error of the tensor, nT/m", ...numbers(change.tensor_before_nT_per_m, change.tensor_after_nT_per_m, "tensor_*_nT_per_m")],
                ["noise of a pose mean, nT", "", number(change.noise_nT, "change.noise_nT")]];
  const price = change.variance_price.parameter
    ? [`sd of ${change.variance_price.parameter} times `, number(change.variance_price.growth_of_sd, "change.variance_price.growth_of_sd")] : ["no standard deviation grows"];
  const state = change.tried ? (change.vetoed ? "tried: speaks against it" : "tried, not kept") : change.kept ? "kept" : "not kept";
  return [make("h3", {}, `${change.action === "add" ? "With" : "Without"} ${change.effect}: `, make("span", { class: change.vetoed ? "bad" : "good", id: "change-state" }, state)),
          table("", ["", "before", "after"], body),
          make("p", {}, `χ² ${fall[0]} predicted `, number(fall[1], `change.predicted_${fall[0]}`, 4), ", realised ", number(fall[2], `change.realised_${fall[0]}`, 4), ". Price: ", price, "."),
          change.coefficients.length ? make("p", {}, change.coefficients.slice(0, 6).map((c) => `${c.name} ${plusMinus(c.value, c.sd, c.unit)}`).join("; "), change.coefficients.length > 6 ? "; ..." : "") : null,
          ...change.veto_reasons.map((reason) => make("p", { class: "bad" }, reason)),
          change.open ? make("p", { class: "warn" }, change.open) : null, make("p", { class: "row" }, buttons)];
}

/** The steps that the run keeps, as bars of what each left; noise and held-out error beside them. */
export function showFall(model, compare, fit, buttonsOf) {
  const steps = [];
  for (const step of model?.history ?? []) {
    if (step.action === "undo") steps.pop();
    else steps.push(step);
  }
  const changes = steps.filter((s) => s.action === "add" || s.action === "drop");
  const first = changes[0]?.result.rms_before_nT ?? compare.residual_nT;
  const list = [{ label: changes.length ? "without effects" : "the model as it is", residual: first, held_out: changes[0]?.result.held_out_before_nT ?? fit?.held_out_residual_nT,
                  keys: changes.length ? ["", ""] : ["compare.residual_nT", "fit.held_out_residual_nT"] },
                ...changes.map((s, i) => ({ label: `${s.action === "add" ? "+" : "−"} ${s.spec}`, residual: s.result.rms_after_nT, held_out: s.result.held_out_after_nT,
                                            keys: [`steps.${i}.rms_after_nT`, `steps.${i}.held_out_after_nT`] }))];
  const most = Math.max(...list.flatMap((s) => [s.residual, s.held_out ?? 0]), compare.noise_nT) * 1.04;
  const bar = (s, i) => {
    const fallen = make("i", { class: "bar fallen" }), left = make("i", { class: "bar" }), floor = make("i", { class: "floor" }), held = make("i", { class: "held" });
    left.style.width = `${(100 * s.residual) / most}%`;
    if (i > 0) { fallen.style.left = left.style.width; fallen.style.width = `${Math.max(0, (100 * (list[i - 1].residual - s.residual)) / most)}%`; }
    floor.style.left = `${(100 * compare.noise_nT) / most}%`;
    if (s.held_out) held.style.left = `${(100 * s.held_out) / most}%`;
    return make("li", {}, make("b", {}, s.label), make("span", { class: "track" }, i > 0 ? fallen : null, left, floor, s.held_out ? held : null),
                make("small", {}, "residual ", number(s.residual, s.keys[0]), " nT", s.held_out ? [" · held out ", number(s.held_out, s.keys[1]), " nT"] : []));
  };
  return [make("ol", { class: "fall", id: "fall" }, list.map(bar)),
          make("p", { class: "good-one" }, make("i", { class: "key floor" }), ` noise ${sig(compare.noise_nT)} nT  `, make("i", { class: "key held" }), " on poses held out"),
          make("p", { class: "row" }, buttonsOf(steps))];
}
