// Vertices on the graphics processor: a buffer for each attribute, and one for the corners of faces.

export class GlVertices {
  /**
   * @param {WebGL2RenderingContext} gl
   * @param {number} usage how often they change: `gl.STATIC_DRAW`, `gl.DYNAMIC_DRAW`
   * @param {...number} types of the attributes 0, 1, ...: `gl.FLOAT` for three numbers of a place, else four bytes as
   *   shares of 1
   */
  constructor(gl, usage, ...types) {
    this.gl = gl;
    this.usage = usage;
    this.array = gl.createVertexArray();
    this.buffers = types.map(() => gl.createBuffer());
    this.corners = gl.createBuffer();
    gl.bindVertexArray(this.array);
    types.forEach((type, index) => {
      gl.bindBuffer(gl.ARRAY_BUFFER, this.buffers[index]);
      gl.enableVertexAttribArray(index);
      gl.vertexAttribPointer(index, type === gl.FLOAT ? 3 : 4, type, type !== gl.FLOAT, 0, 0);
    });
    gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, this.corners);
    gl.bindVertexArray(null);
  }

  /** Replaces an attribute of all vertices. @param {number} index @param {ArrayBufferView} numbers */
  set(index, numbers) {
    const { gl } = this;
    gl.bindBuffer(gl.ARRAY_BUFFER, this.buffers[index]);
    gl.bufferData(gl.ARRAY_BUFFER, numbers, this.usage);
  }

  /** Replaces all faces. @param {Uint32Array} corners vertices, three each face */
  setFaces(corners) {
    const { gl } = this;
    gl.bindVertexArray(this.array);
    gl.bufferData(gl.ELEMENT_ARRAY_BUFFER, corners, this.usage);
    gl.bindVertexArray(null);
  }

  /** Draws points that hide what is behind them. @param {number} count */
  drawPoints(count) {
    this.#draw((gl) => gl.drawArrays(gl.POINTS, 0, count));
  }

  /** Draws faces that hide what is behind them. @param {number} count corners */
  drawFaces(count) {
    this.#draw((gl) => gl.drawElements(gl.TRIANGLES, count, gl.UNSIGNED_INT, 0));
  }

  /** @param {(gl: WebGL2RenderingContext) => void} call */
  #draw(call) {
    const { gl } = this;
    gl.disable(gl.BLEND);
    gl.disable(gl.CULL_FACE);
    gl.enable(gl.DEPTH_TEST);
    gl.depthFunc(gl.LEQUAL);
    gl.depthMask(true);
    gl.bindVertexArray(this.array);
    call(gl);
    gl.bindVertexArray(null);
  }

  dispose() {
    [...this.buffers, this.corners].forEach((buffer) => this.gl.deleteBuffer(buffer));
    this.gl.deleteVertexArray(this.array);
  }
}
