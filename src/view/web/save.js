// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The dialog that saves files: by name, into the folder of --out.
import {parseNumber, short} from './format.js';

const id = (name) => document.getElementById(name);
const endings = {picture: '.png', surface: '.vtp', sweep: '.webp', turn: '.webp'};
const rules = {picture: 'The name ends in .png.', surface: 'The name ends in .vtp, .vtk, .ply, .stl, .obj or .ts.',
  sweep: 'The name ends in .webp.', turn: 'The name ends in .webp.'};

export class Save {
  /** @param on  {state(): as messages have it, size(): [w, h], range(): [lower, upper], send(message): whether it went} */
  constructor(on) {
    this.on = on;
    this.out = '';
    id('save-open').addEventListener('click', () => this.open());
    id('save-close').addEventListener('click', () => id('save').close());
    id('save-kind').addEventListener('change', () => { this.show(); this.tell(this.out ? `Into the folder ${this.out}` : id('save-told').textContent); });
    id('save-form').addEventListener('submit', (event) => { event.preventDefault(); this.go(); });
  }

  open() {
    const [width, height] = this.on.size(), [lower, upper] = this.on.range();
    id('save-width').value = width;
    id('save-height').value = height;
    id('save-from').value = short(lower + 0.05 * (upper - lower));
    id('save-to').value = short(upper - 0.05 * (upper - lower));
    id('save-go').disabled = !this.out;
    this.tell(this.out ? `Into the folder ${this.out}` : 'Nothing can be saved: start isotet view with --out FOLDER.');
    this.show();
    id('save').showModal();
  }

  show() {
    const kind = id('save-kind').value, name = id('save-name').value.trim().replace(/\.[a-z]*$/, '') || kind;
    const fits = kind === 'surface' && /\.(vtp|vtk|ply|stl|obj|ts)$/.test(id('save-name').value);
    if (!fits) id('save-name').value = name + endings[kind];
    id('save-hint').textContent = rules[kind];
    id('save-size').hidden = kind === 'surface';
    id('save-values').hidden = kind !== 'sweep';
    id('save-many').hidden = kind !== 'sweep' && kind !== 'turn';
  }

  tell(sentence, busy = false) {
    id('save-told').textContent = sentence;
    id('save-go').disabled = busy || !this.out;
  }

  go() {
    const kind = id('save-kind').value, number = (name) => parseNumber(id('save-' + name).value);
    const message = {do: 'save', kind, name: id('save-name').value.trim(), state: this.on.state()};
    const wanted = {picture: ['width', 'height'], surface: [], sweep: ['width', 'height', 'from', 'to', 'pictures'], turn: ['width', 'height', 'pictures']}[kind];
    for (const name of wanted) {
      message[name] = number(name);
      const fits = message[name] !== null && (name === 'from' || name === 'to' || (Number.isInteger(message[name]) && message[name] > 0));
      id('save-' + name).setAttribute('aria-invalid', !fits);
      if (!fits) return this.tell(`${id('save-' + name).getAttribute('aria-label') || 'Pictures'} takes a number.`);
    }
    this.tell(`Writing ${message.name} …`, true);
    if (!this.on.send(message)) this.tell('There is no connection.');
  }
}
