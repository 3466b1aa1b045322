// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The machine's graphics card, by WebGPU, for a module of isotet (src/web/webgpu): it says what it wants, and is called again when it
// has it. Where there is no card, or anything fails, the module does all by itself.

const headBytes = 64, indirectBytes = 24; // of the state: lists, and what is told of the surface (kernels/common.wgsl)
const patience = 30000;                   // ms, for one surface

/** What is asked of an adapter's limits; all else is as every adapter has it. */
const wantedLimits = ['maxBufferSize', 'maxStorageBufferBindingSize'];

class GraphicsCard {
  /** @param software  whether an adapter that is the processor will do; throws where there is no other */
  static async open(software) {
    const adapter = await globalThis.navigator?.gpu?.requestAdapter({powerPreference: 'high-performance'});
    if (!adapter) throw new Error('this browser has no WebGPU here');
    if (isSoftware(adapter) && !software) throw new Error('WebGPU has no graphics card here');
    const device = await adapter.requestDevice({requiredLimits: Object.fromEntries(wantedLimits.map((name) => [name, adapter.limits[name]]))});
    const card = new GraphicsCard();
    card.device = device;
    card.lost = new Promise((_, fail) => { device.lost.then(({message}) => fail(new Error(`the graphics card was lost: ${message}`))); });
    card.lost.catch(() => {}); // who waits is told
    const {vendor, architecture, device: model, description} = adapter.info ?? {};
    const {maxBufferSize, maxStorageBufferBindingSize} = device.limits;
    card.info = {vendor, architecture, device: model, description, bindingBytes: Math.min(maxBufferSize, maxStorageBufferBindingSize)};
    card.most = Math.floor(Math.min(card.info.bindingBytes, (maxBufferSize - headBytes) / 2) / 12); // the answer has both
    return card;
  }

  buffers = {};
  grid = 0;                               // that is there
  most = 0;                               // vertices or triangles that it can make
  room = null;                            // {vertices, triangles} that there is room for
  last = {vertices: 0, triangles: 0};     // of the surface before

  /** @param texts  of the kernels, by their names */
  async compile(texts) {
    const {device} = this, visibility = 4; // GPUShaderStage.COMPUTE
    const types = ['uniform', ...Array(4).fill('read-only-storage'), ...Array(3).fill('storage')];
    this.layout = device.createBindGroupLayout({entries: types.map((type, binding) => ({binding, visibility, buffer: {type}}))});
    const layout = device.createPipelineLayout({bindGroupLayouts: [this.layout]});
    const made = await Promise.all(Object.entries(texts).map(async ([name, code]) =>
      [name, await device.createComputePipelineAsync({layout, compute: {module: device.createShaderModule({code, label: name})}})]));
    this.pipelines = Object.fromEntries(made);
  }

  /** In place of that of the same name. */
  buffer(name, bytes, usage) {
    this.buffers[name]?.destroy();
    this.buffers[name] = this.device.createBuffer({label: name, size: Math.max(16, Math.ceil(bytes / 4) * 4), usage});
    this.group = null;
    return this.buffers[name];
  }

  take({grid, push, stateBytes, upload}, memory) {
    if (grid === this.grid) return;
    const {storage, to, from, uniform, indirect} = bufferUses;
    this.buffer('push', 4 * push.length, uniform | to);
    ['page', 'clusters', 'ranges', 'tables'].forEach((name, i) => {
      const [at, bytes] = upload[i], buffer = this.buffer(name, bytes, storage | to);
      for (let done = 0; done < bytes; done += uploadBytes)
        this.device.queue.writeBuffer(buffer, done, memory.buffer, at + done, Math.min(uploadBytes, bytes - done));
    });
    this.buffer('state', stateBytes, storage | to | from);
    this.buffer('indirect', indirectBytes, indirect | to);
    this.grid = grid;
  }

  makeRoom() {
    const {storage, to, from, read} = bufferUses, {vertices, triangles} = this.room;
    if (this.buffers.positions?.size === 12 * vertices && this.buffers.triangles?.size === 12 * triangles) return;
    this.buffer('positions', 12 * vertices, storage | from);
    this.buffer('triangles', 12 * triangles, storage | from);
    this.buffer('answer', headBytes + 12 * (vertices + triangles), read | to);
  }

  binding() {
    const names = ['push', 'page', 'clusters', 'ranges', 'tables', 'state', 'positions', 'triangles'];
    const entries = names.map((name, binding) => ({binding, resource: {buffer: this.buffers[name]}}));
    return this.group ??= this.device.createBindGroup({layout: this.layout, entries});
  }

  pass(encoder, steps) {
    const pass = encoder.beginComputePass();
    pass.setBindGroup(0, this.binding());
    for (const [name, go] of steps) {
      pass.setPipeline(this.pipelines[name]);
      go(pass);
    }
    pass.end();
  }

