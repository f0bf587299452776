// SPDX-License-Identifier: Apache-2.0
// Drives Debian's Chromium over its DevTools protocol: a page, what it shows, clicks and pictures. Needs node >= 20 with
// --experimental-websocket (or 22) and chromium; no package from elsewhere.
import { spawn } from "node:child_process";
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";

const pause = (ms) => new Promise((resolve) => setTimeout(resolve, ms));

/** Polls until `ask` gives something true; what it gave. */
export async function until(ask, what, limit_ms = 30000) {
  for (const end = Date.now() + limit_ms; Date.now() < end; await pause(50)) {
    const found = await ask();
    if (found) return found;
  }
  throw new Error(`not within ${limit_ms / 1000} s: ${what}`);
}

export class Browser {
  #child; #folder; #socket; #next = 1; #waiting = new Map(); #session = null;
  log = [];  ///< errors of the console and refusals of the content policy

  static async start() {
    const browser = new Browser();
    browser.#folder = mkdtempSync(join(tmpdir(), "mgtd-browser-"));
    browser.#child = spawn("chromium", ["--headless=new", "--no-sandbox", "--disable-gpu", "--remote-debugging-port=0",
                                        `--user-data-dir=${browser.#folder}`, "about:blank"], { stdio: "ignore" });
    const portFile = join(browser.#folder, "DevToolsActivePort");
    const [port, path] = (await until(() => { try { return readFileSync(portFile, "utf8").split("\n"); } catch { return null; } }, "chromium"));
    browser.#socket = new WebSocket(`ws://127.0.0.1:${port}${path}`);
    await new Promise((resolve) => { browser.#socket.onopen = resolve; });
    browser.#socket.onmessage = (event) => browser.#heard(JSON.parse(event.data));
    const { targetId } = await browser.#call("Target.createTarget", { url: "about:blank" });
    browser.#session = (await browser.#call("Target.attachToTarget", { targetId, flatten: true })).sessionId;
    for (const domain of ["Page", "Runtime", "Log"]) await browser.#call(`${domain}.enable`);
    return browser;
  }
  #heard(message) {
    if (message.method === "Log.entryAdded") this.log.push(message.params.entry.text);
    if (message.method === "Runtime.exceptionThrown") this.log.push(message.params.exceptionDetails.exception?.description ?? "exception");
    if (message.method === "Page.javascriptDialogOpening") this.#call("Page.handleJavaScriptDialog", { accept: true });
    const waiting = this.#waiting.get(message.id);
    if (!waiting) return;
    this.#waiting.delete(message.id);
    message.error ? waiting.reject(new Error(message.error.message)) : waiting.resolve(message.result);
  }
  #call(method, params = {}) {
    const id = this.#next++;
    this.#socket.send(JSON.stringify({ id, method, params, ...(this.#session ? { sessionId: this.#session } : {}) }));
    return new Promise((resolve, reject) => this.#waiting.set(id, { resolve, reject }));
  }
  async open(url, width = 1280, height = 800) {
    await this.#call("Emulation.setDeviceMetricsOverride", { width, height, deviceScaleFactor: 1, mobile: width < 600 });
    await this.#call("Page.navigate", { url: "about:blank" });  // the same address with another fragment would load nothing
    await this.#call("Page.navigate", { url });
    await until(() => this.run("document.body && 'ready' in document.body.dataset"), `the page at ${url}`);
  }
  async run(expression) {
    const { result, exceptionDetails } = await this.#call("Runtime.evaluate", { expression, awaitPromise: true, returnByValue: true });
    if (exceptionDetails) throw new Error(`${expression}: ${exceptionDetails.exception?.description ?? exceptionDetails.text}`);
    return result.value;
  }
  text(id) { return this.run(`document.getElementById(${JSON.stringify(id)}).innerText`); }
  click(id) { return this.run(`document.getElementById(${JSON.stringify(id)}).click()`); }
  async picture(path, whole = true) {
    const { data } = await this.#call("Page.captureScreenshot", { captureBeyondViewport: whole });
    writeFileSync(path, Buffer.from(data, "base64"));
  }
  async close() {
    const ended = new Promise((resolve) => this.#child.once("exit", resolve));
    this.#child.kill();
    await ended;
    // Chromium's helpers may write for a moment longer than it lives; what they leave is the system's to clear.
    try { rmSync(this.#folder, { recursive: true, force: true, maxRetries: 5 }); } catch { /* left behind */ }
  }
}
