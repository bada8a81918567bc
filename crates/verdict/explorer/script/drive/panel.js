// The drive panel: time line, map from above, read-out, sectors, 3-D picture and charts, tied together.
//
// Use: `const panel = new DrivePanel(host, page);` where `host` is an empty element and `page` is
//   { model, container: { decode(reference) => Promise<typed array> } }
// A `PageData` (page_data.js) is one. Of the model it reads `drive`, `mesh` (vertices, faces, origin) and `sensors`
// (pose, camera, grid, size, max_range). `panel.ready` settles once the map is shown, and never fails: trouble is told
// in the panel. Optional in the model: `drive.vehicle` { wheelbase, track, wheel_radius, wheel_width, clearance } in
// metres (else the default vehicle), and `drive.scans`, indices in `frames` of the frames with a vertical scan.
//
// Hooks for tests: `[data-drive]` has `data-state` (loading, ready, failed), `data-ground` (loading, ready, none) and
// `data-frame` (index in the page's frames). `[data-drive-slider]`, `[data-drive-play]`, `[data-drive-when]`,
// `[data-drive-map]` (`data-drive-drawn`), `[data-drive-colouring]`, `[data-drive-switch=NAME]`,
// `[data-drive-scale]`, `[data-drive-readout]`, `[data-drive-value]`, `[data-drive-sectors]`,
// `tr[data-drive-sector=N]`, `[data-drive-3d]`, `[data-drive-charts]`, `[data-drive-says]`. The address `#frame/120`
// (or `#frame/120/sector/7`) names a frame of the drive.

import { button, checkbox, element, menu } from '../elements.js';
import { DriveRecord } from './model.js';
import { MapReplay } from './replay.js';
import { DriveGround } from './ground.js';
import { plainDriveState } from './state.js';
import { DriveTimeline } from './timeline.js';
import { DriveMap } from './map.js';
import { DriveReadout } from './readout.js';
import { SectorTable } from './table.js';
import { DriveView3d } from './view3d.js';
import { driveCharts } from './chart.js';
import { driveKeys } from './keys.js';
import { driveLegend } from './legend.js';
import { CellTruth } from './raster.js';
import { paintRelief } from './relief.js';
import { elevationScale, errorScale } from './scale.js';
import { readDriveTheme } from './looks.js';
import { degreesOf } from './sectors.js';

/** @typedef {import('./model.js').DrivePage} DrivePage */
/** @typedef {import('./state.js').DriveChoice} DriveChoice */
/** @typedef {import('./scale.js').MapColouring} MapColouring */

/** Ways to colour the map. @type {[MapColouring, string][]} */
const COLOURINGS = [['elevation', 'elevation'], ['source', 'source'], ['error', 'map − true ground']];

/** @typedef {'isShaded'|'hasRelief'|'hasSectors'|'mapFollows'} MapSwitch */

/** Switches of the map. @type {[MapSwitch, string][]} */
const MAP_SWITCHES = [
  ['isShaded', 'hill shading'], ['hasRelief', 'true ground in grey'], ['hasSectors', 'sectors'],
  ['mapFollows', 'follow the vehicle'],
];

/** Time after the last change until the address follows: milliseconds. */
const HASH_REST = 250;

export class DrivePanel {
  /** @param {HTMLElement} host @param {DrivePage} page */
  constructor(host, page) {
    this.host = host;
    this.page = page;
    this.root = element('div', { class: 'drive', 'data-drive': true },
      element('h2', {}, 'The drive, frame by frame'),
      element('p', { class: 'drive-soft', role: 'status' }, 'The drive is being read.'));
    Object.assign(this.root.dataset, { state: 'loading', ground: 'loading' });
    host.append(this.root);
    this.state = plainDriveState();
    this.hashTimer = 0;
    /** @type {DriveView3d|null} */
    this.view3d = null;
    /** @type {Promise<void>} */
    this.ready = this.start().catch((error) => {
      console.error(error);
      this.root.dataset.state = 'failed';
      this.root.replaceChildren(element('p', { role: 'alert' },
        `The drive cannot be shown: ${error instanceof Error ? error.message : error}.`));
    });
  }

