// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The link of a page that has a packed grid in it.
import {EngineLink} from './engine_link.js';
import {unpack} from './unpack.js';

export class Link extends EngineLink {
  constructor(_token, on) {
    super(on);
    this.start().catch((error) => this.failed(error.message));
  }

  async start() {
    const told = JSON.parse(document.getElementById('saved').textContent);
    const [engine, grid] = await Promise.all([unpack('engine'), unpack('grid')]);
    this.begin({engine, grid, told}, [engine.buffer, grid.buffer]);
  }
}
