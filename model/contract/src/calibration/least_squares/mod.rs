// SPDX-License-Identifier: MIT OR Apache-2.0
//! Least squares over tables: which entries make interpolation come nearest to given values.
//!
//! The normal equations of three entries ([`Moments`]) and those of a raster ([`RasterFit`]) are solved by
//! Cholesky's factor.

mod band;
mod moments;
mod near;
mod raster;
#[cfg(test)]
mod terms;

pub use moments::Moments;
pub use raster::RasterFit;
