// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// What the page shows, as a value, and as the part of the address behind the token.

export const firstState = () => ({
  field: '', value: null, pins: [], // [{value, color, opacity}], color null: the one that isotet render gives
  color: null, opacity: null,       // of the surface that the slider moves
  colorBy: '', map: 'viridis', range: null, logarithmic: false, outline: false, edges: false, camera: null,
  boundary: 0.1, isosurfaces: true, coloredBoundary: false, // by colorBy
  solid: '', // 'above' or 'below' in place of isosurfaces
  keep: '', // connected parts, as --keep takes them; all
  planes: [], step: null, drawn: '', // 'server': pictures, 'browser': never
  volume: null, // {opacity, length, surfaces, shaded}: as isotet render --volume draws it
  hidden: [], // names of classes of colorBy: their cells are left out
  cells: [], // as --cells takes them: only these cells
  up: 'z', stretch: null, // the axis that points upwards; [x, y, z], factors of the axes
  labels: true, // scale, field, isovalue and time in the scene
  span: '', // of the slider: 'step', else all steps that were seen
  scale: '', // of the slider: 'log', 'share' of the volume, else values
  // planes: [{kind: 'clip' or 'slice', normal, offset}]
});

const isColor = (text) => /^#[0-9a-f]{6}$/.test(text);
/** Whether a text is one of --keep that the page shows. */
export const isKeptParts = (text) => text.length <= 4096 && /^(largest|0*[1-9]\d{0,17}|(area|volume)>\+?(\d+\.?\d*|\.\d+)(e[+-]?\d+)?|touching:boundary|(parts|not):\d{1,18}(,\d{1,18})*)$/i.test(text);

const isPart = (number) => Number.isFinite(number) && number >= 0 && number <= 1;

const upAxes = ['z', 'y', 'x', '-z', '-y', '-x'];
export const factorsOf = ({stretch}) => stretch ?? [1, 1, 1];

export const maxPlanes = 6; // of a kind
export const planesOf = (state, kind) => state.planes.filter((plane) => plane.kind === kind);

export function toAddress(state) {
  const parts = new URLSearchParams();
  parts.set('f', state.field);
  if (state.value !== null) parts.set('i', state.value);
  if (state.color) parts.set('c', state.color);
  if (state.opacity !== null) parts.set('o', state.opacity);
  for (const pin of state.pins) parts.append('pin', [pin.value, pin.color || '', pin.opacity ?? ''].join(','));
  if (state.colorBy) parts.set('by', state.colorBy);
  if (state.map !== 'viridis') parts.set('map', state.map);
  if (state.range) parts.set('range', state.range.join(','));
  for (const flag of ['logarithmic', 'outline', 'edges']) if (state[flag]) parts.set(flag, 1);
  if (state.boundary !== 0.1) parts.set('boundary', state.boundary);
  if (!state.isosurfaces) parts.set('isosurfaces', 0);
  if (state.coloredBoundary) parts.set('colored', 1);
  if (state.solid) parts.set('solid', state.solid);
  if (state.keep) parts.set('keep', state.keep);
  for (const {kind, normal, offset} of state.planes) parts.append(kind, [...normal, offset].join(','));
  if (state.step !== null) parts.set('step', state.step);
  if (state.drawn) parts.set('drawn', state.drawn);
  if (state.span) parts.set('span', state.span);
  if (state.scale) parts.set('scale', state.scale);
  if (state.volume) parts.set('volume', state.volume.opacity);
  if (state.volume?.length) parts.set('length', state.volume.length);
  if (state.volume?.surfaces) parts.set('surfaces', 1);
  if (state.volume?.shaded) parts.set('shaded', 1);
  for (const name of state.hidden) parts.append('hidden', name);
  for (const cells of state.cells) parts.append('cells', cells);
  if (state.up !== 'z') parts.set('up', state.up);
  if (state.stretch) parts.set('stretch', state.stretch.join(','));
  if (!state.labels) parts.set('labels', 0);
  if (state.camera) parts.set('camera', state.camera);
  return parts.toString();
}

