// SPDX-License-Identifier: MIT OR Apache-2.0
// What the page knows: the source's description, the frames of the last seconds, and which of them is shown.

/** Longest span of the strips, in seconds of device time. */
export const HISTORY_S = 10;
/** Frames closer than this are kept as one, so that slow motion does not fill the memory. */
const APART_S = 0.002;
/** Without frames for this long, the values shown are called old. */
export const STALE_MS = 1000;
const EVENTS = 100;

/** Magnitude of the vector `(x, y)`, or null where a component is unknown. */
export const length = (x, y) => (x == null || y == null ? null : Math.hypot(x, y));

export class Model {
  constructor() {
    Object.assign(this, { hello: null, pad: 0, events: [], status: {}, lost: true, stale: false });
    this.clear();
  }

  clear() {
    Object.assign(this, { frames: [], latest: null, held: null, range: null, cursor_s: null });
  }

  acceptHello(hello) {
    this.clear();
    Object.assign(this, { hello, events: [], status: {}, stale: false });
    this.pad = Math.min(this.pad, hello.pads.length - 1);
  }

  /** Keeps a message of type `frames`; its columns become one object per pad. */
  acceptFrames(message) {
    const names = Object.keys(message.pads);
    const count = message.pads.pad.length;
    const pads = new Array(this.hello.pads.length).fill(null);
    for (let k = 0; k < count; k++) {
      const pad = {};
      for (const name of names) pad[name] = message.pads[name][k];
      pad.error_mm = length(pad.x_mm - pad.true_x_mm, pad.y_mm - pad.true_y_mm);
      if (pad.true_x_mm == null || pad.x_mm == null) pad.error_mm = null;
      pad.hand_n = length(pad.hand_x_n, pad.hand_y_n);
      pads[pad.pad] = pad;
    }
    const { slot, time_s, terminals = [], walls = [] } = message;
    if (this.latest && time_s < this.latest.time_s) this.clear();
    this.latest = { slot, time_s, terminals, walls, pads };
    this.keep(this.latest);
  }

  keep(frame) {
    const frames = this.frames;
    if (frames.length > 1 && frame.time_s - frames.at(-2).time_s < APART_S) frames.pop();
    frames.push(frame);
    // While the picture is held, its frames stay; the excess goes in one piece, since `splice` moves the rest.
    const first = frame.time_s - HISTORY_S;
    if (!this.frozen && frames[0].time_s < first - 1) {
      frames.splice(0, frames.findIndex((kept) => kept.time_s >= first));
    }
    if (this.frozen && frames.length > 20_000) this.follow();
  }

  get frozen() {
    return this.held !== null;
  }

  /** The frame that the page shows: the newest one, or the one at which the picture is held. */
  get shown() {
    return this.held ?? this.latest;
  }

  /** Times at the ends of the strips. */
  span(seconds) {
    if (this.range) return this.range;
    const end = (this.held_end_s ?? this.latest?.time_s) || 0;
    return [end - seconds, end];
  }

  freeze(time_s = this.latest?.time_s) {
    if (!this.frames.length) return;
    if (!this.frozen) this.held_end_s = this.latest.time_s;
    this.held = this.at(time_s);
  }

  follow() {
    Object.assign(this, { held: null, held_end_s: null, range: null });
  }

  /** The kept frame that is nearest to a time. */
  at(time_s) {
    let [low, high] = [0, this.frames.length - 1];
    while (low < high) {
      const middle = (low + high) >> 1;
      if (this.frames[middle].time_s < time_s) low = middle + 1;
      else high = middle;
    }
    const before = this.frames[Math.max(0, low - 1)];
    const here = this.frames[low];
    return time_s - before.time_s < here.time_s - time_s ? before : here;
  }

  /** Kept frames within a range of times, with one frame more on each side. */
  within([from_s, to_s]) {
    const frames = this.frames;
    let first = frames.findIndex((frame) => frame.time_s >= from_s);
    if (first < 0) return [];
    let last = frames.length;
    while (last > first && frames[last - 1].time_s > to_s) last--;
    return frames.slice(Math.max(0, first - 1), last + 1);
  }

  acceptEvent(event) {
    this.events.unshift(event);
    this.events.length = Math.min(this.events.length, EVENTS);
  }

  /** Where the finger of a pad is in the newest frame: of a pad without a hand, the pad itself. */
  finger(number) {
    const pad = this.latest?.pads[number];
    if (!pad) return null;
    if (pad.finger_x_mm != null) return [pad.finger_x_mm, pad.finger_y_mm];
    return place(pad);
  }

  /** Word of a pad's state, as it must be shown now. */
  state(pad) {
    if (this.lost) return 'lost';
    return this.stale && !this.frozen ? 'late' : pad?.state ?? 'invalid';
  }
}

/** Where a pad is: the true place where the source knows it, else the measured one. */
export function place(pad) {
  return pad.true_x_mm == null ? [pad.x_mm, pad.y_mm] : [pad.true_x_mm, pad.true_y_mm];
}
