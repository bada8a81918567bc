// The elevation map at any frame, replayed from its changes.
//
// Each change keeps what was in its cell before. So the way back is as fast as the way forward, and no copies of
// the whole map are needed.

/** @typedef {import('./model.js').DriveRecord} DriveRecord */

/** Cells along a side of a tile. Only tiles that ever had a known cell are in memory. */
const TILE_SIDE = 64;
const TILE_CELLS = TILE_SIDE * TILE_SIDE;

/** Cell of which nothing was ever known. */
export const NO_SLOT = -1;

export class MapReplay {
  /** @param {DriveRecord} record */
  constructor(record) {
    this.record = record;
    /** @type {Map<number, number>} */
    this.tileOfKey = new Map();
    /** Tile coordinates, two numbers each tile. @type {number[]} */
    this.tilePlaces = [];
    const changes = record.i.length;
    /** Slot of the cell of each change. */
    this.slots = new Int32Array(changes);
    this.#placeChanges();
    const size = this.tilePlaces.length / 2 * TILE_CELLS;
    this.slotCount = size;
    /** Elevation of each slot, metres in the scene frame. */
    this.elevation = new Float32Array(size).fill(NaN);
    /** Source of each slot; 0 is unknown. */
    this.source = new Uint8Array(size);
    /** Frame of the last change of each slot. */
    this.since = new Uint16Array(size);
    this.oldElevation = new Float32Array(changes);
    this.oldSource = new Uint8Array(changes);
    this.oldSince = new Uint16Array(changes);
    /** Number of known cells in each frame, by source. @type {Uint32Array[]} */
    this.known = [1, 2, 3].map(() => new Uint32Array(record.count));
    /** The frame that is replayed now; -1: before the first one. */
    this.frame = -1;
    this.#playOnce();
  }

