// SPDX-License-Identifier: MIT OR Apache-2.0
// What the canvases share: the style sheet's palette, shapes, and a view of the sheet in millimetres.

import { place } from './model.mjs';

const NAMES = ['page', 'raised', 'rule', 'ink', 'muted', 'grid', 'limit', 'measured', 'true', 'target', 'finger', 'force', 'puck', 'goal'];
const FONT = '12px system-ui, sans-serif';

/** Colours by name and by number of a series. */
export const colours = {};
const hatches = new Map();

/** Reads the palette: once, and again when the system's theme changes. */
export function readColours() {
  const style = getComputedStyle(document.documentElement);
  for (const name of NAMES) colours[name] = style.getPropertyValue(`--${name}`).trim();
  colours.series = [10, 11, 12, 13, 14, 15].map((k) => style.getPropertyValue(`--k${k}`).trim());
  hatches.clear();
}

/** A number with fixed decimals and a true minus sign; a dash where it is unknown. */
export function fixed(value, decimals) {
  if (!Number.isFinite(value)) return '–';
  const text = value.toFixed(decimals);
  return (Number(text) === 0 ? text.replace('-', '') : text).replace('-', '−');
}

export function line(g, points, colour, width = 1, dash = []) {
  Object.assign(g, { strokeStyle: colour, lineWidth: width });
  g.setLineDash(dash);
  g.beginPath();
  for (const [x, y] of points) g.lineTo(x, y);
  g.stroke();
}

function circle(g, [x, y], radius) {
  g.setLineDash([]);
  g.beginPath();
  g.arc(x, y, radius, 0, 2 * Math.PI);
}

export function ring(g, at, radius, colour, width) {
  Object.assign(g, { strokeStyle: colour, lineWidth: width });
  circle(g, at, radius);
  g.stroke();
}

export function disc(g, at, radius, colour, alpha = 1) {
  Object.assign(g, { fillStyle: colour, globalAlpha: alpha });
  circle(g, at, radius);
  g.fill();
  g.globalAlpha = 1;
}

/** An arrow by `(dx, dy)`; nothing where it is shorter than 2 pixels. */
export function arrow(g, [x, y], [dx, dy], colour, width) {
  const size = Math.hypot(dx, dy);
  if (size < 2) return;
  const head = Math.min(3 * width, size);
  const [ux, uy] = [dx / size, dy / size];
  const [bx, by] = [x + dx - head * ux, y + dy - head * uy];
  line(g, [[x, y], [bx, by]], colour, width);
  g.fillStyle = colour;
  g.beginPath();
  g.moveTo(x + dx, y + dy);
  g.lineTo(bx - 0.6 * head * uy, by + 0.6 * head * ux);
  g.lineTo(bx + 0.6 * head * uy, by - 0.6 * head * ux);
  g.fill();
}

/** A spring between two points: zigzags of `size` pixels to each side. */
export function spring(g, [x, y], [tx, ty], colour, turns = 6, size = 5) {
  const [dx, dy] = [tx - x, ty - y];
  const span = Math.hypot(dx, dy);
  if (span < 1) return;
  const at = (share, side) => [x + share * dx - (side * size * dy) / span, y + share * dy + (side * size * dx) / span];
  const zigzag = Array.from({ length: 2 * turns }, (_, k) => at(0.12 + (0.76 * (k + 0.5)) / (2 * turns), k % 2 ? 1 : -1));
  line(g, [at(0, 0), at(0.12, 0), ...zigzag, at(0.88, 0), at(1, 0)], colour, 1.25);
}

/** Slanting lines `gap` pixels apart. */
function hatch(g, gap) {
  if (!hatches.has(gap)) {
    const tile = Object.assign(document.createElement('canvas'), { width: gap, height: gap });
    const context = tile.getContext('2d');
    context.globalAlpha = 0.55;
    for (const shift of [-gap, 0, gap]) line(context, [[shift, gap], [shift + gap, 0]], colours.muted);
    hatches.set(gap, g.createPattern(tile, 'repeat'));
  }
  return hatches.get(gap);
}

