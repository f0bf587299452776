// SPDX-License-Identifier: Apache-2.0
// What stands below the panels: a formula, what to measure next, what cannot be told apart, limits, parameters, history.
import { fill, make, table } from "./elements.js";
import { chance, plusMinus, sig } from "./numbers.js";
import { Panel } from "./panel.js";

const css = (name) => getComputedStyle(document.documentElement).getPropertyValue(name).trim();
const time = (t) => t.slice(0, 19).replace("T", " ") + "Z";

/** `measure(step)` takes its poses to the form of a run; null without a rig. */
export function showNext(next, measure) {
  if (next.next.length === 0) return [make("p", {}, next.text)];
  return [make("p", {}, make("b", {}, next.effect), next.rival ? [" or ", make("b", {}, next.rival), "?"] : ""),
          table("What to measure, the best first", ["", "minutes", "right name, now", "right name, then", "by", ""],
                next.next.map((s) => [s.action, s.minutes.toFixed(0), sig(s.p_right_before), sig(s.p_right_after), s.by_the_rig ? "the rig" : "hand",
                                      measure && s.run ? make("button", { class: "small", onclick: () => measure(s) }, "Measure this") : ""])),
          next.text ? make("p", {}, next.text) : null];
}

export function showLimits(explain, words) {
  return [make("div", { class: "columns" },
    make("div", {}, table("Smallest size that would have been seen", ["", "where", "", ""], explain.detectable_above.map((d) => d.value === null ? [d.effect, d.text, "", ""]
      : [d.effect, d.where, sig(d.value, 2), d.unit.replace("degC", "°C").replace("^2", "²")]))),
    make("div", {}, table("Not testable on these poses", ["", "why"], explain.untestable.map((u) => [u.effect, u.why])),
         table("The residual follows", ["", "where", "p"], explain.maps.map((m) => [m.map, m.where, make("span", {}, chance(m.log10_p))])))),
          words ? make("p", { class: "good-one" }, `Good: ${words.good}`) : null];
}

export function showParameters(fit) {
  const names = [["theta_deg", "θ, deg"], ["phi_deg", "φ, deg"], ["psi_deg", "ψ, deg"], ["cx", "cx"], ["cy", "cy"], ["cz", "cz"], ["ix_nT", "ix, nT"], ["iy_nT", "iy, nT"],
                 ["iz_nT", "iz, nT"], ["alpha_deg", "α, deg"], ["beta_deg", "β, deg"], ["gamma_deg", "γ, deg"]];
  const known = names.filter(([key]) => fit.sensors[0]?.[key]);
  const effects = fit.effects.flatMap((e) => e.coefficients.map((c) => [e.effect, c.name, plusMinus(c.value, c.sd, c.unit)]));
  const checks = fit.checks.filter((c) => !c.passed).map((c) => [c.name, c.measured, c.limit, c.remedy]);
  return [table(`Calibration of ${fit.poses} poses, ${fit.accepted ? "accepted" : "not accepted"}`, ["", ...fit.sensors.map((_, i) => `s${i + 1}`)],
                known.map(([key, label]) => [label, ...fit.sensors.map((s) => plusMinus(s[key].value, s[key].sd))])),
          effects.length ? table("Effects in the model", ["", "", ""], effects) : null,
          checks.length ? table("Checks that failed", ["", "measured", "limit", "what to do"], checks) : null,
          table("Standard error of the gradient by the calibration, nT/m", Object.keys(fit.tensor_sd_nT_per_m), [Object.values(fit.tensor_sd_nT_per_m).map((v) => sig(v, 2))]),
          fit.reasons.length ? make("ul", {}, fit.reasons.map((r) => make("li", {}, r))) : null];
}

