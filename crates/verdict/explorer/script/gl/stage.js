// The WebGL2 canvas: its context, also when it is lost and comes back, and the drawing of one frame.

import { TerrainDrawing } from './mesh.js';
import { StrokeDrawing } from './lines.js';
import { coarseCellSize, coarseTerrain } from '../view3d/coarse.js';

/** @typedef {import('../view3d/terrain.js').Terrain} Terrain */
/** @typedef {import('../view3d/camera.js').ViewCamera} ViewCamera */
/** @typedef {import('../view3d/drawing.js').SceneDrawing} SceneDrawing */
/** @typedef {import('./mesh.js').TerrainLook} TerrainLook */
/** @typedef {import('./mesh.js').Rgb} Rgb */
/** @typedef {import('../view3d/theme.js').ColourName} ColourName */

/** From so many faces on there is a coarse terrain, for slow pictures while the eye moves. */
const FACES_TO_COARSEN = 60000;
/** Largest size of its cells in the middle of the picture, CSS pixels. */
const COARSE_PIXELS = 16;

/** Milliseconds between questions whether a frame is done. */
const FENCE_PAUSE = 6;

/**
 * Whether a context computes its pictures without a graphics processor.
 * @param {WebGL2RenderingContext} gl
 */
function isSoftwareContext(gl) {
  const names = gl.getExtension('WEBGL_debug_renderer_info');
  const name = String(gl.getParameter(names ? names.UNMASKED_RENDERER_WEBGL : gl.RENDERER));
  return /swiftshader|llvmpipe|software|basic render/i.test(name);
}

/**
 * Whether this browser has no graphics processor. A canvas has to be told before its context can be asked.
 */
function isSoftwareHere() {
  const gl = document.createElement('canvas').getContext('webgl2');
  if (!gl) return false;
  const isSoftware = isSoftwareContext(gl);
  gl.getExtension('WEBGL_lose_context')?.loseContext();
  return isSoftware;
}

/** A canvas with WebGL2. */
export class GlStage {
  /**
   * @param {HTMLCanvasElement} canvas
   * @param {(isLost: boolean) => void} onLoss called when the context is lost, and when it is back
   */
  constructor(canvas, onLoss) {
    this.canvas = canvas;
    this.gl = GlStage.#context(canvas);
    /** @type {TerrainDrawing | null} */
    this.terrainDrawing = null;
    /** The coarse terrain, once it is needed. @type {TerrainDrawing | null} */
    this.coarseDrawing = null;
    /** @type {{terrain: Terrain, faceOf: Uint32Array} | null} */
    this.coarse = null;
    /** @type {StrokeDrawing | null} */
    this.strokes = null;
    /** @type {{terrain: Terrain, ramp: Uint8Array, colours: Uint32Array} | null} */
    this.given = null;
    this.isLost = false;
    /** How often the context was lost. */
    this.losses = 0;
    this.stop = new AbortController();
    const { signal } = this.stop;
    canvas.addEventListener(
      'webglcontextlost',
      (event) => {
        // Without this the browser never gives the context back.
        event.preventDefault();
        this.isLost = true;
        this.losses += 1;
        this.forget();
        onLoss(true);
      },
      { signal },
    );
    canvas.addEventListener(
      'webglcontextrestored',
      () => {
        this.isLost = false;
        this.#build();
        onLoss(false);
      },
      { signal },
    );
  }

