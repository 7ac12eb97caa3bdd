// SPDX-License-Identifier: MIT OR Apache-2.0
//! Clocks to ticks: the time axis of a waveform file.
//!
//! The tick is the coarsest decimal unit in which half a clock period is whole, so that 25 MHz
//! counts in nanoseconds (40 a clock). Where there is none (12 MHz), the tick is a picosecond and
//! every time is rounded by itself: never more than half a tick off, however long the run.

use crate::Error;

/// The units tried, as powers of ten of a second.
const EXPONENTS: [i8; 5] = [0, -3, -6, -9, -12];

/// The fastest clock whose half period is still some ticks long.
const MOST_HZ: u64 = 100_000_000_000;

/// How clocks map to ticks of the file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Timebase {
    exponent: i8,
    clock_hz: u64,
    /// Ticks in half a period, where that is whole.
    half_period: Option<u64>,
}

impl Timebase {
    /// The time axis of a simulation clocked at `clock_hz`.
    ///
    /// # Errors
    /// A clock of 0 Hz or above 100 GHz.
    pub fn of_clock(clock_hz: u64) -> Result<Self, Error> {
        if !(1..=MOST_HZ).contains(&clock_hz) {
            return Err(Error::ClockFrequency(clock_hz));
        }
        let whole =
            EXPONENTS.iter().find(|&&exponent| per_second(exponent).is_multiple_of(2 * clock_hz));
        let half_period = whole.map(|&exponent| per_second(exponent) / (2 * clock_hz));
        Ok(Timebase { exponent: *whole.unwrap_or(&-12), clock_hz, half_period })
    }

    /// A tick is `10^exponent` seconds.
    pub fn exponent(self) -> i8 {
        self.exponent
    }

    /// The tick at which clock number `clock` falls.
    pub fn ticks(self, clock: u64) -> u64 {
        self.half_ticks(2 * clock)
    }

    /// The tick after `halves` half periods.
    pub fn half_ticks(self, halves: u64) -> u64 {
        match self.half_period {
            Some(ticks) => halves * ticks,
            None => self.rounded(halves),
        }
    }

    fn rounded(self, halves: u64) -> u64 {
        let hz = u128::from(self.clock_hz);
        let doubled = u128::from(halves) * u128::from(per_second(self.exponent));
        ((doubled + hz) / (2 * hz)) as u64
    }
}

fn per_second(exponent: i8) -> u64 {
    10u64.pow(u32::from(exponent.unsigned_abs()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_tick_is_the_coarsest_that_is_exact() {
        let cases =
            [(25_000_000, -9, 40), (100_000_000, -9, 10), (200_000_000, -12, 5000), (1, -3, 1000)];
        for (hz, exponent, period) in cases {
            let base = Timebase::of_clock(hz).unwrap();
            assert_eq!((base.exponent(), base.ticks(1)), (exponent, period), "{hz} Hz");
            assert_eq!(base.ticks(1_000_000_000), 1_000_000_000 * period);
        }
    }

    #[test]
    fn a_clock_without_an_exact_tick_does_not_drift() {
        let base = Timebase::of_clock(12_000_000).unwrap();
        assert_eq!((base.exponent(), base.ticks(1), base.half_ticks(1)), (-12, 83_333, 41_667));
        assert_eq!(base.ticks(12_000_000 * 3600), 3600 * 1_000_000_000_000, "an hour is an hour");
    }

    #[test]
    fn impossible_clocks_are_errors() {
        assert!(Timebase::of_clock(0).is_err() && Timebase::of_clock(MOST_HZ + 1).is_err());
    }
}
