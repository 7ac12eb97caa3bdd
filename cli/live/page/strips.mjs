// SPDX-License-Identifier: MIT OR Apache-2.0
// Strips: the chosen pad's quantities over the last seconds, one below the other on one time axis.

import { colours, fixed } from './draw.mjs';

const AXIS_PIXELS = 22;
/** Height of a plot where the layout does not decide it. */
const PLOT_PIXELS = 92;
const wide = window.matchMedia('(min-width: 65rem)');

/** The strips of a source. A line: name, colour, column, dash. A limit: value and name. `least`: the smallest range. */
function strips({ limits, truth, walls, controller, hand }) {
  const measured = (column) => ['measured', 'measured', column];
  const known = (column) => (truth ? [['true', 'true', column]] : []);
  const rail = limits.rail_v == null ? null : [limits.rail_v, 'rail'];
  const depth = { title: 'Depth in the wall', unit: 'mm', decimals: 2, least: 2, words: 'Measured, behind the surface; negative outside.',
    lines: [['', 'measured', 'depth_mm']] };
  const ahead = { title: 'Finger ahead of the pad', unit: 'mm', decimals: 2, least: 1, words: 'The hand is a spring between the two.',
    lines: [['', 'finger', 'ahead_mm']] };
  const load = { title: 'Load', unit: 'g', decimals: 0, least: 50, words: 'With which the pad is pressed on the sheet.',
    lines: [['', 'finger', 'load_g']] };
  const list = [
    { title: 'Haptic force', unit: 'N', decimals: 3, least: 0.2, words: 'Friction that the voltage adds. Target: what wall or controller ask for.',
      lines: [measured('force_n'), ...known('true_force_n'), ...(controller ? [['target', 'target', 'target_n', [6, 4]]] : [])] },
    walls.length ? depth : hand ? ahead : load,
    { title: 'Haptic voltage', unit: 'V rms', decimals: 0, least: 50, limit: rail, words: 'Across the pad. Drive: what the source puts out; rail: its limit.',
      lines: [measured('haptic_v_rms'), ...known('true_haptic_v_rms'), ...(controller ? [['drive', 'target', 'drive_v_rms', [6, 4]]] : [])] },
    { title: 'Capacitance', unit: 'pF', decimals: 1, least: 2, free: true, words: 'Between pad and sheet. It rises as the gap closes.',
      lines: [measured('capacitance_pf'), ...known('true_capacitance_pf')] },
  ];
  const limit = limits.position_mm == null ? null : [limits.position_mm, 'limit'];
  if (truth) list.push({ title: 'Position error', unit: 'mm', decimals: 2, least: 0.5, limit, words: 'Between measured and true position.',
    lines: [['', 'measured', 'error_mm']] });
  return list;
}

const STEPS = [1, 1.2, 1.6, 2, 2.5, 3, 4, 5, 6, 8, 10];

/** Range of an axis in round steps, so that it does not tremble. Zero is in it, unless the strip is `free`. */
function range({ least, free }, low, high) {
  if (low == null) [low, high] = [0, 0];
  if (!free) [low, high] = [Math.min(0, low), Math.max(0, high)];
  const wanted = Math.max(least, (high - low) * 1.1);
  const power = 10 ** Math.floor(Math.log10(wanted));
  const span = power * STEPS.find((step) => step * power >= wanted * 0.999);
  const step = span / 10;
  const from = free ? Math.floor((low + high - span) / 2 / step) * step : Math.floor(low / step + 1e-6) * step;
  return [from, Math.max(from + span, high)];
}

/** A time without the zeros at its end. */
const seconds = (value) => `${fixed(value, 3).replace(/\.?0+$/, '')} s`;
export const plain = (value) => String(Number(value.toFixed(3))).replace('-', '−');

/** What axes of all plots have in common. */
export const axis = () => ({ stroke: colours.muted, grid: { stroke: colours.grid, width: 1 }, ticks: { show: false }, font: '11px system-ui' });

export class Strips {
  constructor(box, model, onChange) {
    Object.assign(this, { box, model, onChange, plots: [], span_s: 10 });
    new ResizeObserver(() => this.resize()).observe(box);
  }

  /** Makes the strips anew: for a new source and after a change of theme. */
  build() {
    for (const { plot } of this.plots) plot.destroy();
    this.box.replaceChildren();
    const list = strips(this.model.hello);
    this.plots = list.map((strip, k) => this.add(strip, k === list.length - 1));
    this.resize();
  }

  add(strip, last) {
    const figure = document.createElement('figure');
    const caption = figure.appendChild(document.createElement('figcaption'));
    caption.title = strip.words;
    caption.innerHTML = `<b>${strip.title}</b> <small>${strip.unit}</small>` + strip.lines.map(([name, colour, , dash]) =>
      `<span class="value"><i class="key line ${colour}${dash ? ' dashed' : ''}"></i>${name} <output></output></span>`).join('');
    this.box.append(figure);
    const plot = new window.uPlot(this.options(strip, last), [[], ...strip.lines.map(() => [])], figure);
    return { plot, strip, caption, last, values: caption.querySelectorAll('output') };
  }

