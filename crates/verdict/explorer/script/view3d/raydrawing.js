// The chosen ray in the scene: the ways of both sides, the exact hit, a witness, the faces, the light to the
// camera.

import { vecAlong, vecScale } from './vector.js';
import { pointOfImage } from './sensor.js';
import { SceneDrawing } from './drawing.js';
import { colourOfBeam } from './rig.js';
import { facesInWords, rangeInWords } from './words.js';

/** @typedef {import('./vector.js').Point3} Point3 */
/** @typedef {import('./theme.js').ColourName} ColourName */
/** @typedef {import('./terrain.js').Terrain} Terrain */
/** @typedef {import('./story.js').RayStory} RayStory */
/** @typedef {import('./view3d.js').PageModel3d} PageModel3d */

/** Faces that one ray may highlight: many faces can meet in a vertex. */
const MOST_FACES = 40;

/**
 * Everything about the chosen ray.
 * @param {RayStory} story
 * @param {Terrain} terrain
 * @param {PageModel3d} model
 * @param {number} size of the symbols, metres
 * @returns {SceneDrawing}
 */
export function drawingOfRay(story, terrain, model, size) {
  const drawing = new SceneDrawing();
  const origin = story.ray.origin;
  drawing.mark(origin, 'dot', 'ink');
  drawing.label(origin, `${story.sensorName} (${story.i}, ${story.j})`, 'ink', 6);
  drawFaces(drawing, story, terrain);
  drawSides(drawing, story);
  for (const witness of story.witnesses) {
    const end = witness.hit?.point ?? alongRay(story, missLength(story));
    drawing.line(witness.ray.origin, end, 'witness', { width: 1.6, dash: [6, 5], ghost: true });
    const what = witness.hit ? `face ${witness.hit.face}` : 'a miss';
    drawing.label(vecAlong(end, story.along, 0), `witness: ${what}`, 'witness', 4.5);
  }
  drawView(drawing, story, terrain);
  drawPixel(drawing, story, model, size);
  return drawing;
}

/**
 * The path of the light alone: laser, ground, camera.
 * @param {RayStory} story
 * @param {Terrain} terrain
 * @param {PageModel3d} model
 * @param {number} size metres
 * @returns {SceneDrawing}
 */
export function drawingOfLight(story, terrain, model, size) {
  const drawing = new SceneDrawing();
  if (model.sensors[story.sensor].kind === 'camera') {
    const camera = model.sensors[story.sensor].pose.position;
    for (const pencil of story.pencils) {
      const colour = colourOfBeam(model.sensors[pencil.sensor]);
      drawing.line(pencil.from, pencil.hit, colour, { width: 2, arrow: true, ghost: true });
      drawing.line(pencil.hit, camera, 'seen', { width: 1.5, arrow: true, ghost: true });
      drawing.mark(pencil.hit, 'dot', colour);
    }
    if (story.pencils.length === 0) {
      drawing.label(story.target ?? story.ray.origin, 'no pencil lands in this pixel', 'soft', 6);
    }
  } else {
    const end = story.view?.from ?? alongRay(story, missLength(story));
    drawing.line(story.ray.origin, end, colourOfBeam(model.sensors[story.sensor]), {
      width: 3.5,
      arrow: true,
      ghost: true,
    });
    drawing.mark(story.ray.origin, 'dot', 'ink');
    drawing.label(story.ray.origin, 'laser', 'ink', 6);
    if (story.view) {
      drawing.mark(end, 'plus', 'exact');
      drawing.label(end, 'ground', 'ink', 6);
    } else {
      drawing.label(end, 'no hit', 'soft', 6);
    }
    drawView(drawing, story, terrain);
  }
  drawPixel(drawing, story, model, size);
  return drawing;
}

/**
 * Edges of faces, each once.
 * @param {SceneDrawing} drawing
 * @param {number[]} faces
 * @param {Terrain} terrain
 */
