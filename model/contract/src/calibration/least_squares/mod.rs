// SPDX-License-Identifier: MIT OR Apache-2.0
//! Least squares over tables: which entries make interpolation come nearest to given values.
//!
//! The normal equations of three entries are solved by Cholesky's factor ([`Moments`]), those of a raster by
//! conjugate gradients ([`RasterFit`]). Why both are ours, with figures: docs/decisions.md §32.

mod band;
mod gradients;
mod moments;
mod near;
mod raster;
mod separable;
#[cfg(test)]
mod terms;

pub use moments::Moments;
pub use raster::RasterFit;
