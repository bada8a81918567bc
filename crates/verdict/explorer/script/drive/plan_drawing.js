// Drawings on the map from above: grid in metres, ways, waypoints, vehicle, sectors, cursor.

import { LABEL_LOOKS, drawMark } from './looks.js';
import { onCircle, halfWidth, wedgeOf } from './sectors.js';
import { axisInWords, offsetOfAxis, roundStep, tickInWords } from '../view3d/words.js';
import { vecAdd, vecTurn } from '../view3d/vector.js';

/** @typedef {import('./plan.js').PlanView} PlanView */
/** @typedef {import('./looks.js').DriveTheme} DriveTheme */
/** @typedef {import('./model.js').DriveRecord} DriveRecord */
/** @typedef {import('./model.js').DriveObstacleMap} DriveObstacleMap */
/** @typedef {import('./model.js').DrivePose} DrivePose */
/** @typedef {import('./model.js').DriveVehicle} DriveVehicle */
/** @typedef {import('../view3d/vector.js').Point3} Point3 */
/** @typedef {[number, number]} PlanPoint x and y */

/** Corners of a rectangle, and points of an arrow, in units of their half lengths. @type {[number, number][]} */
const RECTANGLE = [[-1, -1], [1, -1], [1, 1], [-1, 1], [-1, -1]];
/** @type {[number, number][]} */
const HEADING_ARROW = [[-0.3, 0], [0.9, 0], [0.5, 0.22], [0.9, 0], [0.5, -0.22]];

const LETTERS = '11px system-ui, sans-serif';

export class PlanDrawing {
  /** @param {CanvasRenderingContext2D} context @param {PlanView} view @param {DriveTheme} theme */
  constructor(context, view, theme) {
    this.context = context;
    this.view = view;
    this.theme = theme;
  }

  /** A path through places. @param {ArrayLike<number>[]} places x and y, metres */
  trace(places) {
    const { context, view } = this;
    context.beginPath();
    places.forEach((place, k) => {
      const [x, y] = [view.pixelX(place[0]), view.pixelY(place[1])];
      if (k === 0) { context.moveTo(x, y); } else { context.lineTo(x, y); }
    });
  }

  /** The path that was traced, with an edge that stands out on every ground.
   * @param {string} colour @param {number} width CSS pixels @param {number[]} [dash] */
  strokeWithEdge(colour, width, dash = []) {
    const { context } = this;
    context.lineJoin = 'round';
    context.setLineDash([]);
    context.strokeStyle = this.theme.paper;
    context.globalAlpha = 0.75;
    context.lineWidth = width + 2;
    context.stroke();
    context.globalAlpha = 1;
    context.setLineDash(dash);
    context.strokeStyle = colour;
    context.lineWidth = width;
    context.stroke();
    context.setLineDash([]);
  }

  /** Lines each round number of metres, with numbers of the global frame. @param {Point3} origin */
  grid(origin) {
    const { context, view, theme } = this;
    const step = roundStep(96 / view.scale);
    const [left, top] = view.placeAt(0, 0);
    const [right, bottom] = view.placeAt(view.width, view.height);
    const axes = /** @type {const} */ ([[0, left, right], [1, bottom, top]]);
    const offsets = axes.map(([axis, low, high]) => offsetOfAxis(low + origin[axis], high + origin[axis]));
    const [across, upwards] = [axisInWords('x', offsets[0]), axisInWords('y', offsets[1])];
    const room = view.width - 6 - this.widthOf(across) - 8;
    for (const [axis, low, high] of axes) {
      for (let k = Math.ceil((low + origin[axis]) / step); k * step <= high + origin[axis]; k += 1) {
        const place = k * step - origin[axis];
        const pixel = Math.round(axis === 0 ? view.pixelX(place) : view.pixelY(place)) + 0.5;
        context.globalAlpha = 0.25;
        context.strokeStyle = theme.grid;
        context.lineWidth = 1;
        context.beginPath();
        context.moveTo(axis === 0 ? pixel : 0, axis === 0 ? 0 : pixel);
        context.lineTo(axis === 0 ? pixel : view.width, axis === 0 ? view.height : pixel);
        context.stroke();
        context.globalAlpha = 1;
        const word = tickInWords(k * step - offsets[axis], step);
        const half = this.widthOf(word) / 2;
        if (axis === 0 && pixel - half > 6 && pixel + half < room) {
          this.word(word, pixel, view.height - 5, 'center', 'bottom', theme.ink);
        } else if (axis === 1 && pixel > 26 && pixel < view.height - 26) {
          this.word(word, 5, pixel, 'left', 'middle', theme.ink);
        }
      }
    }
    this.word(across, view.width - 6, view.height - 5, 'right', 'bottom', theme.ink);
    this.word(upwards, 5, 5, 'left', 'top', theme.ink);
    this.scaleBar(step);
  }

