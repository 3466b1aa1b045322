// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Draws surfaces with WebGL2. Coordinates come as 65535ths of a surface's box; matrices are made in double precision.
import {Occlusion, openness} from './occlusion.js';

const meshVertex = `#version 300 es
layout(location = 0) in vec3 place;
layout(location = 1) in vec2 octahedron;
layout(location = 2) in float colorPlace;
uniform mat4 clip, toEye;
uniform mat3 toView;
out vec3 normal, position, inBox;
out float colorAt;
flat out float noData;
void main() {
  gl_Position = clip * vec4(place, 1.0);
  inBox = place;
  position = (toEye * vec4(place, 1.0)).xyz;
  vec3 n = vec3(octahedron, 1.0 - abs(octahedron.x) - abs(octahedron.y));
  if (n.z < 0.0) n.xy = (1.0 - abs(n.yx)) * vec2(n.x < 0.0 ? -1.0 : 1.0, n.y < 0.0 ? -1.0 : 1.0);
  normal = toView * n;
  noData = colorPlace > 65534.5 ? 1.0 : 0.0;
  colorAt = colorPlace / 65534.0;
}`;

const inPlace = `
in vec3 inBox;
in float colorAt;`;
const uncut = `${inPlace}
void leaveOut() {}`;
// Beyond a plane nothing is drawn, nor of a class that is hidden; places without data, above 1, are of no class.
const cut = `${inPlace}
uniform vec4 cuts[6];
uniform int cutCount, classCount, hidden;
void leaveOut() {
  if (classCount > 0 && colorAt <= 1.0 && (hidden >> min(int(colorAt * float(classCount)), classCount - 1) & 1) == 1) discard;
  for (int i = 0; i < cutCount; ++i) if (dot(cuts[i].xyz, inBox) > cuts[i].w) discard;
}`;

// Light as in src/render/kernels/mesh.glsl.
const meshFragment = (cut) => `#version 300 es
precision highp float;
in vec3 normal, position;
flat in float noData;
uniform vec4 color;         // linear, as noDataColor
uniform vec3 noDataColor;
uniform sampler2D map;
uniform bool mapped, faces;
out vec4 pixel;
${cut}
${openness}
vec3 linear(vec3 c) { return mix(c / 12.92, pow((c + 0.055) / 1.055, vec3(2.4)), step(0.04045, c)); }
vec3 coded(vec3 c) { return mix(12.92 * c, 1.055 * pow(c, vec3(1.0 / 2.4)) - 0.055, step(0.0031308, c)); }
void main() {
  vec3 toEye = parallel ? vec3(0.0, 0.0, 1.0) : normalize(-position);
  vec3 face = cross(dFdx(position), dFdy(position));
  leaveOut();
  face = dot(face, face) > 0.0 ? normalize(face) : toEye;
  if (dot(face, toEye) < 0.0) face = -face;
  vec3 towards = face;
  if (!faces && dot(normal, normal) > 0.25) towards = normalize(normal);
  if (dot(towards, face) < 0.0) towards = -towards;
  float facing = clamp(dot(towards, toEye), 0.0, 1.0);
  float light = 0.16 + 0.84 * facing + 0.22 * (0.5 + 0.5 * towards.y) * (1.0 - facing);
  vec3 base = color.rgb;
  if (mapped) base = noData > 0.5 ? noDataColor : linear(texture(map, vec2((clamp(colorAt, 0.0, 1.0) * 63.0 + 0.5) / 64.0, 0.5)).rgb);
  float opacity = color.a < 1.0 ? 1.0 - pow(1.0 - min(color.a, 0.999), 1.0 / max(facing, 0.2)) : 1.0;
  if (color.a >= 1.0) light *= openness();
  pixel = vec4(coded(min(vec3(1.0), base * light)), opacity);
}`;

// Depth in 24 bits: what is under the pointer.
const depthFragment = (cut) => `#version 300 es
precision highp float;
out vec4 pixel;
${cut}
void main() {
  leaveOut();
  float d = floor(gl_FragCoord.z * 16777215.0);
  pixel = vec4(mod(d, 256.0), mod(floor(d / 256.0), 256.0), floor(d / 65536.0), 255.0) / 255.0;
}`;

