// The elements of the 3-D panel: buttons of views, switches, canvas, key of colours, caption.

import { button, checkbox, element, menu } from '../elements.js';
import { gradientOf } from '../panel/colour.js';
import { TURN_HELP, pictureFrame } from './frame_elements.js';
import { cssOfColour, colourOfMaterial } from './theme.js';
import { digitsOf } from './words.js';

/** @typedef {import('./theme.js').ColourName} ColourName */
/** @typedef {import('./theme.js').Rgb3} Rgb3 */
/** @typedef {import('./view3d.js').PageModel3d} PageModel3d */
/** @typedef {'material' | 'elevation' | 'slope' | 'face'} TerrainColour */
/** @typedef {'rig' | 'sheets' | 'grid' | 'axes' | 'wireframe' | 'light'} ShowName */
/** @typedef {{view: (name: string) => void, change: () => void}} PanelActions */

const SHOW_WORDS = /** @type {const} */ ([
  ['rig', 'Rig', true],
  ['sheets', 'Sheets of light', true],
  ['grid', 'Grid on the ground', true],
  ['axes', 'Axes', true],
  ['wireframe', 'Faces near the ray', false],
  ['light', 'Path of light only', false],
]);
/** From so many beams on, they are chosen from a list. */
const BEAMS_AS_LIST = 4;

/** @type {[TerrainColour, string][]} */
const GROUND_COLOURS = [
  ['material', 'material'],
  ['elevation', 'elevation'],
  ['slope', 'slope'],
  ['face', 'face'],
];

const PANEL_HELP =
  `${TURN_HELP} Wheel or two fingers: zoom. Double click: turn about that place. Keys, after a click on the ` +
  'picture: arrows turn, Shift and arrows move, + and − zoom, Home goes back.';

/** The panel in the page. */
export class ViewPanel {
  /** @param {HTMLElement} host @param {PageModel3d} model @param {PanelActions} actions */
  constructor(host, model, actions) {
    this.actions = actions;
    /** @type {Record<ShowName, HTMLInputElement>} */
    this.shows = /** @type {any} */ ({});
    this.colourChoice = menu('ground by', GROUND_COLOURS, 'material', () => actions.change());
    this.colourChoice.dataset.colour = '';
    const frame = pictureFrame(
      'The scene in three dimensions. The text below says what is seen.',
      'The terrain is being read.',
    );
    this.canvas = frame.canvas;
    this.message = frame.message;
    this.stage = frame.stage;
    this.key = element('div', { class: 'view3d-key' });
    this.caption = element('div', { class: 'view3d-caption', 'aria-live': 'polite' });
    this.notes = element('p', { class: 'view3d-notes soft' });
    this.root = element(
      'div',
      { class: 'view3d', 'data-state': 'loading' },
      this.#views(model),
      this.#switches(),
      this.stage,
      this.key,
      this.caption,
      this.notes,
      element('p', { class: 'view3d-help soft' }, PANEL_HELP),
    );
    host.append(this.root);
  }

  /** @param {PageModel3d} model */
  #views(model) {
    /** @param {string} name @param {string} words @param {string} title */
    const view = (name, words, title) =>
      button(words, () => this.actions.view(name), { 'data-view': name, title, 'aria-pressed': 'false' });
    const beams = model.sensors.filter((sensor) => sensor.kind === 'beam');
    const hasCamera = model.sensors.some((sensor) => sensor.camera);
    const ofCamera = view('camera', 'From the camera', 'The perspective of the camera image');
    return element(
      'div',
      { class: 'view3d-bar', role: 'toolbar', 'aria-label': 'Views' },
      element('span', { class: 'view3d-word' }, 'View'),
      view('overview', 'Overview', 'Rig, ray and ground'),
      view('top', 'Top', 'From above, forward is up'),
      ...(hasCamera ? [ofCamera] : []),
      ...(beams.length < BEAMS_AS_LIST
        ? beams.map(({ name }) => view(name, `From ${name}`, 'From the middle of the laser'))
        : [this.#beamList(beams.map(({ name }) => name))]),
      view('ray', 'Along the ray', 'Along the chosen ray, shortly before its hit'),
      view('close', 'Close up', 'The hit, as large as the distance between different hits'),
    );
  }

  /** @param {string[]} names */
  #beamList(names) {
    /** @type {[string, string][]} */
    const entries = [['', 'From a beam'], ...names.map((name) => /** @type {[string, string]} */ ([name, `From ${name}`]))];
    const list = menu('From a beam', entries, '', (name) => {
      if (name) this.actions.view(name);
    });
    list.dataset.beams = '';
    return list;
  }

