// SPDX-License-Identifier: MIT OR Apache-2.0
// Twenty millimetres around the finger of the chosen pad, where wall, depth, spring and force are large enough to see.

import { drawPuck, drawReach } from './arena.mjs';
import { arrow, colours, disc, fixed, forceVector, label, line, ring, spring, View } from './draw.mjs';
import { finger, place } from './model.mjs';

const WIDTH_MM = 20;
const PIXELS_PER_N = 110;
/** The view moves only when the finger leaves this share of it on each side of the middle, so that it is calm. */
const CALM = 0.3;

export class Loupe extends View {
  /** A drag anywhere takes the chosen pad. */
  hit() {
    return this.model.pad;
  }

  /** Only differences count, since the view moves. */
  toMm(event) {
    return [event.clientX / this.scale, -event.clientY / this.scale];
  }

  draw() {
    const g = this.begin();
    const pad = this.model.shown?.pads[this.model.pad];
    if (!pad || place(pad)[0] == null) return;
    this.scale = this.width / WIDTH_MM;
    this.follow(finger(pad));
    const reach = [this.width, this.height].map((size) => size / 2 / this.scale);
    this.drawGrid(g, reach);
    disc(g, this.at(place(pad)), this.rim, colours.true, 0.06);
    // A little more than is seen, so that a surface at the edge is no line there.
    this.walls(g, this.origin, reach.map((mm) => mm + 1), 10);
    drawReach(g, this, reach.map((mm) => mm + 1));
    drawPuck(g, this);
    this.drawPad(g, pad);
    const [right, bottom] = [this.width - 12, this.height - 12];
    line(g, [[right - 5 * this.scale, bottom], [right, bottom]], colours.muted, 3);
    label(g, '5 mm', right - 2.5 * this.scale, bottom - 7, colours.muted, 'center');
  }

  get rim() {
    return (this.model.hello.pad_diameter_mm / 2) * this.scale;
  }

  follow(mm) {
    const { pad, hello } = this.model;
    if (this.of !== `${pad} ${hello.scene}`) [this.of, this.origin] = [`${pad} ${hello.scene}`, mm];
    this.origin = this.origin.map((origin, axis) => {
      const room = (CALM * [this.width, this.height][axis]) / this.scale;
      return Math.min(mm[axis] + room, Math.max(mm[axis] - room, origin));
    });
  }

  drawGrid(g, [w, h]) {
    const [x, y] = this.origin;
    const shade = (mm) => (mm % 5 ? colours.grid : colours.rule);
    for (let mm = Math.ceil(x - w); mm <= x + w; mm++) line(g, [[mm, y - h], [mm, y + h]].map((of) => this.at(of)), shade(mm));
    for (let mm = Math.ceil(y - h); mm <= y + h; mm++) line(g, [[x - w, mm], [x + w, mm]].map((of) => this.at(of)), shade(mm));
  }

  drawPad(g, pad) {
    const [centre, tip] = [this.at(place(pad)), this.at(finger(pad))];
    const colour = this.model.hello.truth ? colours.true : colours.measured;
    ring(g, centre, this.rim, colour, 1.5);
    this.drawDepths(g, pad, centre);
    if (pad.finger_x_mm != null) spring(g, centre, tip, colours.finger);
    disc(g, centre, 11, colours.page, 0.9);
    ring(g, centre, 11, colour, 3);
    if (pad.x_mm != null) disc(g, this.at([pad.x_mm, pad.y_mm]), 5, colours.measured);
    if (pad.finger_x_mm != null) {
      ring(g, tip, 17, colours.finger, 3);
      if (Math.hypot(tip[0] - centre[0], tip[1] - centre[1]) > 45) {
        label(g, 'finger', tip[0], tip[1] + 32, colours.muted, 'center');
        label(g, 'pad', centre[0], centre[1] + 25, colours.muted, 'center');
      }
    }
    this.drawForce(g, pad, centre);
  }

  drawForce(g, pad, [x, y]) {
    const force = forceVector(pad);
    if (!force) return;
    const [fx, fy] = force.map((n) => n * PIXELS_PER_N);
    arrow(g, [x, y], [fx, fy], colours.force, 5);
    if (Math.hypot(fx, fy) < 20) return;
    label(g, `${fixed(Math.hypot(...force), 2)} N`, x + fx / 2, y + fy / 2 - 18, colours.ink, 'center', '600 ');
  }

  /** A dimension from the surface of each wall that the pad is in to the pad's centre. */
  drawDepths(g, pad, centre) {
    for (const [axis, mm, depth] of this.depths(pad)) {
      if (!(depth > 0)) continue;
      const surface = this.at(place(pad).map((of, along) => (along === axis ? mm : of)));
      const ends = [surface, centre].map(([x, y]) => (axis ? [x + 40, y] : [x, y + 46]));
      line(g, ends, colours.ink, 1.5);
      for (const [x, y] of ends) line(g, axis ? [[x - 5, y], [x + 5, y]] : [[x, y - 5], [x, y + 5]], colours.ink, 1.5);
      const [x, y] = [0, 1].map((along) => (ends[0][along] + ends[1][along]) / 2);
      label(g, `${fixed(depth, 2)} mm deep`, axis ? x + 8 : x, axis ? y + 4 : y + 18, colours.ink, axis ? 'left' : 'center');
    }
  }
}
