// Rays and values of hits, in f64 and in the order of operations that `docs/formats/report-page.md` states.
// Rust computes the same bits. So no operation here may be moved, joined or left out.

/** @typedef {import('./page_model.js').SensorModel} SensorModel */
/**
 * @typedef {{origin: [number, number, number], direction: [number, number, number], localZ: number}}
 *   SensorRay
 */

/** Channels that follow from face and ray. */
const DERIVED_CHANNELS = [
  'range.T',
  'depth.Z',
  'P.X',
  'P.Y',
  'P.Z',
  'N.X',
  'N.Y',
  'N.Z',
  'incidence.V',
];

/**
 * A function that writes the ray of cell (i, j) into seven numbers: origin, direction, and the direction's
 * part along
 * the sensor's axis. Origin and direction are in the scene frame, metres.
 * @param {SensorModel} sensor
 * @returns {(i: number, j: number, into: Float64Array) => void}
 */
function rayMaker(sensor) {
  const { position, quaternion } = sensor.pose;
  const [px, py, pz] = position;
  const [ux, uy, uz, w] = quaternion;
  const norm = w * w + (ux * ux + uy * uy + uz * uz);
  const factor = 2 / norm;
  /** @param {number} x @param {number} y @param {number} z @param {Float64Array} into @param {number} at */
  const rotate = (x, y, z, into, at) => {
    const cx = uy * z - y * uz;
    const cy = uz * x - z * ux;
    const cz = ux * y - x * uy;
    into[at] = x + (cx * w + (uy * cz - cy * uz)) * factor;
    into[at + 1] = y + (cy * w + (uz * cx - cz * ux)) * factor;
    into[at + 2] = z + (cz * w + (ux * cy - cx * uy)) * factor;
  };
  if (sensor.camera) {
    const {
      pixel_pitch: [pitchX, pitchY],
      principal_point: [centreX, centreY],
      focal_length: focal,
    } = sensor.camera;
    return (i, j, into) => {
      into[0] = px;
      into[1] = py;
      into[2] = pz;
      rotate((i + 0.5 - centreX) * pitchX, (j + 0.5 - centreY) * pitchY, focal, into, 3);
      into[6] = focal;
    };
  }
  const { width, height } = sensor;
  const {
    half_width: half,
    thickness,
    grid_distance: distance,
  } = sensor.grid ?? { half_width: 1, thickness: 0, grid_distance: 1 };
  return (i, j, into) => {
    rotate(0, (thickness * (2 * j + 1 - height)) / (2 * height), 0, into, 0);
    into[0] = px + into[0];
    into[1] = py + into[1];
    into[2] = pz + into[2];
    rotate((half * (2 * i + 1 - width)) / width, 0, distance, into, 3);
    into[6] = distance;
  };
}

/**
 * @param {SensorModel} sensor
 * @param {number} cell
 * @returns {SensorRay}
 */
export function rayOfCell(sensor, cell) {
  const ray = new Float64Array(7);
  rayMaker(sensor)(cell % sensor.width, Math.floor(cell / sensor.width), ray);
  return { origin: [ray[0], ray[1], ray[2]], direction: [ray[3], ray[4], ray[5]], localZ: ray[6] };
}

/** First vertex and normal of each face, computed when a face is first asked for. */
export class FacePlanes {
  /**
   * @param {Float32Array} vertices three numbers each
   * @param {Uint32Array} faces three vertices each
   */
  constructor(vertices, faces) {
    this.vertices = vertices;
    this.faces = faces;
    this.count = Math.floor(faces.length / 3);
    /** Normal, first vertex and length of the normal: seven numbers each. */
    this.planes = new Float64Array(7 * this.count);
    this.isKnown = new Uint8Array(this.count);
  }

  /**
   * The place in `planes` at which a face's numbers begin.
   * @param {number} face
   */
  at(face) {
    const at = 7 * face;
    if (this.isKnown[face] === 0) {
      this.compute(face, at);
    }
    return at;
  }

  /** @param {number} face @param {number} at */
  compute(face, at) {
    const { vertices, faces, planes } = this;
    const a = 3 * faces[3 * face];
    const b = 3 * faces[3 * face + 1];
    const c = 3 * faces[3 * face + 2];
    const ax = vertices[a];
    const ay = vertices[a + 1];
    const az = vertices[a + 2];
    const ux = vertices[b] - ax;
    const uy = vertices[b + 1] - ay;
    const uz = vertices[b + 2] - az;
    const vx = vertices[c] - ax;
    const vy = vertices[c + 1] - ay;
    const vz = vertices[c + 2] - az;
    const nx = uy * vz - vy * uz;
    const ny = uz * vx - vz * ux;
    const nz = ux * vy - vx * uy;
    planes[at] = nx;
    planes[at + 1] = ny;
    planes[at + 2] = nz;
    planes[at + 3] = ax;
    planes[at + 4] = ay;
    planes[at + 5] = az;
    planes[at + 6] = Math.sqrt(nx * nx + ny * ny + nz * nz);
    this.isKnown[face] = 1;
  }
}