export function drawWireframe(drawing, faces, terrain) {
  /** @type {Set<string>} */
  const known = new Set();
  for (const face of faces) {
    if (!terrain.hasFace(face)) continue;
    const corners = terrain.corners(face);
    for (let k = 0; k < 3; k++) {
      const [from, to] = [terrain.faces[3 * face + k], terrain.faces[3 * face + ((k + 1) % 3)]];
      const name = from < to ? `${from} ${to}` : `${to} ${from}`;
      if (known.has(name)) continue;
      known.add(name);
      drawing.line(corners[k], corners[(k + 1) % 3], 'ink', { width: 1 }, 0.45);
    }
  }
}

/** How far a ray without a hit is drawn. @param {RayStory} story */
function missLength(story) {
  const ranges = story.sides.flatMap((side) => (side.hit ? [side.hit.range] : []));
  if (story.exact?.range) ranges.push(story.exact.range);
  if (story.here) ranges.push(story.here.range);
  return ranges.length > 0 ? Math.min(1.3 * Math.max(...ranges), story.maxRange) : 0.4 * story.maxRange;
}

/** @param {RayStory} story @param {number} range metres @returns {Point3} */
function alongRay(story, range) {
  return vecAlong(story.ray.origin, story.along, range);
}

/** @param {SceneDrawing} drawing @param {RayStory} story */
function drawSides(drawing, story) {
  const { origin } = story.ray;
  const point = story.exact ? story.exact.point : (story.here?.point ?? null);
  // The three ways mostly coincide: the exact one is a wide pale band, that of A lies in it, the dashes of B
  // lie on both.
  drawing.line(origin, point ?? alongRay(story, missLength(story)), 'exact', { width: 10, ghost: true }, 0.3);
  const looks = /** @type {const} */ ({
    A: { colour: 'a', shape: 'circle', width: 5, dash: undefined, opacity: 1 },
    B: { colour: 'b', shape: 'square', width: 2.8, dash: [11, 9], opacity: 1 },
  });
  for (const side of story.sides) {
    if (!side.isGiven) continue;
    const { colour, shape, width, dash, opacity } = looks[side.letter];
    const name = `${side.letter} ${side.name}`;
    if (side.hit) {
      /** @type {[number, number] | undefined} */
      const dashes = dash ? [dash[0], dash[1]] : undefined;
      drawing.line(origin, side.hit.point, colour, { width, dash: dashes, ghost: true }, opacity);
      drawing.mark(side.hit.point, shape, colour);
      drawing.label(side.hit.point, `${name}: ${rangeInWords(side.hit.range, story.difference)}`, colour, 9);
    } else {
      const end = alongRay(story, missLength(story));
      drawing.line(
        origin,
        end,
        colour,
        { width: 2, dash: side.letter === 'A' ? [2, 6] : [2, 9], ghost: true },
        0.9,
      );
      drawing.label(end, `${name}: misses`, colour, 8);
    }
  }
  if (point) {
    const range = story.exact?.range ?? story.here?.range ?? NaN;
    drawing.mark(point, 'plus', 'exact');
    drawing.label(
      point,
      `${story.exact ? 'exact' : 'computed here'}: ${rangeInWords(range, story.difference)}`,
      'exact',
      8.5,
    );
  } else if (story.sides.every((side) => side.hit || !side.isGiven)) {
    const end = alongRay(story, missLength(story));
    drawing.label(end, `${story.exact ? 'exact' : 'computed here'}: no hit`, 'exact', 8);
  }
}

