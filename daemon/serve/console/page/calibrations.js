// SPDX-License-Identifier: Apache-2.0
// The calibrations of the rig, and what a person decides about them: accept, reject, roll back.
import { by, fill, make, rows } from "./elements.js";
import { decisionTable, historyFigure } from "./history.js";
import { askReason } from "./reason.js";

export class Calibrations {
  #control; #say; #changed; #list = [];
  /** `say(error)` shows what was refused, null clears it; `changed()` is called when the list was read. */
  constructor(control, say, changed) { this.#control = control; this.#say = say; this.#changed = changed; }

  /** What the list says of one of them; undefined where it is not known. */
  of(id) { return this.#list.find((c) => c.id === id); }

  async refresh() {
    if (!this.#control.possible) {
      fill(by("calibration-list"), make("caption", {}, "The list needs the token: open the address that mgt console prints"));
      return;
    }
    const answer = await this.#do("calibrations.list");
    if (!answer) return;
    this.#list = answer.calibrations.reverse();
    fill(by("calibration-list"), make("caption", {}, this.#list.length ? "Calibrations, newest first" : "No calibration yet: a run proposes one"),
         rows(["id", "state", "since", "by", "from", "because", ""],
              this.#list.map((c) => [c.id, c.state + (c.forced ? ", forced" : ""), `${c.since.slice(0, 19)}Z`, c.by || "not recorded", c.origin, c.why, make("span", {}, this.buttons(c.id))])));
    this.#changed();
    const history = await this.#do("calibrations.history");
    if (!history) return;
    fill(by("calibration-history"), historyFigure(history), history.decisions.length ? decisionTable(history.decisions) : null,
         history.unreadable.length ? make("p", { class: "warn" }, `The files of these cannot be read: ${history.unreadable.join(", ")}`) : null);
  }
  /** What can be decided about one. */
  buttons(id) {
    const state = this.of(id)?.state, button = (text, act) => make("button", { disabled: !this.#control.possible, onclick: act }, text);
    return [state === "active" ? null : button("Accept", () => this.accept(id)), " ",
            state === "proposed" ? button("Reject", () => this.reject(id)) : null];
  }
  /** One that failed its checks, or was rejected, takes a reason. */
  async accept(id) {
    try {
      await this.#control.ask("calibrations.accept", { id });
      this.#say(null);
    } catch (error) {
      if (error.code !== "refused" || !this.of(id)) return this.#say(error);
      const why = await askReason(`Accept calibration ${id} all the same?`, `${error.message}. Every sample names the calibration it used, and says so where it failed its checks.`, "Accept by force");
      if (why && !(await this.#do("calibrations.accept", { id, force: true, why }))) return;
    }
    await this.refresh();
  }
  async reject(id) {
    const why = await askReason(`Reject calibration ${id}?`, "It stays on disk and in the list, with the reason. What is in use does not change.", "Reject");
    if (why && (await this.#do("calibrations.reject", { id, why }))) await this.refresh();
  }
  async rollback() {
    if (await this.#do("calibrations.rollback")) await this.refresh();
  }
  async #do(cmd, args = {}) {
    try {
      const result = await this.#control.ask(cmd, args);
      this.#say(null);
      return result;
    } catch (error) {
      this.#say(error);
      return null;
    }
  }
}
