// The map from above: the elevation map as it was at the chosen frame, with ways, vehicle and sectors.

import { element } from '../elements.js';
import { oncePerFrame } from '../frame.js';
import { PlanView } from './plan.js';
import { PlanDrawing } from './plan_drawing.js';
import { CellPaint, cellPicture } from './raster.js';
import { drawCellMarks } from './cell_marks.js';
import { PictureHand } from '../panel/hand.js';
import { mapKeys } from './keys.js';
import { sectorAt } from './sectors.js';

/** @typedef {import('./state.js').DriveState} DriveState */
/** @typedef {import('./state.js').DriveChoice} DriveChoice */
/** @typedef {import('./replay.js').MapReplay} MapReplay */
/** @typedef {import('./raster.js').CellTruth} CellTruth */
/** @typedef {import('./relief.js').Relief} Relief */
/** @typedef {import('./relief.js').PlanBox} PlanBox */
/** @typedef {import('./looks.js').DriveTheme} DriveTheme */
/** @typedef {import('../data/limits.js').ColourScale} ColourScale */

/** Metres that are seen at least of a map that follows the vehicle. */
const FOLLOWED_METRES = 10;

/** Parts of the choice that change nothing on the map. @type {Set<keyof DriveChoice>} */
const BESIDE_THE_MAP = new Set(/** @type {const} */ (['isPlaying', 'speed', 'viewFollows']));

export class DriveMap {
  /** @param {DriveState} state @param {MapReplay} replay @param {DriveTheme} theme */
  constructor(state, replay, theme) {
    this.state = state;
    this.replay = replay;
    this.record = replay.record;
    this.theme = theme;
    /** @type {ColourScale|null} */
    this.elevations = null;
    /** @type {ColourScale|null} */
    this.errors = null;
    /** @type {CellTruth|null} */
    this.truth = null;
    /** @type {Relief|null} */
    this.relief = null;
    this.view = new PlanView(wholePlan(replay), this.record.spacing);
    this.canvas = element('canvas', {
      class: 'drive-map', tabindex: '0', role: 'img', 'data-drive-map': true,
      'aria-label': 'Elevation map from above. Arrow keys move the picture, with Shift the cell cursor, '
        + '+ and − zoom, 0 shows everything.',
    });
    /** @type {{key: string, paint: CellPaint, picture: ReturnType<typeof cellPicture>}|null} */
    this.painted = null;
    /** Draws before the next picture of the screen. */
    this.ask = oncePerFrame(() => this.draw());
    this.extent = replay.extent();
    new PictureHand(this.canvas, this.view, {
      place: (event) => this.place(event),
      pointed: (x, y, isHover) => this.pointed(x, y, isHover),
      left: () => state.set({ hoverCell: null, hoverSector: -1 }),
      panned: () => {
        state.set({ mapFollows: false });
        this.ask();
      },
      zoomed: () => {
        this.follow();
        this.ask();
      },
    });
    mapKeys(this);
    new ResizeObserver(() => this.resize()).observe(this.canvas);
    state.listen((changed) => {
      if (changed.has('mapFollows') && state.choice.mapFollows && this.view.isFitted) { this.comeNear(); }
      if (changed.has('frame') || changed.has('mapFollows')) { this.follow(); }
      if ([...changed].some((key) => !BESIDE_THE_MAP.has(key))) { this.ask(); }
    });
  }

  /** The ground is known from now on. @param {CellTruth} truth @param {ColourScale} errors */
  setTruth(truth, errors) {
    this.truth = truth;
    this.errors = errors;
    this.changedLook();
  }

  /** Colours or scales are other than before. */
  changedLook() {
    this.painted = null;
    this.ask();
  }

  /** The scale of the colours in use; null for sources. */
  get scale() {
    const { colouring } = this.state.choice;
    return colouring === 'elevation' ? this.elevations : colouring === 'error' ? this.errors : null;
  }

