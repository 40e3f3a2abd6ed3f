// The robot in its room: WebGL2, and a plain 2D drawing where there is none.

import { capsules, FLOOR_Z, nozzleTip, SHADOWS } from './arm.js';
import { eye, projection } from './camera.js';
import { PAINT } from './palette.js';
import { RobotSketch } from './robot_sketch.js';
import { PLANE_VERTEX, planeFragment, TUBE_FRAGMENT, TUBE_VERTEX } from './shaders.js';
import { WallPicture } from './wall_picture.js';

const ROOM = {
  light: { floor: [0.862, 0.872, 0.862], near: [0.925, 0.932, 0.925], far: [0.965, 0.968, 0.962], dim: 1 },
  dark: { floor: [0.15, 0.18, 0.2], near: [0.115, 0.14, 0.158], far: [0.085, 0.105, 0.12], dim: 0.82 },
};
const TUBE_FLOATS = 11; // a, b, two radii, colour
const MAX_RATIO = 1.5;

// wallX: distance of the wall [m]; maze as for Frame.
export function robotView(canvas, wallX, maze) {
  const picture = new WallPicture(maze);
  const gl = canvas.getContext('webgl2', { antialias: true, alpha: false, powerPreference: 'low-power' });
  return gl ? new RobotView(canvas, gl, picture, wallX) : new RobotSketch(canvas, picture, wallX);
}

class RobotView {
  constructor(canvas, gl, picture, wallX) {
    Object.assign(this, { canvas, gl, picture, wallX, pixel: new Uint8Array(4) });
    this.#build();
    canvas.addEventListener('webglcontextlost', (event) => {
      event.preventDefault();
      this.lost = true;
    });
    canvas.addEventListener('webglcontextrestored', () => {
      this.lost = false;
      this.#build();
    });
  }

  // state: a State of the source; path: what is painted; look: how the cursor looks; theme: 'light' or 'dark';
  // size: { width, height [CSS px], ratio } of its place on the page.
  draw(state, path, look, theme, size) {
    const { canvas, gl } = this;
    if (this.lost) return;
    const ratio = Math.min(size.ratio, MAX_RATIO);
    const width = Math.round(size.width * ratio);
    const height = Math.round(size.height * ratio);
    if (canvas.width !== width || canvas.height !== height) Object.assign(canvas, { width, height });
    this.picture.draw(state, path, look);
    const tubes = capsules(state.q);
    const view = projection(width / height);
    const room = ROOM[theme];
    gl.viewport(0, 0, width, height);
    gl.clearColor(...room.far, 1);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    this.#drawPlanes(tubes, view, room);
    this.#drawTubes(tubes, view, room.dim, 0);
    if (state.spraying) this.#drawSpray(state, view);
  }

