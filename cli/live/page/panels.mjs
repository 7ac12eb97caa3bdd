// SPDX-License-Identifier: MIT OR Apache-2.0
// Tables and lists: bars of the terminals, the pads, events, and what a screen reader is to say.

import { fixed } from './draw.mjs';
import { STATES } from './protocol.mjs';

const PEAK_S = 2;
/** A state must last this long to be spoken. */
const SPOKEN_MS = 600;

/** An element with a class and text. */
export function element(tag, className = '', text = '') {
  const made = document.createElement(tag);
  if (className) made.className = className;
  if (text) made.textContent = text;
  return made;
}

/** Writes text only where it differs, since each write costs a layout. */
export function write(node, text) {
  if (node.textContent !== text) node.textContent = text;
}

/** Bars of the terminals' currents in percent of full scale and of the chosen pad's voltage, with their peaks. */
export class Bars {
  constructor(box, model) {
    Object.assign(this, { box, model, bars: [] });
  }

  build() {
    const { hello } = this.model;
    const names = [...hello.terminals_mm.map((_, k) => `I${k + 1}`), ...(hello.limits?.rail_v ? ['V'] : [])];
    this.bars = names.map((name) => {
      const [row, track, fill, peak, value] = ['div', 'i', 'b', 'u', 'output'].map((tag) => element(tag));
      row.className = 'bar';
      track.append(fill, peak);
      row.append(element('span', '', name), track, value);
      if (name === 'V') row.title = 'Haptic voltage of the chosen pad against the highest drive (rail)';
      return { row, fill, peak, value, most: 0, since_s: 0 };
    });
    this.box.replaceChildren(...this.bars.map((bar) => bar.row));
  }

  draw() {
    const { shown, hello, pad } = this.model;
    if (!shown) return;
    const volt = shown.pads[pad]?.voltage_v_rms;
    this.bars.forEach((bar, k) => {
      const current = k < hello.terminals_mm.length;
      const share = current ? shown.terminals[k] : volt == null ? null : volt / hello.limits.rail_v;
      this.drawBar(bar, share ?? 0, shown.time_s);
      write(bar.value, current ? `${fixed(share == null ? null : 100 * share, 1)} %` : `${fixed(volt, 0)} V`);
    });
  }

  drawBar(bar, share, time_s) {
    const age_s = time_s - bar.since_s;
    if (share >= bar.most || age_s > PEAK_S || age_s < 0) Object.assign(bar, { most: share, since_s: time_s });
    bar.fill.style.transform = `scaleX(${Math.min(1, share).toFixed(4)})`;
    bar.peak.style.left = `${(100 * Math.min(1, bar.most)).toFixed(2)}%`;
  }
}

const COLUMNS = [
  (pad) => fixed(pad.x_mm, 2), (pad) => fixed(pad.y_mm, 2), (pad) => fixed(pad.error_mm, 2),
  (pad) => fixed(pad.capacitance_pf, 1), (pad) => fixed(pad.voltage_v_rms, 0), (pad) => fixed(pad.force_n, 3),
  (pad) => fixed(pad.true_force_n, 3), (pad) => fixed(pad.hand_n, 3), (pad) => pad.flags || 'none', (pad) => fixed(pad.age_ms, 1),
];
const TRUTH = new Set([2, 6, 7]);
const FLAGS = 8;

/** The table of pads. */
export class PadTable {
  constructor(body, model, choose) {
    Object.assign(this, { body, model, choose, rows: [] });
  }

  build() {
    this.rows = this.model.hello.pads.map(({ name }, number) => {
      const row = element('tr');
      const head = element('th');
      head.scope = 'row';
      const button = element('button', '', `${number + 1} ${name}`);
      button.type = 'button';
      head.append(button);
      const state = element('td', 'state');
      const cells = COLUMNS.map((_, k) => element('td', k === FLAGS ? '' : TRUTH.has(k) ? 'number truth' : 'number'));
      row.append(head, state, ...cells);
      row.onclick = () => this.choose(number);
      return { row, button, state, cells };
    });
    this.body.replaceChildren(...this.rows.map(({ row }) => row));
  }

  draw() {
    this.rows.forEach(({ row, button, state, cells }, number) => {
      const chosen = number === this.model.pad;
      row.className = chosen ? 'chosen' : '';
      button.setAttribute('aria-pressed', String(chosen));
      const pad = this.model.shown?.pads[number];
      const word = this.model.state(pad);
      if (state.textContent !== word) {
        state.textContent = word;
        state.dataset.state = word;
        state.title = STATES[word] ?? '';
      }
      cells.forEach((cell, k) => write(cell, pad ? COLUMNS[k](pad) : '–'));
    });
  }
}

/** The list of events, newest first; a click freezes the picture there. */
export class Events {
  constructor(list, model, onPick) {
    Object.assign(this, { list, model, onPick });
  }

  draw() {
    const items = this.model.events.map((event) => {
      const button = element('button');
      const name = event.pad == null ? '' : `${this.model.hello.pads[event.pad]?.name ?? event.pad}: `;
      button.type = 'button';
      button.append(element('b', '', `${fixed(event.time_s, 2)} s`), ` ${name}${event.what}`);
      button.onclick = () => this.onPick(event);
      const item = element('li');
      item.append(button);
      return item;
    });
    this.list.replaceChildren(...(items.length ? items : [element('li', 'none', 'Nothing has happened yet.')]));
  }
}

/** Says changes of state, and nothing else, to a screen reader. */
export class Speech {
  constructor(node, model) {
    Object.assign(this, { node, model, said: [], seen: [] });
  }

  clear() {
    [this.said, this.seen] = [[], []];
  }

  hear(now_ms) {
    const sentences = [];
    this.model.hello.pads.forEach(({ name }, number) => {
      const word = this.model.state(this.model.latest?.pads[number]);
      if (this.seen[number]?.word !== word) this.seen[number] = { word, since_ms: now_ms };
      if (now_ms - this.seen[number].since_ms < SPOKEN_MS || this.said[number] === word) return;
      if (this.said[number] !== undefined) sentences.push(`${name}: ${word}`);
      this.said[number] = word;
    });
    if (sentences.length) this.node.textContent = sentences.join('; ');
  }
}
