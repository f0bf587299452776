// SPDX-License-Identifier: Apache-2.0
// The workbench: one run, what its model leaves, what could be missing, and what adding it does. Every number and every
// sentence about statistics is an answer of mgt; its command stands below.
import { by, fill, make } from "./elements.js";
import { sig } from "./numbers.js";
import { measuredLine, measuredPanelsOf } from "./measured.js";
import { Panels, panelsOf, poseLine } from "./panels.js";
import { Evidence, number, showChange, showFall, showCandidates } from "./candidates.js";
import { showLaws } from "./law.js";
import { ConfusionMap, FormulaForm, showHistory, showLimits, showNext, showParameters } from "./tools.js";

const kLong = 3000;  // poses: a search takes up to a minute
const kTools = { next: "What to measure next", formula: "Formula", law: "A law of no library", alike: "Told apart", limits: "Limits", parameters: "Parameters", history: "History" };
const kColour = { PASS: "good", EXPLAINED: "warn", AMBIGUOUS: "warn", PARTIAL: "warn", UNKNOWN: "bad", "BAD-DATA": "bad" };

export class Bench {
  #jobs; #say; #measure; #state = { pose: null, selected: new Set() }; #panels; #evidence; #formula; #map = null; #run = null; #channel = null; #chosen = null; #tool = "next"; #opened = 0;
  #answers = {};  // of mgt on this run, by verb; measured: what compare says where the fit is refused
  #refusals = {};
  #commands = {};