/** What of an address makes sense; nothing of it is trusted. */
export function fromAddress(text) {
  const parts = new URLSearchParams(text), state = firstState();
  const number = (t) => (t !== null && t.trim() !== '' && Number.isFinite(Number(t)) ? Number(t) : null);
  state.field = parts.get('f') || '';
  state.value = number(parts.get('i'));
  if (isColor(parts.get('c') || '')) state.color = parts.get('c');
  const opacity = number(parts.get('o'));
  if (opacity !== null && isPart(opacity)) state.opacity = opacity;
  for (const pin of parts.getAll('pin').slice(0, 31)) {
    const [value, color, part] = pin.split(',');
    if (number(value ?? null) === null) continue;
    const seen = number(part ?? null);
    state.pins.push({value: Number(value), color: isColor(color || '') ? color : null, opacity: seen !== null && isPart(seen) ? seen : null});
  }
  state.colorBy = parts.get('by') || '';
  state.map = parts.get('map') || 'viridis';
  const range = (parts.get('range') || '').split(',').map(Number);
  if (range.length === 2 && range.every(Number.isFinite) && range[0] < range[1]) state.range = range;
  for (const flag of ['logarithmic', 'outline', 'edges']) state[flag] = parts.get(flag) === '1';
  const boundary = number(parts.get('boundary'));
  if (boundary !== null && isPart(boundary)) state.boundary = boundary;
  state.isosurfaces = parts.get('isosurfaces') !== '0';
  state.coloredBoundary = parts.get('colored') === '1';
  if (['above', 'below'].includes(parts.get('solid'))) state.solid = parts.get('solid');
  if (isKeptParts(parts.get('keep') || '')) state.keep = parts.get('keep');
  for (const [kind, text] of parts) {
    if (!['clip', 'slice'].includes(kind) || planesOf(state, kind).length >= maxPlanes) continue;
    const numbers = text.split(',').map(Number);
    if (numbers.length === 4 && numbers.every(Number.isFinite) && Math.hypot(...numbers.slice(0, 3)) > 0)
      state.planes.push({kind, normal: numbers.slice(0, 3), offset: numbers[3]});
  }
  const step = number(parts.get('step'));
  if (step !== null && Number.isInteger(step) && step >= 0) state.step = step;
  if (['server', 'browser'].includes(parts.get('drawn'))) state.drawn = parts.get('drawn');
  if (parts.get('span') === 'step') state.span = 'step';
  if (['log', 'share'].includes(parts.get('scale'))) state.scale = parts.get('scale');
  if (parts.get('volume')) {
    const length = number(parts.get('length'));
    state.volume = {opacity: parts.get('volume').slice(0, 4096), length: length > 0 ? length : null, surfaces: parts.get('surfaces') === '1', shaded: parts.get('shaded') === '1'};
  }
  state.hidden = parts.getAll('hidden').slice(0, 12);
  state.cells = parts.getAll('cells').slice(0, 7);
  if (upAxes.includes(parts.get('up'))) state.up = parts.get('up');
  const stretch = (parts.get('stretch') || '').split(',').map(Number);
  if (stretch.length === 3 && stretch.every((one) => one > 0 && one < Infinity)) state.stretch = stretch;
  state.labels = parts.get('labels') !== '0';
  state.camera = parts.get('camera');
  return state;
}

/** The field that colours: a volume has its own colours. */
export const coloredBy = ({volume, field, colorBy}) => (volume ? field : colorBy);

const maxChoiceBytes = 4096, maxChoices = 9; // of messages (src/view/state.hpp)
const bytesOf = (text) => new TextEncoder().encode(text).length;

/** Of --cells: without the classes that are hidden. */
export function cellsOf({cells, hidden, colorBy}) {
  if (hidden.length === 0 || !colorBy) return cells;
  const choices = [];
  for (const name of hidden) {
    const more = choices.length > 0 ? `${choices.at(-1)},${name}` : '', alone = `!${colorBy}=${name}`;
    if (more && bytesOf(more) <= maxChoiceBytes) choices[choices.length - 1] = more;
    else if (bytesOf(alone) <= maxChoiceBytes) choices.push(alone);
  }
  return [...cells, ...choices].slice(0, maxChoices);
}

/** As messages have it (src/view/state.hpp). */
export function toMessage(state) {
  const message = {field: state.field, isovalues: [state.value, ...state.pins.map((pin) => pin.value)], color_by: state.colorBy,
    map: state.map, logarithmic: state.logarithmic, outline: state.outline,
    edges: state.edges, boundary: state.boundary, isosurfaces: state.isosurfaces, colored_boundary: state.coloredBoundary};
  for (const kind of ['clip', 'slice']) message[kind + 's'] = planesOf(state, kind).map(({normal, offset}) => [...normal, offset]);
  if (state.solid) message.solid = state.solid;
  if (state.keep) message.keep = state.keep;
  if (cellsOf(state).length > 0) message.cells = cellsOf(state);
  if (state.step !== null) message.step = state.step;
  if (state.value === null) message.isovalues.shift();
  if (state.range) message.range = state.range;
  if (state.camera) message.camera = state.camera;
  if (state.stretch) message.stretch = state.stretch;
  if (state.volume) {
    const {opacity, length, surfaces, shaded} = state.volume;
    message.volume = length ? {opacity, length, surfaces, shaded} : {opacity, surfaces, shaded};
    if (state.colorBy !== state.field) message.color_by = '';
  }
  const opacities = [state.opacity, ...state.pins.map((pin) => pin.opacity)];
  if (opacities[0] !== null && opacities.every((one) => one === opacities[0])) message.opacity = opacities[0];
  return message;
}

export function fromMessage(message) {
  const state = firstState(), [value = null, ...pins] = message.isovalues;
  const opacity = message.opacity ?? null;
  return {...state, field: message.field, value, pins: pins.map((one) => ({value: one, color: null, opacity})), opacity,
    colorBy: message.color_by, map: message.map, logarithmic: message.logarithmic, outline: message.outline,
    edges: message.edges, boundary: message.boundary, isosurfaces: message.isosurfaces ?? true, coloredBoundary: message.colored_boundary ?? false,
    solid: message.solid ?? '', keep: message.keep ?? '', step: message.step ?? null, cells: message.cells ?? [],
    planes: ['clip', 'slice'].flatMap((kind) => message[kind + 's'].map((plane) => ({kind, normal: plane.slice(0, 3), offset: plane[3]}))),
    volume: message.volume ? {length: null, shaded: false, ...message.volume} : null,
    range: message.range ?? null, camera: message.camera ?? null, stretch: message.stretch ?? null};
}
