// Solid coloured faces that change from frame to frame: the cells of the map, and the vehicle. Drawn by WebGL2.

import { DepthProgram, GL_WRITE_DEPTH } from '../gl/program.js';
import { GlVertices } from '../gl/vertices.js';

/** @typedef {import('../view3d/camera.js').ViewCamera} ViewCamera */
/** @typedef {{positions: Float32Array, colours: Uint32Array, indices: Uint32Array}} SolidMesh */

const SOLID_VERTEX = `
layout(location = 0) in vec3 position;
layout(location = 1) in vec4 colour;
uniform mat4 matrix;
uniform vec4 shift;
uniform vec3 eyeHigh;
uniform vec2 pull; // towards the eye: of 1 / depth, constant
flat out vec3 faceColour;
out vec3 fromEye;
out float depth;
void main() {
  fromEye = position - eyeHigh;
  gl_Position = matrix * vec4(fromEye, 0.0) + shift;
  depth = gl_Position.w;
  gl_Position.z -= pull.x + pull.y * depth;
  faceColour = colour.rgb;
}
`;

const SOLID_FRAGMENT = `
flat in vec3 faceColour;
in vec3 fromEye;
in float depth;
uniform float ambient;
out vec4 result;
${GL_WRITE_DEPTH}
void main() {
  // The face's normal, turned towards the eye.
  vec3 n = cross(dFdx(fromEye), dFdy(fromEye));
  n = normalize(n + vec3(0.0, 0.0, 1e-20));
  n = dot(n, fromEye) > 0.0 ? -n : n;
  float sun = max(dot(n, vec3(-0.396, 0.594, 0.700)), 0.0);
  float head = max(dot(n, normalize(-fromEye)), 0.0);
  result = vec4(faceColour * (ambient + (1.0 - ambient) * (0.75 * sun + 0.35 * head)), 1.0);
  writeDepth(depth);
}
`;

export class SolidDrawing {
  /** @param {WebGL2RenderingContext} gl */
  constructor(gl) {
    this.program = new DepthProgram(gl, SOLID_VERTEX, SOLID_FRAGMENT);
    this.vertices = new GlVertices(gl, gl.DYNAMIC_DRAW, gl.FLOAT, gl.UNSIGNED_BYTE);
    this.count = 0;
  }

  /** Replaces all faces. The colour of a face is that of its last vertex. @param {SolidMesh} mesh */
  set({ positions, colours, indices }) {
    this.count = indices.length;
    this.vertices.set(0, positions);
    this.vertices.set(1, colours);
    this.vertices.setFaces(indices);
  }

  /**
   * @param {ViewCamera} camera @param {number} ambient light from everywhere, 0 to 1
   * @param {number} pull share of the depth by which it is drawn nearer to the eye
   */
  draw(camera, ambient, pull) {
    if (this.count === 0) { return; }
    const program = this.program.use(camera);
    program.setEye(camera);
    program.setPull(camera, pull);
    program.set('ambient', ambient);
    this.vertices.drawFaces(this.count);
  }

  dispose() {
    this.program.dispose();
    this.vertices.dispose();
  }
}