const lineVertex = `#version 300 es
layout(location = 0) in vec3 place;
layout(location = 2) in float colorPlace;
uniform mat4 clip;
out vec3 inBox;
out float colorAt;
void main() { inBox = place; colorAt = colorPlace / 65534.0; gl_Position = clip * vec4(place, 1.0); }`;
const lineFragment = `#version 300 es
precision highp float;
uniform vec4 color;
out vec4 pixel;
${cut}
void main() { leaveOut(); pixel = color; }`;

const boxLines = new Float32Array([0, 1, 2, 3, 4, 5, 6, 7, 0, 2, 1, 3, 4, 6, 5, 7, 0, 4, 1, 5, 2, 6, 3, 7]
  .flatMap((corner) => [corner & 1, corner >> 1 & 1, corner >> 2]));

/** Whether a boundary hides what is behind it. */
export const isSeenFirst = (opacity) => opacity > 0.5;

export function rgb(text) {
  return [1, 3, 5].map((at) => parseInt(text.slice(at, at + 2), 16) / 255);
}

const linearRgb = (text) => rgb(text).map((c) => (c <= 0.04045 ? c / 12.92 : ((c + 0.055) / 1.055) ** 2.4));

export class Scene {
  /** Throws where the browser has no WebGL2. */
  constructor(canvas) {
    this.canvas = canvas;
    this.meshes = new Map();
    this.scale = 1;      // of the pixels of the screen
    this.smooth = true;  // edges, by four samples a pixel
    this.stretch = [1, 1, 1];
    const gl = this.gl = canvas.getContext('webgl2', {antialias: false, alpha: false, powerPreference: 'high-performance'});
    if (!gl) throw new Error('This browser has no WebGL2, which draws the surfaces.');
    this.start();
    canvas.addEventListener('webglcontextlost', (event) => event.preventDefault());
    canvas.addEventListener('webglcontextrestored', () => { this.meshes.clear(); this.start(); this.onRestored?.(); });
  }

  start() {
    const gl = this.gl;
    const program = (vertex, fragment, names) => this.program(vertex, fragment, names);
    this.mesh = this.cutOrWhole(meshFragment, ['clip', 'toEye', 'toView', 'color', 'noDataColor', 'map', 'mapped', 'faces', 'parallel', 'cuts', 'cutCount', 'classCount', 'hidden',
      'occlusion', 'occlusionReach', 'open', 'depths', 'nearFar']);
    this.depth = this.cutOrWhole(depthFragment, ['clip', 'toEye', 'toView', 'cuts', 'cutCount', 'classCount', 'hidden']);
    this.line = program(lineVertex, lineFragment, ['clip', 'color', 'cuts', 'cutCount', 'classCount', 'hidden']);
    this.occlusion = new Occlusion(gl, program);
    this.warmUp();
    this.samples = {frame: gl.createFramebuffer(), color: gl.createRenderbuffer(), depth: gl.createRenderbuffer(), size: [0, 0]};
    this.map = gl.createTexture();
    this.mapColors = null;
    this.box = gl.createVertexArray();
    gl.bindVertexArray(this.box);
    gl.bindBuffer(gl.ARRAY_BUFFER, gl.createBuffer());
    gl.bufferData(gl.ARRAY_BUFFER, boxLines, gl.STATIC_DRAW);
    gl.enableVertexAttribArray(0);
    gl.vertexAttribPointer(0, 3, gl.FLOAT, false, 0, 0);
    gl.bindVertexArray(null);
    this.pickColor = gl.createRenderbuffer();
    this.pickDepth = gl.createRenderbuffer();
    this.pickFrame = gl.createFramebuffer();
    gl.bindFramebuffer(gl.FRAMEBUFFER, this.pickFrame);
    for (const [buffer, format, point] of [[this.pickColor, gl.RGBA8, gl.COLOR_ATTACHMENT0],
      [this.pickDepth, gl.DEPTH_COMPONENT24, gl.DEPTH_ATTACHMENT]]) {
      gl.bindRenderbuffer(gl.RENDERBUFFER, buffer);
      gl.renderbufferStorage(gl.RENDERBUFFER, format, 1, 1);
      gl.framebufferRenderbuffer(gl.FRAMEBUFFER, point, gl.RENDERBUFFER, buffer);
    }
    gl.bindFramebuffer(gl.FRAMEBUFFER, null);
  }

