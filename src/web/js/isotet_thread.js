// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// A worker of isotet_engine_threads.wasm (isotet_threads.js): says that it has begun, and waits in the module for work
// until it is ended.

/** @param told  {module, memory, number, stack: where it ends, variables}: as beginThreads() gives them */
function run({module, memory, number, stack, variables}, say) {
  const imports = {env: {memory}}; // work calls none of the functions
  for (const {module: from, name, kind} of WebAssembly.Module.imports(module))
    if (kind === 'function') (imports[from] ??= {})[name] = () => { throw new Error(`a thread calls ${name}`); };
  const {exports} = new WebAssembly.Instance(module, imports);
  exports.__stack_pointer.value = stack;
  exports.__wasm_init_tls(variables);
  say();
  try {
    exports.wait_for_work(number);
  } catch {
    exports.worker_failed(); // the first thread does not wait for it
  }
}

if (typeof process !== 'undefined' && process.versions?.node !== undefined) {
  const {parentPort, workerData} = await import('node:worker_threads');
  run(workerData, () => parentPort.postMessage('begun'));
} else onmessage = ({data}) => run(data, () => postMessage('begun'));
