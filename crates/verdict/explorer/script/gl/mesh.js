// The drawing of the terrain by WebGL2: one indexed draw, flat faces, a grid of metres laid over the ground.

import { DepthProgram, GL_WRITE_DEPTH } from './program.js';
import { GlVertices } from './vertices.js';
import { orderForDrawing } from '../view3d/terrain.js';

/** @typedef {import('../view3d/terrain.js').Terrain} Terrain */
/** @typedef {import('../view3d/camera.js').ViewCamera} ViewCamera */
/** @typedef {[number, number, number]} Rgb numbers of 0 to 1 */
/**
 * @typedef {object} TerrainLook
 * @property {'face' | 'elevation' | 'slope'} source where the colour comes from: one of its own for each
 *   face, or a ramp
 * @property {[number, number]} span lowest and highest value of the ramp: metres, or radians of slope
 * @property {number} grid distance of the lines of the grid, metres; 0: none
 * @property {Rgb} back colour of faces that are seen from behind
 * @property {Rgb} gridColour
 * @property {number} ambient light from everywhere, of 0 to 1
 */

/**
 * How faces look that have colours of their own, without a grid.
 * @param {{colours: Record<'back' | 'grid', Rgb>, isDark: boolean}} theme
 * @returns {TerrainLook}
 */
export function lookOfFaces({ colours, isDark }) {
  return {
    source: 'face',
    span: [0, 1],
    grid: 0,
    back: colours.back,
    gridColour: colours.grid,
    ambient: isDark ? 0.32 : 0.42,
  };
}

// What is the same over a face is computed once, at its last vertex. A program without PLACE has no grid and
// no colours by elevation: it is the fastest.
const MESH_VERTEX = `
layout(location = 0) in vec3 position;
layout(location = 1) in vec4 normal;
layout(location = 2) in vec4 colour;
uniform mat4 matrix;
uniform vec4 shift;
uniform vec3 eyeHigh;
uniform float source; // 0 face, 1 elevation, 2 slope
uniform vec2 ramp; // value at the ramp's start, 1 / span
uniform sampler2D rampColours;
uniform float ambient;
flat out vec4 paint; // colour with light; how level the face is
flat out vec2 light; // of its front and of its back
#ifdef PLACE
out vec3 fromEye;
#endif
void main() {
  vec3 away = position - eyeHigh;
  gl_Position = matrix * vec4(away, 0.0) + shift;
  vec3 n = normalize(normal.xyz + vec3(0.0, 0.0, 1e-6));
  float head = -dot(n, away) / max(length(away), 1e-30);
  float sun = max(dot(n, vec3(-0.396, 0.594, 0.700)), 0.0);
  light = vec2(ambient + (1.0 - ambient) * (0.75 * sun + 0.35 * max(head, 0.0)), 0.75 + 0.25 * abs(head));
  vec3 base = colour.rgb;
  if (source > 1.5) {
    base = textureLod(rampColours, vec2((acos(clamp(n.z, -1.0, 1.0)) - ramp.x) * ramp.y, 0.5), 0.0).rgb;
  }
  paint = vec4(base * light.x, abs(n.z));
#ifdef PLACE
  fromEye = away;
#endif
}
`;

const MESH_FRAGMENT = `
flat in vec4 paint;
flat in vec2 light;
#ifdef PLACE
in vec3 fromEye;
uniform float source;
uniform vec2 ramp;
uniform sampler2D rampColours;
uniform vec4 grid; // 1 / distance; the eye in units of it, x and y; strength
uniform vec3 gridColour;
#endif
uniform vec3 backColour;
uniform float pixelRatio;
out vec4 result;
${GL_WRITE_DEPTH}
#ifdef PLACE
// Share of the pixel that lies on lines at whole numbers.
float lineAt(float place, float width, float weight) {
  float away = abs(fract(place + 0.5) - 0.5) / max(width, 1e-30);
  return clamp(pixelRatio * 0.5 + 0.5 - away, 0.0, 1.0) * weight * (1.0 - smoothstep(0.1, 0.4, width));
}
#endif

void main() {
  vec3 base = paint.rgb;
#ifdef PLACE
  if (source > 0.5 && source < 1.5) {
    base = texture(rampColours, vec2((fromEye.z - ramp.x) * ramp.y, 0.5)).rgb * light.x;
  }
#endif
  if (!gl_FrontFacing) {
    float stripe = step(0.5, fract((gl_FragCoord.x + gl_FragCoord.y) / (10.0 * pixelRatio)));
    base = mix(backColour, backColour * 0.62, stripe) * light.y;
  }
#ifdef PLACE
  if (grid.w > 0.0) {
    // Walls have no grid: their lines would be as wide as they are.
    float weight = smoothstep(0.15, 0.4, paint.a);
    vec2 place = fromEye.xy * grid.x + grid.yz;
    vec2 width = fwidth(place);
    float fine = max(lineAt(place.x, width.x, weight), lineAt(place.y, width.y, weight));
    vec2 tenth = place * 0.1;
    float coarse = max(lineAt(tenth.x, width.x * 0.1, weight), lineAt(tenth.y, width.y * 0.1, weight));
    base = mix(base, gridColour, grid.w * max(0.28 * fine, 0.62 * coarse));
  }
#endif
  result = vec4(base, 1.0);
  writeDepth(1.0 / gl_FragCoord.w);
}
`;

