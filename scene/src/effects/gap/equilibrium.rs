// SPDX-License-Identifier: MIT OR Apache-2.0
//! The gap of a patch in equilibrium, once its rubber has relaxed: the largest at which no pressure
//! is left (the branch that starts open), or the one found from where it is.
//!
//! Without contact the balance is a cubic in h = g + d, so its largest root, and the fold where it
//! vanishes, have a closed form: V_PI = √(8κh₀³/27ε₀). The contact only adds pressure, so the root
//! with it lies above the cubic's, where the balance falls steadily: bisection cannot miss it. Past
//! the fold the contact alone holds the patch. Source: docs/physics.md §3.

use super::law::{Drive, Law, Sloped, root};

/// The gap in equilibrium; the insulators themselves do not yield, so it is never negative.
pub(super) fn equilibrium(law: &Law, rest_m: f64, drive: Drive) -> f64 {
    let balance = |gap: f64| law.relaxed(gap, rest_m, drive);
    let open_height = rest_m + law.insulator_m;
    let unpulled = open_height - drive.pressure_pa / law.spring_pa_per_m;
    let top = rest_m + law.contact_pa / law.spring_pa_per_m;
    let fold = (unpulled * 2.0 / 3.0 - law.insulator_m).max(0.0);
    match open_root(unpulled, drive.pull_n / law.spring_pa_per_m) {
        Some(height) => {
            let open = (height - law.insulator_m).max(0.0);
            root(open, top, open, balance)
        }
        None if balance(fold).value >= 0.0 => root(fold, top, fold, balance),
        None => root(0.0, fold, 0.0, balance),
    }
}

/// The gap in equilibrium that a patch let go at `from_m` comes to: a patch that has pulled in stays
/// closed down to a lower voltage than it closed at.
pub(super) fn equilibrium_from(law: &Law, rest_m: f64, drive: Drive, from_m: f64) -> f64 {
    let open_m = equilibrium(law, rest_m, drive);
    let balance = |gap: f64| law.relaxed(gap, rest_m, drive);
    if from_m >= open_m {
        return open_m;
    }
    match valley(law, drive, open_m).filter(|valley_m| balance(*valley_m).value < 0.0) {
        Some(valley_m) if from_m <= valley_m || balance(from_m).value < 0.0 => {
            root(0.0, valley_m, 0.0, balance)
        }
        _ => open_m,
    }
}

/// Where the balance is least between the contact and the open gap; none where it falls all the
/// way. Its slope rises while the contact fades, and falls with the attraction's.
fn valley(law: &Law, drive: Drive, open_m: f64) -> Option<f64> {
    let slope = |gap: f64| {
        let height = gap + law.insulator_m;
        let stiffness = law.contact_pa / law.contact_decay_m * (-gap / law.contact_decay_m).exp();
        let value = 2.0 * drive.pull_n / height.powi(3) - law.spring_pa_per_m - stiffness;
        let bend = stiffness / law.contact_decay_m - 6.0 * drive.pull_n / height.powi(4);
        Sloped { value, slope: bend }
    };
    let steepest_m = root(0.0, open_m, 0.0, |gap| Sloped { value: slope(gap).slope, slope: 0.0 });
    let falling = |gap: f64| {
        let Sloped { value, slope } = slope(gap);
        Sloped { value: -value, slope: -slope }
    };
    (slope(steepest_m).value > 0.0).then(|| root(0.0, steepest_m, 0.0, falling))
}

/// Largest root of h²(H − h) = a, by the trigonometric form; none past the fold a = 4H³/27.
fn open_root(unpulled: f64, a: f64) -> Option<f64> {
    let cosine = 1.0 - 13.5 * a / unpulled.powi(3);
    let open = unpulled > 0.0 && cosine >= -1.0;
    open.then(|| unpulled / 3.0 * (1.0 + 2.0 * (cosine.acos() / 3.0).cos()))
}
