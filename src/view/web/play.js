// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Playing: one place after another, the next one when the last is on the screen.

const players = [];

export class Player {
  /**
   * @param controls  {button, speed: places a second, order: 'loop', 'once' or 'back'}
   * @param on        {count(): of places, at(): the one that is shown, go(place), ended()}
   */
  constructor({button, speed, order}, on) {
    Object.assign(this, {button, speed, order, on, playing: false, forwards: true});
    button.addEventListener('click', () => this.toggle());
    players.push(this);
  }

  /** Nothing where it ends. */
  next(at) {
    const last = this.on.count() - 1, order = this.order.value;
    if (order !== 'back') return at < last ? at + 1 : order === 'once' ? null : 0;
    if (at >= last) this.forwards = false;
    else if (at <= 0) this.forwards = true;
    return at + (this.forwards ? 1 : -1);
  }

  toggle() {
    if (this.playing) return this.stop();
    if (this.on.count() < 2) return;
    for (const other of players) other.stop();
    this.playing = true;
    this.button.textContent = 'Pause';
    this.on.go(this.next(this.on.at()) ?? 0);
  }

  stop() {
    if (!this.playing) return;
    this.playing = false;
    clearTimeout(this.timer);
    this.button.textContent = 'Play';
    this.on.ended();
  }

  /** The place that was gone to is on the screen. */
  shown() {
    if (!this.playing) return;
    clearTimeout(this.timer);
    this.timer = setTimeout(() => {
      if (!this.playing) return;
      const next = this.next(this.on.at());
      if (next === null) this.stop();
      else this.on.go(next);
    }, 1000 / Number(this.speed.value));
  }
}
