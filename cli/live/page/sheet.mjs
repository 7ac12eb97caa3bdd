// SPDX-License-Identifier: MIT OR Apache-2.0
// The whole sheet to scale: terminals, walls, pads with their fingers, errors and forces.

import { drawArena, drawPuck, drawScore } from './arena.mjs';
import { arrow, colours, disc, fixed, forceVector, label, line, ring, View } from './draw.mjs';
import { finger, place } from './model.mjs';

const PIXELS_PER_N = 70;
const TRAIL_S = 1;
/** A pointer takes the nearest pad within this distance: in millimetres, and in pixels. */
const [REACH_MM, REACH_PIXELS] = [45, 26];
/** Narrower sheets have shorter labels, in pixels. */
const NARROW = 500;
const still = window.matchMedia('(prefers-reduced-motion: reduce)');

export class Sheet extends View {
  /** Number of the pad that a pointer takes; null where none is near. */
  hit(event) {
    const [x, y] = this.toMm(event);
    let [best, least] = [null, Math.max(REACH_MM, REACH_PIXELS / this.scale)];
    for (const pad of this.model.latest?.pads.filter(Boolean) ?? []) {
      for (const [px, py] of [place(pad), finger(pad)]) {
        const away = Math.hypot(px - x, py - y);
        if (away < least) [best, least] = [pad.pad, away];
      }
    }
    return best;
  }

  draw() {
    const { hello, shown } = this.model;
    const reach = hello.sheet_mm.map((mm) => mm / 2);
    this.margin = this.canvas.clientWidth < NARROW ? 18 : 28;
    this.scale = (this.canvas.clientWidth - 2 * this.margin) / hello.sheet_mm[0];
    this.radius = Math.max(5, (hello.pad_diameter_mm / 2) * this.scale);
    const g = this.begin(Math.round(hello.sheet_mm[1] * this.scale + 2 * this.margin));
    this.drawSheet(g, reach);
    drawArena(g, this);
    if (!shown) return;
    const pads = shown.pads.filter(Boolean);
    this.walls(g, [0, 0], reach, 8);
    this.drawTerminals(g, shown);
    if (!still.matches) this.drawTrails(g, pads);
    for (const pad of pads) this.drawPad(g, pad);
    drawPuck(g, this);
    drawScore(g, this);
    for (const pad of pads) this.drawLabel(g, pad);
  }

  drawSheet(g, [w, h]) {
    const [[left, top], [right, bottom]] = [this.at([-w, h]), this.at([w, -h])];
    g.fillStyle = colours.raised;
    g.fillRect(left, top, right - left, bottom - top);
    for (let mm = -100 * Math.floor(w / 100); mm <= w; mm += 100) {
      line(g, [this.at([mm, -h]), this.at([mm, h])], colours.grid);
      if (Math.abs(mm) <= h) line(g, [this.at([-w, mm]), this.at([w, mm])], colours.grid);
    }
    line(g, [[left, top], [right, top], [right, bottom], [left, bottom], [left, top]], colours.muted);
  }

  /** Discs whose area is the current. */
  drawTerminals(g, shown) {
    this.model.hello.terminals_mm.forEach((mm, k) => {
      const [x, y] = this.at(mm);
      disc(g, [x, y], 3 + (this.margin - 5) * Math.sqrt(Math.min(1, shown.terminals[k] ?? 0)), colours.measured, 0.4);
      disc(g, [x, y], 2.5, colours.ink);
      const side = x < 3 * this.margin ? 1 : x > this.width - 3 * this.margin ? -1 : 0;
      const lower = mm[1] > 0 ? this.margin + (side ? -8 : 4) : (side ? 16 : 4) - this.margin;
      label(g, `I${k + 1}`, x + side * 16, y + lower, colours.muted, ['right', 'center', 'left'][side + 1]);
    });
  }

  drawTrails(g, pads) {
    const frames = this.model.within([this.model.shown.time_s - TRAIL_S, this.model.shown.time_s]);
    g.globalAlpha = 0.4;
    for (const { pad } of pads) {
      const known = frames.map((frame) => frame.pads[pad]).filter(Boolean);
      line(g, known.map((of) => this.at(place(of))), colours.true, 2);
    }
    g.globalAlpha = 1;
  }

  drawPad(g, pad) {
    const centre = this.at(place(pad));
    disc(g, centre, this.radius, colours.page, 0.85);
    const colour = this.model.hello.truth ? colours.true : colours.measured;
    ring(g, centre, this.radius, colour, pad.pad === this.model.pad ? 3 : 1.5);
    if (pad.finger_x_mm != null) {
      line(g, [centre, this.at(finger(pad))], colours.finger, 1, [3, 3]);
      ring(g, this.at(finger(pad)), Math.max(3.5, this.radius * 0.45), colours.finger, 2);
    }
    if (pad.error_mm != null) {
      const tenfold = place(pad).map((mm, axis) => mm + 10 * ([pad.x_mm, pad.y_mm][axis] - mm));
      line(g, [centre, this.at(tenfold)], colours.measured, 2);
    }
    if (pad.x_mm != null) disc(g, this.at([pad.x_mm, pad.y_mm]), 3, colours.measured);
    const force = forceVector(pad);
    if (force) arrow(g, centre, force.map((n) => n * PIXELS_PER_N), colours.force, 3);
  }

  drawLabel(g, pad) {
    const [x, y] = this.at(place(pad));
    const side = x > this.width - (this.width < NARROW ? 130 : 170) ? -1 : 1;
    const [at, align] = [x + side * (this.radius + 9), side < 0 ? 'right' : 'left'];
    const style = pad.pad === this.model.pad ? '600 ' : '';
    const text = `${fixed(pad.force_n, 2)} N · ${this.model.state(pad)}`;
    // Mallets meet, and so would their labels.
    const short = this.model.hello.arena ? '' : `  ${text}`;
    if (this.width < NARROW) return label(g, `${pad.pad + 1}${short}`, at, y - 4, colours.ink, align, style);
    label(g, this.model.title(pad.pad), at, y - 20, colours.ink, align, style);
    return label(g, text, at, y - 6, colours.muted, align);
  }
}
