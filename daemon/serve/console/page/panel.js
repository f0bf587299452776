// SPDX-License-Identifier: Apache-2.0
// One panel: marks on a canvas, each of a pose. The same pose is marked in every panel; points move to where another model
// puts them. Above kMostMarks the panel shows how dense they lie.
import { binMeans, extent, ticks } from "./numbers.js";

const kMostMarks = 2000, kNear_px = 14, kMove_ms = 450;
const kLegend = 0.1;  // of the height, free of points for the names of the series
const kMargin = { left: 44, right: 10, top: 8, bottom: 34 };
const css = (name) => getComputedStyle(document.documentElement).getPropertyValue(name).trim();
const kTones = ["--s1", "--s2", "--s3", "--s4"];
export const tone = (i) => css(kTones[i % kTones.length]);

/** Sensors are told apart by shape as well as by colour. */
export function mark(g, shape, x, y, r) {
  g.beginPath();
  if (shape % 4 === 0) g.arc(x, y, r, 0, 7);
  else if (shape % 4 === 1) g.rect(x - r * 0.9, y - r * 0.9, 1.8 * r, 1.8 * r);
  else if (shape % 4 === 2) { g.moveTo(x, y - 1.2 * r); g.lineTo(x + 1.1 * r, y + 0.8 * r); g.lineTo(x - 1.1 * r, y + 0.8 * r); g.closePath(); }
  else { g.moveTo(x, y - 1.3 * r); g.lineTo(x + 1.3 * r, y); g.lineTo(x, y + 1.3 * r); g.lineTo(x - 1.3 * r, y); g.closePath(); }
}

