// SPDX-License-Identifier: Apache-2.0
// Numbers as text, and the scales of panels.

export const kSeen_d = 8;  // seen in 99 of 100 runs

/** With so many digits that count; no exponent where four zeros do. */
export function sig(value, digits = 3) {
  if (value === null || value === undefined || !Number.isFinite(value)) return "--";
  if (value === 0) return "0";
  const size = Math.floor(Math.log10(Math.abs(value)));
  if (size < -5 || size > 6) return value.toExponential(digits - 1);
  return value.toFixed(Math.max(0, digits - 1 - size));
}
export const signed = (value, digits = 3) => (value > 0 ? "+" : "") + sig(value, digits);

/** Value with its standard deviation, both to two digits of the latter. */
export function plusMinus(value, sd, unit = "") {
  if (!Number.isFinite(value)) return "--";
  if (!(sd > 0)) return `${signed(value)} ${unit}`;
  const decimals = Math.max(0, Math.min(9, 1 - Math.floor(Math.log10(sd))));
  return `${value > 0 ? "+" : ""}${value.toFixed(decimals)} ± ${sd.toFixed(decimals)} ${unit.replace("degC", "°C").replace("^2", "²")}`;
}

/** How long something has been so, to a whole unit, of which there are at least two. */
export function ago(s) {
  const [unit, name] = s < 120 ? [1, "s"] : s < 7200 ? [60, "min"] : s < 172800 ? [3600, "h"] : [86400, "days"];
  return `${Math.floor(Math.max(0, s) / unit)} ${name}`;
}

/** A p-value underflows; its logarithm does not. */
export function chance(log10_p) {
  if (log10_p === null || log10_p === undefined) return "--";
  if (log10_p < -30) return "< 1e-30";
  const p = 10 ** log10_p;
  return p < 0.001 ? p.toExponential(0) : sig(p, 2);
}

export function ticks(low, high, wanted) {
  const raw = (high - low) / Math.max(1, wanted), size = 10 ** Math.floor(Math.log10(raw));
  const step = [1, 2, 5, 10].map((m) => m * size).find((s) => s >= raw) ?? raw;
  const out = [];
  for (let k = Math.ceil(low / step - 1e-9); k * step <= high + 1e-9 * step; ++k) out.push(k * step);
  return { at: out, text: (v) => v.toFixed(Math.max(0, -Math.floor(Math.log10(step) + 1e-9))) };
}

/** 1, 2 and 5 of each decade between two positive numbers; only the decades where there are many. */
export function logTicks(low, high) {
  const out = [];
  for (let k = Math.floor(Math.log10(low)); k <= Math.log10(high); ++k)
    for (const m of high / low > 1000 ? [1] : [1, 2, 5]) {
      const v = Number(`${m}e${k}`);
      if (v >= low && v <= high) out.push(v);
    }
  return out;
}

export function extent(lists, symmetric = false) {
  let low = Infinity, high = -Infinity;
  for (const list of lists) for (const v of list) if (v !== null && Number.isFinite(v)) { if (v < low) low = v; if (v > high) high = v; }
  if (low > high) return [-1, 1];
  if (symmetric) { high = Math.max(Math.abs(low), Math.abs(high)); low = -high; }
  const room = 0.06 * (high - low) || Math.abs(high) || 1;
  return [low - room, high + room];
}

/** Means over equally filled bins, with two standard errors. */
export function binMeans(x, y, bins = 8) {
  const points = x.map((v, i) => [v, y[i]]).filter(([a, b]) => a !== null && b !== null && Number.isFinite(a) && Number.isFinite(b)).sort((a, b) => a[0] - b[0]);
  const out = [];
  for (let k = 0; k < bins; ++k) {
    const part = points.slice(Math.floor((k * points.length) / bins), Math.floor(((k + 1) * points.length) / bins));
    if (part.length < 3) continue;
    const mean = (i) => part.reduce((s, p) => s + p[i], 0) / part.length, m = mean(1);
    const sd = Math.sqrt(part.reduce((s, p) => s + (p[1] - m) ** 2, 0) / (part.length - 1));
    out.push({ x: mean(0), y: m, two_se: (2 * sd) / Math.sqrt(part.length) });
  }
  return out;
}

/** Of names like "s1 theta" with their units and values: [[parameter, unit, value of s1, ...], ...] and the sensors. */
export function bySensor(names, units, values) {
  const sensors = [...new Set(names.map((name) => name.split(" ")[0]))], lines = new Map();
  names.forEach((name, i) => {
    const [sensor, parameter] = name.split(" ");
    if (!lines.has(parameter)) lines.set(parameter, [parameter, units[i], ...sensors.map(() => null)]);
    lines.get(parameter)[2 + sensors.indexOf(sensor)] = values[i];
  });
  return { sensors, lines: [...lines.values()] };
}
