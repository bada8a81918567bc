// Numbers as words: lengths in metres with fitting units, counts, and round steps of scales.

const LENGTH_UNITS = /** @type {const} */ ([
  [1e3, 'km'],
  [1, 'm'],
  [1e-2, 'cm'],
  [1e-3, 'mm'],
  [1e-6, 'µm'],
  [1e-9, 'nm'],
  [1e-12, 'pm'],
  [1e-15, 'fm'],
]);

/**
 * A number with so many significant digits, without needless zeros and without an exponent where possible.
 * @param {number} value
 * @param {number} digits
 */
export function digitsOf(value, digits) {
  if (!Number.isFinite(value)) return String(value);
  const text = Number(value.toPrecision(digits));
  const size = Math.abs(text);
  return size !== 0 && (size < 1e-4 || size >= 1e7) ? text.toExponential() : String(text);
}

/**
 * A small length or a difference, in a unit that leaves one to three digits before the point.
 * @param {number} metres
 * @param {number} [digits]
 */
export function lengthInWords(metres, digits = 3) {
  const size = Math.abs(metres);
  if (size === 0) return '0 m';
  if (!Number.isFinite(metres)) return 'infinitely far';
  const entry = LENGTH_UNITS.find(([unit, name]) => name !== 'cm' && size >= unit * 0.9995) ?? [1e-15, 'fm'];
  return `${digitsOf(metres / entry[0], digits)} ${entry[1]}`;
}

/**
 * A range in metres, to a tenth of a millimetre, or to so many places that ranges of this difference look
 * different.
 * @param {number} metres
 * @param {number} [difference] metres; 0: none
 */
export function rangeInWords(metres, difference = 0) {
  if (!Number.isFinite(metres)) return 'no range';
  const needed = difference > 0 ? Math.ceil(1 - Math.log10(difference)) : 4;
  const places = Math.max(4, Math.min(needed, 15 - Math.ceil(Math.log10(Math.max(metres, 1)))));
  if (metres < 0.1 && places === 4) return lengthInWords(metres, 4);
  return `${metres.toFixed(places).replace(/0$/, '')} m`;
}

/** The largest of 1, 2 or 5 times a power of ten that is not above a number. @param {number} value */
export function roundStep(value) {
  if (!(value > 0) || !Number.isFinite(value)) return 1;
  const power = 10 ** Math.floor(Math.log10(value) + 1e-9);
  const lead = value / power;
  return (lead >= 5 ? 5 : lead >= 2 ? 2 : 1) * power;
}

/** The largest power of ten that is not above a number. @param {number} value */
export function powerOfTen(value) {
  return value > 0 && Number.isFinite(value) ? 10 ** Math.floor(Math.log10(value) + 1e-9) : 1;
}

/** A tick of a scale. @param {number} value @param {number} step */
export function tickInWords(value, step) {
  const places = Math.max(0, Math.min(12, -Math.floor(Math.log10(step) + 1e-9)));
  const text = value.toFixed(places);
  return Number(text) === 0 ? (0).toFixed(places) : text.replace('-', '−');
}

/** A round number from which the coordinates of an axis are counted, so that their labels stay short; 0 if they are short by
 * themselves. The rule is that of `axis_from_offset` of the figures. @param {number} low @param {number} high */
export function offsetOfAxis(low, high) {
  if (!(high > low) || Math.max(Math.abs(low), Math.abs(high)) < 1000) return 0;
  const power = 10 ** Math.ceil(Math.log10(high - low) - 1e-9);
  const from = (/** @type {number} */ step) => Math.floor(low / step) * step;
  return from(10 * power) === 0 ? from(power) : from(10 * power);
}

/** Name of an axis whose coordinates are counted from an offset: `x − 500000, m`. @param {string} name @param {number} offset */
export function axisInWords(name, offset) {
  if (offset === 0) return `${name}, m`;
  return `${name} ${offset < 0 ? '+' : '−'} ${Math.abs(offset)}, m`;
}

/** `face 12`, `faces 12 and 13`, `faces 1, 2 and 4 more`. @param {ArrayLike<number>} faces */
export function facesInWords(faces) {
  const list = Array.from(faces);
  if (list.length === 0) return 'no face';
  if (list.length === 1) return `face ${list[0]}`;
  if (list.length > 4) return `faces ${list.slice(0, 3).join(', ')} and ${list.length - 3} more`;
  return `faces ${list.slice(0, -1).join(', ')} and ${list[list.length - 1]}`;
}
