// SPDX-License-Identifier: MIT OR Apache-2.0
// A board: the state of its line in words, and the switch of its drive. Escape disables the board, wherever the focus is.

import { fixed } from './draw.mjs';
import { write } from './panels.mjs';

/** How often the server has a sign of life, ms. */
const ALIVE_MS = 250;

export class Board {
  /** `parts`: the group with the buttons `arm` and `disable`, and the line of text. */
  constructor({ group, arm, disable, line }, model, send) {
    Object.assign(this, { group, arm, disable, line, model, send });
    arm.onclick = () => send({ type: 'arm', on: !this.status?.armed });
    disable.onclick = () => send({ type: this.status?.phase === 'off' ? 'enable' : 'disable' });
    addEventListener('keydown', (event) => {
      if (event.key === 'Escape' && this.is) this.send({ type: 'disable' });
    }, { capture: true });
  }

  get is() {
    return this.model.hello?.source === 'board';
  }

  get status() {
    return this.model.lost ? null : this.model.status.line;
  }

  build() {
    this.group.hidden = !this.is;
    this.arm.hidden = !this.model.hello.controller;
  }

  /** Called as pictures are drawn: a page that hangs, or that nobody sees, sends no sign of life, and its drive goes off. */
  live(now_ms) {
    if (!this.is || now_ms - (this.alive_ms ?? 0) < ALIVE_MS) return;
    this.alive_ms = now_ms;
    this.send({ type: 'alive' });
  }

  draw() {
    if (!this.is) return;
    const { status } = this;
    this.arm.disabled = !status || !['measuring', 'armed'].includes(status.phase);
    this.arm.ariaPressed = Boolean(status?.armed);
    write(this.arm, status?.armed ? 'Drive off' : 'Arm drive');
    write(this.disable, status?.phase === 'off' ? 'Enable board' : 'Disable board (Esc)');
    this.line.className = status && ['measuring', 'armed', 'off'].includes(status.phase) ? '' : 'bad';
    write(this.line, status ? this.words(status) : 'Not connected to hapticore');
  }

  words({ name, phase, packets, lost, dropped, damaged, refused, age_ms }) {
    const counts = Object.entries({ lost, dropped, damaged, refused }).map(([word, count]) => `${count} ${word}`);
    return `${name}: ${phase} · ${packets} packets, ${counts.join(', ')} · last ${fixed(age_ms, 0)} ms ago`;
  }
}
