// SPDX-License-Identifier: MIT OR Apache-2.0
// The whole sheet to scale: terminals, walls, pads with their fingers, errors and forces.

import { arrow, begin, colours, disc, fixed, hatch, label, line, ring } from './draw.mjs';
import { place } from './model.mjs';

const PIXELS_PER_N = 70;
const TRAIL_S = 1;
/** A pointer takes the nearest pad within this distance, in millimetres and at least in pixels. */
const REACH_MM = 45;
const REACH_PIXELS = 26;

export const still = window.matchMedia('(prefers-reduced-motion: reduce)');

export class Sheet {
  constructor(canvas, model) {
    Object.assign(this, { canvas, model, scale: 1, middle: [0, 0] });
  }

  x(mm) {
    return this.middle[0] + mm * this.scale;
  }

  y(mm) {
    return this.middle[1] - mm * this.scale;
  }

  /** Place of a pointer on the sheet, in millimetres. */
  toMm(event) {
    const box = this.canvas.getBoundingClientRect();
    return [
      (event.clientX - box.left - this.middle[0]) / this.scale,
      (this.middle[1] - (event.clientY - box.top)) / this.scale,
    ];
  }

  /** Number of the pad that a pointer takes; null where none is near. */
  hit(event) {
    const [x, y] = this.toMm(event);
    let [best, least] = [null, Math.max(REACH_MM, REACH_PIXELS / this.scale)];
    for (const pad of this.model.latest?.pads ?? []) {
      if (!pad) continue;
      for (const [px, py] of [place(pad), this.model.finger(pad.pad)]) {
        const away = Math.hypot(px - x, py - y);
        if (away < least) [best, least] = [pad.pad, away];
      }
    }
    return best;
  }

  draw() {
    const { hello, shown } = this.model;
    const [width_mm, height_mm] = hello.sheet_mm;
    const wide = this.canvas.clientWidth;
    const margin = wide < 500 ? 20 : 30;
    this.scale = (wide - 2 * margin) / width_mm;
    const [g, width, height] = begin(this.canvas, Math.round(height_mm * this.scale + 2 * margin));
    this.middle = [width / 2, height / 2];
    this.drawSheet(g, width_mm, height_mm);
    if (!shown) return;
    this.drawWalls(g, shown, width_mm, height_mm);
    this.drawTerminals(g, shown, margin);
    if (!still.matches) this.drawTrails(g, shown);
    for (const pad of shown.pads) if (pad) this.drawPad(g, pad);
    for (const pad of shown.pads) if (pad) this.drawLabel(g, pad, width);
  }

  drawSheet(g, width_mm, height_mm) {
    const [left, top] = [this.x(-width_mm / 2), this.y(height_mm / 2)];
    g.fillStyle = colours.raised;
    g.fillRect(left, top, width_mm * this.scale, height_mm * this.scale);
    for (let x = -100 * Math.floor(width_mm / 200); x <= width_mm / 2; x += 100) {
      line(g, [[this.x(x), top], [this.x(x), this.y(-height_mm / 2)]], colours.grid);
    }
    for (let y = -100 * Math.floor(height_mm / 200); y <= height_mm / 2; y += 100) {
      line(g, [[left, this.y(y)], [this.x(width_mm / 2), this.y(y)]], colours.grid);
    }
    g.strokeStyle = colours.muted;
    g.lineWidth = 1;
    g.strokeRect(left, top, width_mm * this.scale, height_mm * this.scale);
  }

  drawWalls(g, shown, width_mm, height_mm) {
    const [w, h] = [width_mm / 2, height_mm / 2];
    this.model.hello.walls.forEach((wall, k) => {
      const mm = shown.walls[k];
      if (mm == null) return;
      const limit = wall.axis === 'x' ? w : h;
      if (Math.abs(mm) > limit) return;
      const [from, to] = wall.inside === 'below' ? [-limit, mm] : [mm, limit];
      const [x0, x1, y0, y1] = wall.axis === 'x' ? [from, to, -h, h] : [-w, w, from, to];
      hatch(g, this.x(x0), this.y(y1), (x1 - x0) * this.scale, (y1 - y0) * this.scale);
      const edge = wall.axis === 'x' ? [[mm, -h], [mm, h]] : [[-w, mm], [w, mm]];
      line(g, edge.map(([x, y]) => [this.x(x), this.y(y)]), colours.ink, 2);
    });
  }

