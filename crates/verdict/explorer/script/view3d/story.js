// What is known of one ray: the answers of both sides, the exact one, a witness, the view to the camera.

import { vecAlong, vecDistance, vecDot, vecLength, vecSub, vecUnit } from './vector.js';
import { cellWordOf, imageOfPoint, rayOfPlace } from './sensor.js';
import { firstFaceOnRay, firstHitOfSensor } from './search.js';

/** @typedef {import('./vector.js').Point3} Point3 */
/** @typedef {import('./sensor.js').Ray3} Ray3 */
/** @typedef {import('./terrain.js').Terrain} Terrain */
/** @typedef {import('./view3d.js').View3dScene} View3dScene */
/** @typedef {import('./view3d.js').RayRequest} RayRequest */
/** @typedef {import('./view3d.js').ArrayRef} ArrayRef */
/** @typedef {{face: number, point: Point3, range: number}} HitOf */
/**
 * @typedef {object} SideAnswer
 * @property {'A' | 'B'} letter
 * @property {number} side index of the side
 * @property {string} name
 * @property {boolean} isGiven whether this side answers for this sensor at all
 * @property {HitOf | null} hit null: it misses
 * @property {boolean | null} visible whether it says that the camera sees the hit; null: not given
 * @property {[number, number] | null} pixel
 */
/**
 * The way of the light from the hit to the camera.
 * @typedef {object} ViewToCamera
 * @property {Point3} from
 * @property {Point3} to the camera's projection centre
 * @property {'clear' | 'hidden' | 'turned' | 'behind'} state hidden: by another face; turned: the face shows
 *   the camera its
 *   back; behind: the hit is not before the camera
 * @property {HitOf | null} occluder the first face on the way; its range is the distance from the hit
 * @property {{u: number, v: number, onImage: boolean} | null} image
 */
/**
 * @typedef {object} WitnessRay
 * @property {'face' | 'surface' | 'visibility'} kind what is otherwise on it
 * @property {[number, number]} displacement cells
 * @property {Ray3} ray
 * @property {HitOf | null} hit
 */
/**
 * @typedef {object} RayStory
 * @property {number} sensor
 * @property {number} cell
 * @property {number} i
 * @property {number} j
 * @property {string} sensorName
 * @property {string} cellWord
 * @property {Ray3} ray
 * @property {Point3} along unit vector
 * @property {number} maxRange
 * @property {SideAnswer[]} sides
 * @property {{faces: number[], point: Point3 | null, range: number | null, visible: boolean | null,
 *   pixel: [number, number] | null} | null} exact null: this ray is not described in full
 * @property {HitOf | null} here what this page finds in double precision
 * @property {WitnessRay[]} witnesses
 * @property {Point3 | null} target the hit from which the light goes on
 * @property {ViewToCamera | null} view
 * @property {number} difference of the ranges of the hits, metres: largest less smallest
 * @property {number | null} rangeUlps range of B minus that of A, units in the last place
 * @property {{sensor: number, cell: number, from: Point3, hit: Point3}[]} pencils that land in this pixel of
 *   the camera
 * @property {number} pencilCount number of them; the list may be shorter
 */

const NO_FACE = 4294967295;
/** Pencils of one pixel that are drawn. */
const PENCILS_DRAWN = 24;

/**
 * Gathers all that is known of a ray.
 * @param {View3dScene} scene
 * @param {Terrain} terrain
 * @param {RayRequest} request
 * @param {() => boolean} isStale whether another ray was asked for meanwhile
 * @returns {Promise<RayStory | null>} null if stale, or if there is no such ray
 */
export async function storyOfRay(scene, terrain, request, isStale) {
  const { model } = scene;
  const sensor = model.sensors[request.sensor];
  if (!sensor || !(request.cell >= 0 && request.cell < sensor.width * sensor.height)) return null;
  const i = request.cell % sensor.width;
  const j = Math.floor(request.cell / sensor.width);
  const ray = rayOf(scene, request, i, j);
  if (!ray) return null;
  const pair = request.pair === null || request.pair === undefined ? undefined : sensor.pairs?.[request.pair];
  const sides = await Promise.all(
    sidesShown(scene, request, pair).map((side, k) =>
      answerOfSide(scene, terrain, request, side, k === 0 ? 'A' : 'B', ray),
    ),
  );
  const here = hitOn(ray, await firstHitOfSensor(terrain, ray, sensor.max_range, isStale));
  if (isStale()) return null;
  const exact = request.ray?.exact ?? null;
  const witnesses = await witnessesOf(request, sensor, terrain, i, j, isStale);
  const target = exact ? exact.point : (here?.point ?? sides.find((side) => side.hit)?.hit?.point ?? null);
  const faces = exact
    ? exact.faces
    : here
      ? [here.face]
      : sides.flatMap((side) => (side.hit ? [side.hit.face] : []));
  const fallback = target ?? sides.find((side) => side.hit)?.hit?.point ?? null;
  const view =
    sensor.kind === 'beam' && fallback
      ? await viewToCamera(
          scene,
          terrain,
          fallback,
          target ? faces : sides.flatMap((side) => (side.hit ? [side.hit.face] : [])),
          isStale,
        )
      : null;
  const landed =
    sensor.kind === 'camera' ? await pencilsInPixel(scene, terrain, sides[0]?.side ?? 0, i, j) : [];
  if (isStale()) return null;
  const ranges = [...sides.map((side) => side.hit?.range), exact?.range].filter(
    (range) => typeof range === 'number',
  );
  return {
    difference: ranges.length > 0 ? Math.max(...ranges) - Math.min(...ranges) : 0,
    sensor: request.sensor,
    cell: request.cell,
    i,
    j,
    sensorName: sensor.name,
    cellWord: cellWordOf(sensor),
    ray,
    along: vecUnit(ray.direction),
    maxRange: sensor.max_range,
    sides,
    exact,
    here,
    witnesses,
    target,
    view,
    rangeUlps: await ulpsOf(scene, pair, request.cell),
    pencils: landed.slice(0, PENCILS_DRAWN),
    pencilCount: landed.length,
  };
}

