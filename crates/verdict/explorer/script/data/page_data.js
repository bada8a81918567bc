// The numbers behind the page: rasters and single values of every channel, computed when asked for.

import { FacePlanes, derivedRaster, derivedReader, missingValue } from './derive.js';
import { putRecordedBits, rayOfCell } from './derive.js';
import { commonRaster } from './common_rasters.js';

/** @typedef {import('./container.js').Container} Container */
/** @typedef {import('./container.js').NumberArray} NumberArray */
/** @typedef {import('./page_model.js').PageModel} PageModel */
/** @typedef {import('./page_model.js').SensorPairModel} SensorPairModel */
/** @typedef {import('./page_model.js').DescribedRay} DescribedRay */
/** @typedef {Float32Array|Uint32Array|Uint8Array} Raster */

/** Large rasters that stay in memory beyond those in use. */
const KEPT_RASTERS = 32;

export class PageData {
  /** @param {PageModel} model @param {Container} container */
  constructor(model, container) {
    this.model = model;
    this.container = container;
    /** @type {Map<string, {promise: Promise<Raster|null>, raster: Raster|null}>} */
    this.rasters = new Map();
    /** @type {Promise<FacePlanes|null>|null} */
    this.planesPromise = null;
    /** @type {Promise<Map<string, DescribedRay>>|null} */
    this.described = null;
  }

  /** Planes of the faces; null without a mesh. */
  planes() {
    this.planesPromise ??= this.readPlanes();
    return this.planesPromise;
  }

  async readPlanes() {
    const mesh = this.model.mesh;
    if (!mesh) {
      return null;
    }
    const [vertices, faces] = await Promise.all([
      this.container.decode(mesh.vertices),
      this.container.decode(mesh.faces),
    ]);
    return new FacePlanes(/** @type {Float32Array} */ (vertices), /** @type {Uint32Array} */ (faces));
  }

  /** @param {number} sensorIndex @param {number} cell */
  ray(sensorIndex, cell) {
    return rayOfCell(this.model.sensors[sensorIndex], cell);
  }

  /** @param {number} sensorIndex @param {number} sideIndex @param {string} channel */
  entry(sensorIndex, sideIndex, channel) {
    return this.model.sensors[sensorIndex].sides?.[sideIndex]?.channels[channel] ?? null;
  }

  /**
   * Whether a side gives a channel.
   * @param {number} sensorIndex @param {number} sideIndex @param {string} channel
   */
  has(sensorIndex, sideIndex, channel) {
    if (channel === 'N.RGB') {
      return ['N.X', 'N.Y', 'N.Z'].every((axis) => this.entry(sensorIndex, sideIndex, axis) !== null);
    }
    return (
      this.entry(sensorIndex, sideIndex, channel) !== null ||
      (channel === 'flux.V' && this.beamChannels(sensorIndex, sideIndex).length > 0)
    );
  }

  /** The flux of each beam on the camera's image. @param {number} sensorIndex @param {number} sideIndex */
  beamChannels(sensorIndex, sideIndex) {
    const channels = this.model.sensors[sensorIndex].sides?.[sideIndex]?.channels ?? {};
    return Object.keys(channels).filter((key) => key.startsWith('flux.beam'));
  }

  /**
   * All cells of a channel of a side; null if the side does not give it.
   * @param {number} sensorIndex @param {number} sideIndex @param {string} channel
   * @returns {Promise<Raster|null>}
   */
  raster(sensorIndex, sideIndex, channel) {
    return this.kept(`${sensorIndex}/${sideIndex}/${channel}`, () =>
      this.readRaster(sensorIndex, sideIndex, channel),
    );
  }

  /**
   * A raster that is in memory already.
   * @param {number} sensorIndex @param {number} sideIndex @param {string} channel
   */
  peek(sensorIndex, sideIndex, channel) {
    return this.rasters.get(`${sensorIndex}/${sideIndex}/${channel}`)?.raster ?? null;
  }

