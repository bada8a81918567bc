// The record of a drive: poses, changes of the elevation map, and obstacle maps, decoded from the page model.

/** @typedef {import('../data/container.js').ArrayReference} ArrayReference */
/** @typedef {import('../data/container.js').NumberArray} NumberArray */
/** @typedef {import('../data/page_model.js').PageModel} PageModel */
/** @typedef {import('../view3d/vector.js').Point3} Point3 */
/**
 * @typedef {object} DriveMapModel
 * @property {[number, number]} origin scene x and y of grid point (0, 0), metres
 * @property {number} spacing metres
 * @property {boolean} [is_cut]
 * @property {ArrayReference} first
 * @property {ArrayReference} i
 * @property {ArrayReference} j
 * @property {ArrayReference} elevation
 * @property {ArrayReference} source
 *
 * @typedef {'obstacle'|'unknown'|'visibility'} DriveLabel
 *
 * @typedef {object} DriveSector
 * @property {number} direction radians from the x axis to the left
 * @property {number} radius metres
 * @property {[number, number]} point
 * @property {DriveLabel} label
 * @property {string} reason
 * @property {[number, number]|null} missing
 *
 * @typedef {object} DriveObstacleMap
 * @property {number} frame index in `frames`
 * @property {[number, number]} centre
 * @property {DriveSector[]} sectors from right to left
 *
 * @typedef {object} DriveVehicle
 * @property {number} wheelbase metres, as all
 * @property {number} track
 * @property {number} wheel_radius
 * @property {number} wheel_width
 * @property {number} clearance
 *
 * @typedef {object} DriveModel
 * @property {number} frame_rate frames in a second
 * @property {ArrayReference} frames
 * @property {ArrayReference} stance
 * @property {ArrayReference} believed
 * @property {DriveMapModel} map
 * @property {ArrayReference|null} [obstacles]
 * @property {[number, number][]} [waypoints]
 * @property {DriveVehicle|null} [vehicle] without it, the default vehicle
 * @property {number[]|null} [scans] indices in `frames`, if the page knows them
 *
 * @typedef {{position: Point3, quaternion: [number, number, number, number]}} DrivePose
 *
 * @typedef {object} DrivePage
 * @property {PageModel} model with the key `drive`
 * @property {{decode: (reference: ArrayReference) => Promise<NumberArray>}} container
 */

/** Measures of the vehicle that a drive has if its scene gives no others. */
const DRIVE_DEFAULT_VEHICLE = { wheelbase: 1.2, track: 1, wheel_radius: 0.35, wheel_width: 0.25, clearance: 0.35 };

/** Sources of an elevation, by their number. */
export const DRIVE_SOURCES = ['unknown', 'proximity sensor', 'extrapolated', 'measured'];

/** The labels, in the order of the obstacle map's figure. @type {DriveLabel[]} */
export const DRIVE_LABELS = ['obstacle', 'unknown', 'visibility'];

export class DriveRecord {
  /** @param {PageModel} model @param {DriveModel} drive @param {Record<string, NumberArray>} arrays */
  constructor(model, drive, arrays) {
    this.model = model;
    /** Global coordinates of the scene frame's origin, metres. @type {Point3} */
    this.origin = model.mesh?.origin ?? [0, 0, 0];
    this.rate = drive.frame_rate > 0 ? drive.frame_rate : 1;
    /** Index in the drive of each frame that the page has. */
    this.frames = arrays.frames;
    this.count = arrays.frames.length;
    this.stance = arrays.stance;
    this.believed = arrays.believed;
    this.mapOrigin = drive.map.origin;
    this.spacing = drive.map.spacing;
    this.first = arrays.first;
    this.i = arrays.i;
    this.j = arrays.j;
    this.elevation = arrays.elevation;
    this.source = arrays.source;
    this.isCut = drive.map.is_cut === true;
    /** @type {DriveObstacleMap[]} */
    this.obstacles = obstaclesOf(arrays.obstacles).filter((map) => map.frame < this.count);
    this.waypoints = drive.waypoints ?? [];
    this.scans = drive.scans ?? [];
    this.vehicle = { ...DRIVE_DEFAULT_VEHICLE, ...drive.vehicle };
  }

  /**
   * Decodes the arrays of a drive.
   * @param {DrivePage} page
   * @returns {Promise<DriveRecord>}
   */
  static async read(page) {
    const drive = /** @type {PageModel & {drive?: DriveModel}} */ (page.model).drive;
    if (!drive) {
      throw new Error('the page has no drive');
    }
    /** @type {Record<string, ArrayReference|null|undefined>} */
    const references = {
      frames: drive.frames, stance: drive.stance, believed: drive.believed, first: drive.map.first, i: drive.map.i,
      j: drive.map.j, elevation: drive.map.elevation, source: drive.map.source, obstacles: drive.obstacles,
    };
    /** @type {Record<string, NumberArray>} */
    const arrays = {};
    await Promise.all(Object.entries(references).map(async ([name, reference]) => {
      if (reference) {
        arrays[name] = await page.container.decode(reference);
      }
    }));
    return new DriveRecord(page.model, drive, arrays);
  }

  /** Time of a frame, seconds from the first one of the drive. @param {number} frame */
  timeOf(frame) {
    return this.frames[frame] / this.rate;
  }

  /** The page's frame that is nearest to a frame of the drive. @param {number} number index in the drive */
  frameOfNumber(number) {
    let nearest = 0;
    for (let frame = 1; frame < this.count; frame += 1) {
      if (Math.abs(this.frames[frame] - number) < Math.abs(this.frames[nearest] - number)) {
        nearest = frame;
      }
    }
    return nearest;
  }

  /** @param {number} frame */
  truePose(frame) {
    return poseInArray(this.stance, frame);
  }

  /** @param {number} frame */
  believedPose(frame) {
    return poseInArray(this.believed, frame);
  }

  /** The last obstacle map that was made up to a frame; -1 for none. @param {number} frame */
  obstacleIndexAt(frame) {
    let found = -1;
    for (let index = 0; index < this.obstacles.length && this.obstacles[index].frame <= frame; index += 1) {
      found = index;
    }
    return found;
  }

  /** Last frame with changes of a map that was cut; the last frame otherwise. */
  get lastReplayed() {
    let frame = this.count - 1;
    while (this.isCut && frame > 0 && this.first[frame] === this.first[frame + 1]) {
      frame -= 1;
    }
    return frame;
  }
}

/** @param {NumberArray|undefined} bytes JSON text @returns {DriveObstacleMap[]} */
function obstaclesOf(bytes) {
  /** @type {DriveObstacleMap[]} */
  const maps = bytes ? JSON.parse(new TextDecoder().decode(/** @type {Uint8Array} */ (bytes))) : [];
  for (const sector of maps.flatMap((map) => map.sectors)) {
    sector.label = DRIVE_LABELS.includes(sector.label) ? sector.label : 'unknown';
  }
  return maps;
}

/**
 * @param {NumberArray} numbers seven each
 * @param {number} frame
 * @returns {DrivePose}
 */
function poseInArray(numbers, frame) {
  const at = 7 * frame;
  return {
    position: [numbers[at], numbers[at + 1], numbers[at + 2]],
    quaternion: [numbers[at + 3], numbers[at + 4], numbers[at + 5], numbers[at + 6]],
  };
}
