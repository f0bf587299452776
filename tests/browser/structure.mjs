// SPDX-License-Identifier: Apache-2.0
// The structure of what a page shows, by the arithmetic of its boxes: nothing leaves the page, no text is cut, no text is too
// small to read, and no two of the texts and the things to click lie over each other, on canvases neither. What scrolls on
// purpose may be wider than its place; what sticks to an edge of the window lies over what scrolls beneath it.

const kSmallest_px = 11, kSlack_px = 1.5;

/** To run before the page does: every canvas remembers the texts that are drawn on it since it was cleared. */
export const kCanvasTexts = `{
  const forgets = (proto, name) => {
    const was = Object.getOwnPropertyDescriptor(proto, name);
    Object.defineProperty(proto, name, { ...was, set(to) { this.texts = []; was.set.call(this, to); } });
  };
  forgets(HTMLCanvasElement.prototype, "width");
  for (const { prototype } of [CanvasRenderingContext2D, OffscreenCanvasRenderingContext2D]) {
    const { fillText, clearRect, drawImage } = prototype;
    prototype.clearRect = function (...box) { this.canvas.texts = []; return clearRect.apply(this, box); };
    prototype.drawImage = function (from, ...more) { (this.canvas.texts ??= []).push(...(from.texts ?? [])); return drawImage.call(this, from, ...more); };
    prototype.fillText = function (text, x, y, ...most) {
      const m = this.measureText(text), t = this.getTransform(), narrower = Math.min(1, (most[0] ?? Infinity) / m.width);
      const corners = [[-narrower * m.actualBoundingBoxLeft, -m.actualBoundingBoxAscent], [narrower * m.actualBoundingBoxRight, m.actualBoundingBoxDescent]]
        .map(([dx, dy]) => t.transformPoint({ x: x + dx, y: y + dy }));
      const [xs, ys] = ["x", "y"].map((k) => corners.map((c) => c[k] / devicePixelRatio));
      (this.canvas.texts ??= []).push({ text: String(text), left: Math.min(...xs), right: Math.max(...xs), top: Math.min(...ys), bottom: Math.max(...ys),
                                  size: parseFloat(this.font) * Math.min(1, 1.25 * narrower) });  // a little narrower can still be read
      return fillText.call(this, text, x, y, ...most);
    };
  }
}`;