  /** All passes; of positions and triangles as many go into the answer as the surface before had, and a quarter more. */
  encode(segments, guess) {
    const {device, buffers: {state, indirect, answer}} = this, encoder = device.createCommandEncoder();
    const axis = device.limits.maxComputeWorkgroupsPerDimension;
    const all = (pass) => pass.dispatchWorkgroups(Math.min(segments, axis), Math.ceil(segments / axis));
    const listed = (at) => (pass) => pass.dispatchWorkgroupsIndirect(indirect, at);
    encoder.clearBuffer(state, 0, headBytes);
    this.pass(encoder, [['select', all]]);
    encoder.copyBufferToBuffer(state, 4, indirect, 0, 12);
    this.pass(encoder, [['count', listed(0)], ['scan', all]]);
    encoder.copyBufferToBuffer(state, 20, indirect, 12, 12);
    this.pass(encoder, [['emit', listed(12)]]);
    encoder.copyBufferToBuffer(state, 0, answer, 0, headBytes);
    this.copy(encoder, guess);
    device.queue.submit([encoder.finish()]);
  }

  copy(encoder, {vertices, triangles}) {
    const {positions, triangles: corners, answer} = this.buffers;
    if (vertices > 0) encoder.copyBufferToBuffer(positions, 0, answer, headBytes, 12 * vertices);
    if (triangles > 0) encoder.copyBufferToBuffer(corners, 0, answer, headBytes + 12 * vertices, 12 * triangles);
  }

  /** What `use` makes of the first bytes of the answer. */
  async read(bytes, use) {
    const {answer} = this.buffers;
    await this.within(answer.mapAsync(1, 0, bytes)); // GPUMapMode.READ
    try {
      return use(answer.getMappedRange(0, bytes));
    } finally {
      answer.unmap();
    }
  }

  /** A promise that fails where the card is lost, or takes too long. */
  async within(promise) {
    let clock = 0;
    const late = new Promise((_, fail) => { clock = setTimeout(() => fail(new Error('the graphics card does not answer')), patience); });
    try {
      return await Promise.race([promise, this.lost, late]);
    } finally {
      clearTimeout(clock);
    }
  }

  /**
   * Makes a surface.
   * @param wanted  as the module says it
   * @param roomFor takes (vertices, triangles, tied points, selected clusters), gives where {positions, triangles} go in the memory, or null
   * @returns       false: it is too large
   */
  async surface(wanted, memory, roomFor) {
    const {device} = this;
    for (const kind of ['validation', 'out-of-memory', 'internal']) device.pushErrorScope(kind);
    try {
      return await this.passes(wanted, memory, roomFor);
    } finally {
      const errors = [];
      for (let i = 0; i < 3; ++i) errors.push(await this.within(device.popErrorScope()));
      const error = errors.find((one) => one);
      if (error) throw new Error(error.message);
    }
  }

  async passes(wanted, memory, roomFor) {
    const {device, most} = this, {push, segments} = wanted;
    this.room ??= {vertices: Math.min(most, 1 << 16), triangles: Math.min(most, 1 << 17)};
    this.take(wanted, memory);
    for (;;) {
      this.makeRoom();
      [push[0], push[1]] = [this.room.vertices, this.room.triangles];
      device.queue.writeBuffer(this.buffers.push, 0, new Uint32Array(push));
      const more = (kind) => Math.min(this.room[kind], Math.ceil(1.25 * this.last[kind]));
      const guess = {vertices: more('vertices'), triangles: more('triangles')};
      this.encode(segments, guess);
      const bytes = headBytes + 12 * (guess.vertices + guess.triangles);
      const head = await this.read(bytes, (range) => {
        const [vertices, manyVertices, triangles, manyTriangles, overflow, selected, tied] = new Uint32Array(range, 32, 7);
        if (manyVertices || manyTriangles || vertices > most || triangles > most) return {large: true};
        const done = !overflow && vertices <= guess.vertices && triangles <= guess.triangles;
        const large = done && !copyAnswer(range, guess, {vertices, triangles}, memory, roomFor(vertices, triangles, tied, selected));
        return {vertices, triangles, overflow, selected, tied, done, large};
      });
      if (head.large) return false;
      this.last = {vertices: head.vertices, triangles: head.triangles};
      if (head.done) return true;
      if (head.overflow) {
        for (const kind of ['vertices', 'triangles'])
          if (head[kind] > this.room[kind]) this.room[kind] = Math.min(most, Math.ceil(1.25 * head[kind]));
        continue;
      }
      const encoder = device.createCommandEncoder();
      this.copy(encoder, head);
      device.queue.submit([encoder.finish()]);
      return this.read(headBytes + 12 * (head.vertices + head.triangles), (range) =>
        copyAnswer(range, head, head, memory, roomFor(head.vertices, head.triangles, head.tied, head.selected)));
    }
  }

