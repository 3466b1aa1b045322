// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Files that were dropped on the page: which of them is the grid, and which are read because it names them.

/** Files that name others come first; what is named like a mesh beside it is no grid. */
const kinds = [['.pvd', '.series'], ['.vtm', '.vtmb', '.vtpc', '.vth', '.vthb'], ['.pvtu', '.pvts', '.pvtr', '.pvti'],
  ['.vtu', '.vtk', '.msh', '.mesh', '.meshb', '.node', '.isotet', '.frd', '.inp', '.avs', '.so', '.grdecl', '.vts', '.vtr', '.vti']];
const companions = ['.sol', '.solb', '.ele', '.face', '.edge', '.neigh'];

const ending = (path) => (path.match(/\.[^./]+$/)?.[0] || '').toLowerCase();
const inOrder = (a, b) => a.localeCompare(b, 'en', {numeric: true});

/** The path to read; behind it those of the same kind, which are a time step each, where no file names them. */
export function pathsToRead(paths) {
  const sorted = [...paths].sort(inOrder);
  for (const [rank, endings] of kinds.entries()) {
    const found = sorted.filter((path) => endings.includes(ending(path)));
    if (found.length > 0) return rank < kinds.length - 1 ? [found[0]] : found.filter((path) => ending(path) === ending(found[0]));
  }
  return sorted.filter((path) => !companions.includes(ending(path))).concat(sorted).slice(0, 1);
}

/** What a folder that was dropped holds, [{path, blob}]. */
async function filesIn(folder) {
  const reader = folder.createReader(), entries = [];
  const part = () => new Promise((take, fail) => reader.readEntries(take, fail));
  for (let more = await part(); more.length > 0; more = await part()) entries.push(...more);
  return (await Promise.all(entries.map(filesOf))).flat();
}

function filesOf(entry) {
  if (entry.isDirectory) return filesIn(entry);
  const refused = 'the browser lets a page on a disk read files, but no folders: drop the files, or choose them';
  return new Promise((take, fail) => entry.file((blob) => take([{path: entry.fullPath.replace(/^\/+/, ''), blob}]), () => fail(new Error(refused))));
}

/** Files are asked for themselves: Chromium gives a page that was opened from a disk none by their entries. */
const filesOfItem = ({entry, blob}) => (entry?.isDirectory ? filesIn(entry) : [{path: blob.name, blob}]);

/** @returns  a promise of [{path, blob}] */
export async function filesOfDrop(data) {
  const items = [...data.items].filter(({kind}) => kind === 'file').map((item) => ({entry: item.webkitGetAsEntry?.(), blob: item.getAsFile()}));
  return (await Promise.all(items.map(filesOfItem))).flat();
}

export const filesOfList = (list) => [...list].map((blob) => ({path: blob.webkitRelativePath || blob.name, blob}));
