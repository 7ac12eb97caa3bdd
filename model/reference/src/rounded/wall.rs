// SPDX-License-Identifier: MIT OR Apache-2.0
//! A virtual wall: the equations of docs/physics.md §6, each kept number rounded.
//!
//! ```text
//! x̄ = [(3x̄ + x)/4],  v = [(7v + Δx)/8],  u_in, u_out = [(3u + new)/4] or [(63u + new)/64]
//! y = [(u − off)/σ],  b/σ·bf = […],  S, E in [0, 64)
//! ȳ = [(3ȳ + y)/4],  a = [(3a + x̄, ȳ)/4] where it is farther than the play,  gain = 0 where its direction is along the surface
//! F = [min([k_w·|x|], F_max)·gain]
//! ū = [(7ū + u)/8],  r = [(3r + ū)/4],  d = [(d + x̄)/2] or [(15d + x̄ − slip)/16]     (rule B)
//! ```

use super::{Exact, round, round_quotient, round_real};
use hapticore_contract::format::Format;
use hapticore_contract::profile::{Profile, Release, Wall as Rule};

const U: Format = Format::signed(13, 13);
const LEARNT: Format = Format::signed(20, 19);
const CHANGE: Format = Format::unsigned(19, 19);
const FRICTION: Format = Format::unsigned(21, 20);
const Y: Format = Format::signed(11, 8);
const EVIDENCE: Format = Format::unsigned(14, 8);
const GAIN: Format = Format::unsigned(11, 10);
const SLOW: Format = Format::signed(16, 16);

/// The inputs of a wall in a frame of a pad.
#[derive(Debug, Clone, Copy)]
pub struct WallFrame {
    /// The pad starts anew.
    pub restart: bool,
    /// Capacitances of the left and of the right part.
    pub parts: [Exact; 2],
    /// Position from the wall.
    pub x: Exact,
    /// Position along the wall's surface.
    pub along: Exact,
    /// The user leaves the pad's other wall.
    pub other_free: bool,
    /// There was no haptic voltage.
    pub at_zero: bool,
    /// Stiffness.
    pub stiffness: Exact,
    /// Largest force.
    pub most: Exact,
    /// Factory offset of the direction.
    pub factory: Exact,
}

/// What it gives.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WallResult {
    /// Force target.
    pub target: Exact,
    /// The user leaves.
    pub free: bool,
    /// There was current.
    pub valid: bool,
}

/// One side of what is learnt.
#[derive(Debug, Clone, Copy)]
struct Side(Exact, u32);

/// The wall of one pad.
#[derive(Debug, Clone)]
pub struct Wall {
    rule: Rule,
    position: Format,
    force: Format,
    kept: Option<Kept>,
}

#[derive(Debug, Clone)]
struct Kept {
    last: Exact,
    filtered: Exact,
    speed: Exact,
    /// Filtered place along the surface.
    along: Exact,
    /// The point that follows the filtered place, across the surface and along it.
    anchor: [Exact; 2],
    other_free: bool,
    turned: bool,
    u: Exact,
    change: Exact,
    zero: u64,
    sides: [Side; 2],
    free: bool,
    evidence: Exact,
    extreme: Exact,
    since: u64,
    gain: Exact,
    slow: Exact,
    push: Push,
    latched: bool,
}

/// A push since its last slip inwards.
#[derive(Debug, Clone, Copy)]
struct Push {
    slow: Exact,
    deep: Exact,
    frames: u64,
}

fn times(x: Exact, by: i128) -> Exact {
    x * Exact::new(by, 0)
}

fn mean(old: Exact, new: Exact, shift: u32, to: Format) -> Exact {
    round((times(old, (1 << shift) - 1) + new).scaled(-(shift as i8)), to).value
}

/// The standard deviation of u is 2 to the minus this.
fn deviation(k: &Kept) -> i8 {
    if k.change > round_real(0.0055 / 0.886, CHANGE) { 7 } else { 8 }
}

fn lesser(a: Exact, b: Exact) -> Exact {
    if b < a { b } else { a }
}

impl Wall {
    /// A pad of a profile that has not had a frame.
    pub fn new(profile: &Profile) -> Self {
        let (position, force) = (profile.formats.position, profile.formats.force);
        Wall { rule: profile.wall.unwrap_or_default(), position, force, kept: None }
    }

    fn filtered(&self) -> Format {
        Format::signed(self.position.width + 4, self.position.frac + 4)
    }

    fn speed(&self) -> Format {
        Format::signed(self.position.width + 7, self.position.frac + 6)
    }

    fn millimetres(&self, um: u64, to: Format) -> Exact {
        round_real(1e-3 * um as f64, to)
    }