  close() {
    this.device.destroy();
  }
}

const uploadBytes = 1 << 24; // of a copy at most: the browser keeps one of its own meanwhile

/** Of WebGPU's GPUBufferUsage. */
const bufferUses = {read: 1, from: 4, to: 8, uniform: 64, storage: 128, indirect: 256};

/** Whether the adapter is the processor: SwiftShader, Mesa's or Microsoft's. */
function isSoftware({info, isFallbackAdapter}) {
  const names = [info?.architecture, info?.device, info?.description].join(' ');
  return Boolean(info?.isFallbackAdapter ?? isFallbackAdapter) || /swiftshader|llvmpipe|softpipe|\bwarp\b|basic render/i.test(names);
}

/** Copies an answer, in which there is room for `guess`. False: the memory has no places for it. */
function copyAnswer(range, guess, {vertices, triangles}, memory, places) {
  if (!places) return false;
  const into = new Uint8Array(memory.buffer);
  into.set(new Uint8Array(range, headBytes, 12 * vertices), places.positions);
  into.set(new Uint8Array(range, headBytes + 12 * guess.vertices, 12 * triangles), places.triangles);
  return true;
}

/** The module stopped: its memory is in no known state, and it is called no more. */
const isTrap = (error) => error instanceof WebAssembly.RuntimeError;

/** A module, and the card that it may have. Calls are made one after another. */
export class CardOfModule {
  /** @param exports  of the module;  `memory`  has its buffer */
  constructor(exports, memory) {
    Object.assign(this, {exports, memory, card: null, message: null, why: ''});
  }

  /** Takes a message of the module to the card; false: it is for others. */
  take(message) {
    if (!['card', 'kernels', 'room', 'tested', 'measured'].some((kind) => kind in message)) return false;
    this.message = message;
    return true;
  }

  spent = 0; // ms of the card, by the call that is made

  /** The message of a call. */
  ask(call) {
    this.message = null;
    call();
    return this.message;
  }

  /**
   * Opens the card; use() takes it then. `why` tells where there is none.
   * @param kind  'webgpu', or 'webgpu-software' for adapters that are the processor too
   */
  async open(kind) {
    try {
      const {kernels} = this.ask(() => this.exports.card_kernels());
      const card = await GraphicsCard.open(kind === 'webgpu-software');
      this.opened = card;
      await card.compile(kernels);
    } catch (error) {
      this.end(error);
    }
  }

  /** Tests the card that was opened with a small grid, and uses it where it is right: a call like others. Throws where the module stops. */
  async use() {
    if (!this.opened) return;
    try {
      this.card = this.opened;
      const {bindingBytes} = this.card.info;
      this.exports.card_on(bindingBytes, this.card.device.limits.maxComputeWorkgroupsPerDimension);
      const {tested} = await this.settle(() => this.exports.card_test());
      if (this.card && tested) this.end(new Error(tested));
    } catch (error) {
      if (isTrap(error)) throw error;
      this.end(error);
    }
  }

  /** Makes a call, and makes it again when the card has done what it waits for. Returns the last message. Throws where the module stops. */
  async settle(call) {
    for (this.spent = 0;;) {
      const message = this.ask(call);
      if (!message?.card) return message;
      const start = performance.now();
      try {
        const {exports} = this, roomFor = (...counts) => this.ask(() => exports.card_room(...counts)).room;
        if (!await this.card.surface(message.card, this.memory, roomFor)) exports.card_leave();
      } catch (error) {
        if (isTrap(error)) throw error;
        this.end(error);
      }
      this.spent += performance.now() - start;
    }
  }

  /** The module goes on without. */
  end(error) {
    this.why = error.message;
    this.exports.card_off?.(); // modules of before had none
    this.opened?.close();
    this.card = this.opened = null;
  }

  close() { this.opened?.close(); }

  /** Milliseconds that both take for surfaces of the last grid; nothing: the card cannot have it. */
  async measure() {
    const surfaces = [];
    for (const part of [0.5, 0.2, 0.35, 0.5, 0.65, 0.8]) { // the first one again: it makes room
      const times = [];
      let measured = null;
      for (const byCard of [1, 0]) {
        const start = performance.now();
        ({measured} = await this.settle(() => this.exports.card_measure(part, byCard)));
        if (!measured || !this.card) return [];
        times.push(Math.round(10 * (performance.now() - start)) / 10);
      }
      surfaces.push({...measured, webgpu_ms: times[0], wasm_ms: times[1]});
    }
    return surfaces.slice(1);
  }
}
