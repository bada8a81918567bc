// A WebGL2 program: two shaders, compiled and linked, with its uniforms by name.

/** @typedef {import('../view3d/camera.js').ViewCamera} ViewCamera */

/** The part of a fragment shader that writes logarithmic depths, for scenes of very unlike depths. */
export const GL_WRITE_DEPTH = `
#ifdef LOG_DEPTH
uniform vec2 logDepth; // 1 / near, 1 / log2(far / near)
uniform float logPull; // towards the eye
void writeDepth(float depth) {
  float share = clamp(log2(max(depth * logDepth.x, 1e-30)) * logDepth.y, 0.0, 1.0);
  gl_FragDepth = clamp(share - logPull, 0.0, 1.0);
}
#else
void writeDepth(float depth) {}
#endif
`;

/**
 * @param {WebGL2RenderingContext} gl
 * @param {number} type
 * @param {string} text
 * @returns {WebGLShader}
 */
function compileShader(gl, type, text) {
  const shader = gl.createShader(type);
  if (!shader) throw new Error('no shader: the graphics context is lost');
  gl.shaderSource(shader, text);
  gl.compileShader(shader);
  return shader;
}

/** Two shaders and their uniforms. */
export class GlProgram {
  /**
   * @param {WebGL2RenderingContext} gl
   * @param {string} vertexText
   * @param {string} fragmentText
   * @param {string[]} words names that are defined in both
   */
  constructor(gl, vertexText, fragmentText, words) {
    this.gl = gl;
    const head = ['#version 300 es', ...words.map((word) => `#define ${word}`), 'precision highp float;', ''];
    const vertex = compileShader(gl, gl.VERTEX_SHADER, head.join('\n') + vertexText);
    const fragment = compileShader(gl, gl.FRAGMENT_SHADER, head.join('\n') + fragmentText);
    const program = gl.createProgram();
    if (!program) throw new Error('no program: the graphics context is lost');
    gl.attachShader(program, vertex);
    gl.attachShader(program, fragment);
    gl.linkProgram(program);
    if (!gl.getProgramParameter(program, gl.LINK_STATUS) && !gl.isContextLost()) {
      const reasons = [
        gl.getProgramInfoLog(program),
        gl.getShaderInfoLog(vertex),
        gl.getShaderInfoLog(fragment),
      ];
      throw new Error(`a shader was refused: ${reasons.filter(Boolean).join(' ')}`);
    }
    gl.deleteShader(vertex);
    gl.deleteShader(fragment);
    this.program = program;
    /** @type {Map<string, WebGLUniformLocation | null>} */
    this.places = new Map();
  }

  use() {
    this.gl.useProgram(this.program);
  }

  /** @param {string} name */
  place(name) {
    if (!this.places.has(name)) this.places.set(name, this.gl.getUniformLocation(this.program, name));
    return this.places.get(name) ?? null;
  }

  /** Sets a number or a vector of up to four numbers. @param {string} name @param {...number} values */
  set(name, ...values) {
    const place = this.place(name);
    if (!place) return;
    if (values.length === 1) this.gl.uniform1f(place, values[0]);
    else if (values.length === 2) this.gl.uniform2fv(place, values);
    else if (values.length === 3) this.gl.uniform3fv(place, values);
    else this.gl.uniform4fv(place, values);
  }

  /** Sets where the eye is. @param {ViewCamera} camera */
  setEye(camera) {
    const { matrix, shift, eyeHigh } = camera.forShader();
    this.gl.uniformMatrix4fv(this.place('matrix'), false, matrix);
    this.set('shift', ...shift);
    this.set('eyeHigh', ...eyeHigh);
  }

  /** Draws nearer to the eye than things are. @param {ViewCamera} camera @param {number} share of the depth */
  setPull({ near, far }, share) {
    this.set('pull', (share * 2 * far * near) / (far - near), share > 0 ? 3e-7 : 0);
    this.set('logPull', Math.log2(1 + share) / Math.log2(far / near));
  }

  dispose() {
    this.gl.deleteProgram(this.program);
  }
}

/** One program in all its forms, each compiled when it is first needed: for usual and for deep pictures. */
export class DepthProgram {
  /** @param {WebGL2RenderingContext} gl @param {string} vertexText @param {string} fragmentText */
  constructor(gl, vertexText, fragmentText) {
    this.gl = gl;
    this.vertexText = vertexText;
    this.fragmentText = fragmentText;
    /** Forms by the words that are defined in both shaders. @type {Map<string, GlProgram>} */
    this.forms = new Map();
  }

  /**
   * The form for what a camera sees, in use.
   * @param {ViewCamera} camera @param {...string} words names that are defined in both shaders
   */
  use(camera, ...words) {
    const all = camera.isDeep ? ['LOG_DEPTH', ...words] : words;
    const key = all.join(' ');
    const form = this.forms.get(key) ?? new GlProgram(this.gl, this.vertexText, this.fragmentText, all);
    this.forms.set(key, form);
    form.use();
    if (camera.isDeep) form.set('logDepth', 1 / camera.near, 1 / Math.log2(camera.far / camera.near));
    return form;
  }

  dispose() {
    this.forms.forEach((form) => form.dispose());
  }
}
