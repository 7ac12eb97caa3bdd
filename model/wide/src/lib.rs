// SPDX-License-Identifier: MIT OR Apache-2.0
//! Runs a loop with the widest instructions that the processor has.
//!
//! One build serves every processor of an architecture, so that the compiler may use what all of them have: of
//! x86-64 two numbers to an instruction. [`widest`] compiles a loop a second time, for AVX2, and chooses when it
//! runs. Results are the same to the bit: the compiler neither fuses nor reorders operations on floating-point
//! numbers, it only does several at once.

use pulp::{Arch, NullaryFnOnce};

/// Calls `work`, a loop over `on`, compiled for the processor that it runs on.
///
/// The closure must be marked `#[inline(always)]`, and so must be what it calls: a function of its own is compiled
/// for every processor. Move into it what it needs: what it borrows is read from memory again after each number
/// that the loop writes.
///
/// ```
/// let (mut numbers, factor) = ([1.0, 2.0, 3.0], 0.5);
/// hapticore_wide::widest(&mut numbers, #[inline(always)] move |numbers| {
///     numbers.iter_mut().for_each(|number| *number *= factor);
/// });
/// assert_eq!(numbers, [0.5, 1.0, 1.5]);
/// ```
#[inline(always)]
pub fn widest<On, Result>(on: On, work: impl FnMut(On) -> Result) -> Result {
    Arch::new().dispatch(Loop { on, work })
}

/// A closure is called by `FnMut` here, for the compiler calls it by `FnOnce` through a function of its own.
struct Loop<On, Work> {
    on: On,
    work: Work,
}

impl<On, Result, Work: FnMut(On) -> Result> NullaryFnOnce for Loop<On, Work> {
    type Output = Result;

    #[inline(always)]
    fn call(self) -> Result {
        let Loop { on, mut work } = self;
        work(on)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Where a product and a sum were fused, their sum would not be rounded twice.
    #[test]
    fn products_and_sums_are_rounded_as_one_after_the_other() {
        let numbers = |seed: f64| -> [f64; 1001] {
            std::array::from_fn(|n| (seed + n as f64).sin() * 2f64.powi(n as i32 % 40 - 20))
        };
        let (a, b, c) = (numbers(0.1), numbers(0.2), numbers(0.3));
        let mut sums = c;
        widest(
            &mut sums,
            #[inline(always)]
            move |sums| {
                for ((sum, a), b) in sums.iter_mut().zip(&a).zip(&b) {
                    *sum += a * b;
                }
            },
        );
        for n in 0..sums.len() {
            let product = std::hint::black_box(a[n] * b[n]);
            assert_eq!(sums[n].to_bits(), (c[n] + product).to_bits(), "{n}");
        }
        assert!((0..sums.len()).any(|n| a[n].mul_add(b[n], c[n]) != sums[n]), "all were exact");
    }
}
