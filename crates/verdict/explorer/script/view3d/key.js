// The key of the lines in the picture: which colour stands for what.

import { colourOfBeam } from './rig.js';

/** @typedef {import('./theme.js').ColourName} ColourName */
/** @typedef {import('./story.js').RayStory} RayStory */
/** @typedef {import('./panel.js').ViewPanel} ViewPanel */
/** @typedef {import('./view3d.js').PageModel3d} PageModel3d */
/** @typedef {{name: ColourName, text: string, look: 'plain' | 'dashed' | 'band'}} KeyLine */

/** From so many beams on, they have one entry. */
const BEAMS_IN_KEY = 4;

/**
 * The lines that are in the picture.
 * @param {RayStory | null} story
 * @param {PageModel3d} model
 * @param {ViewPanel} panel
 * @returns {KeyLine[]}
 */
export function keyOfPicture(story, model, panel) {
  /** @type {KeyLine[]} */
  const lines = [];
  const isLight = panel.isShown('light');
  if (story && !isLight) {
    for (const side of story.sides) {
      if (!side.isGiven) continue;
      const isA = side.letter === 'A';
      const text = `${side.letter}: ${side.name} (${isA ? 'circle' : 'square'})`;
      lines.push({ name: isA ? 'a' : 'b', text, look: isA ? 'plain' : 'dashed' });
    }
    lines.push({ name: 'exact', text: `${story.exact ? 'exact' : 'computed here'} (cross)`, look: 'band' });
    if (story.witnesses.length > 0) {
      lines.push({ name: 'witness', text: 'witness: a ray beside it', look: 'dashed' });
    }
  }
  if (story?.view?.state === 'clear' || (story && isLight && story.pencils.length > 0)) {
    lines.push({ name: 'seen', text: 'light to the camera', look: 'plain' });
  } else if (story?.view) {
    lines.push({ name: 'blocked', text: 'light that does not reach the camera', look: 'dashed' });
  }
  const beams = model.sensors.filter((sensor) => sensor.kind === 'beam');
  if (panel.isShown('sheets') && beams.length >= BEAMS_IN_KEY) {
    lines.push({ name: 'beam-0', text: 'beams', look: 'plain' });
  } else if (panel.isShown('sheets')) {
    for (const beam of beams) lines.push({ name: colourOfBeam(beam), text: beam.name, look: 'plain' });
  }
  return lines;
}
