// SPDX-License-Identifier: Apache-2.0
// Panels that are no scatter: equal-area skies of each sensor, and the correlation of a pose with those before.
import { sig, ticks } from "./numbers.js";
import { tone } from "./panel.js";

const css = (name) => getComputedStyle(document.documentElement).getPropertyValue(name).trim();
const kNear_px = 12;

/** Mollweide's equal-area projection: +x in the middle, +z at the top. */
export function mollweide([x, y, z]) {
  const latitude = Math.asin(Math.max(-1, Math.min(1, z))), longitude = Math.atan2(y, x);
  let t = latitude;
  if (Math.abs(Math.abs(latitude) - Math.PI / 2) < 1e-6) t = latitude;
  else for (let i = 0; i < 12; ++i) t -= (2 * t + Math.sin(2 * t) - Math.PI * Math.sin(latitude)) / (2 + 2 * Math.cos(2 * t));
  return [(longitude / Math.PI) * Math.cos(t), 0.5 * Math.sin(t)];  // x from -1 to 1, y from -1/2 to 1/2
}

/** The part that all canvases share: sizes and the ring of the pose. */
class Drawing {
  #canvas;
  constructor(canvas) { this.#canvas = canvas; }
  begin() {
    const canvas = this.#canvas, scale = devicePixelRatio || 1, width = canvas.clientWidth, height = canvas.clientHeight;
    if (width === 0) return null;
    canvas.width = Math.round(width * scale);
    canvas.height = Math.round(height * scale);
    const g = canvas.getContext("2d");
    g.setTransform(scale, 0, 0, scale, 0, 0);
    g.font = `${css("--small")} 'DejaVu Sans', sans-serif`;
    return { g, width, height };
  }
}

export class Skies {
  #drawing; #spec = null; #marks = [];
  constructor(canvas, on) {
    this.#drawing = new Drawing(canvas);
    const nearest = (event) => {
      let best = null, least = kNear_px ** 2;
      for (const m of this.#marks) {
        const d = (m.x - event.offsetX) ** 2 + (m.y - event.offsetY) ** 2;
        if (d < least) { least = d; best = m.pose; }
      }
      return best;
    };
    canvas.addEventListener("pointermove", (event) => on.hover(nearest(event)));
    canvas.addEventListener("pointerleave", () => on.hover(null));
    canvas.addEventListener("click", (event) => { const pose = nearest(event); on.select(pose === null ? [] : [pose], true); });
  }
  /** {skies: [{name, directions: [[x,y,z]], values}], poses, unit}; `keep`: one colour scale with before. */
  show(spec, keep = false) {
    const most = Math.max(1e-12, ...spec.skies.flatMap((s) => s.values.map((v) => Math.abs(v ?? 0))));
    this.#spec = { ...spec, most: keep && this.#spec ? Math.max(this.#spec.most, most) : most,
                   at: spec.skies.map((s) => s.directions.map(mollweide)) };
  }
  fit() { if (this.#spec) this.show({ ...this.#spec }); }
  stale() {}
  draw(state) {
    const begun = this.#spec && this.#drawing.begin();
    if (!begun) return false;
    const { g, width, height } = begun, n = this.#spec.skies.length, room = height - 16;
    const columns = n === 1 ? 1 : n <= 4 ? 2 : Math.ceil(Math.sqrt(n)), rows = Math.ceil(n / columns);
    const w = width / columns, h = room / rows, radius = Math.min(w / 2 - 8, h - 22);
    this.#marks = [];
    this.#spec.skies.forEach((sky, i) => {
      const cx = (i % columns) * w + w / 2, cy = Math.floor(i / columns) * h + h / 2 + 6;
      g.strokeStyle = css("--line");
      g.beginPath(); g.ellipse(cx, cy, radius, radius / 2, 0, 0, 7); g.stroke();
      g.beginPath(); g.moveTo(cx - radius, cy); g.lineTo(cx + radius, cy); g.moveTo(cx, cy - radius / 2); g.lineTo(cx, cy + radius / 2); g.stroke();
      g.fillStyle = css("--ink"); g.textAlign = "left";
      g.fillText(sky.name, cx - radius, cy - radius / 2 - 2);
      const r = sky.values.length > 1500 ? 1.2 : 2.6;
      sky.values.forEach((v, k) => {
        if (v === null) return;
        const [x, y] = this.#spec.at[i][k], m = { x: cx + x * radius, y: cy - y * radius, pose: this.#spec.poses[k] };
        this.#marks.push(m);
        g.globalAlpha = 0.25 + 0.75 * Math.min(1, Math.abs(v) / this.#spec.most);
        g.fillStyle = css(v < 0 ? "--below" : "--above");
        g.beginPath(); g.arc(m.x, m.y, r, 0, 7); g.fill();
        g.globalAlpha = 1;
      });
    });
    for (const m of this.#marks) {
      if (m.pose !== state.pose && !state.selected.has(m.pose)) continue;
      g.strokeStyle = css(m.pose === state.pose ? "--ink" : "--warn");
      g.lineWidth = m.pose === state.pose ? 2.2 : 1.5;
      g.beginPath(); g.arc(m.x, m.y, m.pose === state.pose ? 6.5 : 4.5, 0, 7); g.stroke();
      g.lineWidth = 1;
    }
    g.textAlign = "center";
    for (const [at, sign, colour] of [[0.22, "−", "--below"], [0.78, "+", "--above"]]) {
      g.fillStyle = css(colour);
      g.fillRect(at * width - 45, height - 12, 10, 10);
      g.fillStyle = css("--soft");
      g.fillText(`${sign}${sig(this.#spec.most, 2)} ${this.#spec.unit}`, at * width + 6, height - 3);
    }
    return false;
  }
}

/** Bars of each sensor by lag, and the band within which 95 of 100 end. */
export class Memory {
  #drawing; #spec = null;
  constructor(canvas) { this.#drawing = new Drawing(canvas); }
  /** {by_sensor: [[r]], bound} */
  show(spec) { this.#spec = spec; }
  fit() {}
  stale() {}
  draw() {
    const begun = this.#spec && this.#drawing.begin();
    if (!begun) return false;
    const { g, width, height } = begun, left = 52, right = width - 10, top = 8, bottom = height - 34;
    const { by_sensor, bound } = this.#spec, lags = by_sensor[0]?.length ?? 0;
    const most = Math.max(0.3, bound, ...by_sensor.flat().map((r) => Math.abs(r ?? 0)));
    const low = 1.05 * Math.min(-0.3, ...by_sensor.flat()), high = 1.2 * most, span = high - low;
    const Y = (v) => bottom - ((v - low) / span) * (bottom - top), X = (lag) => left + ((lag + 0.5) / (lags + 1)) * (right - left);
    g.fillStyle = css("--line"); g.globalAlpha = 0.6;
    g.fillRect(left, Y(bound), right - left, Y(-bound) - Y(bound));
    g.globalAlpha = 1;
    const step = (right - left) / (lags + 1) / (by_sensor.length + 1);
    by_sensor.forEach((list, s) => {
      g.fillStyle = tone(s);
      list.forEach((r, k) => g.fillRect(X(k + 0.5) + (s - by_sensor.length / 2) * step, Math.min(Y(0), Y(r)), Math.max(1, step), Math.max(0.5, Math.abs(Y(r) - Y(0)))));
    });
    g.strokeStyle = css("--line"); g.strokeRect(left, top, right - left, bottom - top);
    g.strokeStyle = css("--soft"); g.beginPath(); g.moveTo(left, Y(0)); g.lineTo(right, Y(0)); g.stroke();
    g.fillStyle = css("--soft"); g.textAlign = "right"; g.textBaseline = "middle";
    for (const v of ticks(low, high, 5).at) g.fillText(v.toFixed(1), left - 5, Y(v));
    g.textAlign = "center"; g.textBaseline = "alphabetic";
    for (const lag of [1, 5, 10, 15, 20]) if (lag <= lags) g.fillText(String(lag), X(lag - 0.5), bottom + 14);
    g.fillText("lag, poses", (left + right) / 2, bottom + 29);
    g.save(); g.translate(11, (top + bottom) / 2); g.rotate(-Math.PI / 2); g.fillText("correlation", 0, 0); g.restore();
    g.textAlign = "right"; g.textBaseline = "middle";
    by_sensor.slice(0, 8).forEach((_, s) => { g.fillStyle = tone(s); g.fillText(`s${s + 1}`, right - 5 - (Math.min(8, by_sensor.length) - 1 - s) * 22, top + 9); });
    return false;
  }
}