  // Waits until the picture is drawn, so that its cost can be measured: drawing only queues it.
  finish() {
    const { gl } = this;
    gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, this.pixel);
  }

  dispose() {
    this.gl.getExtension('WEBGL_lose_context')?.loseContext();
  }

  #build() {
    const { gl } = this;
    this.tubes = program(gl, TUBE_VERTEX, TUBE_FRAGMENT);
    this.planes = program(gl, PLANE_VERTEX, planeFragment(SHADOWS));
    this.#buildTubes();
    this.#buildPlanes();
    this.texture = gl.createTexture();
    gl.bindTexture(gl.TEXTURE_2D, this.texture);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, gl.LINEAR);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_WRAP_S, gl.CLAMP_TO_EDGE);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_WRAP_T, gl.CLAMP_TO_EDGE);
    gl.enable(gl.DEPTH_TEST);
  }

  #buildTubes() {
    const { gl, tubes } = this;
    const { vertices, indices } = capsuleMesh(20, 5);
    this.mesh = gl.createVertexArray();
    gl.bindVertexArray(this.mesh);
    upload(gl, gl.ARRAY_BUFFER, vertices);
    attribute(gl, tubes, 'normal', 3, 16, 0);
    attribute(gl, tubes, 'end', 1, 16, 12);
    upload(gl, gl.ELEMENT_ARRAY_BUFFER, indices);
    this.indexCount = indices.length;
    this.instances = gl.createBuffer();
    gl.bindBuffer(gl.ARRAY_BUFFER, this.instances);
    let offset = 0;
    for (const [name, size] of [['a', 3], ['b', 3], ['radius', 2], ['colour', 3]]) {
      attribute(gl, tubes, name, size, 4 * TUBE_FLOATS, offset, 1);
      offset += 4 * size;
    }
  }

  #buildPlanes() {
    const { gl, wallX, picture } = this;
    const { left, right, top, bottom } = picture.extent;
    const back = wallX + 0.012;
    const quad = (corners) => [0, 1, 2, 0, 2, 3].flatMap((i) => corners[i]);
    const vertices = new Float32Array([
      ...quad([[-4, -6, FLOOR_Z, 0, 0], [back, -6, FLOOR_Z, 0, 0], [back, 4, FLOOR_Z, 0, 0], [-4, 4, FLOOR_Z, 0, 0]]),
      ...quad([[back, -9, FLOOR_Z, 0, 0], [back, 6, FLOOR_Z, 0, 0], [back, 6, 4, 0, 0], [back, -9, 4, 0, 0]]),
      ...quad([[wallX, left, top, 0, 0], [wallX, right, top, 1, 0], [wallX, right, bottom, 1, 1], [wallX, left, bottom, 0, 1]]),
    ]);
    this.quads = gl.createVertexArray();
    gl.bindVertexArray(this.quads);
    upload(gl, gl.ARRAY_BUFFER, vertices);
    attribute(gl, this.planes, 'point', 3, 20, 0);
    attribute(gl, this.planes, 'uv', 2, 20, 12);
  }

  #drawPlanes(tubes, view, room) {
    const { gl, planes } = this;
    gl.useProgram(planes);
    gl.bindTexture(gl.TEXTURE_2D, this.texture);
    gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA, gl.RGBA, gl.UNSIGNED_BYTE, this.picture.canvas);
    const at = (name) => gl.getUniformLocation(planes, name);
    gl.uniformMatrix4fv(at('view'), false, view);
    gl.uniform3fv(at('floorColour'), room.floor);
    gl.uniform3fv(at('nearRoom'), room.near);
    gl.uniform3fv(at('farRoom'), room.far);
    const shading = tubes.slice(0, SHADOWS);
    gl.uniform4fv(at('tubeA'), shading.flatMap((t) => [...t.a, t.ra]));
    gl.uniform4fv(at('tubeB'), shading.flatMap((t) => [...t.b, t.rb]));
    gl.bindVertexArray(this.quads);
    for (const surface of [0, 1, 2]) {
      gl.uniform1i(at('surface'), surface);
      gl.drawArrays(gl.TRIANGLES, 6 * surface, 6);
    }
  }

  #drawTubes(tubes, view, dim, spray) {
    const { gl } = this;
    gl.useProgram(this.tubes);
    const at = (name) => gl.getUniformLocation(this.tubes, name);
    gl.uniformMatrix4fv(at('view'), false, view);
    gl.uniform3fv(at('eye'), eye);
    gl.uniform1f(at('dim'), dim);
    gl.uniform1f(at('spray'), spray);
    gl.bindVertexArray(this.mesh);
    gl.bindBuffer(gl.ARRAY_BUFFER, this.instances);
    const floats = tubes.flatMap((t) => [...t.a, ...t.b, t.ra, t.rb, ...t.colour]);
    gl.bufferData(gl.ARRAY_BUFFER, new Float32Array(floats), gl.DYNAMIC_DRAW);
    gl.drawElementsInstanced(gl.TRIANGLES, this.indexCount, gl.UNSIGNED_SHORT, 0, tubes.length);
  }

  #drawSpray(state, view) {
    const { gl } = this;
    gl.enable(gl.BLEND);
    gl.blendFunc(gl.SRC_ALPHA, gl.ONE_MINUS_SRC_ALPHA);
    const colour = PAINT.map((v) => v / 255);
    const cone = { a: nozzleTip(state.q), b: [this.wallX - 0.004, state.y, state.z], ra: 0.005, rb: 0.012, colour };
    this.#drawTubes([cone], view, 1, 1);
    gl.disable(gl.BLEND);
  }
}

// A ball cut at its equator: the shader pulls its halves to the ends of a capsule.
function capsuleMesh(around, up) {
  const vertices = [];
  const indices = [];
  const rows = [];
  for (let i = 0; i <= up; i++) rows.push([-Math.PI / 2 + (i * Math.PI) / 2 / up, 0]);
  for (let i = 0; i <= up; i++) rows.push([(i * Math.PI) / 2 / up, 1]);
  for (const [latitude, end] of rows) {
    for (let j = 0; j <= around; j++) {
      const longitude = (2 * Math.PI * j) / around;
      const c = Math.cos(latitude);
      vertices.push(c * Math.cos(longitude), c * Math.sin(longitude), Math.sin(latitude), end);
    }
  }
  for (let i = 0; i + 1 < rows.length; i++) {
    for (let j = 0; j < around; j++) {
      const k = i * (around + 1) + j;
      indices.push(k, k + 1, k + around + 2, k, k + around + 2, k + around + 1);
    }
  }
  return { vertices: new Float32Array(vertices), indices: new Uint16Array(indices) };
}

function program(gl, vertex, fragment) {
  const linked = gl.createProgram();
  for (const [kind, source] of [[gl.VERTEX_SHADER, vertex], [gl.FRAGMENT_SHADER, fragment]]) {
    const shader = gl.createShader(kind);
    gl.shaderSource(shader, source);
    gl.compileShader(shader);
    gl.attachShader(linked, shader);
  }
  gl.linkProgram(linked);
  if (!gl.getProgramParameter(linked, gl.LINK_STATUS) && !gl.isContextLost()) {
    throw new Error(`robot view: ${gl.getProgramInfoLog(linked)}`);
  }
  return linked;
}

function upload(gl, target, content) {
  gl.bindBuffer(target, gl.createBuffer());
  gl.bufferData(target, content, gl.STATIC_DRAW);
}

function attribute(gl, linked, name, size, stride, offset, divisor = 0) {
  const place = gl.getAttribLocation(linked, name);
  gl.enableVertexAttribArray(place);
  gl.vertexAttribPointer(place, size, gl.FLOAT, false, stride, offset);
  gl.vertexAttribDivisor(place, divisor);
}
