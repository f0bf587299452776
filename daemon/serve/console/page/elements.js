// SPDX-License-Identifier: Apache-2.0
// Elements with text: whatever a rig, a column or a file is called reaches the page as text alone.

export const by = (id) => document.getElementById(id);

export function make(tag, options = {}, ...children) {
  const out = document.createElement(tag);
  for (const [key, value] of Object.entries(options)) {
    if (key === "class") out.className = value;
    else if (key.startsWith("on")) out.addEventListener(key.slice(2), value);
    else if (value !== null && value !== undefined && value !== false) out.setAttribute(key, value === true ? "" : value);
  }
  for (const child of children.flat()) if (child !== null && child !== undefined) out.append(child);
  return out;
}

/** The same of a drawing: elements of SVG. Children may be lists of lists. */
export function draw(tag, attributes = {}, ...children) {
  const out = document.createElementNS("http://www.w3.org/2000/svg", tag);
  for (const [key, value] of Object.entries(attributes)) if (value !== "") out.setAttribute(key, value);
  for (const child of children.flat(Infinity)) if (child !== null && child !== undefined) out.append(child);
  return out;
}

export function fill(element, ...children) { element.replaceChildren(...children.flat().filter((c) => c !== null && c !== undefined)); }

/** A sentence as parts, in which no number with an exponent is broken into two lines. */
export const unbroken = (text) => text.split(/(\S*\de-\d+)/).map((part, i) => (i % 2 ? make("span", { class: "unbroken" }, part) : part));

/** Rows of a table: the first one its head; a column of numbers stands to the right, with its head; {wide, columns} is a text over several columns. */
export function rows(head, body) {
  const isNumber = (value) => typeof value === "number" || (typeof value === "string" && /^[+-]?\d+(\.\d+)?(e[+-]?\d+)?( ± \S+)?$/.test(value));
  const cell = (tag, value, number) => make(tag, { class: number ? "number" : "", scope: tag === "th" ? "col" : null }, value instanceof Node ? value : String(value ?? ""));
  const full = body.filter((row) => !row[0]?.wide), ofNumbers = head.map((_, i) => full.some((row) => isNumber(row[i])) && full.every((row) => isNumber(row[i]) || ["--", "", null, undefined].includes(row[i])));
  return [make("thead", {}, make("tr", {}, head.map((value, i) => cell("th", value, ofNumbers[i])))),
          make("tbody", {}, body.map((row) => make("tr", {}, row.map((value, i) => (value?.wide ? make("td", { class: "wide", colspan: value.columns }, value.wide) : cell("td", value, ofNumbers[i]))))))];
}

export function table(caption, head, body) { return make("table", {}, make("caption", {}, caption), rows(head, body)); }
