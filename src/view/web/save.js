// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The dialog that saves files: as downloads, or by name into the folder of --out.
import {id} from './app.js';
import {parseNumber, short} from './format.js';

const solids = ['above', 'below'];
const surfaceRule = 'The name ends in .vtp, .vtk, .ply, .stl, .3mf, .glb, .usda, .obj or .ts.';
const rules = {above: `Closed: the grid where the field is at least the value of the slider. ${surfaceRule}`,
  below: `Closed: the grid where the field is less than the value of the slider. ${surfaceRule}`, seen: 'The name ends in .png.', picture: 'The name ends in .png.', surface: surfaceRule,
  sweep: 'The name ends in .webp.', turn: 'The name ends in .webp.', steps: 'The name ends in .webp.',
  series: 'The name ends in .glb. A file for each step is written by Copy extract, with “Extract from all time steps”.'};
const asked = {above: [], below: [], seen: [], picture: ['width', 'height'], surface: [], sweep: ['width', 'height', 'from', 'to', 'pictures'],
  turn: ['width', 'height', 'pictures'], steps: ['width', 'height'], series: []};

/** Hands bytes to the browser as a file. */
function handOut(name, blob) {
  const link = document.createElement('a');
  link.href = URL.createObjectURL(blob);
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 60000);
}

export class Save {
  /** @param on  {state(): as messages have it, name(): of a file without its ending, size(): [w, h], range(): [lower, upper], steps(): how many,
   *              seen(): the picture on a canvas, send(message): whether it went} */
  constructor(on) {
    this.on = on;
    this.out = '';
    this.endings = ''; // of surfaces, where they are not those of isotet extract
    this.number = 0;  // behind names that are taken
    this.own = '';    // the name that the page gave
    this.file = null; // that comes: {name, bytes, parts, got}
    id('save-open').addEventListener('click', () => this.open());
    id('save-close').addEventListener('click', () => id('save').close());
    id('save-kind').addEventListener('change', () => this.show());
    id('save-to').addEventListener('change', () => this.show());
    id('save-name').addEventListener('input', () => this.showCommand());
    id('save-form').addEventListener('submit', (event) => { event.preventDefault(); this.go(); });
  }

  open() {
    const [width, height] = this.on.size(), [lower, upper] = this.on.range();
    id('save-width').value = width;
    id('save-height').value = height;
    id('save-from').value = short(lower + 0.05 * (upper - lower));
    id('save-to-value').value = short(upper - 0.05 * (upper - lower));
    id('save-to').options[1].disabled = !this.out;
    id('save-to').options[1].textContent = this.out ? `Folder ${this.out} of the server` : 'Folder of the server: start with --out FOLDER';
    if (!this.out) id('save-to').value = '';
    for (const kind of ['steps.webp', 'series.glb']) {
        const option = id('save-kind').querySelector(`[value="${kind}"]`);
        option.hidden = option.disabled =
            this.endings !== '' || this.on.steps() < 2; // some browsers list what is hidden
    }
    this.command = null;
    this.on.send({do: 'command', state: this.on.state()});
    this.show();
    id('save').showModal();
  }

  /** "surface.stl": kind and ending. */
  chosen() { return id('save-kind').value.split('.'); }

  show() {
    const [kind, ending] = this.chosen(), fits = id('save-name').value.endsWith(`.${ending}`) && id('save-name').value !== this.own;
    if (!fits) this.suggest(ending);
    id('save-hint').textContent = kind === 'surface' && this.endings ? `The name ends in ${this.endings}; places are as exact as on the screen.` : rules[kind];
    id('save-size').hidden = !asked[kind].includes('width');
    id('save-values').hidden = kind !== 'sweep';
    id('save-many').hidden = !asked[kind].includes('pictures');
    id('save-to').disabled = kind === 'seen';
    if (kind === 'seen') id('save-to').value = '';
    id('save-go').textContent = id('save-to').value === '' ? 'Download' : 'Save';
    this.tell('');
    this.showCommand();
  }

  suggest(ending) {
    const [kind] = this.chosen();
    this.own = `${this.on.name()}${solids.includes(kind) ? `-${kind}` : ''}${this.number ? `-${this.number}` : ''}.${ending}`;
    id('save-name').value = this.own;
  }

  /** The command lines of what is shown, {render, extract}. */
  takeCommand(message) {
    this.command = message;
    this.showCommand();
  }

  showCommand() {
    const [kind] = this.chosen(), which = {surface: 'extract', series: 'extract_all', above: 'extract', below: 'extract', picture: 'render'}[kind];
    const solid = solids.includes(kind) ? ` --solid ${kind}` : '', all = this.command?.[which] || '';
    const own = kind === this.on.state().solid, other = own ? / --solid \S+/ : / --solid \S+| --keep (parts|not):\S+/g; // numbers of parts are of what is shown
    const text = solid ? all.replace(/(--isovalue[ =][^ ,]+),\S*/, '$1').replace(other, '') : all;
    id('save-command').textContent = text.replace(/ -o \S+$/, () => `${solid} -o ${/ /.test(id('save-name').value) ? `'${id('save-name').value}'` : id('save-name').value}`);
  }

  tell(sentence, busy = false) {
    id('save-told').textContent = sentence;
    id('save-go').disabled = busy;
  }

  go() {
    const [kind] = this.chosen(), number = (name) => parseNumber(id('save-' + name).value), name = id('save-name').value.trim();
    if (kind === 'seen') return this.handOutPicture(name);
    const message = {do: 'save', kind, name, state: this.on.state(), download: id('save-to').value === ''};
    if (solids.includes(kind)) message.state.isovalues.length = 1; // solids of several would lie in each other
    for (const key of asked[kind]) {
      const box = key === 'to' ? 'to-value' : key;
      message[key] = number(box);
      const fits = message[key] !== null && (key === 'from' || key === 'to' || (Number.isInteger(message[key]) && message[key] > 0));
      id('save-' + box).setAttribute('aria-invalid', !fits);
      if (!fits) return this.tell(`${id('save-' + box).getAttribute('aria-label') || 'Pictures'} takes a number.`);
    }
    this.tell(`Writing ${message.name} …`, true);
    if (!this.on.send(message)) this.tell('There is no connection.');
  }

  handOutPicture(name) {
    this.on.seen().toBlob((blob) => {
      handOut(name, blob);
      this.done(`Downloaded: ${name}`);
    }, 'image/png');
  }

  done(sentence) {
    ++this.number;
    if (id('save-name').value === this.own) this.suggest(this.chosen()[1]);
    this.showCommand();
    this.tell(sentence);
  }

  /** The server has written a file, and sends its parts one after another. */
  begin({name, bytes}) {
    this.file = {name, bytes, parts: [], got: 0};
    this.on.send({do: 'part'});
  }

  takePart(part) {
    const {file} = this;
    if (!file) return;
    file.parts.push(part);
    file.got += part.byteLength;
    if (part.byteLength > 0 && file.got < file.bytes) {
      this.tell(`${file.name}: ${Math.floor(100 * file.got / file.bytes)} %`, true);
      return this.on.send({do: 'part'});
    }
    this.file = null;
    if (file.got !== file.bytes) return this.tell(`${file.name} came in part only: ${file.got} of ${file.bytes} bytes.`);
    handOut(file.name, new Blob(file.parts));
    this.done(`Downloaded: ${file.name}`);
  }

  /** Another connection knows nothing of a file that was on its way. */
  lost() {
    this.file = null;
    if (id('save-go').disabled) this.tell('The connection was lost, and the file with it.');
  }
}
