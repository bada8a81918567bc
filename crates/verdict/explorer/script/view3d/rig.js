// The rig in the scene: the camera with its image plane, the beams with their sheets, the vehicle, axes with
// metres.

import { vecAdd, vecAlong, vecBetween, vecLength, vecScale } from './vector.js';
import { axesOfSensor, pointOfImage, rayOfPlace, sceneFromSensor } from './sensor.js';
import { SceneDrawing } from './drawing.js';
import { roundStep, tickInWords } from './words.js';

/** @typedef {import('./vector.js').Point3} Point3 */
/** @typedef {import('./terrain.js').Bounds3} Bounds3 */
/** @typedef {import('./theme.js').ColourName} ColourName */
/** @typedef {import('./view3d.js').SensorModel} SensorModel */
/** @typedef {import('./view3d.js').PageModel3d} PageModel3d */
/** @typedef {import('./view3d.js').View3dScene} View3dScene */
/**
 * The ends of a sheet's pencils: ranges along the upper and the lower edge, metres, at even steps across the
 * fan.
 * @typedef {{upper: Float64Array, lower: Float64Array}} SheetEnds
 */

/** Colour of a beam. @param {SensorModel} sensor @returns {ColourName} */
export function colourOfBeam(sensor) {
  return /** @type {const} */ (['beam-0', 'beam-1', 'beam-2'])[(sensor.beam ?? 0) % 3];
}

/**
 * Size of the symbols of sensors, metres: also the distance at which the image plane is drawn.
 * @param {PageModel3d} model
 */
export function symbolSize(model) {
  const ranges = model.sensors.map((sensor) => sensor.max_range).filter((range) => range > 0);
  const smallest = ranges.length > 0 ? Math.min(...ranges) : 20;
  return Math.max(1e-3, Math.min(25, smallest * 0.025));
}

/** Steps across the fan of each beam. @param {PageModel3d} model */
function sheetSteps(model) {
  const beams = model.sensors.filter((sensor) => sensor.kind === 'beam').length;
  return beams > 8 ? 24 : 128;
}

/**
 * Reads where the sheet of a beam ends: at the hits that a side has recorded along both edges; where it has
 * none, at the longest range.
 * @param {View3dScene} scene
 * @param {number} index of the sensor
 * @param {number} side -1: none
 * @returns {Promise<SheetEnds>}
 */
export async function readSheetEnds(scene, index, side) {
  const sensor = scene.model.sensors[index];
  const steps = sheetSteps(scene.model);
  /** @type {SheetEnds} */
  const ends = { upper: new Float64Array(steps + 1), lower: new Float64Array(steps + 1) };
  const has = side >= 0 && 'range.T' in (sensor.sides?.[side]?.channels ?? {});
  for (const [edge, row] of /** @type {const} */ ([
    ['upper', 0],
    ['lower', sensor.height - 1],
  ])) {
    for (let step = 0; step <= steps; step++) {
      const column = Math.min(sensor.width - 1, Math.floor((step / steps) * sensor.width));
      const range = has ? await scene.valueAt(index, side, 'range.T', row * sensor.width + column) : Infinity;
      ends[edge][step] = range > 0 && range < sensor.max_range ? range : sensor.max_range;
    }
  }
  return ends;
}

/**
 * The camera: body, image plane with the edges of its field of view.
 * @param {SceneDrawing} drawing
 * @param {SensorModel} sensor
 * @param {number} size metres
 */
export function drawCamera(drawing, sensor, size) {
  const place = (/** @type {Point3} */ local) => sceneFromSensor(sensor, vecScale(local, size));
  drawing.box([-0.13, -0.1, -0.36], [0.13, 0.1, -0.04], place, 'camera');
  const centre = sensor.pose.position;
  const corners = /** @type {const} */ ([
    [0, 0],
    [1, 0],
    [1, 1],
    [0, 1],
  ]).map(([u, v]) => pointOfImage(sensor, u * sensor.width, v * sensor.height, size));
  drawing.area(corners, 'camera', 0.14);
  drawing.path(corners, 'camera', { width: 1.5 }, 1, true);
  const reach = Math.max(2, (sensor.max_range * 0.3) / size);
  for (const corner of corners) {
    drawing.line(centre, corner, 'camera', { width: 1.2 });
    drawing.line(corner, vecBetween(centre, corner, reach), 'camera', { width: 1, dash: [3, 5] }, 0.6);
  }
  // A short line at the top edge tells which way is up on the image.
  const [left, right] = [
    pointOfImage(sensor, sensor.width * 0.44, 0, size),
    pointOfImage(sensor, sensor.width * 0.56, 0, size),
  ];
  const up = vecScale(axesOfSensor(sensor).down, -0.1 * size);
  drawing.area([left, right, vecAdd(vecBetween(left, right, 0.5), up)], 'camera', 0.8);
  drawing.label(place([0, -0.1, -0.3]), sensor.name, 'camera', 4);
}

/** A beam's head. @param {SceneDrawing} drawing @param {SensorModel} sensor @param {number} size metres */
export function drawBeamHead(drawing, sensor, size) {
  const place = (/** @type {Point3} */ local) => sceneFromSensor(sensor, vecScale(local, size));
  drawing.box([-0.1, -0.05, -0.24], [0.1, 0.05, 0], place, colourOfBeam(sensor));
  drawing.label(place([0, -0.05, -0.2]), sensor.name, colourOfBeam(sensor), 4);
}

