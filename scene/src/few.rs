// SPDX-License-Identifier: MIT OR Apache-2.0
//! A few values in place.

pub(crate) use hapticore_sheet::Few;
