// Colours of pictures. All maps are even to the eye and can be told apart by colour-blind people.

/** @typedef {[number, number, number]} Rgb */

/** Viridis: dark is low, bright is high. Eight even steps. */
const VIRIDIS = [
  '#440154',
  '#472d7b',
  '#3b528b',
  '#2c728e',
  '#21918c',
  '#28ae80',
  '#5ec962',
  '#addc30',
  '#fde725',
];
/** Inferno: black is no light. */
const INFERNO = [
  '#000004',
  '#1f0c48',
  '#550f6d',
  '#88226a',
  '#ba3655',
  '#e35933',
  '#f98c0a',
  '#f9c932',
  '#fcffa4',
];
/** Blue is below zero, near white is zero, red is above. */
const BLUE_RED = [
  '#053061',
  '#2166ac',
  '#4393c3',
  '#92c5de',
  '#d1e5f0',
  '#f7f7f7',
  '#fddbc7',
  '#f4a582',
  '#d6604d',
  '#b2182b',
  '#67001f',
];

/** A hit on one side only. */
export const ONE_SIDED_COLOUR = '#ff00e6';

/** What is nearer than a sensor's shortest range. */
export const TOO_NEAR_COLOUR = '#2e3038';

/** Colour, letter and outline of each class, in the order of the classes. */
export const CLASS_LOOKS = [
  { colour: '#d8d6d0', letter: '', shape: 'none' },
  { colour: '#56b4e9', letter: 'T', shape: 'circle' },
  { colour: '#009e73', letter: 'R', shape: 'diamond' },
  { colour: '#e69f00', letter: 'A', shape: 'triangle' },
  { colour: '#cc79a7', letter: 'U', shape: 'square' },
  { colour: '#d73027', letter: 'D', shape: 'cross' },
];

/** Colours of causes, one after the other. */
const CAUSE_COLOURS = [
  '#e69f00',
  '#56b4e9',
  '#009e73',
  '#f0e442',
  '#0072b2',
  '#d55e00',
  '#cc79a7',
  '#999999',
];

/** @param {number} cause index */
export function causeLook(cause) {
  return {
    colour: CAUSE_COLOURS[cause % CAUSE_COLOURS.length],
    letter: String.fromCharCode(97 + (cause % 26)),
  };
}

/** @param {string} hex `#rrggbb` @returns {Rgb} */
function rgbOfHex(hex) {
  const bits = Number.parseInt(hex.slice(1), 16);
  return [bits >> 16, (bits >> 8) & 255, bits & 255];
}

/** A colour as shares of 0 to 1, for WebGL. @param {string} hex `#rrggbb` @returns {Rgb} */
export function sharesOfHex(hex) {
  const [r, g, b] = rgbOfHex(hex);
  return [r / 255, g / 255, b / 255];
}

/** A colour of a style: `#rrggbb`; grey for anything else. @param {CSSStyleDeclaration} style @param {string} name */
export function hexOfStyle(style, name) {
  const text = style.getPropertyValue(name).trim();
  return /^#[0-9a-fA-F]{6}$/.test(text) ? text : '#808080';
}

/**
 * A colour as canvases store it: little endian, red in the lowest byte.
 * @param {number} r
 * @param {number} g
 * @param {number} b
 */
export function packedColour(r, g, b) {
  return (0xff000000 | (b << 16) | (g << 8) | r) >>> 0;
}

/** @param {string} hex */
export function packedHex(hex) {
  const [r, g, b] = rgbOfHex(hex);
  return packedColour(r, g, b);
}

/**
 * A canvas with a pixel for each packed colour.
 * @param {Uint32Array<ArrayBuffer>} pixels @param {number} width @param {number} height
 */
export function canvasOfPixels(pixels, width, height) {
  const canvas = document.createElement('canvas');
  canvas.width = width;
  canvas.height = height;
  const image = new ImageData(new Uint8ClampedArray(pixels.buffer), width, height);
  canvas.getContext('2d')?.putImageData(image, 0, 0);
  return canvas;
}

/** @typedef {'viridis'|'inferno'|'blue-red'} ColourMapName */

/** @type {Record<ColourMapName, string[]>} */
const COLOUR_STOPS = { viridis: VIRIDIS, inferno: INFERNO, 'blue-red': BLUE_RED };

/** Number of colours of a map. Odd, so that zero has a colour of its own. */
export const MAP_COLOURS = 1025;

/** @type {Map<ColourMapName, Uint32Array>} */
const colourTables = new Map();

/**
 * A colour map as a table of `MAP_COLOURS` packed colours.
 * @param {ColourMapName} name
 */
export function colourTable(name) {
  let table = colourTables.get(name);
  if (!table) {
    const stops = COLOUR_STOPS[name].map(rgbOfHex);
    table = new Uint32Array(MAP_COLOURS);
    for (let k = 0; k < MAP_COLOURS; k += 1) {
      const place = (k / (MAP_COLOURS - 1)) * (stops.length - 1);
      const stop = Math.min(Math.floor(place), stops.length - 2);
      const mixed = stops[stop].map((from, c) =>
        Math.round(from + (stops[stop + 1][c] - from) * (place - stop)),
      );
      table[k] = packedColour(mixed[0], mixed[1], mixed[2]);
    }
    colourTables.set(name, table);
  }
  return table;
}

/**
 * The map as a CSS gradient from left to right.
 * @param {ColourMapName} name
 */
export function gradientOf(name) {
  return `linear-gradient(to right, ${COLOUR_STOPS[name].join(', ')})`;
}

/**
 * A colour that only tells faces apart: neighbouring numbers get unlike hues.
 * @param {number} face
 */
export function faceColour(face) {
  const mixed = Math.imul(face + 1, 0x9e3779b1) >>> 0;
  const hue = mixed / 4294967296;
  const light = 0.42 + 0.36 * (((Math.imul(face + 7, 0x85ebca6b) >>> 16) & 255) / 255);
  return hslColour(hue, 0.5, light);
}

/** @param {number} hue 0 to 1 @param {number} saturation @param {number} light */
function hslColour(hue, saturation, light) {
  const chroma = saturation * Math.min(light, 1 - light);
  /** @param {number} shift */
  const part = (shift) => {
    const k = (shift + hue * 12) % 12;
    return Math.round(255 * (light - chroma * Math.max(-1, Math.min(k - 3, 9 - k, 1))));
  };
  return packedColour(part(0), part(8), part(4));
}

/** Ink that can be read on a packed colour. @param {number} packed */
export function inkOn(packed) {
  const linear = [packed & 255, (packed >> 8) & 255, (packed >> 16) & 255].map((part) => (part / 255) ** 2.2);
  return 0.2126 * linear[0] + 0.7152 * linear[1] + 0.0722 * linear[2] > 0.18 ? '#000000' : '#ffffff';
}
