// The WebGL2 canvas of a cloud: the mesh, and the points on it.

import { GlStage } from '../gl/stage.js';
import { PointsDrawing } from '../gl/points.js';

/** @typedef {import('../view3d/camera.js').ViewCamera} ViewCamera */
/** @typedef {import('../gl/mesh.js').TerrainLook} TerrainLook */
/** @typedef {import('../gl/mesh.js').Rgb} Rgb */

export class CloudStage extends GlStage {
  /** @param {HTMLCanvasElement} canvas @param {(isLost: boolean) => void} onLoss */
  constructor(canvas, onLoss) {
    super(canvas, onLoss);
    /** @type {PointsDrawing|null} */
    this.points = null;
    /** @type {{positions: Float32Array, colours: Uint32Array}|null} */
    this.cloud = null;
  }

  forget() {
    this.points = null;
  }

  /** @param {Float32Array} positions three numbers each @param {Uint32Array} colours */
  setCloud(positions, colours) {
    this.cloud = { positions, colours };
    this.points?.set(positions, colours);
  }

  #makePoints() {
    const points = new PointsDrawing(this.gl);
    if (this.cloud) {
      points.set(this.cloud.positions, this.cloud.colours);
    }
    this.points = points;
    return points;
  }

  /**
   * @param {ViewCamera} camera @param {number} pixelRatio @param {TerrainLook|null} look null: no mesh
   * @param {number} size of a point, CSS pixels; 0: none @param {Rgb} sky
   */
  drawCloud(camera, pixelRatio, look, size, sky) {
    if (!this.begin(camera, pixelRatio, sky)) {
      return;
    }
    if (look) {
      this.terrainDrawing?.draw(camera, look, pixelRatio);
    }
    if (size > 0) {
      (this.points ?? this.#makePoints()).draw(camera, size * pixelRatio);
    }
  }
}
