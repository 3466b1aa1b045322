// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Numbers for people.

/** Six significant digits at most: 0.3127, 1.5e-7. */
export function short(value) {
  if (!Number.isFinite(value)) return '–';
  return String(Number(value.toPrecision(6)));
}

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

/** A typed number, or null. */
export function parseNumber(text) {
  const trimmed = text.trim();
  const value = Number(trimmed);
  return trimmed !== '' && Number.isFinite(value) ? value : null;
}

/** Decimals that the hand can choose: a step is a 2000th of the range or more. */
export function roundTo(value, range) {
  const step = 10 ** Math.floor(Math.log10(range / 1000));
  if (!(step > 0) || !Number.isFinite(step)) return value;
  return Number((Math.round(value / step) * step).toPrecision(12));
}