  /** @param {HTMLCanvasElement} canvas @returns {WebGL2RenderingContext} */
  static #context(canvas) {
    // Without a graphics processor, smooth edges of the terrain would take more than half of the time. Lines
    // are smooth anyway.
    const gl = canvas.getContext('webgl2', { alpha: false, depth: true, antialias: !isSoftwareHere() });
    if (!gl) throw new Error('this browser gives no WebGL2');
    return gl;
  }

  /** The context is lost, and with it what a stage beyond this one has in it. */
  forget() {}

  /** Whether the picture is computed without a graphics processor. */
  get isSoftware() {
    return isSoftwareContext(this.gl);
  }

  /**
   * Sets the terrain.
   * @param {Terrain} terrain
   * @param {Uint8Array} ramp
   * @param {Uint32Array} colours one each face
   */
  setTerrain(terrain, ramp, colours) {
    this.given = { terrain, ramp, colours };
    this.coarse = null;
    this.#build();
  }

  /** Sets the colour of each face. @param {Uint32Array} colours */
  setColours(colours) {
    if (this.given) this.given.colours = colours;
    if (this.isLost) return;
    this.terrainDrawing?.setColours(colours);
    this.#colourCoarse();
  }

  #colourCoarse() {
    const { coarse, coarseDrawing, given } = this;
    if (coarse && coarseDrawing && given)
      coarseDrawing.setColours(coarse.faceOf.map((face) => given.colours[face]));
  }

  /**
   * The terrain to be drawn.
   * @param {ViewCamera} camera
   * @param {boolean} isCoarse whether the picture must come fast
   */
  #drawingOf(camera, isCoarse) {
    const { gl, given } = this;
    if (!isCoarse || !given || given.terrain.faceCount < FACES_TO_COARSEN) return this.terrainDrawing;
    // From near by the coarse terrain would be another terrain.
    if (coarseCellSize(given.terrain) > COARSE_PIXELS * camera.metresPerPixel) return this.terrainDrawing;
    if (!this.coarseDrawing) {
      this.coarse ??= coarseTerrain(given.terrain);
      this.coarseDrawing = new TerrainDrawing(gl, this.coarse.terrain, given.ramp);
      this.#colourCoarse();
    }
    return this.coarseDrawing;
  }

  #build() {
    const { gl, given } = this;
    if (!given || gl.isContextLost()) return;
    this.terrainDrawing = new TerrainDrawing(gl, given.terrain, given.ramp);
    this.terrainDrawing.setColours(given.colours);
    this.coarseDrawing = null;
    this.strokes = new StrokeDrawing(gl);
  }

  /**
   * Draws a frame.
   * @param {ViewCamera} camera
   * @param {number} pixelRatio device pixels per CSS pixel
   * @param {TerrainLook} look
   * @param {SceneDrawing[]} drawings
   * @param {Record<ColourName, Rgb>} colours
   * @param {number} slack share of the depth by which the terrain may be drawn too near to the eye
   * @param {boolean} isCoarse whether the picture must come fast
   */
  draw(camera, pixelRatio, look, drawings, colours, slack, isCoarse) {
    if (!this.begin(camera, pixelRatio, colours.sky)) return;
    this.#drawingOf(camera, isCoarse)?.draw(camera, look, pixelRatio);
    this.drawStrokes(camera, pixelRatio, drawings, colours, slack);
  }

  /**
   * Begins a frame: the canvas has its size, and is empty.
   * @param {ViewCamera} camera
   * @param {number} pixelRatio
   * @param {Rgb} sky
   * @returns {boolean} false while the context is lost
   */
  begin(camera, pixelRatio, sky) {
    const { gl, canvas } = this;
    if (this.isLost || gl.isContextLost()) return false;
    const width = Math.max(1, Math.round(camera.width * pixelRatio));
    const height = Math.max(1, Math.round(camera.height * pixelRatio));
    if (canvas.width !== width || canvas.height !== height) {
      canvas.width = width;
      canvas.height = height;
    }
    gl.viewport(0, 0, width, height);
    gl.depthMask(true);
    gl.clearColor(...sky, 1);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    return true;
  }

  /**
   * Draws lines and areas over what is drawn already.
   * @param {ViewCamera} camera
   * @param {number} pixelRatio
   * @param {SceneDrawing[]} drawings
   * @param {Record<string, Rgb>} colours
   * @param {number} slack share of the depth by which faces may be drawn too near to the eye
   */
  drawStrokes(camera, pixelRatio, drawings, colours, slack) {
    const { strokes } = this;
    if (!strokes) return;
    strokes.begin(camera, pixelRatio);
    for (const drawing of drawings) {
      for (const { points, colour, opacity } of drawing.areas)
        strokes.area(points, [...colours[colour], opacity]);
      for (const { from, to, colour, opacity, look: lineLook } of drawing.lines) {
        strokes.line(from, to, [...colours[colour], opacity], lineLook);
      }
    }
    strokes.draw(slack);
  }

  /** Calls back once everything that was asked for is drawn. @param {() => void} done */
  whenDrawn(done) {
    const { gl, losses } = this;
    const fence = gl.fenceSync(gl.SYNC_GPU_COMMANDS_COMPLETE, 0);
    if (!fence || this.isLost) return;
    gl.flush();
    const ask = () => {
      // A fence of a context that was lost means nothing to the next one.
      if (this.stop.signal.aborted || this.losses !== losses) return;
      if (gl.clientWaitSync(fence, 0, 0) === gl.TIMEOUT_EXPIRED) {
        setTimeout(ask, FENCE_PAUSE);
        return;
      }
      gl.deleteSync(fence);
      done();
    };
    setTimeout(ask, FENCE_PAUSE);
  }

  /** Waits until everything is drawn. */
  finish() {
    const pixel = new Uint8Array(4);
    this.gl.readPixels(0, 0, 1, 1, this.gl.RGBA, this.gl.UNSIGNED_BYTE, pixel);
  }

  dispose() {
    this.stop.abort();
    this.terrainDrawing?.dispose();
    this.coarseDrawing?.dispose();
    this.strokes?.dispose();
    // The browser allows few contexts; this one is given back at once.
    this.gl.getExtension('WEBGL_lose_context')?.loseContext();
  }
}