  async start() {
    this.record = await DriveRecord.read(this.page);
    if (this.record.count === 0) {
      throw new Error('it has no frames');
    }
    this.replay = new MapReplay(this.record);
    this.map = new DriveMap(this.state, this.replay, readDriveTheme(this.root));
    this.map.elevations = elevationScale(this.record);
    this.state.choice.frame = this.record.count - 1;
    this.state.choice.viewFollows = true;
    this.followHash();
    this.build(this.map);
    this.root.dataset.state = 'ready';
    this.state.listen((changed) => this.changed(changed));
    window.addEventListener('hashchange', () => this.followHash());
    window.matchMedia('(prefers-color-scheme: dark)').addEventListener('change', () => this.retheme());
    this.changed(new Set(/** @type {const} */ (['frame'])));
    // The ground takes longer; the map is seen before.
    window.setTimeout(() => this.readGround().catch((error) => {
      console.error(error);
      this.noGround('The true ground could not be read.');
    }), 0);
  }

  /** @param {DriveMap} map */
  build(map) {
    const { state } = this;
    this.timeline = new DriveTimeline(state, map.record);
    this.readout = new DriveReadout(state, map);
    this.table = new SectorTable(state, map);
    this.view3d = new DriveView3d(state, map);
    this.legend = driveLegend(state, map);
    this.says = element('p', { class: 'drive-unseen', role: 'status', 'data-drive-says': true });
    const colours = menu('colours of the map', COLOURINGS, state.choice.colouring,
      (value) => state.set({ colouring: /** @type {MapColouring} */ (value) }));
    colours.dataset.driveColouring = '';
    state.listen((changed) => { if (changed.has('colouring')) { colours.value = state.choice.colouring; } });
    const keys = driveKeys(this);
    const bar = element('div', { class: 'drive-row', role: 'toolbar', 'aria-label': 'Map' },
      element('label', {}, 'colours ', colours), ...MAP_SWITCHES.map(([key, words]) => this.switch(key, words)),
      button('−', () => this.zoom(1 / 1.4), { 'aria-label': 'zoom out', title: 'zoom out' }),
      button('+', () => this.zoom(1.4), { 'aria-label': 'zoom in', title: 'zoom in' }),
      button('all', () => this.fit(), { title: 'show everything (0)' }),
      button('keys', () => keys.dialog.showModal(), { title: 'all keys (?)', 'aria-haspopup': 'dialog' }));
    const { record } = map;
    const cut = record.isCut ? [element('p', { class: 'drive-cut', role: 'note' },
      `For want of room the page has no changes of the map after frame ${record.frames[record.lastReplayed]}. `
      + 'Later frames show the map of that frame.')] : [];
    this.root.replaceChildren(
      element('h2', {}, 'The drive, frame by frame'), this.timeline.element, ...cut, bar,
      element('div', { class: 'drive-main' },
        element('div', { class: 'drive-picture' }, map.canvas, this.legend.element),
        element('div', { class: 'drive-side' }, this.readout.element, this.table.element)),
      driveCharts(state, map.replay),
      element('h3', {}, 'In three dimensions'), this.view3d.element, this.says, keys.dialog);
    this.readout.show();
  }

  /** @param {MapSwitch} key @param {string} words */
  switch(key, words) {
    const { state } = this;
    const set = (/** @type {boolean} */ isOn) => state.set({ [key]: isOn });
    const { input, label } = checkbox(words, state.choice[key], set, { 'data-drive-switch': key });
    state.listen((changed) => { if (changed.has(key)) { input.checked = state.choice[key]; } });
    return label;
  }

