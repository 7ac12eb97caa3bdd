// SPDX-License-Identifier: MIT OR Apache-2.0
// Fingers: pointers and arrow keys lead pads. A pointer leads the finger, which pulls the pad as a hand would.

import { finger } from './model.mjs';

const ARROWS = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] };
/** Steps of the keyboard that follow within this time go on from the place wanted, not from the finger's present one. */
const GOES_ON_MS = 400;

/** Sends where fingers should be, once per picture and pad at most; the source draws a line between two such places. */
export class Leader {
  constructor(model, send) {
    Object.assign(this, { model, send, wanted: new Map(), last: {} });
  }

  lead(pad, mm) {
    const { sheet_mm, pad_diameter_mm, leads } = this.model.hello;
    if (!leads) return; // The hand that leads the pads of a board is a real one.
    const inside = mm.map((value, axis) => {
      const reach = (sheet_mm[axis] - pad_diameter_mm) / 2;
      return Number(Math.min(reach, Math.max(-reach, value)).toFixed(3));
    });
    if (!this.wanted.size) requestAnimationFrame(() => this.flush());
    this.wanted.set(pad, inside);
    this.last = { pad, mm: inside, at_ms: performance.now() };
  }

  flush() {
    for (const [pad, mm] of this.wanted) this.send({ type: 'lead', pad, mm });
    this.wanted.clear();
  }

  /** Where the finger of a pad is now; null where the pad has had no frame yet. */
  finger(number) {
    const pad = this.model.latest?.pads[number];
    const mm = pad ? finger(pad) : [null];
    return mm.every(Number.isFinite) ? mm : null;
  }

  step(pad, by) {
    const goesOn = this.last.pad === pad && performance.now() - this.last.at_ms < GOES_ON_MS;
    const from = goesOn ? this.last.mm : this.finger(pad);
    if (from) this.lead(pad, from.map((mm, axis) => mm + by[axis]));
  }
}

/** Lets pointers on a view lead pads, each pointer its own. `onTake(pad)` runs as a drag begins. */
export function leadByPointer(view, leader, onTake) {
  const { canvas } = view;
  const drags = new Map();
  canvas.addEventListener('pointerdown', (event) => {
    const pad = event.button ? null : view.hit(event);
    const from = pad == null ? null : leader.finger(pad);
    if (!from || [...drags.values()].some((drag) => drag.pad === pad)) return;
    drags.set(event.pointerId, { pad, off: view.toMm(event).map((mm, axis) => from[axis] - mm) });
    canvas.setPointerCapture(event.pointerId);
    onTake(pad);
  });
  canvas.addEventListener('pointermove', (event) => {
    const drag = drags.get(event.pointerId);
    canvas.style.cursor = drag ? 'grabbing' : view.hit(event) == null ? 'default' : 'grab';
    if (drag) leader.lead(drag.pad, view.toMm(event).map((mm, axis) => mm + drag.off[axis]));
  });
  for (const end of ['pointerup', 'pointercancel']) canvas.addEventListener(end, (event) => drags.delete(event.pointerId));
  // A touch that takes a pad must not scroll the page; one beside all pads may.
  canvas.addEventListener('touchstart', (event) => {
    if ([...event.changedTouches].some((touch) => view.hit(touch) != null)) event.preventDefault();
  }, { passive: false });
}

/** Keys: numbers choose, arrows step, space freezes, a full stop runs one slot, n serves a new puck. */
export function listenToKeys({ model, choose, step, freeze, slot, serve }) {
  addEventListener('keydown', (event) => {
    const control = event.target.closest?.('input, select, button, summary');
    const typing = control && !control.matches('button');
    if (!model.hello || typing || event.ctrlKey || event.metaKey || event.altKey) return;
    const number = Number(event.key) - 1;
    if (ARROWS[event.key]) step(ARROWS[event.key].map((mm) => mm * (event.shiftKey ? 0.1 : 1)));
    else if (event.key === ' ' && !control) freeze();
    else if (event.key === '.') slot();
    else if (event.key === 'n' && model.hello.arena) serve();
    else if (event.key.trim() && number >= 0 && number < model.hello.pads.length) choose(number);
    else return;
    event.preventDefault();
  });
}
