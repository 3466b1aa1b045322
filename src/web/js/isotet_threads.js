// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Begins and ends the workers of isotet_engine_threads.wasm, which share its memory (isotet_thread.js).

const isNode = typeof process !== 'undefined' && process.versions?.node !== undefined;
const address = () => new URL('isotet_thread.js', import.meta.url);
const stackBytes = 1 << 20, firstPages = 512, mostPages = 65536; // of 64 kB, as src/web/CMakeLists.txt has them

export const mostThreads = 16; // of src/web/portable/web_workers.h

/** How many threads a grid gets where the caller names no number: one, unless the page is isolated. */
export const threadsHere = () => (globalThis.crossOriginIsolated === true ? navigator.hardwareConcurrency : 1);

const mayShare = () => typeof SharedArrayBuffer !== 'undefined' && (isNode || globalThis.crossOriginIsolated === true);

/** Memory that threads share; null where there is none, as in browsers of 32 bits. */
export function sharedMemory() {
  try {
    return mayShare() ? new WebAssembly.Memory({initial: firstPages, maximum: mostPages, shared: true}) : null;
  } catch {
    return null;
  }
}

/** A memory as it is now: its buffer is not that of before where another thread has made it grow. */
export const grown = (memory) => ({
  get buffer() {
    memory.grow(0);
    return memory.buffer;
  },
});

/** Says `begun` or `failed` once; `told` as isotet_thread.js has it. Returns what ends the worker. */
async function beginOne(told, begun, failed) {
  if (isNode) {
    const worker = new (await import('node:worker_threads')).Worker(address(), {workerData: told});
    worker.once('message', () => {
      worker.unref(); // the process ends without it
      begun();
    });
    worker.on('error', failed);
    return () => worker.terminate();
  }
  const worker = new Worker(new URL('isotet_thread.js', import.meta.url), {type: 'module'});
  worker.onmessage = begun;
  worker.onerror = failed;
  worker.postMessage(told);
  return () => worker.terminate();
}

/**
 * Begins workers; those that cannot begin are missing.
 * @returns  functions that end them
 */
export async function beginThreads(count, module, memory, exports) {
  const begin = async (number) => {
    const stack = exports.worker_memory(stackBytes), variables = exports.worker_memory(exports.__tls_size.value);
    if (stack === 0 || variables === 0) return null;
    let end = null;
    try {
      const told = {module, memory, number, stack: stack + stackBytes, variables};
      await new Promise((begun, failed) => { beginOne(told, begun, failed).then((made) => { end = made; }, failed); });
      return end;
    } catch {
      end?.();
      return null;
    }
  };
  const ends = (await Promise.all(Array.from({length: count}, (_, i) => begin(i + 1)))).filter((end) => end !== null);
  exports.set_threads(1 + ends.length);
  return ends;
}
