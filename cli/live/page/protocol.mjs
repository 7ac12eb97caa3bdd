// SPDX-License-Identifier: MIT OR Apache-2.0
// Client of protocol 1: JSON text over one WebSocket. It connects again by itself and matches answers to commands.

/** Words of a pad's state, with what each means. The order is that of growing concern. */
export const STATES = {
  free: 'No wall and no target: the pad moves freely, the drive is at 0 V.',
  'in wall': 'The pad is inside a wall and is braked by its depth.',
  sticking: 'The pad is held at rest by its friction; the finger pulls on it.',
  limited: 'The drive is at its highest voltage: the wanted force is not reached.',
  noisy: 'The measurement scatters more than it should.',
  lifted: 'The pad does not touch the sheet.',
  invalid: 'The core cannot measure this pad; its drive is at 0 V.',
  fault: 'The core has found a fault and holds the drive at 0 V.',
  late: 'No new measurement in time; the value shown is old.',
  lost: 'No connection to the source; the value shown is old.',
};

/** Seconds between attempts to connect. */
const RETRY_S = 1;
/** Seconds after which a command counts as unanswered. */
const ANSWER_S = 10;

/**
 * A connection to the source.
 *
 * `onMessage(message)` receives every message; `onState(connected)` each change of the connection.
 */
export class Link {
  constructor(url, onMessage, onState) {
    Object.assign(this, { url, onMessage, onState, waiting: new Map(), next: 1, answer_ms: null });
    this.connect();
  }

  get connected() {
    return this.socket.readyState === WebSocket.OPEN;
  }

  connect() {
    this.socket = new WebSocket(this.url);
    this.socket.onopen = () => this.onState(true);
    this.socket.onmessage = (event) => this.accept(JSON.parse(event.data));
    this.socket.onclose = () => {
      for (const [id] of this.waiting) this.settle(id, new Error('connection lost'));
      this.onState(false);
      setTimeout(() => this.connect(), 1e3 * RETRY_S);
    };
  }

  accept(message) {
    if (message.type === 'done') this.settle(message.id, null);
    if (message.type === 'error' && this.settle(message.id, new Error(message.message))) return;
    this.onMessage(message);
  }

  /** Ends the command `id`; true where it was waited for. */
  settle(id, error) {
    const command = this.waiting.get(id);
    if (!command) return false;
    this.waiting.delete(id);
    clearTimeout(command.timer);
    if (!error) this.answer_ms = performance.now() - command.sent;
    if (error) command.reject(error);
    else command.resolve();
    return true;
  }

  /** Sends a command. The promise ends with its answer; it fails with the source's message. */
  send(command) {
    if (!this.connected) return Promise.reject(new Error('not connected'));
    const id = this.next++;
    return new Promise((resolve, reject) => {
      const late = () => this.settle(id, new Error(`${command.type}: no answer within ${ANSWER_S} s`));
      this.waiting.set(id, { resolve, reject, sent: performance.now(), timer: setTimeout(late, 1e3 * ANSWER_S) });
      this.socket.send(JSON.stringify({ ...command, id }));
    });
  }
}
