// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Time steps: a slider, a typed time, and playing.
import {parseNumber, short} from './format.js';
import {Player} from './play.js';

export class TimeSteps {
  /** @param on  {step(): shown, go(step), commit(), rest(): no longer playing, say(sentence)} */
  constructor({section, slider, label, typed, play, speed, order}, on) {
    Object.assign(this, {section, slider, label, typed, on, times: []});
    this.player = new Player({button: play, speed, order}, {count: () => this.times.length, at: on.step, go: on.go, ended() { on.rest(); on.commit(); }});
    slider.addEventListener('input', () => { this.stop(); on.go(Number(slider.value)); });
    slider.addEventListener('change', () => on.commit());
    typed.addEventListener('change', () => this.goTo(parseNumber(typed.value)));
    typed.addEventListener('blur', () => {
      if (typed.getAttribute('aria-invalid') === 'true') on.say('');
      this.show(on.step());
    });
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
    if (document.activeElement === this.typed) return;
    this.typed.value = short(this.times[step] ?? NaN);
    this.typed.removeAttribute('aria-invalid');
  }

  /** The step whose time is nearest. */
  goTo(time) {
    this.typed.setAttribute('aria-invalid', time === null);
    if (time === null) return this.on.say('A time is a number, such as 0.25.');
    const far = this.times.map((one) => Math.abs(one - time)), step = far.indexOf(Math.min(...far));
    this.stop();
    this.on.say('');
    this.on.go(step);
    this.typed.value = short(this.times[step]);
    this.on.commit();
  }

  get playing() { return this.player.playing; }

  /** The step to read ahead while playing. */
  next(step) { return this.player.next(step) ?? step; }

  toggle() { this.player.toggle(); }

  stop() { this.player.stop(); }

  /** A frame of this step is on the screen. */
  shown(step) { if (step === this.on.step()) this.player.shown(); }
}