  /** @param {number} step metres */
  scaleBar(step) {
    const { context, view, theme } = this;
    const length = step * view.scale;
    const [x, y] = [view.width - 12 - length, 24];
    context.beginPath();
    context.moveTo(x, y - 4);
    context.lineTo(x, y);
    context.lineTo(x + length, y);
    context.lineTo(x + length, y - 4);
    this.strokeWithEdge(theme.ink, 1.6);
    const words = step >= 0.01 ? `${tickInWords(step, step)} m` : `${tickInWords(1000 * step, 1000 * step)} mm`;
    this.word(words, x + length / 2, y - 4, 'center', 'bottom', theme.ink);
  }

  /** Width of a word, CSS pixels. @param {string} text */
  widthOf(text) {
    this.context.font = LETTERS;
    return this.context.measureText(text).width;
  }

  /** A word with an edge. @param {string} text @param {number} x @param {number} y @param {CanvasTextAlign} align
   * @param {CanvasTextBaseline} baseline @param {string} colour */
  word(text, x, y, align, baseline, colour) {
    const { context, theme } = this;
    context.font = LETTERS;
    context.textAlign = align;
    context.textBaseline = baseline;
    context.lineJoin = 'round';
    context.lineWidth = 3;
    context.strokeStyle = theme.paper;
    context.setLineDash([]);
    context.globalAlpha = 0.85;
    context.strokeText(text, x, y);
    context.globalAlpha = 1;
    context.fillStyle = colour;
    context.fillText(text, x, y);
  }

  /** The ways up to a frame: true solid, believed dashed. @param {DriveRecord} record @param {number} frame */
  ways(record, frame) {
    const upTo = (/** @type {ArrayLike<number>} */ poses) => (
      Array.from({ length: frame + 1 }, (_, k) => [poses[7 * k], poses[7 * k + 1]]));
    this.trace(upTo(record.stance));
    this.strokeWithEdge(this.theme.true, 2.4);
    this.trace(upTo(record.believed));
    this.strokeWithEdge(this.theme.believed, 1.8, [6, 5]);
  }

  /** @param {[number, number][]} waypoints start first */
  waypoints(waypoints) {
    const { context, view, theme } = this;
    waypoints.forEach((place, k) => {
      const [x, y] = [view.pixelX(place[0]), view.pixelY(place[1])];
      context.beginPath();
      context.rect(x - 4, y - 4, 8, 8);
      this.strokeWithEdge(theme.waypoint, 2);
      this.word(k === 0 ? 'start' : `waypoint ${k}`, x + 8, y - 7, 'left', 'bottom', theme.waypoint);
    });
  }

  /** The vehicle from above: body, wheels, and an arrow along its heading.
   * @param {DrivePose} pose @param {DriveVehicle} vehicle @param {string} colour @param {boolean} isBelieved */
  vehicle(pose, vehicle, colour, isBelieved) {
    const place = (/** @type {PlanPoint} */ [x, y]) => vecAdd(pose.position, vecTurn(pose.quaternion, [x, y, 0]));
    const rectangle = (/** @type {PlanPoint} */ [x, y], /** @type {PlanPoint} */ [length, across]) => {
      this.trace(RECTANGLE.map(([a, b]) => place([x + a * length / 2, y + b * across / 2])));
    };
    const { wheelbase, track, wheel_radius: radius, wheel_width: width } = vehicle;
    const { context, theme } = this;
    const dash = isBelieved ? [4, 3] : [];
    if (!isBelieved) {
      for (const [x, y] of [[1, 1], [1, -1], [-1, 1], [-1, -1]]) {
        rectangle([x * wheelbase / 2, y * track / 2], [2 * radius, width]);
        context.fillStyle = theme.paper;
        context.globalAlpha = 0.8;
        context.fill();
        context.globalAlpha = 1;
        this.strokeWithEdge(colour, 1.4);
      }
    }
    const bodyWidth = isBelieved ? track + width : Math.max(0.2 * track, track - width);
    rectangle([0, 0], [wheelbase + 2 * radius, bodyWidth]);
    if (!isBelieved) {
      context.fillStyle = theme.body;
      context.globalAlpha = 0.55;
      context.fill();
      context.globalAlpha = 1;
    }
    this.strokeWithEdge(colour, 1.8, dash);
    const tip = wheelbase / 2 + radius;
    this.trace(HEADING_ARROW.map(([x, y]) => place([x * tip, y * tip])));
    this.strokeWithEdge(colour, isBelieved ? 1.4 : 2, dash);
  }

