// SPDX-License-Identifier: MIT OR Apache-2.0
//! A few values, how many of which is known at run time only: held in place, so that neither slot
//! nor sample allocates, and copied as they are.

use std::ops::{Deref, DerefMut};

/// Up to `MOST` values.
#[derive(Clone, Copy, Debug)]
pub struct Few<T, const MOST: usize> {
    values: [T; MOST],
    count: usize,
}

impl<T: Copy + Default, const MOST: usize> Few<T, MOST> {
    /// Of each value another one.
    #[inline]
    pub fn map<U: Copy + Default>(&self, of: impl Fn(T) -> U) -> Few<U, MOST> {
        let mut few = Few { values: [U::default(); MOST], count: self.count };
        few.iter_mut().zip(self.iter()).for_each(|(to, from)| *to = of(*from));
        few
    }

    /// `count` values, which `fill` puts in front of as many as there may be.
    #[inline]
    pub fn of(count: usize, fill: impl FnOnce(&mut [T; MOST])) -> Self {
        let mut few = Few { values: [T::default(); MOST], count };
        fill(&mut few.values);
        few
    }

    /// A list of these values.
    ///
    /// # Panics
    /// If there are more than there may be.
    #[inline]
    pub fn from_slice(from: &[T]) -> Self {
        Few::of(from.len(), |values| values[..from.len()].copy_from_slice(from))
    }

    /// All there may be, the default where there is none: a loop over these and a shorter row has
    /// the row's length.
    #[inline]
    pub fn padded(&self) -> [T; MOST] {
        self.values
    }

    /// The same without a copy.
    #[inline]
    pub fn as_padded(&self) -> &[T; MOST] {
        &self.values
    }
}

impl<T: Copy + Default, const MOST: usize> Default for Few<T, MOST> {
    fn default() -> Self {
        Few { values: [T::default(); MOST], count: 0 }
    }
}

/// The first `MOST` values.
impl<T: Copy + Default, const MOST: usize> FromIterator<T> for Few<T, MOST> {
    #[inline]
    fn from_iter<I: IntoIterator<Item = T>>(from: I) -> Self {
        let mut few = Few::default();
        for (place, value) in few.values.iter_mut().zip(from) {
            *place = value;
            few.count += 1;
        }
        few
    }
}

/// As lists.
impl<T: PartialEq, const MOST: usize> PartialEq for Few<T, MOST> {
    fn eq(&self, other: &Self) -> bool {
        **self == **other
    }
}

impl<T, const MOST: usize> Deref for Few<T, MOST> {
    type Target = [T];

    #[inline]
    fn deref(&self) -> &[T] {
        &self.values[..self.count]
    }
}

impl<T, const MOST: usize> DerefMut for Few<T, MOST> {
    #[inline]
    fn deref_mut(&mut self) -> &mut [T] {
        &mut self.values[..self.count]
    }
}

/// The values themselves, as from an array.
impl<T: Copy, const MOST: usize> IntoIterator for Few<T, MOST> {
    type Item = T;
    type IntoIter = std::iter::Take<std::array::IntoIter<T, MOST>>;

    #[inline]
    fn into_iter(self) -> Self::IntoIter {
        self.values.into_iter().take(self.count)
    }
}
