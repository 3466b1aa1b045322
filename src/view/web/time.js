// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Time steps: a slider, and playing. The next step is wished for when the last one is on the screen.
import {short} from './format.js';

export class TimeSteps {
  /** @param on  {step(): shown, go(step), commit(), rest(): no longer playing} */
  constructor({section, slider, label, play}, on) {
    Object.assign(this, {section, slider, label, button: play, on, times: [], playing: false});
    slider.addEventListener('input', () => { this.stop(); on.go(Number(slider.value)); });
    slider.addEventListener('change', () => on.commit());
    play.addEventListener('click', () => this.toggle());
  }

  set(times) {
    this.times = times;
    this.section.hidden = times.length < 2;
    this.slider.max = times.length - 1;
  }

  show(step) {
    if (this.times.length < 2) return;
    this.slider.value = step;
    this.label.textContent = `Step ${step} of 0 to ${this.times.length - 1}, time ${short(this.times[step] ?? NaN)}`;
    this.slider.setAttribute('aria-valuetext', this.label.textContent);
  }

  /** The step to read ahead while playing. */
  next(step) { return (step + 1) % this.times.length; }

  toggle() {
    if (this.times.length < 2) return;
    if (this.playing) { this.stop(); return this.on.commit(); }
    this.playing = true;
    this.button.textContent = 'Pause';
    this.on.go(this.next(this.on.step()));
  }

  stop() {
    if (!this.playing) return;
    this.playing = false;
    clearTimeout(this.timer);
    this.button.textContent = 'Play';
    this.on.rest();
  }

  /** A frame of this step is on the screen: the next one follows, 8 a second at most. */
  shown(step) {
    if (!this.playing || step !== this.on.step()) return;
    clearTimeout(this.timer);
    this.timer = setTimeout(() => { if (this.playing) this.on.go(this.next(step)); }, 125);
  }
}
