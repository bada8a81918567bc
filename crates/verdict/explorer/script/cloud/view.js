// The points of a scan in 3-D on the mesh, in the colours of the map above: by range, ring, time, margin, class.
//
// For tests: `[data-cloud-3d]` has `data-state` (waiting, ready, failed), `data-points` (points drawn) and
// `data-frames` (pictures drawn).

import { button, checkbox, element, menu } from '../elements.js';
import { TURN_HELP, pictureFrame } from '../view3d/frame_elements.js';
import { Terrain } from '../view3d/terrain.js';
import { ViewCamera, orbitPose } from '../view3d/camera.js';
import { ViewControls } from '../view3d/controls.js';
import { coloursOfFaces, rampColours, readTheme } from '../view3d/theme.js';
import { lookOfFaces } from '../gl/mesh.js';
import { oncePerFrame } from '../frame.js';
import { CloudStage } from './stage.js';
import { fillLegend } from '../panel/legend.js';
import { counted } from '../data/numbers.js';
import { Viewport } from '../panel/viewport.js';

/** @typedef {import('../data/page_data.js').PageData} PageData */
/** @typedef {import('../panel/painter.js').Painter} Painter */
/** @typedef {import('../state.js').State} State */
/** @typedef {import('../data/channels.js').Channel} Channel */
/** @typedef {import('../view3d/vector.js').Point3} Point3 */
/** @typedef {import('../view3d/terrain.js').Bounds3} Bounds3 */
/** @typedef {import('../data/page_model.js').SolidModel} SolidModel */

/** Device pixels in a CSS pixel, at most. */
const CLOUD_PIXELS = 2;

/** Sizes of points, CSS pixels. */
const POINT_SIZES = [1, 2, 3, 5];

/** Colour of points whose cell has none, as of a difference where only one side has a point. */
const BARE_POINT = 0xffe600ff;

const CLOUD_HELP =
  `${TURN_HELP} Wheel: zoom. The points have the colours of the map above, ` +
  'also by its limits: choose there or here what they show. They are those of A; of B if B alone is shown.';

export class CloudView {
  /**
   * @param {PageData} data @param {State} state @param {Painter} painter @param {SolidModel} solid
   * @param {{channels: Channel[], settings: (of: 'a'|'b'|'difference'|'common') => import('../data/limits.js').ScaleSettings}} host
   */
  constructor(data, state, painter, solid, host) {
    this.data = data;
    this.state = state;
    this.painter = painter;
    this.solid = solid;
    this.host = host;
    this.camera = new ViewCamera();
    /** @type {CloudStage|null} */
    this.stage = null;
    /** @type {Terrain|null} */
    this.terrain = null;
    /** @type {Bounds3|null} */
    this.ofPoints = null;
    this.isSeen = false;
    this.ask = oncePerFrame(() => this.draw());
    this.isStarting = false;
    this.showsMesh = true;
    this.size = 2;
    this.ticket = 0;
    this.frames = 0;
    const frame = pictureFrame(
      'The points in three dimensions. Arrow keys turn, with Shift they move, + and − zoom, Home shows all.',
      'The points are being read.',
    );
    this.canvas = frame.canvas;
    this.message = frame.message;
    this.box = frame.stage;
    const showMesh = (/** @type {boolean} */ isShown) => {
      this.showsMesh = isShown;
      this.ask();
    };
    const mesh = checkbox('mesh', true, showMesh, { 'data-cloud-mesh': true });
    /** @type {[string, string][]} */
    const channels = host.channels.map(({ key, title }) => [key, title]);
    this.chooser = menu('what the colours of the points show', channels, state.choice.channel, (channel) =>
      state.set({ channel }),
    );
    /** @type {[string, string][]} */
    const sizes = POINT_SIZES.map((size) => [String(size), `points of ${size} px`]);
    const size = menu('size of the points', sizes, String(this.size), (value) => {
      this.size = Number(value);
      this.ask();
    });
    this.legend = element('div', { class: 'x-legend' });
    this.words = element('p', { class: 'view3d-help x-soft' });
    this.root = element(
      'section',
      { class: 'view3d cloud-3d', 'data-cloud-3d': true, 'data-state': 'waiting' },
      element('h2', {}, 'Points in 3-D'),
      element(
        'div',
        { class: 'view3d-bar', role: 'toolbar', 'aria-label': 'Views' },
        this.chooser,
        button('all', () => this.goTo('all'), { 'data-cloud-view': 'all' }),
        button('from above', () => this.goTo('top'), { 'data-cloud-view': 'top' }),
        mesh.label,
        size,
      ),
      this.box,
      this.legend,
      this.words,
      element('p', { class: 'view3d-help x-soft' }, CLOUD_HELP),
    );
    new ViewControls(this.canvas, this.camera, {
      setPose: (pose) => this.setPose(pose),
      bounds: () => this.bounds,
      reset: () => this.goTo('all'),
      centre: () => {},
    });
    new ResizeObserver(() => this.ask()).observe(this.box);
    new IntersectionObserver(
      (entries) => {
        this.isSeen = entries.some((entry) => entry.isIntersecting);
        if (this.isSeen) {
          this.start();
        }
      },
      { rootMargin: '100px' },
    ).observe(this.box);
    window.matchMedia('(prefers-color-scheme: dark)').addEventListener('change', () => this.ask());
  }

