// SPDX-License-Identifier: MIT OR Apache-2.0
//! Decoder: messages from a stream of bytes, whatever has become of it on the way.

use crate::line::{Check, Collector, Crc32, Damage};
use crate::packet::{Layout, Message};
use hapticore_contract::profile::Profile;

/// Makes messages of bytes as they come. What it has lost it says, and the next END puts it right;
/// it keeps at most one packet.
///
/// A decoder that starts in the middle of a packet reports one damaged packet first. Of packets
/// that are damaged at random the CRC lets one in 2³² pass. Where an END is lost, or bytes are
/// heard that are none, the next packet is found by its length.
///
/// ```
/// use hapticore_host::{Decoder, Heartbeat, Message, Profile, Status};
///
/// let profile = Profile::bundled("small")?;
/// let heartbeat = Message::Heartbeat(Heartbeat::new(Status::default(), &profile, None));
/// let bytes = heartbeat.encode(&profile);
/// let mut decoder = Decoder::new(&profile);
/// // From the middle of one packet to the end of the next.
/// let heard: Vec<_> = decoder.decode(bytes[9..].iter().chain(&bytes).copied()).collect();
/// assert!(heard[0].is_err());
/// assert_eq!(heard[1..], [Ok(heartbeat)]);
/// # Ok::<(), hapticore_host::ProfileError>(())
/// ```
#[derive(Debug, Clone)]
pub struct Decoder {
    layout: Layout,
    collector: Collector<Crc32>,
}

impl Decoder {
    /// For a board of the profile.
    pub fn new(profile: &Profile) -> Self {
        let layout = Layout::new(profile);
        Decoder { layout, collector: Collector::new(layout.payload_bytes()) }
    }

    /// Takes a byte; gives a message, or what became of it, at its END.
    pub fn push(&mut self, byte: u8) -> Option<Result<Message, Damage>> {
        push(&self.layout, &mut self.collector, byte)
    }

    /// Every message of some bytes.
    pub fn decode<'a>(
        &'a mut self,
        bytes: impl IntoIterator<Item = u8, IntoIter: 'a>,
    ) -> impl Iterator<Item = Result<Message, Damage>> + 'a {
        bytes.into_iter().filter_map(|byte| self.push(byte))
    }
}

/// [`Decoder::push`] with any check.
pub(crate) fn push<C: Check>(
    layout: &Layout,
    collector: &mut Collector<C>,
    byte: u8,
) -> Option<Result<Message, Damage>> {
    if !collector.push(byte) {
        return None;
    }
    let stuffed = collector.stuffed();
    if stuffed.len() < collector.length() && layout.is_cut_heartbeat(stuffed) {
        return None;
    }
    let payload = collector.payload();
    Some(payload.and_then(|payload| layout.message(payload).map_err(Damage::Pad)))
}