/** Text with a halo, so that lines behind it do not disturb; `style` is the beginning of a font. */
export function label(g, text, x, y, colour, align = 'left', style = '') {
  const halo = { strokeStyle: colours.page, lineWidth: 3, lineJoin: 'round', fillStyle: colour };
  Object.assign(g, { font: style + FONT, textAlign: align, ...halo });
  g.setLineDash([]);
  g.strokeText(text, x, y);
  g.fillText(text, x, y);
}

/** Haptic force on a pad as a vector on the screen (y down), N: against the hand. Null without a direction. */
export function forceVector(pad) {
  const newtons = pad.true_force_n ?? pad.force_n;
  if (newtons == null || !(pad.hand_n > 0.005)) return null;
  return [(-pad.hand_x_n / pad.hand_n) * newtons, (pad.hand_y_n / pad.hand_n) * newtons];
}

/** A canvas as a view of the sheet: `origin`, in mm, lies at its middle, and a millimetre has `scale` pixels. */
export class View {
  constructor(canvas, model) {
    Object.assign(this, { canvas, model, scale: 1, origin: [0, 0], width: 0, height: 0 });
  }

  /** A cleared context in CSS pixels. A height makes the canvas so high; without one the style sheet does. */
  begin(height) {
    const { canvas } = this;
    const ratio = window.devicePixelRatio || 1;
    if (height) canvas.style.height = `${height}px`;
    [this.width, this.height] = [canvas.clientWidth, height ?? canvas.clientHeight];
    const [columns, rows] = [this.width, this.height].map((size) => Math.round(size * ratio));
    if (canvas.width !== columns || canvas.height !== rows) [canvas.width, canvas.height] = [columns, rows];
    const g = canvas.getContext('2d');
    g.setTransform(ratio, 0, 0, ratio, 0, 0);
    g.clearRect(0, 0, this.width, this.height);
    return g;
  }

  /** Pixels of a place in millimetres. */
  at([x, y]) {
    return [this.width / 2 + (x - this.origin[0]) * this.scale, this.height / 2 - (y - this.origin[1]) * this.scale];
  }

  /** Where a pointer is, mm. */
  toMm(event) {
    const box = this.canvas.getBoundingClientRect();
    const [x, y] = [event.clientX - box.left - this.width / 2, event.clientY - box.top - this.height / 2];
    return [this.origin[0] + x / this.scale, this.origin[1] - y / this.scale];
  }

  /** The walls within a box of half-widths `reach` about `middle`, in mm: hatched, with their surface as a line. */
  walls(g, middle, reach, gap) {
    this.model.hello.walls.forEach((wall, k) => {
      const mm = this.model.shown.walls[k];
      if (mm != null) this.wall(g, { axis: wall.axis === 'x' ? 0 : 1, mm, below: wall.inside === 'below' }, middle, reach, gap);
    });
  }

  /** One wall across an axis, whose inside is below its surface or above it. */
  wall(g, { axis, mm, below }, middle, reach, gap) {
    const low = middle.map((centre, of) => centre - reach[of]);
    const high = middle.map((centre, of) => centre + reach[of]);
    const surface = Math.min(high[axis], Math.max(low[axis], mm));
    (below ? high : low)[axis] = surface;
    const [[left, bottom], [right, top]] = [this.at(low), this.at(high)];
    g.fillStyle = hatch(g, gap);
    g.fillRect(left, top, right - left, bottom - top);
    if (surface !== mm) return;
    const ends = [low, high].map((end) => end.map((of, along) => (along === axis ? mm : of)));
    line(g, ends.map((end) => this.at(end)), colours.ink, 2);
  }

  /** How deep a pad is in each wall, mm: `[axis, surface, depth]`. */
  depths(pad) {
    const { arena } = this.model.hello;
    if (arena) {
      const at = place(pad);
      return arena.reach_mm[pad.pad].flatMap(([from, to], axis) => [[axis, from, from - at[axis]], [axis, to, at[axis] - to]]);
    }
    return this.model.hello.walls.map((wall, k) => {
      const axis = wall.axis === 'x' ? 0 : 1;
      const mm = this.model.shown.walls[k];
      const depth = mm == null ? 0 : (mm - place(pad)[axis]) * (wall.inside === 'below' ? 1 : -1);
      return [axis, mm, depth];
    });
  }
}
