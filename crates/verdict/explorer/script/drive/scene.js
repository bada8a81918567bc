// Lines of the 3-D picture: ways, waypoints, sensors with their sheets, and the sectors of the obstacle map.

import { SceneDrawing } from '../view3d/drawing.js';
import { drawBeamHead, drawCamera, drawSheet } from '../view3d/rig.js';
import { LABEL_LOOKS } from './looks.js';
import { NO_SLOT } from './replay.js';
import { halfWidth, onCircle } from './sectors.js';
import { sheetEndsOn } from './mounts.js';

/** @typedef {import('../view3d/vector.js').Point3} Point3 */
/** @typedef {import('../view3d/theme.js').ColourName} ColourName */
/** @typedef {import('../view3d/view3d.js').SensorModel} SensorModel3d */
/** @typedef {import('../gl/lines.js').LineLook} LineLook */
/** @typedef {import('./model.js').DriveRecord} DriveRecord */
/** @typedef {import('./model.js').DriveObstacleMap} DriveObstacleMap */
/** @typedef {import('./replay.js').MapReplay} MapReplay */
/** @typedef {import('./ground.js').DriveGround} DriveGround */

/** Size of the sensors' symbols, metres. */
const SENSOR_SIZE = 0.5;

/** Distance of points along a line that follows the ground, metres. */
const GROUND_STEP = 0.15;

/** Height of such lines over the ground, metres. */
const LINE_LIFT = 0.04;

/** Names of colours that only the drive has; the picture knows them beside those of the 3-D panel.
 * @param {import('./looks.js').DriveColour} name */
function driveColour(name) {
  return /** @type {ColourName} */ (/** @type {unknown} */ (`drive-${name}`));
}

export class DriveScene {
  /** @param {MapReplay} replay @param {DriveGround} ground */
  constructor(replay, ground) {
    this.replay = replay;
    this.record = replay.record;
    this.ground = ground;
    this.drawing = new SceneDrawing();
  }

  /** Height of what is seen at a place: of the map and the true ground, the higher one. @param {number} x
   * @param {number} y @returns {number} */
  heightAt(x, y) {
    const slot = this.replay.slotOf(...this.replay.cellAt(x, y));
    const isKnown = slot !== NO_SLOT && this.replay.source[slot] !== 0;
    const height = this.ground.heightAt(x, y);
    const known = isKnown ? this.replay.elevation[slot] : NaN;
    return Math.max(Number.isNaN(height) ? -Infinity : height, Number.isNaN(known) ? -Infinity : known);
  }

  /** @param {number} x @param {number} y @param {number} [fallback] height where nothing is known
   * @returns {Point3} */
  onGround(x, y, fallback = 0) {
    const height = this.heightAt(x, y);
    return [x, y, (Number.isFinite(height) ? height : fallback) + LINE_LIFT];
  }

  /** A line over the ground. @param {[number, number]} from @param {[number, number]} to @param {number} fallback
   * @returns {Point3[]} */
  overGround(from, to, fallback) {
    const length = Math.hypot(to[0] - from[0], to[1] - from[1]);
    const steps = Math.max(1, Math.min(200, Math.ceil(length / GROUND_STEP)));
    return Array.from({ length: steps + 1 }, (_, k) => this.onGround(
      from[0] + (to[0] - from[0]) * k / steps, from[1] + (to[1] - from[1]) * k / steps, fallback));
  }

  /** Both ways up to a frame. @param {number} frame */
  ways(frame) {
    const path = (/** @type {ArrayLike<number>} */ poses) => (
      Array.from({ length: frame + 1 }, (_, k) => placeInPath(poses, k)));
    const believed = path(this.record.believed);
    // Pieces of a path are short, so that each would be one dash: every second piece is left out.
    const dash = Math.max(1, Math.round(0.12 / Math.max(meanStep(believed), 1e-3)));
    for (let k = 0; k + 1 < believed.length; k += 2 * dash) {
      this.drawing.path(believed.slice(k, k + dash + 1), driveColour('believed'), { width: 2.2, ghost: true });
    }
    this.drawing.path(path(this.record.stance), driveColour('true'), { width: 2.6, ghost: true });
  }

  waypoints() {
    this.record.waypoints.forEach(([x, y], k) => {
      const foot = this.onGround(x, y);
      /** @type {Point3} */
      const head = [x, y, foot[2] + 0.6];
      this.drawing.line(foot, head, driveColour('waypoint'), { width: 2 });
      this.drawing.label(head, k === 0 ? 'start' : `waypoint ${k}`, driveColour('waypoint'), 2);
    });
  }

