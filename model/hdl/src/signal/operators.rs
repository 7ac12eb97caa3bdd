// SPDX-License-Identifier: MIT OR Apache-2.0
//! The operators of signals: exact, with the format inferred from the operands.

use super::{Signal, Value, operate};
use crate::format::BIT;
use std::ops::{Add, BitAnd, BitOr, Mul, Neg, Not, Sub};

impl<V: Value> Add for Signal<V> {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        operate!(V, {
            let to = self.format.sum(other.format);
            Signal { value: V::add(self, other, to), format: to }
        })
    }
}

impl<V: Value> Sub for Signal<V> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        operate!(V, {
            let to = self.format.difference(other.format);
            Signal { value: V::sub(self, other, to), format: to }
        })
    }
}

impl<V: Value> Mul for Signal<V> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        operate!(V, {
            let to = self.format.product(other.format);
            Signal { value: V::mul(self, other, to), format: to }
        })
    }
}

impl<V: Value> Neg for Signal<V> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        let zero = super::zero(crate::format::Format { width: 1, signed: false, ..self.format });
        zero - self
    }
}

impl<V: Value> Not for Signal<V> {
    type Output = Self;
    #[inline(always)]
    fn not(self) -> Self {
        operate!(V, {
            debug_assert!(self.format == BIT);
            Signal { value: V::not(self.value), format: BIT }
        })
    }
}

impl<V: Value> BitAnd for Signal<V> {
    type Output = Self;
    #[inline(always)]
    fn bitand(self, other: Self) -> Self {
        operate!(V, {
            debug_assert!(self.format == BIT && other.format == BIT);
            Signal { value: V::and(self.value, other.value), format: BIT }
        })
    }
}

impl<V: Value> BitOr for Signal<V> {
    type Output = Self;
    #[inline(always)]
    fn bitor(self, other: Self) -> Self {
        operate!(V, {
            debug_assert!(self.format == BIT && other.format == BIT);
            Signal { value: V::or(self.value, other.value), format: BIT }
        })
    }
}
