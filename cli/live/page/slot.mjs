// SPDX-License-Identifier: MIT OR Apache-2.0
// One slot: the ADC's codes of every channel, from which the core makes one measurement.

import { colours } from './draw.mjs';

const PALETTE = [10, 11, 12, 13, 14, 15];
const DASHED = [6, 3];

export class SlotPlot {
  constructor(box, channels, facts) {
    Object.assign(this, { box, channels, facts, message: null, plot: null, hidden: new Set() });
    new ResizeObserver(() => this.plot?.setSize({ width: box.clientWidth, height: 170 })).observe(box);
  }

  clear() {
    this.plot?.destroy();
    this.plot = this.message = null;
    this.channels.replaceChildren();
  }

  show(message, pads) {
    const first = !this.message;
    this.message = message;
    const name = pads[message.pad]?.name ?? `pad ${message.pad}`;
    this.facts.textContent = `slot ${message.slot}, ${name}, full scale ±${message.full_scale}`;
    if (first || this.channels.childElementCount !== message.channels.length) this.build();
    this.plot.setData([message.codes[0].map((_, k) => k), ...message.codes]);
  }

  /** Makes the plot and its buttons anew: for other channels and after a change of theme. */
  build() {
    const { message } = this;
    if (!message) return;
    this.plot?.destroy();
    const axis = { stroke: colours.muted, grid: { stroke: colours.grid, width: 1 }, ticks: { show: false }, font: '11px system-ui, sans-serif' };
    this.plot = new window.uPlot({
      width: this.box.clientWidth || 400, height: 170, padding: [8, 8, 0, 0], legend: { show: false }, cursor: { y: false },
      scales: { x: { time: false } },
      axes: [{ ...axis, size: 22, gap: 2, values: (u, ticks) => ticks.map((tick) => (tick % 1 ? '' : tick)) },
        { ...axis, size: 64, space: 30, gap: 4, values: (u, ticks) => ticks.map((tick) => String(tick).replace('-', '−')) }],
      series: [{}, ...message.channels.map((name, k) => ({ label: name, width: 1.25, points: { show: false },
        show: !this.hidden.has(name), ...this.style(k) }))],
    }, [[], ...message.channels.map(() => [])], this.box);
    this.plot.setData([message.codes[0].map((_, k) => k), ...message.codes]);
    this.channels.replaceChildren(...message.channels.map((name, k) => this.button(name, k)));
  }

  style(k) {
    return { stroke: colours[PALETTE[k % PALETTE.length]], dash: k < PALETTE.length ? undefined : DASHED };
  }

  button(name, k) {
    const button = document.createElement('button');
    const key = document.createElement('i');
    key.className = `key line${k < PALETTE.length ? '' : ' dashed'}`;
    key.style.borderColor = this.style(k).stroke;
    button.type = 'button';
    button.append(key, name);
    button.setAttribute('aria-pressed', String(!this.hidden.has(name)));
    button.onclick = () => {
      if (!this.hidden.delete(name)) this.hidden.add(name);
      const shown = !this.hidden.has(name);
      button.setAttribute('aria-pressed', String(shown));
      this.plot.setSeries(k + 1, { show: shown });
    };
    return button;
  }
}
