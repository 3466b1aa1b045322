// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The slider on the histogram of the field.
import {roundTo, short} from './format.js';

/** The histogram of a chart, `room` high above `base`; `x` is the place of a value. */
export function paintBars(context, {points, lower, upper}, x, base, room) {
  // Square roots: bins with few points stay visible beside a bin with most of them.
  const most = Math.sqrt(Math.max(1, ...points)), end = (i) => x(lower + i / points.length * (upper - lower));
  points.forEach((count, i) => {
    const tall = room * Math.sqrt(count) / most;
    if (count > 0) context.fillRect(end(i), base - Math.max(1, tall), Math.max(1, end(i + 1) - end(i) - 0.5), Math.max(1, tall));
  });
}

const leastLogarithm = 1e-6; // of the largest value: where logarithms begin if the range has 0 in it

export class ChartSlider {
  /** @param on  {input(value): the hand moves; commit(): it rests} */
  constructor(element, canvas, on) {
    this.element = element;
    this.canvas = canvas;
    this.context = canvas.getContext('2d', {willReadFrequently: true}); // small, and painted anew while software draws the scene
    this.on = on;
    this.chart = null; // of the step that is shown; null: not there yet
    this.span = null;  // {lower, upper}: the ends of the slider
    this.stops = null; // values that it stops at, rising; null: any
    this.spectrum = null; // area and volume against the isovalue
    this.curve = 'triangles'; // or 'area', 'volume_below'
    this.scale = '';   // or 'log', 'share': of the volume below
    this.value = 0;
    this.marks = [];
    element.addEventListener('pointerdown', (event) => {
      if (!this.span || event.button !== 0) return;
      event.preventDefault();
      element.focus();
      try { element.setPointerCapture(event.pointerId); } catch { /* a pointer that is up already */ }
      this.dragging = true;
      this.take(event);
    });
    element.addEventListener('pointermove', (event) => { if (this.dragging) this.take(event); });
    for (const end of ['pointerup', 'pointercancel'])
      element.addEventListener(end, () => { if (this.dragging) { this.dragging = false; this.on.commit(); } });
    element.addEventListener('keydown', (event) => this.key(event));
    new ResizeObserver(() => this.draw()).observe(element);
  }

  range() { return this.span ? this.span.upper - this.span.lower : 0; }

  /** Part of the range, 0 to 1 between its ends. */
  evenPart(value) { return (value - this.span.lower) / (this.range() || 1); }

  /** Part of the slider, by its scale. */
  part(value) {
    if (this.scale === 'log') {
      const from = this.logStart();
      return value <= from ? 0 : Math.log(value / from) / Math.log(this.span.upper / from);
    }
    if (this.scale === 'share') return this.measured('volume_below', value) / this.spectrum.volume;
    return this.evenPart(value);
  }

  logStart() { return this.span.lower > 0 ? this.span.lower : leastLogarithm * this.span.upper; }

  /** The value at a part of the slider; of a share the least one. */
  valueAt(part) {
    const {lower, upper} = this.span;
    if (part <= 0 || part >= 1) return part <= 0 ? lower : upper;
    if (this.scale === 'log') return this.logStart() * (upper / this.logStart()) ** part;
    if (this.scale !== 'share') return lower + part * this.range();
    const {isovalues, volume_below: below, volume} = this.spectrum, wanted = part * volume, i = below.findIndex((one) => one >= wanted);
    if (i < 1) return i === 0 ? isovalues[0] : upper;
    const between = (wanted - below[i - 1]) / (below[i] - below[i - 1]);
    return isovalues[i - 1] + between * (isovalues[i] - isovalues[i - 1]);
  }

  /** The value there, in decimals that are as fine as the hand: the range, were it everywhere as here. */
  roundedAt(part, finer = 1) {
    const near = 0.005, here = this.scale ? (this.valueAt(part + near) - this.valueAt(part - near)) / (2 * near) : this.range();
    return this.limited(roundTo(this.valueAt(part), here * finer));
  }