/**
 * A beam's sheet of light, as thick as it is: its upper and its lower side, its two edges, the line where it
 * ends on the ground. The lower edge is drawn stronger.
 * @param {SceneDrawing} drawing for lines
 * @param {SceneDrawing} areas for the translucent sides
 * @param {SensorModel} sensor
 * @param {SheetEnds | null} ends null: not known yet
 */
export function drawSheet(drawing, areas, sensor, ends) {
  if (!sensor.grid) return;
  const colour = colourOfBeam(sensor);
  const steps = ends ? ends.lower.length - 1 : 32;
  for (const [edge, row] of /** @type {const} */ ([
    ['upper', -0.5],
    ['lower', sensor.height - 0.5],
  ])) {
    const isLower = edge === 'lower';
    const at = (/** @type {number} */ step, /** @type {number} */ range) => {
      const ray = rayOfPlace(sensor, (step / steps) * sensor.width - 0.5, row);
      return ray
        ? vecAlong(ray.origin, ray.direction, range / vecLength(ray.direction))
        : sensor.pose.position;
    };
    const range = (/** @type {number} */ step) => (ends ? ends[edge][step] : sensor.max_range);
    const origin = at(0, 0);
    for (let step = 0; step < steps; step++) {
      const [near, far] = [Math.min(range(step), range(step + 1)), Math.max(range(step), range(step + 1))];
      // A jump from one surface to another: light ends at the nearer one, and no line joins them.
      const isJump = far > near * 1.08;
      const left = at(step, isJump ? near : range(step));
      const right = at(step + 1, isJump ? near : range(step + 1));
      areas.area([origin, left, right], colour, 0.12);
      if (!isJump && ends && far < sensor.max_range) {
        drawing.line(left, right, colour, { width: isLower ? 2 : 1, ghost: isLower }, isLower ? 1 : 0.5);
      }
    }
    for (const step of [0, steps]) {
      drawing.line(
        origin,
        at(step, range(step)),
        colour,
        { width: isLower ? 1.8 : 0.8 },
        isLower ? 0.95 : 0.4,
      );
    }
  }
}

/**
 * The vehicle's axes, and lines from its origin to its sensors.
 * @param {SceneDrawing} drawing
 * @param {PageModel3d} model
 * @param {number} size metres
 */
export function drawVehicle(drawing, model, size) {
  const { vehicle } = model;
  if (!vehicle) return;
  const origin = vehicle.position;
  const names = /** @type {const} */ ([
    ['axis-x', 'x forward'],
    ['axis-y', 'y left'],
    ['axis-z', 'z up'],
  ]);
  names.forEach(([colour, word], axis) => {
    const tip = vecAlong(origin, vehicle.axes[axis], 1.2 * size);
    drawing.line(origin, tip, colour, { width: 2.5, ghost: true });
    drawing.label(tip, word, colour, 0.6);
  });
  drawing.mark(origin, 'dot', 'ink');
  drawing.label(origin, 'vehicle', 'ink', 3);
  for (const sensor of model.sensors.slice(0, 8)) {
    drawing.line(origin, sensor.pose.position, 'soft', { width: 1, dash: [2, 4] }, 0.7);
  }
}

/**
 * The axes of the scene with metres, at those lower edges of a box that are nearest to the eye.
 * @param {SceneDrawing} drawing
 * @param {Bounds3} box
 * @param {Point3} eye
 */
export function drawSceneAxes(drawing, box, eye) {
  const { low, high } = box;
  const nearX = eye[0] < (low[0] + high[0]) / 2 ? low[0] : high[0];
  const nearY = eye[1] < (low[1] + high[1]) / 2 ? low[1] : high[1];
  const otherX = nearX === low[0] ? high[0] : low[0];
  const step = roundStep(Math.max(high[0] - low[0], high[1] - low[1]) / 5);
  const axes = /** @type {const} */ ([
    [0, 'x', (/** @type {number} */ x) => /** @type {Point3} */ ([x, nearY, low[2]]), 'axis-x'],
    [1, 'y', (/** @type {number} */ y) => /** @type {Point3} */ ([nearX, y, low[2]]), 'axis-y'],
    [2, 'z', (/** @type {number} */ z) => /** @type {Point3} */ ([otherX, nearY, z]), 'axis-z'],
  ]);
  for (const [axis, name, at, colour] of axes) {
    if (!(high[axis] > low[axis])) continue;
    const own = axis === 2 ? Math.min(step, roundStep((high[2] - low[2]) / 2)) : step;
    drawing.line(at(low[axis]), at(high[axis]), colour, { width: 1.2, ghost: true }, 0.9);
    const tick = 0.012 * Math.max(high[0] - low[0], high[1] - low[1]);
    for (let k = Math.ceil(low[axis] / own - 1e-9); k * own <= high[axis] + 1e-9 * own; k++) {
      const place = at(k * own);
      const out =
        axis === 0
          ? vecAdd(place, [0, nearY === low[1] ? -tick : tick, 0])
          : vecAdd(place, [(axis === 1 ? nearX : otherX) === low[0] ? -tick : tick, 0, 0]);
      drawing.line(place, out, colour, { width: 1.2 }, 0.9);
      drawing.labels.push({ at: out, text: tickInWords(k * own, own), colour, priority: 0.3, isTick: true });
    }
    drawing.label(at(axis === 2 ? high[2] : (low[axis] + high[axis]) / 2), `${name} (m)`, colour, 0.8);
  }
}
