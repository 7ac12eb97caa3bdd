// SPDX-License-Identifier: MIT OR Apache-2.0
// Strips: the chosen pad's quantities over the last seconds, one below the other on one time axis.

import { colours, fixed } from './draw.mjs';

const AXIS_PIXELS = 22;
/** Height of a plot where the layout does not decide it. */
const PLOT_PIXELS = 92;
const wide = window.matchMedia('(min-width: 65rem)');

/**
 * The strips of a source. A line has a name, colour, column and dash, a limit its value and name; `least` is the
 * smallest range of the axis, which holds zero unless the strip is `free`.
 */
function strips({ limits, truth, walls, arena, controller, hand }) {
  const strip = (title, unit, decimals, least, words, lines, more) => ({ title, unit, decimals, least, words, lines, ...more });
  const one = (colour, column) => [['', colour, column]];
  const measured = (column) => [['measured', 'measured', column], ...(truth ? [['true', 'true', `true_${column}`]] : [])];
  const asked = (name, column) => (controller ? [[name, 'target', column, [6, 4]]] : []);
  const limit = (value, name) => (value == null ? {} : { limit: [value, name] });
  const depth = strip('Depth in the wall', 'mm', 2, 2, 'Measured, behind the surface; negative outside.', one('measured', 'depth_mm'));
  const ahead = strip('Finger ahead of the pad', 'mm', 2, 1, 'The hand is a spring between the two.', one('finger', 'ahead_mm'));
  const load = strip('Load', 'g', 0, 50, 'With which the pad is pressed on the sheet.', one('finger', 'load_g'));
  const error = strip('Position error', 'mm', 2, 0.5, 'From the true to the measured position.', one('measured', 'error_mm'),
    limit(limits.position_mm, 'limit'));
  return [
    strip('Haptic force', 'N', 3, 0.2, 'Friction that the voltage adds. Target: what wall or controller ask for.',
      [...measured('force_n'), ...asked('target', 'target_n')]),
    walls.length || arena ? depth : hand ? ahead : load,
    strip('Haptic voltage', 'V rms', 0, 50, 'Across the pad. Drive: what the controller asks for; rail: its limit.',
      [...measured('haptic_v_rms'), ...asked('drive', 'drive_v_rms')], limit(limits.rail_v, 'rail')),
    strip('Capacitance', 'pF', 1, 2, 'Between pad and sheet. It rises as the gap closes.', measured('capacitance_pf'), { free: true }),
    ...(truth ? [error] : []),
  ];
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
export function axis() {
  return { stroke: colours.muted, grid: { stroke: colours.grid, width: 1 }, ticks: { show: false }, font: '11px system-ui' };
}

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
    const times = (plot, ticks) => ticks.map((tick) => (last && tick >= 0 ? seconds(tick) : ''));
    return {
      width: 400, height: PLOT_PIXELS, padding: [6, 14, last ? 0 : 4, 0], legend: { show: false },
      cursor: { sync: { key: 'strips' }, y: false, drag: { x: true, y: false, setScale: false },
        bind: { dblclick: () => () => this.unzoom() } },
      scales: { x: { time: false }, y: { range: (plot, low, high) => range(strip, low, high) } },
      axes: [{ ...axis(), size: last ? AXIS_PIXELS : 0, space: 60, gap: 2, values: times },
        { ...axis(), size: 44, space: 24, gap: 4, values: (plot, ticks) => ticks.map(plain) }],
      series: [{}, ...strip.lines.map(([, colour, , dash], k) =>
        ({ stroke: colours[colour], width: k ? 1.25 : 1.75, dash, points: { show: false } }))],
      hooks: { drawAxes: [(plot) => this.drawLimit(plot, strip)], setSelect: [(plot) => this.zoom(plot)],
        setCursor: [(plot) => this.point(plot)] },
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
    const width = this.box.clientWidth;
    for (const { plot, last } of this.plots) plot.setSize({ width, height: height + (last ? AXIS_PIXELS : 0) });
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
