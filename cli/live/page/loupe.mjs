// SPDX-License-Identifier: MIT OR Apache-2.0
// Twenty millimetres around the finger of the chosen pad, where wall, depth, spring and force are large enough to see.

import { arrow, begin, colours, disc, fixed, hatch, label, line, ring, spring } from './draw.mjs';
import { place } from './model.mjs';
import { forceVector } from './sheet.mjs';

const WIDTH_MM = 20;
const PIXELS_PER_N = 110;
/** The view moves only when the finger leaves this share of it, so that it is calm. */
const CALM = 0.3;

export class Loupe {
  constructor(canvas, model) {
    Object.assign(this, { canvas, model, middle: null, pad: null });
  }

  /** Pixels per millimetre. */
  get scale() {
    return this.canvas.clientWidth / WIDTH_MM;
  }

  x(mm) {
    return this.canvas.clientWidth / 2 + (mm - this.middle[0]) * this.scale;
  }

  y(mm) {
    return this.height / 2 - (mm - this.middle[1]) * this.scale;
  }

  draw() {
    this.height = Math.round(Math.min(this.canvas.clientWidth, window.innerWidth < 700 ? 260 : 400));
    const [g, width, height] = begin(this.canvas, this.height);
    const pad = this.model.shown?.pads[this.model.pad];
    if (!pad || place(pad)[0] == null) return;
    const finger = pad.finger_x_mm == null ? place(pad) : [pad.finger_x_mm, pad.finger_y_mm];
    this.follow(finger);
    this.drawGrid(g, width, height);
    this.drawWalls(g, width, height);
    this.drawPad(g, pad, finger);
    this.drawScale(g, width, height);
  }

  follow(finger) {
    if (this.pad !== this.model.pad) [this.pad, this.middle] = [this.model.pad, [...finger]];
    const room = [CALM * WIDTH_MM, (CALM * this.height) / this.scale];
    for (const axis of [0, 1]) {
      const off = finger[axis] - this.middle[axis];
      if (Math.abs(off) > room[axis]) this.middle[axis] = finger[axis] - Math.sign(off) * room[axis];
    }
  }

  drawGrid(g, width, height) {
    const [cx, cy] = this.middle.map(Math.round);
    for (let k = -WIDTH_MM / 2 - 1; k <= WIDTH_MM / 2 + 1; k++) {
      const colour = (mm) => (mm % 5 ? colours.grid : colours.rule);
      line(g, [[this.x(cx + k), 0], [this.x(cx + k), height]], colour(cx + k));
      line(g, [[0, this.y(cy + k)], [width, this.y(cy + k)]], colour(cy + k));
    }
  }

  drawWalls(g, width, height) {
    this.model.hello.walls.forEach((wall, k) => {
      const mm = this.model.shown.walls[k];
      if (mm == null) return;
      const below = wall.inside === 'below';
      if (wall.axis === 'x') {
        const at = Math.min(Math.max(this.x(mm), -2), width + 2);
        hatch(g, below ? 0 : at, 0, below ? at : width - at, height, 10);
        line(g, [[at, 0], [at, height]], colours.ink, 2);
      } else {
        const at = Math.min(Math.max(this.y(mm), -2), height + 2);
        hatch(g, 0, below ? at : 0, width, below ? height - at : at, 10);
        line(g, [[0, at], [width, at]], colours.ink, 2);
      }
    });
  }

  drawPad(g, pad, finger) {
    const { truth, pad_diameter_mm } = this.model.hello;
    const [x, y] = place(pad);
    const centre = [this.x(x), this.y(y)];
    const tip = [this.x(finger[0]), this.y(finger[1])];
    const colour = truth ? colours.true : colours.measured;
    ring(g, centre, (pad_diameter_mm / 2) * this.scale, colour, 2);
    this.drawDepths(g, [x, y]);
    if (pad.finger_x_mm != null) spring(g, centre, tip, colours.finger);
    disc(g, centre, 11, colours.page, 0.9);
    ring(g, centre, 11, colour, 3);
    if (pad.x_mm != null) disc(g, [this.x(pad.x_mm), this.y(pad.y_mm)], 5, colours.measured);
    if (pad.finger_x_mm != null) ring(g, tip, 17, colours.finger, 3);
    const force = forceVector(pad);
    if (!force) return;
    const [fx, fy] = force.map((n) => n * PIXELS_PER_N);
    arrow(g, centre, [fx, fy], colours.force, 5);
    if (Math.hypot(fx, fy) > 25) {
      label(g, `${fixed(Math.hypot(...force), 2)} N`, centre[0] + fx / 2, centre[1] + fy / 2 - 20, colours.force,
        'center', '600 14px system-ui, sans-serif');
    }
  }

  /** Dimension lines from each wall that the pad is in to the pad's centre. */
  drawDepths(g, [x, y]) {
    this.model.hello.walls.forEach((wall, k) => {
      const mm = this.model.shown.walls[k];
      const centre = wall.axis === 'x' ? x : y;
      const depth = mm == null ? 0 : wall.inside === 'below' ? mm - centre : centre - mm;
      if (depth <= 0) return;
      const ends = wall.axis === 'x' ? [[mm, y], [x, y]] : [[x, mm], [x, y]];
      const shift = wall.axis === 'x' ? [0, 34] : [34, 0];
      const points = ends.map(([a, b]) => [this.x(a) + shift[0], this.y(b) + shift[1]]);
      line(g, points, colours.ink, 1.5);
      for (const [a, b] of points) line(g, [[a - shift[1] / 34, b - shift[0] / 34], [a, b]], colours.ink, 6);
      const [[ax, ay], [bx, by]] = points;
      label(g, `${fixed(depth, 2)} mm deep`, (ax + bx) / 2 + shift[0] / 4, (ay + by) / 2 + (shift[1] ? 18 : 4),
        colours.ink, shift[1] ? 'center' : 'left');
    });
  }

  drawScale(g, width, height) {
    const [left, bottom] = [width - 12 - 5 * this.scale, height - 12];
    line(g, [[left, bottom - 4], [left, bottom], [width - 12, bottom], [width - 12, bottom - 4]], colours.muted, 1.5);
    label(g, '5 mm', width - 12 - 2.5 * this.scale, bottom - 6, colours.muted, 'center');
  }
}
