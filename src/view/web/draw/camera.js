// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The camera of isotet::Camera: target, direction to the eye, up, distance or height. Vectors are arrays of 3.

export const add = (a, b, t = 1) => [a[0] + t * b[0], a[1] + t * b[1], a[2] + t * b[2]];
export const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
export const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const unit = (a) => { const l = Math.hypot(...a) || 1; return [a[0] / l, a[1] / l, a[2] / l]; };

function turned(a, axis, angle) {
  const c = Math.cos(angle), s = Math.sin(angle), k = dot(axis, a) * (1 - c), x = cross(axis, a);
  return [0, 1, 2].map((i) => a[i] * c + x[i] * s + axis[i] * k);
}

// To the eye and upwards, in shares of right, front and up, which an axis that points upwards gives.
const views = {
  front: [[0, 1, 0], [0, 0, 1]], right: [[1, 0, 0], [0, 0, 1]], top: [[0, 0, 1], [0, -1, 0]],
  oblique: [unit([0.5, 0.75, 0.43]), [0, 0, 1]], // 33.69 degrees to the right, 25.5 upwards
};

/** The side that a view from the front shows, by the axis that points upwards: as camera_of() of include/isotet/scene.hpp. */
const fronts = {x: [0, -1, 0], y: [0, 0, 1], z: [0, -1, 0]};

export class Camera {
  constructor() {
    this.projection = 'perspective';
    this.target = [0, 0, 0];
    this.distance = 1;
    this.angle = 25;
    this.height = 1;
    this.setUp('z');
    this.look('oblique');
  }

  /** "z" or "-y": of the views to come. */
  setUp(name) {
    const sign = name.startsWith('-') ? -1 : 1, axis = name.slice(-1), up = ['x', 'y', 'z'].map((one) => (one === axis ? sign : 0)), front = fronts[axis];
    this.frame = [cross(up, front), front, up];
  }

  look(name) {
    const [direction, up] = views[name].map((shares) => [0, 1, 2].map((i) => shares.reduce((sum, share, k) => sum + share * this.frame[k][i], 0) || 0));
    this.direction = direction;
    this.up = unit(add(up, direction, -dot(up, direction)));
  }

  right() { return cross(this.up, this.direction); }

  /** Half the angle of view, as a tangent. */
  slope() { return Math.tan(this.angle * Math.PI / 360); }

  /** What the picture shows from its lower to its upper edge, at the depth of a point. */
  heightAt(point) {
    if (this.projection === 'parallel') return this.height;
    const depth = this.distance - dot(add(point, this.target, -1), this.direction);
    return 2 * Math.max(depth, 1e-6 * this.distance) * this.slope();
  }

  setProjection(projection) {
    if (projection === this.projection) return;
    if (projection === 'parallel') this.height = 2 * this.distance * this.slope();
    else this.distance = this.height / (2 * this.slope());
    this.projection = projection;
  }

  /**
   * Sees all of some points as large as possible, as Camera::fit() of include/isotet/scene.hpp.
   *
   * @param points  x, y and z one after another
   */
  fit(points, aspect, margin = 0.04) {
    const lower = [Infinity, Infinity, Infinity], upper = [-Infinity, -Infinity, -Infinity];
    for (let i = 0; i < points.length; ++i) {
      if (points[i] < lower[i % 3]) lower[i % 3] = points[i];
      if (points[i] > upper[i % 3]) upper[i % 3] = points[i];
    }
    const middle = lower.map((v, i) => v / 2 + upper[i] / 2), widest = Math.max(...upper.map((u, i) => u - lower[i])) || 1;
    const part = 1 - 2 * margin, right = this.right(), {up, direction} = this;
    // How far the points reach to the right, left, up and down: where lines of sight spread, and where they are parallel.
    const spread = [-Infinity, -Infinity, -Infinity, -Infinity], flat = spread.slice(), slopes = [this.slope() * part * aspect, this.slope() * part];
    for (let i = 0; i < points.length; i += 3) {
      const x = points[i] - middle[0], y = points[i + 1] - middle[1], z = points[i + 2] - middle[2];
      const nearer = x * direction[0] + y * direction[1] + z * direction[2];
      for (let side = 0; side < 2; ++side) {
        const axis = side ? up : right, place = x * axis[0] + y * axis[1] + z * axis[2], wider = nearer * slopes[side];
        spread[2 * side] = Math.max(spread[2 * side], place + wider);
        spread[2 * side + 1] = Math.max(spread[2 * side + 1], wider - place);
        flat[2 * side] = Math.max(flat[2 * side], place);
        flat[2 * side + 1] = Math.max(flat[2 * side + 1], -place);
      }
    }
    this.height = Math.max(flat[2] + flat[3], (flat[0] + flat[1]) / aspect, widest * 1e-3) / part;
    this.distance = Math.max((spread[0] + spread[1]) / (2 * slopes[0]), (spread[2] + spread[3]) / (2 * slopes[1]), widest * 1e-3);
    const reach = this.projection === 'parallel' ? flat : spread;
    this.target = add(add(middle, right, (reach[0] - reach[1]) / 2), up, (reach[2] - reach[3]) / 2);
    if (this.projection === 'parallel') this.distance = 2 * widest;
  }

