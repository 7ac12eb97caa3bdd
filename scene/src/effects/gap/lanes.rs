// SPDX-License-Identifier: MIT OR Apache-2.0
//! Numbers of several patches side by side: as patches do not wait for each other, the processor starts
//! one's divisions while another's result is still to come.

use std::array::from_fn;
use std::ops::{Add, Div, Mul, Neg, Sub};

/// What the equations of a patch are written in: the number of one patch, or those of several.
pub(super) trait Real:
    Copy
    + Neg<Output = Self>
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
{
    /// The same number for all patches.
    fn of(number: f64) -> Self;
    /// The exponential of each.
    fn exp(self) -> Self;
}

impl Real for f64 {
    #[inline(always)]
    fn of(number: f64) -> f64 {
        number
    }

    #[inline(always)]
    fn exp(self) -> f64 {
        f64::exp(self)
    }
}

/// The numbers of `N` patches.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Lanes<const N: usize>(pub [f64; N]);

impl<const N: usize> Lanes<N> {
    /// The number of each.
    #[inline(always)]
    pub fn each(number: impl FnMut(usize) -> f64) -> Self {
        Lanes(from_fn(number))
    }

    /// The magnitude of each.
    #[inline(always)]
    pub fn abs(self) -> Self {
        Lanes::each(|k| self.0[k].abs())
    }
}

impl<const N: usize> Real for Lanes<N> {
    #[inline(always)]
    fn of(number: f64) -> Self {
        Lanes([number; N])
    }

    #[inline(always)]
    fn exp(self) -> Self {
        Lanes::each(|k| self.0[k].exp())
    }
}

impl<const N: usize> Neg for Lanes<N> {
    type Output = Self;

    #[inline(always)]
    fn neg(self) -> Self {
        Lanes::each(|k| -self.0[k])
    }
}

/// An operator that acts on each patch's numbers.
macro_rules! act_on_each {
    ($($operator:ident, $name:ident);*) => {$(
        impl<const N: usize> $operator for Lanes<N> {
            type Output = Self;

            #[inline(always)]
            fn $name(self, other: Self) -> Self {
                Lanes::each(|k| self.0[k].$name(other.0[k]))
            }
        }
    )*};
}

act_on_each!(Add, add; Sub, sub; Mul, mul; Div, div);
