// SPDX-License-Identifier: Apache-2.0
// Drives Debian's Chromium over its DevTools protocol: a page, what it shows, clicks and pictures. The messages go over two
// pipes of the child, JSON with a zero byte behind each; so Debian 12's node (18) is enough, and no package from elsewhere.
import { spawn, spawnSync } from "node:child_process";
import { mkdtempSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";

const pause = (ms) => new Promise((resolve) => setTimeout(resolve, ms));

/** Polls until `ask` gives something true; what it gave. The limit is for what never happens: no test is about time. */
export async function until(ask, what, limit_ms = 300000) {
  for (const end = Date.now() + limit_ms; Date.now() < end; await pause(50)) {
    const found = await ask();
    if (found) return found;
  }
  throw new Error(`not within ${limit_ms / 1000} s: ${what}`);
}

/** Ends the script as not run (exit code 77) where there is no chromium. */
export function needBrowser() {
  if (!spawnSync("chromium", ["--version"]).error) return;
  console.log("not run: chromium is not installed (apt-get install chromium)");
  process.exit(77);
}

const kFlags = ["--headless=new", "--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run", "--disable-background-networking",
                "--disable-component-update", "--disable-sync", "--remote-debugging-pipe"];

export class Browser {
  #child; #folder; #rest = ""; #next = 1; #waiting = new Map(); #session = null;
  log = [];  ///< errors of the console and refusals of the content policy

  static async start() {
    const browser = new Browser();
    browser.#folder = mkdtempSync(join(tmpdir(), "mgtd-browser-"));
    // Chromium reads requests from descriptor 3 and writes answers to descriptor 4.
    browser.#child = spawn("chromium", [...kFlags, `--user-data-dir=${browser.#folder}`, "about:blank"], { stdio: ["ignore", "ignore", "ignore", "pipe", "pipe"] });
    browser.#child.stdio[4].setEncoding("utf8").on("data", (text) => browser.#received(text));
    browser.#child.stdio[3].on("error", () => {});  // what was lost is told by the exit
    browser.#child.once("exit", (code) => browser.#ended(`chromium ended with exit code ${code}`));
    const { targetId } = await browser.#call("Target.createTarget", { url: "about:blank" });
    browser.#session = (await browser.#call("Target.attachToTarget", { targetId, flatten: true })).sessionId;
    for (const domain of ["Page", "Runtime", "Log"]) await browser.#call(`${domain}.enable`);
    return browser;
  }
  #received(text) {
    const messages = (this.#rest + text).split("\0");
    this.#rest = messages.pop();
    for (const message of messages) this.#heard(JSON.parse(message));
  }
  #ended(why) {
    for (const { reject } of this.#waiting.values()) reject(new Error(why));
    this.#waiting.clear();
  }
  #heard(message) {
    if (message.method === "Log.entryAdded") this.log.push(`${message.params.entry.text} ${message.params.entry.url ?? ""}`.trim());
    if (message.method === "Runtime.exceptionThrown") this.log.push(message.params.exceptionDetails.exception?.description ?? "exception");
    if (message.method === "Page.javascriptDialogOpening") this.#call("Page.handleJavaScriptDialog", { accept: true });
    const waiting = this.#waiting.get(message.id);
    if (!waiting) return;
    this.#waiting.delete(message.id);
    message.error ? waiting.reject(new Error(message.error.message)) : waiting.resolve(message.result);
  }
  #call(method, params = {}) {
    const id = this.#next++;
    this.#child.stdio[3].write(`${JSON.stringify({ id, method, params, ...(this.#session ? { sessionId: this.#session } : {}) })}\0`);
    return new Promise((resolve, reject) => this.#waiting.set(id, { resolve, reject }));
  }
  /** `ready`: an expression that is true of the page when it is there. */
  async open(url, width = 1280, height = 800, ready = "document.body && 'ready' in document.body.dataset") {
    await this.size(width, height);
    await this.#call("Page.navigate", { url: "about:blank" });  // the same address with another fragment would load nothing
    await this.#call("Page.navigate", { url });
    await until(() => this.run(ready), `the page at ${url}`);
  }
  size(width, height) { return this.#call("Emulation.setDeviceMetricsOverride", { width, height, deviceScaleFactor: 1, mobile: width < 600 }); }
  scrollbars(shown) { return this.#call("Emulation.setScrollbarsHidden", { hidden: !shown }); }
  /** A script that runs in every page before its own do. */
  before(source) { return this.#call("Page.addScriptToEvaluateOnNewDocument", { source }); }
  async run(expression) {
    const { result, exceptionDetails } = await this.#call("Runtime.evaluate", { expression, awaitPromise: true, returnByValue: true });
    if (exceptionDetails) throw new Error(`${expression}: ${exceptionDetails.exception?.description ?? exceptionDetails.text}`);
    return result.value;
  }
  get pid() { return this.#child.pid; }
  text(id) { return this.run(`document.getElementById(${JSON.stringify(id)}).innerText`); }
  click(id) { return this.run(`document.getElementById(${JSON.stringify(id)}).click()`); }
  async picture(path, whole = true) {
    const { data } = await this.#call("Page.captureScreenshot", { captureBeyondViewport: whole });
    writeFileSync(path, Buffer.from(data, "base64"));
  }
  /** `media`: screen or print; `colours`: light or dark, as the system is set. */
  media(media, colours) {
    return this.#call("Emulation.setEmulatedMedia", { media, features: [{ name: "prefers-color-scheme", value: colours }] });
  }
  /** As it is printed, by its own style. */
  async print(path) {
    const { data } = await this.#call("Page.printToPDF", { preferCSSPageSize: true, printBackground: true });
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