/**
 * The hit points of a story that differ in place, with those that all agree on as one.
 * @param {RayStory} story
 * @returns {Point3[]}
 */
export function hitPointsOf(story) {
  const points = story.sides.flatMap((side) => (side.hit ? [side.hit.point] : []));
  if (story.exact?.point) points.push(story.exact.point);
  else if (story.here) points.push(story.here.point);
  return points;
}

/**
 * @param {View3dScene} scene
 * @param {RayRequest} request
 * @param {number} i
 * @param {number} j
 * @returns {Ray3 | null}
 */
function rayOf(scene, request, i, j) {
  const given = scene.ray ? scene.ray(request.sensor, request.cell) : null;
  if (!given) return rayOfPlace(scene.model.sensors[request.sensor], i, j);
  const { origin: o, direction: q } = given;
  return { origin: [o[0], o[1], o[2]], direction: [q[0], q[1], q[2]] };
}

/**
 * Indices of the two sides that are shown.
 * @param {View3dScene} scene
 * @param {RayRequest} request
 * @param {{a: number, b: number} | undefined} pair
 */
function sidesShown(scene, request, pair) {
  if (pair) return [pair.a, pair.b];
  const sides = scene.model.sensors[request.sensor].sides ?? [];
  return sides
    .map((_, index) => index)
    .filter((index) => sides[index])
    .slice(0, 2);
}

/**
 * A number of a channel; NaN if it is not given.
 * @param {View3dScene} scene
 * @param {number} sensor
 * @param {number} side
 * @param {string} channel
 * @param {number} cell
 * @returns {Promise<number>}
 */
async function valueOrNaN(scene, sensor, side, channel, cell) {
  const channels = scene.model.sensors[sensor].sides?.[side]?.channels;
  if (!channels || !(channel in channels)) return NaN;
  try {
    const value = await scene.valueAt(sensor, side, channel, cell);
    return typeof value === 'number' ? value : NaN;
  } catch {
    return NaN;
  }
}

/**
 * @param {View3dScene} scene
 * @param {Terrain} terrain
 * @param {RayRequest} request
 * @param {number} side
 * @param {'A' | 'B'} letter
 * @param {Ray3} ray
 * @returns {Promise<SideAnswer>}
 */
async function answerOfSide(scene, terrain, request, side, letter, ray) {
  const { sensor, cell } = request;
  const ask = (/** @type {string} */ channel) => valueOrNaN(scene, sensor, side, channel, cell);
  const [face, range, visible, pixelI, pixelJ] = await Promise.all(
    ['face.I', 'range.T', 'visible.V', 'pixel.I', 'pixel.J'].map(ask),
  );
  const direction = vecUnit(ray.direction);
  /** @type {HitOf | null} */
  let hit = null;
  const hasFace = terrain.hasFace(face);
  if (hasFace || (Number.isFinite(range) && !(face === NO_FACE))) {
    // The range of the face's plane before it was rounded, if it is the recorded one; else the recorded one.
    const exactT = hasFace ? terrain.planeHit(face, ray) : NaN;
    const planeRange = exactT * vecLength(ray.direction);
    const recorded = Number.isFinite(range) ? range : planeRange;
    const isDerived = Number.isFinite(planeRange) && Math.fround(planeRange) === Math.fround(recorded);
    const used = isDerived ? planeRange : recorded;
    const point = isDerived
      ? vecAlong(ray.origin, ray.direction, exactT)
      : vecAlong(ray.origin, direction, used);
    if (Number.isFinite(used)) hit = { face: hasFace ? face : -1, range: used, point };
  }
  return {
    letter,
    side,
    name: scene.model.sides?.[side]?.name ?? `side ${side + 1}`,
    hit,
    isGiven: !(Number.isNaN(face) && Number.isNaN(range)),
    visible: Number.isNaN(visible) ? null : visible !== 0,
    pixel: Number.isNaN(pixelI) || pixelI === NO_FACE ? null : [pixelI, pixelJ],
  };
}

