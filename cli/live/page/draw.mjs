// SPDX-License-Identifier: MIT OR Apache-2.0
// Shapes that the canvases share, and the palette of the style sheet.

const NAMES = ['page', 'raised', 'rule', 'ink', 'muted', 'grid', 'limit', 'measured', 'true', 'target', 'finger', 'force'];

/** Colours by name; read from the style sheet once, and again when the system's theme changes. */
export const colours = {};

export function readColours() {
  const style = getComputedStyle(document.documentElement);
  for (const name of NAMES) colours[name] = style.getPropertyValue(`--${name}`).trim();
  for (let k = 10; k < 16; k++) colours[k] = style.getPropertyValue(`--k${k}`).trim();
  hatches.clear();
}

const hatches = new Map();

/** A canvas context in CSS pixels, cleared: `[context, width, height]`. */
export function begin(canvas, height) {
  const scale = window.devicePixelRatio || 1;
  const width = canvas.clientWidth;
  const [columns, rows] = [Math.round(width * scale), Math.round(height * scale)];
  if (canvas.width !== columns || canvas.height !== rows) {
    [canvas.width, canvas.height] = [columns, rows];
    canvas.style.height = `${height}px`;
  }
  const context = canvas.getContext('2d');
  context.setTransform(scale, 0, 0, scale, 0, 0);
  context.clearRect(0, 0, width, height);
  context.font = '12px system-ui, sans-serif';
  context.lineCap = 'round';
  return [context, width, height];
}

export function line(g, points, colour, width = 1, dash = []) {
  g.strokeStyle = colour;
  g.lineWidth = width;
  g.setLineDash(dash);
  g.beginPath();
  for (const [x, y] of points) g.lineTo(x, y);
  g.stroke();
  g.setLineDash([]);
}

export function ring(g, [x, y], radius, colour, width = 1.5) {
  g.strokeStyle = colour;
  g.lineWidth = width;
  g.beginPath();
  g.arc(x, y, radius, 0, 2 * Math.PI);
  g.stroke();
}

export function disc(g, [x, y], radius, colour, alpha = 1) {
  g.globalAlpha = alpha;
  g.fillStyle = colour;
  g.beginPath();
  g.arc(x, y, radius, 0, 2 * Math.PI);
  g.fill();
  g.globalAlpha = 1;
}

/** An arrow from `a` by `(dx, dy)`; nothing where it is shorter than 2 pixels. */
export function arrow(g, [x, y], [dx, dy], colour, width = 3) {
  const size = Math.hypot(dx, dy);
  if (size < 2) return;
  const head = Math.min(3 * width, size);
  const [ux, uy] = [dx / size, dy / size];
  const [bx, by] = [x + dx - head * ux, y + dy - head * uy];
  g.lineCap = 'butt';
  line(g, [[x, y], [bx, by]], colour, width);
  g.lineCap = 'round';
  g.fillStyle = colour;
  g.beginPath();
  g.moveTo(x + dx, y + dy);
  g.lineTo(bx - 0.6 * head * uy, by + 0.6 * head * ux);
  g.lineTo(bx + 0.6 * head * uy, by - 0.6 * head * ux);
  g.fill();
}

/** A spring between two points: `turns` zigzags of `size` pixels to each side. */
export function spring(g, [x, y], [tx, ty], colour, turns = 6, size = 5) {
  const [dx, dy] = [tx - x, ty - y];
  const span = Math.hypot(dx, dy);
  if (span < 1) return;
  const [nx, ny] = [(-dy / span) * size, (dx / span) * size];
  const at = (share, side) => [x + share * dx + side * nx, y + share * dy + side * ny];
  const points = [at(0, 0), at(0.12, 0)];
  for (let k = 0; k < 2 * turns; k++) points.push(at(0.12 + (0.76 * (k + 0.5)) / (2 * turns), k % 2 ? 1 : -1));
  line(g, [...points, at(0.88, 0), at(1, 0)], colour, 1.25);
}

/** A hatched area: slanting lines `gap` pixels apart. */
export function hatch(g, x, y, width, height, gap = 8) {
  if (width <= 0 || height <= 0) return;
  if (!hatches.has(gap)) hatches.set(gap, g.createPattern(tile(gap), 'repeat'));
  g.fillStyle = hatches.get(gap);
  g.fillRect(x, y, width, height);
}

function tile(gap) {
  const canvas = document.createElement('canvas');
  canvas.width = canvas.height = gap;
  const g = canvas.getContext('2d');
  g.globalAlpha = 0.55;
  for (const shift of [-gap, 0, gap]) line(g, [[shift, gap], [shift + gap, 0]], colours.muted, 1);
  return canvas;
}

/** Text with a halo of the page's colour, so that lines behind it do not disturb. */
export function label(g, text, x, y, colour, align = 'left', font = '12px system-ui, sans-serif') {
  g.font = font;
  g.textAlign = align;
  g.lineJoin = 'round';
  g.strokeStyle = colours.page;
  g.lineWidth = 3;
  g.strokeText(text, x, y);
  g.fillStyle = colour;
  g.fillText(text, x, y);
}

/** A number with fixed decimals and a true minus sign; a dash where it is unknown. */
export function fixed(value, decimals) {
  if (value == null || !Number.isFinite(value)) return '–';
  const text = value.toFixed(decimals);
  return (Number(text) === 0 ? text.replace('-', '') : text).replace('-', '−');
}
