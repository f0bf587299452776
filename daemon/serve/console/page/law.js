// SPDX-License-Identifier: Apache-2.0
// The formula of a law that is in no library: what mgt discover says, and its curve.
import { make, table } from "./elements.js";
import { sig } from "./numbers.js";

const css = (name) => getComputedStyle(document.documentElement).getPropertyValue(name).trim();
const kColour = { PASS: "good", LAW: "warn", "LAW-SET": "warn", LIBRARY: "warn", "SHAPE-ONLY": "bad", "NOISE-LIKE": "bad" };

/** The curve with the band that holds all of it with 95 %, and the leading formula dashed. */
function drawCurve(canvas, curve) {
  const width = canvas.clientWidth, height = 240, scale = devicePixelRatio || 1;
  if (width === 0) return;
  canvas.style.height = `${height}px`;
  canvas.width = width * scale;
  canvas.height = height * scale;
  const g = canvas.getContext("2d"), left = 92, right = 12, top = 12, bottom = 40;
  g.scale(scale, scale);
  const half = curve.hi_nT.map((h, i) => (h - curve.y_nT[i]) / 1.96 * curve.simultaneous_sd);
  const low = curve.y_nT.map((y, i) => y - half[i]), high = curve.y_nT.map((y, i) => y + half[i]);
  const [x0, x1] = [curve.x[0], curve.x.at(-1)], y0 = Math.min(...low), y1 = Math.max(...high);
  const px = (x) => left + (width - left - right) * (x - x0) / (x1 - x0), py = (y) => height - bottom - (height - top - bottom) * (y - y0) / (y1 - y0 || 1);
  const line = (ys) => { g.beginPath(); ys.forEach((y, i) => (i ? g.lineTo(px(curve.x[i]), py(y)) : g.moveTo(px(curve.x[i]), py(y)))); g.stroke(); };
  g.fillStyle = css("--trace"); g.globalAlpha = 0.2;
  g.beginPath(); low.forEach((y, i) => g.lineTo(px(curve.x[i]), py(y))); high.map((y, i) => [y, i]).reverse().forEach(([y, i]) => g.lineTo(px(curve.x[i]), py(y))); g.fill();
  g.globalAlpha = 1;
  g.strokeStyle = css("--trace"); g.lineWidth = 2; line(curve.y_nT);
  if (curve.formulas.length) { g.strokeStyle = css("--named"); g.setLineDash([6, 4]); line(curve.formulas[0].y_nT); g.setLineDash([]); }
  g.fillStyle = g.strokeStyle = css("--ink"); g.lineWidth = 1; g.font = `${css("--small")} 'DejaVu Sans', sans-serif`;
  g.strokeRect(left, top, width - left - right, height - top - bottom);
  g.textAlign = "center"; g.textBaseline = "top";
  for (const x of [x0, (x0 + x1) / 2, x1]) g.fillText(sig(x, 3), Math.min(Math.max(px(x), left + 14), width - 24), height - bottom + 5);
  g.fillText(curve.covariate, left + (width - left - right) / 2, height - bottom + 22);
  g.textAlign = "right"; g.textBaseline = "middle";
  for (const y of [y0, 0, y1]) g.fillText(sig(y, 2), left - 6, Math.min(Math.max(py(y), top + 6), height - bottom - 6));
  g.save(); g.translate(12, top + (height - top - bottom) / 2); g.rotate(-Math.PI / 2); g.textAlign = "center"; g.fillText(`${curve.where}, nT`, 0, 0); g.restore();
}

/** `keep` adds the leading formulas to the model; null for a pose table. */
export function showLaws(found, keep) {
  const canvas = found.curve ? make("canvas", { class: "curve", role: "img", "aria-label": `the shape of ${found.curve.where} over ${found.curve.covariate}` }) : null;
  if (canvas) new ResizeObserver(() => requestAnimationFrame(() => drawCurve(canvas, found.curve))).observe(canvas);
  const believed = found.verdict !== "PASS" && found.stands_out;
  return [make("p", {}, make("b", { class: `word ${kColour[found.verdict] ?? ""}`, "data-key": "law-verdict" }, found.verdict)),
          canvas ? make("figure", {}, canvas, make("figcaption", { class: "caption" }, "The curve has no formula in it: splines or harmonics, up to a constant, with the band that holds all of it with 95 %; dashed the leading formula. Good: the dashes stay in the band.")) : null,
          ...(believed ? found.laws.map((law) => table("The formula, and what else it could be", ["", "where", "P", "fall of χ²", "coefficients"],
                                                   law.formulas.slice(0, 8).map((f) => [f.formula, f.where, f.P.toFixed(2), f.chi2_fall.toFixed(1), f.k]))) : []),
          make("details", {}, make("summary", {}, "All that mgt discover says"), make("pre", {}, found.text)),
          keep && found.commands.length ? make("button", { id: "keep-law", class: "main", onclick: keep }, "Keep the formula in the model") : null];
}
