// SPDX-License-Identifier: Apache-2.0
// Computations on runs: commands of mgt that the server starts, asked about until they end.

const kFirst_ms = 40, kMost_ms = 400, kShare = 0.06;  // of the time that has passed: an answer is seen a few per cent late
/** Milliseconds until a job is asked about again: seldom while it waits for others, and the less often the more are alive. */
const next_ms = (waits, passed_ms, alive) => Math.min(kMost_ms, Math.max((waits ? 4 : 1) * kFirst_ms * alive, kShare * passed_ms));
const pause = (ms) => new Promise((resolve) => setTimeout(resolve, ms));

export class Jobs {
  #token; #tell; #alive = new Map();
  /** `tell(list)`: what is under way, whenever that changes: [{id, command, state, before, elapsed_s, said}]. */
  constructor(token, tell) {
    this.#token = token;
    this.#tell = tell;
    addEventListener("pagehide", () => { for (const id of this.#alive.keys()) this.#send("DELETE", `/jobs/${id}`, null, true).catch(() => {}); });
  }
  get possible() { return this.#token !== null; }

  async #send(method, path, body = null, keepalive = false) {
    for (;;) {
      const answer = await fetch(path, { method, body, keepalive, headers: { Authorization: `Bearer ${this.#token}` } });
      if (answer.status === 429 && answer.headers.has("Retry-After")) { await pause(kMost_ms); continue; }
      if (answer.ok) return answer;
      const { error } = await answer.json().catch(() => ({ error: { message: `HTTP ${answer.status}`, remedy: "" } }));
      throw error;
    }
  }
  async runs() { return (await (await fetch("/runs")).json()).runs; }

  /** {answer, exit_code, command}; fails with {message, remedy}, where the job was ended with {cancelled: true} beside it, where
      mgt refused with what it says all the same in `beside`.
      `text`: the answer is no JSON. */
  async ask(verb, run, args = {}, text = false) {
    if (!this.possible) throw { message: "this page may look and not compute", remedy: "open the address that mgt serve or mgt console prints" };
    const { job: id } = await (await this.#send("POST", "/jobs", JSON.stringify({ verb, run, args }))).json();
    for (const began = performance.now(); ; ) {
      const job = await (await this.#send("GET", `/jobs/${id}`)).json().catch((error) => { this.#alive.delete(id); throw error; });
      const over = job.state !== "waiting" && job.state !== "running";
      over ? this.#alive.delete(id) : this.#alive.set(id, { id, ...job });
      this.#tell([...this.#alive.values()]);
      if (job.state === "cancelled") throw { message: `ended: ${job.command}`, remedy: "", cancelled: true };
      if (job.state === "failed") throw { message: `${job.command}: ${job.why}`, remedy: "leave poses out, or take fewer effects" };
      if (over) {
        const answer = await this.#send("GET", `/jobs/${id}/result`);
        if (text) return { answer: await answer.text(), exit_code: job.exit_code, command: job.command };
        const result = await answer.json();
        if (result.error) throw { ...result.error, command: job.command, beside: result };
        return { answer: result, exit_code: job.exit_code, command: job.command };
      }
      await pause(next_ms(job.state === "waiting", performance.now() - began, this.#alive.size));
    }
  }
  cancel(id) { return this.#send("DELETE", `/jobs/${id}`).catch(() => {}); }
  cancelAll() { for (const id of this.#alive.keys()) this.cancel(id); }
}
