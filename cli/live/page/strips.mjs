// SPDX-License-Identifier: MIT OR Apache-2.0
// Strips: the chosen pad's quantities over the last seconds, one below the other on one time axis.

import { colours, fixed } from './draw.mjs';
import { length } from './model.mjs';

const MEASURED = ['measured', 'measured'];
const TRUE = ['true', 'true'];

/** The strips of a source: title, unit, decimals, lines `[name, colour, value of a pad, dash]`, limit, least range. */
function strips(hello) {
  const limits = hello.limits ?? {};
  const truth = hello.truth;
  const line = ([name, colour], get, dash) => ({ name, colour, get, dash });
  const list = [
    {
      title: 'Haptic force', unit: 'N', decimals: 3, least: 0.2, limit: limits.force_n, limitName: 'rail',
      words: 'Friction that the voltage adds. Target: what the controller or the wall asks for.',
      lines: [line(MEASURED, (pad) => pad.force_n), truth && line(TRUE, (pad) => pad.true_force_n),
        line(['target', 'target'], (pad) => pad.target_n, [6, 4])],
    },
    hello.walls.length
      ? { title: 'Depth in the wall', unit: 'mm', decimals: 2, least: 2,
        words: 'Measured distance of the pad behind the wall’s surface; negative outside.',
        lines: [line(['depth', 'measured'], (pad) => pad.depth_mm)] }
      : { title: 'Finger ahead of the pad', unit: 'mm', decimals: 2, least: 1,
        words: 'Distance from the pad to the finger that leads it.',
        lines: [line(['distance', 'finger'], (pad) => lag(pad))] },
    {
      title: 'Voltage', unit: 'V rms', decimals: 0, least: 50, limit: limits.rail_v, limitName: 'rail',
      words: 'Haptic voltage across the pad. Drive: what the source puts out. Rail: the highest drive.',
      lines: [line(MEASURED, (pad) => pad.voltage_v_rms), truth && line(TRUE, (pad) => pad.true_voltage_v_rms),
        line(['drive', 'target'], (pad) => pad.drive_v, [6, 4])],
    },
    {
      title: 'Capacitance', unit: 'pF', decimals: 1, least: 2, free: true,
      words: 'Between pad and sheet. It rises when the gap closes.',
      lines: [line(MEASURED, (pad) => pad.capacitance_pf), truth && line(TRUE, (pad) => pad.true_capacitance_pf)],
    },
    truth && {
      title: 'Position error', unit: 'mm', decimals: 2, least: 0.5, limit: limits.position_mm, limitName: 'limit',
      words: 'Distance between the measured and the true position.', lines: [line(['error', 'measured'], (pad) => pad.error_mm)],
    },
  ];
  return list.filter(Boolean).map((strip) => ({ ...strip, lines: strip.lines.filter(Boolean) }));
}

const lag = (pad) =>
  pad.finger_x_mm == null ? null : length(pad.finger_x_mm - (pad.true_x_mm ?? pad.x_mm), pad.finger_y_mm - (pad.true_y_mm ?? pad.y_mm));

/** Rounded up to 1, 2 or 5 times a power of ten, so that axes do not tremble. */
function round(value) {
  const power = 10 ** Math.floor(Math.log10(value));
  return [1, 2, 5, 10].find((step) => step * power >= value * 0.999) * power;
}

/** Range of an axis around data from `low` to `high`: zero is in it, unless the strip is `free`. */
function range(strip, low, high) {
  if (low == null) [low, high] = [0, 0];
  if (!strip.free) [low, high] = [Math.min(0, low), Math.max(0, high)];
  const span = round(Math.max(strip.least, (high - low) * 1.08));
  const step = span / 10;
  const from = strip.free ? Math.floor((low + high - span) / 2 / step) * step : low < 0 ? Math.floor(low / step) * step : 0;
  return [from, Math.max(from + span, Math.ceil(high / step) * step)];
}

export class Strips {
  constructor(box, model, onChange) {
    Object.assign(this, { box, model, onChange, plots: [], span_s: 10 });
    new ResizeObserver(() => this.resize()).observe(box);
  }

  get height() {
    return window.innerWidth < 700 ? 92 : 116;
  }

  /** Makes the strips anew: after a new source and after a change of theme. */
  build() {
    for (const { plot } of this.plots) plot.destroy();
    this.box.replaceChildren();
    const list = strips(this.model.hello);
    this.plots = list.map((strip, k) => this.add(strip, k === list.length - 1));
  }

  add(strip, last) {
    const figure = document.createElement('figure');
    const caption = document.createElement('figcaption');
    caption.title = strip.words;
    caption.innerHTML = `<b>${strip.title}</b> <small>${strip.unit}</small>`;
    const values = strip.lines.map((line) => legend(caption, line, strip.lines.length > 1));
    figure.append(caption);
    this.box.append(figure);
    const plot = new window.uPlot(this.options(strip, last), [[], ...strip.lines.map(() => [])], figure);
    figure.querySelector('canvas').setAttribute('aria-hidden', 'true');
    return { plot, strip, values };
  }

