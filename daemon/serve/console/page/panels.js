// SPDX-License-Identifier: Apache-2.0
// The nine panels of a run: what the model leaves, by pose, linked. Their sentences are those of mgt.
import { fill, make, table, unbroken } from "./elements.js";
import { Panel } from "./panel.js";
import { Memory, Skies } from "./skies.js";

const kClosures = 4;
/** Of a channel over a covariate, or over the one that orders the poses as it does. */
function dependence(compare, channel, covariate) {
  const shown = compare.alike.find((a) => a.covariate === covariate)?.as ?? covariate;
  return compare.channels.find((c) => c.channel === channel)?.against.find((d) => d.covariate === shown);
}
const rowsOf = (group, names) => names.filter((n) => group[n]?.some((v) => v !== null)).map((name, shape) => ({ name, values: group[name], shape }));

/** What a panel draws: {words, kind, spec}. `channel`: the one that the single-channel panels draw, null: that which depends most. */
export function panelsOf(compare, channel) {
  const p = compare.poses, sensors = Object.keys(p.scalar_nT);
  const left = new Map(p.pose.map((n, k) => [n, p.left_out[k].join(" ")]));
  const hollow = (pose, series) => { const where = left.get(pose); return where !== "" && (where.includes(series) || !where.includes(".")); };
  const time = { label: "time since the start, h", values: p.t_h }, azimuth = { label: "azimuth of the table, deg", values: p.azimuth_deg };
  const common = { poses: p.pose, hollow };
  const single = (x, covariate, title) => {
    const judged = dependence(compare, "whitened", covariate)?.component ?? "s1.x", name = channel ?? judged;
    return { judged, title, spec: { ...common, x, y: { label: `residual of ${name}, nT`, symmetric: true }, bins: true,
                             series: [{ name, values: p.residual_nT[name], shape: Number(name[1]) - 1 }] } };
  };
  const many = (x, group, names, label) => ({ spec: { ...common, x, y: { label, symmetric: true }, series: rowsOf(group, names) } });
  const draw = {
    "residual-time": () => single(time, "time_h"),
    "residual-azimuth": () => single(azimuth, "azimuth_deg"),
    "residual-temperature": (title) => {
      const own = channel?.split(".")[0], sensor = own && p.T_degC[own]?.some((v) => v !== null) ? own : /s\d+$/.exec(title)?.[0] ?? "s1";
      return single({ label: `temperature of ${sensor}, °C`, values: p.T_degC[sensor] }, `${sensor}_T_degC`, title.replace(/s\d+$/, sensor));
    },
    skies: () => ({ kind: "skies", spec: { poses: p.pose, unit: "nT", skies: sensors.map((name) => ({ name, values: p.scalar_nT[name],
      directions: p.pose.map((_, k) => ["x", "y", "z"].map((a) => p.direction_S[`${name}.${a}`][k])) })) } }),
    qq: () => {
      const q = compare.quantiles;
      return { spec: { poses: [], x: { label: "quantile of the normal distribution" }, y: { label: "residual in its own units", also: [q.low, q.high] },
                       band: { x: q.quantile, low: q.low, high: q.high }, series: [{ name: "all readings", x: q.quantile, values: q.residual, pose: q.pose, shape: 0 }] } };
    },
    autocorrelation: () => ({ kind: "memory", spec: compare.autocorrelation }),
    "residual-scalar": () => many(time, p.scalar_nT, sensors, "|b| − F, nT"),
    "residual-attitude": () => many(azimuth.values.some((v) => v !== null) ? azimuth : time, p.attitude_deg, ["x", "y", "z"], "correction, deg"),
    "residual-closure": () => many(time, p.closure, Object.keys(p.closure).sort((a, b) => a.localeCompare(b, "en", { numeric: true })).slice(0, kClosures), "closure, nT"),
  };
  return compare.panels.map((words) => {
    const column = /^residual-\d+$/.test(words.name) ? words.title.replace("Residual against ", "") : null;
    const made = column ? single({ label: column, values: p.columns[column] }, column) : draw[words.name]?.(words.title);
    return made ? { words, kind: "scatter", ...made } : null;
  }).filter(Boolean);
}

/** The sentence of a panel with this run's number in it; the rule stands behind it for who asks. */
function short(words) {
  const at = words.good.indexOf("Here ");
  return at < 0 ? words.good : words.good.slice(at);
}

