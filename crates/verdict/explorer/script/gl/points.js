// Points of a cloud, each with its colour. Drawn by WebGL2.

import { GL_LOG_DEPTH, GlProgram } from './program.js';

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
uniform float logPull;
out vec4 result;
#ifdef LOG_DEPTH
${GL_LOG_DEPTH}
#endif
void main() {
  result = vec4(pointColour, 1.0);
#ifdef LOG_DEPTH
  gl_FragDepth = clamp(logDepthOf(depth) - logPull, 0.0, 1.0);
#endif
}
`;

/** Share of the depth by which points are drawn nearer to the eye: the face that they lie on hides none. */
const POINTS_PULL = 2e-3;

export class PointsDrawing {
  /** @param {WebGL2RenderingContext} gl */
  constructor(gl) {
    this.gl = gl;
    this.plain = new GlProgram(gl, POINTS_VERTEX, POINTS_FRAGMENT, []);
    /** @type {GlProgram | null} */
    this.deep = null;
    this.array = gl.createVertexArray();
    this.buffers = [gl.createBuffer(), gl.createBuffer()];
    this.count = 0;
    gl.bindVertexArray(this.array);
    gl.bindBuffer(gl.ARRAY_BUFFER, this.buffers[0]);
    gl.enableVertexAttribArray(0);
    gl.vertexAttribPointer(0, 3, gl.FLOAT, false, 0, 0);
    gl.bindBuffer(gl.ARRAY_BUFFER, this.buffers[1]);
    gl.enableVertexAttribArray(1);
    gl.vertexAttribPointer(1, 4, gl.UNSIGNED_BYTE, true, 0, 0);
    gl.bindVertexArray(null);
  }

  /** Replaces all points. @param {Float32Array} positions @param {Uint32Array} colours */
  set(positions, colours) {
    const { gl } = this;
    this.count = colours.length;
    gl.bindBuffer(gl.ARRAY_BUFFER, this.buffers[0]);
    gl.bufferData(gl.ARRAY_BUFFER, positions, gl.DYNAMIC_DRAW);
    gl.bindBuffer(gl.ARRAY_BUFFER, this.buffers[1]);
    gl.bufferData(gl.ARRAY_BUFFER, colours, gl.DYNAMIC_DRAW);
  }

  /** @param {ViewCamera} camera @param {number} size of a point, pixels of the device */
  draw(camera, size) {
    if (this.count === 0) {
      return;
    }
    const { gl } = this;
    const { isDeep, near, far } = camera;
    if (isDeep && !this.deep) {
      this.deep = new GlProgram(gl, POINTS_VERTEX, POINTS_FRAGMENT, ['LOG_DEPTH']);
    }
    const program = isDeep && this.deep ? this.deep : this.plain;
    program.use();
    const { matrix, shift, eyeHigh } = camera.forShader();
    gl.uniformMatrix4fv(program.place('matrix'), false, matrix);
    program.set('shift', ...shift);
    program.set('eyeHigh', ...eyeHigh);
    program.set('pull', (POINTS_PULL * 2 * far * near) / (far - near), 3e-7);
    program.set('size', size);
    program.set('logPull', Math.log2(1 + POINTS_PULL) / Math.log2(far / near));
    if (isDeep) {
      program.set('logDepth', 1 / near, 1 / Math.log2(far / near));
    }
    gl.disable(gl.BLEND);
    gl.enable(gl.DEPTH_TEST);
    gl.depthFunc(gl.LEQUAL);
    gl.depthMask(true);
    gl.bindVertexArray(this.array);
    gl.drawArrays(gl.POINTS, 0, this.count);
    gl.bindVertexArray(null);
  }

  dispose() {
    this.buffers.forEach((buffer) => this.gl.deleteBuffer(buffer));
    this.gl.deleteVertexArray(this.array);
    this.plain.dispose();
    this.deep?.dispose();
  }
}