  /** `measure(step)`: null without a rig. */
  constructor(jobs, say, measure) {
    this.#measure = measure;
    this.#jobs = jobs;
    this.#say = say;
    const on = { hover: (pose) => this.#hover(pose), select: (poses, more) => this.#select(poses, more) };
    this.#panels = new Panels(by("panels"), this.#state, on);
    this.#evidence = new Evidence(on);
    this.#formula = new FormulaForm((args, tried) => this.#define(args, tried), on);
    for (const [id, label] of Object.entries(kTools))
      by("tool-tabs").append(make("button", { id: `tool-${id}`, onclick: () => this.#show(id) }, label));
    by("bench-fit").addEventListener("click", () => this.#panels.fit());
    by("bench-runs").addEventListener("click", () => this.close());
    by("bench-report").addEventListener("click", () => this.#report());
    by("mask").addEventListener("submit", (event) => { event.preventDefault(); this.#mask(); });
    by("clear").addEventListener("click", () => this.#select([], false));
    by("channel").addEventListener("change", (event) => { this.#channel = event.target.value || null; this.#drawPanels(false); });
    document.addEventListener("keydown", (event) => this.#key(event));
  }
  get open() { return this.#run !== null; }

  // The list of runs.
  async list(only = null) {
    const runs = await this.#jobs.runs();
    if (runs.some((r) => r.poses === null && r.kind === "run")) setTimeout(() => { if (!this.open) this.list(); }, 1500);
    const size = (bytes) => (bytes > 1e6 ? `${(bytes / 1e6).toFixed(1)} MB` : `${(bytes / 1e3).toFixed(0)} kB`);
    const row = (r) => make("tr", {}, make("td", {}, make("button", { class: "run", "data-run": r.name, onclick: () => this.start(r) }, r.name)),
      make("td", {}, r.kind === "run" ? r.rig : "pose table"), make("td", { class: "number" }, r.poses ?? ""), make("td", { class: "number" }, size(r.bytes)),
      make("td", {}, r.changed.slice(0, 19).replace("T", " ") + "Z"), make("td", {}, r.state));
    fill(by("run-list"), make("caption", {}, runs.length ? "Runs and pose tables, the newest first" : "There are no runs here yet: a run of the rig makes one, mgt import another."),
         make("thead", {}, make("tr", {}, ["", "rig", "poses", "size", "changed", "state"].map((h) => make("th", { scope: "col" }, h)))), make("tbody", {}, runs.map(row)));
    if (only) { const one = runs.find((r) => r.name === only); if (one) this.start(one); }
  }
  close() {
    this.#jobs.cancelAll();
    this.#run = null;
    ++this.#opened;
    by("bench-list").hidden = false;
    by("bench-run").hidden = true;
    this.list();
  }
  start(run) {
    this.#run = run;
    this.#channel = this.#chosen = null;
    this.#answers = {};
    this.#refusals = {};
    this.#commands = {};
    fill(by("commands"));
    this.#say("");
    this.#map = null;
    this.#state.selected.clear();
    this.#state.pose = null;
    by("bench-list").hidden = true;
    by("bench-run").hidden = false;
    by("run-name").textContent = run.name;
    for (const id of ["fall-card", "candidates", "evidence", "change", "tool", "pose"]) fill(by(id));
    by("change-card").hidden = by("evidence-card").hidden = true;
    this.#panels.clear();
    this.#select([], false);
    const table = run.kind === "table";
    by("bench-import").hidden = !table;
    by("bench-import").onclick = () => this.#import();
    by("mask").hidden = table;
    fill(by("verdict"), make("p", { class: "caption" }, "being computed"));
    this.#load(false);
  }

  #tellCommand(verb, command) {
    this.#commands[verb] = command;
    fill(by("commands"), Object.values(this.#commands).map((c) => make("code", {}, c)));
  }
  /** An answer of mgt about the run; nothing where it was refused, which is said. */
  async #ask(verb, args = {}, quiet = false) {
    const opened = this.#opened;
    try {
      const { answer, command } = await this.#jobs.ask(verb, this.#run.name, args);
      if (opened !== this.#opened) throw { cancelled: true };
      this.#tellCommand(verb, command);
      return answer;
    } catch (error) {
      if (quiet) throw error;
      if (opened !== this.#opened || error.cancelled) return null;
      if (error.command) this.#tellCommand(verb, error.command);
      const said = this.#refusals[verb] = `${error.message}${error.remedy ? `: ${error.remedy}` : ""}`;
      if (verb === "compare" && error.beside?.poses) this.#answers.measured = error.beside;
      if (verb === "compare" || verb === "explain") fill(by("verdict"), make("p", { class: "bad", id: "refusal" }, said));
      else if (verb !== "fit") this.#say(said);  // that of a fit is said when that of compare is known
      return null;
    }
  }

  /** Everything about the run as it is now. `keep`: the same run with another model. */
  async #load(keep) {
    const opened = ++this.#opened;
    delete this.#answers.discover;
    delete this.#answers.measured;
    this.#refusals = {};
    by("bench-run").classList.toggle("veiled", keep);
    delete by("bench-run").dataset.shown;
    const long = (this.#run.poses ?? 0) > kLong && !keep;
    // In the order in which they are begun, one or two at a time; each part is shown when it is there.
    const part = async (promise, verb, show) => {
      const answer = await promise;
      if (opened !== this.#opened) return;
      this.#answers[verb] = answer;
      show(answer);
    };
    const panels = part(this.#ask("compare"), "compare", (answer) => {
      by("bench-run").classList.toggle("refused", Boolean(this.#answers.measured));
      if (answer || this.#answers.measured) { this.#channels(); this.#drawPanels(answer ? keep : false); }
      if (answer) by("bench-run").classList.remove("veiled");
    });
    const search = long ? null : part(this.#ask("explain"), "explain", (answer) => { if (answer) this.#drawSearch(); });
    const fit = part(this.#ask("fit"), "fit", () => {}), model = part(this.#run.kind === "run" ? this.#ask("model") : null, "model", () => {});
    await Promise.all([panels, fit, model]);
    if (opened !== this.#opened) return;
    if (this.#refusals.fit && this.#refusals.fit !== this.#refusals.compare) this.#say(this.#refusals.fit);
    this.#drawFall();
    if (long) this.#offerSearch();
    await search;
    if (opened !== this.#opened) return;
    by("bench-run").classList.remove("veiled");
    this.#show(this.#tool);
    by("bench-run").dataset.shown = String(opened);
  }
  #offerSearch() {
    fill(by("verdict"), make("p", {}, `The search for effects in ${this.#run.poses} poses may take a minute. `,
      make("button", { onclick: async () => { this.#answers.explain = await this.#ask("explain"); if (this.#answers.explain) this.#drawSearch(); } }, "Search all the same")));
  }

  #channels() {
    const { compare, measured } = this.#answers, names = Object.keys(compare?.poses.residual_nT ?? measured.poses.reading_nT);
    fill(by("channel"), make("option", { value: "" }, compare ? "the channel that depends most" : "the first"), names.map((n) => make("option", { value: n }, n)));
    by("channel").value = this.#channel ?? "";
  }
  #drawPanels(keep) {
    if (this.#answers.measured) {
      this.#panels.show(measuredPanelsOf(this.#answers.measured, this.#channel), false);
      return this.#redraw();
    }
    const list = panelsOf(this.#answers.compare, this.#channel);
    // The channel that was looked at stays the one that is looked at when the model changes.
    if (!this.#channel) this.#channel = list[0]?.judged && this.#run.kind === "run" ? list[0].judged : null;
    by("channel").value = this.#channel ?? "";
    this.#panels.show(this.#channel ? panelsOf(this.#answers.compare, this.#channel) : list, keep);
    this.#redraw();
  }
  #drawFall() {
    const { compare, model, fit } = this.#answers;
    if (!compare) {
      if (this.#answers.measured && model?.history.length)
        fill(by("fall-card"), make("h2", {}, "The model that is refused"), make("p", {}, model.model.join(", ") || "no effects"),
             make("p", { class: "row" }, make("button", { id: "undo", onclick: () => this.#undo() }, `Undo ${model.history.at(-1).action}`)));
      return;
    }
    fill(by("fall-card"), make("h2", {}, "What is left of the error"), showFall(model, compare, fit, (steps) => [
      steps.length ? make("button", { id: "undo", onclick: () => this.#undo() }, `Undo ${steps.at(-1).action}`) : null,
      model?.model.map((spec) => make("button", { class: "small", onclick: () => this.#change("drop", spec, {}) }, `Drop ${spec}`))].flat()));
  }
  #drawSearch() {
    const { explain } = this.#answers, words = (name) => explain.figures[name];
    const ratio = make("i", { class: "bar" }), times = explain.residual_nT / explain.noise_nT;
    ratio.style.width = `${Math.min(100, (100 * Math.log10(Math.max(1, times))) / 3)}%`;  // 1 to 1000
    fill(by("verdict"), make("p", {}, make("b", { class: `word ${kColour[explain.verdict] ?? ""}`, "data-key": "verdict" }, explain.verdict),
                             " residual ", number(explain.residual_nT, "residual_nT"), " nT, noise ", number(explain.noise_nT, "noise_nT"), " nT: ",
                             make("b", {}, `${sig(times, 3)} times`), make("span", { class: "track ratio", title: "1 to 1000 times the noise, lines at 10 and 100" }, ratio)),
         make("p", { "data-key": "text" }, explain.text), explain.law?.instead_of?.length ? make("p", { "data-key": "law" }, explain.law.text.split("\n")[0]) : null, explain.notes.filter((n) => !explain.text.includes(n.slice(0, 60))).map((n) => make("p", { class: "caption" }, n)),
         (explain.chosen_in_doubt ?? []).map((d) => make("p", { class: "warn" }, d.text ?? `${d.spec}: ${d.alternatives?.join(", ") ?? ""}`)));
    this.#drawCandidates();
    this.#map = null;
    if (explain.confusion && explain.confusion.effects.length > 1)
      this.#map = new ConfusionMap(explain.confusion, words("confusion"), (a, b) => this.#settle(a, b));
  }
  #drawCandidates() {
    const { explain } = this.#answers;
    fill(by("candidates"), make("h2", {}, "What could be missing"), showCandidates(explain, explain.figures.candidates, this.#chosen, (c) => this.#choose(c)));
  }

  async #choose(candidate) {
    this.#chosen = candidate.spec;
    this.#drawCandidates();
    by("evidence-card").hidden = false;
    fill(by("evidence"), make("p", { class: "caption" }, `the evidence for ${candidate.effect} is being computed`));
    const why = await this.#ask("why", { effect: candidate.effect, at: candidate.where });
    if (!why || this.#chosen !== candidate.spec) return;
    const spec = candidate.spec;
    fill(by("evidence"), this.#evidence.show(why, [
      make("button", { id: "try", onclick: () => this.#change("add", spec, { try: true }) }, "Try it"),
      this.#run.kind === "run" ? make("button", { id: "add", class: "main", onclick: () => this.#change("add", spec, {}) }, `Add ${spec}`) : null]));
    this.#redraw();
    by("evidence-card").scrollIntoView({ block: "nearest" });
  }
  async #change(verb, effect, more) {
    const change = await this.#ask(verb, { effect, ...more });
    if (!change) return;
    const buttons = [];
    if (!change.kept && !more.force && change.vetoed && this.#run.kind === "run" && !more.try)
      buttons.push(make("button", { id: "force", onclick: () => { if (confirm("Keep it although these poses speak against it?")) this.#change(verb, effect, { force: true }); } }, "Keep it all the same"));
    if (change.tried && !change.vetoed && this.#run.kind === "run") buttons.push(make("button", { onclick: () => this.#change(verb, effect, {}) }, "Keep it"));
    by("change-card").hidden = false;
    fill(by("change"), showChange(change, buttons));
    by("change").dataset.effect = change.spec;
    if (!change.kept) return;
    this.#chosen = null;
    by("evidence-card").hidden = true;
    this.#load(true);
  }
  async #undo() {
    if (!(await this.#ask("undo"))) return;
    by("change-card").hidden = true;
    this.#load(true);
  }
  async #mask() {
    const why = by("mask-why").value.trim();
    if (!why || this.#state.selected.size === 0) return;
    if (!(await this.#ask("mask", { poses: [...this.#state.selected], why }))) return;
    by("mask-why").value = "";
    this.#select([], false);
    this.#load(true);
  }
  async #define(args, tried) {
    const said = await this.#ask("define", tried ? { ...args, try: true } : args, true);
    if (!tried) this.#load(true);
    return said;
  }
  async #import() {
    const made = await this.#ask("import");
    if (!made) return;
    const runs = await this.#jobs.runs(), name = this.#run.name.replace(/\.csv$/, ".mgtrun");
    const run = runs.find((r) => r.name === name);
    if (run) this.start(run);
  }
  async #settle(a, b) {
    const next = await this.#ask("next", { effect: a, rival: b });
    if (!next) return;
    this.#answers.next = next;
    this.#show("next");
  }
  async #report() {
    try {
      const { answer } = await this.#jobs.ask("report", this.#run.name, {}, true);
      const link = make("a", { href: URL.createObjectURL(new Blob([answer.slice(0, answer.lastIndexOf("</html>") + 7)], { type: "text/html" })), download: this.#run.name.replace(/\.[^.]*$/, ".html") });
      link.click();
      URL.revokeObjectURL(link.href);
    } catch (error) { this.#say(`${error.message}${error.remedy ? `: ${error.remedy}` : ""}`); }
  }

  async #show(id) {
    this.#tool = id;
    for (const other of Object.keys(kTools)) by(`tool-${other}`).setAttribute("aria-pressed", String(other === id));
    const { explain, fit, model, compare } = this.#answers, words = (name) => explain?.figures[name];
    const wait = (verb) => [make("p", { class: "caption" }, this.#refusals[verb] ?? "not computed yet")];
    if (this.#answers.measured && id !== "history") return fill(by("tool"), wait("compare"));
    if (id === "formula") return void fill(by("tool"), compare ? this.#formula.elements(this.#names(compare)) : wait("compare"));
    if (id === "law") return this.#showLaw();
    if (id === "alike") { fill(by("tool"), this.#map?.elements ?? wait("explain")); return this.#map?.draw(); }
    if (id === "limits") return fill(by("tool"), explain ? showLimits(explain, words("detectable")) : wait("explain"));
    if (id === "parameters") return fill(by("tool"), fit ? showParameters(fit) : wait("fit"));
    if (id === "history") return fill(by("tool"), showHistory(model, async (pose) => { if (await this.#ask("unmask", { poses: [pose] })) this.#load(true); }));
    const known = this.#answers.next;
    if (known) return fill(by("tool"), showNext(known, this.#measure()));
    fill(by("tool"), make("p", {}, make("button", { id: "ask-next", onclick: async () => { const next = await this.#ask("next"); if (next) { this.#answers.next = next; this.#show("next"); } } },
      "Which measurement would settle it?")));
  }
  #showLaw() {
    const found = this.#answers.discover;
    if (found) return fill(by("tool"), showLaws(found, this.#run.kind === "run" ? () => this.#keepLaw(found) : null));
    fill(by("tool"), make("p", {}, "Tries every formula of a fixed grammar on every axis, sensor and the array, and says which one the readings follow, and how sure that is. "),
      make("button", { id: "ask-law", onclick: async () => { const discover = await this.#ask("discover"); if (discover) { this.#answers.discover = discover; this.#show("law"); } } }, "Look for its formula"));
  }
  /** Each effect of the leading formula is defined, then added: the page's step is the terminal's. */
  async #keepLaw(found) {
    for (const { name, level, scale, unit, formula } of found.laws.flatMap((law) => law.formulas[0].define)) {
      if (!(await this.#ask("define", { name, formula, level, unit, ...(scale ? { scale } : {}) }))) return;
      await this.#change("add", name, {});
    }
  }
  #names(compare) {
    const p = compare.poses, has = (list) => list?.some((v) => v !== null);
    return [...Object.keys(p.columns), "t_h", ...["azimuth_deg", "pitch_deg", "roll_deg"].filter((c) => has(p[c])), ...Object.keys(p.T_degC ?? {}).filter((s) => has(p.T_degC[s])).map((s) => `${s}_T_degC`),
            ...(has(p.T_degC?.s1) ? ["T_degC"] : [])];
  }

  #hover(pose) {
    if (pose !== undefined && pose !== this.#state.pose) {
      this.#state.pose = pose;
      const { compare, measured } = this.#answers;
      by("pose").textContent = pose === null ? "" : compare ? poseLine(compare, pose) : measured ? measuredLine(measured, pose) : "";
    }
    this.#redraw();
  }
  #select(poses, more) {
    const { selected } = this.#state;
    if (!more) selected.clear();
    for (const pose of poses) more && poses.length === 1 && selected.has(pose) ? selected.delete(pose) : selected.add(pose);
    const list = [...selected].sort((a, b) => a - b);
    by("selected").textContent = list.length ? `${list.length} selected: ${list.slice(0, 12).join(", ")}${list.length > 12 ? ", ..." : ""}` : "Click poses, or draw a frame around them, to select them.";
    by("mask-button").disabled = list.length === 0;
    by("clear").hidden = list.length === 0;
    this.#redraw();
  }
  #redraw(colours = false) {
    this.#panels.redraw(colours);
    if (colours) { this.#evidence.stale(); this.#formula.stale(); if (this.#tool === "alike") this.#map?.draw(); if (this.#tool === "law" && this.#answers.discover) this.#showLaw(); }
    requestAnimationFrame(() => { this.#evidence.draw(this.#state); this.#formula.draw(this.#state); });
  }
  /** After another theme. */
  recolour() { this.#redraw(true); }

  #key(event) {
    if (!this.open || by("workbench").hidden || event.ctrlKey || event.metaKey || event.altKey || /^(INPUT|SELECT|TEXTAREA)$/.test(event.target.tagName)) return;
    const poses = (this.#answers.compare ?? this.#answers.measured)?.poses.pose;
    if ((event.key === "[" || event.key === "]") && poses) {
      const at = poses.indexOf(this.#state.pose), step = event.key === "]" ? 1 : -1;
      this.#hover(poses[at < 0 ? 0 : (at + step + poses.length) % poses.length]);
    } else if (event.key === "Enter" && event.target === document.body && this.#state.pose !== null) this.#select([this.#state.pose], true);
    else if (event.key === "m" && !by("mask").hidden) { by("mask-why").focus(); event.preventDefault(); }
    else if (event.key === "u") { if (by("undo") && confirm("Take the last step back?")) this.#undo(); }
    else if (event.key === "Escape") this.#select([], false);
  }
}
