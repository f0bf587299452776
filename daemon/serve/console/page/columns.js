// SPDX-License-Identifier: Apache-2.0
// A trace in columns as wide as a pixel: what a line through all samples covers, at a cost that does not grow with their rate.

export const kColumn_s = 0.08, kBridge_s = 0.5;  // a line joins samples that are no farther apart

export class Columns {
  #span_s; #columns = []; #last_s = null; #last = null;
  /** The latest `span_s` are kept. */
  constructor(span_s) { this.#span_s = span_s; }

  /** null: not measured; a line does not go over it. Times never go back. */
  add(t_s, value) {
    if (value === null) { this.#last_s = null; return; }
    const k = Math.floor(t_s / kColumn_s), joined = this.#last_s !== null && t_s - this.#last_s <= kBridge_s, newest = this.#columns.at(-1);
    if (newest?.k === k) {
      newest.least = Math.min(newest.least, value);
      newest.greatest = Math.max(newest.greatest, value);
    } else {
      // A line that arrives from the column before covers the way from its last value.
      const from = joined && newest?.k === k - 1 ? this.#last : value;
      this.#columns.push({ k, t_s: (k + 0.5) * kColumn_s, least: value, greatest: value, low: Math.min(from, value), high: Math.max(from, value), joined });
      const oldest = Math.floor((t_s - this.#span_s) / kColumn_s);
      while (this.#columns[0].k < oldest) this.#columns.shift();
    }
    const column = this.#columns.at(-1);
    column.low = Math.min(column.low, value);
    column.high = Math.max(column.high, value);
    column.last = this.#last = value;
    this.#last_s = t_s;
  }
  /** [{t_s, least, greatest, low, high, last, joined}], the oldest first: least and greatest value of the column, what the line
      covers in it (with the way from the column next to it), its last value; whether a line joins it to the one before. */
  get all() { return this.#columns; }
}
