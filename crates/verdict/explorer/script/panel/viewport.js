// The part of a sensor that a picture shows: centre and magnification, and the way between cells and pixels.
// All sizes are pixels of the device, so that a cell covers whole pixels at high magnification.

/** Cells of flat sensors are drawn at least so high, if the whole sensor is shown: CSS pixels. */
const FLAT_ROW_HEIGHT = 10;

/** The same on a wide page: CSS pixels. */
const WIDE_ROW_HEIGHT = 18;

/** From this width on a page is wide: CSS pixels. */
const WIDE = 760;

/** Largest cell: CSS pixels. */
const LARGEST_CELL = 260;

export class Viewport {
  /** @param {number} columns @param {number} rows */
  constructor(columns, rows) {
    this.columns = columns;
    this.rows = rows;
    /** Centre, cells. */
    this.centreX = columns / 2;
    this.centreY = rows / 2;
    /** Magnification beyond that at which the whole sensor fits. */
    this.zoom = 1;
    /** Area of the picture, pixels of the device. */
    this.width = 1;
    this.height = 1;
    this.ratio = 1;
  }

  /** Height of the area for a width, CSS pixels. @param {number} width */
  heightFor(width) {
    const square = (width * this.rows) / this.columns;
    const [row, most] = width >= WIDE ? [WIDE_ROW_HEIGHT, 320] : [FLAT_ROW_HEIGHT, 160];
    const flat = Math.min(most, Math.max(this.rows * row, 64));
    return Math.round(Math.min(Math.max(square, flat), 640));
  }

  /**
   * @param {number} width
   * @param {number} height
   * @param {number} ratio pixels of the device in a CSS pixel
   */
  resize(width, height, ratio) {
    this.width = Math.max(1, width);
    this.height = Math.max(1, height);
    this.ratio = ratio;
    this.keepInside();
  }

  /** Scale at which all columns fit, and all rows of a sensor that is not flat. */
  get fitScale() {
    const across = this.width / this.columns;
    const down = this.height / this.rows;
    return this.isFlat ? across : Math.min(across, down);
  }

  /** Whether the sensor is so flat that rows are drawn higher than columns are wide. */
  get isFlat() {
    return (this.rows * this.width) / this.columns < 0.5 * this.height;
  }

  get largestZoom() {
    return Math.max(1, (LARGEST_CELL * this.ratio) / this.fitScale);
  }

  /** Pixels of the device across a cell. */
  get scaleX() {
    return this.isFitted ? this.fitScale : Math.max(this.fitScale, wholeScale(this.fitScale * this.zoom));
  }

  /** Pixels of the device down a cell. */
  get scaleY() {
    if (!this.isFlat) {
      return this.scaleX;
    }
    return Math.max(this.scaleX, wholeScale(this.height / this.rows));
  }

  /** How many times higher than wide a cell is drawn. */
  get stretch() {
    return this.scaleY / this.scaleX;
  }

  /** Pixel of the left edge of column 0. */
  get left() {
    return Math.round(this.width / 2 - this.centreX * this.scaleX);
  }

  /** Pixel of the upper edge of row 0. */
  get top() {
    return Math.round(this.height / 2 - this.centreY * this.scaleY);
  }

  /**
   * The place in cells under a pixel of the area.
   * @param {number} x
   * @param {number} y
   * @returns {[number, number]}
   */
  cellsAt(x, y) {
    return [(x - this.left) / this.scaleX, (y - this.top) / this.scaleY];
  }

  /** The cell under a pixel; -1 outside. @param {number} x @param {number} y */
  cellAt(x, y) {
    const [i, j] = this.cellsAt(x, y).map(Math.floor);
    return i >= 0 && i < this.columns && j >= 0 && j < this.rows ? j * this.columns + i : -1;
  }

  /** Columns and rows that can be seen: first and one past the last. */
  visibleCells() {
    const [left, top] = this.cellsAt(0, 0);
    const [right, bottom] = this.cellsAt(this.width, this.height);
    return {
      left: Math.max(0, Math.floor(left)),
      right: Math.min(this.columns, Math.ceil(right)),
      top: Math.max(0, Math.floor(top)),
      bottom: Math.min(this.rows, Math.ceil(bottom)),
    };
  }

  /**
   * Magnifies about a pixel of the area: the place under it stays.
   * @param {number} factor @param {number} x @param {number} y
   */
  zoomAbout(factor, x, y) {
    const [i, j] = this.cellsAt(x, y);
    this.zoom = Math.min(Math.max(this.zoom * factor, 1), this.largestZoom);
    this.centreX = i - (x - this.width / 2) / this.scaleX;
    this.centreY = j - (y - this.height / 2) / this.scaleY;
    this.keepInside();
  }

  /** Moves the picture, pixels of the device. @param {number} x @param {number} y */
  panBy(x, y) {
    this.centreX -= x / this.scaleX;
    this.centreY -= y / this.scaleY;
    this.keepInside();
  }

  /** Shows everything. */
  fit() {
    this.zoom = 1;
    this.keepInside();
  }

  /** Whether everything is shown. */
  get isFitted() {
    return this.zoom <= 1.0001;
  }

  /**
   * Shows a cell in the middle, at least so large.
   * @param {number} cell @param {number} size CSS pixels
   */
  centreOn(cell, size) {
    const wanted = (size * this.ratio) / this.fitScale;
    this.zoom = Math.min(Math.max(this.zoom, wanted, 1), this.largestZoom);
    this.centreX = (cell % this.columns) + 0.5;
    this.centreY = Math.floor(cell / this.columns) + 0.5;
    this.keepInside();
  }

  /** Whether a cell is in the area, and not at its rim. @param {number} cell */
  shows(cell) {
    const x = this.left + ((cell % this.columns) + 0.5) * this.scaleX;
    const y = this.top + (Math.floor(cell / this.columns) + 0.5) * this.scaleY;
    return x > 0.05 * this.width && x < 0.95 * this.width && y > 0.02 * this.height && y < 0.98 * this.height;
  }

  /** No empty space beside a picture that is larger than its area. */
  keepInside() {
    this.zoom = Math.min(Math.max(this.zoom, 1), this.largestZoom);
    this.centreX = inside(this.centreX, this.columns, this.width / this.scaleX);
    this.centreY = inside(this.centreY, this.rows, this.height / this.scaleY);
  }

  /** Takes over what another viewport of the same sensor size shows. @param {Viewport} other */
  follow(other) {
    this.zoom = other.zoom;
    this.centreX = other.centreX;
    this.centreY = other.centreY;
    this.keepInside();
  }
}

/** A scale of at least three pixels is a whole number of them. @param {number} scale */
function wholeScale(scale) {
  return scale >= 3 ? Math.floor(scale + 1e-9) : scale;
}

/** @param {number} centre @param {number} count cells @param {number} shown cells */
function inside(centre, count, shown) {
  return shown >= count ? count / 2 : Math.min(Math.max(centre, shown / 2), count - shown / 2);
}