/** @param {SceneDrawing} drawing @param {RayStory} story @param {Terrain} terrain */
function drawFaces(drawing, story, terrain) {
  /** @type {Map<number, string[]>} */
  const names = new Map();
  const add = (/** @type {number} */ face, /** @type {string} */ name) => {
    if (terrain.hasFace(face)) names.set(face, [...(names.get(face) ?? []), name]);
  };
  for (const side of story.sides) if (side.hit) add(side.hit.face, side.letter);
  for (const face of (story.exact?.faces ?? []).slice(0, MOST_FACES)) add(face, 'exact');
  if (!story.exact && story.here) add(story.here.face, 'computed here');
  for (const witness of story.witnesses) if (witness.hit) add(witness.hit.face, 'witness');
  for (const [face, of] of names) {
    const both = of.includes('A') && of.includes('B');
    const isWitness = of.length === 1 && of[0] === 'witness';
    /** @type {ColourName} */
    const colour = both
      ? 'exact'
      : of.includes('A')
        ? 'a'
        : of.includes('B')
          ? 'b'
          : isWitness
            ? 'witness'
            : 'exact';
    const corners = terrain.corners(face);
    drawing.area(corners, colour, isWitness ? 0.16 : both ? 0.22 : 0.34);
    drawing.path(corners, colour, { width: 2, ghost: true }, 1, true);
    drawing.label(centreOf(corners), `${facesInWords([face])} (${of.join(', ')})`, colour, 5);
  }
}

/** @param {SceneDrawing} drawing @param {RayStory} story @param {Terrain} terrain */
function drawView(drawing, story, terrain) {
  const { view } = story;
  if (!view) return;
  if (view.state === 'clear') {
    drawing.line(view.from, view.to, 'seen', { width: 2.2, arrow: true, ghost: true });
    return;
  }
  const { occluder } = view;
  const start = view.state === 'hidden' && occluder ? occluder.point : view.from;
  if (start !== view.from) drawing.line(view.from, start, 'seen', { width: 2.2, ghost: true });
  drawing.line(start, view.to, 'blocked', { width: 2, dash: [7, 7], ghost: true });
  if (view.state === 'hidden' && occluder) {
    drawing.mark(occluder.point, 'cross', 'blocked');
    if (terrain.hasFace(occluder.face)) {
      const corners = terrain.corners(occluder.face);
      drawing.area(corners, 'blocked', 0.22);
      drawing.path(corners, 'blocked', { width: 1.6, ghost: true }, 1, true);
    }
    drawing.label(occluder.point, `hidden by face ${occluder.face}`, 'blocked', 7);
  } else if (view.state === 'turned') {
    drawing.label(view.from, 'face turned away from the camera', 'blocked', 7);
  }
}

/**
 * The pixel of the ray on the camera's image plane.
 * @param {SceneDrawing} drawing
 * @param {RayStory} story
 * @param {PageModel3d} model
 * @param {number} size distance of the image plane that is drawn, metres
 */
function drawPixel(drawing, story, model, size) {
  const camera = model.sensors.find((sensor) => sensor.kind === 'camera' && sensor.camera);
  if (!camera) return;
  const own = model.sensors[story.sensor] === camera;
  const image = own ? { u: story.i, v: story.j, onImage: true } : story.view?.image;
  if (!image || !image.onImage) return;
  const [i, j] = [Math.floor(image.u), Math.floor(image.v)];
  const at = (/** @type {number} */ u, /** @type {number} */ v) => pointOfImage(camera, u, v, size);
  const colour = story.view && story.view.state !== 'clear' ? 'blocked' : 'seen';
  drawing.line(at(0, j + 0.5), at(camera.width, j + 0.5), colour, { width: 1 }, 0.7);
  drawing.line(at(i + 0.5, 0), at(i + 0.5, camera.height), colour, { width: 1 }, 0.7);
  drawing.mark(at(i + 0.5, j + 0.5), 'pixel', colour);
  drawing.label(at(i + 0.5, j + 0.5), `pixel (${i}, ${j})`, colour, 6.5);
}

/** @param {Point3[]} corners @returns {Point3} */
function centreOf(corners) {
  return vecScale(
    corners.reduce((sum, corner) => vecAlong(sum, corner, 1), /** @type {Point3} */ ([0, 0, 0])),
    1 / corners.length,
  );
}
