// SPDX-License-Identifier: Apache-2.0
// The lanes: one trace each over one time axis, drawn on a canvas. The last minute has every sample; longer windows come
// decimated from the daemon, as mean within the range of each column. What was not measured is hatched, with its reason. The
// last minute is drawn by columns of a pixel (columns.js), not by samples.

import { Columns, kColumn_s } from "./columns.js";

const kHeight = 52, kAxis = 26, kRight = 12, kFrame_ms = 250;
const css = (name) => getComputedStyle(document.documentElement).getPropertyValue(name).trim();
export const windows = [["1 min", 60], ["10 min", 600], ["1 h", 3600], ["6 h", 21600], ["24 h", 86400]];

/** A number with as many digits as tell it from its neighbours in a range of `span`. */
export function shown(value, span) {
  if (value === null || value === undefined || !Number.isFinite(value)) return "--";
  const digits = Math.max(0, Math.min(4, Math.ceil(2 - Math.log10(Math.max(span, 1e-9)))));
  return value.toFixed(digits);
}

const clock = (t_s) => new Date(1000 * t_s).toISOString().slice(11, 19) + "Z";

export class Lanes {
  #canvas; #say; #channels = []; #window_s = 60; #recent = new Map(); #columns = new Map(); #gaps = []; #lanes = new Map(); #now_s = 0; #cursor = null;
  #asked_ms = 0; #dirty = true; #left = 200;
  constructor(canvas, say) {
    this.#canvas = canvas;
    this.#say = say;
    canvas.addEventListener("pointermove", (event) => { this.#cursor = event.offsetX; this.#dirty = true; });
    canvas.addEventListener("pointerleave", () => { this.#cursor = null; this.#say(""); this.#dirty = true; });
    canvas.addEventListener("keydown", (event) => {
      const step = { ArrowLeft: -8, ArrowRight: 8 }[event.key];
      if (!step) return;
      this.#cursor = Math.max(this.#left, Math.min(canvas.clientWidth - kRight, (this.#cursor ?? canvas.clientWidth - kRight) + step));
      this.#dirty = true;
      event.preventDefault();
    });
    const frame = () => {
      if (this.#dirty) this.#draw();
      setTimeout(() => requestAnimationFrame(frame), kFrame_ms);
    };
    requestAnimationFrame(frame);
  }
  /** [{name, label, unit}], top to bottom. */
  set channels(list) {
    const same = list.length === this.#channels.length && list.every((c, i) => c.name === this.#channels[i].name);
    if (same) return;
    this.#channels = list;
    this.#canvas.style.height = `${list.length * kHeight + kAxis}px`;
    this.#asked_ms = 0;
    this.#dirty = true;
  }
  get count() { return this.#channels.length; }
  set window_s(seconds) { this.#window_s = seconds; this.#lanes.clear(); this.#asked_ms = 0; this.#dirty = true; }
  get window_s() { return this.#window_s; }
  redraw() { this.#dirty = true; }

  add(t_s, values) {
    this.#now_s = t_s;
    for (const { name } of this.#channels) {
      let trace = this.#recent.get(name);
      if (!trace) {
        this.#recent.set(name, trace = []);
        this.#columns.set(name, new Columns(61));
      }
      trace.push([t_s, values[name] ?? null]);
      this.#columns.get(name).add(t_s, values[name] ?? null);
      let old = 0;
      while (old < trace.length && trace[old][0] < t_s - 61) ++old;
      if (old > 64) trace.splice(0, old);
    }
    this.#dirty = true;
    if (this.#window_s > 60) this.#ask();
  }
  /** Not measured from the last sample on, or from the end of the gap before, which had another reason. */
  gap(why) {
    const last = this.#gaps.at(-1);
    if (last && last.open && last.why === why) return;
    this.endGap(this.#now_s);
    this.#gaps.push({ from_s: this.#now_s, to_s: null, why, open: true });
    if (this.#gaps.length > 200) this.#gaps.shift();
    this.#dirty = true;
  }
  endGap(t_s) {
    const last = this.#gaps.at(-1);
    if (last && last.open) { last.open = false; last.to_s = t_s; }
  }
  /** It is `t_s` now; the lanes go on while nothing is measured. */
  pass(t_s) {
    if (!this.#gaps.at(-1)?.open || t_s <= this.#now_s) return;
    this.#now_s = t_s;
    this.#dirty = true;
    if (this.#window_s > 60) this.#ask();
  }

  /** Longer windows: a column's worth of time at most between two questions. */
  #ask() {
    const columns = Math.max(100, Math.floor((this.#canvas.clientWidth - this.#left) / 2));
    if (performance.now() - this.#asked_ms < Math.max(2000, (1000 * this.#window_s) / columns)) return;
    this.#asked_ms = performance.now();
    const wanted = this.#window_s;
    for (const { name } of this.#channels)
      fetch(`/lane?channel=${encodeURIComponent(name)}&window_s=${wanted}&columns=${columns}`)
        .then((answer) => (answer.ok ? answer.json() : null))
        .then((lane) => { if (lane && wanted === this.#window_s) { this.#lanes.set(name, lane); this.#dirty = true; } })
        .catch(() => {});
  }

  #points(name) {
    if (this.#window_s <= 60) return { t: (this.#recent.get(name) ?? []), band: null, gaps: this.#gaps };
    const lane = this.#lanes.get(name);
    if (!lane) return { t: [], band: null, gaps: [] };
    const t = lane.mean.map((mean, i) => [lane.from_s + (i + 0.5) * lane.step_s, mean]);
    return { t, band: lane, gaps: lane.gaps };
  }

  /** What each lane shows, as numbers: [{label, unit, now, mean, least, greatest, gaps}] of the window. */
  summary() {
    const from_s = this.#now_s - this.#window_s;
    return this.#channels.map(({ name, label, unit, least_span }) => {
      const { t, band, gaps } = this.#points(name), values = t.filter(([t_s, v]) => v !== null && t_s >= from_s).map(([, v]) => v);
      const of = (list, choose) => list.filter((v) => v !== null).reduce((a, b) => (a === null ? b : choose(a, b)), null);
      const least = of(band?.least ?? values, Math.min), greatest = of(band?.greatest ?? values, Math.max), span = Math.max(greatest - least, least_span ?? 1e-3);
      const mean = values.length ? values.reduce((a, b) => a + b, 0) / values.length : null;
      return { label, unit, now: shown(values.at(-1), span), mean: shown(mean, span), least: shown(least, span), greatest: shown(greatest, span),
               gaps: gaps.filter((gap) => (gap.to_s ?? this.#now_s) > from_s).length };
    });
  }

  #draw() {
    this.#dirty = false;
    const canvas = this.#canvas, scale = devicePixelRatio || 1, width = canvas.clientWidth, height = canvas.clientHeight;
    if (width === 0 || this.#now_s === 0) return;
    this.#left = width < 600 ? 112 : 200;  // room for names and numbers
    if (canvas.width !== Math.round(width * scale) || canvas.height !== Math.round(height * scale)) {
      canvas.width = Math.round(width * scale);
      canvas.height = Math.round(height * scale);
    }
    const g = canvas.getContext("2d");
    g.setTransform(scale, 0, 0, scale, 0, 0);
    g.clearRect(0, 0, width, height);
    const to_s = this.#now_s, from_s = to_s - this.#window_s;
    const x = (t_s) => this.#left + ((t_s - from_s) / this.#window_s) * (width - this.#left - kRight);
    const colour = { ink: css("--ink"), soft: css("--soft"), line: css("--line"), band: css("--band"), trace: css("--trace"), bad: css("--bad"), card: css("--card"), stroke: Number(css("--stroke")) };
    g.font = "12px 'DejaVu Sans', sans-serif";
    const at = [];
    this.#channels.forEach((channel, i) => at.push(this.#lane(g, channel, i * kHeight, x, from_s, width, colour)));
    this.#axis(g, x, from_s, to_s, width, height, colour.soft, colour.line);
    if (this.#cursor !== null && this.#cursor >= this.#left) this.#showCursor(g, at, from_s, width, height, colour.soft);
  }

  #lane(g, channel, top, x, from_s, width, colour) {
    const { t, band, gaps } = this.#points(channel.name);
    const columns = band ? null : (this.#columns.get(channel.name)?.all ?? []).filter((c) => c.t_s >= from_s);
    let least = Infinity, greatest = -Infinity;
    for (const c of columns ?? []) { least = Math.min(least, c.least); greatest = Math.max(greatest, c.greatest); }
    if (band) for (let i = 0; i < band.least.length; ++i) if (band.least[i] !== null) {
      least = Math.min(least, band.least[i]); greatest = Math.max(greatest, band.greatest[i]);
    }
    const room = least > greatest ? 1 : Math.max(1.15 * (greatest - least), channel.least_span ?? 1e-3);
    const middle = least > greatest ? 0 : (least + greatest) / 2;
    const y = (v) => top + kHeight / 2 - ((v - middle) / room) * (kHeight - 8);
    g.strokeStyle = colour.line;
    g.lineWidth = 1;
    g.beginPath(); g.moveTo(0, top + kHeight + 0.5); g.lineTo(width, top + kHeight + 0.5); g.stroke();
    for (const gap of gaps) this.#hatch(g, x(Math.max(gap.from_s, from_s)), x(gap.to_s ?? this.#now_s), top, gap.why, colour);
    g.save();
    g.beginPath(); g.rect(this.#left, top, width - this.#left - kRight, kHeight); g.clip();
    if (band) {
      g.fillStyle = colour.band;
      for (let i = 0; i < band.mean.length; ++i) if (band.mean[i] !== null) {
        const left = x(band.from_s + i * band.step_s), right = x(band.from_s + (i + 1) * band.step_s);
        g.fillRect(left, y(band.greatest[i]), Math.max(1, right - left), Math.max(1, y(band.least[i]) - y(band.greatest[i])));
      }
    }
    columns ? this.#spans(g, columns, x, y, colour) : this.#line(g, t, x, y, 1.5 * band.step_s, colour);
    if (channel.limit) {
      g.strokeStyle = colour.bad;
      g.setLineDash([6, 4]);
      g.beginPath(); g.moveTo(this.#left, y(channel.limit)); g.lineTo(width - kRight, y(channel.limit)); g.stroke();
      g.setLineDash([]);
    }
    g.restore();
    const now = columns ? columns.at(-1)?.last : t.findLast(([, v]) => v !== null)?.[1];
    g.fillStyle = colour.ink;
    g.textAlign = "left";
    g.fillText(`${channel.label}`, 8, top + 18);
    g.fillText(`${shown(now, room)} ${channel.unit}`, 8, top + 36);
    g.fillStyle = colour.soft;
    g.textAlign = "right";
    if (least <= greatest && this.#left > 150) {
      g.fillText(shown(greatest, room), this.#left - 6, top + 13);
      g.fillText(shown(least, room), this.#left - 6, top + kHeight - 5);
    }
    return { channel, t, room };
  }

  /** Each column from the least to the greatest value that the line takes in it. */
  #spans(g, columns, x, y, colour) {
    const half = colour.stroke / 2;
    g.fillStyle = g.strokeStyle = colour.trace;
    g.lineWidth = colour.stroke;
    g.beginPath();
    const pixel = 1 / (devicePixelRatio || 1), whole = (v) => Math.round(v / pixel) * pixel, thick = Math.max(pixel, whole(colour.stroke));
    for (const c of columns) {  // whole pixels are filled at a fraction of the cost of their parts
      const left = whole(x(c.t_s) - half), next = whole(x(c.t_s + kColumn_s) - half), top = whole(y(c.high) - half);
      g.rect(left, top, Math.max(thick, next - left), Math.max(thick, whole(y(c.low) + half) - top));
    }
    g.fill();
    g.beginPath();
    columns.forEach((c, i) => {
      const before = columns[i - 1];
      if (!c.joined || !before || c.k - before.k < 2) return;
      g.moveTo(x(before.t_s), y(before.last));  // samples that come slowly: the columns stand apart
      g.lineTo(x(c.t_s), y(c.last));
    });
    g.stroke();
  }

  #line(g, points, x, y, bridge_s, colour) {
    g.strokeStyle = colour.trace;
    g.lineWidth = colour.stroke;
    g.beginPath();
    let pen = false, before_s = null;
    for (const [t_s, v] of points) {
      if (v === null || (before_s !== null && t_s - before_s > bridge_s)) pen = false;
      if (v === null) continue;
      pen ? g.lineTo(x(t_s), y(v)) : g.moveTo(x(t_s), y(v));
      pen = true;
      before_s = t_s;
    }
    g.stroke();
  }

  #hatch(g, from, to, top, why, colour) {
    if (to <= this.#left) return;
    const left = Math.max(this.#left, from), wide = Math.max(2, to - left);
    g.save();
    g.beginPath(); g.rect(left, top, wide, kHeight); g.clip();
    g.strokeStyle = colour.soft;
    g.lineWidth = 1;
    g.beginPath();
    for (let k = -kHeight; k < wide; k += 6) { g.moveTo(left + k, top + kHeight); g.lineTo(left + k + kHeight, top); }
    g.stroke();
    if (wide > 90) {
      g.fillStyle = colour.card;
      g.fillRect(left + 4, top + kHeight / 2 - 9, Math.min(wide - 8, g.measureText(why).width + 8), 18);
      g.fillStyle = colour.ink;
      g.textAlign = "left";
      g.fillText(why, left + 8, top + kHeight / 2 + 4);
    }
    g.restore();
  }

  #axis(g, x, from_s, to_s, width, height, soft, line) {
    const steps = [5, 10, 30, 60, 300, 600, 1800, 3600, 7200, 14400];
    const step = steps.find((s) => (this.#window_s / s) * 90 < width - this.#left) ?? steps.at(-1);
    g.fillStyle = soft;
    g.strokeStyle = line;
    g.textAlign = "center";
    for (let t_s = Math.ceil(from_s / step) * step; t_s <= to_s; t_s += step) {
      const at = x(t_s);
      if (at < this.#left + 30 || at > width - 34) continue;
      g.beginPath(); g.moveTo(at, 0); g.lineTo(at, height - kAxis); g.stroke();
      g.fillText(clock(t_s), at, height - 8);
    }
  }

  #showCursor(g, at, from_s, width, height, soft) {
    const t_s = from_s + ((this.#cursor - this.#left) / (width - this.#left - kRight)) * this.#window_s;
    g.strokeStyle = soft;
    g.beginPath(); g.moveTo(this.#cursor, 0); g.lineTo(this.#cursor, height - kAxis); g.stroke();
    const values = at.map(({ channel, t, room }) => {
      let best = null;
      for (const point of t) if (!best || Math.abs(point[0] - t_s) < Math.abs(best[0] - t_s)) best = point;
      return `${channel.label} ${shown(best?.[1], room)}`;
    });
    this.#say(`${clock(t_s)}  ${values.join("  ")}`);
  }
}
