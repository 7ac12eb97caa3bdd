// SPDX-License-Identifier: MIT OR Apache-2.0
// Fingers: pointers and arrow keys lead pads. A pointer leads the finger, which pulls the pad as a hand would.

const ARROWS = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] };
/** Key presses that follow within this time continue from the place wanted, not from the finger's measured one. */
const CONTINUES_MS = 400;

/** Sends where fingers should be, once per picture and pad at most: the source draws a line between them. */
export class Leader {
  constructor(model, send) {
    Object.assign(this, { model, send, wanted: new Map(), last: new Map() });
  }

  lead(pad, mm) {
    const { sheet_mm, pad_diameter_mm } = this.model.hello;
    const inside = mm.map((value, axis) => {
      const reach = (sheet_mm[axis] - pad_diameter_mm) / 2;
      return Math.round(1e3 * Math.min(reach, Math.max(-reach, value))) / 1e3;
    });
    if (!this.wanted.size) requestAnimationFrame(() => this.flush());
    this.wanted.set(pad, inside);
    this.last.set(pad, { mm: inside, at_ms: performance.now() });
  }

  flush() {
    for (const [pad, mm] of this.wanted) this.send({ type: 'lead', pad, mm });
    this.wanted.clear();
  }

  /** Moves a finger by a step of the keyboard. */
  step(pad, by) {
    const last = this.last.get(pad);
    const from = last && performance.now() - last.at_ms < CONTINUES_MS ? last.mm : this.model.finger(pad);
    if (from) this.lead(pad, [from[0] + by[0], from[1] + by[1]]);
  }
}

/**
 * Lets pointers on a canvas lead pads, each pointer its own.
 *
 * `take(event)` is the pad's number or null; `toMm(event)` a place whose differences are millimetres; `onTake(pad)`
 * runs when a drag begins.
 */
export function leadByPointer(canvas, leader, { take, toMm, onTake }) {
  const drags = new Map();
  canvas.addEventListener('pointerdown', (event) => {
    const pad = event.button ? null : take(event);
    const finger = pad == null ? null : leader.model.finger(pad);
    if (!finger || [...drags.values()].some((drag) => drag.pad === pad)) return;
    const at = toMm(event);
    drags.set(event.pointerId, { pad, off: [finger[0] - at[0], finger[1] - at[1]] });
    canvas.setPointerCapture(event.pointerId);
    onTake(pad);
  });
  canvas.addEventListener('pointermove', (event) => {
    const drag = drags.get(event.pointerId);
    if (!drag) {
      if (event.pointerType === 'mouse') canvas.style.cursor = take(event) == null ? 'default' : 'grab';
      return;
    }
    canvas.style.cursor = 'grabbing';
    const at = toMm(event);
    leader.lead(drag.pad, [at[0] + drag.off[0], at[1] + drag.off[1]]);
  });
  for (const end of ['pointerup', 'pointercancel', 'lostpointercapture']) {
    canvas.addEventListener(end, (event) => drags.delete(event.pointerId));
  }
  // A finger that takes a pad must not scroll the page; one beside a pad may.
  canvas.addEventListener('touchstart', (event) => {
    if ([...event.changedTouches].some((touch) => take(touch) != null)) event.preventDefault();
  }, { passive: false });
}

/** Keys of the page: `actions` has `choose(pad)`, `freeze()`, `slot()` and the `leader` with the chosen pad. */
export function listenToKeys({ model, leader, choose, freeze, slot, onLead }) {
  addEventListener('keydown', (event) => {
    if (!model.hello || event.ctrlKey || event.metaKey || event.altKey) return;
    const control = event.target.closest?.('input, select, textarea');
    if (control) return;
    const pressed = event.target.closest?.('button, summary');
    const number = '1234'.indexOf(event.key);
    if (ARROWS[event.key] && !event.target.closest?.('ol')) {
      const size = event.shiftKey ? 0.1 : 1;
      onLead();
      leader.step(model.pad, ARROWS[event.key].map((step) => step * size));
    } else if (number >= 0 && number < model.hello.pads.length) choose(number);
    else if (event.key === ' ' && !pressed) freeze();
    else if (event.key === '.') slot();
    else return;
    event.preventDefault();
  });
}
