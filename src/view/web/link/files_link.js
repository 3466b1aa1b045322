// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The link of a page without a grid: one is dropped into it, or chosen. Nothing of it leaves the page.
import {filesOfDrop, filesOfList, openfoamCase, pathsToRead} from './dropped_files.js';
import {EngineLink} from './engine_link.js';
import {partText, savedMessage} from './unpack.js';

function element(kind, attributes, ...children) {
  const made = Object.assign(document.createElement(kind), attributes);
  made.append(...children);
  return made;
}

export class Link extends EngineLink {
  constructor(_token, on) {
    super(on);
    this.makeControls();
    this.takeDrops();
  }

  makeControls() {
    const files = element('input', {type: 'file', multiple: true, hidden: true, id: 'chosen-files'});
    const folder = element('input', {type: 'file', webkitdirectory: true, hidden: true, id: 'chosen-folder'});
    for (const input of [files, folder]) input.addEventListener('change', () => { this.open(filesOfList(input.files)); input.value = ''; });
    const button = (text, input) => {
      const made = element('button', {type: 'button', textContent: text, title: 'Open a grid of this machine'});
      made.addEventListener('click', () => input.click());
      return made;
    };
    this.panel = element('section', {id: 'drop'}, element('h2', {textContent: 'Drop a grid here'}), button('Choose files…', files), ' ', button('Choose a folder…', folder),
      element('p', {textContent: 'VTU, PVTU, legacy VTK, OpenFOAM, Gmsh, Medit, TetGen, AVS UCD, CalculiX, Gocad, GRDECL or a packed grid. Of a file that names others, drop all or their folder; of OpenFOAM, the folder of the case.'}),
      element('p', {textContent: 'Nothing leaves this machine: the page reads the files itself, and loads nothing.'}));
    this.panel.setAttribute('aria-label', 'Open a grid');
    document.getElementById('stage').append(this.panel, files, folder);
    document.querySelector('.top').prepend(button('Open…', files));
  }

  takeDrops() {
    const stage = document.documentElement, mark = (over) => document.body.classList.toggle('dropping', over);
    stage.addEventListener('dragover', (event) => { event.preventDefault(); mark(true); });
    stage.addEventListener('dragleave', (event) => { if (!event.relatedTarget) mark(false); });
    stage.addEventListener('drop', (event) => {
      event.preventDefault();
      mark(false);
      filesOfDrop(event.dataTransfer).then((files) => this.open(files)).catch((error) => this.failed(error.message));
    });
  }

  /** @param given  [{path, blob}] */
  async open(given) {
    if (given.length === 0) return;
    const place = openfoamCase(given.map(({path}) => path))?.place ?? ((path) => path);
    const blobs = given.map(({path, blob}) => ({path: place(path), blob}));
    this.forget();
    this.on.other();
    this.panel.hidden = true;
    this.on.text({say: 'progress', step: 'read', fraction: 0});
    const files = pathsToRead(blobs.map(({path}) => path));
    this.begin(() => ({engine: partText('engine'), blobs, told: {file: files[0] === '.' ? 'OpenFOAM case' : files[0].split('/').pop(), version: savedMessage().version, files}}));
  }

  take(message) {
    super.take(message);
    // Nothing is shown: another file may be chosen.
    if (message.text?.say === 'error' && !this.ready) {
      this.panel.hidden = false;
      this.on.text({say: 'progress', step: 'ready', fraction: 1});
    }
  }
}