  take(event) {
    const box = this.element.getBoundingClientRect();
    this.on.input(this.roundedAt(Math.max(0, Math.min(1, (event.clientX - box.left) / box.width))));
  }

  limited(value) { return this.allowed(Math.max(this.span.lower, Math.min(this.span.upper, value))); }

  /** The nearest value that there is. */
  allowed(value) {
    return this.stops ? this.stops.reduce((best, one) => (Math.abs(one - value) < Math.abs(best - value) ? one : best)) : value;
  }

  /** Moves by so many 200ths of the range. */
  step(steps) {
    if (!(this.range() > 0)) return;
    if (this.stops) return this.stepOverStops(steps);
    const finer = Math.min(1, Math.abs(steps));
    if (this.scale) this.on.input(this.nextByScale(steps / 200, finer));
    else this.on.input(this.limited(roundTo(this.value + steps * this.range() / 200, this.range() * finer)));
    this.on.commit();
  }

  /** Over parts of the slider that all have this value. */
  nextByScale(step, finer) {
    for (let part = this.part(this.value) + step; part > 0 && part < 1; part += step) {
      const value = this.roundedAt(part, finer);
      if ((value - this.value) * step > 0) return value;
    }
    return step < 0 ? this.span.lower : this.span.upper;
  }

  /** At least one of them. */
  stepOverStops(steps) {
    const {stops} = this, count = Math.max(1, Math.round(Math.abs(steps) * stops.length / 200));
    const at = stops.indexOf(this.allowed(this.value)) + Math.sign(steps) * count;
    this.on.input(stops[Math.max(0, Math.min(stops.length - 1, at))]);
    this.on.commit();
  }

  key(event) {
    if (!this.span || event.ctrlKey || event.altKey || event.metaKey) return;
    const fine = event.shiftKey ? 0.1 : 1;
    const steps = {ArrowLeft: -fine, ArrowDown: -fine, ArrowRight: fine, ArrowUp: fine, PageUp: 10, PageDown: -10}[event.key];
    if (steps) this.step(steps);
    else if (event.key === 'Home' || event.key === 'End') {
      this.on.input(event.key === 'Home' ? this.span.lower : this.span.upper);
      this.on.commit();
    } else return;
    event.preventDefault();
    event.stopPropagation();
  }

  /** Triangles that are expected at a value; null where nothing is known. */
  expected(value) {
    if (!this.chart || !(this.chart.lower < this.chart.upper)) return null;
    const {lower, upper, triangles} = this.chart;
    if (value < lower || value > upper) return 0;
    return triangles[Math.min(triangles.length - 1, Math.floor((value - lower) / (upper - lower) * triangles.length))];
  }

  /** Whether values of the chart are over decades, and nearly all of them at the lower end. */
  isOverDecades() {
    const {lower, upper, points} = this.chart, tenth = points.slice(0, Math.ceil(points.length / 10));
    const sum = (counts) => counts.reduce((a, b) => a + b, 0);
    return !this.stops && lower > 0 && upper / lower >= 1e4 && sum(tenth) > 0.7 * sum(points);
  }

  /** The value below which half of the triangles are where the slider goes by logarithms. */
  firstByLogarithm() {
    const {lower, upper, triangles, first} = this.chart;
    if (!(upper > 0) || this.stops) return first;
    const from = lower > 0 ? lower : leastLogarithm * upper, place = (value) => Math.log(Math.max(value, from));
    const ends = triangles.map((_, i) => [i, i + 1].map((at) => place(lower + at / triangles.length * (upper - lower))));
    const parts = ends.map(([a, b], i) => triangles[i] * (b - a));
    let half = parts.reduce((a, b) => a + b, 0) / 2;
    const at = parts.findIndex((part) => (half -= part) < 0);
    if (at < 0) return first;
    const value = Math.exp(ends[at][1] + half / parts[at] * (ends[at][1] - ends[at][0]));
    return Number(value.toPrecision(2));
  }

