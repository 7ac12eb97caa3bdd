// SPDX-License-Identifier: MIT OR Apache-2.0
// One slot: the ADC's codes of every channel, from which the core makes one measurement.

import { colours } from './draw.mjs';
import { element } from './panels.mjs';
import { axis, plain } from './strips.mjs';

const HEIGHT = 170;

export class SlotPlot {
  constructor(box, buttons, facts, model) {
    Object.assign(this, { box, buttons, facts, model, message: null, plot: null, hidden: new Set() });
    new ResizeObserver(() => this.plot?.setSize({ width: box.clientWidth, height: HEIGHT })).observe(box);
  }

  show(message) {
    const { parts } = this.model.hello;
    const part = parts > 1 ? `, part ${(message.pad % parts) + 1} of ${parts}` : '';
    const codes = message.codes.length ? `full scale ±${message.full_scale}` : 'no codes: this scene computes phasors';
    this.facts.textContent = `number ${message.slot}, ${this.model.title(Math.floor(message.pad / parts))}${part}, ${codes}`;
    this.message = message.codes.length ? message : null;
    this.build();
  }

  /** Makes plot and buttons anew: for other codes and after a change of theme. */
  build() {
    this.plot?.destroy();
    this.plot = null;
    this.buttons.replaceChildren();
    if (!this.message) return;
    const { channels, codes, sample_rate_hz } = this.message;
    const shown = (name) => ({ show: !this.hidden.has(name), width: 1.25, points: { show: false } });
    const series = channels.map((name, k) => ({ ...shown(name), ...style(k) }));
    const times = codes[0].map((_, k) => (1e6 * k) / sample_rate_hz);
    this.plot = new window.uPlot({
      width: this.box.clientWidth, height: HEIGHT, padding: [8, 22, 0, 0], legend: { show: false }, cursor: { y: false },
      scales: { x: { time: false } }, series: [{}, ...series],
      axes: [{ ...axis(), size: 26, gap: 6, values: (plot, ticks) => ticks.map((tick) => `${tick} µs`) },
        { ...axis(), size: 64, gap: 4, values: (plot, ticks) => ticks.map(plain) }],
    }, [times, ...codes], this.box);
    this.buttons.replaceChildren(...channels.map((name, k) => this.button(name, k)));
  }

  button(name, k) {
    const key = element('i', `key line${style(k).dash ? ' dashed' : ''}`);
    key.style.borderColor = style(k).stroke;
    const button = element('button', '', name);
    button.prepend(key);
    button.ariaPressed = !this.hidden.has(name);
    button.onclick = () => {
      const show = this.hidden.delete(name);
      if (!show) this.hidden.add(name);
      button.ariaPressed = show;
      this.plot.setSeries(k + 1, { show });
    };
    return button;
  }
}

/** Colour and dash of a channel: as many colours as there are, then again dashed. */
function style(k) {
  const { series } = colours;
  return { stroke: series[k % series.length], dash: k < series.length ? undefined : [6, 3] };
}
