// Small drawings of the paper's approximations: the true geometry in green, the paper's in red.

import { svgElement } from '../elements.js';

/** @typedef {(board: SketchBoard) => void} Sketch */

/** A drawing area with the few shapes that sketches need. Style comes from classes. */
class SketchBoard {
  /** @param {string} title */
  constructor(title) {
    this.root = svgElement('svg', {
      class: 'x-sketch',
      viewBox: '0 0 320 130',
      role: 'img',
      'aria-label': title,
    });
  }

  /** @param {string} d @param {string} kind */
  path(d, kind) {
    this.root.append(svgElement('path', { d, class: `x-sk-${kind}` }));
  }

  /** @param {number} x @param {number} y @param {string} kind */
  dot(x, y, kind) {
    this.root.append(svgElement('circle', { cx: x, cy: y, r: 4, class: `x-sk-${kind}` }));
  }

  /** @param {number} x @param {number} y @param {string} text @param {'start'|'middle'|'end'} [anchor] */
  text(x, y, text, anchor = 'start') {
    this.root.append(svgElement('text', { x, y, 'text-anchor': anchor, class: 'x-sk-text' }, text));
  }

  /** The body of a sensor that looks to the right. @param {number} x @param {number} y */
  sensor(x, y) {
    this.path(`M${x - 12} ${y - 7} h14 v14 h-14 z M${x + 2} ${y - 3} l7 -4 v14 l-7 -4 z`, 'body');
  }
}

/** @type {Record<string, {title: string, draw: Sketch}>} */
const SKETCHES = {
  'beam-edges': {
    title: "A face's side is a curve on the grid of the beam; the paper draws its chord.",
    draw: (board) => {
      for (let i = 0; i <= 8; i += 1) {
        board.path(`M${30 + i * 25} 14 V104`, 'grid');
      }
      for (let j = 0; j <= 3; j += 1) {
        board.path(`M30 ${14 + j * 30} H230`, 'grid');
      }
      board.path('M30 104 Q95 34 230 14 V104 Z', 'face');
      board.path('M30 104 Q95 34 230 14', 'true');
      board.path('M30 104 L230 14', 'paper');
      board.dot(117, 58, 'ray');
      board.text(125, 76, 'this pencil loses its face');
      board.text(40, 30, 'curve: true');
      board.text(226, 122, 'chord: the paper', 'end');
    },
  },
  'skip-rules': {
    title:
      'All corners of a face lie beyond the maximum range, its inside does not. The paper skips the face.',
    draw: (board) => {
      board.sensor(22, 65);
      board.path('M120 4 A110 110 0 0 1 120 126', 'limit');
      board.path('M134 6 L142 124', 'paper');
      board.path('M139 44.5 L139.8 82', 'true');
      board.dot(134, 6, 'corner');
      board.dot(142, 124, 'corner');
      board.path('M31 65 H139', 'raypath');
      board.dot(138.6, 65, 'ray');
      board.text(112, 118, 'maximum range', 'end');
      board.text(152, 14, 'corner beyond it');
      board.text(150, 62, 'inside within it: skipped');
      board.text(150, 76, 'all the same');
    },
  },
  facing: {
    title: "The paper judges by the camera's axis whether a face hides; exactly it depends on the ray.",
    draw: (board) => {
      board.sensor(22, 92);
      board.path('M31 92 H236', 'limit');
      board.text(238, 106, "camera's axis", 'end');
      board.path('M116 40 L150 66', 'paper');
      board.path('M133 53 L149 31', 'normal');
      board.path('M31 92 L224 20', 'raypath');
      board.dot(224, 20, 'ray');
      board.text(154, 76, 'turned away from the axis:');
      board.text(154, 90, 'not asked');
      board.text(218, 16, 'hidden point', 'end');
    },
  },
  extent: {
    title: 'A face that lies deeper than the upper stripe is not asked whether it hides.',
    draw: (board) => {
      board.sensor(22, 28);
      board.path('M10 112 H250', 'ground');
      board.path('M132 6 V122', 'limit');
      board.text(128, 16, 'end of the upper stripe', 'end');
      board.path('M168 112 V66', 'paper');
      board.path('M31 28 L222 112', 'raypath');
      board.dot(222, 112, 'ray');
      board.text(174, 62, 'deeper: not asked');
      board.text(228, 104, 'hidden');
    },
  },
  place: {
    title: 'The paper asks at the centre of the pixel what hides, not at the point of the stripe.',
    draw: (board) => {
      for (let i = 0; i <= 3; i += 1) {
        board.path(`M${50 + i * 52} 10 V114`, 'grid');
      }
      for (let j = 0; j <= 2; j += 1) {
        board.path(`M50 ${10 + j * 52} H206`, 'grid');
      }
      board.path('M50 114 V70 L206 22 V114 Z', 'face');
      board.path('M50 70 L206 22', 'true');
      board.dot(128, 36, 'paperdot');
      board.dot(144, 52, 'ray');
      board.text(118, 30, 'centre: free', 'end');
      board.text(150, 66, 'point: hidden');
    },
  },
};

/**
 * The drawing of a switch; null if there is none.
 * @param {string} name
 */
export function sketchOf(name) {
  const sketch = SKETCHES[name];
  if (!sketch) {
    return null;
  }
  const board = new SketchBoard(sketch.title);
  sketch.draw(board);
  return board.root;
}