/** @typedef {{faces: Uint32Array, values: Float32Array, cells: Uint32Array}} KnownSide */

/**
 * One derived channel of all cells, before the cells that the recording has otherwise.
 * @param {SensorModel} sensor
 * @param {FacePlanes} facePlanes
 * @param {Uint32Array} faces face of each cell
 * @param {string} channel
 * @param {KnownSide|null} [known] faces and recorded values of another side, and the cells in which these are
 *   not
 *   derived; where both sides hit the same face, they have the same value
 * @returns {Float32Array}
 */
export function derivedRaster(sensor, facePlanes, faces, channel, known = null) {
  const { width, height } = sensor;
  const derive = derivedReader(sensor, facePlanes, faces, channel);
  if (known) {
    const values = known.values.slice();
    for (let cell = 0; cell < values.length; cell += 1) {
      if (faces[cell] !== known.faces[cell]) {
        values[cell] = derive(cell);
      }
    }
    known.cells.forEach((cell) => {
      values[cell] = derive(cell);
    });
    return values;
  }
  const values = new Float32Array(width * height);
  const makeRay = rayMaker(sensor);
  const ray = new Float64Array(7);
  const kind = DERIVED_CHANNELS.indexOf(channel);
  const missing = missingValue(channel);
  const count = facePlanes.count;
  let cell = 0;
  for (let j = 0; j < height; j += 1) {
    for (let i = 0; i < width; i += 1) {
      const face = faces[cell];
      if (face < count) {
        makeRay(i, j, ray);
        values[cell] = valueOnPlane(kind, ray, facePlanes.planes, facePlanes.at(face));
      } else {
        values[cell] = missing;
      }
      cell += 1;
    }
  }
  return values;
}

/**
 * A function that gives one derived channel of one cell in f64, before rounding to f32.
 * @param {SensorModel} sensor
 * @param {FacePlanes} facePlanes
 * @param {Uint32Array} faces face of each cell
 * @param {string} channel
 * @returns {(cell: number) => number}
 */
export function derivedReader(sensor, facePlanes, faces, channel) {
  const makeRay = rayMaker(sensor);
  const ray = new Float64Array(7);
  const kind = DERIVED_CHANNELS.indexOf(channel);
  const missing = missingValue(channel);
  return (cell) => {
    const face = faces[cell];
    if (!(face < facePlanes.count)) {
      return missing;
    }
    makeRay(cell % sensor.width, Math.floor(cell / sensor.width), ray);
    return valueOnPlane(kind, ray, facePlanes.planes, facePlanes.at(face));
  };
}

/**
 * What a recording has where nothing is hit.
 * @param {string} channel
 */
export function missingValue(channel) {
  return channel === 'range.T' || channel === 'depth.Z' ? Infinity : NaN;
}

/**
 * @param {number} kind index in `DERIVED_CHANNELS`
 * @param {Float64Array} ray
 * @param {Float64Array} planes
 * @param {number} at
 */
function valueOnPlane(kind, ray, planes, at) {
  const nx = planes[at];
  const ny = planes[at + 1];
  const nz = planes[at + 2];
  if (kind >= 5 && kind <= 7) {
    return planes[at + kind - 5] / planes[at + 6];
  }
  const qx = ray[3];
  const qy = ray[4];
  const qz = ray[5];
  const alongRay = nx * qx + ny * qy + nz * qz;
  if (kind === 8) {
    return -alongRay / (planes[at + 6] * Math.sqrt(qx * qx + qy * qy + qz * qz));
  }
  const toPlane =
    nx * (planes[at + 3] - ray[0]) + ny * (planes[at + 4] - ray[1]) + nz * (planes[at + 5] - ray[2]);
  const t = toPlane / alongRay;
  switch (kind) {
    case 0:
      return t * Math.sqrt(qx * qx + qy * qy + qz * qz);
    case 1:
      return t * ray[6];
    default:
      return ray[kind - 2] + ray[kind + 1] * t;
  }
}

/**
 * Puts the recorded bits into the cells in which the recording differs from what is derived.
 * @param {Float32Array} values
 * @param {Uint32Array} cells ascending
 * @param {Uint32Array} bits
 */
export function putRecordedBits(values, cells, bits) {
  const words = new Uint32Array(values.buffer, values.byteOffset, values.length);
  for (let k = 0; k < cells.length; k += 1) {
    words[cells[k]] = bits[k];
  }
}