/** The terrain on the graphics processor. */
export class TerrainDrawing {
  /**
   * @param {WebGL2RenderingContext} gl
   * @param {Terrain} terrain
   * @param {Uint8Array} ramp 256 colours, four bytes each
   */
  constructor(gl, terrain, ramp) {
    this.gl = gl;
    this.faceCount = terrain.faceCount;
    this.program = new DepthProgram(gl, MESH_VERTEX, MESH_FRAGMENT);
    const order = orderForDrawing(terrain);
    this.owner = order.owner.subarray(0, order.count);
    this.indexCount = order.indices.length;
    this.vertexCount = order.count;
    const positions = new Float32Array(3 * order.count);
    // Signed bytes of the normal, four each vertex, copied as whole words.
    const normals = new Int32Array(order.count);
    const faceNormals = new Int32Array(terrain.normals.buffer, terrain.normals.byteOffset, terrain.faceCount);
    for (let vertex = 0; vertex < order.count; vertex++) {
      const from = 3 * order.source[vertex];
      positions[3 * vertex] = terrain.vertices[from];
      positions[3 * vertex + 1] = terrain.vertices[from + 1];
      positions[3 * vertex + 2] = terrain.vertices[from + 2];
      const face = order.owner[vertex];
      if (face !== 4294967295) normals[vertex] = faceNormals[face];
    }
    this.vertices = new GlVertices(gl, gl.STATIC_DRAW, gl.FLOAT, gl.BYTE, gl.UNSIGNED_BYTE);
    this.vertices.set(0, positions);
    this.vertices.set(1, normals);
    this.vertices.setFaces(order.indices);
    this.ramp = gl.createTexture();
    gl.bindTexture(gl.TEXTURE_2D, this.ramp);
    gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA8, 256, 1, 0, gl.RGBA, gl.UNSIGNED_BYTE, ramp);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, gl.LINEAR);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MAG_FILTER, gl.LINEAR);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_WRAP_S, gl.CLAMP_TO_EDGE);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_WRAP_T, gl.CLAMP_TO_EDGE);
  }

  /**
   * Sets the colour of each face.
   * @param {Uint32Array} ofFaces bytes R, G, B, 255 as one word (R is the lowest)
   */
  setColours(ofFaces) {
    const { owner } = this;
    const colours = new Uint32Array(this.vertexCount);
    for (let vertex = 0; vertex < this.vertexCount; vertex++) {
      const face = owner[vertex];
      if (face !== 4294967295) colours[vertex] = ofFaces[face];
    }
    this.vertices.set(2, colours);
  }

  /**
   * @param {ViewCamera} camera
   * @param {TerrainLook} look
   * @param {number} pixelRatio device pixels per CSS pixel
   */
  draw(camera, look, pixelRatio) {
    if (this.indexCount === 0) return;
    const { gl } = this;
    const hasPlace = look.grid > 0 || look.source === 'elevation';
    const program = this.program.use(camera, ...(hasPlace ? ['PLACE'] : []));
    const { eyeHigh } = camera.forShader();
    program.setEye(camera);
    program.set('source', look.source === 'slope' ? 2 : look.source === 'elevation' ? 1 : 0);
    const start = look.source === 'elevation' ? look.span[0] - eyeHigh[2] : look.span[0];
    program.set('ramp', start, 1 / Math.max(look.span[1] - look.span[0], 1e-9));
    program.set('gridColour', ...look.gridColour);
    program.set('backColour', ...look.back);
    program.set('ambient', look.ambient);
    program.set('pixelRatio', pixelRatio);
    // Lines at multiples of 10: whole numbers modulo 10 keep them in place far from the origin.
    const phase = (/** @type {number} */ place) =>
      place / look.grid - 10 * Math.floor(place / look.grid / 10);
    if (look.grid > 0) program.set('grid', 1 / look.grid, phase(eyeHigh[0]), phase(eyeHigh[1]), 1);
    else program.set('grid', 0, 0, 0, 0);
    gl.activeTexture(gl.TEXTURE0);
    gl.bindTexture(gl.TEXTURE_2D, this.ramp);
    this.vertices.drawFaces(this.indexCount);
  }

  dispose() {
    this.vertices.dispose();
    this.gl.deleteTexture(this.ramp);
    this.program.dispose();
  }
}
