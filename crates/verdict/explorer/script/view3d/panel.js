// The elements of the 3-D panel: buttons of views, switches, canvas, key of colours, caption.

import { gradientOf } from '../panel/colour.js';
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

/**
 * @template {keyof HTMLElementTagNameMap} K
 * @param {K} tag
 * @param {string} className
 * @param {string} [text]
 * @returns {HTMLElementTagNameMap[K]}
 */
function panelElement(tag, className, text) {
  const element = document.createElement(tag);
  if (className) element.className = className;
  if (text !== undefined) element.textContent = text;
  return element;
}

/** The panel in the page. */
export class ViewPanel {
  /** @param {HTMLElement} host @param {PageModel3d} model @param {PanelActions} actions */
  constructor(host, model, actions) {
    this.root = panelElement('div', 'view3d');
    this.root.dataset.state = 'loading';
    this.actions = actions;
    /** @type {Record<ShowName, HTMLInputElement>} */
    this.shows = /** @type {any} */ ({});
    this.colourChoice = panelElement('select', '');
    this.root.append(this.#views(model), this.#switches());
    this.stage = panelElement('div', 'view3d-stage');
    this.canvas = panelElement('canvas', 'view3d-canvas');
    this.canvas.tabIndex = 0;
    this.canvas.setAttribute('role', 'img');
    this.canvas.setAttribute(
      'aria-label',
      'The scene in three dimensions. The text below says what is seen.',
    );
    this.canvas.setAttribute('aria-keyshortcuts', 'ArrowLeft ArrowRight ArrowUp ArrowDown + - Home');
    this.overlay = panelElement('canvas', 'view3d-overlay');
    this.overlay.setAttribute('aria-hidden', 'true');
    this.labels = panelElement('div', 'view3d-labels');
    this.labels.setAttribute('aria-hidden', 'true');
    this.message = panelElement('p', 'view3d-message', 'The terrain is being read.');
    this.message.setAttribute('role', 'status');
    this.stage.append(this.canvas, this.overlay, this.labels, this.message);
    this.key = panelElement('div', 'view3d-key');
    this.caption = panelElement('div', 'view3d-caption');
    this.caption.setAttribute('aria-live', 'polite');
    this.notes = panelElement('p', 'view3d-notes soft');
    this.root.append(
      this.stage,
      this.key,
      this.caption,
      this.notes,
      panelElement(
        'p',
        'view3d-help soft',
        'Drag: turn. Shift or right button, or two fingers: move. Wheel or two fingers: zoom. Double click: ' +
          'turn about that place. Keys, after a click on the picture: arrows turn, Shift and arrows move, ' +
          '+ and − zoom, Home goes back.',
      ),
    );
    host.append(this.root);
  }

  /** @param {PageModel3d} model */
  #views(model) {
    const bar = panelElement('div', 'view3d-bar');
    bar.setAttribute('role', 'toolbar');
    bar.setAttribute('aria-label', 'Views');
    bar.append(panelElement('span', 'view3d-word', 'View'));
    /** @param {string} name @param {string} text @param {string} title */
    const button = (name, text, title) => {
      const element = panelElement('button', '', text);
      element.type = 'button';
      element.dataset.view = name;
      element.title = title;
      element.setAttribute('aria-pressed', 'false');
      element.addEventListener('click', () => this.actions.view(name));
      bar.append(element);
    };
    button('overview', 'Overview', 'Rig, ray and ground');
    button('top', 'Top', 'From above, forward is up');
    if (model.sensors.some((sensor) => sensor.camera))
      button('camera', 'From the camera', 'The perspective of the camera image');
    const beams = model.sensors.filter((sensor) => sensor.kind === 'beam');
    if (beams.length < BEAMS_AS_LIST) {
      for (const beam of beams) button(beam.name, `From ${beam.name}`, 'From the middle of the laser');
    } else {
      const list = panelElement('select', '');
      list.dataset.beams = '';
      list.setAttribute('aria-label', 'From a beam');
      list.append(
        new Option('From a beam', ''),
        ...beams.map((beam) => new Option(`From ${beam.name}`, beam.name)),
      );
      list.addEventListener('change', () => {
        if (list.value) this.actions.view(list.value);
      });
      bar.append(list);
    }
    button('ray', 'Along the ray', 'Along the chosen ray, shortly before its hit');
    button('close', 'Close up', 'The hit, as large as the distance between different hits');
    return bar;
  }

  #switches() {
    const bar = panelElement('div', 'view3d-bar');
    bar.setAttribute('role', 'group');
    bar.setAttribute('aria-label', 'What is shown');
    const label = panelElement('label', '', 'Ground by ');
    const words = /** @type {const} */ ([
      ['material', 'material'],
      ['elevation', 'elevation'],
      ['slope', 'slope'],
      ['face', 'face'],
    ]);
    for (const [value, text] of words) this.colourChoice.append(new Option(text, value));
    this.colourChoice.dataset.colour = '';
    this.colourChoice.addEventListener('change', () => this.actions.change());
    label.append(this.colourChoice);
    bar.append(label);
    for (const [name, text, isOn] of SHOW_WORDS) {
      const choice = panelElement('label', '');
      const input = panelElement('input', '');
      input.type = 'checkbox';
      input.checked = isOn;
      input.dataset.show = name;
      input.addEventListener('change', () => this.actions.change());
      this.shows[name] = input;
      choice.append(input, ` ${text}`);
      bar.append(choice);
    }
    return bar;
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
      ...sentences.map((text, k) => panelElement('p', k === 0 ? 'view3d-name' : '', text)),
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
    const parts = lines.map(({ name, text, look }) => {
      const entry = panelElement('span', 'view3d-entry');
      const sample = panelElement('i', look);
      sample.style.setProperty('--sample', cssOfColour(colours[name]));
      entry.append(sample, text);
      return entry;
    });
    const by = this.terrainColour;
    if (by === 'material') {
      model.mesh.material_names.slice(0, 6).forEach((text, material) => {
        const entry = panelElement('span', 'view3d-entry');
        const sample = panelElement('i', 'block');
        sample.style.setProperty('--sample', cssOfColour(colourOfMaterial(colours, material)));
        entry.append(sample, text === '' ? `material ${material}` : text);
        parts.push(entry);
      });
    } else if (by === 'face') {
      parts.push(panelElement('span', 'view3d-entry', 'Neighbouring faces have different colours.'));
    } else if (heights) {
      const [low, high] =
        by === 'slope' ? ['level', 'upright'] : heights.map((height) => `${digitsOf(height, 4)} m`);
      const entry = panelElement('span', 'view3d-entry');
      const sample = panelElement('i', 'ramp');
      sample.style.setProperty('--sample', gradientOf('viridis'));
      entry.append(low, sample, high);
      parts.push(entry);
    }
    this.key.replaceChildren(...parts);
  }
}