  async readGround() {
    const { mesh } = this.page.model;
    if (!mesh || !this.map || !this.replay) {
      this.noGround('The page has no ground.');
      return;
    }
    const { container } = this.page;
    const [vertices, faces] = await Promise.all([container.decode(mesh.vertices), container.decode(mesh.faces)]);
    const ground = new DriveGround(/** @type {Float32Array} */ (vertices), /** @type {Uint32Array} */ (faces));
    this.map.setTruth(new CellTruth(this.replay, ground), errorScale(this.replay, ground));
    this.root.dataset.ground = 'ready';
    this.readout?.show();
    this.legend?.show();
    this.view3d?.ask();
    await this.paintGround();
  }

  async paintGround() {
    const { map } = this;
    if (map?.truth) {
      const isDark = window.matchMedia('(prefers-color-scheme: dark)').matches;
      map.relief = await paintRelief(map.truth.ground, grownBox(map.view.everything), isDark);
      map.ask();
    }
  }

  /** @param {string} words */
  noGround(words) {
    this.root.dataset.ground = 'none';
    this.view3d?.fail(words);
  }

  retheme() {
    const { map } = this;
    if (map) {
      map.theme = readDriveTheme(this.root);
      map.changedLook();
      this.legend?.show();
      if (this.table) {
        this.table.shown = -2;
        this.table.fill();
      }
      this.view3d?.retheme();
      this.paintGround();
    }
  }

  /** @param {number} factor */
  zoom(factor) {
    const { map } = this;
    if (map) {
      map.view.zoomAbout(factor, map.view.width / 2, map.view.height / 2);
      map.follow();
      map.ask();
    }
  }

  fit() {
    this.state.set({ mapFollows: false });
    this.map?.view.fit();
    this.map?.ask();
  }

  /** @param {Set<keyof DriveChoice>} changed */
  changed(changed) {
    const { choice } = this.state;
    this.root.dataset.frame = String(choice.frame);
    if (changed.has('cell') && choice.cell && this.says) {
      this.says.textContent = this.readout?.cellWords() ?? '';
    } else if (changed.has('sector') && choice.sector >= 0) {
      this.saySector();
    }
    const isOther = changed.has('frame') || changed.has('sector') || changed.has('isPlaying');
    if (isOther && !choice.isPlaying) {
      window.clearTimeout(this.hashTimer);
      this.hashTimer = window.setTimeout(() => this.writeHash(), HASH_REST);
    }
  }

  /** Tells the chosen sector to people who do not see it. */
  saySector() {
    const { sector: index } = this.state.choice;
    const sector = this.map?.obstacles?.sectors[index];
    if (sector && this.says) {
      const place = `${degreesOf(sector)} degrees, ${sector.radius.toFixed(1)} metres`;
      this.says.textContent = `Sector ${index}, ${place}, ${sector.label}. ${sector.reason}`;
    }
  }

  writeHash() {
    const { choice } = this.state;
    const { record } = this;
    if (!record) { return; }
    const isPlain = choice.frame === record.count - 1 && choice.sector < 0;
    if (isPlain && !window.location.hash) { return; }
    const sector = choice.sector >= 0 ? `/sector/${choice.sector}` : '';
    const hash = `#frame/${record.frames[choice.frame]}${sector}`;
    if (window.location.hash !== hash) {
      history.replaceState(null, '', hash);
    }
  }

  followHash() {
    const asked = /^#frame\/(\d+)(?:\/sector\/(\d+))?$/.exec(window.location.hash);
    if (asked && this.record) {
      const frame = this.record.frameOfNumber(Number(asked[1]));
      const count = this.record.obstacles[this.record.obstacleIndexAt(frame)]?.sectors.length ?? 0;
      const sector = asked[2] !== undefined && Number(asked[2]) < count ? Number(asked[2]) : -1;
      this.state.set({ frame, sector, isPlaying: false });
    }
  }
}

/** A box with room about it, so that the ground reaches beyond the cells.
 * @param {import('./relief.js').PlanBox} box */
function grownBox({ left, bottom, right, top }) {
  const room = Math.max(right - left, top - bottom) * 0.6;
  return { left: left - room, bottom: bottom - room, right: right + room, top: top + room };
}
