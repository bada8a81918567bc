// The rays of the table as a CSV file.

import { codeName } from './filters.js';
import { NO_CODE, probeCommand } from '../data/page_model.js';

/** @typedef {import('./list.js').RayList} RayList */
/** @typedef {import('../data/page_model.js').PageModel} PageModel */

/**
 * The shown rays as CSV, in the order of the table.
 * @param {PageModel} model @param {RayList} rays measured
 */
export function raysAsCsv(model, rays) {
  const unit = model.flux_unit ?? 'W';
  const lines = [
    [
      'sensor',
      'i',
      'j',
      'a',
      'b',
      'class',
      'quantity',
      'cause',
      'range_b_minus_a_m',
      `flux_b_minus_a_${unit}`,
      'command',
    ],
  ];
  for (const ray of rays.shown) {
    const sensor = model.sensors[rays.sensor[ray]];
    const cell = rays.cell[ray];
    const { a, b } = rays.pairs[rays.pair[ray]];
    lines.push([
      sensor.name,
      String(cell % sensor.width),
      String(Math.floor(cell / sensor.width)),
      model.sides[a]?.name ?? '',
      model.sides[b]?.name ?? '',
      codeName(model, rays, 'class', rays.class[ray]),
      codeName(model, rays, 'quantity', rays.quantity[ray]),
      rays.cause[ray] === NO_CODE ? '' : codeName(model, rays, 'cause', rays.cause[ray]),
      numberField(rays.range[ray]),
      numberField(rays.flux[ray]),
      probeCommand(model, rays.sensor[ray], cell),
    ]);
  }
  return lines.map((fields) => fields.map(csvField).join(',')).join('\n') + '\n';
}

/** @param {number} value */
function numberField(value) {
  return Number.isNaN(value) ? '' : Number.isFinite(value) ? String(value) : 'inf';
}

/** A field in quotes, if it needs them. @param {string} text */
function csvField(text) {
  return /[",\n]/.test(text) ? `"${text.replace(/"/g, '""')}"` : text;
}

/** Offers a text as a file. @param {string} name @param {string} text */
export function downloadText(name, text) {
  const link = document.createElement('a');
  link.href = URL.createObjectURL(new Blob([text], { type: 'text/csv' }));
  link.download = name;
  link.click();
  window.setTimeout(() => URL.revokeObjectURL(link.href), 10000);
}
