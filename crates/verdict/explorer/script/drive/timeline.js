// The time line: a slider over all frames, play and pause, steps, and ticks of obstacle maps and scans.

import { button, element, menu, setAttributes, svgElement } from '../elements.js';

/** @typedef {import('./state.js').DriveState} DriveState */
/** @typedef {import('./model.js').DriveRecord} DriveRecord */

/** Speeds of playing, in multiples of the drive's own. */
const PLAY_SPEEDS = [0.5, 1, 2, 4, 8];

export class DriveTimeline {
  /** @param {DriveState} state @param {DriveRecord} record */
  constructor(state, record) {
    this.state = state;
    this.record = record;
    this.slider = element('input', {
      type: 'range', min: 0, max: Math.max(0, record.count - 1), step: 1, value: 0, 'aria-label': 'Frame',
      'data-drive-slider': true,
    });
    this.slider.addEventListener('input', () => state.set({ frame: Number(this.slider.value), isPlaying: false }));
    this.play = button('▶ play', () => this.toggle(), { class: 'drive-play', 'data-drive-play': true });
    this.words = element('output', { class: 'drive-when', 'data-drive-when': true });
    this.element = element('div', { class: 'drive-time', role: 'group', 'aria-label': 'Time line' },
      element('div', { class: 'drive-row' },
        this.play,
        button('|◀', () => this.step(-record.count), {
          title: 'first frame (Home)', 'aria-label': 'first frame',
        }),
        button('◀ map', () => this.stepMap(-1), {
          title: 'previous obstacle map (Page up)', 'aria-label': 'previous obstacle map',
        }),
        button('−1', () => this.step(-1), { title: 'previous frame (left)', 'aria-label': '−1: previous frame' }),
        button('+1', () => this.step(1), { title: 'next frame (right)', 'aria-label': '+1: next frame' }),
        button('map ▶', () => this.stepMap(1), {
          title: 'next obstacle map (Page down)', 'aria-label': 'next obstacle map',
        }),
        button('▶|', () => this.step(record.count), { title: 'last frame (End)', 'aria-label': 'last frame' }),
        menu('speed', PLAY_SPEEDS.map((speed) => [String(speed), `×${speed}`]), String(state.choice.speed),
          (value) => state.set({ speed: Number(value) })),
        this.words),
      element('div', { class: 'drive-slide' }, this.slider, this.ticks()));
    /** Place of playing, seconds of the drive. */
    this.place = 0;
    this.lastTick = 0;
    state.listen((changed) => {
      if (changed.has('isPlaying')) { this.startOrStop(); }
      if (changed.has('frame')) { this.show(); }
    });
    this.show();
  }

  /** Ticks of the obstacle maps (thin) and of the scans (thick), in units of frames. */
  ticks() {
    const { record } = this;
    const last = Math.max(1, record.count - 1);
    const lines = record.obstacles.map((map) => `M${map.frame} 0V6`).join('');
    const scans = record.scans.map((frame) => `M${frame} 4V12`).join('');
    return svgElement('svg', {
      class: 'drive-ticks', viewBox: `0 0 ${last} 12`, preserveAspectRatio: 'none', 'aria-hidden': 'true',
    },
    svgElement('path', { d: lines, class: 'drive-tick' }), svgElement('path', { d: scans, class: 'drive-scan' }));
  }

  show() {
    const { record, state: { choice } } = this;
    this.slider.value = String(choice.frame);
    const time = `${record.timeOf(choice.frame).toFixed(record.rate > 20 ? 2 : 1)} s`;
    const text = `frame ${record.frames[choice.frame]} of ${record.frames[record.count - 1]}, ${time}`;
    this.words.textContent = text;
    this.slider.setAttribute('aria-valuetext', text);
  }

  /** @param {number} by frames */
  step(by) {
    const frame = Math.max(0, Math.min(this.record.count - 1, this.state.choice.frame + by));
    this.state.set({ frame, isPlaying: false });
  }

  /** To the next obstacle map, or to the one before. @param {number} way 1 or -1 */
  stepMap(way) {
    const { frame } = this.state.choice;
    const frames = this.record.obstacles.map((map) => map.frame);
    const next = way > 0 ? frames.find((one) => one > frame) : frames.filter((one) => one < frame).pop();
    if (next !== undefined) {
      this.state.set({ frame: next, isPlaying: false });
    }
  }

  toggle() {
    const { choice } = this.state;
    const isAtEnd = choice.frame >= this.record.count - 1;
    this.state.set({ isPlaying: !choice.isPlaying, frame: !choice.isPlaying && isAtEnd ? 0 : choice.frame });
  }

  startOrStop() {
    const { isPlaying, frame } = this.state.choice;
    this.play.textContent = isPlaying ? '❚❚ pause' : '▶ play';
    setAttributes(this.play, { 'aria-pressed': String(isPlaying) });
    if (isPlaying) {
      this.place = this.record.timeOf(frame);
      this.lastTick = performance.now();
      requestAnimationFrame((now) => this.tick(now));
    }
  }

  /** @param {number} now milliseconds */
  tick(now) {
    const { state, record } = this;
    if (!state.choice.isPlaying) { return; }
    // A slow picture does not make the drive jump by more than a quarter of a second.
    const passed = Math.min(0.25, Math.max(0, (now - this.lastTick) / 1000));
    this.lastTick = now;
    this.place += passed * state.choice.speed;
    let { frame } = state.choice;
    while (frame < record.count - 1 && record.timeOf(frame + 1) <= this.place) {
      frame += 1;
    }
    state.set({ frame, isPlaying: frame < record.count - 1 });
    requestAnimationFrame((next) => this.tick(next));
  }
}
