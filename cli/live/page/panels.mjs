// SPDX-License-Identifier: MIT OR Apache-2.0
// Tables and lists: bars of the terminals, the pads, events, and what a screen reader is to say.

import { fixed } from './draw.mjs';
import { STATES } from './protocol.mjs';

/** How long a bar holds its peak, in device time. */
const PEAK_S = 2;
/** A state must last this long to be spoken. */
const SPOKEN_MS = 600;

/** An element with a class and text. */
export function element(tag, className = '', text = '') {
  const made = Object.assign(document.createElement(tag), { className, textContent: text });
  if (tag === 'button') made.type = 'button';
  return made;
}

/** Writes text only where it differs, since each write costs a layout. */
export function write(node, text) {
  if (node.textContent !== text) node.textContent = text;
}

/** Bars of the terminals' currents and of the two voltages, in percent of the ADC's full scale, with their peaks. */
export class Bars {
  constructor(box, model) {
    Object.assign(this, { box, model, bars: [] });
  }

  build() {
    const currents = this.model.hello.terminals_mm.map((_, k) => [`I${k + 1}`, `Current of the terminal ${k + 1}`]);
    const voltages = [['Vs', 'Voltage that senses'], ['Vh', 'Haptic voltage']];
    this.bars = [...currents, ...voltages].map(([name, title]) => {
      const [row, track, fill, peak, value] = ['div', 'i', 'b', 'u', 'output'].map((tag) => element(tag));
      Object.assign(row, { className: 'bar', title });
      track.append(fill, peak);
      row.append(element('span', '', name), track, value);
      return { row, fill, peak, value, most: 0, since_s: 0 };
    });
    this.box.replaceChildren(...this.bars.map((bar) => bar.row));
  }

  draw() {
    const { shown } = this.model;
    if (!shown) return;
    const shares = [...shown.terminals, ...shown.voltages];
    this.bars.forEach((bar, k) => {
      const share = Math.min(1, shares[k] ?? 0);
      const age_s = shown.time_s - bar.since_s;
      if (share >= bar.most || age_s > PEAK_S || age_s < 0) Object.assign(bar, { most: share, since_s: shown.time_s });
      bar.fill.style.transform = `scaleX(${share.toFixed(4)})`;
      bar.peak.style.left = `${(99 * bar.most).toFixed(2)}%`;
      bar.text = `${fixed(100 * shares[k], 1)} %`;
    });
  }

  drawValues() {
    for (const bar of this.bars) write(bar.value, bar.text ?? '–');
  }
}

/** Columns of the table after name and state: column of a frame, decimals, what it needs: truth or a hand. */
const COLUMNS = [['force_n', 3], ['true_force_n', 3, 'truth'], ['hand_n', 3, 'hand'], ['haptic_v_rms', 0], ['capacitance_pf', 1],
  ['x_mm', 2], ['y_mm', 2], ['error_mm', 2, 'truth'], ['age_ms', 1]];

/** The table of pads. */
export class PadTable {
  constructor(body, model, choose) {
    Object.assign(this, { body, model, choose, rows: [] });
  }

  build() {
    this.rows = this.model.hello.pads.map((_, number) => {
      const [row, head, button] = [element('tr'), element('th'), element('button', '', this.model.title(number))];
      const [state, flags] = [element('td', 'state'), element('td', 'flags')];
      const cells = COLUMNS.map(([, , kind = '']) => element('td', `number ${kind}`));
      head.scope = 'row';
      head.append(button);
      row.append(head, state, ...cells, flags);
      row.onclick = () => this.choose(number);
      return { row, button, state, flags, cells };
    });
    this.body.replaceChildren(...this.rows.map(({ row }) => row));
  }

  draw() {
    this.rows.forEach(({ row, button, state, flags, cells }, number) => {
      button.ariaPressed = number === this.model.pad;
      row.className = number === this.model.pad ? 'chosen' : '';
      const pad = this.model.shown?.pads[number];
      const word = this.model.state(pad);
      write(state, word);
      state.dataset.state = word;
      state.title = STATES[word] ?? '';
      write(flags, pad?.flags?.replaceAll('+', ', ').replaceAll('_', ' ') || 'none');
      // An age counts while frames come; later it would look younger than it is.
      const old = this.model.lost || this.model.stale;
      COLUMNS.forEach(([column, decimals], k) => {
        write(cells[k], old && column === 'age_ms' ? '–' : fixed(pad?.[column], decimals));
      });
    });
  }
}

/** Draws the list of events, newest first; `onPick(event)` runs where one is clicked. */
export function drawEvents(list, model, onPick) {
  const items = model.events.map((event) => {
    const button = element('button', '', ` ${model.title(event.pad)}: ${event.what}`);
    button.prepend(element('b', '', `${fixed(event.time_s, 2)} s`));
    button.onclick = () => onPick(event);
    const item = element('li');
    item.append(button);
    return item;
  });
  list.replaceChildren(...(items.length ? items : [element('li', 'note', 'Nothing has happened yet.')]));
}

/** Says changes of state, and nothing else, to a screen reader. */
export class Speech {
  constructor(node, model) {
    Object.assign(this, { node, model, pads: [] });
  }

  hear(now_ms) {
    const sentences = this.model.hello.pads.map((_, number) => {
      const word = this.model.state(this.model.latest?.pads[number]);
      const heard = (this.pads[number] ??= { said: word });
      if (heard.word !== word) Object.assign(heard, { word, since_ms: now_ms });
      if (now_ms - heard.since_ms < SPOKEN_MS || heard.said === word) return null;
      heard.said = word;
      return `${this.model.title(number)}: ${word}`;
    });
    if (sentences.some(Boolean)) this.node.textContent = sentences.filter(Boolean).join('; ');
  }
}