  options(strip, last) {
    return {
      width: 400, height: PLOT_PIXELS, padding: [6, 4, last ? 0 : 4, 0], legend: { show: false },
      cursor: { sync: { key: 'strips' }, y: false, drag: { x: true, y: false, setScale: false },
        bind: { dblclick: () => () => this.unzoom() } },
      scales: { x: { time: false }, y: { range: (plot, low, high) => range(strip, low, high) } },
      axes: [{ ...axis(), size: last ? AXIS_PIXELS : 0, space: 60, gap: 2, values: (plot, ticks) => ticks.map((tick) => (last && tick >= 0 ? seconds(tick) : '')) },
        { ...axis(), size: 44, space: 24, gap: 4, values: (plot, ticks) => ticks.map(plain) }],
      series: [{}, ...strip.lines.map(([, colour, , dash], k) =>
        ({ stroke: colours[colour], width: k ? 1.25 : 1.75, dash, points: { show: false } }))],
      hooks: { drawAxes: [(plot) => this.drawLimit(plot, strip)], setSelect: [(plot) => this.zoom(plot)], setCursor: [(plot) => this.point(plot)] },
    };
  }

  /** A limit as a dashed line with the area beyond it shaded. */
  drawLimit(plot, { limit, unit }) {
    if (!limit || limit[0] > plot.scales.y.max) return;
    const [{ left, top, width }, g, ratio] = [plot.bbox, plot.ctx, window.devicePixelRatio || 1];
    const y = Math.round(plot.valToPos(limit[0], 'y', true));
    g.save();
    Object.assign(g, { fillStyle: colours.limit, strokeStyle: colours.limit, lineWidth: ratio, globalAlpha: 0.1 });
    g.fillRect(left, top, width, y - top);
    g.globalAlpha = 1;
    g.setLineDash([4 * ratio, 4 * ratio]);
    g.strokeRect(left, y, width, 0);
    Object.assign(g, { font: `${11 * ratio}px system-ui`, textAlign: 'left' });
    g.fillText(`${limit[1]} ${limit[0]} ${unit}`, left + 4 * ratio, y - top > 14 * ratio ? y - 4 * ratio : y + 12 * ratio);
    g.restore();
  }

  /** Zooms to the span that was drawn with the pointer, and holds the picture. */
  zoom(plot) {
    if (plot.select.width < 4) return;
    const ends = [plot.select.left, plot.select.left + plot.select.width].map((left) => plot.posToVal(left, 'x'));
    plot.setSelect({ left: 0, width: 0, top: 0, height: 0 }, false);
    this.model.freeze(ends[1]);
    this.model.range = ends;
    this.onChange();
  }

  unzoom() {
    this.model.follow();
    this.onChange();
  }

  /** Shows values at the pointer's time; with the picture held, the sheet at that time, too. */
  point(plot) {
    const inside = plot.cursor.left >= 0;
    if (inside && !plot.over.matches(':hover')) return;
    const time_s = inside ? plot.posToVal(plot.cursor.left, 'x') : null;
    if (time_s === this.model.cursor_s) return;
    this.model.cursor_s = time_s;
    if (inside && this.model.frozen) this.model.held = this.model.at(time_s);
    this.onChange();
  }

  resize() {
    const captions = this.plots.reduce((sum, { caption }) => sum + caption.offsetHeight + 6, 0);
    const share = Math.floor((this.box.clientHeight - captions - AXIS_PIXELS) / this.plots.length);
    const height = wide.matches ? Math.max(70, share) : PLOT_PIXELS;
    for (const { plot, last } of this.plots) plot.setSize({ width: this.box.clientWidth, height: height + (last ? AXIS_PIXELS : 0) });
  }

  draw() {
    const { model } = this;
    const [min, max] = model.span(this.span_s);
    const frames = model.within([min, max]).filter((frame) => frame.pads[model.pad]);
    const times = frames.map((frame) => frame.time_s);
    for (const { plot, strip } of this.plots) {
      const data = strip.lines.map(([, , column]) => frames.map((frame) => frame.pads[model.pad][column]));
      plot.batch(() => {
        plot.setData([times, ...data], false);
        plot.setScale('x', { min, max });
      });
    }
  }

  drawValues() {
    const { model } = this;
    const frame = model.cursor_s == null || !model.frames.length ? model.shown : model.at(model.cursor_s);
    for (const { strip, values } of this.plots) {
      strip.lines.forEach(([, , column], k) => (values[k].textContent = fixed(frame?.pads[model.pad]?.[column], strip.decimals)));
    }
  }
}