/** Runs in the page; what is wrong with it, one sentence each. */
function look(kSmallest, kSlack) {
  const out = new Set(), width = document.documentElement.clientWidth;
  const dialog = document.querySelector("dialog[open]"), root = dialog ?? document.body;
  const seen = (e) => e.checkVisibility({ visibilityProperty: true }) && e.getClientRects().length > 0;
  const words = (s) => s.trim().replace(/\s+/g, " ").slice(0, 40);
  const name = (e) => `<${e.localName}${e.id ? ` #${e.id}` : ""}> "${words(e.textContent || e.value || "")}" in #${e.closest("[id]")?.id ?? ""}`;
  const clips = (e) => getComputedStyle(e).overflowX !== "visible", scrolls = (e) => /auto|scroll/.test(getComputedStyle(e).overflowX);
  const up = function* (e) { for (; e && e !== document.documentElement; e = e.parentElement) yield e; };
  const sticks = (e) => [...up(e)].find((p) => /sticky|fixed/.test(getComputedStyle(p).position)) ?? null;
  /** What is seen of a box, inside everything that clips it. */
  const within = (box, e) => {
    let { left, right, top, bottom } = box;
    for (const p of up(e)) {
      if (p === document.body || !clips(p)) continue;
      const r = p.getBoundingClientRect();
      [left, right, top, bottom] = [Math.max(left, r.left), Math.min(right, r.right), Math.max(top, r.top), Math.min(bottom, r.bottom)];
    }
    return right - left > kSlack && bottom - top > kSlack ? { left, right, top, bottom } : null;
  };
  const overlap = (p, q) => Math.min(p.right, q.right) - Math.max(p.left, q.left) > kSlack && Math.min(p.bottom, q.bottom) - Math.max(p.top, q.top) > kSlack;

  const beyond = document.documentElement.scrollWidth - width;
  if (beyond > 0) out.add(`the page is ${beyond} px wider than its window`);
  const things = [];  // texts and things to click: the element, what is seen of it
  for (const e of root.querySelectorAll("button, input, select, textarea, summary, canvas, progress, figure, .card"))
    if (seen(e)) { const box = within(e.getBoundingClientRect(), e.parentElement); if (box) things.push({ e, box }); }
  for (const texts = document.createTreeWalker(root, NodeFilter.SHOW_TEXT); texts.nextNode();) {
    const node = texts.currentNode, e = node.parentElement;
    if (!node.data.trim() || !seen(e) || e.closest("option, title, desc")) continue;
    const style = getComputedStyle(e), size = parseFloat(style.fontSize) * (e.getScreenCTM?.()?.a ?? 1);
    const turned = e.getScreenCTM?.()?.b;  // the scale of a text that stands upright is that of its drawing
    if (!turned && size < kSmallest - 0.01) out.add(`${name(e)}: text of ${size.toFixed(1)} px`);
    const range = document.createRange();
    range.selectNodeContents(node);
    for (const rect of range.getClientRects()) {
      if (rect.width < kSlack) continue;
      const box = within(rect, e);
      if (box) things.push({ e, box, text: true });
      const cutter = [...up(e)].find((p) => p !== document.body && clips(p));
      const svg = e.closest("svg")?.getBoundingClientRect();
      if (svg && (rect.left < svg.left - kSlack || rect.right > svg.right + kSlack)) out.add(`${name(e)}: leaves its drawing`);
      if (cutter && !scrolls(cutter) && !svg) {
        const place = cutter.getBoundingClientRect();
        if (rect.right > place.right + kSlack || rect.left < place.left - kSlack || rect.bottom > place.bottom + kSlack || rect.top < place.top - kSlack) out.add(`${name(e)}: cut`);
      }
      if (!cutter && (rect.right > width + kSlack || rect.left < -kSlack)) out.add(`${name(e)}: leaves the page`);
    }
  }
  for (const e of root.querySelectorAll("*"))
    if (seen(e) && !e.closest("svg") && e.clientWidth > 0 && e.scrollWidth > e.clientWidth + kSlack && !scrolls(e) && e.textContent.trim() + (e.value ?? "") !== "" && (clips(e) || e.matches("button, input, figure, .card")))
      out.add(`${name(e)}: ${e.scrollWidth - e.clientWidth} px are cut`);
  for (const e of root.querySelectorAll("select")) {  // its own text has no box: measured in its font
    if (!seen(e)) continue;
    const g = document.createElement("canvas").getContext("2d"), style = getComputedStyle(e);
    g.font = `${style.fontSize} ${style.fontFamily}`;
    const room = e.clientWidth - parseFloat(style.paddingLeft) - parseFloat(style.paddingRight), text = e.selectedOptions[0]?.text ?? "";
    if (g.measureText(text).width > room + kSlack) out.add(`<select #${e.id}> "${words(text)}": its text is cut`);
  }
  for (const canvas of root.querySelectorAll("canvas")) {
    const texts = seen(canvas) ? (canvas.texts ?? []) : [], wide = canvas.width / devicePixelRatio, high = canvas.height / devicePixelRatio;
    if (texts.length && Math.abs(wide - canvas.clientWidth) > kSlack) out.add(`<canvas> in #${canvas.closest("[id]").id}: drawn ${wide} px wide, shown ${canvas.clientWidth}`);
    for (const [i, t] of texts.entries()) {
      const what = `<canvas> in ${canvas.closest("[data-panel]")?.dataset.panel ?? `#${canvas.closest("[id]")?.id}`}: "${words(t.text)}"`;
      if (t.size < kSmallest - 0.01) out.add(`${what}: text of ${t.size.toFixed(1)} px`);
      if (t.left < -kSlack || t.right > wide + kSlack || t.top < -kSlack || t.bottom > high + kSlack) out.add(`${what}: cut`);
      for (const other of texts.slice(i + 1)) if (overlap(t, other)) out.add(`${what} lies over "${words(other.text)}"`);
    }
  }
  things.sort((p, q) => p.box.top - q.box.top);
  for (const [i, p] of things.entries())
    for (let k = i + 1; k < things.length && things[k].box.top < p.box.bottom; ++k) {
      const q = things[k];
      const belong = p.e === q.e || (p.e.contains(q.e) || q.e.contains(p.e)) && !(p.text && q.text);
      if (!belong && overlap(p.box, q.box) && sticks(p.e) === sticks(q.e)) out.add(`${name(p.e)} and ${name(q.e)} overlap`);
    }
  return [...out];
}

/** An expression for the page; gives a list of sentences. */
export const kFaults = `(${look})(${kSmallest_px}, ${kSlack_px})`;
