// SPDX-License-Identifier: Apache-2.0
// Two WebSockets: the stream, which anyone may read, and control, which needs the token.

const here = (path) => `ws://${location.host}${path}`;
const kStale_ms = 3000;

/** Calls on.message(object) for every line; on.state("live" | "stale" | "gone", sinceDate). Reconnects by itself, and asks
    for what it missed: a sample is never lost between two connections. */
export function openStream(on) {
  let last = null, lastSeq = null, wait_ms = 500, state = "";
  const tell = (now) => { if (now !== state) { state = now; on.state(now, last); } };
  const heard = () => { last = new Date(); tell("live"); };
  function connect() {
    const socket = new WebSocket(here("/stream"));
    socket.onopen = () => { wait_ms = 500; };
    socket.onmessage = (event) => {
      heard();
      for (const line of event.data.split("\n")) {
        if (!line) continue;
        const message = JSON.parse(line);
        if (message.class === "HELLO")
          socket.send(JSON.stringify({ watch: { class: ["TENSOR", "STATUS", "RUN", "SENSORS"], rate_hz: null,
                                                from_seq: lastSeq === null ? null : lastSeq + 1 } }));
        if (message.class === "TENSOR") lastSeq = message.seq;
        if (message.class === "GAP") lastSeq = message.to_seq;
        if (message.class === "ERROR") lastSeq = null;
        on.message(message);
      }
    };
    socket.onclose = () => { tell("gone"); setTimeout(connect, wait_ms); wait_ms = Math.min(8000, 2 * wait_ms); };
  }
  setInterval(() => { if (state === "live" && new Date() - last > kStale_ms) tell("stale"); }, 500);
  connect();
}

/** The token of the address bar moves into this tab's memory: a fragment is in no log, and is gone from the bar. */
export function takeToken() {
  const found = /^#token=([0-9a-f]+)$/.exec(location.hash);
  if (found) {
    sessionStorage.setItem("token", found[1]);
    history.replaceState(null, "", location.pathname);
  }
  return sessionStorage.getItem("token");
}

/** Control requests over one connection, answered in their order. ask(cmd, args) is a promise of the result; it fails
    with {message, remedy}. */
export class Control {
  #token; #socket = null; #waiting = new Map(); #next = 1;
  ended = () => {};  ///< the connection is gone, and with it what was held
  constructor(token) { this.#token = token; }
  get possible() { return this.#token !== null; }
  async ask(cmd, args = {}) {
    if (!this.possible)
      throw { message: "this page may look and not control", remedy: "open the address that mgt console prints" };
    const socket = await this.#connected();
    const id = this.#next++;
    return new Promise((resolve, reject) => {
      this.#waiting.set(id, { resolve, reject });
      socket.send(JSON.stringify({ cmd, args, id }));
    });
  }
  #connected() {
    if (this.#socket) return this.#socket;
    this.#socket = new Promise((resolve, reject) => {
      const socket = new WebSocket(here("/control"));
      socket.onopen = () => { socket.send(JSON.stringify({ token: this.#token })); resolve(socket); };
      socket.onmessage = (event) => {
        for (const line of event.data.split("\n")) if (line) this.#answered(JSON.parse(line));
      };
      socket.onclose = () => {
        const why = { message: "the connection for control ended", remedy: "say it again" };
        reject(why);
        for (const { reject: fail } of this.#waiting.values()) fail(why);
        this.#waiting.clear();
        this.#socket = null;
        this.ended();
      };
    });
    return this.#socket;
  }
  #answered(reply) {
    const waiting = reply.id === null ? [...this.#waiting.values()] : [this.#waiting.get(reply.id)];
    if (reply.id === null) this.#waiting.clear(); else this.#waiting.delete(reply.id);
    for (const one of waiting) if (one) reply.ok ? one.resolve(reply.result) : one.reject(reply.error);
  }
}
