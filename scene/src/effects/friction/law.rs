// SPDX-License-Identifier: MIT OR Apache-2.0
//! Laws of friction in the plane, and one step of a pad under them.
//!
//!   stiction   sticks below f_s = `stiction`·f_c, slides at f_c.
//!   Dahl       ż = v − σ₀|v|z/f_c,          F = σ₀z
//!   LuGre      ż = v − σ₀|v|z/g(v),         F = σ₀z + σ₁ż,   g = f_c + (f_s − f_c)·e^(−(v/v_s)²)
//!
//! with f_c = μ(N + F_e). All take the pad's velocity v implicitly, so that any step is stable: A·v
//! = b − F(v), with A = m/h + c + kh and b what drives the pad. The bristles' z⁺ = (z + hv)/(1 +
//! hσ₀|v|/g) is linear in v once |v| is known, so that one number is sought. Source:
//! docs/physics.md §4; Canudas de Wit et al., 1995.

pub(super) type Vector = [f64; 2];

/// A law of friction.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Law {
    Stiction,
    Dahl,
    LuGre,
}

/// The numbers of the laws.
#[derive(Clone, Copy, Debug)]
pub(super) struct Surface {
    /// Ratio f_s/f_c of static to sliding friction.
    pub stiction: f64,
    /// Stribeck velocity v_s, m/s.
    pub stribeck_m_s: f64,
    /// Stiffness σ₀ of the bristles, N/m.
    pub bristle_n_per_m: f64,
    /// Damping σ₁ of the bristles, N·s/m.
    pub bristle_n_s_per_m: f64,
}

/// A pad's motion.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Motion {
    pub velocity_m_s: Vector,
    /// z of the bristles, m.
    pub bristle_m: Vector,
    /// The friction against the motion, N.
    pub friction_n: Vector,
}

/// What drives a pad through a step: A·v = b − F(v).
#[derive(Clone, Copy, Debug)]
pub(super) struct Drive {
    pub step_s: f64,
    /// A, N·s/m; infinite where the motion is prescribed.
    pub mobility_n_s_per_m: f64,
    /// b, N; where the motion is prescribed, the velocity.
    pub push_n: Vector,
    /// Sliding friction f_c, N.
    pub sliding_n: f64,
}

pub(super) fn length([x, y]: Vector) -> f64 {
    x.hypot(y)
}

pub(super) fn add(a: Vector, scale: f64, b: Vector) -> Vector {
    [a[0] + scale * b[0], a[1] + scale * b[1]]
}

fn scaled(scale: f64, a: Vector) -> Vector {
    add([0.0; 2], scale, a)
}

impl Law {
    /// The pad a step later.
    pub fn step(self, surface: &Surface, from: Motion, drive: Drive) -> Motion {
        match self {
            Law::Stiction => stiction(surface, from, drive),
            Law::Dahl => bristles(
                &Surface { stiction: 1.0, bristle_n_s_per_m: 0.0, ..*surface },
                from,
                drive,
            ),
            Law::LuGre => bristles(surface, from, drive),
        }
    }

    /// The friction of a pad whose motion is prescribed.
    pub fn follow(
        self,
        surface: &Surface,
        from: Motion,
        velocity_m_s: Vector,
        step_s: f64,
        sliding_n: f64,
    ) -> Motion {
        let speed = length(velocity_m_s);
        let surface = match self {
            Law::Dahl => Surface { stiction: 1.0, bristle_n_s_per_m: 0.0, ..*surface },
            _ => *surface,
        };
        if self == Law::Stiction {
            let friction_n =
                if speed > 0.0 { scaled(sliding_n / speed, velocity_m_s) } else { [0.0; 2] };
            return Motion { velocity_m_s, friction_n, ..from };
        }
        let keep = surface.keep(step_s, speed, sliding_n);
        surface.bristled(from, velocity_m_s, keep, step_s)
    }
}

/// Sticks where the push does not exceed what holds it; slides at f_c otherwise.
fn stiction(surface: &Surface, from: Motion, drive: Drive) -> Motion {
    let push = length(drive.push_n);
    let stuck = length(from.velocity_m_s) == 0.0;
    let holds_n = drive.sliding_n * if stuck { surface.stiction } else { 1.0 };
    if push <= holds_n {
        return Motion { velocity_m_s: [0.0; 2], friction_n: drive.push_n, ..from };
    }
    let friction_n = scaled(drive.sliding_n / push, drive.push_n);
    let velocity_m_s = scaled(1.0 / drive.mobility_n_s_per_m, add(drive.push_n, -1.0, friction_n));
    Motion { velocity_m_s, friction_n, ..from }
}

fn bristles(surface: &Surface, from: Motion, drive: Drive) -> Motion {
    let stiffness = surface.bristle_n_per_m + surface.bristle_n_s_per_m / drive.step_s;
    let velocity = |speed: f64| {
        let keep = surface.keep(drive.step_s, speed, drive.sliding_n);
        let bristle = stiffness * keep - surface.bristle_n_s_per_m / drive.step_s;
        let left = add(drive.push_n, -bristle, from.bristle_m);
        scaled(1.0 / (drive.mobility_n_s_per_m + stiffness * keep * drive.step_s), left)
    };
    let most =
        (length(drive.push_n) + stiffness * length(from.bristle_m)) / drive.mobility_n_s_per_m;
    let speed = agreeing(most, |speed| length(velocity(speed)));
    let keep = surface.keep(drive.step_s, speed, drive.sliding_n);
    surface.bristled(from, velocity(speed), keep, drive.step_s)
}

impl Surface {
    /// What a step leaves of z + hv: 1/(1 + hσ₀|v|/g).
    fn keep(&self, step_s: f64, speed: f64, sliding_n: f64) -> f64 {
        let stribeck = (-(speed / self.stribeck_m_s).powi(2)).exp();
        let level_n = sliding_n * (1.0 + (self.stiction - 1.0) * stribeck);
        if level_n > 0.0 {
            level_n / (level_n + step_s * self.bristle_n_per_m * speed)
        } else {
            0.0
        }
    }

    fn bristled(&self, from: Motion, velocity_m_s: Vector, keep: f64, step_s: f64) -> Motion {
        let bristle_m = scaled(keep, add(from.bristle_m, step_s, velocity_m_s));
        let rate = scaled(1.0 / step_s, add(bristle_m, -1.0, from.bristle_m));
        let friction_n = add(scaled(self.bristle_n_per_m, bristle_m), self.bristle_n_s_per_m, rate);
        Motion { velocity_m_s, bristle_m, friction_n }
    }
}

/// The speed s in 0 ..= `most` at which f(s) = s, where f(0) ≥ 0 and f(most) ≤ most: regula falsi
/// (Illinois), which keeps a bracket.
fn agreeing(most: f64, f: impl Fn(f64) -> f64) -> f64 {
    let (mut low, mut high) = ((0.0, f(0.0)), (most, f(most) - most));
    if low.1 == 0.0 || high.1 >= 0.0 {
        return if low.1 == 0.0 { 0.0 } else { most };
    }
    let mut at = 0.0;
    for _ in 0..200 {
        at = (low.0 * high.1 - high.0 * low.1) / (high.1 - low.1);
        let over = f(at) - at;
        if over.abs() <= 1e-12 * at.abs() || high.0 - low.0 <= 1e-15 * high.0 {
            break;
        }
        if over > 0.0 {
            low = (at, over);
            high.1 *= 0.5;
        } else {
            high = (at, over);
            low.1 *= 0.5;
        }
    }
    at
}
