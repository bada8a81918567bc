// The WebGL2 canvas of the drive: true ground, cells of the map, vehicle, and lines over them.

import { GlStage } from '../gl/stage.js';
import { SolidDrawing } from './solid.js';

/** @typedef {import('../view3d/camera.js').ViewCamera} ViewCamera */
/** @typedef {import('../view3d/drawing.js').SceneDrawing} SceneDrawing */
/** @typedef {import('../gl/mesh.js').TerrainLook} TerrainLook */
/** @typedef {import('../gl/mesh.js').Rgb} Rgb */
/** @typedef {import('./solid.js').SolidMesh} SolidMesh */

/** Share of the depth by which cells are drawn nearer to the eye: ground at the same height hides none. */
const CELL_PULL = 6e-4;

export class DriveStage extends GlStage {
  /** @param {HTMLCanvasElement} canvas @param {(isLost: boolean) => void} onLoss */
  constructor(canvas, onLoss) {
    super(canvas, onLoss);
    /** @type {{cells: SolidDrawing, body: SolidDrawing}|null} */
    this.solids = null;
    /** @type {SolidMesh|null} */
    this.cells = null;
    /** @type {SolidMesh|null} */
    this.body = null;
  }

  forget() {
    this.solids = null;
  }

  /** @param {SolidMesh|null} cells null: none are shown */
  setCells(cells) {
    this.cells = cells;
    if (cells) { this.solids?.cells.set(cells); }
  }

  /** @param {SolidMesh} body */
  setBody(body) {
    this.body = body;
    this.solids?.body.set(body);
  }

  #makeSolids() {
    const solids = { cells: new SolidDrawing(this.gl), body: new SolidDrawing(this.gl) };
    if (this.cells) { solids.cells.set(this.cells); }
    if (this.body) { solids.body.set(this.body); }
    this.solids = solids;
    return solids;
  }

  /**
   * @param {ViewCamera} camera @param {number} pixelRatio @param {TerrainLook|null} look null: no ground
   * @param {SceneDrawing} drawing @param {Record<string, Rgb>} colours
   */
  drawDrive(camera, pixelRatio, look, drawing, colours) {
    if (!this.begin(camera, pixelRatio, colours.sky)) { return; }
    const solids = this.solids ?? this.#makeSolids();
    if (look) { this.terrainDrawing?.draw(camera, look, pixelRatio); }
    if (this.cells) { solids.cells.draw(camera, 0.45, CELL_PULL); }
    solids.body.draw(camera, 0.45, 0);
    this.drawStrokes(camera, pixelRatio, [drawing], colours, CELL_PULL);
  }
}
