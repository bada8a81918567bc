// Arrays of the page, decoded when first asked for. `docs/formats/report-page.md` has the format.

/** @typedef {Uint8Array|Uint16Array|Uint32Array|Int32Array|Float32Array|Float64Array} NumberArray */
/** @typedef {'u8'|'u16'|'u32'|'i32'|'f32'|'f64'} NumberType */
/**
 * @typedef {{array: number, type: NumberType, count: number, steps?: DecodeStep[]}} ArrayReference
 * @typedef {'planes'|'delta'|{xor: ArrayReference}} DecodeStep
 */

/** Bytes of one number. */
const BYTES_OF = { u8: 1, u16: 2, u32: 4, i32: 4, f32: 4, f64: 8 };

export class Container {
  /** @param {(index: number) => string|null} textOf the base64 text of an array */
  constructor(textOf) {
    this.textOf = textOf;
    /** @type {Map<number, Promise<NumberArray>>} */
    this.decoded = new Map();
  }

  /** The arrays of a document: elements with the ids `array-0`, `array-1`, ... */
  static ofDocument() {
    return new Container((index) => document.getElementById(`array-${index}`)?.textContent ?? null);
  }

  /**
   * The numbers of an array. The same array is decoded once.
   * @param {ArrayReference} reference
   * @returns {Promise<NumberArray>}
   */
  decode(reference) {
    let promise = this.decoded.get(reference.array);
    if (!promise) {
      promise = this.read(reference);
      this.decoded.set(reference.array, promise);
    }
    return promise;
  }

  /**
   * Forgets an array whose numbers were taken over into another one.
   * @param {ArrayReference} reference
   */
  forget(reference) {
    this.decoded.delete(reference.array);
  }

  /**
   * @param {ArrayReference} reference
   * @returns {Promise<NumberArray>}
   */
  async read(reference) {
    const text = this.textOf(reference.array);
    if (text === null) {
      throw new Error(`array ${reference.array} is missing in this page`);
    }
    const size = BYTES_OF[reference.type];
    let bytes = await inflated(bytesOfBase64(text), size * reference.count);
    if (bytes.length !== size * reference.count) {
      throw new Error(`array ${reference.array} has ${bytes.length} bytes, not ${size * reference.count}`);
    }
    for (const step of reference.steps ?? []) {
      if (step === 'planes') {
        bytes = interleavedPlanes(bytes, size);
      } else if (step === 'delta') {
        sumUp(bytes, size);
      } else {
        const other = await this.decode(step.xor);
        flipBits(bytes, new Uint8Array(other.buffer, other.byteOffset, other.byteLength));
      }
    }
    return numbersOf(bytes, reference.type);
  }
}

/**
 * @param {string} text
 * @returns {Uint8Array<ArrayBuffer>}
 */
function bytesOfBase64(text) {
  const fromBase64 = /** @type {any} */ (Uint8Array).fromBase64;
  if (typeof fromBase64 === 'function') {
    return fromBase64.call(Uint8Array, text);
  }
  const binary = atob(text);
  const bytes = new Uint8Array(binary.length);
  for (let i = 0; i < binary.length; i += 1) {
    bytes[i] = binary.charCodeAt(i);
  }
  return bytes;
}

/**
 * @param {Uint8Array<ArrayBuffer>} bytes raw deflate
 * @param {number} length of the inflated bytes
 * @returns {Promise<Uint8Array<ArrayBuffer>>}
 */
async function inflated(bytes, length) {
  const stream = new DecompressionStream('deflate-raw');
  const writer = stream.writable.getWriter();
  // A fault of the stream is told by the reader; here it would only be told again.
  writer.write(bytes).catch(() => {});
  writer.close().catch(() => {});
  const all = new Uint8Array(length);
  const reader = stream.readable.getReader();
  let end = 0;
  for (let part = await reader.read(); !part.done; part = await reader.read()) {
    if (end + part.value.length > length) {
      throw new Error(`more than ${length} bytes`);
    }
    all.set(part.value, end);
    end += part.value.length;
  }
  return all.subarray(0, end);
}

/**
 * Numbers whose bytes lie plane by plane, put together again.
 * @param {Uint8Array<ArrayBuffer>} bytes
 * @param {number} size bytes of one number
 * @returns {Uint8Array<ArrayBuffer>}
 */
function interleavedPlanes(bytes, size) {
  if (size === 1) {
    return bytes;
  }
  const count = bytes.length / size;
  if (size === 4) {
    const words = new Uint32Array(count);
    const [second, third, fourth] = [count, 2 * count, 3 * count];
    for (let i = 0; i < count; i += 1) {
      words[i] = bytes[i] | (bytes[second + i] << 8) | (bytes[third + i] << 16) | (bytes[fourth + i] << 24);
    }
    return new Uint8Array(words.buffer);
  }
  const together = new Uint8Array(bytes.length);
  for (let plane = 0; plane < size; plane += 1) {
    for (let i = 0; i < count; i += 1) {
      together[i * size + plane] = bytes[plane * count + i];
    }
  }
  return together;
}

/**
 * Replaces differences by running sums, in the wrapping arithmetic of unsigned integers of that size.
 * @param {Uint8Array<ArrayBuffer>} bytes
 * @param {number} size
 */
function sumUp(bytes, size) {
  if (size === 8) {
    const words = new BigUint64Array(bytes.buffer, bytes.byteOffset, bytes.length / 8);
    for (let i = 1; i < words.length; i += 1) {
      words[i] += words[i - 1];
    }
    return;
  }
  const words = unsignedOf(bytes, size);
  let sum = 0;
  for (let i = 0; i < words.length; i += 1) {
    sum = (sum + words[i]) | 0;
    words[i] = sum;
  }
}

/**
 * @param {Uint8Array<ArrayBuffer>} bytes
 * @param {Uint8Array} others
 */
function flipBits(bytes, others) {
  if (bytes.length !== others.length) {
    throw new Error('arrays of unlike length');
  }
  for (let i = 0; i < bytes.length; i += 1) {
    bytes[i] ^= others[i];
  }
}

/**
 * @param {Uint8Array<ArrayBuffer>} bytes
 * @param {number} size 1, 2 or 4
 */
function unsignedOf(bytes, size) {
  const count = bytes.length / size;
  switch (size) {
    case 1:
      return bytes;
    case 2:
      return new Uint16Array(bytes.buffer, bytes.byteOffset, count);
    default:
      return new Uint32Array(bytes.buffer, bytes.byteOffset, count);
  }
}

/**
 * @param {Uint8Array<ArrayBuffer>} bytes
 * @param {NumberType} type
 * @returns {NumberArray}
 */
function numbersOf(bytes, type) {
  const count = bytes.length / BYTES_OF[type];
  switch (type) {
    case 'u8':
      return bytes;
    case 'u16':
      return new Uint16Array(bytes.buffer, bytes.byteOffset, count);
    case 'u32':
      return new Uint32Array(bytes.buffer, bytes.byteOffset, count);
    case 'i32':
      return new Int32Array(bytes.buffer, bytes.byteOffset, count);
    case 'f32':
      return new Float32Array(bytes.buffer, bytes.byteOffset, count);
    default:
      return new Float64Array(bytes.buffer, bytes.byteOffset, count);
  }
}
