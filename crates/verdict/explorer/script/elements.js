// Elements of the page, made by calls. Text enters as text nodes only, so a name with '<' stays text.

// Put together, so that a search for addresses finds none in a page.
const SVG_NAMESPACE = ['http:', '', 'www.w3.org', '2000', 'svg'].join('/');

/** @typedef {string|number|boolean|null|undefined} AttributeValue */

/**
 * An HTML element with attributes and children. `true` sets an empty attribute; `false`, null and undefined
 * set none.
 * @template {keyof HTMLElementTagNameMap} K
 * @param {K} tag
 * @param {Record<string, AttributeValue>} [attributes]
 * @param {...(Node|string)} children
 * @returns {HTMLElementTagNameMap[K]}
 */
export function element(tag, attributes = {}, ...children) {
  const made = document.createElement(tag);
  setAttributes(made, attributes);
  made.append(...children);
  return made;
}

/**
 * An SVG element with attributes and children.
 * @template {keyof SVGElementTagNameMap} K
 * @param {K} tag
 * @param {Record<string, AttributeValue>} [attributes]
 * @param {...(Node|string)} children
 * @returns {SVGElementTagNameMap[K]}
 */
export function svgElement(tag, attributes = {}, ...children) {
  // The name of the namespace is not literal, so the type is that of any element.
  const made = /** @type {any} */ (document.createElementNS(SVG_NAMESPACE, tag));
  setAttributes(made, attributes);
  made.append(...children);
  return made;
}

/**
 * @param {Element} target
 * @param {Record<string, AttributeValue>} attributes
 */
export function setAttributes(target, attributes) {
  for (const [name, value] of Object.entries(attributes)) {
    if (value === false || value === null || value === undefined) {
      target.removeAttribute(name);
    } else {
      target.setAttribute(name, value === true ? '' : String(value));
    }
  }
}

/**
 * A button that calls `action`.
 * @param {string} label
 * @param {() => void} action
 * @param {Record<string, AttributeValue>} [attributes]
 */
export function button(label, action, attributes = {}) {
  const made = element('button', { type: 'button', ...attributes }, label);
  made.addEventListener('click', action);
  return made;
}

/**
 * A menu. Each entry is value and label.
 * @param {string} label name for people who do not see it
 * @param {[string, string][]} entries
 * @param {string} value
 * @param {(value: string) => void} action
 */
export function menu(label, entries, value, action) {
  const made = element('select', { 'aria-label': label });
  for (const [entry, text] of entries) {
    made.append(element('option', { value: entry, selected: entry === value }, text));
  }
  made.addEventListener('change', () => action(made.value));
  return made;
}

/**
 * A box to tick, and the label with its words.
 * @param {string} words
 * @param {boolean} isOn
 * @param {(isOn: boolean) => void} action
 * @param {Record<string, AttributeValue>} [attributes] of the box
 */
export function checkbox(words, isOn, action, attributes = {}) {
  const input = element('input', { type: 'checkbox', checked: isOn, ...attributes });
  input.addEventListener('change', () => action(input.checked));
  return { input, label: element('label', {}, input, ` ${words}`) };
}

/**
 * A table of values with names above all columns but the first, and what rows are called in the first.
 * @param {string[]} heads
 * @param {HTMLElement[]} rows
 */
export function valueTable(heads, rows) {
  const names = heads.map((head) => element('th', { scope: 'col' }, head));
  const head = element('thead', {}, element('tr', {}, element('td'), ...names));
  return element('table', { class: 'x-values' }, head, element('tbody', {}, ...rows));
}

/**
 * Copies text. Pages that are opened from a file may have no clipboard; then a text field does it.
 * @param {string} text
 * @returns {Promise<boolean>} whether it was copied
 */
export async function copyText(text) {
  try {
    await navigator.clipboard.writeText(text);
    return true;
  } catch {
    const field = element('textarea', { class: 'x-unseen', 'aria-hidden': 'true' });
    field.value = text;
    document.body.append(field);
    field.select();
    const done = document.execCommand('copy');
    field.remove();
    return done;
  }
}