  /** All sectors of an obstacle map. @param {DriveObstacleMap} map @param {number} chosen @param {number} hovered
   * @param {number} inner radius from which lines are drawn, metres */
  sectors(map, chosen, hovered, inner) {
    map.sectors.forEach((_, index) => {
      if (index !== chosen && index !== hovered) { this.sector(map, index, 'plain', inner); }
    });
    if (hovered >= 0 && hovered !== chosen) { this.sector(map, hovered, 'hovered', inner); }
    if (chosen >= 0) { this.sector(map, chosen, 'chosen', inner); }
  }

  /** @param {DriveObstacleMap} map @param {number} index @param {'plain'|'hovered'|'chosen'} how
   * @param {number} inner metres */
  sector(map, index, how, inner) {
    const sector = map.sectors[index];
    if (!sector) { return; }
    const { context, view, theme } = this;
    const look = LABEL_LOOKS[sector.label];
    const colour = theme[sector.label];
    const isPlain = how === 'plain';
    if (!isPlain) {
      this.trace(wedgeOf(map, index));
      context.closePath();
      context.fillStyle = colour;
      context.globalAlpha = how === 'chosen' ? 0.38 : 0.22;
      context.fill();
      context.globalAlpha = 1;
    }
    const from = Math.min(inner, sector.radius);
    this.trace([onCircle(map, sector.direction, from), sector.point]);
    context.lineWidth = isPlain ? 1.1 : 2;
    context.setLineDash(look.dash);
    context.strokeStyle = colour;
    context.globalAlpha = isPlain ? 0.75 : 1;
    context.stroke();
    context.globalAlpha = 1;
    context.setLineDash([]);
    // The end: an arc over the sector's whole width.
    const half = halfWidth(map.sectors, index);
    const end = (/** @type {number} */ share) => onCircle(map, sector.direction + share * half, sector.radius);
    this.trace([-1, -0.5, 0, 0.5, 1].map(end));
    this.strokeWithEdge(colour, isPlain ? 2.4 : 4);
    const across = 2 * half * sector.radius * view.scale;
    const size = isPlain ? Math.max(1.8, Math.min(4.5, across / 2.6)) : 5.5;
    const [x, y] = [view.pixelX(sector.point[0]), view.pixelY(sector.point[1])];
    drawMark(context, look.mark, x, y, size, colour, theme.paper);
    if (!isPlain && sector.missing) {
      this.missing(sector.point, sector.missing, colour);
    }
  }

  /** The place whose elevation is missing. @param {[number, number]} point @param {[number, number]} missing
   * @param {string} colour */
  missing(point, missing, colour) {
    const { context, view, theme } = this;
    const [x, y] = [view.pixelX(missing[0]), view.pixelY(missing[1])];
    this.trace([point, missing]);
    this.strokeWithEdge(colour, 1.2, [2, 3]);
    context.beginPath();
    context.arc(x, y, 8, 0, 2 * Math.PI);
    this.strokeWithEdge(colour, 2.4);
    drawMark(context, 'cross', x, y, 3, colour, theme.paper);
    this.word('missing', x + 12, y, 'left', 'middle', colour);
  }

  /** A frame about a cell. @param {number} x scene metres @param {number} y @param {number} spacing
   * @param {boolean} isChosen */
  cell(x, y, spacing, isChosen) {
    const { context, view, theme } = this;
    const size = Math.max(spacing * view.scale, 5);
    context.beginPath();
    context.rect(view.pixelX(x) - size / 2, view.pixelY(y) - size / 2, size, size);
    this.strokeWithEdge(isChosen ? theme.cursor : theme.ink, isChosen ? 2 : 1.2);
  }
}
