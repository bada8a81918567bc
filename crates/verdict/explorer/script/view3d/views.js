// The ready-made views: where the eye stands for each.

import { vecAdd, vecAlong, vecDistance, vecIsFinite, vecLength } from './vector.js';
import { vecScale, vecSub, vecUnit } from './vector.js';
import { axesOfSensor, rayOfPlace } from './sensor.js';
import { orbitPose } from './camera.js';
import { firstFaceOnRay } from './search.js';
import { hitPointsOf, spreadOf } from './story.js';

/** @typedef {import('./vector.js').Point3} Point3 */
/** @typedef {import('./terrain.js').Bounds3} Bounds3 */
/** @typedef {import('./terrain.js').Terrain} Terrain */
/** @typedef {import('./camera.js').EyePose} EyePose */
/** @typedef {import('./story.js').RayStory} RayStory */
/** @typedef {import('./view3d.js').PageModel3d} PageModel3d */
/** @typedef {import('./view3d.js').SensorModel} SensorModel */

/** No close-up shows less than this, metres: the terrain's single precision ends there. */
const SMALLEST_VIEW = 2e-6;

/** The smallest box around points. @param {Point3[]} points @returns {Bounds3 | null} */
export function boundsOfPoints(points) {
  /** @type {Point3} */
  const low = [Infinity, Infinity, Infinity];
  /** @type {Point3} */
  const high = [-Infinity, -Infinity, -Infinity];
  for (const point of points) {
    if (!vecIsFinite(point)) continue;
    for (let axis = 0; axis < 3; axis++) {
      low[axis] = Math.min(low[axis], point[axis]);
      high[axis] = Math.max(high[axis], point[axis]);
    }
  }
  return low[0] <= high[0] ? { low, high } : null;
}

/**
 * Height of the ground below the rig, as far as it is known without a search.
 * @param {PageModel3d} model
 * @param {Bounds3 | null} ground
 */
function groundHeight(model, ground) {
  if (model.vehicle) return model.vehicle.position[2];
  return ground ? ground.low[2] : 0;
}

/**
 * Where the middle ray of a sensor meets level ground, but at most at a part of its range.
 * @param {SensorModel} sensor
 * @param {number} height of the ground
 * @returns {Point3}
 */
function groundAhead(sensor, height) {
  const ray = rayOfPlace(sensor, (sensor.width - 1) / 2, (sensor.height - 1) / 2);
  const origin = sensor.pose.position;
  if (!ray) return origin;
  const along = vecUnit(ray.direction);
  const level = (height - origin[2]) / along[2];
  const far = 0.3 * sensor.max_range;
  return vecAlong(origin, along, level > 0 && level < far ? level : far);
}

/**
 * The part of the scene that the overview shows: rig, the ground that the sensors look at, the chosen ray.
 * @param {PageModel3d} model
 * @param {Terrain} terrain
 * @param {RayStory | null} story
 * @returns {Bounds3}
 */
export function boundsOfInterest(model, terrain, story) {
  const height = groundHeight(model, terrain.bounds);
  const points = model.sensors.flatMap((sensor) => [sensor.pose.position, groundAhead(sensor, height)]);
  if (model.vehicle) points.push(model.vehicle.position);
  if (story) points.push(...hitPointsOf(story));
  const rig = boundsOfPoints(points);
  if (!rig) return terrain.bounds ?? { low: [-1, -1, -1], high: [1, 1, 1] };
  // As wide as it is long, since the sheets spread, but no wider than the ground.
  const length = Math.max(rig.high[0] - rig.low[0], rig.high[1] - rig.low[1], rig.high[2] - rig.low[2], 1e-3);
  for (const axis of [0, 1]) {
    const missing = (length - (rig.high[axis] - rig.low[axis])) / 2;
    const [low, high] = [rig.low[axis] - missing - 0.1 * length, rig.high[axis] + missing + 0.1 * length];
    rig.low[axis] = Math.min(rig.low[axis], Math.max(low, terrain.bounds?.low[axis] ?? low));
    rig.high[axis] = Math.max(rig.high[axis], Math.min(high, terrain.bounds?.high[axis] ?? high));
  }
  return rig;
}

/** Yaw of the rig: the vehicle's, or the first sensor's. @param {PageModel3d} model */
export function yawOfRig(model) {
  const forward =
    model.vehicle?.axes[0] ?? (model.sensors[0] ? axesOfSensor(model.sensors[0]).forward : [1, 0, 0]);
  return Math.abs(forward[0]) + Math.abs(forward[1]) > 1e-6 ? Math.atan2(forward[1], forward[0]) : 0;
}

/**
 * A view of a box from behind the rig, on its right, from above.
 * @param {Bounds3} box
 * @param {number} yaw of the rig
 * @param {number} shape width of the canvas by its height
 * @returns {EyePose}
 */
export function overviewPose(box, yaw, shape) {
  return poseOnBox(box, yaw + 0.85, 0.42, shape < 1 ? 1.25 : 0.98);
}

/**
 * A view from above with the rig's forward up.
 * @param {Bounds3} box
 * @param {number} yaw
 * @returns {EyePose}
 */
export function topPose(box, yaw) {
  return poseOnBox(box, yaw, Math.PI / 2, 1.2);
}

/** @param {Bounds3} box @param {number} yaw @param {number} pitch @param {number} room */
function poseOnBox(box, yaw, pitch, room) {
  const size = vecDistance(box.low, box.high);
  return orbitPose(vecScale(vecAdd(box.low, box.high), 0.5), Math.max(size * room, 1e-3), yaw, pitch);
}

