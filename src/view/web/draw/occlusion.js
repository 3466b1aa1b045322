// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Folds of opaque surfaces become darker, as src/render/cpu/occlusion.cpp has it: from the depths of the picture at half its size.

const reach = 0.35; // of half the longest side of the grid's box

/** Distances along the view from depths, in shaders. */
export const distances = `
uniform highp sampler2D depths;
uniform vec2 nearFar;
uniform bool parallel;
float distanceOf(float depth) {
  return parallel ? mix(nearFar.x, nearFar.y, depth) : nearFar.x * nearFar.y / (nearFar.y - depth * (nearFar.y - nearFar.x));
}
float depthAt(ivec2 at) { return texelFetch(depths, at, 0).r; }`;

/** openness(), in shaders: of the four nearest pixels of half the picture, those of the same surface. */
export const openness = `
uniform sampler2D open;
uniform float occlusion, occlusionReach;
${distances}
float openness() {
  if (occlusion <= 0.0) return 1.0;
  float here = distanceOf(gl_FragCoord.z), sum = 0.0, weights = 0.0;
  ivec2 size = textureSize(open, 0);
  vec2 place = gl_FragCoord.xy / 2.0 - 0.5, part = fract(place);
  for (int i = 0; i < 4; ++i) {
    ivec2 side = ivec2(i & 1, i >> 1), at = clamp(ivec2(floor(place)) + side, ivec2(0), size - 1);
    float depth = depthAt(at);
    if (depth >= 1.0) continue;
    vec2 near = mix(1.0 - part, part, vec2(side));
    float weight = near.x * near.y * max(1e-3, 1.0 - abs(distanceOf(depth) - here) * 4.0 / occlusionReach);
    sum += weight * texelFetch(open, at, 0).r;
    weights += weight;
  }
  return weights > 0.0 ? 1.0 - occlusion * (1.0 - sum / weights) : 1.0;
}`;

const wholePicture = `#version 300 es
void main() { gl_Position = vec4(vec2(gl_VertexID & 1, gl_VertexID >> 1) * 4.0 - 1.0, 0.0, 1.0); }`;

const heights = `#version 300 es
precision highp float;
uniform vec2 pixel; // its size in the scene, at a distance of 1 or at any
uniform float reach;
out vec4 color;
${distances}
const int turns[16] = int[](0, 8, 2, 10, 12, 4, 14, 6, 3, 11, 1, 9, 15, 7, 13, 5);
// The sine of how high a place beside this one stands above it, less the farther away it is; -1 where nothing is.
float height(ivec2 at, ivec2 away, float here, float square) {
  ivec2 there = at + away, size = textureSize(depths, 0);
  if (any(lessThan(there, ivec2(0))) || any(greaterThanEqual(there, size))) return -1.0;
  float depth = depthAt(there);
  if (depth >= 1.0) return -1.0;
  float far = distanceOf(depth), farther = far - here;
  vec2 across = (parallel ? vec2(away) : vec2(away) * far + (vec2(at) + 0.5 - vec2(size) / 2.0) * farther) * pixel;
  float length = dot(across, across) + farther * farther, part = length / square;
  return part < 1.0 ? (1.0 - part * part) * (1.0 - farther / sqrt(length)) - 1.0 : -1.0;
}
void main() {
  ivec2 at = ivec2(gl_FragCoord.xy);
  float depth = depthAt(at), here = distanceOf(depth), unit = parallel ? pixel.y : pixel.y * here;
  float pixels = min(reach / unit, 96.0), square = pixels * unit * pixels * unit, closed = 0.0;
  color = vec4(1.0);
  if (depth >= 1.0 || pixels < 1.5) return;
  int turn = (at.y & 3) * 4 + (at.x & 3);
  for (int slice = 0; slice < 4; ++slice) {
    float angle = 3.14159265 * (float(slice) + float(turns[turn]) / 16.0) / 4.0;
    float highest = 0.0;
    for (int k = 0; k < 4; ++k) {
      float part = (float(k) + float(turns[(5 * turn + 3) & 15] + 1) / 16.0) / 4.0;
      ivec2 away = ivec2(floor((1.0 + part * part * (pixels - 1.0)) * vec2(cos(angle), sin(angle)) + 0.5));
      highest = max(highest, 0.5 * (height(at, away, here, square) + height(at, -away, here, square)) - 0.05);
    }
    closed += highest;
  }
  color = vec4(max(0.0, 1.0 - 1.7 * closed / 4.0));
}`;

const mean = `#version 300 es
precision highp float;
uniform sampler2D open;
uniform float reach;
out vec4 color;
${distances}
void main() {
  ivec2 at = ivec2(gl_FragCoord.xy), size = textureSize(depths, 0);
  float here = distanceOf(depthAt(at)), sum = 0.0, count = 0.0;
  for (int i = 0; i < 16; ++i) {
    ivec2 there = at + ivec2(i & 3, i >> 2) - 2;
    if (any(lessThan(there, ivec2(0))) || any(greaterThanEqual(there, size))) continue;
    if (abs(distanceOf(depthAt(there)) - here) >= reach / 4.0) continue;
    sum += texelFetch(open, there, 0).r;
    count += 1.0;
  }
  color = vec4(count > 0.0 ? sum / count : 1.0);
}`;

