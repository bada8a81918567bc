// Labels over the picture: elements of HTML, each near its place, none over another.

/** @typedef {{left: number, top: number, right: number, bottom: number}} LabelBox CSS pixels */
/**
 * @typedef {object} PlacedLabel
 * @property {number} x place of the labelled point, CSS pixels
 * @property {number} y
 * @property {string} text
 * @property {string} colour as in a style
 * @property {number} priority the higher is placed first; below 1 it goes away where there is no room
 * @property {boolean} isTick
 */
/** @typedef {{x: number, y: number, toX: number, toY: number, colour: string}} LeaderLine */

const LABEL_HEIGHT = 19;
const TICK_HEIGHT = 14;
/** Distances from the point at which a label may stand, CSS pixels. */
const LABEL_RINGS = [14, 30, 52, 80, 116, 160, 210];
/** Directions in which a label may stand, the best first: x to the right, y down. */
const LABEL_DIRECTIONS = [
  [1, -0.5],
  [1, 0.5],
  [-1, -0.5],
  [-1, 0.5],
  [0, -1],
  [0, 1],
  [1, -1],
  [-1, -1],
  [1, 1],
  [-1, 1],
];

/** The layer of labels. */
export class LabelLayer {
  /** @param {HTMLElement} host an element over the canvas */
  constructor(host) {
    this.host = host;
    /** @type {HTMLElement[]} */
    this.pool = [];
    /** @type {Map<string, number>} */
    this.widths = new Map();
    this.measure = document.createElement('canvas').getContext('2d');
  }

  /** Width of a text, CSS pixels. @param {string} text @param {boolean} isTick */
  #width(text, isTick) {
    const key = `${isTick}${text}`;
    const known = this.widths.get(key);
    if (known !== undefined) return known;
    let width = 7 * text.length;
    if (this.measure) {
      this.measure.font = `${isTick ? '11px' : '600 12px'} ${getComputedStyle(this.host).fontFamily}`;
      width = this.measure.measureText(text).width;
    }
    width = Math.ceil(width) + (isTick ? 4 : 13);
    if (this.widths.size > 2000) this.widths.clear();
    this.widths.set(key, width);
    return width;
  }

  /**
   * Shows labels.
   * @param {PlacedLabel[]} labels
   * @param {number} width of the canvas, CSS pixels
   * @param {number} height
   * @param {LabelBox[]} taken places that no label may cover
   * @returns {LeaderLine[]} lines from labels that stand away to their points
   */
  show(labels, width, height, taken) {
    const boxes = [...taken];
    /** @type {LeaderLine[]} */
    const leaders = [];
    let used = 0;
    const sorted = labels
      .filter((label) => label.x > -40 && label.y > -40 && label.x < width + 40 && label.y < height + 40)
      .sort((a, b) => b.priority - a.priority);
    for (const label of sorted) {
      const w = this.#width(label.text, label.isTick);
      const h = label.isTick ? TICK_HEIGHT : LABEL_HEIGHT;
      const box = this.#freePlace(label, w, h, width, height, boxes);
      if (!box) continue;
      boxes.push(box);
      this.#element(used, label, box);
      used += 1;
      const toX = Math.max(box.left, Math.min(label.x, box.right));
      const toY = Math.max(box.top, Math.min(label.y, box.bottom));
      if (!label.isTick && Math.hypot(toX - label.x, toY - label.y) > 12) {
        leaders.push({ x: label.x, y: label.y, toX, toY, colour: label.colour });
      }
    }
    for (let k = used; k < this.pool.length; k++) this.pool[k].hidden = true;
    return leaders;
  }

  /**
   * @param {PlacedLabel} label
   * @param {number} w
   * @param {number} h
   * @param {number} width
   * @param {number} height
   * @param {LabelBox[]} boxes
   * @returns {LabelBox | null}
   */
  #freePlace(label, w, h, width, height, boxes) {
    const rings = label.isTick ? [5, 12] : label.priority < 1 ? LABEL_RINGS.slice(0, 2) : LABEL_RINGS;
    for (const ring of rings) {
      for (const [dx, dy] of LABEL_DIRECTIONS) {
        const x = label.x + dx * ring + (dx > 0 ? 0 : dx < 0 ? -w : -w / 2);
        const y = label.y + dy * ring + (dy === -1 ? -h : dy === 1 ? 0 : -h / 2);
        const box = { left: x, top: y, right: x + w, bottom: y + h };
        if (box.left < 2 || box.top < 2 || box.right > width - 2 || box.bottom > height - 2) continue;
        const isFree = boxes.every(
          (other) =>
            box.right + 1 < other.left ||
            other.right + 1 < box.left ||
            box.bottom + 1 < other.top ||
            other.bottom + 1 < box.top,
        );
        if (isFree) return box;
      }
    }
    return null;
  }

  /** @param {number} index @param {PlacedLabel} label @param {LabelBox} box */
  #element(index, label, box) {
    let element = this.pool[index];
    if (!element) {
      element = document.createElement('span');
      this.host.append(element);
      this.pool.push(element);
    }
    element.hidden = false;
    const name = label.isTick ? 'view3d-tick' : 'view3d-label';
    if (element.className !== name) element.className = name;
    if (element.textContent !== label.text) element.textContent = label.text;
    element.style.transform = `translate(${Math.round(box.left)}px, ${Math.round(box.top)}px)`;
    element.style.setProperty('--label-colour', label.colour);
  }
}
