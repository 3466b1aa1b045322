// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Sections of the panel that are folded stay so in this browser.
const foldKey = 'isotet-folded';

/** A page in another one's frame may have no storage. */
function foldedBefore() {
  try { return JSON.parse(localStorage.getItem(foldKey)) ?? []; } catch { return []; }
}

const foldable = [...document.querySelectorAll('details.fold')], folded = foldedBefore();
for (const section of foldable) {
  if (Array.isArray(folded) && folded.includes(section.dataset.fold)) section.open = false;
  section.addEventListener('toggle', () => {
    try { localStorage.setItem(foldKey, JSON.stringify(foldable.filter(({open}) => !open).map(({dataset}) => dataset.fold))); } catch { /* kept until the page goes */ }
  });
  // What is switched on beside the title has its controls here.
  section.parentElement.querySelector('.aside input')?.addEventListener('change', ({target}) => { if (target.checked) section.open = true; });
}
