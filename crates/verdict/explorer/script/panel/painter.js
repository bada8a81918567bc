// Pictures of rasters: one canvas pixel for each cell, with the scale it was coloured by.

import { CLASS_LOOKS, MAP_COLOURS, ONE_SIDED_COLOUR, TOO_NEAR_COLOUR, causeLook } from './colour.js';
import { canvasOfPixels, colourTable, faceColour, packedColour, packedHex } from './colour.js';
import { placeOn, scaleOfDifferences, scaleOfValues, statisticsOf } from '../data/limits.js';
import { NOTHING, NO_CODE } from '../data/page_model.js';
import { NO_NAME, ONE_SIDED, SAME_NAME, differenceRaster } from '../data/difference.js';
import { isNamed } from '../data/channels.js';

/** @typedef {import('../data/page_data.js').PageData} PageData */
/** @typedef {import('../data/channels.js').Channel} Channel */
/** @typedef {import('../data/limits.js').ColourScale} ColourScale */
/** @typedef {import('../data/limits.js').ScaleSettings} ScaleSettings */
/** @typedef {import('../data/limits.js').ValueStatistics} ValueStatistics */

/**
 * @typedef {object} Layer
 * @property {HTMLCanvasElement} canvas
 * @property {Uint32Array} pixels packed colours; 0 is transparent
 * @property {ArrayLike<number>|null} values what is written into large cells; null for colours alone
 * @property {ColourScale|null} scale
 * @property {ValueStatistics|null} statistics
 * @property {string} unit
 * @property {'a'|'b'|'difference'|'common'} of
 * @property {Channel} channel
 */

/** Pictures that stay in memory. */
const KEPT_LAYERS = 16;

/** Colours of a raster of differences of names. */
const NAME_COLOURS = { same: '#eceae4', other: '#e69f00' };

export class Painter {
  /** @param {PageData} data */
  constructor(data) {
    this.data = data;
    /** @type {Map<string, Promise<Layer|null>>} */
    this.layers = new Map();
    /** @type {Map<string, ValueStatistics>} */
    this.statistics = new Map();
  }

  /**
   * A picture of a side, of the difference, or of what both have in common. Null if there is nothing to show.
   * @param {number} sensor
   * @param {{a: number, b: number}} sides
   * @param {'a'|'b'|'difference'|'common'} of
   * @param {Channel} channel
   * @param {ScaleSettings} settings
   * @returns {Promise<Layer|null>}
   */
  layer(sensor, sides, of, channel, settings) {
    const { isRobust, isLog, exposure } = settings;
    const key = [sensor, sides.a, sides.b, of, channel.key, isRobust, isLog, exposure].join('/');
    let layer = this.layers.get(key);
    this.layers.delete(key);
    layer ??= this.paint(sensor, sides, of, channel, settings);
    this.layers.set(key, layer);
    for (const oldest of this.layers.keys()) {
      if (this.layers.size <= KEPT_LAYERS) {
        break;
      }
      this.layers.delete(oldest);
    }
    return layer;
  }

  /**
   * @param {number} sensor @param {{a: number, b: number}} sides @param {'a'|'b'|'difference'|'common'} of
   * @param {Channel} channel @param {ScaleSettings} settings
   * @returns {Promise<Layer|null>}
   */
  async paint(sensor, sides, of, channel, settings) {
    if (of === 'common') {
      const values = await this.data.common(sensor, sides.a, sides.b, channel.key);
      return (
        values &&
        this.paintOne(sensor, [values], values, of, channel, settings, `${sensor}/${sides.a}/${sides.b}`)
      );
    }
    if (of === 'difference') {
      const values = await differenceRaster(this.data, sensor, sides.a, sides.b, channel);
      const key = `${sensor}/${sides.a}-${sides.b}`;
      if (!values) {
        return null;
      }
      if (isNamed(channel.drawing)) {
        return this.finish(sensor, namesPixels(values), null, null, null, of, channel);
      }
      const statistics = this.statisticsOf(`${key}/${channel.key}`, values);
      const isAngle = channel.drawing === 'normal';
      const scale = isAngle
        ? scaleOfValues([statistics], settings, false)
        : scaleOfDifferences(statistics, settings);
      const pixels = scaledPixels(values, scale, NaN);
      return this.finish(
        sensor,
        pixels,
        values,
        scale,
        statistics,
        of,
        channel,
        isAngle ? '°' : channel.unit,
      );
    }
    const side = of === 'a' ? sides.a : sides.b;
    if (channel.drawing === 'normal') {
      const axes = await Promise.all(['N.X', 'N.Y', 'N.Z'].map((key) => this.data.raster(sensor, side, key)));
      return axes.every((axis) => axis !== null)
        ? this.finish(sensor, normalPixels(axes), null, null, null, of, channel)
        : null;
    }
    const both = await Promise.all(
      [sides.a, sides.b].map((one) => this.data.raster(sensor, one, channel.key)),
    );
    const values = of === 'a' ? both[0] : both[1];
    const known = both.filter((raster) => raster !== null);
    return (
      values && this.paintOne(sensor, known, values, of, channel, settings, `${sensor}/${sides.a}/${sides.b}`)
    );
  }

