// The part of the plane that the map shows: centre and scale, and the way between metres and CSS pixels. y is up.

/** @typedef {import('./relief.js').PlanBox} PlanBox */

/** Largest scale: pixels across a cell. */
const LARGEST_PLAN_CELL = 200;

export class PlanView {
  /** @param {PlanBox} everything @param {number} spacing of the cells, metres */
  constructor(everything, spacing) {
    this.everything = everything;
    this.spacing = spacing;
    this.centreX = (everything.left + everything.right) / 2;
    this.centreY = (everything.bottom + everything.top) / 2;
    /** Pixels of a metre. */
    this.scale = 1;
    this.width = 1;
    this.height = 1;
    this.isFitted = true;
  }

  /** @param {number} width CSS pixels @param {number} height */
  resize(width, height) {
    this.width = Math.max(1, width);
    this.height = Math.max(1, height);
    if (this.isFitted) {
      this.fit();
    } else {
      this.scale = this.clampedScale(this.scale);
    }
  }

  get fitScale() {
    const { left, right, bottom, top } = this.everything;
    return Math.min(this.width / Math.max(right - left, 1e-6), this.height / Math.max(top - bottom, 1e-6));
  }

  /** @param {number} scale */
  clampedScale(scale) {
    return Math.min(Math.max(scale, this.fitScale), Math.max(this.fitScale, LARGEST_PLAN_CELL / this.spacing));
  }

  /** Shows everything. */
  fit() {
    const { left, right, bottom, top } = this.everything;
    this.scale = this.fitScale;
    this.centreX = (left + right) / 2;
    this.centreY = (bottom + top) / 2;
    this.isFitted = true;
  }

  /** @param {number} x metres */
  pixelX(x) {
    return this.width / 2 + (x - this.centreX) * this.scale;
  }

  /** @param {number} y metres */
  pixelY(y) {
    return this.height / 2 - (y - this.centreY) * this.scale;
  }

  /** The place under a pixel, metres. @param {number} x @param {number} y @returns {[number, number]} */
  placeAt(x, y) {
    return [this.centreX + (x - this.width / 2) / this.scale, this.centreY - (y - this.height / 2) / this.scale];
  }

  /** Magnifies about a pixel: the place under it stays. @param {number} factor @param {number} x
   * @param {number} y */
  zoomAbout(factor, x, y) {
    const place = this.placeAt(x, y);
    this.scale = this.clampedScale(this.scale * factor);
    this.isFitted = this.scale <= this.fitScale * 1.0001;
    if (this.isFitted) {
      this.fit();
      return;
    }
    this.centreX = place[0] - (x - this.width / 2) / this.scale;
    this.centreY = place[1] + (y - this.height / 2) / this.scale;
    this.keepInside();
  }

  /** Moves the picture. @param {number} x CSS pixels @param {number} y */
  panBy(x, y) {
    this.centreX -= x / this.scale;
    this.centreY += y / this.scale;
    this.keepInside();
  }

  /** @param {number} x metres @param {number} y */
  centreOn(x, y) {
    this.centreX = x;
    this.centreY = y;
    this.keepInside();
  }

  /** Moves the picture so that a place is in it, and not at its rim. @param {number} x metres @param {number} y */
  show(x, y) {
    const [across, down] = [this.pixelX(x) / this.width, this.pixelY(y) / this.height];
    if (!(across > 0.06 && across < 0.94 && down > 0.06 && down < 0.94)) {
      this.centreOn(x, y);
    }
  }

  /** The centre stays within everything, or in its middle where all of it is seen. */
  keepInside() {
    const { left, right, bottom, top } = this.everything;
    this.centreX = keptCentre(this.centreX, left, right, this.width / this.scale);
    this.centreY = keptCentre(this.centreY, bottom, top, this.height / this.scale);
  }
}

/** @param {number} centre @param {number} low @param {number} high @param {number} shown all metres */
function keptCentre(centre, low, high, shown) {
  return shown >= high - low ? (low + high) / 2 : Math.min(Math.max(centre, low + shown / 2), high - shown / 2);
}
