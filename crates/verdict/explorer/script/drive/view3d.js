// The 3-D picture of the drive: true ground, map as a surface, vehicle, sensors and sectors.
//
// For tests: `[data-drive-3d]` has `data-state` (waiting, ready, failed), `data-frames` (pictures drawn) and
// `data-frame` (index in the page's frames of the frame that is seen).

import { Terrain } from '../view3d/terrain.js';
import { ViewCamera, orbitOfPose, orbitPose } from '../view3d/camera.js';
import { SceneDrawing } from '../view3d/drawing.js';
import { boundsOfPoints, cameraPose } from '../view3d/views.js';
import { ViewControls } from '../view3d/controls.js';
import { lookOfFaces } from '../gl/mesh.js';
import { oncePerFrame } from '../frame.js';
import { coloursOfFaces, rampColours, readTheme } from '../view3d/theme.js';
import { vecAdd, vecAlong, vecSub, vecTurn } from '../view3d/vector.js';
import { powerOfTen } from '../view3d/words.js';
import { sharesOfHex } from '../panel/colour.js';
import { readDriveTheme } from './looks.js';
import { DRIVE_SHOWS, view3dElements } from './view3d_elements.js';
import { poseOnPlan, poseOnVehicle } from './orbit.js';
import { SceneOverlay } from '../view3d/over.js';
import { DriveStage } from './stage.js';
import { DriveScene } from './scene.js';
import { DriveMounts } from './mounts.js';
import { vehicleBody } from './body.js';
import { cellSurface } from './surface.js';
import { CellPaint } from './raster.js';

/** @typedef {import('../view3d/vector.js').Point3} Point3 */
/** @typedef {import('../view3d/camera.js').EyePose} EyePose */
/** @typedef {import('../gl/mesh.js').Rgb} Rgb */
/** @typedef {import('./state.js').DriveState} DriveState */
/** @typedef {import('./map.js').DriveMap} DriveMap */
/** @typedef {import('../view3d/view3d.js').PageModel3d} PageModel3d */
/** @typedef {import('./view3d_elements.js').DriveShow} DriveShow */
/** @typedef {import('./view3d_elements.js').DriveViewName} DriveViewName */

/** Device pixels in a CSS pixel, at most. */
const DRIVE_PIXELS = 2;

/** A picture that takes longer, milliseconds, is coarser while something moves. */
const DRIVE_SLOW = 45;

/** Time after the last move until the picture is drawn in full: milliseconds. */
const DRIVE_REST = 220;

export class DriveView3d {
  /** @param {DriveState} state @param {DriveMap} map */
  constructor(state, map) {
    this.state = state;
    this.map = map;
    this.record = map.record;
    this.mounts = new DriveMounts(this.record);
    this.camera = new ViewCamera();
    /** @type {DriveStage|null} */
    this.stage = null;
    /** @type {Terrain|null} */
    this.terrain = null;
    /** @type {Set<DriveShow>} */
    this.shown = new Set(DRIVE_SHOWS.map(([name]) => name));
    this.lift = 0.02;
    this.ask = oncePerFrame((time) => this.next(time));
    this.isSeen = false;
    /** Mean time from picture to picture while they follow each other, milliseconds. */
    this.gap = 0;
    this.lastTime = 0;
    this.restTimer = 0;
    this.isResting = true;
    this.frames = 0;
    this.cellsKey = '';
    this.bodyKey = '';
    this.linesKey = '';
    this.lines = new SceneDrawing();
    this.elements = view3dElements(state.choice.viewFollows, this.lift, {
      view: (name) => this.goTo(name),
      follow: (isOn) => state.set({ viewFollows: isOn }),
      lift: (lift) => {
        this.lift = lift;
        this.ask();
      },
      show: (name, isShown) => {
        if (isShown) { this.shown.add(name); } else { this.shown.delete(name); }
        this.ask();
      },
    });
    this.element = this.elements.root;
    this.overlay = new SceneOverlay(this.elements.canvas);
    new ViewControls(this.elements.canvas, this.camera, {
      setPose: (pose) => this.setPose(pose),
      bounds: () => this.bounds,
      reset: () => this.goTo('vehicle'),
      centre: (x, y) => this.centre(x, y),
    });
    this.lastPlace = this.record.truePose(state.choice.frame).position;
    state.listen((changed) => this.changed(changed));
    new ResizeObserver(() => this.ask()).observe(this.elements.stage);
    new IntersectionObserver((entries) => {
      this.isSeen = entries.some((entry) => entry.isIntersecting);
      this.ask();
    }, { rootMargin: '100px' }).observe(this.elements.stage);
  }

