// The toolbar: quantity, sides, mode, scale and view.
//
// For tests: menus `[data-choose="channel"]`, `"a"`, `"b"`; buttons with aria-pressed `[data-mode="a"]`,
// `"b"`, `"difference"`, `"slider"`, `"blend"`, `"flip"`, and `[data-switch="robust"]`, `"log"`, `"marks"`,
// `"linked"`; buttons `[data-act="fit"]`, `"zoom-in"`, `"zoom-out"`, `"brighter"`, `"darker"`, `"help"`.

import { button, element, menu } from '../elements.js';
import { channelOf } from '../data/channels.js';
import { PICTURE_MODES, PLAIN_DRAWING } from '../state.js';

/** @typedef {import('../data/page_model.js').PageModel} PageModel */
/** @typedef {import('../state.js').State} State */
/** @typedef {import('../data/channels.js').Channel} Channel */
/**
 * @typedef {{zoom: (factor: number) => void, fit: () => void, help: () => void, isLog: () => boolean}}
 *   ToolActions
 */

export class Toolbar {
  /**
   * @param {PageModel} model
   * @param {State} state
   * @param {Channel[]} channels
   * @param {ToolActions} actions
   */
  constructor(model, state, channels, actions) {
    this.model = model;
    this.state = state;
    this.channels = channels;
    this.actions = actions;
    this.root = element('div', {
      class: 'x-toolbar',
      role: 'toolbar',
      'aria-label': 'What the pictures show',
    });
    this.words = element('p', { class: 'x-soft x-words' });
    this.build();
    this.update();
  }

  build() {
    const { state, model } = this;
    this.channelMenu = menu(
      'Quantity',
      this.channels.map(({ key, title }) => [key, title]),
      state.choice.channel,
      (channel) => state.set({ channel }),
    );
    this.channelMenu.dataset.choose = 'channel';
    const groups = [group('quantity', this.channelMenu)];
    if (model.sides.length > 1) {
      const names = model.sides.map(
        (side, index) => /** @type {[string, string]} */ ([String(index), side.name]),
      );
      this.menuA = menu('Side A', names, String(state.choice.a), (index) => state.set({ a: Number(index) }));
      this.menuB = menu('Side B', names, String(state.choice.b), (index) => state.set({ b: Number(index) }));
      this.menuA.dataset.choose = 'a';
      this.menuB.dataset.choose = 'b';
      groups.push(
        group('sides', element('label', {}, 'A ', this.menuA), element('label', {}, 'B ', this.menuB)),
      );
      this.modeButtons = PICTURE_MODES.map(([mode, label, words], index) =>
        button(label, () => this.chooseMode(mode), {
          'data-mode': mode,
          title: `${words} Key ${mode === 'flip' ? 'f' : index + 1}.`,
        }),
      );
      this.opacity = element('input', {
        type: 'range',
        min: 0,
        max: 1,
        step: 0.05,
        'aria-label': 'Opacity of B',
      });
      this.opacity.addEventListener('input', () => state.set({ opacity: Number(this.opacity?.value) }));
      groups.push(group('mode', element('span', { class: 'x-joined' }, ...this.modeButtons), this.opacity));
    }
    this.robust = switchButton(
      'robust limits',
      'robust',
      () => state.set({ isRobust: !state.choice.isRobust }),
      'The scale ends at the 1st and the 99th percentile, so that a few outliers do not take all colours.',
    );
    this.log = switchButton('log', 'log', () => this.toggleLog(), 'Even steps of the logarithm. Key l.');
    this.exposure = element('output', { 'aria-label': 'Exposure, stops' });
    groups.push(
      group(
        'scale',
        this.robust,
        this.log,
        element(
          'span',
          { class: 'x-joined' },
          act('−', 'darker', 'Darker by half a stop', () => this.expose(-0.5)),
          this.exposure,
          act('+', 'brighter', 'Brighter by half a stop', () => this.expose(0.5)),
        ),
      ),
    );
    this.marks = switchButton(
      'marks',
      'marks',
      () => state.set({ showsMarks: !state.choice.showsMarks }),
      'Marks on the rays that the table shows. Key m.',
    );
    this.linked = switchButton(
      'linked',
      'linked',
      () => state.set({ isLinked: !state.choice.isLinked }),
      'Sensors of the same size show the same part.',
    );
    groups.push(
      group(
        'view',
        element(
          'span',
          { class: 'x-joined' },
          act('−', 'zoom-out', 'Smaller', () => this.actions.zoom(1 / 1.5)),
          act('fit', 'fit', 'Fit everything in. Key 0.', this.actions.fit),
          act('+', 'zoom-in', 'Larger', () => this.actions.zoom(1.5)),
        ),
        this.marks,
        this.linked,
        act('?', 'help', 'Keys and help', this.actions.help),
      ),
    );
    this.root.append(...groups);
  }

  /** @param {import('../state.js').PictureMode} mode */
  chooseMode(mode) {
    const calm = window.matchMedia('(prefers-reduced-motion: reduce)').matches;
    const { choice } = this.state;
    // With little motion wanted, each press of the button shows the other side.
    if (mode === 'flip' && calm) {
      this.state.set({
        mode,
        flipShowsB: choice.mode === 'flip' ? !choice.flipShowsB : true,
        flipRuns: false,
      });
    } else {
      this.state.set({ mode, flipRuns: mode === 'flip' && !(choice.mode === 'flip' && choice.flipRuns) });
    }
  }

  toggleLog() {
    const isLog = !this.actions.isLog();
    this.state.set(
      this.state.choice.mode === 'difference' ? { isLogOfDifferences: isLog } : { isLogOfValues: isLog },
    );
  }

  /** @param {number} stops */
  expose(stops) {
    this.state.set({ exposure: Math.max(-20, Math.min(40, this.state.choice.exposure + stops)) });
  }

  reset() {
    this.state.set({ ...PLAIN_DRAWING });
  }

  update() {
    const { choice } = this.state;
    if (this.channelMenu) {
      this.channelMenu.value = choice.channel;
    }
    if (this.menuA && this.menuB) {
      this.menuA.value = String(choice.a);
      this.menuB.value = String(choice.b);
    }
    const channel = channelOf(this.model, choice.channel);
    for (const made of this.modeButtons ?? []) {
      made.setAttribute('aria-pressed', String(made.dataset.mode === choice.mode));
      made.disabled = channel?.belongs !== 'side';
    }
    if (this.opacity) {
      this.opacity.hidden = choice.mode !== 'blend';
      this.opacity.value = String(choice.opacity);
    }
    this.log?.setAttribute('aria-pressed', String(this.actions.isLog()));
    this.robust?.setAttribute('aria-pressed', String(choice.isRobust));
    this.marks?.setAttribute('aria-pressed', String(choice.showsMarks));
    this.linked?.setAttribute('aria-pressed', String(choice.isLinked));
    if (this.exposure) {
      this.exposure.textContent = `${choice.exposure > 0 ? '+' : ''}${choice.exposure} EV`.replace('-', '−');
    }
    this.words.textContent = channel?.words ?? '';
  }
}

/** @param {string} name @param {...(Node|string)} children */
function group(name, ...children) {
  return element('div', { class: 'x-group', role: 'group', 'aria-label': name }, ...children);
}

/** @param {string} label @param {string} name @param {() => void} action @param {string} title */
function switchButton(label, name, action, title) {
  return button(label, action, { 'data-switch': name, title, 'aria-pressed': 'false' });
}

/** @param {string} label @param {string} name @param {string} title @param {() => void} action */
function act(label, name, title, action) {
  return button(label, action, { 'data-act': name, title, 'aria-label': title });
}