/** The numbers of a panel, for who does not see it or wants them. */
function dataOf({ kind, spec, words }) {
  const text = (v) => (v === null || v === undefined ? "" : Number(v.toPrecision(6)));
  if (kind === "memory") return table(words.title, ["lag", ...spec.by_sensor.map((_, s) => `s${s + 1}`)], spec.by_sensor[0].map((_, k) => [k + 1, ...spec.by_sensor.map((r) => text(r[k]))]));
  if (kind === "skies") return table(words.title, ["pose", ...spec.skies.map((s) => `${s.name}, ${spec.unit}`)], spec.poses.map((pose, k) => [pose, ...spec.skies.map((s) => text(s.values[k]))]));
  const [first] = spec.series, poses = first.pose ?? spec.poses;
  return table(words.title, ["pose", spec.x.label, ...spec.series.map((s) => (spec.series.length > 1 ? s.name : spec.y.label))],
               poses.map((pose, k) => [pose, text((first.x ?? spec.x.values)[k]), ...spec.series.map((s) => text(s.values[k]))]));
}

export class Panels {
  #place; #on; #panels = []; #state; #dirty = true; #keep = false;
  constructor(place, state, on) {
    this.#place = place;
    this.#state = state;
    this.#on = on;
    const frame = () => {
      if (this.#dirty && !this.#place.closest("[hidden]")) this.#dirty = this.#panels.map((p) => p.drawer.draw(this.#state)).some(Boolean);
      requestAnimationFrame(frame);
    };
    requestAnimationFrame(frame);
    new ResizeObserver(() => this.redraw()).observe(place);
  }
  redraw(colours = false) {
    if (colours) for (const p of this.#panels) p.drawer.stale();
    this.#dirty = true;
  }
  fit() { for (const p of this.#panels) p.drawer.fit(); this.#dirty = true; }
  clear() { this.#panels = []; fill(this.#place); }

  /** `keep`: the same poses with another model: axes stay, points move. */
  show(list, keep) {
    const same = keep && this.#panels.length === list.length && list.every((p, i) => p.words.name === this.#panels[i].name);
    if (!same) this.#build(list);
    list.forEach((p, i) => {
      const own = this.#panels[i];
      own.drawer.show(p.spec, same);
      own.title.textContent = p.title ?? p.words.title;
      own.figure.classList.toggle("stands-out", p.words.stands_out);
      const drawn = p.spec.series?.[0]?.name;
      own.say = () => {
        const wide = own.figure.classList.contains("wide"), of = p.judged && drawn !== p.judged ? `${p.judged}: ` : "";
        fill(own.good, unbroken(wide ? `${p.words.caption} Good: ${of}${p.words.good}` : of + short(p.words)));
      };
      own.say();
      own.table = () => dataOf(p);
      own.data.open = false;
      own.good.title = own.figure.title = `${p.words.caption} Good: ${p.words.good}`;
      own.canvas.setAttribute("aria-label", `${p.words.title}. ${p.words.good}`);
    });
    this.#dirty = true;
  }
  #build(list) {
    this.#panels = list.map((p) => {
      const canvas = make("canvas", { role: "img", class: "panel" }), title = make("h3", {}), good = make("p", { class: "good-one" });
      const wide = make("button", { class: "small", title: "larger", "aria-label": "larger", onclick: () => { figure.classList.toggle("wide"); own.say(); this.redraw(); } }, "⤢");
      const place = make("div", { class: "data", tabindex: "0", role: "region", "aria-label": `${p.words.title}, data` }), data = make("details", { ontoggle: () => fill(place, data.open ? own.table() : null) }, make("summary", {}, "data"), place);
      const figure = make("figure", { "data-panel": p.words.name }, make("header", {}, title, wide), canvas, good, data);
      const drawer = p.kind === "skies" ? new Skies(canvas, this.#on) : p.kind === "memory" ? new Memory(canvas) : new Panel(canvas, this.#on);
      const own = { name: p.words.name, figure, canvas, title, good, data, drawer, say: () => {}, table: () => null };
      return own;
    });
    fill(this.#place, this.#panels.map((p) => p.figure));
  }
}

/** What was measured at the pose under the cursor, in one line. */
export function poseLine(compare, pose) {
  const p = compare.poses, k = p.pose.indexOf(pose);
  if (k < 0) return "";
  const degrees = ["azimuth_deg", "pitch_deg", "roll_deg"].map((a) => p[a]?.[k]).filter((v) => v !== null && v !== undefined).map((v) => v.toFixed(1)).join(", ");
  const worst = Object.entries(p.whitened).map(([name, list]) => [name, Math.abs(list[k] ?? 0), p.residual_nT[name][k]]).sort((a, b) => b[1] - a[1])[0];
  const warm = Object.values(p.T_degC ?? {}).map((list) => list[k]).filter((v) => v !== null);
  return [`pose ${pose}`, p.set[k], `${p.t_h[k].toFixed(3)} h`, degrees && `${degrees} deg`, warm.length ? `${warm[0].toFixed(2)} °C` : "",
          `largest residual ${worst[2]?.toFixed(3)} nT in ${worst[0]}`, `leverage ${p.leverage[k]?.toFixed(3)}`,
          p.left_out[k].length ? `left out by the fit: ${p.left_out[k].join(", ")}` : ""].filter(Boolean).join(" · ");
}
