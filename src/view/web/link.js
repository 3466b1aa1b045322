// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The WebSocket to the server, opened again whenever it is lost.

export class Link {
  /** @param on  {text(message), frame(buffer), part(bytes): of a download, open(), lost(refused), waits(): whether
   *              a large message is expected} */
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
    const address = new URL('socket', location.href.split('#')[0]);
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

  send(message) {
    if (!this.ready || this.socket.readyState !== WebSocket.OPEN) return false;
    this.socket.send(JSON.stringify(message));
    return true;
  }
}

const mark = (text) => [...text].reduce((number, letter, i) => number + letter.charCodeAt(0) * 256 ** i, 0);

/** A frame begins with "isof", a part of a download with "isod". */
function takeBytes(buffer, on) {
  if (new DataView(buffer).getUint32(0, true) === mark('isod')) on.part(new Uint8Array(buffer, 4));
  else on.frame(buffer);
}

/** A frame taken apart: its head, with arrays in place of where they stand. */
export function readFrame(buffer) {
  const view = new DataView(buffer);
  if (view.getUint32(0, true) !== mark('isof')) throw new Error('a frame begins with "isof"');
  const length = view.getUint32(4, true);
  const head = JSON.parse(new TextDecoder().decode(new Uint8Array(buffer, 8, length)));
  const blocks = Math.ceil((8 + length) / 8) * 8;
  for (const {mesh} of head.surfaces) {
    if (!mesh) continue;
    mesh.vertexBytes = new Uint8Array(buffer, blocks + mesh.vertices_at, 8 * mesh.vertices);
    if (mesh.colors_at !== undefined) mesh.colors = new Uint16Array(buffer, blocks + mesh.colors_at, mesh.vertices);
    if (mesh.corners_at !== undefined) {
      const Type = mesh.wide ? Uint32Array : Uint16Array;
      mesh.corners = new Type(buffer, blocks + mesh.corners_at, 3 * mesh.triangles);
    }
  }
  if (head.picture) head.picture.coded = new Uint8Array(buffer, blocks + head.picture.at, head.picture.bytes);
  head.bytes = buffer.byteLength;
  return head;
}