  drawTerminals(g, shown, margin) {
    const most = margin - 4;
    this.model.hello.terminals_mm.forEach(([x, y], k) => {
      const share = Math.max(0, shown.terminals[k] ?? 0);
      const at = [this.x(x), this.y(y)];
      disc(g, at, 3 + (most - 3) * Math.sqrt(Math.min(1, share)), colours.measured, 0.35);
      disc(g, at, 2.5, colours.ink);
      const inward = margin + 2;
      const [left, right] = [at[0] < margin + 4, at[0] > 2 * this.middle[0] - margin - 4];
      const [tx, align] = left ? [at[0] + inward, 'left'] : right ? [at[0] - inward, 'right'] : [at[0], 'center'];
      const ty = left || right ? at[1] + 4 : at[1] + (y > 0 ? inward : 8 - inward);
      label(g, `I${k + 1}`, tx, ty, colours.muted, align);
    });
  }

  drawTrails(g, shown) {
    const frames = this.model.within([shown.time_s - TRAIL_S, shown.time_s]);
    g.globalAlpha = 0.4;
    for (const { pad } of shown.pads.filter(Boolean)) {
      const points = frames.filter((frame) => frame.pads[pad]).map((frame) => place(frame.pads[pad]));
      line(g, points.map(([x, y]) => [this.x(x), this.y(y)]), colours.true, 2);
    }
    g.globalAlpha = 1;
  }

  drawPad(g, pad) {
    const { hello } = this.model;
    const chosen = pad.pad === this.model.pad;
    const radius = Math.max(5, (hello.pad_diameter_mm / 2) * this.scale);
    const [px, py] = place(pad);
    const centre = [this.x(px), this.y(py)];
    disc(g, centre, radius, colours.page, 0.85);
    ring(g, centre, radius, hello.truth ? colours.true : colours.measured, chosen ? 3 : 1.5);
    if (pad.finger_x_mm != null) {
      const finger = [this.x(pad.finger_x_mm), this.y(pad.finger_y_mm)];
      line(g, [centre, finger], colours.finger, 1, [3, 3]);
      ring(g, finger, Math.max(3.5, radius * 0.45), colours.finger, 2);
    }
    if (pad.x_mm != null && pad.true_x_mm != null) {
      const [ex, ey] = [10 * (pad.x_mm - pad.true_x_mm), 10 * (pad.y_mm - pad.true_y_mm)];
      line(g, [centre, [this.x(px + ex), this.y(py + ey)]], colours.measured, 2);
    }
    if (pad.x_mm != null) disc(g, [this.x(pad.x_mm), this.y(pad.y_mm)], 3, colours.measured);
    const force = forceVector(pad);
    if (force) arrow(g, centre, force.map((n) => n * PIXELS_PER_N), colours.force);
  }

  drawLabel(g, pad, width) {
    const chosen = pad.pad === this.model.pad;
    const radius = Math.max(5, (this.model.hello.pad_diameter_mm / 2) * this.scale);
    const [x, y] = place(pad);
    const toLeft = this.x(x) > width - 170;
    const side = toLeft ? this.x(x) - radius - 10 : this.x(x) + radius + 10;
    const align = toLeft ? 'right' : 'left';
    const name = `${pad.pad + 1} ${this.model.hello.pads[pad.pad].name}`;
    const weight = chosen ? '600 ' : '';
    const font = `${weight}12px system-ui, sans-serif`;
    const compact = width < 500;
    if (!compact) label(g, name, side, this.y(y) - 4, colours.ink, align, font);
    const text = `${fixed(pad.force_n, 2)} N · ${this.model.state(pad)}`;
    label(g, compact ? `${pad.pad + 1}  ${text}` : text, side, this.y(y) + (compact ? 4 : 11),
      compact ? colours.ink : colours.muted, align, compact ? font : undefined);
  }
}

/** Haptic force on a pad as a vector on the screen (y down), in newtons: against the hand. Null without a direction. */
export function forceVector(pad) {
  const newtons = pad.true_force_n ?? pad.force_n;
  if (newtons == null || !(pad.hand_n > 0.005)) return null;
  return [(-pad.hand_x_n / pad.hand_n) * newtons, (pad.hand_y_n / pad.hand_n) * newtons];
}
