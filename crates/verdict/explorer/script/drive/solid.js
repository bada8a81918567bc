// Solid coloured faces that change from frame to frame: the cells of the map, and the vehicle. Drawn by WebGL2.

import { GL_LOG_DEPTH, GlProgram } from '../gl/program.js';

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
uniform float logPull;
out vec4 result;
#ifdef LOG_DEPTH
${GL_LOG_DEPTH}
#endif
void main() {
  // The face's normal, turned towards the eye.
  vec3 n = cross(dFdx(fromEye), dFdy(fromEye));
  n = normalize(n + vec3(0.0, 0.0, 1e-20));
  n = dot(n, fromEye) > 0.0 ? -n : n;
  float sun = max(dot(n, vec3(-0.396, 0.594, 0.700)), 0.0);
  float head = max(dot(n, normalize(-fromEye)), 0.0);
  result = vec4(faceColour * (ambient + (1.0 - ambient) * (0.75 * sun + 0.35 * head)), 1.0);
#ifdef LOG_DEPTH
  gl_FragDepth = clamp(logDepthOf(depth) - logPull, 0.0, 1.0);
#endif
}
`;

export class SolidDrawing {
  /** @param {WebGL2RenderingContext} gl */
  constructor(gl) {
    this.gl = gl;
    this.plain = new GlProgram(gl, SOLID_VERTEX, SOLID_FRAGMENT, []);
    /** @type {GlProgram | null} */
    this.deep = null;
    this.array = gl.createVertexArray();
    this.buffers = [gl.createBuffer(), gl.createBuffer(), gl.createBuffer()];
    this.count = 0;
    gl.bindVertexArray(this.array);
    gl.bindBuffer(gl.ARRAY_BUFFER, this.buffers[0]);
    gl.enableVertexAttribArray(0);
    gl.vertexAttribPointer(0, 3, gl.FLOAT, false, 0, 0);
    gl.bindBuffer(gl.ARRAY_BUFFER, this.buffers[1]);
    gl.enableVertexAttribArray(1);
    gl.vertexAttribPointer(1, 4, gl.UNSIGNED_BYTE, true, 0, 0);
    gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, this.buffers[2]);
    gl.bindVertexArray(null);
  }

  /** Replaces all faces. The colour of a face is that of its last vertex. @param {SolidMesh} mesh */
  set({ positions, colours, indices }) {
    const { gl } = this;
    this.count = indices.length;
    gl.bindVertexArray(this.array);
    gl.bindBuffer(gl.ARRAY_BUFFER, this.buffers[0]);
    gl.bufferData(gl.ARRAY_BUFFER, positions, gl.DYNAMIC_DRAW);
    gl.bindBuffer(gl.ARRAY_BUFFER, this.buffers[1]);
    gl.bufferData(gl.ARRAY_BUFFER, colours, gl.DYNAMIC_DRAW);
    gl.bufferData(gl.ELEMENT_ARRAY_BUFFER, indices, gl.DYNAMIC_DRAW);
    gl.bindVertexArray(null);
  }

  /**
   * @param {ViewCamera} camera @param {number} ambient light from everywhere, 0 to 1
   * @param {number} pull share of the depth by which it is drawn nearer to the eye
   */
  draw(camera, ambient, pull) {
    if (this.count === 0) { return; }
    const { gl } = this;
    const { isDeep, near, far } = camera;
    if (isDeep && !this.deep) {
      this.deep = new GlProgram(gl, SOLID_VERTEX, SOLID_FRAGMENT, ['LOG_DEPTH']);
    }
    const program = isDeep && this.deep ? this.deep : this.plain;
    program.use();
    const { matrix, shift, eyeHigh } = camera.forShader();
    gl.uniformMatrix4fv(program.place('matrix'), false, matrix);
    program.set('shift', ...shift);
    program.set('eyeHigh', ...eyeHigh);
    program.set('pull', pull * 2 * far * near / (far - near), pull > 0 ? 3e-7 : 0);
    program.set('ambient', ambient);
    program.set('logPull', Math.log2(1 + pull) / Math.log2(far / near));
    if (isDeep) {
      program.set('logDepth', 1 / near, 1 / Math.log2(far / near));
    }
    gl.disable(gl.BLEND);
    gl.disable(gl.CULL_FACE);
    gl.enable(gl.DEPTH_TEST);
    gl.depthFunc(gl.LEQUAL);
    gl.depthMask(true);
    gl.bindVertexArray(this.array);
    gl.drawElements(gl.TRIANGLES, this.count, gl.UNSIGNED_INT, 0);
    gl.bindVertexArray(null);
  }

  dispose() {
    this.buffers.forEach((buffer) => this.gl.deleteBuffer(buffer));
    this.gl.deleteVertexArray(this.array);
    this.plain.dispose();
    this.deep?.dispose();
  }
}
