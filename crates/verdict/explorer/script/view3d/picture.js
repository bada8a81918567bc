// The picture of the 3-D panel: what is drawn, from where, and when. A frame is drawn only if something
// changed.

import { vecAlong, vecLength, vecSub } from './vector.js';
import { ViewCamera, orbitOfPose, orbitPose, poseBetween } from './camera.js';
import { lookOfFaces } from '../gl/mesh.js';
import { GlStage } from '../gl/stage.js';
import { OverPicture } from './over.js';
import { keyOfPicture } from './key.js';
import { ViewControls } from './controls.js';
import { coloursOfFaces, rampColours, readTheme } from './theme.js';
import { SceneDrawing } from './drawing.js';
import { drawBeamHead, drawCamera, drawSceneAxes, drawSheet } from './rig.js';
import { drawVehicle, symbolSize } from './rig.js';
import { drawWireframe, drawingOfLight, drawingOfRay } from './raydrawing.js';
import { firstFaceOnRay } from './search.js';
import { boundsOfInterest, boundsOfPoints } from './views.js';
import { powerOfTen } from './words.js';

/** @typedef {import('./vector.js').Point3} Point3 */
/** @typedef {import('./terrain.js').Terrain} Terrain */
/** @typedef {import('./terrain.js').Bounds3} Bounds3 */
/** @typedef {import('./camera.js').EyePose} EyePose */
/** @typedef {import('./story.js').RayStory} RayStory */
/** @typedef {import('./rig.js').SheetEnds} SheetEnds */
/** @typedef {import('./panel.js').ViewPanel} ViewPanel */
/** @typedef {import('./view3d.js').PageModel3d} PageModel3d */

/** Milliseconds of the way from one view to another. */
const TRAVEL_TIME = 350;
/** A frame that takes longer, milliseconds, is drawn coarser while the eye moves. */
const SLOW_FRAME = 45;
/** Milliseconds after the last move until the picture is drawn in full again. */
const REST_TIME = 180;
/** Device pixels per CSS pixel, at most. */
const MOST_PIXEL_RATIO = 2;

/** Everything inside the panel's frame. */
export class ViewPicture {
  /** @param {ViewPanel} panel @param {PageModel3d} model @param {boolean} animate */
  constructor(panel, model, animate) {
    this.panel = panel;
    this.model = model;
    this.animate = animate;
    /** @type {() => void} */
    this.onReset = () => {};
    /** @type {(isLost: boolean) => void} */
    this.onLoss = () => {};
    this.stage = new GlStage(panel.canvas, (isLost) => {
      this.onLoss(isLost);
      if (!isLost) this.requestFrame();
    });
    this.camera = new ViewCamera();
    this.over = new OverPicture(panel, model);
    this.theme = readTheme(panel.root);
    this.ramp = rampColours();
    /** @type {Terrain | null} */
    this.terrain = null;
    /** @type {RayStory | null} */
    this.story = null;
    /** @type {number[]} */
    this.wireframe = [];
    /** @type {Map<number, SheetEnds>} */
    this.sheets = new Map();
    this.size = symbolSize(model);
    this.rig = new SceneDrawing();
    this.light = new SceneDrawing();
    this.ray = new SceneDrawing();
    /** @type {Bounds3} */
    this.everything = { low: [-1, -1, -1], high: [1, 1, 1] };
    /** @type {Bounds3} */
    this.interest = this.everything;
    this.colouredBy = '';
    this.frame = 0;
    this.frames = 0;
    this.slow = 0;
    this.coarse = false;
    this.restTimer = 0;
    this.travel = 0;
    this.controls = new ViewControls(panel.canvas, this.camera, {
      setPose: (pose) => this.#setByHand(pose),
      bounds: () => this.everything,
      reset: () => this.onReset(),
      centre: (x, y) => {
        this.#centre(x, y);
      },
    });
    this.watcher = new ResizeObserver(() => this.requestFrame());
    this.watcher.observe(panel.stage);
    this.dark = matchMedia('(prefers-color-scheme: dark)');
    this.onTheme = () => this.#retheme();
    this.dark.addEventListener('change', this.onTheme);
  }

  /** Width of the canvas by its height. */
  get shape() {
    const { clientWidth, clientHeight } = this.panel.stage;
    return clientHeight > 0 ? clientWidth / clientHeight : 1;
  }

  /** @param {Terrain} terrain */
  setTerrain(terrain) {
    this.terrain = terrain;
    this.stage.setTerrain(terrain, this.ramp, coloursOfFaces(terrain, 'material', this.theme.colours));
    this.colouredBy = 'material';
    this.change();
  }