  /**
   * @param {number} sensor
   * @param {ArrayLike<number>[]} known rasters that share the scale
   * @param {ArrayLike<number>} values
   * @param {Layer['of']} of @param {Channel} channel @param {ScaleSettings} settings @param {string} key
   */
  paintOne(sensor, known, values, of, channel, settings, key) {
    switch (channel.drawing) {
      case 'faces':
        return this.finish(sensor, facePixels(values), values, null, null, of, channel);
      case 'yes-no':
        return this.finish(sensor, flagPixels(values), values, null, null, of, channel);
      case 'classes': {
        const colours = CLASS_LOOKS.map((look) => packedHex(look.colour));
        return this.finish(
          sensor,
          codePixels(values, (code) => colours[code] ?? 0),
          null,
          null,
          null,
          of,
          channel,
        );
      }
      case 'causes':
        return this.finish(
          sensor,
          codePixels(values, (code) => packedHex(causeLook(code).colour)),
          null,
          null,
          null,
          of,
          channel,
        );
      default: {
        const nothing = channel.key.startsWith('pixel.') ? NOTHING : NaN;
        const all = known.map((raster, k) =>
          this.statisticsOf(`${key}/${channel.key}/${k}`, raster, nothing),
        );
        const isLength = channel.key === 'range.T' || channel.key === 'depth.Z';
        const scale =
          channel.drawing === 'signed'
            ? signedUnitScale(settings)
            : scaleOfValues(all, settings, channel.drawing === 'light', isLength);
        const pixels = scaledPixels(values, scale, nothing, false);
        return this.finish(sensor, pixels, values, scale, all[0], of, channel);
      }
    }
  }

  /** @param {string} key @param {ArrayLike<number>} values @param {number} [nothing] */
  statisticsOf(key, values, nothing = NaN) {
    let known = this.statistics.get(key);
    if (!known) {
      known = statisticsOf(values, nothing);
      this.statistics.set(key, known);
    }
    return known;
  }

  /**
   * @param {number} sensor @param {Uint32Array<ArrayBuffer>} pixels @param {ArrayLike<number>|null} values
   * @param {ColourScale|null} scale @param {ValueStatistics|null} statistics @param {Layer['of']} of
   * @param {Channel} channel @param {string} [unit]
   * @returns {Layer}
   */
  finish(sensor, pixels, values, scale, statistics, of, channel, unit = channel.unit) {
    const { width, height } = this.data.model.sensors[sensor];
    const canvas = canvasOfPixels(pixels, width, height);
    return { canvas, pixels, values, scale, statistics, unit, of, channel };
  }
}

/** Components of normals lie between -1 and 1. @param {ScaleSettings} settings @returns {ColourScale} */
function signedUnitScale(settings) {
  const limit = 1 / 2 ** settings.exposure;
  return { spread: 'signed', low: -limit, high: limit, floor: 0, map: 'blue-red', isClipped: limit < 1 };
}

/**
 * The packed colour of a finite value on a scale.
 * @param {ColourScale} scale
 * @returns {(value: number) => number}
 */
export function coloursOf(scale) {
  const table = colourTable(scale.map);
  const place = placeOn(scale);
  const last = MAP_COLOURS - 1;
  return (value) => {
    const step = Math.round(place(value) * last);
    return table[step < 0 ? 0 : step > last ? last : step];
  };
}

/**
 * @param {ArrayLike<number>} values @param {ColourScale} scale @param {number} nothing
 * @param {boolean} [marksInfinite] whether Infinity is a hit on one side only; else it is no hit
 * @returns {Uint32Array<ArrayBuffer>}
 */
function scaledPixels(values, scale, nothing, marksInfinite = true) {
  const pixels = new Uint32Array(values.length);
  const colourOf = coloursOf(scale);
  const [oneSided, tooNear] = [ONE_SIDED_COLOUR, TOO_NEAR_COLOUR].map(packedHex);
  for (let cell = 0; cell < pixels.length; cell += 1) {
    const value = values[cell];
    if (!(value < Infinity && value > -Infinity) || value === nothing) {
      pixels[cell] = value === -Infinity ? tooNear : marksInfinite && value === Infinity ? oneSided : 0;
      continue;
    }
    pixels[cell] = colourOf(value);
  }
  return pixels;
}

/** @param {ArrayLike<number>} codes */
function namesPixels(codes) {
  const [same, other, oneSided] = [NAME_COLOURS.same, NAME_COLOURS.other, ONE_SIDED_COLOUR].map(packedHex);
  return codePixels(
    codes,
    (code) => (code === SAME_NAME ? same : code === ONE_SIDED ? oneSided : other),
    NO_NAME,
  );
}

/** @param {ArrayLike<number>} values @param {(code: number) => number} colourOf @param {number} [none] */
function codePixels(values, colourOf, none = NO_CODE) {
  const pixels = new Uint32Array(values.length);
  const colours = Uint32Array.from({ length: 256 }, (_, code) => (code === none ? 0 : colourOf(code)));
  for (let cell = 0; cell < pixels.length; cell += 1) {
    pixels[cell] = colours[values[cell]];
  }
  return pixels;
}

/** @param {ArrayLike<number>} faces */
function facePixels(faces) {
  const pixels = new Uint32Array(faces.length);
  for (let cell = 0; cell < pixels.length; cell += 1) {
    pixels[cell] = faces[cell] === NOTHING ? 0 : faceColour(faces[cell]);
  }
  return pixels;
}

/** @param {ArrayLike<number>} flags */
function flagPixels(flags) {
  return codePixels(flags, (flag) => packedHex(flag === 0 ? '#3d4451' : '#f2d16b'));
}

/** @param {(ArrayLike<number>|null)[]} axes */
function normalPixels(axes) {
  const [x, y, z] = /** @type {ArrayLike<number>[]} */ (axes);
  const pixels = new Uint32Array(x.length);
  for (let cell = 0; cell < pixels.length; cell += 1) {
    if (x[cell] === x[cell]) {
      pixels[cell] = packedColour(
        Math.round(127.5 + 127.5 * x[cell]),
        Math.round(127.5 + 127.5 * y[cell]),
        Math.round(127.5 + 127.5 * z[cell]),
      );
    }
  }
  return pixels;
}
