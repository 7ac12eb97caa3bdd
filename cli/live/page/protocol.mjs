// SPDX-License-Identifier: MIT OR Apache-2.0
// Client of protocol 1: JSON text over one WebSocket. It connects again by itself and matches answers to commands.

/** Version of the protocol that the page speaks. */
export const PROTOCOL = 1;

/** Words of a pad's state, and what each means. */
export const STATES = {
  free: 'Outside all walls, and nothing is wrong.',
  'in wall': 'The pad is inside a wall, which brakes it by its depth.',
  sticking: 'The hand pulls the pad out of the wall, and the wall still holds it.',
  limited: 'The drive is at its limit: the force is below its target.',
  noisy: 'The force swings about its target.',
  lifted: 'The pad does not touch the sheet.',
  invalid: 'The core cannot measure this pad.',
  fault: 'A fault of the controller keeps the drive at 0 V.',
  late: 'No new measurement in time: the values shown are old.',
  lost: 'A terminal’s current, or the connection, is missing.',
};

/** Seconds between attempts to connect, and until a command counts as unanswered. */
const [RETRY_S, ANSWER_S] = [1, 10];

/** A connection. `onMessage(message)` receives every message, `onState(connected)` each change of the connection. */
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
      for (const id of this.waiting.keys()) this.settle(id, new Error('connection lost'));
      this.onState(false);
      setTimeout(() => this.connect(), 1e3 * RETRY_S);
    };
  }

  accept(message) {
    if (message.type === 'done') this.settle(message.id, null);
    else if (message.type !== 'error' || !this.settle(message.id, new Error(message.message))) this.onMessage(message);
  }

  /** Ends the command `id`; true where it was waited for. */
  settle(id, error) {
    const command = this.waiting.get(id);
    if (!command) return false;
    this.waiting.delete(id);
    clearTimeout(command.timer);
    if (error) command.reject(error);
    else {
      this.answer_ms = performance.now() - command.sent_ms;
      command.resolve();
    }
    return true;
  }

  /** Sends a command. The promise ends with its answer, or fails with the source's message. */
  send(command) {
    if (!this.connected) return Promise.reject(new Error('Not connected: the command was not sent'));
    const id = this.next++;
    return new Promise((resolve, reject) => {
      const unanswered = () => this.settle(id, new Error(`${command.type}: no answer within ${ANSWER_S} s`));
      const timer = setTimeout(unanswered, 1e3 * ANSWER_S);
      this.waiting.set(id, { resolve, reject, timer, sent_ms: performance.now() });
      this.socket.send(JSON.stringify({ ...command, id }));
    });
  }
}