  /** Turns about a point: to the right about the axis of the world that is nearest to `up`, then upwards. Radians. */
  orbit(point, azimuth, elevation) {
    const axis = [0, 0, 0];
    const most = this.up.map(Math.abs).indexOf(Math.max(...this.up.map(Math.abs)));
    axis[most] = Math.sign(this.up[most]) || 1;
    const turn = (around, angle) => {
      this.direction = unit(turned(this.direction, around, angle));
      this.up = turned(this.up, around, angle);
      this.target = add(point, turned(add(this.target, point, -1), around, angle));
    };
    turn(axis, azimuth);
    // Not over the pole: there left and right would change places.
    const now = Math.asin(Math.max(-1, Math.min(1, dot(this.direction, axis)))), most_up = 89 * Math.PI / 180;
    turn(this.right(), -(Math.max(-most_up, Math.min(most_up, now + elevation)) - now));
    this.up = unit(add(this.up, this.direction, -dot(this.up, this.direction)));
  }

  /** Moves so that a point follows the pointer; shares of the height of the picture, upwards. */
  pan(point, x, y) {
    const size = this.heightAt(point);
    this.target = add(add(this.target, this.right(), -x * size), this.up, -y * size);
  }

  /** Things `factor` times as large; the point keeps its place in the picture. */
  zoom(point, factor) {
    if (this.projection === 'parallel') {
      this.height /= factor;
      const away = add(point, this.target, -1);
      const in_plane = add(away, this.direction, -dot(away, this.direction));
      this.target = add(this.target, in_plane, 1 - 1 / factor);
      return;
    }
    this.target = add(point, add(this.target, point, -1), 1 / factor);
    this.distance /= factor;
  }

  /** The point at the depth of `at` under a place of the picture, -1 to 1 each. */
  under(x, y, aspect, at) {
    if (this.projection === 'parallel') {
      const depth = dot(add(at, this.target, -1), this.direction), half = this.height / 2;
      return add(add(add(this.target, this.direction, depth), this.right(), x * half * aspect), this.up, y * half);
    }
    const eye = add(this.target, this.direction, this.distance);
    const ray = add(add([0, 0, 0].map((_, i) => -this.direction[i]), this.right(), x * this.slope() * aspect), this.up, y * this.slope());
    const depth = this.distance - dot(add(at, this.target, -1), this.direction);
    return add(eye, ray, depth);
  }

  /** Origin and direction of the ray under a place of the picture, from before a box. */
  ray(x, y, aspect, lower, upper) {
    const through = this.under(x, y, aspect, this.target);
    if (this.projection === 'perspective') {
      const eye = add(this.target, this.direction, this.distance);
      return [eye, unit(add(through, eye, -1))];
    }
    const size = Math.hypot(...add(upper, lower, -1)), away = Math.hypot(...add(through, lower, -1));
    return [add(through, this.direction, size + away), this.direction.map((v) => -v)];
  }

  /** World to clip space, column by column, for a box that is to be between the near and the far plane. */
  matrix(aspect, lower, upper) {
    const right = this.right(), {up, direction, target} = this;
    let near = Infinity, far = -Infinity;
    for (let corner = 0; corner < 8; ++corner) {
      const from = [0, 1, 2].map((i) => (corner >> i & 1 ? upper : lower)[i] - target[i]);
      const depth = this.distance - dot(from, direction);
      near = Math.min(near, depth);
      far = Math.max(far, depth);
    }
    const pad = 0.01 * (far - near) || 0.01 * this.distance;
    near -= pad; far += pad;
    if (this.projection === 'perspective') near = Math.max(near, far * 1e-4, this.distance * 1e-4);
    far = Math.max(far, near * 1.001 + 1e-30);
    const rows = [right, up, direction].map((axis) => [...axis, -dot(axis, target)]);
    rows[2][3] -= this.distance; // depth behind the eye is negative
    let sx, sy, zz, zw, w;
    if (this.projection === 'parallel') {
      sy = 2 / this.height; sx = sy / aspect;
      zz = -2 / (far - near); zw = -(far + near) / (far - near); w = [0, 0, 0, 1];
    } else {
      sy = 1 / this.slope(); sx = sy / aspect;
      zz = -(far + near) / (far - near); zw = -2 * far * near / (far - near); w = rows[2].map((v) => -v);
    }
    const out = [rows[0].map((v) => v * sx), rows[1].map((v) => v * sy), rows[2].map((v, i) => v * zz + (i === 3 ? zw : 0)), w];
    return {rows: out, near, far};
  }

  text() {
    const of = (vector) => vector.map((v) => Number(v.toPrecision(9))).join(',');
    const head = `${this.projection}:${of(this.target)}:${of(this.direction)}:${of(this.up)}:`;
    const size = (v) => Number(v.toPrecision(9));
    return head + (this.projection === 'parallel' ? size(this.height) : `${size(this.distance)}:${size(this.angle)}`);
  }

  /** False, and nothing changed, where the text is no camera. */
  set(text) {
    const [projection, target, direction, up, size, angle] = text.split(':');
    const vectors = [target, direction, up].map((t) => (t || '').split(',').map(Number));
    const sizes = projection === 'parallel' ? [Number(size)] : [Number(size), Number(angle)];
    if (!['parallel', 'perspective'].includes(projection) || vectors.some((v) => v.length !== 3 || !v.every(Number.isFinite)) ||
        !sizes.every((s) => s > 0)) return false;
    this.projection = projection;
    [this.target, this.direction, this.up] = vectors;
    this.direction = unit(this.direction);
    this.up = unit(add(this.up, this.direction, -dot(this.up, this.direction)));
    if (projection === 'parallel') { this.height = sizes[0]; this.distance = this.height / (2 * this.slope()); }
    else { [this.distance, this.angle] = sizes; this.height = 2 * this.distance * this.slope(); }
    return true;
  }
}