  #switches() {
    const boxes = SHOW_WORDS.map(([name, words, isOn]) => {
      const { input, label } = checkbox(words, isOn, () => this.actions.change(), { 'data-show': name });
      this.shows[name] = input;
      return label;
    });
    return element(
      'div',
      { class: 'view3d-bar', role: 'group', 'aria-label': 'What is shown' },
      element('label', {}, 'Ground by ', this.colourChoice),
      ...boxes,
    );
  }

  /** @param {ShowName} name */
  isShown(name) {
    return this.shows[name].checked;
  }

  /** @returns {TerrainColour} */
  get terrainColour() {
    return /** @type {TerrainColour} */ (this.colourChoice.value);
  }

  /** Marks the button of the view that is shown; '' for none. @param {string} name */
  setView(name) {
    this.root.dataset.view = name;
    const list = this.root.querySelector('select[data-beams]');
    if (list instanceof HTMLSelectElement) {
      list.value = name;
      if (list.selectedIndex < 0) list.value = '';
    }
    for (const button of this.root.querySelectorAll('button[data-view]')) {
      button.setAttribute(
        'aria-pressed',
        String(button instanceof HTMLElement && button.dataset.view === name),
      );
    }
  }

  /** Buttons that need a chosen ray. @param {boolean} hasRay */
  setHasRay(hasRay) {
    for (const name of ['ray', 'close']) {
      const button = this.root.querySelector(`button[data-view="${name}"]`);
      if (button instanceof HTMLButtonElement) button.disabled = !hasRay;
    }
    this.shows.wireframe.disabled = !hasRay;
    this.shows.light.disabled = !hasRay;
  }

  /** A message over the picture; '' for none. @param {string} text */
  setMessage(text) {
    this.message.textContent = text;
    this.message.hidden = text === '';
  }

  /** @param {string[]} sentences */
  setCaption(sentences) {
    this.caption.replaceChildren(
      ...sentences.map((text, k) => element('p', { class: k === 0 ? 'view3d-name' : null }, text)),
    );
    const start = 'The scene in three dimensions. ';
    this.canvas.setAttribute(
      'aria-label',
      start + (sentences.length > 0 ? sentences.join(' ') : 'No ray is chosen.'),
    );
  }

  /**
   * The key of lines and of the ground's colours.
   * @param {Record<ColourName, Rgb3>} colours
   * @param {import('./key.js').KeyLine[]} lines
   * @param {PageModel3d} model
   * @param {number[] | null} heights lowest and highest ground, metres
   */
  setKey(colours, lines, model, heights) {
    /** @param {string} look of the sample @param {string} colour */
    const sample = (look, colour) => element('i', { class: look, style: `--sample: ${colour}` });
    /** @param {...(Node|string)} children */
    const entry = (...children) => element('span', { class: 'view3d-entry' }, ...children);
    const parts = lines.map(({ name, text, look }) => entry(sample(look, cssOfColour(colours[name])), text));
    const by = this.terrainColour;
    if (by === 'material') {
      model.mesh.material_names.slice(0, 6).forEach((text, material) => {
        const block = sample('block', cssOfColour(colourOfMaterial(colours, material)));
        parts.push(entry(block, text === '' ? `material ${material}` : text));
      });
    } else if (by === 'face') {
      parts.push(entry('Neighbouring faces have different colours.'));
    } else if (heights) {
      const [low, high] =
        by === 'slope' ? ['level', 'upright'] : heights.map((height) => `${digitsOf(height, 4)} m`);
      parts.push(entry(low, sample('ramp', gradientOf('viridis')), high));
    }
    this.key.replaceChildren(...parts);
  }
}
