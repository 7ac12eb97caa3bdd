// SPDX-License-Identifier: MIT OR Apache-2.0
//! Force controllers of other projects, described anew from their published behaviour, in a loop
//! with this project's plant beside ours.
//!
//! Each receives the force by eq. 8 as an ideal core reads it in the frame that has just ended, and
//! sets the drive of the next. What a drive asks for beyond 0 and the rail, the amplifier cuts.
//!
//! | module | is |
//! | --- | --- |
//! | [`laws`] | the laws, in their words |
//! | [`table`] | every law on the same targets |
//! | [`trial`] | a pad under 50 g in a loop with a law, and how far its true force is from its target |

pub mod laws;
pub mod table;
pub mod trial;
