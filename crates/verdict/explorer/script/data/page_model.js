// The page model: what the Rust side wrote into the page, with its types.

/**
 * @typedef {import('./container.js').ArrayReference} ArrayReference
 * @typedef {[number, number, number]} Triple
 * @typedef {{stored: ArrayReference}|{derived: {cells: ArrayReference, bits: ArrayReference}}} ChannelEntry
 * @typedef {{channels: Record<string, ChannelEntry>}} SensorSide
 *
 * @typedef {object} SensorPairModel
 * @property {number} a index of a side
 * @property {number} b index of a side
 * @property {ArrayReference|null} [class]
 * @property {ArrayReference|null} [cause]
 * @property {ArrayReference|null} [quantity]
 * @property {ArrayReference|null} [range_ulps]
 * @property {ArrayReference|null} [range_bound]
 *
 * @typedef {object} MarginModel
 * @property {ArrayReference} cells
 * @property {ArrayReference|null} [face]
 * @property {ArrayReference|null} [surface]
 * @property {ArrayReference|null} [visibility]
 * @property {ArrayReference|null} [landing]
 *
 * @typedef {object} SensorModel
 * @property {string} name
 * @property {string} kind `camera` or `beam`
 * @property {number|null} [beam]
 * @property {number} width
 * @property {number} height
 * @property {number} [max_range]
 * @property {{position: Triple, quaternion: [number, number, number, number]}} pose
 * @property {{pixel_pitch: [number, number], principal_point: [number, number], focal_length: number}|null}
 *   [camera]
 * @property {{half_width: number, thickness: number, grid_distance: number}|null} [grid]
 * @property {RasterAxes|null} [axes] what columns and rows are
 * @property {(SensorSide|null)[]} [sides]
 * @property {SensorPairModel[]} [pairs]
 * @property {MarginModel|null} [margins]
 *
 * @typedef {object} RasterAxis
 * @property {string} name
 * @property {string} unit
 * @property {boolean} turns whether the numbers are angles of a turn, in degrees
 * @property {number[]} at the number of each column or row
 *
 * @typedef {{columns: RasterAxis, rows: RasterAxis}} RasterAxes
 *
 * @typedef {object} SolidModel a mesh on which the points of a raster lie
 * @property {Triple} origin zero of the vertices, in the frame of the points
 * @property {[Triple, Triple, Triple]} axes to the right, up the page, and upward
 * @property {ArrayReference} vertices three f32 each
 * @property {ArrayReference} faces three u32 each
 * @property {string} words
 *
 * @typedef {object} CauseModel
 * @property {string[]} switches
 * @property {number} [rays]
 * @property {number} [lost]
 * @property {number} [added]
 * @property {number} [flux_changed]
 * @property {number|null} [worst_range]
 * @property {{sensor: number, cell: number}|null} [worst_place]
 *
 * @typedef {object} DescribedRay
 * @property {number} sensor
 * @property {number} cell
 * @property {number} pair index in the pairs of the sensor
 * @property {string} text
 * @property {{faces: number[], point: Triple|null, range: number|null, visible: boolean|null,
 *   pixel: [number, number]|null}} [exact]
 * @property {{face: [number, number]|null, surface: [number, number]|null, visibility: [number,
 *   number]|null}} [witness]
 *
 * @typedef {object} PageModel
 * @property {number} version
 * @property {string} kind
 * @property {string} title
 * @property {string} [probe]
 * @property {string} [flux_unit]
 * @property {{origin: Triple, vertices: ArrayReference, faces: ArrayReference, materials?: ArrayReference,
 *   material_names?: string[], reflectivity?: number[]}|null} [mesh]
 * @property {{position: Triple, axes: Triple[]}|null} [vehicle]
 * @property {{name: string, kind: string, words?: string}[]} sides
 * @property {SensorModel[]} sensors
 * @property {string[]} [classes]
 * @property {{name: string, unit: string}[]} [quantities]
 * @property {CauseModel[]} [causes]
 * @property {Record<string, {title: string, words: string}>} [switches]
 * @property {ArrayReference|null} [rays]
 * @property {string} [rays_words]
 * @property {SolidModel|null} [solid]
 * @property {string} [opening] the address of the cell that the page opens on
 */

/** Class, cause or quantity that a cell does not have. */
export const NO_CODE = 255;

/** Face or pixel of a ray that has none. */
export const NOTHING = 4294967295;

/** A difference of ranges of at least so many ulp is not told in numbers. */
export const SATURATED_ULPS = 2147483647;

/** Names of the classes, in case the model has none. */
export const CLASS_NAMES = ['agree', 'tie', 'rounding', 'approximation', 'undecided', 'defect'];

/**
 * The model of this document; null if it has none or one of a later version.
 * @returns {PageModel|null}
 */
export function readPageModel() {
  const text = document.getElementById('page-model')?.textContent;
  if (!text) {
    return null;
  }
  const model = JSON.parse(text);
  const isKnown = model.version === 1 && Array.isArray(model.sensors) && Array.isArray(model.sides);
  return isKnown ? model : null;
}

/**
 * The command that prints everything about a ray.
 * @param {PageModel} model
 * @param {number} sensorIndex
 * @param {number} cell
 */
export function probeCommand(model, sensorIndex, cell) {
  if (!model.probe) {
    return '';
  }
  const sensor = model.sensors[sensorIndex];
  const place = `${cell % sensor.width},${Math.floor(cell / sensor.width)}`;
  return sensor.kind === 'beam'
    ? `${model.probe} --beam ${sensor.beam ?? 0} --pencil ${place}`
    : `${model.probe} --pixel ${place}`;
}

/**
 * A cell as people read it: `camera (412, 300)`.
 * @param {PageModel} model
 * @param {number} sensorIndex
 * @param {number} cell
 */
export function placeWords(model, sensorIndex, cell) {
  const sensor = model.sensors[sensorIndex];
  return `${sensor.name} (${cell % sensor.width}, ${Math.floor(cell / sensor.width)})`;
}
