// The quantities that pictures show: what each channel is called, its unit, and how it is drawn.

/** @typedef {import('./page_model.js').PageModel} PageModel */
/** @typedef {'value'|'light'|'signed'|'faces'|'yes-no'|'normal'|'classes'|'causes'} ChannelDrawing */
/**
 * @typedef {object} Channel
 * @property {string} key as in files, or the page's own name
 * @property {string} title
 * @property {string} unit
 * @property {ChannelDrawing} drawing
 * @property {'side'|'pair'|'sensor'} belongs whose values these are: of a side, of a pair, or of the sensor
 *   alone
 * @property {string} words what it is, in one sentence
 */

/** @type {[string, string, string, ChannelDrawing, 'side'|'pair'|'sensor', string][]} */
const KNOWN_CHANNELS = [
  ['range.T', 'range', 'm', 'value', 'side', "Distance from the ray's start to its hit."],
  ['depth.Z', 'depth', 'm', 'value', 'side', "Distance of the hit along the sensor's axis."],
  ['P.X', 'point x', 'm', 'value', 'side', "The hit's x in the scene frame."],
  ['P.Y', 'point y', 'm', 'value', 'side', "The hit's y in the scene frame."],
  ['P.Z', 'point z', 'm', 'value', 'side', "The hit's z in the scene frame."],
  [
    'N.RGB',
    'normal, as a colour',
    '',
    'normal',
    'side',
    "Red, green and blue show x, y and z of the face's normal.",
  ],
  ['N.X', 'normal x', '', 'signed', 'side', "The x component of the face's normal."],
  ['N.Y', 'normal y', '', 'signed', 'side', "The y component of the face's normal."],
  ['N.Z', 'normal z', '', 'signed', 'side', "The z component of the face's normal."],
  ['incidence.V', 'incidence', '', 'value', 'side', "Cosine between the ray and the face's normal."],
  ['face.I', 'face', '', 'faces', 'side', 'The face that is hit. Colours only tell faces apart.'],
  ['visible.V', 'visible', '', 'yes-no', 'side', "Whether the camera sees the pencil's hit."],
  ['pixel.I', 'pixel column', '', 'value', 'side', "Column of the camera's pixel in which the hit lands."],
  ['pixel.J', 'pixel row', '', 'value', 'side', "Row of the camera's pixel in which the hit lands."],
  ['flux.V', 'flux', 'W', 'light', 'side', 'Light that the camera receives.'],
  ['class', 'class', '', 'classes', 'pair', 'What the referee says of the two answers.'],
  ['cause', 'cause', '', 'causes', 'pair', "The paper's approximations that caused the difference."],
  [
    'share',
    'range difference / bound',
    '',
    'value',
    'pair',
    'Share of its bound that the difference of the ranges uses.',
  ],
  [
    'margin.face',
    'margin: face',
    'cells',
    'value',
    'sensor',
    'How far the ray is from one with other nearest faces. Only rays that the referee ruled on have it.',
  ],
  [
    'margin.surface',
    'margin: surface',
    'cells',
    'value',
    'sensor',
    'How far the ray is from a miss or a jump of the range. Only rays that the referee ruled on have it.',
  ],
  [
    'margin.visibility',
    'margin: visibility',
    'cells',
    'value',
    'sensor',
    'How far the pencil is from one that is seen otherwise. Only rays that the referee ruled on have it.',
  ],
  [
    'margin.landing',
    'margin: landing',
    'pixels',
    'value',
    'sensor',
    "How far the hit's image is from the next pixel. Only rays that the referee ruled on have it.",
  ],
];

/**
 * The channels that any sensor of the model has, in a fixed order.
 * @param {PageModel} model
 * @returns {Channel[]}
 */
export function channelsOfModel(model) {
  /** @type {Map<string, Channel>} */
  const found = new Map();
  for (const sensorIndex of model.sensors.keys()) {
    for (const channel of channelsOfSensor(model, sensorIndex)) {
      found.set(channel.key, channel);
    }
  }
  const order = [...KNOWN_CHANNELS.map(([key]) => key)];
  /** @param {string} key */
  const placeOf = (key) => {
    const base = key.startsWith('flux.') ? 'flux.V' : key;
    return order.indexOf(base) < 0 ? order.length : order.indexOf(base);
  };
  return [...found.values()].sort(
    (one, other) => placeOf(one.key) - placeOf(other.key) || (one.key < other.key ? -1 : 1),
  );
}

/**
 * The channels that a sensor has on any side.
 * @param {PageModel} model
 * @param {number} sensorIndex
 * @returns {Channel[]}
 */
export function channelsOfSensor(model, sensorIndex) {
  const sensor = model.sensors[sensorIndex];
  const given = new Set((sensor.sides ?? []).flatMap((side) => Object.keys(side?.channels ?? {})));
  if (['N.X', 'N.Y', 'N.Z'].every((key) => given.has(key))) {
    given.add('N.RGB');
  }
  const beams = [...given].filter((key) => key.startsWith('flux.beam'));
  if (beams.length > 0) {
    given.add('flux.V');
  }
  for (const pair of sensor.pairs ?? []) {
    if (pair.class) {
      given.add('class');
    }
    if (pair.cause && (model.causes ?? []).length > 0) {
      given.add('cause');
    }
    if (pair.range_ulps && pair.range_bound) {
      given.add('share');
    }
  }
  for (const name of /** @type {const} */ (['face', 'surface', 'visibility', 'landing'])) {
    if (sensor.margins?.[name]) {
      given.add(`margin.${name}`);
    }
  }
  return [...given].map((key) => channelOf(model, key)).filter((channel) => channel !== null);
}

/**
 * What is known of a channel; null for one that this page does not draw.
 * @param {PageModel} model
 * @param {string} key
 * @returns {Channel|null}
 */
export function channelOf(model, key) {
  const entry = KNOWN_CHANNELS.find(([known]) => known === key);
  if (entry) {
    const [, title, unit, drawing, belongs, words] = entry;
    const ofLight = key === 'flux.V';
    return { key, title, unit: ofLight ? (model.flux_unit ?? 'W') : unit, drawing, belongs, words };
  }
  const beam = /^flux\.beam(\d+)$/.exec(key);
  if (beam) {
    const words = `Light of beam ${beam[1]} that each pixel receives.`;
    return {
      key,
      title: `flux of beam ${beam[1]}`,
      unit: model.flux_unit ?? 'W',
      drawing: 'light',
      belongs: 'side',
      words,
    };
  }
  // A channel of other programs' files: its own name, and the unit that the page has for it.
  const quantity = (model.quantities ?? []).find(({ name }) => name === key);
  return quantity
    ? { key, title: key, unit: quantity.unit, drawing: 'value', belongs: 'side', words: `The channel ${key}.` }
    : null;
}

/**
 * Whether a number of this drawing is an index, and its difference says nothing.
 * @param {ChannelDrawing} drawing
 */
export function isNamed(drawing) {
  return drawing === 'faces' || drawing === 'yes-no' || drawing === 'classes' || drawing === 'causes';
}
