// SPDX-License-Identifier: MIT OR Apache-2.0
//! What a hand feels of a wall's rule.
//!
//! | measure | of a trial |
//! | --- | --- |
//! | sticking force | mean of the wall's part of the friction while the hand pulls out of the wall |
//! | slow peak | the largest of it while the hand leaves slowly |
//! | release | from the hand's force turning outwards, in each part in which it leaves, until the wall's force is below 0.05 N or the pad is out |
//! | excess flips | changes of direction within the wall, beyond one in each part in which the hand leaves |
//! | bursts | times at which the direction changes more often than tremor of 10 Hz asks for: more than 4 flips within 200 ms |
//! | vanished | time within the wall in which the hand pushes in by more than 0.05 N and the rule is `Free`, in the parts in which it enters |

use hapticore_reference::wall::Direction;

use super::hand::Phase;
use super::trial::Seen;

/// A force below which the wall has let go, N.
const GONE_N: f64 = 0.05;

/// A burst: more than this number of flips within this time, s, in which tremor of 10 Hz turns four
/// times.
const BURST: (usize, f64) = (4, 0.2);

/// The measures of one trial.
#[derive(Clone, Debug, Default)]
pub struct Measures {
    /// Mean sticking force, N.
    pub sticking_n: f64,
    /// Peak in slow leaving, N.
    pub slow_peak_n: f64,
    /// Times until the wall let go, ms.
    pub release_ms: Vec<f64>,
    /// Flips beyond those that the hand asked for.
    pub excess_flips: f64,
    /// Bursts of flips.
    pub bursts: f64,
    /// Time in which the wall had vanished, ms.
    pub vanished_ms: f64,
    /// Largest haptic force, N.
    pub peak_n: f64,
}

impl Measures {
    /// Of the frames of a trial.
    pub fn of(frames: &[Seen], frame_ms: f64) -> Measures {
        let pulls = |seen: &&Seen| seen.x_mm < 0.0 && seen.hand_n > 0.0;
        let felt: Vec<f64> = frames.iter().filter(pulls).map(|seen| seen.felt_n).collect();
        let slow = frames.iter().filter(pulls).filter(|seen| seen.part.1 == Phase::LeaveSlowly);
        let vanished = |seen: &&Seen| {
            seen.part.1 == Phase::Enter
                && seen.x_mm < 0.0
                && seen.hand_n < -GONE_N
                && seen.direction == Direction::Free
        };
        Measures {
            sticking_n: felt.iter().sum::<f64>() / felt.len().max(1) as f64,
            slow_peak_n: slow.map(|seen| seen.felt_n).fold(0.0, f64::max),
            release_ms: releases_ms(frames),
            excess_flips: (flips_s(frames).len() as f64 - leavings(frames)).max(0.0),
            bursts: bursts(&flips_s(frames)),
            vanished_ms: frame_ms * frames.iter().filter(vanished).count() as f64,
            peak_n: frames.iter().map(|seen| seen.force_n).fold(0.0, f64::max),
        }
    }
}

fn leaves(phase: Phase) -> bool {
    matches!(phase, Phase::LeaveSlowly | Phase::LeaveFast)
}

/// Each part in which the hand leaves, with what follows it.
fn leaving_parts(frames: &[Seen]) -> impl Iterator<Item = &[Seen]> {
    let starts = (1..frames.len())
        .filter(|n| leaves(frames[*n].part.1) && frames[n - 1].part.0 != frames[*n].part.0);
    starts.map(|start| {
        let enters = |seen: &Seen| matches!(seen.part.1, Phase::Enter | Phase::Hover);
        let end = frames[start..].iter().position(enters).map_or(frames.len(), |n| start + n);
        &frames[start..end]
    })
}

/// Parts in which the hand leaves from within the wall.
fn leavings(frames: &[Seen]) -> f64 {
    leaving_parts(frames).filter(|part| part[0].x_mm < 0.0).count() as f64
}

