// SPDX-License-Identifier: MIT OR Apache-2.0
//! The simulated device as its users see it, in one program: a program of its own for each file takes
//! long to build.

mod arena;
mod budget;
mod charge;
mod common;
mod defaults;
mod effects;
mod gallery;
mod inputs;
mod limits;
mod messages;
mod moving;
mod panel;
mod pay;
mod plant;
mod pull_in;
mod release;
mod sensor;
mod split;
mod switching;
mod temperature;
mod terminals;
mod time;
