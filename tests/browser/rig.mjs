// SPDX-License-Identifier: Apache-2.0
// A simulated rig on serial ports and the real daemon on it, in a folder of their own, with the console on one address
// for as long as the rig lives, so that a browser finds a daemon that was started anew.
import { spawn, spawnSync } from "node:child_process";
import { existsSync, mkdtempSync, rmSync, writeFileSync } from "node:fs";
import { createServer } from "node:net";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { until } from "./browser.mjs";

/** A port of this computer that nobody listens on now. */
function freePort() {
  return new Promise((resolve) => {
    const server = createServer().listen(0, "127.0.0.1", () => {
      const { port } = server.address();
      server.close(() => resolve(port));
    });
  });
}

export class Rig {
  #bin; #folder; #words; #rig = null; #daemon = null; #said = "";

  /** `bin`: the folder of the programs; `speed`: how much faster time runs than on a real rig; `scenario`: of the rig, as text. */
  static async start(bin, speed, scenario = `[rig]\nname = "table6"\nparameters = "table6"\n`) {
    const rig = new Rig();
    rig.#bin = bin;
    rig.#folder = mkdtempSync(join(tmpdir(), "mgtd-rig-"));
    writeFileSync(join(rig.#folder, "scenario.toml"), scenario);
    rig.#words = ["--scenario", join(rig.#folder, "scenario.toml"), "--dir", join(rig.#folder, "ports"), "--speed-up", String(speed)];
    rig.#rig = spawn(join(bin, "mgt-rig"), ["run", ...rig.#words], { stdio: "ignore" });
    await until(() => existsSync(join(rig.#folder, "ports/ready")), "the ports of the rig");
    const config = spawnSync(join(bin, "mgt-rig"), ["config", ...rig.#words, "--state", rig.#folder, "--tcp", "127.0.0.1:0"], { encoding: "utf8" }).stdout;
    const listen = `[console]\nlisten = "127.0.0.1:`, at = config.indexOf(`${listen}0"`);
    if (at < 0) throw new Error(`the configuration has no console:\n${config}`);
    writeFileSync(join(rig.#folder, "mgtd.toml"), config.replace(`${listen}0"`, `${listen}${await freePort()}"`));
    return rig;
  }
  /** Until every device measures. */
  async startDaemon() {
    this.#said = "";
    this.#daemon = spawn(join(this.#bin, "mgtd"), ["--config", join(this.#folder, "mgtd.toml")], { stdio: ["ignore", "pipe", "pipe"] });
    for (const stream of [this.#daemon.stdout, this.#daemon.stderr]) stream.on("data", (bytes) => { this.#said += bytes; });
    await until(() => this.mgt("status", "--wait", "20").status === 0, "the daemon and its devices");
  }
  /** As a power failure: nothing is flushed, nobody is told. */
  async killDaemon(signal = "SIGKILL") {
    const ended = new Promise((resolve) => this.#daemon.once("exit", resolve));
    this.#daemon.kill(signal);
    await ended;
    this.#daemon = null;
  }
  mgt(...words) { return spawnSync(join(this.#bin, "mgt"), ["--socket", join(this.#folder, "control.sock"), ...words], { encoding: "utf8", maxBuffer: 1e8 }); }
  /** The same, where it has to succeed. */
  command(...words) {
    const done = this.mgt(...words);
    if (done.status !== 0) throw new Error(`mgt ${words.join(" ")}: ${done.error ?? done.stderr}`);
  }
  ask(...words) { return JSON.parse(this.mgt(...words, "--json").stdout); }
  fault(...words) {
    const done = spawnSync(join(this.#bin, "mgt-rig"), ["fault", join(this.#folder, "ports"), ...words], { encoding: "utf8" });
    if (done.status !== 0) throw new Error(`mgt-rig fault ${words.join(" ")}: ${done.stderr}`);
  }
  /** Holds a bar magnet beyond the sensor of that number; 0 takes it away. */
  magnet(arm) {
    const done = spawnSync(join(this.#bin, "mgt-rig"), ["magnet", join(this.#folder, "ports"), String(arm)], { encoding: "utf8" });
    if (done.status !== 0) throw new Error(`mgt-rig magnet ${arm}: ${done.stderr}`);
  }
  /** Of the daemon. */
  get pid() { return this.#daemon.pid; }
  /** What the daemon has printed since it was started. */
  get said() { return this.#said; }
  async stop() {
    if (this.#daemon) await this.killDaemon("SIGTERM");
    const ended = new Promise((resolve) => this.#rig.once("exit", resolve));
    this.#rig.kill("SIGTERM");
    await ended;
    rmSync(this.#folder, { recursive: true, force: true });
  }
}