    /// A frame.
    pub fn frame(&mut self, i: &WallFrame) -> WallResult {
        let fresh = || Kept {
            last: i.x,
            filtered: i.x,
            speed: Exact::ZERO,
            along: i.along,
            anchor: [i.x, i.along],
            other_free: false,
            turned: false,
            u: i.factory,
            change: Exact::ZERO,
            zero: 0,
            sides: [Side(i.factory, 0); 2],
            free: false,
            evidence: Exact::ZERO,
            extreme: i.x,
            since: self.rule.dwell_frames,
            gain: Exact::ZERO,
            slow: i.factory,
            push: Push { slow: i.factory, deep: i.x, frames: 0 },
            latched: false,
        };
        let known = self.kept.take().filter(|_| !i.restart);
        let is_new = known.is_none();
        let mut k = known.unwrap_or_else(fresh);
        let [left, right] = i.parts;
        let sum = left + right;
        k.speed = mean(k.speed, i.x - k.last, 3, self.speed());
        k.filtered = mean(k.filtered, i.x, 2, self.filtered());
        k.last = i.x;
        k.along = mean(k.along, i.along, 2, self.filtered());
        let slides = self.slides(&mut k, i.other_free);
        k.zero = if i.at_zero { (k.zero + 1).min(self.rule.zero_frames) } else { 0 };
        let read = self.read(sum, right - left);
        if let Some(u) = read {
            self.learn(&mut k, u);
        }
        k.slow = mean(k.slow, k.u, 3, SLOW);
        let y = self.weigh(&mut k, i, read.is_some());
        self.test(&mut k, y, i.x);
        if self.rule.rule == Release::Sequential && slides {
            k.gain = Exact::ZERO;
        }
        let target = self.target(&k, i, sum);
        k.latched = target > round_real(1e-3 * self.rule.latch_mn as f64, self.force);
        let free = k.free;
        self.kept = Some(k).filter(|_| !is_new || sum != Exact::ZERO);
        WallResult { target, free, valid: sum != Exact::ZERO }
    }

    /// Whether the pad slides along the surface; the anchor follows.
    fn slides(&self, k: &mut Kept, other_free: bool) -> bool {
        let place = [k.filtered, k.along];
        let play = |share: f64| {
            let to = Format::signed(self.position.width + 5, self.position.frac + 4);
            round_real(share * 1e-3 * self.rule.play_um as f64, to)
        };
        let was_free = std::mem::replace(&mut k.other_free, other_free);
        if other_free && !was_free {
            k.turned = true;
            k.anchor = [place[0], round(place[1] - play(1.0), self.filtered()).value];
            return true;
        }
        let [inwards, along] = [k.anchor[0] - place[0], (place[1] - k.anchor[1]).magnitude()];
        if inwards.magnitude() > play(1.0) || along > play(1.0) {
            k.anchor = [0, 1].map(|n| mean(k.anchor[n], place[n], 2, self.filtered()));
        }
        k.turned |= other_free;
        let along = if k.turned { along.scaled(2) } else { along };
        k.turned &= along > inwards.scaled(1) && along > play(0.5);
        along > inwards.scaled(1) && along > play(0.5)
    }

    /// u, where it is to be trusted.
    fn read(&self, sum: Exact, difference: Exact) -> Option<Exact> {
        let of = round_quotient(difference.magnitude(), sum, Format::unsigned(14, 13)).value;
        if sum == Exact::ZERO || of >= Exact::new(1, -1) {
            return None;
        }
        Some(round(if difference < Exact::ZERO { -of } else { of }, U).value)
    }

    fn learn(&self, k: &mut Kept, u: Exact) {
        let moved = (u - k.u).magnitude();
        k.u = u;
        let clear = self.millimetres(self.rule.clear_um, self.filtered());
        if k.filtered <= clear || k.zero < self.rule.zero_frames {
            return;
        }
        k.change = mean(k.change, moved, 6, CHANGE);
        let fast = self.millimetres(self.rule.learn_um, self.speed());
        let side = if k.speed < -fast {
            &mut k.sides[0]
        } else if k.speed > fast {
            &mut k.sides[1]
        } else {
            return;
        };
        let shift = if side.1 < 16 { 2 } else { 6 };
        *side = Side(mean(side.0, u, shift, LEARNT), (side.1 + 1).min(16));
    }