  /** The obstacle map at the chosen frame, or null. */
  get obstacles() {
    return this.record.obstacles[this.record.obstacleIndexAt(this.state.choice.frame)] ?? null;
  }

  resize() {
    const { clientWidth, clientHeight } = this.canvas;
    if (clientWidth > 0) {
      this.view.resize(clientWidth, clientHeight);
      this.follow();
      this.ask();
    }
  }

  /** Keeps the vehicle in the middle, if that is wanted. */
  follow() {
    const { choice } = this.state;
    if (choice.mapFollows) {
      const [x, y] = this.record.truePose(choice.frame).position;
      this.view.centreOn(x, y);
    }
  }

  /** Magnifies so that some metres about the vehicle are seen: the whole map cannot follow it. */
  comeNear() {
    const { view } = this;
    const scale = Math.min(view.width, view.height) / FOLLOWED_METRES;
    view.zoomAbout(scale / view.scale, view.width / 2, view.height / 2);
  }

  /** Cells that are seen, within what was ever known; null if none is. */
  seenCells() {
    const { extent } = this;
    if (!extent) { return null; }
    const [left, top] = this.replay.cellAt(...this.view.placeAt(0, 0));
    const [right, bottom] = this.replay.cellAt(...this.view.placeAt(this.view.width, this.view.height));
    // One cell more, so that the shade at the rim has neighbours.
    const box = {
      left: Math.max(left - 1, extent.left), right: Math.min(right + 1, extent.right),
      bottom: Math.max(bottom - 1, extent.bottom), top: Math.min(top + 1, extent.top),
    };
    return box.left <= box.right && box.bottom <= box.top ? box : null;
  }

  draw() {
    const { canvas, view, theme, state: { choice } } = this;
    const context = canvas.getContext('2d');
    if (!context || canvas.clientWidth === 0) { return; }
    const ratio = window.devicePixelRatio || 1;
    const [width, height] = [Math.round(canvas.clientWidth * ratio), Math.round(canvas.clientHeight * ratio)];
    if (canvas.width !== width || canvas.height !== height) {
      [canvas.width, canvas.height] = [width, height];
    }
    this.replay.goTo(choice.frame);
    context.setTransform(ratio, 0, 0, ratio, 0, 0);
    context.fillStyle = theme.empty;
    context.fillRect(0, 0, view.width, view.height);
    if (choice.hasRelief && this.relief) { this.drawRelief(context, this.relief); }
    this.drawCells(context);
    const drawing = new PlanDrawing(context, view, theme);
    drawing.grid(this.record.origin);
    drawing.ways(this.record, choice.frame);
    drawing.vehicle(this.record.believedPose(choice.frame), this.record.vehicle, theme.believed, true);
    drawing.vehicle(this.record.truePose(choice.frame), this.record.vehicle, theme.true, false);
    const { obstacles } = this;
    if (obstacles && choice.hasSectors) {
      const inner = this.record.vehicle.wheelbase / 2 + 0.1;
      drawing.sectors(obstacles, choice.sector, choice.hoverSector, inner);
    }
    drawing.waypoints(this.record.waypoints);
    for (const [cell, isChosen] of /** @type {const} */ ([[choice.hoverCell, false], [choice.cell, true]])) {
      if (cell) { drawing.cell(...this.replay.placeOf(cell[0], cell[1]), this.record.spacing, isChosen); }
    }
    canvas.dataset.driveDrawn = String(choice.frame);
  }

  /** @param {CanvasRenderingContext2D} context @param {Relief} relief */
  drawRelief(context, { canvas, box }) {
    const { view } = this;
    context.imageSmoothingEnabled = true;
    const [x, y] = [view.pixelX(box.left), view.pixelY(box.top)];
    context.drawImage(canvas, x, y, view.pixelX(box.right) - x, view.pixelY(box.bottom) - y);
  }