  /** A point of the mesh's frame in the picture's: to the right, up the page, upward. @param {Point3} point */
  placed([x, y, z]) {
    const { origin, axes } = this.solid;
    const [dx, dy, dz] = [x - origin[0], y - origin[1], z - origin[2]];
    return /** @type {Point3} */ (axes.map((axis) => axis[0] * dx + axis[1] * dy + axis[2] * dz));
  }

  /** Makes the picture when it is first seen. */
  async start() {
    if (this.stage || this.isStarting || this.root.dataset.state === 'failed') {
      this.ask();
      return;
    }
    this.isStarting = true;
    try {
      const { container } = this.data;
      const [vertices, faces] = await Promise.all([
        container.decode(this.solid.vertices),
        container.decode(this.solid.faces),
      ]);
      const { axes } = this.solid;
      const turned = new Float32Array(vertices.length);
      for (let at = 0; at + 2 < vertices.length; at += 3) {
        for (let k = 0; k < 3; k += 1) {
          turned[at + k] =
            axes[k][0] * vertices[at] + axes[k][1] * vertices[at + 1] + axes[k][2] * vertices[at + 2];
        }
      }
      this.terrain = new Terrain(turned, /** @type {Uint32Array} */ (faces), new Uint16Array(0));
      this.stage = new CloudStage(this.canvas, (isLost) => {
        this.message.textContent = 'The graphics processor is gone. The picture comes back by itself.';
        this.message.hidden = !isLost;
        this.ask();
      });
      const { colours } = readTheme(this.root);
      this.stage.setTerrain(this.terrain, rampColours(), coloursOfFaces(this.terrain, 'material', colours));
      await this.refresh();
      this.message.hidden = true;
      this.root.dataset.state = 'ready';
      this.goTo('all');
    } catch (error) {
      this.stage = null;
      this.root.dataset.state = 'failed';
      this.message.textContent = `There is no 3-D picture: ${error instanceof Error ? error.message : error}.`;
      this.message.hidden = false;
    }
  }

  /** Which picture of the maps has the colours. @param {Channel} channel @returns {'a'|'b'|'difference'|'common'} */
  layerOf(channel) {
    if (channel.belongs !== 'side') {
      return 'common';
    }
    const { mode } = this.state.choice;
    return mode === 'b' || mode === 'difference' ? mode : 'a';
  }

