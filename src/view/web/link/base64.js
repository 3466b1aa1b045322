// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Bytes in a file: base64, and inflated by the browser.

/** Why a part cannot be read. */
export const damaged = () => new Error('this page was damaged on its way: get it once more');

export function fromBase64(text) {
  try {
    if (Uint8Array.fromBase64) return Uint8Array.fromBase64(text);
    const letters = atob(text), bytes = new Uint8Array(letters.length);
    for (let i = 0; i < letters.length; ++i) bytes[i] = letters.charCodeAt(i);
    return bytes;
  } catch {
    throw damaged();
  }
}

/** A stream of inflated bytes. */
export const inflated = (bytes) => new Blob([bytes]).stream().pipeThrough(new DecompressionStream('deflate'));

/** All that a stream gives. */
export async function allBytes(stream) {
  try {
    return new Uint8Array(await new Response(stream).arrayBuffer());
  } catch (error) {
    throw error instanceof RangeError ? error : damaged(); // no memory
  }
}
