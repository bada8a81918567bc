// Keys, as viewers of images in this field have them, and the dialog that lists them.

import { button, element } from './elements.js';

/** @typedef {{keys: string[], words: string, run: (event: KeyboardEvent) => void}} KeyEntry */

/** Names of keys that people know otherwise. @type {Record<string, string>} */
const KEY_NAMES = {
  ArrowLeft: '←',
  ArrowRight: '→',
  ArrowUp: '↑',
  ArrowDown: '↓',
  Escape: 'Esc',
  PageUp: 'Page up',
  PageDown: 'Page down',
  ' ': 'Space',
};

export class Keyboard {
  /**
   * @param {HTMLElement} root keys count while the focus is in it, or nowhere and the pointer is over it
   * @param {KeyEntry[]} entries
   */
  constructor(root, entries) {
    this.root = root;
    this.entries = entries;
    document.addEventListener('keydown', (event) => this.press(event));
  }

  /** @param {KeyboardEvent} event */
  press(event) {
    const target = /** @type {Element|null} */ (document.activeElement);
    const isInside = target && this.root.contains(target);
    const isNowhere = !target || target === document.body;
    if (
      event.ctrlKey ||
      event.metaKey ||
      event.altKey ||
      event.defaultPrevented ||
      document.querySelector('dialog[open]')
    ) {
      return;
    }
    if (!isInside && !(isNowhere && this.root.matches(':hover'))) {
      return;
    }
    // Fields, menus and the 3-D view have keys of their own.
    if (target?.closest('input, select, textarea, [data-geometry]')) {
      return;
    }
    if (event.key.startsWith('Arrow') && !target?.matches('canvas.x-canvas') && !isNowhere) {
      return;
    }
    const entry = this.entries.find(({ keys }) => keys.includes(event.key));
    if (entry) {
      event.preventDefault();
      entry.run(event);
    }
  }
}

/**
 * The dialog that lists keys.
 * @param {string} title @param {string} words what the mouse does @param {{keys: string[], words: string}[]} entries
 */
export function helpDialog(title, words, entries) {
  const rows = entries.map(({ keys, words: action }) =>
    element(
      'tr',
      {},
      element(
        'th',
        { scope: 'row' },
        ...keys.flatMap((key, k) => [...(k > 0 ? [' '] : []), element('kbd', {}, KEY_NAMES[key] ?? key)]),
      ),
      element('td', {}, action),
    ),
  );
  const dialog = element(
    'dialog',
    { class: 'x-help', 'aria-labelledby': 'x-help-title' },
    element('h3', { id: 'x-help-title' }, title),
    element('p', {}, words),
    element('table', {}, element('tbody', {}, ...rows)),
  );
  dialog.append(button('Close', () => dialog.close(), { class: 'x-close' }));
  dialog.addEventListener('click', (event) => {
    if (event.target === dialog) {
      dialog.close();
    }
  });
  return dialog;
}