  /** @param {number} sensor @param {SheetEnds} ends */
  setSheet(sensor, ends) {
    this.sheets.set(sensor, ends);
    this.change();
  }

  /** @param {RayStory | null} story @param {number[]} wireframe faces */
  setStory(story, wireframe) {
    this.story = story;
    this.wireframe = wireframe;
    this.change();
  }

  #retheme() {
    this.theme = readTheme(this.panel.root);
    this.colouredBy = '';
    this.change();
  }

  /** Builds what is drawn anew. */
  change() {
    const { panel, model, terrain, story, size } = this;
    if (!terrain) return;
    const by = panel.terrainColour;
    const needed = by === 'face' ? 'face' : 'material';
    if (this.colouredBy !== needed) {
      this.stage.setColours(coloursOfFaces(terrain, needed, this.theme.colours));
      this.colouredBy = needed;
    }
    this.rig = new SceneDrawing();
    this.light = new SceneDrawing();
    for (const [index, sensor] of model.sensors.entries()) {
      if (sensor.kind === 'beam' && panel.isShown('sheets')) {
        drawSheet(this.rig, this.light, sensor, this.sheets.get(index) ?? null);
      }
    }
    if (panel.isShown('rig')) drawVehicle(this.rig, model, size);
    if (!story) this.ray = new SceneDrawing();
    else if (panel.isShown('light')) this.ray = drawingOfLight(story, terrain, model, size);
    else this.ray = drawingOfRay(story, terrain, model, size);
    if (story && panel.isShown('wireframe')) drawWireframe(this.ray, this.wireframe, terrain);
    this.interest = boundsOfInterest(model, terrain, story);
    const ends = [...this.rig.lines, ...this.ray.lines].flatMap((line) => [line.from, line.to]);
    const corners = terrain.bounds ? [terrain.bounds.low, terrain.bounds.high] : [];
    const poses = model.sensors.map((sensor) => sensor.pose.position);
    this.everything =
      boundsOfPoints([...ends, ...corners, ...poses, this.interest.low, this.interest.high]) ??
      this.everything;
    const heights = terrain.bounds ? [terrain.bounds.low[2], terrain.bounds.high[2]] : null;
    panel.setKey(this.theme.colours, keyOfPicture(story, model, panel), model, heights);
    this.requestFrame();
  }

  /** Goes to a pose, in steps if that is wanted. @param {EyePose} pose @param {boolean} animate */
  goTo(pose, animate) {
    cancelAnimationFrame(this.travel);
    const start = this.camera.pose;
    const isCalm = !this.animate || matchMedia('(prefers-reduced-motion: reduce)').matches;
    // The lens of a sensor and the free lens have nothing between them.
    const isJump = start.lens.kind === 'image' || pose.lens.kind === 'image';
    if (!animate || isCalm || isJump || this.slow > SLOW_FRAME || this.frames < 2) {
      this.#setPose(pose);
      return;
    }
    const began = performance.now();
    const step = () => {
      const share = Math.min(1, (performance.now() - began) / TRAVEL_TIME);
      const smooth = share * share * (3 - 2 * share);
      this.#setPose(share < 1 ? poseBetween(start, pose, smooth) : pose);
      if (share < 1) this.travel = requestAnimationFrame(step);
    };
    step();
  }

  /** @param {EyePose} pose */
  #setPose(pose) {
    this.camera.pose = pose;
    this.requestFrame();
  }

  /**
   * The eye was moved by hand. Within the image of a sensor the view stays that of the sensor.
   * @param {EyePose} pose
   */
  #setByHand(pose) {
    cancelAnimationFrame(this.travel);
    if (pose.lens.kind !== 'image') this.panel.setView('');
    this.#setPose(pose);
    this.#markMotion();
  }

  /** While the eye moves, slow pictures are coarse. */
  #markMotion() {
    if (this.slow > SLOW_FRAME) this.coarse = true;
    clearTimeout(this.restTimer);
    this.restTimer = window.setTimeout(() => {
      if (!this.coarse) return;
      this.coarse = false;
      this.requestFrame();
    }, REST_TIME);
  }

  /**
   * Makes the ground that is seen at a place the middle of turns.
   * @param {number} x CSS pixels
   * @param {number} y
   */
  async #centre(x, y) {
    const { camera, terrain } = this;
    if (!terrain) return;
    const { pose } = camera;
    const ray = { origin: pose.eye, direction: camera.directionAt(x, y) };
    const found = await firstFaceOnRay(terrain, ray, { from: camera.near, to: Infinity, frontsOnly: false });
    if (!found || camera.pose !== pose) return;
    const focus = vecAlong(ray.origin, ray.direction, found.t);
    const { yaw, pitch, distance } = orbitOfPose({ ...pose, focus });
    this.panel.setView('');
    this.goTo(orbitPose(focus, distance, yaw, pitch), true);
  }

  /** Asks for a frame. Many requests give one frame. */
  requestFrame() {
    if (this.frame !== 0) return;
    this.frame = requestAnimationFrame(() => {
      this.frame = 0;
      const start = performance.now();
      this.drawNow();
      // Coarse frames say nothing of how slow a full one is.
      if (this.coarse) return;
      this.stage.whenDrawn(() => {
        this.slow = this.slow * 0.5 + (performance.now() - start) * 0.5;
      });
    });
  }

  /** Draws a frame at once. */
  drawNow() {
    const { camera, panel, stage } = this;
    const { clientWidth: width, clientHeight: height } = panel.stage;
    if (width === 0 || height === 0) return;
    camera.fit(width, height, this.everything);
    const ratio = Math.min(window.devicePixelRatio || 1, MOST_PIXEL_RATIO);
    const { colours } = this.theme;
    const { bounds } = this.terrain ?? { bounds: null };
    const by = panel.terrainColour;
    // Seen from a sensor, a sheet would lie over the whole image.
    const isWithoutSheets = camera.pose.lens.kind === 'image' || panel.isShown('light');
    const drawings = [
      this.#sensorBodies(),
      ...(isWithoutSheets ? [] : [this.light]),
      this.rig,
      this.ray,
      this.#axes(),
    ];
    stage.draw(
      camera,
      this.coarse ? ratio / 2 : ratio,
      {
        ...lookOfFaces(this.theme),
        source: by === 'elevation' || by === 'slope' ? by : 'face',
        span: by === 'slope' ? [0, Math.PI / 2] : bounds ? [bounds.low[2], bounds.high[2]] : [0, 1],
        grid: panel.isShown('grid') && !this.coarse ? powerOfTen(8 * camera.metresPerPixel) * 10 : 0,
      },
      drawings,
      colours,
      this.#slack(),
      this.coarse,
    );
    this.over.draw(camera, drawings, colours, this.story);
    this.frames += 1;
    panel.root.dataset.frames = String(this.frames);
  }

  /**
   * The terrain is drawn in single precision: a face of a metre may be off by some tenths of a micrometre. In
   * a close-up that is a share of the depth, and lines on the face are drawn that much nearer.
   */
  #slack() {
    const { story, terrain, camera } = this;
    if (!story || !terrain) return 0;
    const faces = [story.here?.face ?? -1, ...story.sides.map((side) => side.hit?.face ?? -1)];
    const sides = faces.filter((face) => terrain.hasFace(face)).map((face) => terrain.longestSide(face));
    const { distance } = orbitOfPose(camera.pose);
    return Math.min(0.1, (4e-7 * Math.max(0, ...sides)) / distance);
  }

  /** Bodies of sensors, but not of the one that the eye is in. */
  #sensorBodies() {
    const drawing = new SceneDrawing();
    if (!this.panel.isShown('rig')) return drawing;
    const { eye } = this.camera.pose;
    for (const sensor of this.model.sensors) {
      if (vecLength(vecSub(sensor.pose.position, eye)) < 0.02 * this.size) continue;
      if (sensor.kind === 'camera') drawCamera(drawing, sensor, this.size);
      else drawBeamHead(drawing, sensor, this.size);
    }
    return drawing;
  }

  #axes() {
    const drawing = new SceneDrawing();
    if (this.panel.isShown('axes') && this.camera.pose.lens.kind === 'angle') {
      drawSceneAxes(drawing, this.interest, this.camera.pose.eye);
    }
    return drawing;
  }

  /** @param {Point3} point @returns {[number, number] | null} */
  project(point) {
    return this.camera.project(point);
  }

  /**
   * Draws frames while the eye turns a little, and waits for each.
   * @param {number} count
   * @returns {number[]} milliseconds
   */
  frameTimes(count) {
    const { pose } = this.camera;
    const { yaw, pitch, distance } = orbitOfPose(pose);
    const times = [];
    for (let k = 0; k < count; k++) {
      const start = performance.now();
      this.camera.pose = orbitPose(pose.focus, distance, yaw + 0.01 * k, pitch);
      this.drawNow();
      this.stage.finish();
      times.push(performance.now() - start);
    }
    this.camera.pose = pose;
    this.requestFrame();
    return times;
  }

  dispose() {
    cancelAnimationFrame(this.frame);
    cancelAnimationFrame(this.travel);
    clearTimeout(this.restTimer);
    this.watcher.disconnect();
    this.dark.removeEventListener('change', this.onTheme);
    this.controls.dispose();
    this.stage.dispose();
  }
}