  options(strip, last) {
    const axis = { stroke: colours.muted, grid: { stroke: colours.grid, width: 1 }, ticks: { show: false }, font: '11px system-ui, sans-serif' };
    const time = (u, ticks) => ticks.map((tick) => fixed(tick, 3).replace(/\.?0+$/, '') || '0');
    return {
      width: this.box.clientWidth || 400, height: this.height + (last ? 22 : 0), padding: [6, 4, last ? 0 : 4, 0],
      legend: { show: false },
      cursor: { sync: { key: 'strips' }, y: false, drag: { x: true, y: false, setScale: false }, points: { size: 6 },
        bind: { dblclick: () => () => this.unzoom() } },
      scales: { x: { time: false }, y: { range: (u, low, high) => range(strip, low, high) } },
      axes: [{ ...axis, size: last ? 22 : 0, space: 60, gap: 2, values: last ? (u, ticks) => time(u, ticks).map((t) => `${t} s`) : () => [] },
        { ...axis, size: 44, space: 24, gap: 4, values: (u, ticks) => ticks.map((tick) => String(+tick.toFixed(3)).replace('-', '−')) }],
      series: [{}, ...strip.lines.map((line) => ({
        stroke: colours[line.colour], width: line.name === 'measured' ? 1.75 : 1.25, dash: line.dash, points: { show: false } }))],
      hooks: { drawAxes: [(u) => drawLimit(u, strip)], setSelect: [(u) => this.zoom(u)], setCursor: [(u) => this.point(u)] },
    };
  }

  /** Zooms to the span that was drawn with the pointer, and holds the picture. */
  zoom(u) {
    if (u.select.width < 4) return;
    const range = [u.posToVal(u.select.left, 'x'), u.posToVal(u.select.left + u.select.width, 'x')];
    u.setSelect({ left: 0, width: 0, top: 0, height: 0 }, false);
    this.model.freeze(range[1]);
    this.model.range = range;
    this.onChange();
  }

  unzoom() {
    this.model.follow();
    this.onChange();
  }

  /** Follows the pointer: values at its time; with the picture held, the sheet at its time, too. */
  point(u) {
    const inside = u.cursor.left >= 0;
    const cursor_s = inside ? u.posToVal(u.cursor.left, 'x') : null;
    if (cursor_s === this.model.cursor_s || (inside && !u.over.matches(':hover'))) return;
    this.model.cursor_s = cursor_s;
    if (inside && this.model.frozen) this.model.held = this.model.at(cursor_s);
    this.onChange();
  }

  resize() {
    for (const [k, { plot }] of this.plots.entries()) {
      plot.setSize({ width: this.box.clientWidth, height: this.height + (k === this.plots.length - 1 ? 22 : 0) });
    }
  }

  /** Draws the strips of the chosen pad. */
  draw() {
    const { model } = this;
    const [from, to] = model.span(this.span_s);
    const frames = model.within([from, to]).filter((frame) => frame.pads[model.pad]);
    const pads = frames.map((frame) => frame.pads[model.pad]);
    const times = frames.map((frame) => frame.time_s);
    for (const { plot, strip } of this.plots) {
      plot.batch(() => {
        plot.setData([times, ...strip.lines.map((line) => pads.map(line.get))], false);
        plot.setScale('x', { min: from, max: to });
      });
    }
    this.drawValues();
  }

  drawValues() {
    const { model } = this;
    const frame = model.cursor_s == null || !model.frames.length ? model.shown : model.at(model.cursor_s);
    const pad = frame?.pads[model.pad];
    for (const { strip, values } of this.plots) {
      strip.lines.forEach((line, k) => {
        const text = pad ? fixed(line.get(pad), strip.decimals) : '–';
        if (values[k].textContent !== text) values[k].textContent = text;
      });
    }
  }
}

function legend(caption, line, named) {
  const item = document.createElement('span');
  item.className = 'value';
  item.innerHTML = `<i class="key line ${line.colour}${line.dash ? ' dashed' : ''}"></i>${named ? `${line.name} ` : ''}<output></output>`;
  caption.append(item);
  return item.lastElementChild;
}

/** A limit as a dashed line, with the area beyond it shaded. */
function drawLimit(u, strip) {
  const { top, left, width } = u.bbox;
  if (strip.limit == null || strip.limit > u.scales.y.max) return;
  const g = u.ctx;
  const y = Math.round(u.valToPos(strip.limit, 'y', true));
  const ratio = window.devicePixelRatio || 1;
  g.save();
  g.fillStyle = g.strokeStyle = colours.limit;
  g.globalAlpha = 0.1;
  g.fillRect(left, top, width, y - top);
  g.globalAlpha = 1;
  g.lineWidth = ratio;
  g.setLineDash([4 * ratio, 4 * ratio]);
  g.beginPath();
  g.moveTo(left, y);
  g.lineTo(left + width, y);
  g.stroke();
  g.font = `${11 * ratio}px system-ui, sans-serif`;
  g.textAlign = 'left';
  g.fillText(`${strip.limitName} ${strip.limit} ${strip.unit}`, left + 4 * ratio, y + 13 * ratio);
  g.restore();
}
