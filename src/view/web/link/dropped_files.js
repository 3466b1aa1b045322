// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Files that were dropped on the page: which of them is the grid, and which are read because it names them.

/** Files that name others come first; what is named like a mesh beside it is no grid. */
const kinds = [['.pvd', '.series'], ['.vtm', '.vtmb', '.vtpc', '.vth', '.vthb'], ['.pvtu', '.pvts', '.pvtr', '.pvti'],
  ['.vtu', '.vtk', '.msh', '.mesh', '.meshb', '.node', '.isotet', '.frd', '.inp', '.avs', '.ucd', '.so', '.grdecl', '.vts', '.vtr', '.vti']];
const companions = ['.sol', '.solb', '.ele', '.face', '.edge', '.neigh'];

const ending = (path) => (path.match(/\.[^./]+$/)?.[0] || '').toLowerCase();
const inOrder = (a, b) => a.localeCompare(b, 'en', {numeric: true});

/** The path to read, a folder for a case of OpenFOAM; behind it those of the same kind, which are a time step each, where no file names them. */
export function pathsToRead(paths) {
  const found = openfoamCase(paths);
  if (found) return [found.folder];
  const sorted = [...paths].sort(inOrder);
  for (const [rank, endings] of kinds.entries()) {
    const found = sorted.filter((path) => endings.includes(ending(path)));
    if (found.length > 0) return rank < kinds.length - 1 ? [found[0]] : found.filter((path) => ending(path) === ending(found[0]));
  }
  return sorted.filter((path) => !companions.includes(ending(path))).concat(sorted).slice(0, 1);
}

const meshFiles = /^(points|faces|owner|neighbour|boundary|cells|(cell|face|point)Zones|(cell|face|point|boundary)(ProcAddressing|Level)|meshModifiers|sets)(\.gz)?$/;

/**
 * The case of OpenFOAM among the paths: its folder, and where files belong whose folders were not dropped: those of a mesh
 * into constant/polyMesh, fields into the time 0.
 * @returns  {folder, place(path)}; null where there is none
 */
export function openfoamCase(paths) {
  const sorted = [...paths].sort(inOrder), shortest = (all) => all.sort((a, b) => a.length - b.length)[0];
  const time = '[-+0-9.eE]+', whole = new RegExp(`^(|.*?/)(?:processors?\\d[^/]*/)?(?:constant|${time})/(?:[^/]+/)?polyMesh/faces(?:\\.gz)?$`);
  const folder = shortest(sorted.map((path) => path.match(whole)?.[1]).filter((found) => found !== undefined));
  if (folder !== undefined) return {folder: folder.slice(0, -1) || '.', place: (path) => path};
  const all = new Set(paths), beside = (at) => ['points', 'owner'].every((name) => all.has(at + name) || all.has(`${at}${name}.gz`));
  const mesh = shortest(sorted.map((path) => path.match(/^(|.*\/)faces(?:\.gz)?$/)?.[1]).filter((found) => found !== undefined && beside(found)));
  if (mesh === undefined) return null;
  const around = mesh.replace(/(^|\/)polyMesh\/$/, '$1');
  const place = (path) => {
    const inMesh = path.startsWith(mesh) ? path.slice(mesh.length) : '', rest = path.startsWith(around) ? path.slice(around.length) : path;
    if (inMesh && (mesh !== around || meshFiles.test(inMesh))) return `constant/polyMesh/${inMesh}`;
    return rest.includes('/') ? rest : `0/${rest}`;
  };
  return {folder: '.', place};
}

/** What a folder that was dropped holds, [{path, blob}]. */
async function filesIn(folder) {
  const reader = folder.createReader(), entries = [];
  const part = () => new Promise((take, fail) => reader.readEntries(take, fail));
  for (let more = await part(); more.length > 0; more = await part()) entries.push(...more);
  return (await Promise.all(entries.map(filesOf))).flat();
}

const filesOf = (entry) => (entry.isDirectory ? filesIn(entry) :
  new Promise((take, fail) => entry.file((blob) => take([{path: entry.fullPath.replace(/^\/+/, ''), blob}]), fail)));

/** The same by a handle, which Chromium has: of entries it gives a page that was opened from a disk none. */
async function filesOfHandle(handle, path) {
  if (handle.kind === 'file') return [{path, blob: await handle.getFile()}];
  const all = [];
  for await (const one of handle.values()) all.push(filesOfHandle(one, `${path}/${one.name}`));
  return (await Promise.all(all)).flat();
}

async function filesOfItem({entry, handle, blob}) {
  if (!entry?.isDirectory) return [{path: blob.name, blob}];
  const given = await handle;
  return given ? filesOfHandle(given, given.name) : filesIn(entry);
}

/** @returns  a promise of [{path, blob}] */
export async function filesOfDrop(data) {
  // All are asked for at once: later, the browser has forgotten the drop.
  const items = [...data.items].filter(({kind}) => kind === 'file')
    .map((item) => ({entry: item.webkitGetAsEntry?.(), handle: item.getAsFileSystemHandle?.().catch(() => null), blob: item.getAsFile()}));
  try {
    return (await Promise.all(items.map(filesOfItem))).flat();
  } catch (error) {
    throw new Error(`the browser does not give the page what was dropped (${error.message}): choose it by the buttons`);
  }
}

export const filesOfList = (list) => [...list].map((blob) => ({path: blob.webkitRelativePath || blob.name, blob}));