    /// y, and the bias of friction, in standard deviations; time goes on.
    fn weigh(&self, k: &mut Kept, i: &WallFrame, reads: bool) -> [Exact; 2] {
        let first = round_real(0.006, FRICTION);
        let least = round_real(0.0015, FRICTION);
        let [into, out] = k.sides;
        let (offset, friction) = match (into.1 == 16, out.1 == 16) {
            (true, true) => {
                let half = (out.0 - into.0).scaled(-1);
                ((into.0 + out.0).scaled(-1), if half < least { least } else { half })
            }
            (true, false) => (into.0 + first, first),
            (false, true) => (out.0 - first, first),
            (false, false) => (i.factory, first),
        };
        let by = deviation(k);
        let y = if reads { round((k.u - offset).scaled(by), Y).value } else { Exact::ZERO };
        let sixteenths = if k.free { self.rule.delay_16 } else { self.rule.advance_16 };
        let bias = times(friction, sixteenths.into()).scaled(by - 4);
        if !self.fades() {
            k.gain = lesser(k.gain + self.gain_step(), Exact::new(1, 0));
        }
        k.since = (k.since + 1).min(self.rule.dwell_frames.max(1));
        [y, round(bias, EVIDENCE).value]
    }

    fn test(&self, k: &mut Kept, [y, bias]: [Exact; 2], x: Exact) {
        let half = Exact::new(1, -1);
        let fast = self.millimetres(self.rule.fast_um, self.speed());
        let play = self.millimetres(self.rule.play_um, self.filtered());
        let [h1, h2] = [self.rule.release, self.rule.engage].map(|h| Exact::new(h.into(), 0));
        let back;
        let decided = if k.free {
            k.extreme = if k.filtered > k.extreme { k.filtered } else { k.extreme };
            k.evidence = round(k.evidence - y - half - bias, EVIDENCE).value;
            back = k.extreme - k.filtered;
            k.evidence > h2 && k.speed <= fast
        } else {
            k.extreme = lesser(k.extreme, k.filtered);
            let y = if self.fades() && k.latched { lesser(y, Exact::ZERO) } else { y };
            k.evidence = round(k.evidence + y + bias - half, EVIDENCE).value;
            if k.speed < -fast {
                k.evidence = lesser(k.evidence, h1);
            }
            back = k.filtered - k.extreme;
            k.evidence > h1
        };
        let leaves = (decided || back > play) && k.since >= self.rule.dwell_frames;
        let outside = x >= Exact::ZERO;
        let free = match self.rule.rule {
            Release::Never => Some(false),
            Release::Direct => Some(!outside && y > Exact::ZERO),
            Release::Sequential => None,
        };
        if let Some(free) = free {
            (k.free, k.gain) = (free, Exact::new(1, 0));
            return;
        }
        if outside || leaves {
            (k.evidence, k.extreme) = (Exact::ZERO, k.filtered);
        }
        if outside || leaves {
            k.push = Push { slow: k.slow, deep: k.filtered, frames: 0 };
        } else if self.fades() && !k.free {
            self.press(k);
        }
        if outside {
            (k.free, k.gain) = (false, Exact::new(1, 0));
            k.since = if self.fades() { k.since } else { self.rule.dwell_frames };
        } else if leaves {
            k.gain = if k.free { Exact::ZERO } else { k.gain };
            (k.free, k.since) = (!k.free, 0);
        }
    }

    fn fades(&self) -> bool {
        self.rule.quiet_frames > 0 && self.rule.rule == Release::Sequential
    }

    fn gain_step(&self) -> Exact {
        round_real(1.0 / self.rule.ramp_frames as f64, GAIN)
    }

    /// A push goes on: its force comes back where it slips inwards, and may fall where it does not.
    fn press(&self, k: &mut Kept) {
        let step = self.gain_step();
        let slip = self.millimetres(self.rule.slip_um, self.filtered());
        let push = k.push;
        let is_weaker = k.slow - push.slow > Exact::new(1, 0).scaled(-deviation(k));
        let gain = if push.deep - k.filtered > slip {
            let deep = round((push.deep + k.filtered).scaled(-1), self.filtered()).value;
            k.push = Push { slow: k.slow, deep, frames: 0 };
            k.gain + times(step, 4)
        } else {
            let behind = k.filtered - slip;
            k.push = Push {
                slow: if k.slow < push.slow { mean(push.slow, k.slow, 2, SLOW) } else { push.slow },
                deep: match behind > push.deep {
                    true => mean(push.deep, behind, 4, self.filtered()),
                    false => push.deep,
                },
                frames: push.frames + 1,
            };
            let falls = is_weaker && k.push.frames > self.rule.quiet_frames;
            if falls { k.gain - step } else { k.gain + step }
        };
        let gain = lesser(gain, Exact::new(1, 0));
        k.gain = if gain < Exact::ZERO { Exact::ZERO } else { gain };
    }

    fn target(&self, k: &Kept, i: &WallFrame, sum: Exact) -> Exact {
        if k.free || sum == Exact::ZERO || i.x >= Exact::ZERO {
            return Exact::ZERO;
        }
        let force = round(i.x.magnitude() * i.stiffness, self.force).value;
        round(lesser(force, i.most) * k.gain, self.force).value
    }
}