  /**
   * @param {string} key
   * @param {() => Promise<Raster|null>} read
   */
  kept(key, read) {
    const known = this.rasters.get(key);
    if (known) {
      // Last used, last forgotten.
      this.rasters.delete(key);
      this.rasters.set(key, known);
      return known.promise;
    }
    const slot = { promise: read(), raster: /** @type {Raster|null} */ (null) };
    slot.promise.then(
      (raster) => {
        slot.raster = raster;
      },
      () => {
        this.rasters.delete(key);
      },
    );
    this.rasters.set(key, slot);
    for (const oldest of this.rasters.keys()) {
      if (this.rasters.size <= KEPT_RASTERS) {
        break;
      }
      this.rasters.delete(oldest);
    }
    return slot.promise;
  }

  /**
   * @param {number} sensorIndex @param {number} sideIndex @param {string} channel
   * @returns {Promise<Raster|null>}
   */
  async readRaster(sensorIndex, sideIndex, channel) {
    const entry = this.entry(sensorIndex, sideIndex, channel);
    if (!entry) {
      return channel === 'flux.V' ? this.sumOfBeams(sensorIndex, sideIndex) : null;
    }
    if ('stored' in entry) {
      return /** @type {Raster} */ (await this.container.decode(entry.stored));
    }
    const parts = await this.derivedParts(sensorIndex, sideIndex, entry.derived);
    if (!parts) {
      return null;
    }
    const { sensor, planes, faces, cells, bits } = parts;
    const known = await this.knownSide(sensorIndex, sideIndex, channel);
    const values = derivedRaster(sensor, planes, faces, channel, known);
    putRecordedBits(values, cells, bits);
    return values;
  }

  /**
   * From what a derived channel is computed; null without faces.
   * @param {number} sensorIndex @param {number} sideIndex
   * @param {{cells: import('./container.js').ArrayReference, bits: import('./container.js').ArrayReference}} derived
   */
  async derivedParts(sensorIndex, sideIndex, derived) {
    const [planes, faces, cells, bits] = await Promise.all([
      this.planes(),
      this.raster(sensorIndex, sideIndex, 'face.I'),
      this.container.decode(derived.cells),
      this.container.decode(derived.bits),
    ]);
    const words = (/** @type {unknown} */ array) => /** @type {Uint32Array} */ (array);
    return planes && faces
      ? { sensor: this.model.sensors[sensorIndex], planes, faces: words(faces), cells: words(cells), bits: words(bits) }
      : null;
  }

  /**
   * Another side whose raster of a derived channel is computed already, or is being computed. Most faces are
   * the same.
   * @param {number} sensorIndex @param {number} sideIndex @param {string} channel
   * @returns {Promise<import('./derive.js').KnownSide|null>}
   */
  async knownSide(sensorIndex, sideIndex, channel) {
    for (let other = 0; other < this.model.sides.length; other += 1) {
      const entry = this.entry(sensorIndex, other, channel);
      const slot = this.rasters.get(`${sensorIndex}/${other}/${channel}`);
      // Only earlier sides are waited for, so that no two sides wait for each other.
      if (other !== sideIndex && entry && 'derived' in entry && slot && (slot.raster || other < sideIndex)) {
        const [values, faces, cells] = await Promise.all([
          slot.promise,
          this.raster(sensorIndex, other, 'face.I'),
          this.container.decode(entry.derived.cells),
        ]);
        if (values instanceof Float32Array && faces instanceof Uint32Array) {
          return { values, faces, cells: /** @type {Uint32Array} */ (cells) };
        }
      }
    }
    return null;
  }

  /** @param {number} sensorIndex @param {number} sideIndex */
  async sumOfBeams(sensorIndex, sideIndex) {
    const channels = this.beamChannels(sensorIndex, sideIndex);
    if (channels.length === 0) {
      return null;
    }
    const beams = await Promise.all(channels.map((key) => this.raster(sensorIndex, sideIndex, key)));
    const { width, height } = this.model.sensors[sensorIndex];
    const sum = new Float32Array(width * height);
    for (const beam of beams) {
      if (!beam) {
        continue;
      }
      for (let cell = 0; cell < sum.length; cell += 1) {
        sum[cell] += beam[cell];
      }
    }
    return sum;
  }