export class Occlusion {
  /** @param program  (vertex, fragment, names) as Scene.program() */
  constructor(gl, program) {
    this.gl = gl;
    this.compile = () => [heights, mean].map((fragment) => program(wholePicture, fragment, ['depths', 'nearFar', 'parallel', 'pixel', 'reach', 'open']));
    this.passes = null; // until they are needed
    this.depths = gl.createTexture();
    this.open = [gl.createTexture(), gl.createTexture()];
    this.frames = [0, 1, 2].map(() => gl.createFramebuffer()); // of the depths, and of both passes
    this.nothing = gl.createVertexArray();
    this.size = [0, 0];
    this.strength = 0;
  }

  resize(width, height) {
    if (this.size[0] === width && this.size[1] === height) return;
    const gl = this.gl;
    this.size = [width, height];
    for (const [texture, inside, format, type] of [[this.depths, gl.DEPTH_COMPONENT24, gl.DEPTH_COMPONENT, gl.UNSIGNED_INT],
      ...this.open.map((one) => [one, gl.RGBA8, gl.RGBA, gl.UNSIGNED_BYTE])]) {
      gl.bindTexture(gl.TEXTURE_2D, texture);
      gl.texImage2D(gl.TEXTURE_2D, 0, inside, width, height, 0, format, type, null);
      for (const how of [gl.TEXTURE_MIN_FILTER, gl.TEXTURE_MAG_FILTER]) gl.texParameteri(gl.TEXTURE_2D, how, gl.NEAREST);
      for (const how of [gl.TEXTURE_WRAP_S, gl.TEXTURE_WRAP_T]) gl.texParameteri(gl.TEXTURE_2D, how, gl.CLAMP_TO_EDGE);
    }
    const points = [gl.DEPTH_ATTACHMENT, gl.COLOR_ATTACHMENT0, gl.COLOR_ATTACHMENT0];
    [this.depths, ...this.open].forEach((texture, i) => {
      gl.bindFramebuffer(gl.FRAMEBUFFER, this.frames[i]);
      gl.framebufferTexture2D(gl.FRAMEBUFFER, points[i], gl.TEXTURE_2D, texture, 0);
      gl.drawBuffers([i === 0 ? gl.NONE : gl.COLOR_ATTACHMENT0]);
    });
  }

  /**
   * Of a picture that is about to be drawn.
   * @param strength    0 to 1; 0: nothing is done
   * @param drawDepths  draws what is opaque
   */
  find(strength, canvas, {rows, near, far}, isParallel, size, drawDepths) {
    this.strength = strength;
    if (strength <= 0) return;
    const gl = this.gl, [width, height] = [canvas.width, canvas.height].map((side) => Math.ceil(side / 2));
    this.resize(width, height);
    this.passes ??= this.compile();
    this.reach = reach * size / 2;
    this.lens = {near, far, isParallel};
    gl.bindFramebuffer(gl.FRAMEBUFFER, this.frames[0]);
    gl.viewport(0, 0, width, height);
    gl.clear(gl.DEPTH_BUFFER_BIT);
    drawDepths();
    gl.disable(gl.DEPTH_TEST);
    gl.bindVertexArray(this.nothing);
    this.passes.forEach((pass, i) => {
      gl.bindFramebuffer(gl.FRAMEBUFFER, this.frames[i + 1]);
      gl.useProgram(pass.program);
      this.bind(pass, this.open[0], i === 1);
      gl.uniform1f(pass.reach, this.reach);
      gl.uniform2f(pass.pixel, ...[[0, width], [1, height]].map(([r, side]) => 2 / (side * Math.hypot(...rows[r].slice(0, 3)))));
      gl.drawArrays(gl.TRIANGLES, 0, 3);
    });
    gl.enable(gl.DEPTH_TEST);
    gl.bindFramebuffer(gl.FRAMEBUFFER, null);
  }

  bind(program, open, isRead) {
    const gl = this.gl;
    [[program.depths, this.depths, 1], [program.open, isRead ? open : null, 2]].forEach(([at, texture, unit]) => {
      gl.activeTexture(gl.TEXTURE0 + unit);
      gl.bindTexture(gl.TEXTURE_2D, texture);
      gl.uniform1i(at, unit);
    });
    gl.activeTexture(gl.TEXTURE0);
    gl.uniform2f(program.nearFar, this.lens.near, this.lens.far);
    gl.uniform1i(program.parallel, this.lens.isParallel ? 1 : 0);
  }

  /** For a program with openness(). */
  use(program) {
    const gl = this.gl;
    gl.uniform1f(program.occlusion, this.strength);
    gl.uniform1f(program.occlusionReach, this.reach ?? 1);
    gl.uniform1i(program.depths, 1);
    gl.uniform1i(program.open, 2);
    if (this.strength > 0) this.bind(program, this.open[1], true);
  }
}
