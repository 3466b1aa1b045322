// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The list of clip planes and slices: a row a plane, with its direction and its place.
import {parseNumber, roundTo, short} from './format.js';
import {maxPlanes, planesOf} from './state.js';

const alongAxes = {x: [1, 0, 0], y: [0, 1, 0], z: [0, 0, 1]};
const same = (a, b) => a.every((v, i) => v === b[i]);

export class Cuts {
  /** @param on  {state(), box(): [lower, upper], direction(): to the eye, changed(moving), say(sentence)} */
  constructor(list, buttons, on) {
    Object.assign(this, {list, on});
    for (const [kind, button] of Object.entries(buttons)) button.addEventListener('click', () => this.add(kind));
  }

  /** Places along a normal that the box has. */
  range(normal) {
    const [lower, upper] = this.on.box(), ends = [0, 0];
    normal.forEach((n, i) => { ends[0] += n * (n < 0 ? upper : lower)[i]; ends[1] += n * (n < 0 ? lower : upper)[i]; });
    return ends;
  }

  add(kind) {
    const state = this.on.state();
    if (planesOf(state, kind).length >= maxPlanes) return this.on.say(`There can be ${maxPlanes} planes of a kind.`);
    const [from, to] = this.range(alongAxes.x);
    state.planes.push({kind, normal: alongAxes.x.slice(), offset: roundTo((from + to) / 2, to - from)});
    this.on.changed(false, kind);
    this.list.lastChild?.querySelector('input[type=range]').focus();
  }

  /** Rows stay where they are: a control keeps its focus. */
  show() {
    const {planes} = this.on.state();
    while (this.list.children.length > planes.length) this.list.lastChild.remove();
    planes.forEach((plane, i) => this.fill(this.list.children[i] || this.list.appendChild(this.row(i)), plane, i));
  }

  fill(row, {kind, normal, offset}, i) {
    const get = (name) => row.querySelector('.' + name), name = `${kind} ${i + 1}`;
    const along = Object.keys(alongAxes).find((axis) => same(alongAxes[axis], normal.map(Math.abs)));
    const [from, to] = this.range(normal), slider = get('place');
    get('kind').textContent = kind === 'clip' ? 'Clip' : 'Slice';
    if (document.activeElement !== get('axis')) get('axis').value = along || 'free';
    get('normal').hidden = !!along;
    if (document.activeElement !== get('normal')) get('normal').value = normal.map(short).join(', ');
    get('flip').hidden = kind !== 'clip';
    slider.min = from; slider.max = to; slider.step = (to - from) / 1000 || 'any';
    if (document.activeElement !== slider) slider.value = offset;
    slider.setAttribute('aria-valuetext', short(this.told(normal, offset)));
    if (document.activeElement !== get('offset')) get('offset').value = short(this.told(normal, offset));
    for (const [part, what] of [['axis', 'Direction'], ['normal', 'Normal'], ['place', 'Place'], ['offset', 'Place, typed,'], ['flip', 'Other side'], ['remove', '']])
      get(part).setAttribute('aria-label', what ? `${what} of ${name}` : `Remove ${name}`);
  }

  /** Along -x the place is told as x. */
  told(normal, offset) { return normal.some((v) => v === -1) ? (offset === 0 ? 0 : -offset) : offset; }

  row(i) {
    const row = document.createElement('li');
    row.innerHTML = '<div><span class="kind"></span><select class="axis"><option>x</option><option>y</option><option>z</option>' +
      '<option value="view">as seen</option><option value="free">free</option></select><input class="normal" type="text" autocomplete="off" hidden>' +
      '<button class="flip" type="button" title="Show the other side">Flip</button><button class="remove" type="button">×</button></div>' +
      '<div><input class="place" type="range"><input class="offset" type="text" inputmode="decimal" autocomplete="off"></div>';
    const get = (name) => row.querySelector('.' + name), plane = () => this.on.state().planes[i];
    get('axis').addEventListener('change', () => {
      const chosen = get('axis').value;
      this.turn(plane(), alongAxes[chosen] || (chosen === 'view' ? this.on.direction() : this.tilted(plane().normal)));
    });
    get('normal').addEventListener('change', () => {
      const numbers = get('normal').value.split(/[ ,;]+/).filter(Boolean).map(Number);
      const fits = numbers.length === 3 && numbers.every(Number.isFinite) && Math.hypot(...numbers) > 0;
      get('normal').setAttribute('aria-invalid', !fits);
      if (!fits) return this.on.say('A normal is three numbers that are not all 0, such as 1, 0, 0.5.');
      this.turn(plane(), numbers);
    });
    get('place').addEventListener('input', () => { plane().offset = this.rounded(plane(), Number(get('place').value)); this.on.changed(true); });
    get('place').addEventListener('change', () => this.on.changed(false));
    get('offset').addEventListener('change', () => {
      const number = parseNumber(get('offset').value);
      get('offset').setAttribute('aria-invalid', number === null);
      if (number === null) return this.on.say('The place of a plane is a number.');
      plane().offset = this.told(plane().normal, number);
      this.on.changed(false);
    });
    get('flip').addEventListener('click', () => {
      plane().normal = plane().normal.map((v) => (v === 0 ? 0 : -v));
      plane().offset = plane().offset === 0 ? 0 : -plane().offset;
      this.on.changed(false);
    });
    get('remove').addEventListener('click', () => {
      this.on.state().planes.splice(i, 1);
      this.on.changed(false);
      (this.list.children[i] || this.list.children[i - 1])?.querySelector('.remove').focus();
    });
    return row;
  }

  /** A direction that is none of the alongAxes, to be changed. */
  tilted(normal) {
    const axis = normal.findIndex((v) => v !== 0);
    return Object.values(alongAxes).some((one) => same(one, normal.map(Math.abs))) ? normal.map((v, i) => (i === (axis + 1) % 3 ? 0.5 : v)) : normal;
  }

  rounded(plane, offset) { const [from, to] = this.range(plane.normal); return roundTo(offset, to - from); }

  /** Another direction, through the same point of the middle axis. */
  turn(plane, normal) {
    plane.normal = normal.map((v) => Number(v.toPrecision(6)));
    const [from, to] = this.range(plane.normal);
    plane.offset = roundTo((from + to) / 2, to - from);
    this.on.say('');
    this.on.changed(false);
  }
}
