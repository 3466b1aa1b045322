// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Mouse, touch and keys on the picture move the camera, about the point under the pointer.

export class Pointer {
  /** @param on  {moved(), middle(): of the grid, level(steps): moves the isovalue, click(x, y)} */
  constructor(canvas, camera, scene, on) {
    Object.assign(this, {canvas, camera, scene, on});
    this.down = new Map();
    this.wheelPoint = null;
    canvas.addEventListener('pointerdown', (event) => this.press(event));
    canvas.addEventListener('pointermove', (event) => this.move(event));
    for (const end of ['pointerup', 'pointercancel']) canvas.addEventListener(end, (event) => this.release(event));
    canvas.addEventListener('wheel', (event) => this.wheel(event), {passive: false});
    canvas.addEventListener('dblclick', (event) => this.center(event));
    canvas.addEventListener('auxclick', (event) => event.preventDefault());
    canvas.addEventListener('contextmenu', (event) => { if (this.turned) event.preventDefault(); });
    canvas.addEventListener('keydown', (event) => this.key(event));
  }

  /** Places of the picture, -1 to 1 each. */
  place(event) {
    const box = this.canvas.getBoundingClientRect();
    return [2 * (event.clientX - box.left) / box.width - 1, 1 - 2 * (event.clientY - box.top) / box.height];
  }

  /** The point of a surface there; else at the depth of the middle of the grid. */
  pointAt(event) {
    const [x, y] = this.place(event);
    return this.scene()?.pick(x, y) || this.camera.under(x, y, this.canvas.clientWidth / Math.max(1, this.canvas.clientHeight), this.on.middle() || this.camera.target);
  }

  press(event) {
    if (event.button === 1) event.preventDefault();
    try { this.canvas.setPointerCapture(event.pointerId); } catch { /* a pointer that is up already */ }
    const [x, y] = this.place(event);
    const found = this.scene()?.pick(x, y);
    // Where nothing is, the middle is what one turns about.
    this.point = found || this.pointAt(event);
    this.pivot = found || this.on.middle() || this.camera.target;
    this.travelled = 0;
    this.panning = event.shiftKey || event.button !== 0;
    this.down.set(event.pointerId, [event.clientX, event.clientY]);
    if (this.down.size === 2) this.pinchPoint = this.point;
  }

  release(event) {
    if (!this.down.delete(event.pointerId) || event.type !== 'pointerup' || this.travelled > 4 || event.button !== 0) return;
    clearTimeout(this.clickTimer);
    const place = this.place(event);
    this.clickTimer = setTimeout(() => this.on.click(...place), 250); // unless it becomes a double click
  }

  move(event) {
    const before = this.down.get(event.pointerId);
    if (!before) return;
    const height = this.canvas.clientHeight, dx = event.clientX - before[0], dy = event.clientY - before[1];
    if (dx === 0 && dy === 0) return;
    this.travelled += Math.abs(dx) + Math.abs(dy);
    if (this.travelled <= 4 && this.down.size < 2) return; // a click, so far
    if (this.down.size === 2) this.pinch(event, before);
    else if (this.panning) this.camera.pan(this.point, dx / height, -dy / height);
    else this.camera.orbit(this.pivot, -dx / height * Math.PI, dy / height * Math.PI);
    this.down.set(event.pointerId, [event.clientX, event.clientY]);
    this.on.moved();
  }

  pinch(event, before) {
    const [, other] = [...this.down].find(([pointer]) => pointer !== event.pointerId);
    const apart = (at) => Math.hypot(at[0] - other[0], at[1] - other[1]) || 1;
    this.camera.zoom(this.pinchPoint, apart([event.clientX, event.clientY]) / apart(before));
    const height = this.canvas.clientHeight;
    this.camera.pan(this.pinchPoint, (event.clientX - before[0]) / 2 / height, -(event.clientY - before[1]) / 2 / height);
  }

  wheel(event) {
    event.preventDefault();
    const notches = -event.deltaY * (event.deltaMode === 1 ? 16 : 1) / 100;
    if (event.ctrlKey && Math.abs(event.deltaY) >= 50) return this.on.level(Math.sign(notches) * (event.shiftKey ? 0.1 : 1));
    // A pinch on a touchpad comes as a wheel with Ctrl and small steps.
    const now = performance.now();
    if (!this.wheelPoint || now - this.wheelAt > 300) this.wheelPoint = this.pointAt(event);
    this.wheelAt = now;
    this.camera.zoom(this.wheelPoint, Math.exp(notches * (event.ctrlKey ? 1 : 0.18)));
    this.on.moved();
  }

  center(event) {
    clearTimeout(this.clickTimer);
    const point = this.pointAt(event), start = performance.now(), from = this.camera.target.slice();
    const still = matchMedia('(prefers-reduced-motion: reduce)').matches;
    const go = () => {
      const part = still ? 1 : Math.min(1, (performance.now() - start) / 200), eased = part * (2 - part);
      this.camera.target = from.map((v, i) => v + (point[i] - v) * eased);
      this.on.moved();
      if (part < 1) requestAnimationFrame(go);
    };
    go();
  }

  key(event) {
    if (event.ctrlKey || event.altKey || event.metaKey) return;
    const direction = {ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1]}[event.key];
    const middle = this.on.middle() || this.camera.target;
    if (direction && event.shiftKey) this.camera.pan(middle, direction[0] * 0.05, direction[1] * 0.05);
    else if (direction) this.camera.orbit(middle, direction[0] * Math.PI / 36, direction[1] * Math.PI / 36);
    else if (event.key === '+' || event.key === '=') this.camera.zoom(middle, 1.15);
    else if (event.key === '-') this.camera.zoom(middle, 1 / 1.15);
    else return;
    event.preventDefault();
    event.stopPropagation();
    this.on.moved();
  }
}