fn releases_ms(frames: &[Seen]) -> Vec<f64> {
    let release = |part: &[Seen]| {
        let turned = part.iter().position(|seen| seen.hand_n > 0.0)?;
        let (turn, rest) = (&part[turned], &part[turned..]);
        if turn.x_mm >= 0.0 || turn.force_n < GONE_N {
            return None;
        }
        let gone = rest.iter().find(|seen| seen.force_n < GONE_N || seen.x_mm >= 0.0);
        Some(1e3 * (gone.or(rest.last())?.time_s - turn.time_s))
    };
    leaving_parts(frames).filter_map(release).collect()
}

/// When the direction changes with the pad within the wall, s.
fn flips_s(frames: &[Seen]) -> Vec<f64> {
    let within = |pair: &&[Seen]| pair[0].x_mm < 0.0 && pair[1].x_mm < 0.0;
    let changes = frames.windows(2).filter(within);
    let flips = changes.filter(|pair| pair[0].direction != pair[1].direction);
    flips.map(|pair| pair[1].time_s).collect()
}

/// Bursts among flips; none of a burst counts for the next.
fn bursts(mut flips_s: &[f64]) -> f64 {
    let ((most, within_s), mut count) = (BURST, 0.0);
    while let [first, rest @ ..] = flips_s {
        let is_burst = flips_s.get(most).is_some_and(|last| last - first <= within_s);
        flips_s = if is_burst { &flips_s[most + 1..] } else { rest };
        count += f64::from(u8::from(is_burst));
    }
    count
}

/// The measures over many hands: a row of the table.
#[derive(Clone, Debug, Default)]
pub struct Row {
    /// Mean of the hands' mean sticking forces, N.
    pub sticking_n: f64,
    /// The worst hand's, N.
    pub worst_n: f64,
    /// Mean of the slow peaks, N.
    pub slow_peak_n: f64,
    /// Median of all releases, ms.
    pub release_ms: f64,
    /// 95 % of all releases are as short, ms.
    pub release_p95_ms: f64,
    /// Mean of the trials' excess flips.
    pub excess_flips: f64,
    /// Bursts of flips of all trials together.
    pub bursts: f64,
    /// Mean time per trial in which the wall had vanished on entry, ms.
    pub vanished_ms: f64,
    /// Largest haptic force, N.
    pub peak_n: f64,
}

impl Row {
    /// Of many trials.
    pub fn of(trials: &[Measures]) -> Row {
        let mean = |of: fn(&Measures) -> f64| {
            trials.iter().map(of).sum::<f64>() / trials.len().max(1) as f64
        };
        let most = |of: fn(&Measures) -> f64| trials.iter().map(of).fold(0.0, f64::max);
        let mut releases: Vec<f64> =
            trials.iter().flat_map(|trial| trial.release_ms.iter().copied()).collect();
        releases.sort_by(f64::total_cmp);
        let quantile = |share: f64| {
            let at = (share * releases.len() as f64).floor() as usize;
            releases.get(at.min(releases.len().saturating_sub(1))).copied().unwrap_or(0.0)
        };
        Row {
            sticking_n: mean(|trial| trial.sticking_n),
            worst_n: most(|trial| trial.sticking_n),
            slow_peak_n: mean(|trial| trial.slow_peak_n),
            release_ms: quantile(0.5),
            release_p95_ms: quantile(0.95),
            excess_flips: mean(|trial| trial.excess_flips),
            bursts: trials.iter().map(|trial| trial.bursts).sum(),
            vanished_ms: mean(|trial| trial.vanished_ms),
            peak_n: most(|trial| trial.peak_n),
        }
    }

    /// A row of the table in Markdown, without its name.
    pub fn text(&self) -> String {
        format!(
            "{:.3} ({:.3}) | {:.3} | {:.0}; {:.0} | {:.1} | {:.1} | {:.2} | {:.0}",
            self.sticking_n,
            self.worst_n,
            self.slow_peak_n,
            self.release_ms,
            self.release_p95_ms,
            self.excess_flips,
            self.vanished_ms,
            self.peak_n,
            self.bursts
        )
    }
}
