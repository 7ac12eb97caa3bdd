// SPDX-License-Identifier: MIT OR Apache-2.0
//! The gap of a patch in equilibrium, once its rubber has relaxed: the largest at which no pressure
//! is left (the branch that starts open), or the one found from where it is.
//!
//! Without contact the balance is a cubic in h = g + d, so its largest root, and the fold where it
//! vanishes, have a closed form: V_PI = √(8κh₀³/27ε₀). The contact only adds pressure, so the root
//! with it lies above the cubic's, where the balance falls steadily: bisection cannot miss it. Past
//! that fold the contact may still hold the patch in front of it; where it does not, the patch closes. The
//! balance has one bend, where the contact's decay length is at most half of d: it falls, rises between a
//! valley and a peak, if at all, and falls. Where parts of a patch touch the film none of this holds, and the gap is
//! followed in steps. Source: docs/physics.md §3.

use super::law::{Drive, Law, Patch, Sloped, root};

/// Steps in which a gap is followed, over the contact's decay length, and how many there are at most.
const STEP: f64 = 1.0 / 16.0;
const MOST_STEPS: f64 = 8192.0;

/// The gap in equilibrium; the insulators themselves do not yield, so it is never negative.
pub(super) fn equilibrium(law: &Law, patch: Patch, drive: Drive) -> f64 {
    if law.touches() {
        return followed(law, patch, drive, unpressed(law, patch));
    }
    let balance = |gap: f64| law.relaxed(gap, patch, drive);
    let open_height = patch.rest_m + law.haptic_insulator_m;
    let unpulled = open_height - patch.load_share * drive.pressure_pa / law.spring_pa_per_m;
    let top = patch.rest_m + law.contact_pa / law.spring_pa_per_m;
    if let Some(height) = open_root(unpulled, drive.pull_n / law.spring_pa_per_m) {
        let open = (height - law.haptic_insulator_m).max(0.0);
        return root(open, top, open, balance);
    }
    let fold = (unpulled * 2.0 / 3.0 - law.haptic_insulator_m).max(0.0);
    if balance(fold).value >= 0.0 {
        return root(fold, top, fold, balance);
    }
    match Rise::below(law, drive, fold) {
        Some(rise) if balance(rise.peak_m).value >= 0.0 => {
            root(rise.peak_m, fold, rise.peak_m, balance)
        }
        Some(rise) => root(0.0, rise.valley_m, 0.0, balance),
        None => root(0.0, fold, 0.0, balance),
    }
}

/// The gap in equilibrium that a patch let go at `from_m` comes to: a patch that has pulled in stays
/// closed down to a lower voltage than it closed at.
pub(super) fn equilibrium_from(law: &Law, patch: Patch, drive: Drive, from_m: f64) -> f64 {
    if law.touches() {
        return followed(law, patch, drive, from_m);
    }
    let open_m = equilibrium(law, patch, drive);
    let balance = |gap: f64| law.relaxed(gap, patch, drive).value;
    if from_m >= open_m {
        return open_m;
    }
    match Rise::below(law, drive, open_m) {
        Some(Rise { valley_m, .. })
            if balance(valley_m) < 0.0 && (from_m <= valley_m || balance(from_m) < 0.0) =>
        {
            root(0.0, valley_m, 0.0, |gap| law.relaxed(gap, patch, drive))
        }
        _ => open_m,
    }
}

/// The gap without load and voltage, m: no patch is further open.
fn unpressed(law: &Law, patch: Patch) -> f64 {
    let top = patch.rest_m + law.contact_pa / law.spring_pa_per_m;
    root(0.0, top, patch.rest_m, |gap| law.rubber(gap, patch.rest_m))
}

/// Where a patch comes to that is let go at a gap: pressure moves it step by step until it changes its sign.
fn followed(law: &Law, patch: Patch, drive: Drive, from_m: f64) -> f64 {
    let balance = |gap: f64| law.relaxed(gap, patch, drive);
    let step_m = (STEP * law.contact_decay_m).max(unpressed(law, patch) / MOST_STEPS);
    let mut at_m = from_m;
    if balance(at_m).value > 0.0 {
        while balance(at_m + step_m).value > 0.0 {
            at_m += step_m;
        }
        return root(at_m, at_m + step_m, at_m, balance);
    }
    while at_m > 0.0 {
        let next_m = (at_m - step_m).max(0.0);
        if balance(next_m).value >= 0.0 {
            return root(next_m, at_m, next_m, balance);
        }
        at_m = next_m;
    }
    0.0
}

/// The gaps between which a patch's balance rises: contact has faded, and attraction falls faster than the spring.
struct Rise {
    valley_m: f64,
    peak_m: f64,
}

impl Rise {
    /// The rise below a gap; none where the balance falls all the way.
    fn below(law: &Law, drive: Drive, most_m: f64) -> Option<Rise> {
        let rises = |gap: f64| slope(law, drive, gap).value;
        // The contact's share of the bend by the attraction's is largest here.
        let from_m = (4.0 * law.contact_decay_m - law.haptic_insulator_m).clamp(0.0, most_m);
        let bends = |gap: f64| bend(law, drive, gap);
        let steepest_m = match bends(from_m).value > 0.0 {
            true => root(from_m, most_m, from_m, bends),
            false => 0.0,
        };
        if rises(steepest_m) <= 0.0 {
            return None;
        }
        let falling = |gap: f64| {
            let Sloped { value, slope } = slope(law, drive, gap);
            Sloped { value: -value, slope: -slope }
        };
        let valley_m = root(0.0, steepest_m, 0.0, falling);
        let peak_m = root(steepest_m, most_m, steepest_m, |gap| slope(law, drive, gap));
        Some(Rise { valley_m, peak_m })
    }
}

/// The balance's derivative and its second one: neither the load nor the rest gap is in them.
fn slope(law: &Law, drive: Drive, gap_m: f64) -> Sloped {
    let (height, contact) = (gap_m + law.haptic_insulator_m, contact_pa_per_m(law, gap_m));
    Sloped {
        value: 2.0 * drive.pull_n / height.powi(3) - law.spring_pa_per_m - contact,
        slope: bend(law, drive, gap_m).value,
    }
}

/// The balance's second derivative and its third one.
fn bend(law: &Law, drive: Drive, gap_m: f64) -> Sloped {
    let height = gap_m + law.haptic_insulator_m;
    let contact = contact_pa_per_m(law, gap_m) / law.contact_decay_m;
    Sloped {
        value: contact - 6.0 * drive.pull_n / height.powi(4),
        slope: 24.0 * drive.pull_n / height.powi(5) - contact / law.contact_decay_m,
    }
}

/// Stiffness of the contact.
fn contact_pa_per_m(law: &Law, gap_m: f64) -> f64 {
    law.contact_pa / law.contact_decay_m * (-gap_m / law.contact_decay_m).exp()
}

/// Largest root of h²(H − h) = a, by the trigonometric form; none past the fold a = 4H³/27.
fn open_root(unpulled: f64, a: f64) -> Option<f64> {
    let cosine = 1.0 - 13.5 * a / unpulled.powi(3);
    let open = unpulled > 0.0 && cosine >= -1.0;
    open.then(|| unpulled / 3.0 * (1.0 + 2.0 * (cosine.acos() / 3.0).cos()))
}
