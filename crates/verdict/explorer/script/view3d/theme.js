// The colours of the 3-D panel: those of the page's style, and the colour of each face of the terrain.

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

/** Viridis at nine even steps: dark is low, bright is high, also for colour-blind people. */
const RAMP_STOPS = [
  [68, 1, 84],
  [71, 44, 122],
  [59, 81, 139],
  [44, 113, 142],
  [33, 144, 141],
  [39, 173, 129],
  [92, 200, 99],
  [170, 220, 50],
  [253, 231, 37],
];

/**
 * Reads the colours in force on an element.
 * @param {Element} host
 * @returns {{colours: Record<ColourName, Rgb3>, isDark: boolean}}
 */
export function readTheme(host) {
  const style = getComputedStyle(host);
  const colours = /** @type {Record<ColourName, Rgb3>} */ ({});
  for (const name of VIEW3D_COLOURS) colours[name] = parseHex(style.getPropertyValue(`--view3d-${name}`));
  const [r, g, b] = colours.sky;
  return { colours, isDark: 0.2 * r + 0.7 * g + 0.1 * b < 0.5 };
}

/** `#rgb` or `#rrggbb`; grey for anything else. @param {string} text @returns {Rgb3} */
function parseHex(text) {
  const digits = text.trim().replace(/^#/, '');
  const long = digits.length === 3 ? [...digits].map((digit) => digit + digit).join('') : digits;
  if (!/^[0-9a-fA-F]{6}$/.test(long)) return [0.5, 0.5, 0.5];
  const part = (/** @type {number} */ at) => parseInt(long.slice(at, at + 2), 16) / 255;
  return [part(0), part(2), part(4)];
}

/** A colour as text for a style. @param {Rgb3} colour @param {number} [opacity] */
export function cssOfColour(colour, opacity = 1) {
  const [r, g, b] = colour.map((value) => Math.round(255 * value));
  return `rgb(${r} ${g} ${b} / ${opacity})`;
}

/** The ramp as 256 colours of four bytes. @returns {Uint8Array} */
export function rampColours() {
  const bytes = new Uint8Array(4 * 256);
  for (let k = 0; k < 256; k++) {
    const place = (k / 255) * (RAMP_STOPS.length - 1);
    const stop = Math.min(Math.floor(place), RAMP_STOPS.length - 2);
    for (let axis = 0; axis < 3; axis++) {
      const [low, high] = [RAMP_STOPS[stop][axis], RAMP_STOPS[stop + 1][axis]];
      bytes[4 * k + axis] = Math.round(low + (high - low) * (place - stop));
    }
    bytes[4 * k + 3] = 255;
  }
  return bytes;
}

/** The ramp as a gradient of a style, low at the left. */
export function rampGradient() {
  return `linear-gradient(90deg, ${RAMP_STOPS.map((stop) => `rgb(${stop.join(' ')})`).join(', ')})`;
}

/**
 * Colour of a material.
 * @param {Record<ColourName, Rgb3>} colours
 * @param {number} material
 * @returns {Rgb3}
 */
export function colourOfMaterial(colours, material) {
  const names = /** @type {const} */ ([
    'ground-0',
    'ground-1',
    'ground-2',
    'ground-3',
    'ground-4',
    'ground-5',
  ]);
  return colours[names[material % names.length]];
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
    return ((255 << 24) | (b << 16) | (g << 8) | r) >>> 0;
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