  /** Area or volume at a value, between two that are exact; null where nothing is known. */
  measured(name, value) {
    if (!this.spectrum || this.spectrum.isovalues.length < 2) return null;
    const {isovalues} = this.spectrum, list = this.spectrum[name], last = isovalues.length - 1;
    if (value <= isovalues[0] || value > isovalues[last]) return name === 'volume_below' && value > isovalues[0] ? list[last] : 0;
    let i = Math.min(last - 1, Math.floor((value - isovalues[0]) / (isovalues[last] - isovalues[0]) * last));
    while (i > 0 && value < isovalues[i]) --i;
    while (i < last - 1 && value > isovalues[i + 1]) ++i;
    const part = (value - isovalues[i]) / (isovalues[i + 1] - isovalues[i]);
    return list[i] + part * (list[i + 1] - list[i]);
  }

  /** The curve as points (part of the range, part of the largest). */
  line() {
    if (this.curve === 'triangles' || !this.spectrum) {
      const {lower, upper, triangles} = this.chart, largest = Math.max(1, ...triangles);
      return triangles.map((count, i) => [this.part(lower + (i + 0.5) / triangles.length * (upper - lower)), count / largest]);
    }
    const {isovalues} = this.spectrum, list = this.spectrum[this.curve], largest = Math.max(...list) || 1;
    return list.map((one, i) => [this.part(isovalues[i]), one / largest]);
  }

  set(value, marks, color) {
    this.value = value;
    this.marks = marks;
    this.color = color; // of the surface there
    const {element} = this;
    element.setAttribute('aria-valuenow', value);
    element.setAttribute('aria-valuetext', short(value));
    if (this.span) {
      element.setAttribute('aria-valuemin', this.span.lower);
      element.setAttribute('aria-valuemax', this.span.upper);
    }
    this.draw();
  }

  draw() {
    const ratio = window.devicePixelRatio || 1, {canvas, context, element} = this;
    const width = element.clientWidth, height = element.clientHeight;
    if (width === 0) return;
    canvas.width = Math.round(width * ratio);
    canvas.height = Math.round(height * ratio);
    context.setTransform(ratio, 0, 0, ratio, 0, 0);
    context.clearRect(0, 0, width, height);
    if (!this.span) return;
    const style = getComputedStyle(document.documentElement), color = (name) => style.getPropertyValue('--' + name).trim();
    if (this.chart) this.drawChart(width, height, color);
    const x = (value) => this.range() > 0 ? Math.round(Math.max(0, Math.min(1, this.part(value))) * (width - 2)) + 1 : width / 2;
    for (const mark of this.marks) {
      context.fillStyle = mark.color;
      context.fillRect(x(mark.value) - 1, 10, 2, height - 10);
    }
    context.fillStyle = color('accent');
    context.fillRect(x(this.value) - 1, 4, 2, height - 4);
    context.beginPath();
    context.arc(x(this.value), 6, 5, 0, 2 * Math.PI);
    context.fill();
    if (!this.color) return;
    context.fillStyle = this.color;
    context.beginPath();
    context.arc(x(this.value), 6, 3.5, 0, 2 * Math.PI);
    context.fill();
  }

  /** Histogram and curve, in their part of the slider. */
  drawChart(width, height, color) {
    const {context} = this, base = height - 2, room = height - 14;
    context.fillStyle = color('bars');
    paintBars(context, this.chart, (value) => this.part(value) * width, base, room);
    context.strokeStyle = color('curve');
    context.lineWidth = 1.5;
    context.lineJoin = 'round';
    context.beginPath();
    this.line().forEach(([x, y], i) => context[i ? 'lineTo' : 'moveTo'](x * width, base - room * y));
    context.stroke();
  }
}
