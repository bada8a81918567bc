// Points of a cloud, each with its colour. Drawn by WebGL2.

import { DepthProgram, GL_WRITE_DEPTH } from './program.js';
import { GlVertices } from './vertices.js';

/** @typedef {import('../view3d/camera.js').ViewCamera} ViewCamera */

const POINTS_VERTEX = `
layout(location = 0) in vec3 position;
layout(location = 1) in vec4 colour;
uniform mat4 matrix;
uniform vec4 shift;
uniform vec3 eyeHigh;
uniform vec2 pull; // towards the eye: of 1 / depth, constant
uniform float size;
flat out vec3 pointColour;
out float depth;
void main() {
  gl_Position = matrix * vec4(position - eyeHigh, 0.0) + shift;
  depth = gl_Position.w;
  gl_Position.z -= pull.x + pull.y * depth;
  gl_PointSize = size;
  pointColour = colour.rgb;
}
`;

const POINTS_FRAGMENT = `
flat in vec3 pointColour;
in float depth;
out vec4 result;
${GL_WRITE_DEPTH}
void main() {
  result = vec4(pointColour, 1.0);
  writeDepth(depth);
}
`;

/** Share of the depth by which points are drawn nearer to the eye: the face that they lie on hides none. */
const POINTS_PULL = 2e-3;

export class PointsDrawing {
  /** @param {WebGL2RenderingContext} gl */
  constructor(gl) {
    this.program = new DepthProgram(gl, POINTS_VERTEX, POINTS_FRAGMENT);
    this.vertices = new GlVertices(gl, gl.DYNAMIC_DRAW, gl.FLOAT, gl.UNSIGNED_BYTE);
    this.count = 0;
  }

  /** Replaces all points. @param {Float32Array} positions @param {Uint32Array} colours */
  set(positions, colours) {
    this.count = colours.length;
    this.vertices.set(0, positions);
    this.vertices.set(1, colours);
  }

  /** @param {ViewCamera} camera @param {number} size of a point, pixels of the device */
  draw(camera, size) {
    if (this.count === 0) {
      return;
    }
    const program = this.program.use(camera);
    program.setEye(camera);
    program.setPull(camera, POINTS_PULL);
    program.set('size', size);
    this.vertices.drawPoints(this.count);
  }

  dispose() {
    this.program.dispose();
    this.vertices.dispose();
  }
}
