// The rays on which two sides do not agree: all pairs and sensors, with filters and orders.

import { NO_CODE } from '../data/page_model.js';
import { differenceOf } from '../data/difference.js';

/** @typedef {import('../data/page_data.js').PageData} PageData */
/** @typedef {'place'|'range'|'flux'|'class'} RayOrder */
/** What a filter is about. @typedef {'class'|'cause'|'quantity'|'sensor'|'pair'} Facet */

/** @type {Facet[]} */
export const FACETS = ['class', 'cause', 'quantity', 'sensor', 'pair'];

export class RayList {
  /** @param {PageData} data */
  constructor(data) {
    this.data = data;
    this.count = 0;
    /** Sides that are compared anywhere. @type {{a: number, b: number}[]} */
    this.pairs = [];
    this.sensor = new Uint16Array(0);
    /** Index in `pairs`. */
    this.pair = new Uint16Array(0);
    /** Index in the sensor's own pairs. */
    this.ownPair = new Uint16Array(0);
    this.cell = new Uint32Array(0);
    this.class = new Uint8Array(0);
    this.cause = new Uint8Array(0);
    this.quantity = new Uint8Array(0);
    /** b - a of the ranges, metres; Infinity: a hit, or what is too near, on one side only; NaN: none or not known. */
    this.range = new Float64Array(0);
    this.flux = new Float64Array(0);
    /** @type {Promise<void>|null} */
    this.measured = null;
    this.isMeasured = false;
    /** @type {Record<Facet, Set<number>>} */
    this.chosen = {
      class: new Set(),
      cause: new Set(),
      quantity: new Set(),
      sensor: new Set(),
      pair: new Set(),
    };
    /** @type {RayOrder} */
    this.order = 'place';
    this.isDescending = false;
    /** Indices of rays that pass the filters, in order. */
    this.shown = new Uint32Array(0);
  }

  /** Finds the rays. */
  async gather() {
    const { model, container } = this.data;
    /** @type {{sensor: number, pair: number, ownPair: number, cells: Uint32Array, of: Uint8Array[]}[]} */
    const parts = [];
    for (const [sensorIndex, sensor] of model.sensors.entries()) {
      for (const [ownPair, pair] of (sensor.pairs ?? []).entries()) {
        if (!pair.class) {
          continue;
        }
        const codes = /** @type {Uint8Array} */ (await container.decode(pair.class));
        const none = new Uint8Array(0);
        const [causes, quantities] = await Promise.all(
          [pair.cause, pair.quantity].map(async (reference) =>
            reference ? /** @type {Uint8Array} */ (await container.decode(reference)) : none,
          ),
        );
        const cells = cellsThatDiffer(codes);
        /** @param {Uint8Array} of */
        const picked = (of) => Uint8Array.from(cells, (cell) => of[cell] ?? NO_CODE);
        parts.push({
          sensor: sensorIndex,
          pair: this.pairIndex(pair.a, pair.b),
          ownPair,
          cells,
          of: [picked(codes), picked(causes), picked(quantities)],
        });
      }
    }
    this.count = parts.reduce((sum, part) => sum + part.cells.length, 0);
    this.sensor = new Uint16Array(this.count);
    this.pair = new Uint16Array(this.count);
    this.ownPair = new Uint16Array(this.count);
    this.cell = new Uint32Array(this.count);
    [this.class, this.cause, this.quantity] = [0, 1, 2].map(() => new Uint8Array(this.count));
    let at = 0;
    for (const part of parts) {
      const end = at + part.cells.length;
      this.sensor.fill(part.sensor, at, end);
      this.pair.fill(part.pair, at, end);
      this.ownPair.fill(part.ownPair, at, end);
      this.cell.set(part.cells, at);
      this.class.set(part.of[0], at);
      this.cause.set(part.of[1], at);
      this.quantity.set(part.of[2], at);
      at = end;
    }
    this.update();
  }

  /** @param {number} a @param {number} b */
  pairIndex(a, b) {
    const known = this.pairs.findIndex((pair) => pair.a === a && pair.b === b);
    return known >= 0 ? known : this.pairs.push({ a, b }) - 1;
  }

  /** Differences of range and flux of every ray; computed once. */
  measure() {
    this.measured ??= this.readDifferences();
    return this.measured;
  }

  async readDifferences() {
    const { model, container } = this.data;
    this.range = new Float64Array(this.count).fill(NaN);
    this.flux = new Float64Array(this.count).fill(NaN);
    // Rays of one sensor and pair stand together.
    for (let from = 0, to = 0; from < this.count; from = to) {
      const [sensor, ownPair] = [this.sensor[from], this.ownPair[from]];
      while (to < this.count && this.sensor[to] === sensor && this.ownPair[to] === ownPair) {
        to += 1;
      }
      const { a, b } = this.pairs[this.pair[from]];
      const reference = model.sensors[sensor].pairs?.[ownPair].range_ulps;
      const [rangeA, rangeB, fluxA, fluxB] = await Promise.all(
        ['range.T', 'flux.V'].flatMap((channel) =>
          [a, b].map((side) => this.data.reader(sensor, side, channel)),
        ),
      );
      const ulps = reference ? await container.decode(reference) : null;
      for (let ray = from; ray < to; ray += 1) {
        const cell = this.cell[ray];
        this.range[ray] = differenceOf(rangeA(cell), rangeB(cell), ulps ? ulps[cell] : null);
        this.flux[ray] = fluxB(cell) - fluxA(cell);
      }
    }
    this.isMeasured = true;
  }

