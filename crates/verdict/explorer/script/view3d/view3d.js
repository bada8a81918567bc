// The 3-D panel: the terrain, the rig and one chosen ray, to be looked at from everywhere.
//
// Use: `const view = new View3d(host, scene); await view.showRay({ sensor, cell, pair, ray });`
// The panel fills `host`, which may be hidden at first. It needs of the scene:
//   model      the page model; `sensors`, `sides`, `mesh`, `vehicle` are read
//   decode     array reference => typed array, decoded once by its owner (mesh, range_ulps, stored channels)
//   ray        (sensor, cell) => { origin, direction }, or null; if it is absent the panel computes the ray
//   valueAt    (sensor, side, channel, cell) => the recorded number; asked only for channels that the model
// lists A request: sensor and cell by index; `pair` an index of the sensor's pairs, or null (then its first
// two sides are A and B); `ray` the entry of the model's `rays`, or null (then this page finds the hit, in
// double precision). Without WebGL2 the words under the picture still come.
//
// Hooks for tests: `.view3d[data-state]` loading, ready, failed, lost; `[data-view]` the view that is shown
// ('' if it was changed by hand); `[data-ray]` "sensor/cell" once a ray is shown; `[data-frames]` frames
// drawn; buttons `button[data-view=NAME]`, `input[data-show=NAME]`, `select[data-colour]`; `.view3d-caption`,
// `.view3d-label`, `.view3d-message`, `.view3d-notes`. Methods `project`, `frameTimes`, `setView`; `times`
// has milliseconds.

import { Terrain } from './terrain.js';
import { facesNearPoint } from './search.js';
import { storyOfRay } from './story.js';
import { captionOfRay } from './caption.js';
import { ViewPanel } from './panel.js';
import { ViewPicture } from './picture.js';
import { readSheetEnds } from './rig.js';
import { boundsOfInterest, cameraPose, beamPose, closePose, overviewPose } from './views.js';
import { rayPose, topPose, yawOfRig } from './views.js';

/** @typedef {import('./vector.js').Point3} Point3 */
/** @typedef {import('./story.js').RayStory} RayStory */
/** @typedef {import('./rig.js').SheetEnds} SheetEnds */
/** @typedef {import('./camera.js').EyePose} EyePose */
/** @typedef {{array: number, type: string, count: number, steps: unknown[]}} ArrayRef */
/**
 * @typedef {ArrayLike<number> & {readonly buffer: ArrayBufferLike, readonly length: number}} NumberArray
 * @typedef {{stored?: ArrayRef, derived?: {cells: ArrayRef, bits: ArrayRef}}} ChannelModel
 */
/**
 * @typedef {object} SensorModel
 * @property {string} name
 * @property {'camera' | 'beam'} kind
 * @property {number | null} beam
 * @property {number} width
 * @property {number} height
 * @property {number} max_range metres
 * @property {{position: Point3, quaternion: [number, number, number, number]}} pose
 * @property {{pixel_pitch: [number, number], principal_point: [number, number], focal_length: number} | null}
 *   camera
 * @property {{half_width: number, thickness: number, grid_distance: number} | null} grid
 * @property {({channels: Record<string, ChannelModel>} | null)[]} [sides]
 * @property {{a: number, b: number, range_ulps?: ArrayRef | null}[]} [pairs]
 */
/**
 * @typedef {object} PageModel3d
 * @property {{origin: Point3, vertices: ArrayRef, faces: ArrayRef, materials: ArrayRef, material_names:
 *   string[]}} mesh
 * @property {{position: Point3, axes: [Point3, Point3, Point3]} | null} vehicle
 * @property {{name: string}[]} sides
 * @property {SensorModel[]} sensors
 */
/**
 * @typedef {object} View3dScene
 * @property {PageModel3d} model
 * @property {(reference: ArrayRef) => Promise<ArrayLike<number>>} decode
 * @property {(sensor: number, cell: number) => ({origin: ArrayLike<number>, direction: ArrayLike<number>} |
 *   null)} [ray]
 * @property {(sensor: number, side: number, channel: string, cell: number) => Promise<number>} valueAt
 */
/**
 * @typedef {object} DescribedRay3d
 * @property {{faces: number[], point: Point3 | null, range: number | null, visible: boolean | null,
 *   pixel: [number, number] | null}} exact
 * @property {{face?: [number, number] | null, surface?: [number, number] | null,
 *   visibility?: [number, number] | null}} [witness]
 */
