// Numbers as text: shortest decimals of single precision, prefixes of units, and steps between numbers.

const doubleCell = new Float64Array(1);
const doubleBits = new BigUint64Array(doubleCell.buffer);
const singleCell = new Float32Array(1);
const singleBits = new Uint32Array(singleCell.buffer);

/**
 * The shortest decimal that gives the same f32 back.
 * @param {number} value a number of single precision
 */
export function shortestSingle(value) {
  if (!Number.isFinite(value)) {
    return String(value);
  }
  for (let digits = 1; digits <= 9; digits += 1) {
    const text = value.toPrecision(digits);
    if (Math.fround(Number(text)) === value) {
      return String(Number(text));
    }
  }
  return String(value);
}

/**
 * Steps of f32 from one number to another; NaN if one of them is no number.
 * @param {number} from
 * @param {number} to
 */
export function singleSteps(from, to) {
  if (Number.isNaN(from) || Number.isNaN(to)) {
    return NaN;
  }
  return singleOrder(to) - singleOrder(from);
}

/** @param {number} value */
function singleOrder(value) {
  singleCell[0] = value;
  const bits = singleBits[0];
  return bits >= 0x80000000 ? 0x80000000 - bits : bits;
}

/**
 * One unit in the last place of f64 at a number.
 * @param {number} value
 */
export function doubleUlp(value) {
  const size = Math.abs(value);
  if (!Number.isFinite(size)) {
    return NaN;
  }
  doubleCell[0] = size;
  doubleBits[0] += 1n;
  return doubleCell[0] - size;
}

/** Prefixes by power of a thousand, for units that people read with prefixes. */
const PREFIXES = new Map([
  [3, 'G'],
  [2, 'M'],
  [1, 'k'],
  [0, ''],
  [-1, 'm'],
  [-2, 'µ'],
  [-3, 'n'],
  [-4, 'p'],
  [-5, 'f'],
]);

/**
 * A value with its unit, in engineering notation: `12.4 µm`, `3.21 m`, `4.4e-16 m`.
 * @param {number} value
 * @param {string} unit
 * @param {number} [digits] significant digits
 */
export function withUnit(value, unit, digits = 4) {
  const { text, unit: scaled } = engineering(value, unit, digits);
  return scaled ? `${text} ${scaled}` : text;
}

/**
 * A value in a unit with the prefix that suits it.
 * @param {number} value
 * @param {string} unit
 * @param {number} digits
 * @returns {{text: string, unit: string}}
 */
function engineering(value, unit, digits) {
  if (value === 0 || !Number.isFinite(value)) {
    return { text: plain(value, digits), unit };
  }
  const takesPrefix = unit === 'm' || unit === 'W' || unit === 'W/m';
  if (!takesPrefix) {
    return { text: plain(value, digits), unit };
  }
  const power = Math.floor(Math.log10(Math.abs(Number(value.toPrecision(digits)))) / 3);
  const lowest = unit === 'm' ? -3 : -5;
  const highest = unit === 'm' ? 0 : 3;
  const used = Math.min(power, highest);
  const prefix = used < lowest ? undefined : PREFIXES.get(used);
  if (prefix === undefined) {
    return { text: plain(value, Math.min(digits, 3)), unit };
  }
  return { text: plain(value / 1000 ** used, digits), unit: prefix + unit };
}

/**
 * A number in at most so many digits.
 * @param {number} value
 * @param {number} digits
 */
export function plain(value, digits) {
  if (Number.isNaN(value)) {
    return 'no number';
  }
  if (!Number.isFinite(value)) {
    return value > 0 ? '∞' : '−∞';
  }
  const rounded = Number(value.toPrecision(digits));
  const size = Math.abs(rounded);
  const text =
    size !== 0 && (size < 1e-3 || size >= 1e7)
      ? rounded.toExponential(Math.max(0, shortestDigits(rounded) - 1)).replace('e+', 'e')
      : String(rounded);
  return text.replace(/^-/, '−');
}

/** @param {number} value */
function shortestDigits(value) {
  return value.toExponential().replace(/e.*/, '').replace(/[-.]/g, '').length;
}

/**
 * A number with a sign, also if it is positive.
 * @param {number} value
 * @param {string} unit
 * @param {number} [digits]
 */
export function signedWithUnit(value, unit, digits = 4) {
  return value > 0 ? `+${withUnit(value, unit, digits)}` : withUnit(value, unit, digits);
}

/**
 * A count with commas between the thousands.
 * @param {number} value
 */
export function countWords(value) {
  return String(Math.round(value)).replace(/\B(?=(\d{3})+$)/g, ',');
}

/**
 * "1 ray", "2 rays".
 * @param {number} value
 * @param {string} noun in the singular
 */
export function counted(value, noun) {
  return `${countWords(value)} ${noun}${value === 1 ? '' : 's'}`;
}

/**
 * A number for a cell of the picture: at most so many characters.
 * @param {number} value
 * @param {number} room characters
 */
export function cellWords(value, room) {
  if (Number.isNaN(value) || !Number.isFinite(value)) {
    return '';
  }
  const size = Math.abs(value);
  const sign = value < 0 ? 1 : 0;
  if (value === 0) {
    return '0';
  }
  if (Number.isInteger(value) && String(value).length <= room) {
    return String(value).replace(/^-/, '−');
  }
  if (size >= 1e-3 && size < 10 ** (room - sign)) {
    const before = Math.max(1, Math.floor(Math.log10(size)) + 1);
    return value.toFixed(Math.max(0, Math.min(7, room - sign - before - 1))).replace(/^-/, '−');
  }
  const mantissa = room - sign >= 7 ? 1 : 0;
  return value.toExponential(mantissa).replace('e+', 'e').replace(/^-/, '−');
}

/** The least of 1, 2 and 5 times a power of ten that is not below a number. @param {number} size above 0 */
export function roundAbove(size) {
  const decade = 10 ** Math.floor(Math.log10(size));
  return [1, 2, 5, 10].map((factor) => factor * decade).find((step) => step >= size) ?? 10 * decade;
}
