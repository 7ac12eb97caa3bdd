// SPDX-License-Identifier: MIT OR Apache-2.0
//! Many runs of a plan: what accuracy costs in time, on the core's side and on the plant's.
//!
//! Each run is named by the hash of everything that it is made of, so that it may be run anywhere, any
//! number of times: what is in the store is done. Threads of one program, or any engine that starts
//! programs, fill a store; what is collected from it has the same bytes.
//!
//! | module | does |
//! | --- | --- |
//! | [`plan`], `file` | a plan: scene, profile, axes; its file, with messages that name lines |
//! | [`axis`], [`settings`] | keys and their values; a profile or a scene with keys set |
//! | [`point`] | a plan's points and their names |
//! | [`canonical`] | canonical JSON and its hash |
//! | [`run`], [`result`](mod@result) | a point run; the line that it leaves |
//! | [`store`], `part`, `index`, `claim` | the folder of results; a file of it; the points of each; chunks that a runner is at |
//! | [`host`] | whether a host makes the same bytes as others |
//! | [`work`] | chunks of points, run on all threads or one at a time |
//! | [`collect`] | results sorted, missing and failed points, the Pareto front |
//! | `parquet` | results as a Parquet file, with the feature of this name |
//! | [`engines`] | commands for HyperQueue, Slurm, GNU parallel and Snakemake |

pub mod axis;
pub mod canonical;
mod claim;
pub mod collect;
pub mod engines;
mod file;
pub mod host;
mod index;
#[cfg(feature = "parquet")]
mod parquet;
mod part;
pub mod plan;
pub mod point;
pub mod result;
pub mod run;
pub mod settings;
pub mod store;
pub mod work;
