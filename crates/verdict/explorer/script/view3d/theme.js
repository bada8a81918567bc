// The colours of the 3-D panel: those of the page's style, and the colour of each face of the terrain.

import { MAP_COLOURS, colourTable, hexOfStyle, packedColour, sharesOfHex } from '../panel/colour.js';

/** @typedef {[number, number, number]} Rgb3 numbers of 0 to 1 */
/** @typedef {import('./terrain.js').Terrain} Terrain */

/** Names of the colours, each a custom property `--view3d-NAME` of view3d.css. */
const VIEW3D_COLOURS = /** @type {const} */ ([
  'sky',
  'ink',
  'paper',
  'soft',
  'a',
  'b',
  'exact',
  'witness',
  'seen',
  'blocked',
  'camera',
  'beam-0',
  'beam-1',
  'beam-2',
  'grid',
  'back',
  'axis-x',
  'axis-y',
  'axis-z',
  'ground-0',
  'ground-1',
  'ground-2',
  'ground-3',
  'ground-4',
  'ground-5',
]);

/** @typedef {typeof VIEW3D_COLOURS[number]} ColourName */

/**
 * Reads the colours in force on an element.
 * @param {Element} host
 * @returns {{colours: Record<ColourName, Rgb3>, isDark: boolean}}
 */
export function readTheme(host) {
  const style = getComputedStyle(host);
  const colours = /** @type {Record<ColourName, Rgb3>} */ ({});
  for (const name of VIEW3D_COLOURS) colours[name] = sharesOfHex(hexOfStyle(style, `--view3d-${name}`));
  const [r, g, b] = colours.sky;
  return { colours, isDark: 0.2 * r + 0.7 * g + 0.1 * b < 0.5 };
}

/** A colour as text for a style. @param {Rgb3} colour @param {number} [opacity] */
export function cssOfColour(colour, opacity = 1) {
  const [r, g, b] = colour.map((value) => Math.round(255 * value));
  return `rgb(${r} ${g} ${b} / ${opacity})`;
}

/** The colours of heights and slopes, viridis, as 256 colours of four bytes. */
export function rampColours() {
  const table = colourTable('viridis');
  const ramp = Uint32Array.from({ length: 256 }, (_, k) => table[Math.round((k / 255) * (MAP_COLOURS - 1))]);
  return new Uint8Array(ramp.buffer);
}

/**
 * Colour of a material.
 * @param {Record<ColourName, Rgb3>} colours
 * @param {number} material
 * @returns {Rgb3}
 */
export function colourOfMaterial(colours, material) {
  const name = /** @type {ColourName} */ (`ground-${material % 6}`);
  return colours[name];
}

/**
 * The colour of each face, for the graphics processor: bytes R, G, B, 255 as one word.
 * @param {Terrain} terrain
 * @param {'material' | 'face'} by
 * @param {Record<ColourName, Rgb3>} colours
 * @returns {Uint32Array}
 */
export function coloursOfFaces(terrain, by, colours) {
  const words = new Uint32Array(terrain.faceCount);
  const word = (/** @type {number[]} */ colour) => {
    const [r, g, b] = colour.map((value) => Math.round(255 * value));
    return packedColour(r, g, b);
  };
  if (by === 'material') {
    const palette = Array.from({ length: 6 }, (_, material) => word(colourOfMaterial(colours, material)));
    for (let face = 0; face < words.length; face++) words[face] = palette[(terrain.materials[face] ?? 0) % 6];
    return words;
  }
  // Neighbouring numbers get unlike hues: multiples of the golden ratio never come back to where they were.
  const wheel = Array.from({ length: 64 }, (_, k) => {
    const hue = (k / 64) * 2 * Math.PI;
    const light = 0.62 + 0.1 * Math.cos(7 * hue);
    return word([0, 2, 4].map((third) => light + 0.13 * Math.cos(hue + (third * Math.PI) / 3)));
  });
  for (let face = 0; face < words.length; face++)
    words[face] = wheel[Math.floor(((face * 0.6180339887) % 1) * 64)];
  return words;
}