  /** Makes the picture once the ground is known. */
  start() {
    const { truth } = this.map;
    if (this.stage || !truth || !this.isSeen || this.element.dataset.state === 'failed') { return; }
    try {
      this.stage = new DriveStage(this.elements.canvas, (isLost) => {
        this.elements.message.textContent = 'The graphics processor is gone. The picture comes back by itself.';
        this.elements.message.hidden = !isLost;
        this.ask();
      });
      const { ground } = truth;
      this.terrain = new Terrain(ground.vertices, ground.faces, new Uint16Array(0));
      this.readColours();
      this.stage.setTerrain(this.terrain, rampColours(), this.groundColours());
      this.elements.message.hidden = true;
      this.element.dataset.state = 'ready';
      this.goTo('vehicle');
    } catch (error) {
      this.fail(`There is no 3-D picture: ${error instanceof Error ? error.message : error}.`);
    }
  }

  /** @param {string} words */
  fail(words) {
    this.stage = null;
    this.element.dataset.state = 'failed';
    this.elements.message.textContent = words;
    this.elements.message.hidden = false;
  }

  readColours() {
    const { colours, isDark } = readTheme(this.element);
    /** @type {{colours: Record<string, Rgb>, isDark: boolean}} */
    this.theme = { colours: { ...colours }, isDark };
    for (const [name, hex] of Object.entries(readDriveTheme(this.element))) {
      this.theme.colours[`drive-${name}`] = sharesOfHex(hex);
    }
  }

  groundColours() {
    const { colours } = readTheme(this.element);
    return this.terrain ? coloursOfFaces(this.terrain, 'material', colours) : new Uint32Array(0);
  }

  /** Colours of the page changed. */
  retheme() {
    if (this.stage) {
      this.readColours();
      this.stage.setColours(this.groundColours());
      [this.cellsKey, this.bodyKey] = ['', ''];
      this.ask();
    }
  }

  /** @param {Set<keyof import('./state.js').DriveChoice>} changed */
  changed(changed) {
    const { choice } = this.state;
    const { position } = this.record.truePose(choice.frame);
    if (changed.has('frame')) {
      const { pose } = this.camera;
      if (choice.viewFollows && pose.lens.kind === 'image') {
        // The same part of the image, from the new place.
        this.goTo('camera');
        this.camera.pose = { ...this.camera.pose, lens: pose.lens };
      } else if (choice.viewFollows) {
        const shift = vecSub(position, this.lastPlace);
        this.camera.pose = { ...pose, eye: vecAdd(pose.eye, shift), focus: vecAdd(pose.focus, shift) };
      }
      this.lastPlace = position;
      this.move();
    }
    if (changed.has('viewFollows')) { this.elements.follow.checked = choice.viewFollows; }
    this.ask();
  }

  /** @param {DriveViewName} name */
  goTo(name) {
    const pose = this.record.truePose(this.state.choice.frame);
    const isWide = this.elements.stage.clientWidth > this.elements.stage.clientHeight;
    if (name === 'camera') {
      const sensors = this.mounts.at(pose);
      const model = /** @type {unknown} */ ({ ...this.record.model, sensors, vehicle: null });
      const found = this.terrain ? cameraPose(/** @type {PageModel3d} */ (model), this.terrain) : null;
      this.setPose(found ?? this.camera.pose);
    } else if (name === 'vehicle') {
      this.setPose(poseOnVehicle(pose, isWide ? 10 : 13));
    } else {
      this.setPose(poseOnPlan(this.map.view.everything, pose, name === 'top'));
      this.state.set({ viewFollows: false });
    }
  }

  /** @param {EyePose} pose */
  setPose(pose) {
    this.camera.pose = pose;
    this.move();
  }

  /** Makes the ground at a place of the picture the middle of turns. @param {number} x CSS pixels
   * @param {number} y */
  centre(x, y) {
    const { truth } = this.map;
    const direction = this.camera.directionAt(x, y);
    const hit = truth ? truth.ground.rayHit(this.camera.pose.eye, direction, 1e6) : 1e6;
    if (hit < 1e6) {
      const { yaw, pitch, distance } = orbitOfPose(this.camera.pose);
      this.setPose(orbitPose(vecAlong(this.camera.pose.eye, direction, hit), distance, yaw, pitch));
    }
  }