  program(vertex, fragment, names) {
    const gl = this.gl, program = gl.createProgram();
    for (const [type, source] of [[gl.VERTEX_SHADER, vertex], [gl.FRAGMENT_SHADER, fragment]]) {
      const shader = gl.createShader(type);
      gl.shaderSource(shader, source);
      gl.compileShader(shader);
      gl.attachShader(program, shader);
    }
    gl.linkProgram(program);
    if (!gl.getProgramParameter(program, gl.LINK_STATUS)) throw new Error('WebGL2: ' + gl.getProgramInfoLog(program));
    const at = {program};
    for (const name of names) at[name] = gl.getUniformLocation(program, name);
    return at;
  }

  /** Drivers compile for a state when it is drawn with first: nothing is drawn, while the grid is not there yet. */
  warmUp() {
    const gl = this.gl, key = 'nothing';
    gl.useProgram(this.mesh({cuts: [], hidden: {mask: 0}}).program);
    this.add(key, {vertices: 3, vertexBytes: new Uint8Array(24), colors: new Uint16Array(3), corners: new Uint16Array(3)});
    gl.bindVertexArray(this.meshes.get(key).array);
    gl.enable(gl.DEPTH_TEST);
    gl.drawElements(gl.TRIANGLES, 3, gl.UNSIGNED_SHORT, 0);
    this.remove(key);
  }

  /** A function that gives the program for a look: one that leaves nothing out lets depths be tested first. Compiled when it is needed. */
  cutOrWhole(fragment, names) {
    const made = [null, null];
    return ({cuts, hidden}) => {
      const isCut = cuts.length > 0 || hidden.mask !== 0 ? 1 : 0;
      return made[isCut] ??= this.program(meshVertex, fragment(isCut ? cut : uncut), names);
    };
  }

  /** Takes a mesh of a frame (link.js) over. */
  add(key, mesh) {
    const gl = this.gl;
    this.remove(key);
    const own = {count: mesh.vertices, indexed: !!mesh.corners, type: mesh.wide ? gl.UNSIGNED_INT : gl.UNSIGNED_SHORT,
      lower: mesh.lower, upper: mesh.upper, colored: !!mesh.colors, corners: mesh.corners, vertexBytes: mesh.vertexBytes, buffers: []};
    if (mesh.corners) own.count = mesh.corners.length;
    own.array = gl.createVertexArray();
    gl.bindVertexArray(own.array);
    const fill = (target, data) => {
      const buffer = gl.createBuffer();
      own.buffers.push(buffer);
      gl.bindBuffer(target, buffer);
      gl.bufferData(target, data, gl.STATIC_DRAW);
    };
    fill(gl.ARRAY_BUFFER, mesh.vertexBytes);
    gl.enableVertexAttribArray(0);
    gl.vertexAttribPointer(0, 3, gl.UNSIGNED_SHORT, true, 8, 0);
    gl.enableVertexAttribArray(1);
    gl.vertexAttribPointer(1, 2, gl.BYTE, true, 8, 6);
    if (mesh.colors) {
      fill(gl.ARRAY_BUFFER, mesh.colors);
      gl.enableVertexAttribArray(2);
      gl.vertexAttribPointer(2, 1, gl.UNSIGNED_SHORT, false, 2, 0);
    }
    if (mesh.corners) fill(gl.ELEMENT_ARRAY_BUFFER, mesh.corners);
    gl.bindVertexArray(null);
    this.meshes.set(key, own);
  }

  remove(key) {
    const own = this.meshes.get(key);
    if (!own) return;
    for (const buffer of own.buffers) this.gl.deleteBuffer(buffer);
    this.gl.deleteVertexArray(own.array);
    this.meshes.delete(key);
  }

