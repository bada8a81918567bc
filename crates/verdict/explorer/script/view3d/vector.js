// Vectors of three numbers, in double precision: small functions without state.

/** @typedef {[number, number, number]} Point3 */

/** @param {Point3} a @param {Point3} b @returns {Point3} */
export function vecAdd(a, b) {
  return [a[0] + b[0], a[1] + b[1], a[2] + b[2]];
}

/** @param {Point3} a @param {Point3} b @returns {Point3} */
export function vecSub(a, b) {
  return [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
}

/** @param {Point3} a @param {number} factor @returns {Point3} */
export function vecScale(a, factor) {
  return [a[0] * factor, a[1] * factor, a[2] * factor];
}

/**
 * The point `a + b * factor`.
 * @param {Point3} a
 * @param {Point3} b
 * @param {number} factor
 * @returns {Point3}
 */
export function vecAlong(a, b, factor) {
  return [a[0] + b[0] * factor, a[1] + b[1] * factor, a[2] + b[2] * factor];
}

/** @param {Point3} a @param {Point3} b */
export function vecDot(a, b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/** @param {Point3} a @param {Point3} b @returns {Point3} */
export function vecCross(a, b) {
  return [a[1] * b[2] - b[1] * a[2], a[2] * b[0] - b[2] * a[0], a[0] * b[1] - b[0] * a[1]];
}

/** @param {Point3} a */
export function vecLength(a) {
  return Math.sqrt(vecDot(a, a));
}

/** @param {Point3} a @param {Point3} b */
export function vecDistance(a, b) {
  return vecLength(vecSub(a, b));
}

/** The vector at length 1; a vector without length stays. @param {Point3} a @returns {Point3} */
export function vecUnit(a) {
  const length = vecLength(a);
  return length > 0 ? vecScale(a, 1 / length) : a;
}

/** @param {Point3} a @param {Point3} b @param {number} share 0: a; 1: b @returns {Point3} */
export function vecBetween(a, b, share) {
  return [a[0] + (b[0] - a[0]) * share, a[1] + (b[1] - a[1]) * share, a[2] + (b[2] - a[2]) * share];
}

/** @param {Point3} a */
export function vecIsFinite(a) {
  return Number.isFinite(a[0]) && Number.isFinite(a[1]) && Number.isFinite(a[2]);
}

/**
 * The vector `v`, turned by a quaternion of any length except 0: the operations of the page model, in their
 * order.
 * @param {ArrayLike<number>} q x, y, z, w
 * @param {Point3} v
 * @returns {Point3}
 */
export function vecTurn(q, v) {
  /** @type {Point3} */
  const u = [q[0], q[1], q[2]];
  const w = q[3];
  const n = w * w + vecDot(u, u);
  const c = vecCross(u, v);
  const uc = vecCross(u, c);
  const scale = 2 / n;
  return [
    v[0] + (c[0] * w + uc[0]) * scale,
    v[1] + (c[1] * w + uc[1]) * scale,
    v[2] + (c[2] * w + uc[2]) * scale,
  ];
}

/** The opposite turn of `vecTurn`. @param {ArrayLike<number>} q @param {Point3} v @returns {Point3} */
export function vecTurnBack(q, v) {
  return vecTurn([-q[0], -q[1], -q[2], q[3]], v);
}