  /** @param {number} time of the screen, milliseconds */
  next(time) {
    const gap = time - this.lastTime;
    this.gap = gap < 1000 ? this.gap * 0.6 + gap * 0.4 : this.gap;
    this.lastTime = time;
    this.start();
    this.draw();
  }

  /** Something moves: pictures are coarse where they are slow, until all is at rest. */
  move() {
    this.isResting = false;
    window.clearTimeout(this.restTimer);
    this.restTimer = window.setTimeout(() => {
      this.isResting = true;
      this.ask();
    }, DRIVE_REST);
    this.ask();
  }

  /** Device pixels of a CSS pixel in the next picture. */
  get pixelRatio() {
    const ratio = Math.min(window.devicePixelRatio || 1, DRIVE_PIXELS);
    return !this.isResting && (this.gap > DRIVE_SLOW || this.stage?.isSoftware) ? ratio / 2 : ratio;
  }

  /** Faces of the map and of the vehicle, if they are other than before. */
  refreshSolids() {
    const { stage, map, state: { choice } } = this;
    if (!stage) { return; }
    const key = [choice.frame, choice.colouring, this.lift, this.shown.has('cells')].join('/');
    if (this.cellsKey !== key) {
      this.cellsKey = key;
      map.replay.goTo(choice.frame);
      const paint = new CellPaint(map.replay, choice.colouring, map.scale, map.truth, map.theme);
      stage.setCells(this.shown.has('cells') ? cellSurface(paint, this.lift) : null);
    }
    if (this.bodyKey !== String(choice.frame)) {
      this.bodyKey = String(choice.frame);
      const pose = this.record.truePose(choice.frame);
      const place = (/** @type {Point3} */ local) => vecAdd(pose.position, vecTurn(pose.quaternion, local));
      stage.setBody(vehicleBody(this.record.vehicle, this.mounts.places, place, map.theme));
    }
  }

  /** Everything that the picture may show, for its nearest and farthest depth. */
  get bounds() {
    const { left, right, bottom, top } = this.map.view.everything;
    const level = this.lastPlace[2];
    /** @type {Point3[]} */
    const points = [[left, bottom, level - 2], [right, top, level + 4]];
    const ground = this.terrain?.bounds;
    const all = ground ? [...points, ground.low, ground.high] : points;
    return boundsOfPoints(all) ?? { low: points[0], high: points[1] };
  }

  /** Lines of the picture, made anew if they are other than before. */
  refreshLines() {
    const { map, shown, state: { choice }, record } = this;
    const isFromCamera = this.camera.pose.lens.kind === 'image';
    const key = [choice.frame, choice.sector, choice.hoverSector, isFromCamera, ...shown].join('/');
    if (this.linesKey === key || !map.truth) { return; }
    this.linesKey = key;
    map.replay.goTo(choice.frame);
    const scene = new DriveScene(map.replay, map.truth.ground);
    scene.ways(choice.frame);
    scene.waypoints();
    const sensors = this.mounts.at(record.truePose(choice.frame));
    scene.sensors(sensors, shown.has('sheets'), shown.has('frustum') && !isFromCamera, isFromCamera);
    const { obstacles } = map;
    if (obstacles && shown.has('sectors')) {
      scene.sectors(obstacles, choice.sector, choice.hoverSector, record.vehicle.wheelbase / 2 + 0.1);
    }
    this.lines = scene.drawing;
  }

  draw() {
    const { stage, map, camera, state: { choice }, theme, shown } = this;
    const { clientWidth: width, clientHeight: height } = this.elements.stage;
    if (!stage || !map.truth || !theme || !this.isSeen || width === 0 || height === 0) { return; }
    this.refreshSolids();
    this.refreshLines();
    camera.fit(width, height, this.bounds);
    const grid = shown.has('grid') ? Math.max(1, powerOfTen(8 * camera.metresPerPixel) * 10) : 0;
    const look = { ...lookOfFaces(theme), grid };
    stage.drawDrive(camera, this.pixelRatio, shown.has('ground') ? look : null, this.lines, theme.colours);
    this.overlay.draw(camera, [this.lines], theme.colours);
    this.frames += 1;
    Object.assign(this.element.dataset, { frames: String(this.frames), frame: String(choice.frame) });
  }
}