  /** @param {SensorModel3d[]} sensors at their present places @param {boolean} hasSheets
   * @param {boolean} hasFrustum @param {boolean} isFromCamera whether the eye is the camera's */
  sensors(sensors, hasSheets, hasFrustum, isFromCamera) {
    // Before the camera the sheets would cover all; their lines on the ground are what it sees.
    const areas = isFromCamera ? new SceneDrawing() : this.drawing;
    for (const sensor of sensors) {
      if (sensor.kind === 'beam') {
        if (hasSheets) { drawSheet(this.drawing, areas, sensor, sheetEndsOn(sensor, this.ground)); }
        if (!isFromCamera) { drawBeamHead(this.drawing, sensor, SENSOR_SIZE); }
      } else if (hasFrustum) {
        drawCamera(this.drawing, sensor, SENSOR_SIZE);
      }
    }
    // Names of sensors would cover each other at this size.
    this.drawing.labels = this.drawing.labels.filter(({ priority }) => priority !== 4);
  }

  /** @param {DriveObstacleMap} map @param {number} chosen @param {number} hovered @param {number} inner metres */
  sectors(map, chosen, hovered, inner) {
    const level = this.heightAt(map.centre[0], map.centre[1]);
    const fallback = Number.isFinite(level) ? level : 0;
    map.sectors.forEach((sector, index) => {
      const isStrong = index === chosen || index === hovered;
      const look = LABEL_LOOKS[sector.label];
      const colour = driveColour(sector.label);
      const half = halfWidth(map.sectors, index);
      /** @type {LineLook} */
      const line = { width: isStrong ? 2.6 : 1, ghost: isStrong };
      const start = onCircle(map, sector.direction, Math.min(inner, sector.radius));
      const along = this.overGround(start, sector.point, fallback);
      this.dashed(along, colour, line, look.dash, isStrong ? 1 : 0.5);
      const arc = [-1, -0.5, 0, 0.5, 1].map((share) => this.onGround(
        ...onCircle(map, sector.direction + share * half, sector.radius), fallback));
      this.drawing.path(arc, colour, { width: isStrong ? 5 : 3.2, ghost: true });
      if (sector.label === 'obstacle') {
        // A wall that is seen also where colours are not.
        const wall = arc.map(([x, y, z]) => /** @type {Point3} */ ([x, y, z + 0.25]));
        for (let k = 1; k < arc.length; k += 1) {
          this.drawing.area([arc[k - 1], arc[k], wall[k], wall[k - 1]], colour, isStrong ? 0.75 : 0.4);
        }
        this.drawing.path(wall, colour, { width: 1.5 });
      }
      if (index === chosen) {
        const words = `sector ${index}: ${look.words}, ${sector.radius.toFixed(1)} m`;
        this.drawing.label(arc[2], words, colour, 6);
        this.missing(sector, fallback);
      }
    });
  }

  /** @param {import('./model.js').DriveSector} sector @param {number} fallback */
  missing(sector, fallback) {
    if (!sector.missing) { return; }
    const colour = driveColour(sector.label);
    const at = this.onGround(...sector.missing, fallback);
    const way = this.overGround(sector.point, sector.missing, fallback);
    this.drawing.path(way, colour, { width: 1.4, ghost: true }, 0.9);
    this.drawing.line(at, [at[0], at[1], at[2] + 0.35], colour, { width: 2.5, ghost: true });
    this.drawing.mark(at, 'cross', colour);
    this.drawing.label([at[0], at[1], at[2] + 0.35], 'missing', colour, 5);
  }

  /** A path with the dash of a label: its short pieces are drawn or left out. @param {Point3[]} points
   * @param {ColourName} colour @param {LineLook} look @param {number[]} dash @param {number} opacity */
  dashed(points, colour, look, dash, opacity) {
    const period = dash.length === 0 ? 1 : dash[0] > 4 ? 3 : 2;
    for (let k = 1; k < points.length; k += 1) {
      const isDrawn = dash.length === 0 || k % period !== 0;
      if (isDrawn) { this.drawing.line(points[k - 1], points[k], colour, look, opacity); }
    }
  }
}

/** @param {ArrayLike<number>} poses @param {number} k @returns {Point3} */
function placeInPath(poses, k) {
  return [poses[7 * k], poses[7 * k + 1], poses[7 * k + 2] + LINE_LIFT];
}

/** Mean distance of neighbouring points, metres. @param {Point3[]} points */
function meanStep(points) {
  let sum = 0;
  for (let k = 1; k < points.length; k += 1) {
    sum += Math.hypot(points[k][0] - points[k - 1][0], points[k][1] - points[k - 1][1]);
  }
  return points.length > 1 ? sum / (points.length - 1) : 0;
}
