// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Bytes in a file: base64, and inflated by the browser.

export function fromBase64(text) {
  if (Uint8Array.fromBase64) return Uint8Array.fromBase64(text);
  const letters = atob(text), bytes = new Uint8Array(letters.length);
  for (let i = 0; i < letters.length; ++i) bytes[i] = letters.charCodeAt(i);
  return bytes;
}

/** A stream of inflated bytes. */
export const inflated = (bytes) => new Blob([bytes]).stream().pipeThrough(new DecompressionStream('deflate'));

/** All that a stream gives. */
export const allBytes = async (stream) => new Uint8Array(await new Response(stream).arrayBuffer());