  /** Whether a ray passes the filters, but for one facet. @param {number} ray @param {Facet|null} but */
  passes(ray, but) {
    for (const facet of FACETS) {
      const set = this.chosen[facet];
      if (facet !== but && set.size > 0 && !set.has(this[facet][ray])) {
        return false;
      }
    }
    return true;
  }

  /**
   * Counts of a facet's codes among the rays that pass the other filters, by code. Codes that no ray has at
   * all are
   * left out.
   * @param {Facet} facet
   * @returns {Map<number, number>}
   */
  counts(facet) {
    const codes = this[facet];
    const counts = new Float64Array(facet === 'sensor' || facet === 'pair' ? 65536 : 256).fill(-1);
    for (let ray = 0; ray < this.count; ray += 1) {
      const code = codes[ray];
      if (counts[code] < 0) {
        counts[code] = 0;
      }
      if (this.passes(ray, facet)) {
        counts[code] += 1;
      }
    }
    /** @type {Map<number, number>} */
    const byCode = new Map();
    counts.forEach((count, code) => {
      if (count >= 0) {
        byCode.set(code, count);
      }
    });
    return byCode;
  }

  /** Applies filters and order. */
  update() {
    let passing = 0;
    const shown = new Uint32Array(this.count);
    for (let ray = 0; ray < this.count; ray += 1) {
      if (this.passes(ray, null)) {
        shown[passing] = ray;
        passing += 1;
      }
    }
    this.shown = shown.slice(0, passing);
    const key = this.sortKey();
    if (key) {
      const sign = this.isDescending ? -1 : 1;
      // Rays of equal size stay in the order of their places; those without a number come last.
      this.shown.sort((one, other) => {
        const [k, l] = [key(one), key(other)];
        if (Number.isNaN(k) || Number.isNaN(l)) {
          return Number.isNaN(k) === Number.isNaN(l) ? one - other : Number.isNaN(k) ? 1 : -1;
        }
        return k === l ? one - other : sign * (k < l ? -1 : 1);
      });
    } else if (this.isDescending) {
      this.shown.reverse();
    }
  }

  /** @returns {((ray: number) => number)|null} */
  sortKey() {
    switch (this.order) {
      case 'range':
        return (ray) => Math.abs(this.range[ray]);
      case 'flux':
        return (ray) => Math.abs(this.flux[ray]);
      case 'class':
        return (ray) => this.class[ray];
      default:
        return null;
    }
  }

  /**
   * Cells and classes of the shown rays of a sensor and a pair of sides, whichever way round, for its
   * picture.
   * @param {number} sensor @param {number} a @param {number} b
   */
  marksOn(sensor, a, b) {
    const pairs = this.pairs.map((pair) => (pair.a === a && pair.b === b) || (pair.a === b && pair.b === a));
    const rays = this.shown.filter((ray) => this.sensor[ray] === sensor && pairs[this.pair[ray]]);
    return {
      cells: rays.map((ray) => this.cell[ray]),
      codes: Uint8Array.from(rays, (ray) => this.class[ray]),
    };
  }

  /**
   * The place of a cell's ray in the shown list; -1 if it is not shown.
   * @param {number} sensor @param {number} cell @param {number} a @param {number} b
   */
  placeOf(sensor, cell, a, b) {
    let fallback = -1;
    for (let row = 0; row < this.shown.length; row += 1) {
      const ray = this.shown[row];
      if (this.sensor[ray] === sensor && this.cell[ray] === cell) {
        const pair = this.pairs[this.pair[ray]];
        if ((pair.a === a && pair.b === b) || (pair.a === b && pair.b === a)) {
          return row;
        }
        fallback = row;
      }
    }
    return fallback;
  }
}

/** Cells of a class other than `agree` that were compared. @param {Uint8Array} codes */
function cellsThatDiffer(codes) {
  let count = 0;
  for (let cell = 0; cell < codes.length; cell += 1) {
    if (codes[cell] !== 0 && codes[cell] !== NO_CODE) {
      count += 1;
    }
  }
  const cells = new Uint32Array(count);
  let at = 0;
  for (let cell = 0; cell < codes.length; cell += 1) {
    if (codes[cell] !== 0 && codes[cell] !== NO_CODE) {
      cells[at] = cell;
      at += 1;
    }
  }
  return cells;
}
