// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Numbers for people.

/** Six significant digits at most, and a power of ten from a million on and below a ten thousandth: 0.3127, 1.5e-7, 3.64e14. */
export const short = (value) => rounded(value, 6);

export function rounded(value, digits) {
  if (!Number.isFinite(value)) return '–';
  const size = Math.abs(value);
  if (size === 0 || (size >= 1e-4 && size < 1e6)) return String(Number(value.toPrecision(digits)));
  const [factor, power] = value.toExponential(digits - 1).split('e');
  return `${Number(factor)}e${Number(power)}`;
}

/** In a box: all digits of a number that has few of them. */
export function ofBox(value) {
  if (value === null) return '';
  const text = rounded(value, 9);
  return Number(text) === value ? text : short(value);
}

/** Of a whole: 54 %, 0.3 %. */
export const share = (part, whole) => (whole > 0 ? `${rounded(100 * part / whole, 2)} %` : '–');

/** 1,234,567 */
export function grouped(count) {
  return Math.round(count).toString().replace(/\B(?=(\d{3})+$)/g, ',');
}

/** About: 950, 12 k, 3.6 M. */
export function rough(count) {
  for (const [size, name] of [[1e9, ' G'], [1e6, ' M'], [1e3, ' k']]) {
    if (count >= size) return (count / size).toPrecision(count >= 100 * size ? 3 : 2) + name;
  }
  return String(Math.round(count));
}

/** 0.4 ms, 12 ms, 1.5 s */
export function duration(ms) {
  if (ms >= 1000) return (ms / 1000).toFixed(1) + ' s';
  return ms >= 10 ? Math.round(ms) + ' ms' : ms.toFixed(1) + ' ms';
}

/** 512 B, 1.2 MB: a MB is 10^6 bytes. */
export function bytes(count) {
  for (const [size, name] of [[1e9, ' GB'], [1e6, ' MB'], [1e3, ' kB']]) {
    if (count >= size) return (count / size).toFixed(1) + name;
  }
  return count + ' B';
}

/** A typed number, also with a decimal comma; "50 %" of a range {lower, upper}, where there is one. Else null. */
export function parseNumber(text, range = null) {
  const percent = range && text.trim().endsWith('%');
  const trimmed = (percent ? text.trim().slice(0, -1) : text).trim().replace(/^([^.,]*),([^.,]*)$/, '$1.$2');
  const value = Number(trimmed);
  if (trimmed === '' || !Number.isFinite(value)) return null;
  const part = value / 100;
  return percent ? (1 - part) * range.lower + part * range.upper : value; // exact at both ends
}

/** "90%v" and "p95", as the command line takes them: {of, percent}. Else null. */
export function parseShare(text) {
  const number = (digits) => (digits !== undefined && Number(digits) <= 100 ? Number(digits) : null);
  const [, volume, points] = /^(?:(\d+\.?\d*|\.\d+)\s*%\s*v|p\s*(\d+\.?\d*|\.\d+))$/i.exec(text.trim().replace(',', '.')) || [];
  if (number(volume) !== null) return {of: 'volume', percent: number(volume)};
  return number(points) === null ? null : {of: 'points', percent: number(points)};
}

/** Decimals that the hand can choose: a step is a 2000th of the range or more. */
export function roundTo(value, range) {
  const step = 10 ** Math.floor(Math.log10(range / 1000));
  if (!(step > 0) || !Number.isFinite(step)) return value;
  return Number((Math.round(value / step) * step).toPrecision(12));
}