  /** The points, with the colours of what is chosen. */
  async refresh() {
    const { data, state, host, stage } = this;
    const { choice } = state;
    if (!stage) {
      return;
    }
    this.ticket += 1;
    const ticket = this.ticket;
    this.chooser.value = choice.channel;
    const channel = host.channels.find(({ key }) => key === choice.channel) ?? host.channels[0];
    const of = this.layerOf(channel);
    const side = of === 'b' ? choice.b : choice.a;
    const sides = { a: choice.a, b: choice.b };
    const [layer, ...axes] = await Promise.all([
      this.painter.layer(0, sides, of, channel, host.settings(of)),
      ...['P.X', 'P.Y', 'P.Z'].map((key) => data.raster(0, side, key)),
    ]);
    const [x, y, z] = axes;
    if (ticket !== this.ticket) {
      return;
    }
    const count = x && y && z ? x.length : 0;
    const positions = new Float32Array(3 * count);
    const colours = new Uint32Array(count);
    const low = /** @type {Point3} */ ([Infinity, Infinity, Infinity]);
    const high = /** @type {Point3} */ ([-Infinity, -Infinity, -Infinity]);
    let points = 0;
    for (let cell = 0; cell < count; cell += 1) {
      if (!x || !y || !z || !(Number.isFinite(x[cell]) && Number.isFinite(y[cell]) && Number.isFinite(z[cell]))) {
        continue;
      }
      const point = this.placed([x[cell], y[cell], z[cell]]);
      for (let k = 0; k < 3; k += 1) {
        positions[3 * points + k] = point[k];
        low[k] = Math.min(low[k], point[k]);
        high[k] = Math.max(high[k], point[k]);
      }
      colours[points] = layer?.pixels[cell] || BARE_POINT;
      points += 1;
    }
    this.ofPoints = points > 0 ? { low, high } : null;
    stage.setCloud(positions.subarray(0, 3 * points), colours.subarray(0, points));
    this.root.dataset.points = String(points);
    const { name, width, height } = data.model.sensors[0];
    fillLegend(this.legend, data.model, layer ? [layer] : [], new Viewport(width, height));
    const whose = data.model.sides[side]?.name ?? '';
    this.words.textContent = `${counted(points, 'point')} of ${name}, ${whose}. ${this.solid.words}`;
    this.ask();
  }

  /** Everything in the picture. @returns {Bounds3} */
  get bounds() {
    const all = [this.ofPoints, this.terrain?.bounds ?? null].filter((bounds) => bounds !== null);
    const least = (/** @type {number} */ k) => Math.min(...all.map(({ low }) => low[k]));
    const most = (/** @type {number} */ k) => Math.max(...all.map(({ high }) => high[k]));
    return all.length > 0
      ? { low: [least(0), least(1), least(2)], high: [most(0), most(1), most(2)] }
      : { low: [-1, -1, -1], high: [1, 1, 1] };
  }

  /** @param {'all'|'top'} name */
  goTo(name) {
    const { low, high } = this.ofPoints ?? this.bounds;
    const centre = /** @type {Point3} */ ([0, 1, 2].map((k) => (low[k] + high[k]) / 2));
    const size = Math.max(Math.hypot(high[0] - low[0], high[1] - low[1], high[2] - low[2]), 1e-3);
    this.setPose(
      name === 'top'
        ? orbitPose(centre, size * 1.1, Math.PI / 2, Math.PI / 2)
        : orbitPose(centre, size * 1.15, 0.9, 0.6),
    );
  }

  /** @param {import('../view3d/camera.js').EyePose} pose */
  setPose(pose) {
    this.camera.pose = pose;
    this.ask();
  }

  draw() {
    const { stage, camera, box } = this;
    if (!stage || !this.isSeen || box.clientWidth === 0) {
      return;
    }
    const theme = readTheme(this.root);
    camera.fit(box.clientWidth, box.clientHeight, this.bounds);
    const ratio = Math.min(window.devicePixelRatio || 1, CLOUD_PIXELS);
    stage.drawCloud(camera, ratio, this.showsMesh ? lookOfFaces(theme) : null, this.size, theme.colours.sky);
    this.frames += 1;
    this.root.dataset.frames = String(this.frames);
  }
}