/** @typedef {{sensor: number, cell: number, pair?: number | null, ray?: DescribedRay3d | null}} RayRequest */
/** @typedef {{animate?: boolean}} View3dOptions */

/** Faces of the wireframe about the hit. */
const WIREFRAME_FACES = 400;

/** The panel. */
export class View3d {
  /** @param {HTMLElement} host @param {View3dScene} scene @param {View3dOptions} [options] */
  constructor(host, scene, options = {}) {
    this.scene = scene;
    /** Milliseconds: decoding, the terrain's numbers, the first frame. */
    this.times = { decode: 0, prepare: 0, firstFrame: 0 };
    this.panel = new ViewPanel(host, scene.model, {
      view: (name) => {
        this.setView(name);
      },
      change: () => {
        this.#change();
      },
    });
    this.panel.setHasRay(false);
    /** @type {Terrain} */
    this.terrain = new Terrain(new Float32Array(0), new Uint32Array(0), new Uint16Array(0));
    /** @type {RayStory | null} */
    this.story = null;
    this.asked = 0;
    this.viewAsked = 0;
    this.isDisposed = false;
    /** @type {ViewPicture | null} */
    this.picture = null;
    try {
      this.picture = new ViewPicture(this.panel, scene.model, options.animate ?? true);
      this.picture.onReset = () => {
        this.setView('overview');
      };
      this.picture.onLoss = (isLost) => {
        this.#loss(isLost);
      };
    } catch (error) {
      this.#fail(
        `There is no picture: ${error instanceof Error ? error.message : error}. The text below still holds.`,
      );
    }
    /**
     * Settled once the terrain is shown. It never fails: trouble is told in the panel.
     * @type {Promise<void>}
     */
    this.ready = this.#load().catch((error) => {
      this.#fail(`The scene cannot be shown: ${error instanceof Error ? error.message : error}.`);
    });
  }

  /** @param {string} text */
  #fail(text) {
    this.panel.root.dataset.state = 'failed';
    this.panel.setMessage(text);
  }

  /** @param {boolean} isLost */
  #loss(isLost) {
    this.panel.root.dataset.state = isLost ? 'lost' : 'ready';
    this.panel.setMessage(
      isLost ? 'The graphics processor was taken away. The picture comes back with it.' : '',
    );
  }

  async #load() {
    const { model } = this.scene;
    const start = performance.now();
    const [vertices, faces, materials] = await Promise.all(
      [model.mesh.vertices, model.mesh.faces, model.mesh.materials].map((reference) =>
        this.scene.decode(reference),
      ),
    );
    if (this.isDisposed) return;
    const decoded = performance.now();
    this.terrain = new Terrain(
      vertices instanceof Float32Array ? vertices : Float32Array.from(vertices),
      faces instanceof Uint32Array ? faces : Uint32Array.from(faces),
      materials instanceof Uint16Array ? materials : Uint16Array.from(materials),
    );
    const prepared = performance.now();
    this.panel.notes.textContent = this.#notes();
    this.times.decode = decoded - start;
    this.times.prepare = prepared - decoded;
    if (!this.picture) return;
    this.panel.setMessage('');
    this.picture.setTerrain(this.terrain);
    this.setView('overview', false);
    this.picture.drawNow();
    this.times.firstFrame = performance.now() - prepared;
    this.panel.root.dataset.state = 'ready';
    this.#readSheets();
  }

  /** What is to be said of the mesh. */
  #notes() {
    const { faceCount, brokenFaces, flatFaces } = this.terrain;
    const { origin } = this.scene.model.mesh;
    const count = (/** @type {number} */ number, /** @type {string} */ words) =>
      number === 0 ? '' : `${number === 1 ? '1 face' : `${number} faces`} ${words}. `;
    const place = origin.some((number) => number !== 0)
      ? `Axes have the scene frame's metres; its origin is the global point (${origin.join(', ')}). `
      : '';
    return (
      (faceCount === 0 ? 'The scene has no faces. ' : '') +
      place +
      count(flatFaces, 'without area') +
      count(brokenFaces, 'with a vertex that is not there or no number: left out')
    );
  }

  /** The sheets end where a side's pencils hit. Until that is read they run to the longest range. */
  async #readSheets() {
    const { sensors } = this.scene.model;
    for (const [index, sensor] of sensors.entries()) {
      if (sensor.kind !== 'beam' || !sensor.grid) continue;
      try {
        const side = (sensor.sides ?? []).findIndex(
          (candidate) => candidate && 'range.T' in candidate.channels,
        );
        const ends = await readSheetEnds(this.scene, index, side);
        if (this.isDisposed) return;
        this.picture?.setSheet(index, ends);
      } catch {
        // Without ranges the sheet keeps its longest range.
      }
    }
  }

  /**
   * Shows a ray: its hits, its faces, its way to the camera, and says in words what is seen.
   * @param {RayRequest} request
   */
  async showRay(request) {
    const turn = ++this.asked;
    await this.ready;
    const isStale = () => this.isDisposed || turn !== this.asked;
    if (isStale()) return;
    const story = await storyOfRay(this.scene, this.terrain, request, isStale);
    if (isStale()) return;
    this.story = story;
    this.panel.setHasRay(story !== null);
    this.panel.setCaption(story ? captionOfRay(story) : ['There is no such ray.']);
    this.picture?.setStory(story, []);
    const { view } = this.panel.root.dataset;
    if (view === 'ray' || view === 'close') await this.setView(view);
    else if (view === 'overview') await this.setView('overview');
    this.panel.root.dataset.ray = story ? `${story.sensor}/${story.cell}` : '';
    await this.#readWireframe(isStale);
  }

  /** @param {() => boolean} isStale */
  async #readWireframe(isStale) {
    const { story, terrain, picture } = this;
    if (!story || !picture || !this.panel.isShown('wireframe')) return;
    const hit = story.target ?? story.sides.find((side) => side.hit)?.hit?.point;
    if (!hit) return;
    const face =
      story.exact?.faces[0] ?? story.here?.face ?? story.sides.find((side) => side.hit)?.hit?.face ?? -1;
    const radius = terrain.hasFace(face) ? 6 * terrain.longestSide(face) : 1;
    const faces = await facesNearPoint(terrain, hit, radius, WIREFRAME_FACES, isStale);
    if (!isStale()) picture.setStory(story, faces);
  }

  /** Something else is to be shown. */
  #change() {
    const turn = this.asked;
    this.picture?.change();
    this.#readWireframe(() => this.isDisposed || turn !== this.asked);
  }

  /**
   * Goes to a view: `overview`, `top`, `camera`, the name of a beam, `ray` or `close`.
   * @param {string} name
   * @param {boolean} [animate]
   */
  async setView(name, animate = true) {
    const { picture } = this;
    if (!picture) return;
    const turn = ++this.viewAsked;
    const pose = await this.#poseOf(name, () => this.isDisposed || turn !== this.viewAsked);
    if (!pose || turn !== this.viewAsked || this.isDisposed) return;
    this.panel.setView(name);
    picture.goTo(pose, animate);
  }

  /**
   * @param {string} name
   * @param {() => boolean} isStale
   * @returns {Promise<EyePose | null> | EyePose | null}
   */
  #poseOf(name, isStale) {
    const { story, terrain } = this;
    const { model } = this.scene;
    const box = boundsOfInterest(model, terrain, story);
    if (name === 'overview') return overviewPose(box, yawOfRig(model), this.picture?.shape ?? 1);
    if (name === 'top') return topPose(box, yawOfRig(model));
    if (name === 'camera') return cameraPose(model, terrain);
    if (name === 'ray') return story ? rayPose(story, terrain) : null;
    if (name === 'close') return story ? closePose(story, terrain, isStale) : null;
    return beamPose(model, terrain, name);
  }

  /**
   * Where a point of the scene frame is seen: CSS pixels from the canvas' upper left corner; null if it is
   * not before the eye.
   * @param {Point3} point
   * @returns {[number, number] | null}
   */
  project(point) {
    return this.picture ? this.picture.project(point) : null;
  }

  /**
   * Draws frames while the eye turns, and returns the milliseconds of each.
   * @param {number} count
   * @returns {number[]}
   */
  frameTimes(count) {
    return this.picture ? this.picture.frameTimes(count) : [];
  }

  /** To be called when the host's size has changed without notice. */
  resize() {
    this.picture?.requestFrame();
  }

  dispose() {
    this.isDisposed = true;
    this.picture?.dispose();
    this.panel.root.remove();
  }
}
