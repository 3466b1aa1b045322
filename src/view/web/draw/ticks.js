// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Round numbers on a colour scale, as src/render/ticks.cpp has them.
const raised = '⁰¹²³⁴⁵⁶⁷⁸⁹', minus = '\u2212';
const raisedNumber = (number) => (number < 0 ? '⁻' : '') + [...String(Math.abs(number))].map((digit) => raised[digit]).join('');
const powerOf = (value) => Math.floor(Math.log10(Math.abs(value)) + 1e-9);
const isLong = (largest) => largest >= 1e5 || largest < 1e-3;
const withMinus = (text) => text.replace(/^-/, minus);

export function numberLabel(value) {
  if (value === 0) return '0';
  const power = powerOf(value), factor = Math.abs(value) / 10 ** power;
  if (!isLong(Math.abs(value)) || !Number.isFinite(factor)) return withMinus(String(Number(value.toPrecision(Math.max(4, power + 1)))));
  return `${value < 0 ? minus : ''}${Number(factor.toPrecision(4))}×10${raisedNumber(power)}`;
}

function linearTicks(lower, upper, most) {
  const width = upper - lower, power = 10 ** Math.floor(Math.log10(width / most));
  const step = power * ([1, 2, 5, 10, 20].find((factor) => width / (factor * power) <= most - 1) || 20);
  const largest = Math.max(Math.abs(lower), Math.abs(upper));
  if (!Number.isFinite(width) || !(step > largest * 1e-12)) return []; // too narrow to tell its numbers apart
  const highest = powerOf(largest), lowest = powerOf(step);
  // A power of ten that needs every digit before the point, and more, saves nothing: 101325.2.
  const shared = isLong(largest) && !(highest > 0 && lowest <= 0) ? highest : 0, digits = Math.max(0, Math.min(12, shared - lowest));
  const label = (value) => (value === 0 ? '0' : withMinus((value / 10 ** shared).toFixed(digits)) + (shared === 0 ? '' : `×10${raisedNumber(shared)}`));
  const ticks = [];
  for (let k = Math.ceil(lower / step - 1e-9); k * step <= upper + 1e-9 * step; ++k) ticks.push([k * step, label(k === 0 ? 0 : k * step)]);
  return ticks;
}

function logarithmicTicks(lower, upper, most) {
  const first = powerOf(lower), last = powerOf(upper), few = last - first <= 2;
  const stride = Math.max(1, Math.floor((last - first + most) / most)), ticks = [];
  for (let power = first; power <= last; power += stride)
    for (const factor of few ? [1, 2, 5] : [1]) {
      const value = factor * 10 ** power;
      if (value < lower * (1 - 1e-9) || value > upper * (1 + 1e-9)) continue;
      ticks.push([value, isLong(value) && factor === 1 ? `10${raisedNumber(power)}` : numberLabel(value)]);
    }
  return ticks;
}

/** [value, label] of a scale {lower, upper, logarithmic}; `most` at most, about. */
export function ticksOf({lower, upper, logarithmic}, most) {
  const ticks = (logarithmic ? logarithmicTicks : linearTicks)(lower, upper, Math.max(2, most));
  return ticks.length > 0 ? ticks : [[lower, numberLabel(lower)], [upper, numberLabel(upper)]];
}
