// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The link of a page that has a packed grid in it.
import {EngineLink} from './engine_link.js';
import {partText, savedMessage} from './unpack.js';

export class Link extends EngineLink {
  constructor(_token, on) {
    super(on);
    this.begin(() => ({engine: partText('engine'), grid: partText('grid'), told: savedMessage()}));
  }
}
