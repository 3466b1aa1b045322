// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The WebSocket to the server, opened again whenever it is lost.
import {isSecond} from '../app.js';
import {beginsWith, readFrame} from './frame.js';

export class Link {
  /** @param on  {text(message), frame(frame): as readFrame() gives it, part(bytes): of a download, open(),
   *              lost(refused), waits(): whether a large message is expected} */
  constructor(token, on) {
    this.token = token;
    this.on = on;
    this.delay = 300;
    this.refused = ''; // why there is nothing to come back to: token, pages or file
    this.ready = false;
    this.heard = this.listened = performance.now();
    this.connect();
    setInterval(() => this.listen(), 1000);
    // A page that is closed says so; one that the browser shows again connects anew.
    addEventListener('pagehide', () => this.socket.close());
    addEventListener('pageshow', (event) => { if (event.persisted) this.connect(); });
    // A machine that wakes up, or a page that is shown again, need not wait for the next attempt.
    const now = () => { if (!this.refused && !this.ready && this.timer) { clearTimeout(this.timer); this.connect(); } };
    addEventListener('online', now);
    document.addEventListener('visibilitychange', () => { if (!document.hidden) now(); });
  }

  connect() {
    this.timer = null;
    this.heard = performance.now();
    const address = new URL(isSecond ? 'second' : 'socket', location.href.split('#')[0]);
    address.protocol = address.protocol.replace('http', 'ws');
    const socket = this.socket = new WebSocket(address);
    socket.binaryType = 'arraybuffer';
    socket.onopen = () => socket.send(JSON.stringify({do: 'hello', token: this.token}));
    socket.onmessage = (event) => {
      this.heard = performance.now();
      if (typeof event.data !== 'string') return takeBytes(event.data, this.on);
      const message = JSON.parse(event.data);
      if (message.say === 'welcome') {
        this.ready = true;
        this.delay = 300;
        this.on.open();
      }
      if (message.say === 'error' && ['token', 'pages', 'file'].includes(message.about)) this.refused = message.about;
      this.on.text(message);
    };
    socket.onclose = () => {
      if (this.socket === socket) this.ended();
    };
  }

  /** The server tells every 4 seconds that it is there; while something large comes nothing else can be heard. */
  listen() {
    const now = performance.now(), slept = now - this.listened > 3000;
    this.listened = now;
    if (slept) this.heard = now; // what came while the page was busy, or the machine asleep, is not taken yet
    const limit = Number(document.body.dataset.silence) || (this.on.waits() ? 60000 : 12000);
    if (!this.ready || now - this.heard < limit) return;
    const {socket} = this;
    socket.onclose = socket.onmessage = null; // it may take long to end
    socket.close();
    this.ended();
  }

  ended() {
    this.ready = false;
    if (!this.refused) {
      this.timer = setTimeout(() => this.connect(), this.delay);
      this.delay = Math.min(5000, this.delay * 1.6);
    }
    this.on.lost(this.refused);
  }

  /** Another connection, to which all is sent again. */
  restart() { this.socket.close(); }

  send(message) {
    if (!this.ready || this.socket.readyState !== WebSocket.OPEN) return false;
    this.socket.send(JSON.stringify(message));
    return true;
  }
}

function takeBytes(buffer, on) {
  if (beginsWith(buffer, 'isod')) on.part(new Uint8Array(buffer, 4));
  else on.frame(readFrame(buffer));
}