  /** Of 64 colours, "rrggbb" one after another. */
  setMap(colors) {
    if (this.mapColors === colors) return;
    const gl = this.gl, pixels = new Uint8Array(64 * 4).fill(255);
    for (let i = 0; i < 64; ++i) for (let k = 0; k < 3; ++k) pixels[4 * i + k] = parseInt(colors.slice(6 * i + 2 * k, 6 * i + 2 * k + 2), 16);
    gl.bindTexture(gl.TEXTURE_2D, this.map);
    gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA8, 64, 1, 0, gl.RGBA, gl.UNSIGNED_BYTE, pixels);
    for (const [what, how] of [[gl.TEXTURE_MIN_FILTER, gl.LINEAR], [gl.TEXTURE_MAG_FILTER, gl.LINEAR],
      [gl.TEXTURE_WRAP_S, gl.CLAMP_TO_EDGE], [gl.TEXTURE_WRAP_T, gl.CLAMP_TO_EDGE]]) gl.texParameteri(gl.TEXTURE_2D, what, how);
    this.mapColors = colors;
  }

  aspect() { return this.canvas.clientWidth / Math.max(1, this.canvas.clientHeight); }

  resize() {
    const ratio = (window.devicePixelRatio || 1) * this.scale;
    const width = Math.max(1, Math.round(this.canvas.clientWidth * ratio)), height = Math.max(1, Math.round(this.canvas.clientHeight * ratio));
    if (this.canvas.width !== width || this.canvas.height !== height) { this.canvas.width = width; this.canvas.height = height; }
  }

  /** The frame that is drawn into. */
  beginPicture() {
    const gl = this.gl, {frame, color, depth, size} = this.samples, {width, height} = this.canvas;
    gl.bindFramebuffer(gl.FRAMEBUFFER, this.smooth ? frame : null);
    gl.viewport(0, 0, width, height);
    if (!this.smooth || (size[0] === width && size[1] === height)) return;
    this.samples.size = [width, height];
    const count = Math.min(4, gl.getParameter(gl.MAX_SAMPLES));
    for (const [buffer, format, point] of [[color, gl.RGB8, gl.COLOR_ATTACHMENT0], [depth, gl.DEPTH_COMPONENT24, gl.DEPTH_ATTACHMENT]]) {
      gl.bindRenderbuffer(gl.RENDERBUFFER, buffer);
      gl.renderbufferStorageMultisample(gl.RENDERBUFFER, count, format, width, height);
      gl.framebufferRenderbuffer(gl.FRAMEBUFFER, point, gl.RENDERBUFFER, buffer);
    }
  }

  endPicture() {
    if (!this.smooth) return;
    const gl = this.gl, {width, height} = this.canvas;
    gl.bindFramebuffer(gl.DRAW_FRAMEBUFFER, null);
    gl.blitFramebuffer(0, 0, width, height, 0, 0, width, height, gl.COLOR_BUFFER_BIT, gl.NEAREST);
    gl.invalidateFramebuffer(gl.READ_FRAMEBUFFER, [gl.COLOR_ATTACHMENT0, gl.DEPTH_ATTACHMENT]);
    gl.bindFramebuffer(gl.FRAMEBUFFER, null);
  }

  /** The matrix of a box of size 1 that lies at `lower` to `upper` of the grid. */
  clip(rows, lower, upper) {
    const out = new Float32Array(16);
    for (let r = 0; r < 4; ++r) {
      let last = rows[r][3];
      for (let c = 0; c < 3; ++c) {
        const factor = rows[r][c] * this.stretch[c];
        out[4 * c + r] = factor * (upper[c] - lower[c]);
        last += factor * lower[c];
      }
      out[12 + r] = last;
    }
    return out;
  }

  /** Planes in the coordinates of the mesh's box; slices are not cut. And classes that are hidden. */
  setCuts(program, {mesh, kind}, look) {
    const gl = this.gl, cuts = kind === 'slice' ? [] : look.cuts;
    gl.uniform1i(program.cutCount, cuts.length);
    gl.uniform1i(program.classCount, mesh.colored && look.hidden.mask ? look.hidden.count : 0);
    gl.uniform1i(program.hidden, look.hidden.mask);
    if (cuts.length === 0) return;
    gl.uniform4fv(program.cuts, cuts.flatMap(({normal, offset}) => {
      const size = Math.hypot(...normal), scaled = normal.map((n, i) => n * (mesh.upper[i] - mesh.lower[i]) / size);
      return [...scaled, (offset - normal.reduce((sum, n, i) => sum + n * mesh.lower[i], 0)) / size];
    }));
  }

  /**
   * @param surfaces  [{key, kind, color, opacity}]; keys without a mesh are passed over
   * @param look      {background, lower, upper, outline, edges, mapped, noData, line, cuts: [{normal, offset}], occlusion: 0 to 1,
   *                   hidden: {count, mask: bits} of classes, stretch: factors of the axes; lower and upper are stretched}
   */
  draw(camera, surfaces, look) {
    const gl = this.gl;
    this.resize();
    this.camera = camera;
    this.surfaces = surfaces;
    this.look = look;
    this.stretch = look.stretch;
    gl.enable(gl.DEPTH_TEST);
    const view = this.view = camera.matrix(this.aspect(), look.lower, look.upper);
    const there = surfaces.map((one) => ({...one, mesh: this.meshes.get(one.key)}))
      .filter(({mesh, opacity}) => mesh && mesh.lower && mesh.count > 0 && opacity > 0);
    const opaque = there.filter(({opacity}) => opacity >= 1), size = Math.max(...look.upper.map((u, i) => u - look.lower[i]));
    this.occlusion.find(opaque.length > 0 ? look.occlusion : 0, this.canvas, view, camera.projection === 'parallel', size, () => {
      gl.useProgram(this.depth(look).program);
      for (const one of opaque) this.drawDepth(one, view.rows, look);
    });
    this.beginPicture();
    gl.clearColor(...rgb(look.background), 1);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    if (look.outline) this.drawBox(view.rows, look);
    const program = this.mesh(look), right = camera.right();
    gl.useProgram(program.program);
    // From the eye, in the directions of the picture.
    const eye = camera.projection === 'parallel' ? camera.target : camera.target.map((t, i) => t + camera.distance * camera.direction[i]);
    this.eyeRows = [right, camera.up, camera.direction].map((axis) => [...axis, -axis.reduce((sum, v, i) => sum + v * eye[i], 0)]).concat([[0, 0, 0, 1]]);
    gl.uniform1i(program.parallel, camera.projection === 'parallel' ? 1 : 0);
    gl.uniformMatrix3fv(program.toView, false, [0, 1, 2].flatMap((i) => [right, camera.up, camera.direction].map((axis) => axis[i] / look.stretch[i])));
    this.occlusion.use(program);
    gl.uniform3fv(program.noDataColor, linearRgb(look.noData || '#b8b8b8'));
    gl.bindTexture(gl.TEXTURE_2D, this.map);
    if (look.edges) { gl.enable(gl.POLYGON_OFFSET_FILL); gl.polygonOffset(1, 1); }
    for (const one of opaque) this.drawMesh(one, view.rows, look);
    gl.disable(gl.POLYGON_OFFSET_FILL);
    // As isotet render: edges of boundary and slices, or of the surfaces where neither is there.
    const fixed = there.filter(({kind}) => kind !== 'surface');
    if (look.edges) this.drawEdges(fixed.length > 0 ? fixed : there, view.rows, look);
    this.drawTranslucent(there.filter(({opacity}) => opacity < 1), view.rows, look);
    this.endPicture();
  }

  /** Inner surfaces lie in smaller boxes: far sides from the outer to the inner, then near sides back. */
  drawTranslucent(surfaces, rows, look) {
    if (surfaces.length === 0) return;
    const gl = this.gl;
    const size = ({mesh}) => Math.hypot(...mesh.upper.map((u, i) => u - mesh.lower[i]));
    surfaces.sort((a, b) => size(b) - size(a));
    gl.enable(gl.BLEND);
    gl.blendFunc(gl.SRC_ALPHA, gl.ONE_MINUS_SRC_ALPHA);
    gl.depthMask(false);
    gl.enable(gl.CULL_FACE);
    for (const face of [gl.BACK, gl.FRONT]) {
      // Triangles are counter-clockwise from the side of higher values, which may be inside: both ways are drawn.
      gl.cullFace(face);
      for (const one of surfaces) this.drawMesh(one, rows, look);
      surfaces.reverse();
    }
    gl.disable(gl.CULL_FACE);
    gl.depthMask(true);
    gl.disable(gl.BLEND);
  }

  drawMesh(one, rows, look) {
    const gl = this.gl, {mesh, color, opacity, kind} = one, program = this.mesh(look);
    gl.uniformMatrix4fv(program.clip, false, this.clip(rows, mesh.lower, mesh.upper));
    gl.uniformMatrix4fv(program.toEye, false, this.clip(this.eyeRows, mesh.lower, mesh.upper));
    gl.uniform1i(program.faces, kind !== 'surface' ? 1 : 0);
    this.setCuts(program, one, look);
    gl.uniform4f(program.color, ...linearRgb(color), opacity);
    gl.uniform1i(program.mapped, look.mapped && mesh.colored ? 1 : 0);
    gl.bindVertexArray(mesh.array);
    if (mesh.indexed) gl.drawElements(gl.TRIANGLES, mesh.count, mesh.type, 0);
    else gl.drawArrays(gl.TRIANGLES, 0, mesh.count);
  }

  drawDepth({mesh, kind}, rows, look) {
    const gl = this.gl, program = this.depth(look);
    this.setCuts(program, {mesh, kind}, look);
    gl.uniformMatrix4fv(program.clip, false, this.clip(rows, mesh.lower, mesh.upper));
    gl.bindVertexArray(mesh.array);
    if (mesh.indexed) gl.drawElements(gl.TRIANGLES, mesh.count, mesh.type, 0);
    else gl.drawArrays(gl.TRIANGLES, 0, mesh.count);
  }

  drawEdges(surfaces, rows, look) {
    const gl = this.gl;
    gl.useProgram(this.line.program);
    gl.uniform4f(this.line.color, ...rgb(look.line), 1);
    gl.enable(gl.BLEND);
    for (const one of surfaces) {
      const {mesh} = one;
      this.setCuts(this.line, one, look);
      if (!mesh.lines) this.makeEdges(mesh);
      gl.uniformMatrix4fv(this.line.clip, false, this.clip(rows, mesh.lower, mesh.upper));
      gl.bindVertexArray(mesh.lines.array);
      gl.drawElements(gl.LINES, mesh.lines.count, gl.UNSIGNED_INT, 0);
    }
    gl.disable(gl.BLEND);
    gl.useProgram(this.mesh(look).program);
  }

  makeEdges(mesh) {
    const gl = this.gl, triangles = mesh.count / 3, edges = new Uint32Array(6 * triangles);
    for (let t = 0; t < triangles; ++t)
      for (let k = 0; k < 3; ++k) {
        const a = 3 * t + k, b = 3 * t + (k + 1) % 3;
        edges[6 * t + 2 * k] = mesh.corners ? mesh.corners[a] : a;
        edges[6 * t + 2 * k + 1] = mesh.corners ? mesh.corners[b] : b;
      }
    const array = gl.createVertexArray(), buffer = gl.createBuffer();
    gl.bindVertexArray(array);
    gl.bindBuffer(gl.ARRAY_BUFFER, mesh.buffers[0]);
    gl.enableVertexAttribArray(0);
    gl.vertexAttribPointer(0, 3, gl.UNSIGNED_SHORT, true, 8, 0);
    if (mesh.colored) {
      gl.bindBuffer(gl.ARRAY_BUFFER, mesh.buffers[1]);
      gl.enableVertexAttribArray(2);
      gl.vertexAttribPointer(2, 1, gl.UNSIGNED_SHORT, false, 2, 0);
    }
    gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, buffer);
    gl.bufferData(gl.ELEMENT_ARRAY_BUFFER, edges, gl.STATIC_DRAW);
    gl.bindVertexArray(null);
    mesh.buffers.push(buffer);
    mesh.lines = {array, count: edges.length};
  }

  drawBox(rows, look) {
    const gl = this.gl;
    gl.useProgram(this.line.program);
    gl.uniformMatrix4fv(this.line.clip, false, this.clip(rows, look.boxLower, look.boxUpper));
    gl.uniform1i(this.line.cutCount, 0);
    gl.uniform1i(this.line.classCount, 0);
    gl.uniform4f(this.line.color, ...rgb(look.line), 1);
    gl.bindVertexArray(this.box);
    gl.drawArrays(gl.LINES, 0, 24);
  }

  /** Where a point is in the picture, -1 to 1 each; null behind the eye. */
  project(point) {
    if (!this.view) return null;
    const [x, y, , w] = this.view.rows.map((row) => row[3] + point.reduce((sum, v, i) => sum + v * row[i], 0));
    return w > 0 ? [x / w, y / w] : null;
  }

  /** What a pick can meet: a boundary that is more seen through than seen only where it stands alone. */
  pickable() {
    const alone = this.surfaces.every(({kind}) => kind === 'boundary');
    return this.surfaces.filter(({kind, opacity}) => kind !== 'boundary' || isSeenFirst(opacity) || alone);
  }

  /** The surface under a place of the picture, and its point there; or null. */
  pickSurface(x, y) {
    const point = this.pick(x, y);
    if (!point) return null;
    const far = ({key}) => { const other = this.pick(x, y, key); return other ? Math.hypot(...other.map((v, i) => v - point[i])) : Infinity; };
    const [surface] = this.pickable().map((one) => [one, far(one)]).reduce((a, b) => (b[1] < a[1] ? b : a));
    return {point, surface};
  }

  /** The point of a surface or slice under a place of the picture (-1 to 1 each), or null; of the one called `only`. */
  pick(x, y, only = null) {
    if (!this.view) return null;
    const gl = this.gl, {rows, near, far} = this.view;
    const width = this.canvas.width, height = this.canvas.height;
    // The picture shrinks to one pixel: that at (x, y).
    const zoomed = [0, 1].map((r) => rows[r].map((v, i) => (v - (r ? y : x) * rows[3][i]) * (r ? height : width)));
    gl.bindFramebuffer(gl.FRAMEBUFFER, this.pickFrame);
    gl.viewport(0, 0, 1, 1);
    gl.disable(gl.BLEND);
    gl.enable(gl.DEPTH_TEST);
    gl.clearColor(0, 0, 0, 0);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    gl.useProgram(this.depth(this.look).program);
    for (const {key, opacity, kind} of this.pickable()) {
      const mesh = this.meshes.get(key);
      if (!mesh || !mesh.lower || opacity <= 0 || (only && key !== only)) continue;
      this.drawDepth({mesh, kind}, [zoomed[0], zoomed[1], rows[2], rows[3]], this.look);
    }
    const pixel = new Uint8Array(4);
    gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, pixel);
    gl.bindFramebuffer(gl.FRAMEBUFFER, null);
    if (pixel[3] === 0) return null;
    const z = 2 * (pixel[0] + 256 * pixel[1] + 65536 * pixel[2]) / 16777215 - 1;
    const parallel = this.camera.projection === 'parallel';
    const depth = parallel ? (z * (far - near) + far + near) / 2 : 2 * far * near / (far + near - z * (far - near));
    const at = [0, 1, 2].map((i) => this.camera.target[i] + (this.camera.distance - depth) * this.camera.direction[i]);
    return this.camera.under(x, y, this.aspect(), at);
  }

  /** Waits until all is drawn: for measuring. */
  finish() {
    this.gl.readPixels(0, 0, 1, 1, this.gl.RGBA, this.gl.UNSIGNED_BYTE, new Uint8Array(4));
  }
}