/** @param {Ray3} ray @param {{face: number, t: number} | null} found @returns {HitOf | null} */
function hitOn(ray, found) {
  if (!found) return null;
  return {
    face: found.face,
    point: vecAlong(ray.origin, ray.direction, found.t),
    range: found.t * vecLength(ray.direction),
  };
}

/**
 * @param {RayRequest} request
 * @param {import('./view3d.js').SensorModel} sensor
 * @param {Terrain} terrain
 * @param {number} i
 * @param {number} j
 * @param {() => boolean} isStale
 * @returns {Promise<WitnessRay[]>}
 */
async function witnessesOf(request, sensor, terrain, i, j, isStale) {
  /** @type {WitnessRay[]} */
  const found = [];
  for (const kind of /** @type {const} */ (['face', 'surface', 'visibility'])) {
    const displacement = request.ray?.witness?.[kind];
    if (!displacement) continue;
    const [dx, dy] = displacement;
    if (found.some((other) => other.displacement[0] === dx && other.displacement[1] === dy)) continue;
    const ray = rayOfPlace(sensor, i + dx, j + dy);
    if (!ray) continue;
    const hit = hitOn(ray, await firstHitOfSensor(terrain, ray, sensor.max_range, isStale));
    found.push({ kind, displacement: [dx, dy], ray, hit });
  }
  return found;
}

/**
 * Follows the light from a hit to the camera. Any face between hides the hit, its front or its back; the
 * faces of the hit itself do not, and no face before the camera's projection plane does.
 * @param {View3dScene} scene
 * @param {Terrain} terrain
 * @param {Point3} from
 * @param {number[]} faces
 * @param {() => boolean} isStale
 * @returns {Promise<ViewToCamera | null>}
 */
async function viewToCamera(scene, terrain, from, faces, isStale) {
  const camera = scene.model.sensors.find((sensor) => sensor.kind === 'camera' && sensor.camera);
  if (!camera || !camera.camera) return null;
  const to = camera.pose.position;
  const image = imageOfPoint(camera, from);
  const direction = vecSub(to, from);
  if (!image) return { from, to, state: 'behind', occluder: null, image: null };
  const known = faces.filter((face) => terrain.hasFace(face));
  const showsFront = known.length === 0 || known.some((face) => vecDot(terrain.normal(face), direction) > 0);
  const limits = {
    from: 1e-9,
    to: 1 - camera.camera.focal_length / image.depth,
    frontsOnly: false,
    skip: new Set(known),
  };
  const found = await firstFaceOnRay(terrain, { origin: from, direction }, limits, isStale);
  const occluder = hitOn({ origin: from, direction }, found);
  return { from, to, state: !showsFront ? 'turned' : occluder ? 'hidden' : 'clear', occluder, image };
}

/**
 * @param {View3dScene} scene
 * @param {{range_ulps?: ArrayRef | null} | undefined} pair
 * @param {number} cell
 * @returns {Promise<number | null>}
 */
async function ulpsOf(scene, pair, cell) {
  if (!pair?.range_ulps) return null;
  try {
    return Number((await scene.decode(pair.range_ulps))[cell]);
  } catch {
    return null;
  }
}

/**
 * The pencils of all beams that land in a pixel of the camera and are visible, by what one side has recorded.
 * @param {View3dScene} scene
 * @param {Terrain} terrain
 * @param {number} side
 * @param {number} i
 * @param {number} j
 */
async function pencilsInPixel(scene, terrain, side, i, j) {
  /** @type {{sensor: number, cell: number, from: Point3, hit: Point3}[]} */
  const landed = [];
  for (const [index, sensor] of scene.model.sensors.entries()) {
    const channels = sensor.kind === 'beam' ? sensor.sides?.[side]?.channels : null;
    const [columns, rows, seen, faces] = ['pixel.I', 'pixel.J', 'visible.V', 'face.I'].map(
      (name) => channels?.[name]?.stored ?? null,
    );
    if (!columns || !rows || !seen || !faces) continue;
    try {
      const arrays = await Promise.all(
        [columns, rows, seen, faces].map((reference) => scene.decode(reference)),
      );
      for (let cell = 0; cell < sensor.width * sensor.height; cell++) {
        if (arrays[0][cell] !== i || arrays[1][cell] !== j || !arrays[2][cell]) continue;
        const ray = rayOfPlace(sensor, cell % sensor.width, Math.floor(cell / sensor.width));
        const face = Number(arrays[3][cell]);
        if (!ray || !terrain.hasFace(face)) continue;
        landed.push({
          sensor: index,
          cell,
          from: ray.origin,
          hit: vecAlong(ray.origin, ray.direction, terrain.planeHit(face, ray)),
        });
      }
    } catch {
      // A beam whose arrays cannot be read has no pencils here.
    }
  }
  return landed;
}

/** Largest distance between points, metres. @param {Point3[]} points */
export function spreadOf(points) {
  let largest = 0;
  for (let a = 0; a < points.length; a++) {
    for (let b = a + 1; b < points.length; b++)
      largest = Math.max(largest, vecDistance(points[a], points[b]));
  }
  return largest;
}