export class Panel {
  #canvas; #on; #marks = []; #from = null; #moved_ms = 0; #spec = null; #range = null; #base = null; #drag = null; #toX; #toY;
  /** `on`: {hover(pose|null), select([poses])}. */
  constructor(canvas, on) {
    this.#canvas = canvas;
    this.#on = on;
    canvas.addEventListener("pointermove", (event) => this.#pointer(event));
    canvas.addEventListener("pointerleave", () => { if (!this.#drag) on.hover(null); });
    canvas.addEventListener("pointerdown", (event) => { this.#drag = { x: event.offsetX, y: event.offsetY, toX: event.offsetX, toY: event.offsetY }; canvas.setPointerCapture(event.pointerId); });
    canvas.addEventListener("pointerup", (event) => this.#released(event));
  }
  /** {x: {label, values}, y: {label, symmetric}, series: [{name, values, pose, shape}], band, line, bins, hollow, ringed, poses}.
      `keep`: the axes stay, and the points move from where they were. */
  show(spec, keep = false) {
    const before = keep && this.#spec && this.#spec.series.length === spec.series.length ? this.#spec : null;
    this.#spec = spec;
    if (!before || !this.#range) this.fit();
    this.#from = before && !matchMedia("(prefers-reduced-motion: reduce)").matches ? before : null;
    this.#moved_ms = performance.now();
    this.#base = null;
  }
  get spec() { return this.#spec; }
  fit() {
    const { x, y, series } = this.#spec;
    const [low, high] = extent([...series.map((s) => s.values), ...(y.also ?? [])], y.symmetric);
    this.#range = { x: extent(series.map((s) => s.x ?? x.values)), y: [low, series.length > 1 ? high + kLegend * (high - low) : high] };
    this.#base = null;
  }
  stale() { this.#base = null; }

  /** Draws; true while points move. `state`: {pose, selected: Set, masked: Set}. */
  draw(state) {
    const canvas = this.#canvas, scale = devicePixelRatio || 1, width = canvas.clientWidth, height = canvas.clientHeight;
    if (!this.#spec || width === 0) return false;
    const part = this.#from ? Math.min(1, (performance.now() - this.#moved_ms) / kMove_ms) : 1;
    if (canvas.width !== Math.round(width * scale) || canvas.height !== Math.round(height * scale)) {
      canvas.width = Math.round(width * scale);
      canvas.height = Math.round(height * scale);
      this.#base = null;
    }
    if (!this.#base || part < 1) this.#base = this.#drawn(width, height, scale, part < 1 ? part * (2 - part) : 1);
    if (part >= 1) this.#from = null;
    const g = canvas.getContext("2d");
    g.setTransform(1, 0, 0, 1, 0, 0);
    g.clearRect(0, 0, canvas.width, canvas.height);
    g.drawImage(this.#base, 0, 0);
    g.setTransform(scale, 0, 0, scale, 0, 0);
    for (const m of this.#marks) if (state.selected.has(m.pose) && m.pose !== state.pose) this.#ring(g, m, state.selected.size > 30 ? 3.4 : 4.5, css("--warn"), state.selected.size > 30 ? 1 : 1.5);
    for (const m of this.#marks) if (m.pose === state.pose) this.#ring(g, m, 6.5, css("--ink"), 2.2);
    if (this.#drag) {
      g.strokeStyle = css("--warn");
      g.setLineDash([4, 3]);
      g.strokeRect(this.#drag.x, this.#drag.y, this.#drag.toX - this.#drag.x, this.#drag.toY - this.#drag.y);
      g.setLineDash([]);
    }
    return part < 1;
  }
  #ring(g, m, r, colour, wide) {
    g.strokeStyle = colour;
    g.lineWidth = wide;
    g.beginPath(); g.arc(m.x, m.y, r, 0, 7); g.stroke();
  }

  #drawn(width, height, scale, part) {
    const base = new OffscreenCanvas(this.#canvas.width, this.#canvas.height), g = base.getContext("2d"), spec = this.#spec;
    g.setTransform(scale, 0, 0, scale, 0, 0);
    g.font = `${css("--small")} 'DejaVu Sans', sans-serif`;
    const right = width - kMargin.right, top = kMargin.top, bottom = height - kMargin.bottom, { x: rx, y: ry } = this.#range;
    const ty = ticks(ry[0], ry[1], (bottom - top) / 30);
    const left = Math.max(kMargin.left, 26 + Math.max(...ty.at.map((v) => g.measureText(ty.text(v)).width)));
    const X = this.#toX = (v) => left + ((v - rx[0]) / (rx[1] - rx[0])) * (right - left);
    const Y = this.#toY = (v) => bottom - ((v - ry[0]) / (ry[1] - ry[0])) * (bottom - top);
    this.#axes(g, { left, right, top, bottom, X, Y, rx, ry, ty });
    g.save();
    g.beginPath(); g.rect(left, top - 3, right - left, bottom - top + 6); g.clip();
    if (spec.band) this.#band(g, spec.band, X, Y);
    if (spec.line) this.#line(g, spec.line, X, Y, rx);
    this.#points(g, X, Y, part);
    if (spec.bins && part === 1) this.#bins(g, X, Y);
    g.restore();
    if (spec.series.length > 1) this.#legend(g, right, top);
    return base;
  }
  #axes(g, { left, right, top, bottom, X, Y, rx, ry, ty }) {
    g.lineWidth = 1;
    g.fillStyle = css("--soft");
    g.strokeStyle = css("--line");
    const tx = ticks(rx[0], rx[1], (right - left) / 45);
    g.textAlign = "right"; g.textBaseline = "middle";
    for (const v of ty.at) {
      g.globalAlpha = 0.5;
      g.beginPath(); g.moveTo(left, Y(v)); g.lineTo(right, Y(v)); g.stroke();
      g.globalAlpha = 1;
      g.fillText(ty.text(v), left - 5, Y(v));
    }
    g.textAlign = "center"; g.textBaseline = "alphabetic";
    for (const v of tx.at) {
      g.beginPath(); g.moveTo(X(v), bottom); g.lineTo(X(v), bottom + 3); g.stroke();
      if (X(v) > left + 6 && X(v) < right - 4) g.fillText(tx.text(v), X(v), bottom + 14);
    }
    g.strokeRect(left, top, right - left, bottom - top);
    if (ry[0] < 0 && ry[1] > 0) { g.strokeStyle = css("--soft"); g.beginPath(); g.moveTo(left, Y(0)); g.lineTo(right, Y(0)); g.stroke(); }
    g.fillText(this.#spec.x.label, (left + right) / 2, bottom + 29, right - left + 2 * kMargin.right);
    g.save();
    g.translate(11, (top + bottom) / 2); g.rotate(-Math.PI / 2);
    g.fillText(this.#spec.y.label, 0, 0, bottom - top);
    g.restore();
  }
  #band(g, { x, low, high }, X, Y) {
    g.fillStyle = css("--line");
    g.globalAlpha = 0.6;
    g.beginPath();
    x.forEach((v, i) => (i ? g.lineTo(X(v), Y(low[i])) : g.moveTo(X(v), Y(low[i]))));
    for (let i = x.length - 1; i >= 0; --i) g.lineTo(X(x[i]), Y(high[i]));
    g.fill();
    g.globalAlpha = 1;
  }
  #line(g, { slope, sd }, X, Y, rx) {
    g.strokeStyle = css("--ink");
    for (const [k, dash] of [[slope, []], [slope - 2 * sd, [3, 3]], [slope + 2 * sd, [3, 3]]]) {
      g.setLineDash(dash);
      g.beginPath(); g.moveTo(X(Math.min(0, rx[0])), Y(k * Math.min(0, rx[0]))); g.lineTo(X(rx[1]), Y(k * rx[1])); g.stroke();
    }
    g.setLineDash([]);
  }
  #points(g, X, Y, part) {
    const spec = this.#spec, from = this.#from, count = spec.series.reduce((n, s) => n + s.values.length, 0);
    this.#marks = [];
    spec.series.forEach((series, i) => {
      const xs = series.x ?? spec.x.values, poses = series.pose ?? spec.poses;
      const old = from && part < 1 ? new Map((from.series[i].pose ?? from.poses).map((p, k) => [p, from.series[i].values[k]])) : null;
      series.values.forEach((v, k) => {
        if (v === null || xs[k] === null || xs[k] === undefined) return;
        const start = old?.get(poses[k]);
        const y = start !== undefined && start !== null && !series.pose ? start + part * (v - start) : v;
        this.#marks.push({ x: X(xs[k]), y: Y(y), pose: poses[k], series: i, hollow: spec.hollow?.(poses[k], series.name) ?? false });
      });
    });
    if (count > kMostMarks) return this.#density(g);
    const r = count > 700 ? 1.6 : count > 250 ? 2 : 2.6;
    if (spec.ringed) for (const m of this.#marks) if (spec.ringed.has(m.pose)) this.#ring(g, m, 6, css("--soft"), 1);
    for (const m of this.#marks) {
      const colour = tone(spec.series[m.series].shape ?? m.series);
      mark(g, spec.series[m.series].shape ?? m.series, m.x, m.y, r);
      g.globalAlpha = 0.8;
      if (m.hollow) { g.strokeStyle = colour; g.lineWidth = 1; g.stroke(); } else { g.fillStyle = colour; g.fill(); }
      g.globalAlpha = 1;
    }
  }
  /** Marks in squares of 5 px, the darker the more. */
  #density(g) {
    const size = 5, cells = new Map();
    for (const m of this.#marks) {
      const key = `${Math.floor(m.x / size)} ${Math.floor(m.y / size)} ${this.#spec.series[m.series].shape ?? m.series}`;
      cells.set(key, (cells.get(key) ?? 0) + 1);
    }
    const most = Math.max(1, ...cells.values());
    for (const [key, n] of cells) {
      const [i, j, series] = key.split(" ").map(Number);
      g.fillStyle = tone(series);
      g.globalAlpha = 0.15 + 0.85 * Math.sqrt(n / most);
      g.fillRect(i * size, j * size, size, size);
    }
    g.globalAlpha = 1;
  }
  #bins(g, X, Y) {
    g.strokeStyle = css("--ink");
    for (const series of this.#spec.series.length === 1 ? this.#spec.series : []) {
      g.lineWidth = 1.6;
      for (const bin of binMeans(series.x ?? this.#spec.x.values, series.values)) {
        g.beginPath(); g.moveTo(X(bin.x), Y(bin.y - bin.two_se)); g.lineTo(X(bin.x), Y(bin.y + bin.two_se));
        g.moveTo(X(bin.x) - 7, Y(bin.y)); g.lineTo(X(bin.x) + 7, Y(bin.y)); g.stroke();
      }
    }
    g.lineWidth = 1;
  }
  #legend(g, right, top) {
    g.font = "11px 'DejaVu Sans', sans-serif";
    g.textAlign = "right"; g.textBaseline = "middle";
    let x = right - 4;
    for (let i = this.#spec.series.length - 1; i >= 0; --i) {
      const { shape } = this.#spec.series[i], name = this.#spec.series[i].name.replace("combination ", "no. "), wide = g.measureText(name).width;
      g.fillStyle = css("--card"); g.fillRect(x - wide - 15, top + 1, wide + 18, 15);
      g.fillStyle = css("--ink"); g.fillText(name, x, top + 9);
      g.fillStyle = tone(shape ?? i); mark(g, shape ?? i, x - wide - 7, top + 9, 3); g.fill();
      x -= wide + 18;
    }
  }

  #nearest(px, py) {
    let best = null, least = kNear_px ** 2;
    for (const m of this.#marks) {
      const d = (m.x - px) ** 2 + (m.y - py) ** 2;
      if (d < least) { least = d; best = m; }
    }
    return best;
  }
  #pointer(event) {
    if (this.#drag) { this.#drag.toX = event.offsetX; this.#drag.toY = event.offsetY; return this.#on.hover(undefined); }
    this.#on.hover(this.#nearest(event.offsetX, event.offsetY)?.pose ?? null);
  }
  #released(event) {
    const d = this.#drag;
    this.#drag = null;
    if (!d) return;
    if (Math.hypot(d.toX - d.x, d.toY - d.y) < 5) {
      const near = this.#nearest(event.offsetX, event.offsetY);
      return this.#on.select(near ? [near.pose] : [], true);
    }
    const within = (m) => (m.x - d.x) * (m.x - d.toX) <= 0 && (m.y - d.y) * (m.y - d.toY) <= 0;
    this.#on.select([...new Set(this.#marks.filter(within).map((m) => m.pose))], event.shiftKey);
  }
}