export function showHistory(model, unmask) {
  if (!model) return [make("p", {}, "A pose table keeps no model and no history.")];
  const told = (value) => (value === null || value === undefined ? "refused" : sig(value));
  const left = (r) => ((r.rms_before_nT ?? r.rms_after_nT ?? null) === null ? "" : `${told(r.rms_before_nT)} → ${told(r.rms_after_nT)}`);
  return [model.history.length ? table("Steps, the oldest first", ["when", "who", "", "", "residual, nT", "why"], model.history.map((s) => [time(s.t), s.who, s.action, s.spec, left(s.result), s.result.because ?? ""]))
                               : make("p", {}, "No steps yet."),
          model.masked.length ? table("Masked poses", ["pose", "why", "who", ""], model.masked.map((m) => [m.pose, m.because, m.who, make("button", { onclick: () => unmask(m.pose) }, "Take in again")])) : null,
          model.formulas.length ? table("Formulas", ["", "", ""], model.formulas.map((f) => [f.name, f.spec, f.exploratory ? "exploratory" : "confirmed on a second run"])) : null];
}

/** How much alike the signatures of every two effects are on these poses. */
export class ConfusionMap {
  #canvas; #data; #say; #order; #cell = 0; #left = 190; #top = 8;
  constructor(confusion, words, ask) {
    this.#data = confusion;
    this.#order = confusion.effects.map((_, i) => i);
    this.#canvas = make("canvas", { class: "confusion", role: "img", "aria-label": words?.good ?? "" });
    this.#say = make("p", { class: "caption", "aria-live": "polite" });
    this.elements = [make("h3", {}, words?.title ?? ""), this.#canvas, this.#say, words ? make("p", { class: "good-one" }, `Good: ${words.good}`) : null];
    this.#canvas.addEventListener("pointermove", (event) => this.#hover(event));
    new ResizeObserver(() => requestAnimationFrame(() => this.draw())).observe(this.#canvas);
    this.#canvas.addEventListener("click", (event) => { const pair = this.#pair(event); if (pair && pair[0] !== pair[1]) ask(...pair.map((i) => confusion.effects[i])); });
  }
  #alike(i, j) { const c = this.#data.correlation; return Math.max(c[i][j], c[j][i]); }
  #pair(event) {
    const n = this.#order.length, j = Math.floor((event.offsetX - this.#left) / this.#cell), i = Math.floor((event.offsetY - this.#top) / this.#cell);
    return i >= 0 && j >= 0 && i < n && j < n ? [this.#order[i], this.#order[j]] : null;
  }
  #hover(event) {
    const pair = this.#pair(event);
    if (!pair) { this.#say.textContent = ""; return; }
    const [i, j] = pair, { effects, where, p_right } = this.#data;
    this.#say.textContent = i === j ? `${effects[i]} ${where[i]}` : `${effects[i]} ${where[i]} and ${effects[j]}: correlation ${sig(this.#alike(i, j), 4)}, right name ${sig(Math.min(p_right[i][j], p_right[j][i]))}. A click asks what would tell them apart.`;
  }
  draw() {
    const n = this.#order.length, canvas = this.#canvas, scale = devicePixelRatio || 1, width = canvas.clientWidth;
    if (width === 0) return;
    const g = canvas.getContext("2d"), size = parseFloat(css("--small")), font = `${size}px 'DejaVu Sans', sans-serif`;
    const room = (left) => Math.min(18, Math.floor((width - left - 8) / n));
    g.font = font;
    this.#left = 14 + Math.ceil(Math.max(...this.#data.effects.map((name) => g.measureText(name).width)));
    const named = room(this.#left) >= size;  // else there is no room for a name at each row
    if (!named) this.#left = 8;
    this.#cell = Math.max(5, room(this.#left));
    const height = this.#top * 2 + n * this.#cell;
    canvas.style.height = `${height}px`;
    canvas.width = width * scale;
    canvas.height = height * scale;
    g.scale(scale, scale);
    g.font = font;
    g.textAlign = "right"; g.textBaseline = "middle";
    this.#order.forEach((i, row) => {
      g.fillStyle = css("--ink");
      if (named) g.fillText(this.#data.effects[i], this.#left - 6, this.#top + (row + 0.5) * this.#cell);
      this.#order.forEach((j, column) => {
        const x = this.#left + column * this.#cell, y = this.#top + row * this.#cell, alike = this.#alike(i, j);
        g.fillStyle = css("--line"); g.globalAlpha = 0.35; g.fillRect(x, y, this.#cell - 1, this.#cell - 1);
        g.fillStyle = css("--trace"); g.globalAlpha = alike ** 2; g.fillRect(x, y, this.#cell - 1, this.#cell - 1);
        g.globalAlpha = 1;
        if (i !== j && alike > 0.95) { g.strokeStyle = css("--named"); g.lineWidth = 2; g.strokeRect(x + 1, y + 1, this.#cell - 3, this.#cell - 3); }
      });
    });
  }
}

/** A formula of one's own: examined on every pause, kept when asked. */
export class FormulaForm {
  #ask; #on; #timer = null; #number = 0; #panel = null; #said = make("div", { id: "formula-said" });
  /** `ask(args, tried)` gives what mgt define says. */
  constructor(ask, on) { this.#ask = ask; this.#on = on; }
  elements(columns) {
    const field = (name, label, more = {}) => make("label", {}, label, make("input", { name, autocomplete: "off", spellcheck: "false", oninput: () => this.#soon(), ...more }));
    const choice = (name, label, options) => make("label", {}, label, make("select", { name, onchange: () => this.#soon() }, options.map((o) => make("option", { value: o }, o || "default"))));
    this.form = make("form", { id: "formula-form", onsubmit: (event) => { event.preventDefault(); this.#keep(); } },
      field("formula", "The term of one axis", { class: "long", placeholder: "k*lamp_A", list: "formula-names", required: true }), field("name", "called", { value: "mine", required: true }),
      choice("level", "level", ["axis", "platform", "site", "gradient"]), choice("scale", "one coefficient for", ["", "all", "each-sensor", "each-axis"]), field("unit", "unit", { placeholder: "nT" }),
      make("datalist", { id: "formula-names" }, columns.map((c) => make("option", { value: c }))), make("button", { id: "formula-keep" }, "Keep it"));
    return [make("p", { class: "caption" }, "Names of this run: ", make("code", {}, columns.join("  ")), "; u ux uy uz (axis), b bx by bz gx gy gz (platform), px py pz (site); k, k1, k2 are coefficients. mgt define --help tells more."),
            this.form, this.#said];
  }
  #args() {
    const read = (name) => this.form.elements[name].value.trim();
    return { name: read("name"), formula: read("formula"), level: read("level"), ...(read("unit") ? { unit: read("unit") } : {}), ...(read("scale") ? { scale: read("scale") } : {}) };
  }
  #soon() {
    clearTimeout(this.#timer);
    this.#timer = setTimeout(() => this.#try(), 700);
  }
  async #try() {
    const args = this.#args(), number = ++this.#number;
    if (!args.formula || !args.name) return;
    try {
      const said = await this.#ask(args, true);
      if (number === this.#number) this.#show(said);
    } catch (error) {
      if (number === this.#number && !error.cancelled) fill(this.#said, make("p", { class: "bad" }, error.message, error.remedy ? `: ${error.remedy}` : ""));
    }
  }
  #show(said) {
    const canvas = make("canvas", { class: "panel", role: "img", "aria-label": "what the formula makes of each pose, and what is left there" });
    fill(this.#said, said.signature.pose.length ? make("figure", {}, canvas) : null, make("pre", {}, said.text));
    this.#panel = null;
    if (!said.signature.pose.length) return;
    this.#panel = new Panel(canvas, this.#on);
    const { pose, x, y } = said.signature;
    this.#panel.show({ poses: pose, x: { label: "made of the pose by the formula, noise = 1", values: x }, y: { label: "left there, noise = 1", also: [[0]] }, series: [{ name: said.name, values: y, shape: 0 }] });
    this.#on.hover(undefined);
  }
  async #keep() {
    clearTimeout(this.#timer);
    ++this.#number;
    const said = await this.#ask(this.#args(), false).catch((error) => { fill(this.#said, make("p", { class: "bad" }, error.message, error.remedy ? `: ${error.remedy}` : "")); return null; });
    if (said) this.#show(said);
  }
  draw(state) { return this.#panel?.draw(state) ?? false; }
  stale() { this.#panel?.stale(); }
}
