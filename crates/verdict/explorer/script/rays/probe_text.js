// The text that `raypencil probe` prints, as blocks to read: the ray, the exact answer, each renderer.

import { element } from '../elements.js';

/** @typedef {{title: string, lines: string[]}} ProbeBlock */

/**
 * The blocks of a probe. A line with two blanks begins a block, deeper lines belong to it.
 * @param {string} text
 * @returns {ProbeBlock[]}
 */
function probeBlocks(text) {
  /** @type {ProbeBlock[]} */
  const blocks = [];
  for (const line of text.split('\n')) {
    const depth = line.length - line.trimStart().length;
    if (line.trim() === '' || depth === 0) {
      continue;
    }
    if (depth <= 2 || blocks.length === 0) {
      blocks.push({ title: line.trim(), lines: [] });
    } else {
      blocks[blocks.length - 1].lines.push(line.trim());
    }
  }
  return blocks.filter((block) => !block.title.startsWith('again:'));
}

/**
 * The command that prints such a text again; an empty text if it names none.
 * @param {string} text
 */
export function commandOf(text) {
  return /^ *again: (.*)$/m.exec(text)?.[1] ?? '';
}

/**
 * The blocks as elements. In a renderer's answer, digits that the exact answer has otherwise are marked.
 * @param {string} text
 */
export function probeElement(text) {
  const blocks = probeBlocks(text);
  const exact = blocks.find((block) => block.title.startsWith('exactly'));
  const root = element('div', { class: 'x-probe' });
  for (const block of blocks) {
    const isAnswer = exact && block !== exact && !block.title.startsWith('ray');
    const list = element('ul', {});
    for (const line of block.lines) {
      const like = isAnswer
        ? exact.lines.find((known) => shapeOfLine(known) === shapeOfLine(line))
        : undefined;
      list.append(element('li', {}, ...(like === undefined ? [line] : withMarkedDigits(line, like))));
    }
    root.append(element('section', {}, element('h4', {}, block.title), list));
  }
  return root;
}

const NUMBERS = /-?\d+(?:\.\d+)?(?:e-?\d+)?/g;

/** A line without its numbers. @param {string} line */
function shapeOfLine(line) {
  return line.replace(NUMBERS, '#');
}

/**
 * @param {string} line @param {string} like the same line of the exact answer
 * @returns {(Node|string)[]}
 */
function withMarkedDigits(line, like) {
  const known = like.match(NUMBERS) ?? [];
  /** @type {(Node|string)[]} */
  const parts = [];
  let end = 0;
  let index = 0;
  for (const match of line.matchAll(NUMBERS)) {
    const [number, other] = [match[0], known[index] ?? ''];
    index += 1;
    let same = 0;
    while (same < number.length && number[same] === other[same]) {
      same += 1;
    }
    if (number === other) {
      continue;
    }
    const from = match.index + (same === number.length ? 0 : same);
    parts.push(line.slice(end, from), element('mark', {}, line.slice(from, match.index + number.length)));
    end = match.index + number.length;
  }
  parts.push(line.slice(end));
  return parts;
}
