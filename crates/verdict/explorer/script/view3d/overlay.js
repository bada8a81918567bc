// The canvas over the picture: marks of points, lines to labels, the frame of the camera's image, a bar of
// scale.

/** @typedef {import('./drawing.js').MarkShape} MarkShape */
/** @typedef {import('./labels.js').LeaderLine} LeaderLine */
/** @typedef {{left: number, top: number, width: number, height: number}} FrameBox CSS pixels */

/** Half sizes of marks, CSS pixels. They differ, so that marks of one point are seen within each other. */
const MARK_SIZES = /** @type {Record<MarkShape, number>} */ ({
  circle: 10,
  square: 6.5,
  plus: 14,
  cross: 7,
  dot: 3.5,
  pixel: 5,
  ring: 6,
});

/** The 2-D drawing over the 3-D picture. */
export class OverlayCanvas {
  /** @param {HTMLCanvasElement} canvas */
  constructor(canvas) {
    this.canvas = canvas;
    this.pen = canvas.getContext('2d');
  }

  /** Starts a frame. @param {number} width CSS pixels @param {number} height @param {number} pixelRatio */
  begin(width, height, pixelRatio) {
    const { canvas, pen } = this;
    const [w, h] = [Math.round(width * pixelRatio), Math.round(height * pixelRatio)];
    if (canvas.width !== w || canvas.height !== h) {
      canvas.width = w;
      canvas.height = h;
    }
    if (!pen) return;
    pen.setTransform(pixelRatio, 0, 0, pixelRatio, 0, 0);
    pen.clearRect(0, 0, width, height);
    pen.lineCap = 'round';
    pen.lineJoin = 'round';
  }

  /** @param {LeaderLine[]} leaders */
  leaders(leaders) {
    const { pen } = this;
    if (!pen) return;
    pen.lineWidth = 1;
    for (const { x, y, toX, toY, colour } of leaders) {
      pen.strokeStyle = colour;
      pen.beginPath();
      pen.moveTo(x, y);
      pen.lineTo(toX, toY);
      pen.stroke();
    }
  }

  /**
   * A mark with a rim of the other tone, so that it is seen on any ground.
   * @param {number} x
   * @param {number} y
   * @param {MarkShape} shape
   * @param {string} colour
   * @param {string} rim
   */
  mark(x, y, shape, colour, rim) {
    const { pen } = this;
    if (!pen) return;
    const size = MARK_SIZES[shape];
    const path = new Path2D();
    if (shape === 'circle' || shape === 'dot' || shape === 'ring') path.arc(x, y, size, 0, 2 * Math.PI);
    else if (shape === 'square' || shape === 'pixel') path.rect(x - size, y - size, 2 * size, 2 * size);
    else if (shape === 'plus') {
      for (const [dx, dy] of [
        [1, 0],
        [-1, 0],
        [0, 1],
        [0, -1],
      ]) {
        path.moveTo(x + dx * 3, y + dy * 3);
        path.lineTo(x + dx * size, y + dy * size);
      }
    } else {
      path.moveTo(x - size, y - size);
      path.lineTo(x + size, y + size);
      path.moveTo(x + size, y - size);
      path.lineTo(x - size, y + size);
    }
    const width = shape === 'plus' ? 1.8 : 2.6;
    if (shape === 'dot') {
      pen.fillStyle = colour;
      pen.fill(path);
      pen.strokeStyle = rim;
      pen.lineWidth = 1;
      pen.stroke(path);
      return;
    }
    pen.strokeStyle = rim;
    pen.lineWidth = width + 2.4;
    pen.stroke(path);
    pen.strokeStyle = colour;
    pen.lineWidth = width;
    pen.stroke(path);
  }

  /**
   * Dims what is outside of the camera's image, and frames it.
   * @param {FrameBox} box
   * @param {number} width
   * @param {number} height
   * @param {string} outside
   * @param {string} line
   */
  frame(box, width, height, outside, line) {
    const { pen } = this;
    if (!pen) return;
    pen.fillStyle = outside;
    const path = new Path2D();
    path.rect(0, 0, width, height);
    path.rect(box.left, box.top, box.width, box.height);
    pen.fill(path, 'evenodd');
    pen.strokeStyle = line;
    pen.lineWidth = 1.5;
    pen.strokeRect(box.left, box.top, box.width, box.height);
  }

  /**
   * The cell of the image, at its true size if that can be seen.
   * @param {FrameBox} box
   * @param {string} colour
   * @param {string} rim
   */
  cell(box, colour, rim) {
    const { pen } = this;
    if (!pen) return;
    const grow = Math.max(0, (9 - box.width) / 2);
    const [x, y, w, h] = [box.left - grow, box.top - grow, box.width + 2 * grow, box.height + 2 * grow];
    pen.strokeStyle = rim;
    pen.lineWidth = 4;
    pen.strokeRect(x, y, w, h);
    pen.strokeStyle = colour;
    pen.lineWidth = 2;
    pen.strokeRect(x, y, w, h);
  }

  /**
   * A bar of scale at the lower left.
   * @param {number} length CSS pixels
   * @param {string} text
   * @param {number} height
   * @param {string} colour
   * @param {string} rim
   * @param {string} font
   */
  scaleBar(length, text, height, colour, rim, font) {
    const { pen } = this;
    if (!pen) return;
    const [x, y] = [14, height - 14];
    const path = new Path2D();
    path.moveTo(x, y - 5);
    path.lineTo(x, y);
    path.lineTo(x + length, y);
    path.lineTo(x + length, y - 5);
    pen.strokeStyle = rim;
    pen.lineWidth = 5;
    pen.stroke(path);
    pen.strokeStyle = colour;
    pen.lineWidth = 2;
    pen.stroke(path);
    pen.font = font;
    pen.strokeStyle = rim;
    pen.lineWidth = 4;
    pen.strokeText(text, x + 5, y - 6);
    pen.fillStyle = colour;
    pen.fillText(text, x + 5, y - 6);
  }
}
