// SPDX-License-Identifier: MIT OR Apache-2.0
// What the page knows: the source's description, the frames of the last seconds, and which of them is shown.

/** Frames that are kept: this long, and not closer than that, in seconds of device time. */
const [HISTORY_S, APART_S] = [10, 0.002];
/** A held picture keeps all frames; at this number it follows the source again. */
const MOST_FRAMES = 20_000;
const MOST_EVENTS = 100;

/** Length of a vector; null where a component is unknown. */
export const length = (x, y) => (Number.isFinite(x) && Number.isFinite(y) ? Math.hypot(x, y) : null);
const minus = (a, b) => (a == null || b == null ? null : a - b);

/** Where a pad is: its true place where the source knows that, else the measured one. */
export const place = (pad) => (pad.true_x_mm == null ? [pad.x_mm, pad.y_mm] : [pad.true_x_mm, pad.true_y_mm]);

/** Where the finger of a pad is; without a hand, the pad itself. */
export const finger = (pad) => (pad.finger_x_mm == null ? place(pad) : [pad.finger_x_mm, pad.finger_y_mm]);

export class Model {
  constructor() {
    Object.assign(this, { hello: null, pad: 0, events: [], status: {}, lost: true, stale: false });
    this.clear();
  }

  clear() {
    Object.assign(this, { frames: [], latest: null, cursor_s: null });
    this.follow();
  }

  acceptHello(hello) {
    this.clear();
    Object.assign(this, { hello, events: [], status: {}, stale: false, pad: Math.min(this.pad, hello.pads.length - 1) });
  }

  /** Keeps a message of type `frames`; its columns become one object per pad. */
  acceptFrames({ slot, time_s, terminals, voltages, walls, game, pads: columns }) {
    const names = Object.keys(columns);
    const pads = this.hello.pads.map(() => null);
    columns.pad.forEach((number, row) => {
      const pad = (pads[number] = Object.fromEntries(names.map((name) => [name, columns[name][row]])));
      pad.error_mm = length(minus(pad.x_mm, pad.true_x_mm), minus(pad.y_mm, pad.true_y_mm));
      pad.hand_n = length(pad.hand_x_n, pad.hand_y_n);
      pad.ahead_mm = length(...finger(pad).map((mm, axis) => minus(mm, place(pad)[axis])));
    });
    if (this.latest && time_s < this.latest.time_s) this.clear();
    this.latest = { slot, time_s, terminals, voltages, walls, game, pads };
    this.keep(this.latest);
  }

  keep(frame) {
    const { frames } = this;
    if (frames.length > 1 && frame.time_s - frames.at(-2).time_s < APART_S) frames.pop();
    frames.push(frame);
    if (this.frozen && frames.length > MOST_FRAMES) this.follow();
    const first_s = frame.time_s - HISTORY_S;
    // The excess goes once a second, since `splice` moves all that stays.
    if (!this.frozen && frames[0].time_s < first_s - 1) frames.splice(0, this.index(first_s));
  }

  get frozen() {
    return this.held !== null;
  }

  /** The frame that the page shows: the newest one, or the one at which the picture is held. */
  get shown() {
    return this.held ?? this.latest;
  }

  /** Ends of the strips' time axis. */
  span(seconds) {
    const end_s = this.heldEnd_s ?? this.latest?.time_s ?? 0;
    return this.range ?? [end_s - seconds, end_s];
  }

  /** Holds the picture at a time, by default now. */
  freeze(time_s = this.latest?.time_s) {
    if (!this.frames.length) return;
    this.heldEnd_s ??= this.latest.time_s;
    this.held = this.at(time_s);
  }

  follow() {
    Object.assign(this, { held: null, heldEnd_s: null, range: null });
  }

  /** Number of the first kept frame that is not before a time. */
  index(time_s) {
    let [low, high] = [0, this.frames.length];
    while (low < high) {
      const middle = (low + high) >> 1;
      if (this.frames[middle].time_s < time_s) low = middle + 1;
      else high = middle;
    }
    return low;
  }

  /** The kept frame at a time, or the next one. */
  at(time_s) {
    return this.frames[Math.min(this.index(time_s), this.frames.length - 1)];
  }

  /** Kept frames within a range of times, and one beyond each of its ends. */
  within([from_s, to_s]) {
    return this.frames.slice(Math.max(0, this.index(from_s) - 1), this.index(to_s) + 1);
  }

  /** Name of a pad as it is shown: with its key, unless the name is but a number. */
  title(number) {
    const name = this.hello.pads[number]?.name ?? '';
    return /^(pad \d+)?$/.test(name) ? `pad ${number + 1}` : `${number + 1} ${name}`;
  }

  acceptEvent(event) {
    this.events = [event, ...this.events.slice(0, MOST_EVENTS - 1)];
  }

  /** Word of a pad's state, as it must be shown now. */
  state(pad) {
    if (this.lost) return 'lost';
    if (this.stale) return 'late';
    return pad?.state ?? 'no frame yet';
  }
}
