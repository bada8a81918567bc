// The 3-D view, made only when somebody asks for it. If it fails, a message stands in its place.

import { element } from '../elements.js';
import { View3d } from '../view3d/view3d.js';

/** @typedef {import('../data/page_data.js').PageData} PageData */
/** @typedef {import('../data/page_model.js').DescribedRay} DescribedRay */

export class Geometry {
  /** @param {PageData} data */
  constructor(data) {
    this.data = data;
    /** @type {any} */
    this.view = null;
    this.hasFailed = false;
    this.host = element('div', { class: 'x-geometry', 'data-geometry': true });
    this.root = element(
      'details',
      { class: 'x-geometry-box' },
      element('summary', {}, 'Geometry: terrain, rig and rays in 3-D'),
      this.host,
    );
    this.root.addEventListener('toggle', () => {
      if (this.root.open) {
        this.open();
      }
    });
  }

  open() {
    this.root.open = true;
    if (this.view || this.hasFailed) {
      return;
    }
    try {
      const { data } = this;
      const scene = {
        model: data.model,
        /** @param {import('../data/container.js').ArrayReference} reference */
        decode: (reference) => data.container.decode(reference),
        /** @param {number} sensor @param {number} cell */
        ray: (sensor, cell) => data.ray(sensor, cell),
        /** @param {number} sensor @param {number} side @param {string} channel @param {number} cell */
        valueAt: (sensor, side, channel, cell) => data.value(sensor, side, channel, cell),
      };
      this.view = new View3d(this.host, /** @type {any} */ (scene), {});
      // For tests: where a point of the scene is in the picture.
      Object.assign(this.host, { view3d: this.view });
    } catch (error) {
      this.fail(error);
    }
  }

  /** @param {{sensor: number, cell: number, pair: number|null, ray: DescribedRay|null}} asked */
  async showRay(asked) {
    this.open();
    try {
      await this.view?.showRay(asked);
    } catch (error) {
      this.fail(error);
    }
  }

  /** @param {unknown} error */
  fail(error) {
    this.hasFailed = true;
    this.view = null;
    this.host.replaceChildren(
      element(
        'p',
        { class: 'x-message' },
        `This browser cannot draw the geometry: ${error instanceof Error ? error.message : error}.`,
      ),
    );
  }
}