  #placeChanges() {
    const { i, j } = this.record;
    let [lastI, lastJ, lastTile] = [NaN, NaN, 0];
    for (let change = 0; change < this.slots.length; change += 1) {
      const tileI = Math.floor(i[change] / TILE_SIDE);
      const tileJ = Math.floor(j[change] / TILE_SIDE);
      if (tileI !== lastI || tileJ !== lastJ) {
        lastTile = this.#tileAt(tileI, tileJ);
        [lastI, lastJ] = [tileI, tileJ];
      }
      this.slots[change] = lastTile * TILE_CELLS + cellInTile(i[change], j[change], tileI, tileJ);
    }
  }

  /** @param {number} tileI @param {number} tileJ */
  #tileAt(tileI, tileJ) {
    const key = tileKey(tileI, tileJ);
    let tile = this.tileOfKey.get(key);
    if (tile === undefined) {
      tile = this.tilePlaces.length / 2;
      this.tilePlaces.push(tileI, tileJ);
      this.tileOfKey.set(key, tile);
    }
    return tile;
  }

  /** Plays all frames, and counts known cells on the way. */
  #playOnce() {
    const now = [0, 0, 0, 0];
    for (let frame = 0; frame < this.record.count; frame += 1) {
      this.#forward(frame, now);
      for (let source = 1; source <= 3; source += 1) {
        this.known[source - 1][frame] = now[source];
      }
    }
    this.frame = this.record.count - 1;
  }

  /** @param {number} frame @param {number[]} [counts] cells of each source, kept up to date */
  #forward(frame, counts) {
    const { first, elevation, source } = this.record;
    for (let change = first[frame]; change < first[frame + 1]; change += 1) {
      const slot = this.slots[change];
      this.oldElevation[change] = this.elevation[slot];
      this.oldSource[change] = this.source[slot];
      this.oldSince[change] = this.since[slot];
      if (counts) {
        counts[this.source[slot]] -= 1;
        counts[source[change]] += 1;
      }
      this.elevation[slot] = elevation[change];
      this.source[slot] = source[change];
      this.since[slot] = frame;
    }
  }

  /** @param {number} frame */
  #backward(frame) {
    const { first } = this.record;
    for (let change = first[frame + 1] - 1; change >= first[frame]; change -= 1) {
      const slot = this.slots[change];
      this.elevation[slot] = this.oldElevation[change];
      this.source[slot] = this.oldSource[change];
      this.since[slot] = this.oldSince[change];
    }
  }

  /** Makes the map what it was after a frame. @param {number} frame */
  goTo(frame) {
    const wanted = Math.max(-1, Math.min(frame, this.record.count - 1));
    while (this.frame < wanted) {
      this.frame += 1;
      this.#forward(this.frame);
    }
    while (this.frame > wanted) {
      this.#backward(this.frame);
      this.frame -= 1;
    }
  }

  /** Slot of a cell, or `NO_SLOT`. @param {number} i @param {number} j */
  slotOf(i, j) {
    const tileI = Math.floor(i / TILE_SIDE);
    const tileJ = Math.floor(j / TILE_SIDE);
    const tile = this.tileOfKey.get(tileKey(tileI, tileJ));
    return tile === undefined ? NO_SLOT : tile * TILE_CELLS + cellInTile(i, j, tileI, tileJ);
  }

  /** Cell of a slot. @param {number} slot @returns {[number, number]} */
  cellOfSlot(slot) {
    const tile = Math.floor(slot / TILE_CELLS);
    const within = slot - tile * TILE_CELLS;
    const row = Math.floor(within / TILE_SIDE);
    const [tileI, tileJ] = [this.tilePlaces[2 * tile], this.tilePlaces[2 * tile + 1]];
    return [tileI * TILE_SIDE + within - row * TILE_SIDE, tileJ * TILE_SIDE + row];
  }

  /** Scene x and y of a cell's grid point. @param {number} i @param {number} j @returns {[number, number]} */
  placeOf(i, j) {
    const { mapOrigin, spacing } = this.record;
    return [mapOrigin[0] + spacing * i, mapOrigin[1] + spacing * j];
  }

  /** The cell whose grid point is nearest to a place. @param {number} x @param {number} y
   * @returns {[number, number]} */
  cellAt(x, y) {
    const { mapOrigin, spacing } = this.record;
    return [Math.round((x - mapOrigin[0]) / spacing), Math.round((y - mapOrigin[1]) / spacing)];
  }

  /**
   * Slots of every `step`-th cell of a rectangle, row by row; `NO_SLOT` where nothing was ever known.
   * @param {number} left first i @param {number} bottom first j @param {number} columns @param {number} rows
   * @param {number} step
   */
  slotsIn(left, bottom, columns, rows, step) {
    const slots = new Int32Array(columns * rows);
    let at = 0;
    for (let row = 0; row < rows; row += 1) {
      const j = bottom + row * step;
      const tileJ = Math.floor(j / TILE_SIDE);
      const inRow = (j - tileJ * TILE_SIDE) * TILE_SIDE;
      let [lastI, base] = [NaN, NO_SLOT];
      for (let column = 0; column < columns; column += 1) {
        const i = left + column * step;
        const tileI = Math.floor(i / TILE_SIDE);
        if (tileI !== lastI) {
          const tile = this.tileOfKey.get(tileKey(tileI, tileJ));
          base = tile === undefined ? NO_SLOT : tile * TILE_CELLS + inRow;
          lastI = tileI;
        }
        slots[at] = base === NO_SLOT ? NO_SLOT : base + i - tileI * TILE_SIDE;
        at += 1;
      }
    }
    return slots;
  }

  /** Lowest and highest cell that was ever known: left, bottom, right, top; null if there is none. */
  extent() {
    if (this.tilePlaces.length === 0) {
      return null;
    }
    const { i, j } = this.record;
    let [left, bottom, right, top] = [Infinity, Infinity, -Infinity, -Infinity];
    for (let change = 0; change < this.slots.length; change += 1) {
      left = Math.min(left, i[change]);
      right = Math.max(right, i[change]);
      bottom = Math.min(bottom, j[change]);
      top = Math.max(top, j[change]);
    }
    return { left, bottom, right, top };
  }
}

/** @param {number} i @param {number} j @param {number} tileI @param {number} tileJ */
function cellInTile(i, j, tileI, tileJ) {
  return (j - tileJ * TILE_SIDE) * TILE_SIDE + (i - tileI * TILE_SIDE);
}

/** @param {number} tileI @param {number} tileJ */
function tileKey(tileI, tileJ) {
  return (tileJ + 2 ** 25) * 2 ** 26 + (tileI + 2 ** 25);
}
