// SPDX-License-Identifier: MIT OR Apache-2.0
//! The live server as its clients see it.

mod client;
mod hostile;
mod pace;
mod protocol;
mod record;
mod sharing;