  /**
   * The recorded number of one cell, without computing the whole raster; NaN if the side does not give it.
   * @param {number} sensorIndex @param {number} sideIndex @param {string} channel @param {number} cell
   * @returns {Promise<number>}
   */
  async value(sensorIndex, sideIndex, channel, cell) {
    return (await this.reader(sensorIndex, sideIndex, channel))(cell);
  }

  /**
   * A function that gives the recorded number of any cell.
   * @param {number} sensorIndex @param {number} sideIndex @param {string} channel
   * @returns {Promise<(cell: number) => number>}
   */
  async reader(sensorIndex, sideIndex, channel) {
    const known = this.peek(sensorIndex, sideIndex, channel);
    const entry = this.entry(sensorIndex, sideIndex, channel);
    if (known || !entry || 'stored' in entry) {
      const raster = known ?? (await this.raster(sensorIndex, sideIndex, channel));
      return (cell) => raster?.[cell] ?? NaN;
    }
    const parts = await this.derivedParts(sensorIndex, sideIndex, entry.derived);
    if (!parts) {
      return () => missingValue(channel);
    }
    const { sensor, planes, faces, cells, bits } = parts;
    const derive = derivedReader(sensor, planes, faces, channel);
    const recorded = new Float32Array(bits.buffer, bits.byteOffset, bits.length);
    return (cell) => {
      const fixed = cells.length === 0 ? -1 : placeOfCell(cells, cell);
      return fixed >= 0 ? recorded[fixed] : Math.fround(derive(cell));
    };
  }

  /**
   * The pair of two sides on a sensor, and whether its order is the other way round.
   * @param {number} sensorIndex @param {number} a @param {number} b
   * @returns {{pair: SensorPairModel, index: number, isTurned: boolean}|null}
   */
  pairOf(sensorIndex, a, b) {
    const pairs = this.model.sensors[sensorIndex].pairs ?? [];
    const index = pairs.findIndex((pair) => (pair.a === a && pair.b === b) || (pair.a === b && pair.b === a));
    return index < 0 ? null : { pair: pairs[index], index, isTurned: pairs[index].a !== a };
  }

  /**
   * What belongs to a pair or to the sensor alone: `class`, `cause`, `share`, `margin.face`, ...
   * @param {number} sensorIndex @param {number} a @param {number} b @param {string} channel
   * @returns {Promise<Raster|null>}
   */
  common(sensorIndex, a, b, channel) {
    const pair = this.pairOf(sensorIndex, a, b)?.index ?? -1;
    return this.kept(`${sensorIndex}/pair ${pair}/${channel}`, () =>
      commonRaster(this, sensorIndex, pair, channel),
    );
  }

  /** The rays that the page describes in full, by `sensor/cell/pair`. */
  describedRays() {
    this.described ??= this.readDescribed();
    return this.described;
  }

  async readDescribed() {
    /** @type {Map<string, DescribedRay>} */
    const byPlace = new Map();
    if (this.model.rays) {
      const bytes = /** @type {Uint8Array} */ (await this.container.decode(this.model.rays));
      /** @type {DescribedRay[]} */
      const rays = JSON.parse(new TextDecoder().decode(bytes));
      for (const ray of rays) {
        byPlace.set(`${ray.sensor}/${ray.cell}/${ray.pair ?? 0}`, ray);
      }
    }
    return byPlace;
  }
}

/**
 * The place of a cell in an ascending list; -1 if it is not in it.
 * @param {ArrayLike<number>} cells
 * @param {number} cell
 */
export function placeOfCell(cells, cell) {
  let low = 0;
  let high = cells.length - 1;
  while (low <= high) {
    const middle = (low + high) >> 1;
    if (cells[middle] === cell) {
      return middle;
    }
    if (cells[middle] < cell) {
      low = middle + 1;
    } else {
      high = middle - 1;
    }
  }
  return -1;
}
