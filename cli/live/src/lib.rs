// SPDX-License-Identifier: MIT OR Apache-2.0
//! A simulated display in a browser: a scene and the core in real time, led by hand, behind a local web server.
//!
//! | module | does |
//! | --- | --- |
//! | [`source`], [`simulated`], [`setup`], [`describe`] | what is watched and led: a scene that is simulated, how it is set up, and what a client must know of it |
//! | [`pace`] | device time against wall time |
//! | [`hub`] | the loop: requests in, frames out, one source for all clients |
//! | [`protocol`] | the messages |
//! | [`pads`], [`state`], [`rows`] | rows of slots as pads, as states in words, as columns for programs |
//! | [`record`] | inputs as a scene file or a log |
//! | [`presets`] | scenes with something to try |
//! | [`server`], [`http`], [`client`], [`files`] | sockets, who may ask, queues, the page's files |

pub mod client;
pub mod describe;
pub mod files;
pub mod http;
pub mod hub;
pub mod pace;
pub mod pads;
pub mod presets;
pub mod protocol;
pub mod record;
pub mod rows;
pub mod server;
pub mod setup;
pub mod simulated;
pub mod source;
pub mod state;
