// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Two pages in frames. What one of them changes is passed on to the other one where it is linked.
// The address: #TOKEN&left=STATE&right=STATE&link=camera,value; with ?second the right one is of the second file.

const id = (name) => document.getElementById(name);
const links = ['camera', 'value', 'step'];
const [token, ...rest] = location.hash.slice(1).split('&'), start = new URLSearchParams(rest.join('&'));
const linked = (start.get('link') ?? 'camera,value').split(',');
const hasSecond = new URLSearchParams(location.search).has('second');
for (const link of links) id(`link-${link}`).checked = linked.includes(link);

/** The second file begins as the first one, until something is chosen in one of them. */
let followsFirst = hasSecond && !start.has('left') && !start.has('right');

function frameOf(side) {
  const element = document.createElement('iframe');
  element.title = `${side === 'left' ? 'Left' : 'Right'} picture`;
  element.src = `./?beside${hasSecond && side === 'right' ? '&second' : ''}#${token}&${start.get(side) ?? ''}`;
  id('frames').append(element);
  if (followsFirst)
    element.addEventListener('load', () => {
      for (const kind of ['pointerdown', 'wheel', 'keydown', 'input', 'change']) element.contentWindow.addEventListener(kind, () => { followsFirst = false; }, true);
    });
  return {side, element, shown: null, sent: 0, address: start.get(side) ?? ''}; // shown: as it told it last; sent: changes
}

const frames = ['left', 'right'].map(frameOf);
let latest = frames[0];

const say = ({element}, message) => element.contentWindow.postMessage(message, location.origin);

/** The other frame gets what is linked and differs. */
function passOn(from) {
  const to = frames.find((one) => one !== from), message = {};
  if (!from.shown || !to.shown) return;
  for (const link of links)
    if (id(`link-${link}`).checked && from.shown[link] !== to.shown[link] && from.shown[link] !== null) message[link] = from.shown[link];
  if (from.shown.field !== to.shown.field) delete message.value;
  if (message.step >= to.shown.steps) delete message.step;
  if (Object.keys(message).length === 0) return;
  say(to, {...message, number: ++to.sent});
}

/** Whether what one camera sees is seen by the other one: boxes of about the same size at about the same place. */
function areAlike(one, other) {
  const [size, otherSize] = [one, other].map(({lower, upper}) => Math.hypot(...upper.map((u, i) => u - lower[i])));
  const apart = Math.hypot(...one.lower.map((l, i) => (l + one.upper[i] - other.lower[i] - other.upper[i]) / 2));
  return Math.max(size, otherSize) <= 2 * Math.min(size, otherSize) && apart <= size / 2;
}

/** With folders where the files have the same name. */
function showNames() {
  const shown = frames.map((one) => one.shown).filter(Boolean);
  const names = (of) => [...new Set(shown.map(of))].join(' | ');
  id('file').textContent = hasSecond && new Set(shown.map(({file}) => file)).size < 2 ? names(({path}) => path) : names(({file}) => file);
  document.title = `${id('file').textContent} – isotet`;
}

let nameTimer = 0;

/** A bookmark, or loading again, gives the same. */
function nameSoon() {
  clearTimeout(nameTimer);
  nameTimer = setTimeout(() => {
    const parts = new URLSearchParams(frames.map(({side, element, address}) => [side, addressIn(element) ?? address]));
    parts.set('link', links.filter((link) => id(`link-${link}`).checked).join(','));
    history.replaceState(null, '', `#${token}&${parts}`);
  }, 1000);
}

/** The state that a frame's address names; null before it is loaded. */
function addressIn(element) {
  const {hash, protocol} = element.contentWindow.location;
  return protocol === 'about:' ? null : hash.split('&').slice(1).join('&');
}

addEventListener('message', ({source, origin, data}) => {
  const from = frames.find(({element}) => element.contentWindow === source);
  if (!from || origin !== location.origin) return;
  if (data.taken === 0 && from.shown?.taken > 0) Object.assign(from, {shown: null, sent: 0}); // it was loaded again
  // What it told before it took a change is past; what it tells when it takes one is no change of its own.
  const own = from.shown && data.taken === from.sent && data.taken === from.shown.taken;
  const isFirst = !from.shown;
  if (data.taken === from.sent) from.shown = data;
  if (followsFirst) {
    if (isFirst && frames.every(({shown}) => shown) && !areAlike(...frames.map(({shown}) => shown))) id('link-camera').checked = false;
    if (isFirst || own) passOn(frames[0]);
  } else if (own) {
    latest = from;
    passOn(from);
  }
  id('step-choice').hidden = !frames.every(({shown}) => shown?.steps > 1);
  showNames();
  nameSoon();
});

for (const link of links) id(`link-${link}`).addEventListener('change', () => { passOn(latest); nameSoon(); });
id('controls').addEventListener('change', () => { for (const one of frames) say(one, {panel: id('controls').checked}); });
addEventListener('popstate', () => { if (location.hash.slice(1).split('&')[0] !== token) location.reload(); });
