// The sectors of an obstacle map: which one lies at a place, its outline, and its words.

import { LABEL_LOOKS } from './looks.js';

/** @typedef {import('./model.js').DriveObstacleMap} DriveObstacleMap */
/** @typedef {import('./model.js').DriveSector} DriveSector */

/** How far beyond its end a sector is still hit, metres. */
const SECTOR_ROOM = 0.2;

/** Half of the angle between a sector and its neighbours, radians. @param {DriveSector[]} sectors
 * @param {number} index */
export function halfWidth(sectors, index) {
  const other = sectors[index + 1] ?? sectors[index - 1];
  return other ? Math.abs(turnBetween(other.direction, sectors[index].direction)) / 2 : 0.02;
}

/** The turn from one direction to another, -pi to pi. @param {number} from @param {number} to */
function turnBetween(from, to) {
  const turn = (to - from) % (2 * Math.PI);
  return turn > Math.PI ? turn - 2 * Math.PI : turn < -Math.PI ? turn + 2 * Math.PI : turn;
}

/** The sector at a place; -1 for none. @param {DriveObstacleMap} map @param {number} x metres @param {number} y */
export function sectorAt(map, x, y) {
  const [dx, dy] = [x - map.centre[0], y - map.centre[1]];
  const radius = Math.hypot(dx, dy);
  const direction = Math.atan2(dy, dx);
  let [nearest, least] = [-1, Infinity];
  map.sectors.forEach((sector, index) => {
    const away = Math.abs(turnBetween(sector.direction, direction));
    if (away < least && away <= halfWidth(map.sectors, index) * 1.02 && radius <= sector.radius + SECTOR_ROOM) {
      [nearest, least] = [index, away];
    }
  });
  return nearest;
}

/**
 * A point of the plan on a circle about the centre of the map.
 * @param {DriveObstacleMap} map @param {number} direction @param {number} radius
 * @returns {[number, number]}
 */
export function onCircle(map, direction, radius) {
  return [map.centre[0] + Math.cos(direction) * radius, map.centre[1] + Math.sin(direction) * radius];
}

/** The outline of a sector up to its end. @param {DriveObstacleMap} map @param {number} index */
export function wedgeOf(map, index) {
  const { direction, radius } = map.sectors[index];
  const half = halfWidth(map.sectors, index);
  return [map.centre, ...[-1, -0.5, 0, 0.5, 1].map((share) => onCircle(map, direction + share * half, radius))];
}

/** Direction in degrees, from the x axis to the left. @param {DriveSector} sector */
export function degreesOf(sector) {
  return (sector.direction * 180 / Math.PI).toFixed(1).replace('-', '−');
}

/** How many sectors have each label, in words. @param {DriveObstacleMap} map */
export function labelCounts(map) {
  return Object.entries(LABEL_LOOKS).map(([label, look]) => {
    const count = map.sectors.filter((sector) => sector.label === label).length;
    return `${count} ${look.words}`;
  }).join(', ');
}
