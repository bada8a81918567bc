// The words under the picture: what is seen of the chosen ray.

import { digitsOf, facesInWords, lengthInWords, rangeInWords } from './words.js';

/** @typedef {import('./story.js').RayStory} RayStory */
/** @typedef {import('./story.js').SideAnswer} SideAnswer */

/** Paragraphs about a ray, in order; the first names it. @param {RayStory} story @returns {string[]} */
export function captionOfRay(story) {
  return [
    `${story.sensorName}, ${story.cellWord} (${story.i}, ${story.j})`,
    [...sentencesOfSides(story), exactSentence(story)].join(' '),
    witnessSentences(story).join(' '),
    [viewSentence(story), pencilSentence(story)].join(' ').trim(),
  ].filter((paragraph) => paragraph !== '');
}

/** @param {RayStory} story @returns {string[]} */
function sentencesOfSides(story) {
  const given = story.sides.filter((side) => side.isGiven);
  const sentences = given.map(
    (side) => `${side.letter} (${side.name}) ${answerInWords(side, story.difference)}.`,
  );
  const [a, b] = given;
  if (!a?.hit || !b?.hit) return sentences;
  const gap = b.hit.range - a.hit.range;
  const ulps = story.rangeUlps;
  const amount =
    ulps !== null && ulps !== 0 && Math.abs(ulps) < 2147483647
      ? `${lengthInWords(Math.abs(ulps) * ulpOf(a.hit.range))} (${Math.abs(ulps)} ulp)`
      : gap === 0
        ? ''
        : lengthInWords(Math.abs(gap));
  const isLonger = ulps !== null && ulps !== 0 ? ulps > 0 : gap > 0;
  if (amount === '') sentences.push('Both ranges are the same.');
  else sentences.push(`The range of B is ${amount} ${isLonger ? 'longer' : 'shorter'} than that of A.`);
  return sentences;
}

/** @param {SideAnswer} side @param {number} difference of the ranges, metres */
function answerInWords(side, difference) {
  if (!side.hit) return 'misses';
  const where = side.hit.face >= 0 ? `hits face ${side.hit.face}` : 'hits';
  return `${where} at ${rangeInWords(side.hit.range, difference)}`;
}

/** @param {RayStory} story */
function exactSentence(story) {
  const { exact, here } = story;
  if (exact) {
    if (exact.faces.length === 0 || exact.range === null) return 'The exact ray meets no face.';
    const range = rangeInWords(exact.range, story.difference);
    return `The exact ray meets ${facesInWords(exact.faces)} at ${range}.`;
  }
  if (!here) return 'In double precision, computed in this page, the ray meets no face.';
  const where = `face ${here.face} at ${rangeInWords(here.range)}`;
  return `In double precision, computed in this page, the ray meets ${where}.`;
}

/** @param {RayStory} story @returns {string[]} */
function witnessSentences(story) {
  const others = {
    face: 'another nearest face',
    surface: 'another surface',
    visibility: 'another visibility',
  };
  return story.witnesses.map((witness) => {
    const [dx, dy] = witness.displacement;
    const meets = witness.hit
      ? `It meets face ${witness.hit.face} at ${rangeInWords(witness.hit.range)}.`
      : 'It meets no face.';
    const by = `(${digitsOf(dx, 3)}, ${digitsOf(dy, 3)})`;
    return `A ray displaced by ${by} cells has ${others[witness.kind]}. ${meets}`;
  });
}

/** @param {RayStory} story */
function viewSentence(story) {
  const { view, exact } = story;
  if (!view) return '';
  const parts = [];
  if (view.state === 'behind') parts.push('The hit is not before the camera.');
  if (view.state === 'turned')
    parts.push('The face of the hit shows its back to the camera, so that the camera does not see it.');
  if (view.state === 'clear') parts.push('Nothing stands between the hit and the camera.');
  if (view.state === 'hidden' && view.occluder) {
    parts.push(
      `Face ${view.occluder.face} hides the hit from the camera,`,
      `${lengthInWords(view.occluder.range)} from the hit.`,
    );
  }
  if (view.image) {
    const place = `(${Math.floor(view.image.u)}, ${Math.floor(view.image.v)})`;
    parts.push(
      view.image.onImage
        ? `The hit lies in pixel ${place} of the camera.`
        : 'The hit lies beside the camera image.',
    );
  }
  const isSeen = exact?.visible ?? (view.state === 'clear' && view.image?.onImage === true);
  for (const side of story.sides) {
    if (!side.hit || side.visible === null || side.visible === isSeen) continue;
    parts.push(`${side.letter} says that the camera ${side.visible ? 'sees' : 'does not see'} its hit.`);
  }
  if (exact && exact.visible !== null) {
    parts.push(`The exact answer: the camera ${exact.visible ? 'sees' : 'does not see'} it.`);
  }
  return parts.join(' ');
}

/** @param {RayStory} story */
function pencilSentence(story) {
  if (story.pencilCount === 0) return '';
  const count = story.pencilCount === 1 ? 'One pencil lands' : `${story.pencilCount} pencils land`;
  return `${count} in this pixel.`;
}

/** Unit in the last place of a number in double precision. @param {number} value */
function ulpOf(value) {
  return 2 ** (Math.floor(Math.log2(Math.abs(value))) - 52);
}