  /** @param {CanvasRenderingContext2D} context */
  drawCells(context) {
    const box = this.seenCells();
    const { choice } = this.state;
    if (!box || (choice.colouring === 'error' && !this.truth)) { return; }
    const { left: l, right: r, bottom: b, top: t } = box;
    const key = [choice.frame, choice.colouring, choice.isShaded, l, r, b, t].join('/');
    if (this.painted?.key !== key) {
      const paint = new CellPaint(this.replay, choice.colouring, this.scale, this.truth, this.theme);
      this.painted = { key, paint, picture: cellPicture(paint, box, choice.isShaded) };
    }
    const { canvas, left, bottom, columns, rows, step } = this.painted.picture;
    const { view, replay, record } = this;
    const size = record.spacing * step;
    const [x, y] = replay.placeOf(left, bottom);
    context.imageSmoothingEnabled = size * view.scale < 1;
    const top = y - size / 2 + rows * size;
    const [wide, high] = [columns * size * view.scale, rows * size * view.scale];
    context.drawImage(canvas, view.pixelX(x - size / 2), view.pixelY(top), wide, high);
    drawCellMarks(context, view, this.painted.paint, box, record.origin[2]);
  }

  /** The place of a pointer in the picture, CSS pixels. @param {{clientX: number, clientY: number}} event
   * @returns {[number, number]} */
  place(event) {
    const box = this.canvas.getBoundingClientRect();
    const { clientLeft, clientTop } = this.canvas;
    return [event.clientX - box.left - clientLeft, event.clientY - box.top - clientTop];
  }

  /**
   * The pointer is at a place, or clicked it.
   * @param {number} x CSS pixels @param {number} y @param {boolean} isHover
   */
  pointed(x, y, isHover) {
    const place = this.view.placeAt(x, y);
    const cell = this.replay.cellAt(...place);
    const { obstacles, state } = this;
    const sector = obstacles && state.choice.hasSectors ? sectorAt(obstacles, ...place) : -1;
    state.set(isHover
      ? { hoverCell: cell, hoverSector: sector } : { cell, sector, hoverCell: null, hoverSector: -1 });
  }

  /** Moves the cell cursor. @param {number} di @param {number} dj */
  moveCell(di, dj) {
    const { view, replay, state } = this;
    const start = state.choice.cell ?? replay.cellAt(view.centreX, view.centreY);
    const cell = /** @type {[number, number]} */ (state.choice.cell ? [start[0] + di, start[1] + dj] : start);
    const place = replay.placeOf(cell[0], cell[1]);
    view.show(...place);
    const { obstacles } = this;
    const sector = obstacles && state.choice.hasSectors ? sectorAt(obstacles, ...place) : -1;
    state.set({ cell, hoverCell: null, sector });
    this.ask();
  }
}

/** Everything that the map may show: all cells ever known, and both ways. @param {MapReplay} replay
 * @returns {PlanBox} */
function wholePlan(replay) {
  const { record } = replay;
  const box = { left: Infinity, bottom: Infinity, right: -Infinity, top: -Infinity };
  const add = (/** @type {number} */ x, /** @type {number} */ y, /** @type {number} */ room) => {
    if (Number.isFinite(x) && Number.isFinite(y)) {
      box.left = Math.min(box.left, x - room);
      box.right = Math.max(box.right, x + room);
      box.bottom = Math.min(box.bottom, y - room);
      box.top = Math.max(box.top, y + room);
    }
  };
  for (let frame = 0; frame < record.count; frame += 1) {
    add(record.stance[7 * frame], record.stance[7 * frame + 1], 1.4);
    add(record.believed[7 * frame], record.believed[7 * frame + 1], 1.4);
  }
  record.waypoints.forEach(([x, y]) => add(x, y, 1));
  const extent = replay.extent();
  if (extent) {
    add(...replay.placeOf(extent.left, extent.bottom), 0.5);
    add(...replay.placeOf(extent.right, extent.top), 0.5);
  }
  return box.left <= box.right ? box : { left: -1, bottom: -1, right: 1, top: 1 };
}