/**
 * The camera's own perspective.
 * @param {PageModel3d} model
 * @param {Terrain} terrain
 * @returns {EyePose | null}
 */
export function cameraPose(model, terrain) {
  const sensor = model.sensors.find((candidate) => candidate.camera);
  if (!sensor || !sensor.camera) return null;
  const { pixel_pitch: pitch, principal_point: centre, focal_length: focal } = sensor.camera;
  return {
    eye: sensor.pose.position,
    axes: axesOfSensor(sensor),
    lens: {
      kind: 'image',
      width: sensor.width,
      height: sensor.height,
      focal: [focal / pitch[0], focal / pitch[1]],
      centre: [centre[0], centre[1]],
      zoom: 1,
      u: sensor.width / 2,
      v: sensor.height / 2,
    },
    focus: groundAhead(sensor, groundHeight(model, terrain.bounds)),
    // The camera sees nothing before its projection plane.
    nearest: focal,
  };
}

/**
 * From the middle of a laser.
 * @param {PageModel3d} model
 * @param {Terrain} terrain
 * @param {string} name
 * @returns {EyePose | null}
 */
export function beamPose(model, terrain, name) {
  const sensor = model.sensors.find((candidate) => candidate.name === name);
  if (!sensor || !sensor.grid) return null;
  // Wider fans than 100 degrees are not shown whole: their edges would be far too large.
  const spread =
    Math.min(sensor.grid.half_width / sensor.grid.grid_distance, Math.tan((50 * Math.PI) / 180)) * 1.08;
  const [width, height] = [1000, 620];
  const focal = width / 2 / spread;
  return {
    eye: sensor.pose.position,
    axes: axesOfSensor(sensor),
    lens: {
      kind: 'image',
      width,
      height,
      focal: [focal, focal],
      centre: [500, 310],
      zoom: 1,
      u: 500,
      v: 310,
    },
    focus: groundAhead(sensor, groundHeight(model, terrain.bounds)),
    nearest: sensor.grid.grid_distance,
  };
}

/** The place that views of the ray look at. @param {RayStory} story @returns {Point3} */
function middleOfHits(story) {
  const points = hitPointsOf(story);
  if (points.length === 0) return vecAlong(story.ray.origin, story.along, 0.3 * story.maxRange);
  return vecScale(
    points.reduce((sum, point) => vecAdd(sum, point)),
    1 / points.length,
  );
}

/**
 * Along the chosen ray, shortly before its hit.
 * @param {RayStory} story
 * @param {Terrain} terrain
 * @returns {EyePose}
 */
export function rayPose(story, terrain) {
  const focus = story.target ?? middleOfHits(story);
  const range = vecDistance(focus, story.ray.origin);
  const size = viewSize(story, terrain);
  const distance = Math.max(Math.min(size * 2, 0.5 * range), 1e-3 * range);
  const [x, y, z] = story.along;
  return orbitPose(focus, distance, Math.atan2(y, x), Math.asin(Math.max(-1, Math.min(1, -z))));
}

/**
 * Size of what is to be seen about the hits: their distance from each other; if they are one, the face.
 * @param {RayStory} story
 * @param {Terrain} terrain
 */
function viewSize(story, terrain) {
  const points = hitPointsOf(story);
  const spread = spreadOf(points);
  const range = points.length > 0 ? vecLength(vecSub(points[0], story.ray.origin)) : story.maxRange;
  const faces = [
    ...story.sides.flatMap((side) => (side.hit ? [side.hit.face] : [])),
    ...(story.exact?.faces ?? []),
    ...(story.here ? [story.here.face] : []),
  ].filter((face) => terrain.hasFace(face));
  const sides = faces.map((face) => terrain.longestSide(face));
  const face = sides.length > 0 ? Math.min(...sides) : 0.1 * range;
  // Differences below some roundings of a range have no picture; then the face is shown.
  const isPlace = spread > 8 * 2.2e-16 * range;
  return isPlace ? Math.max(3 * spread, SMALLEST_VIEW) : Math.max(1.4 * face, SMALLEST_VIEW);
}

/**
 * The hits from near by, from a side on which no face stands between.
 * @param {RayStory} story
 * @param {Terrain} terrain
 * @param {() => boolean} isStale
 * @returns {Promise<EyePose>}
 */
export async function closePose(story, terrain, isStale) {
  const focus = middleOfHits(story);
  const distance = 1.6 * viewSize(story, terrain);
  const [x, y, z] = story.along;
  const yaw = Math.atan2(y, x);
  const pitch = Math.asin(Math.max(-1, Math.min(1, -z)));
  // The nearest hit must be seen: the others may lie below the ground.
  const points = hitPointsOf(story).sort(
    (a, b) => vecDistance(a, story.ray.origin) - vecDistance(b, story.ray.origin),
  );
  const seen = points[0] ?? focus;
  // From beside the ray its hits lie apart; the nearer to the ray, the less can stand between.
  for (const [turn, tilt] of [
    [-1.1, 0.35],
    [1.1, 0.35],
    [-0.6, 0.3],
    [0.6, 0.3],
    [0, 0.8],
    [0.3, 0.1],
  ]) {
    const pose = orbitPose(focus, distance, yaw + turn, Math.max(0.15, Math.min(1.5, pitch * 0.6 + tilt)));
    const way = { origin: seen, direction: vecSub(pose.eye, seen) };
    const blocked = await firstFaceOnRay(terrain, way, { from: 0.02, to: 1, frontsOnly: false }, isStale);
    if (isStale()) break;
    if (!blocked) return pose;
  }
  return orbitPose(focus, distance, yaw + 0.05, pitch + 0.02);
}
