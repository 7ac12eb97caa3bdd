// SPDX-License-Identifier: MIT OR Apache-2.0
//! Packets: the payloads of the board's line, as bits and bytes.
//!
//! `Layout` goes both ways between a [`Message`] and its payload; [`crate::decoder`] finds payloads
//! in a stream of bytes. Boards encode by gateware, which shares nothing with this but the
//! constants of [`hapticore_protocol::framing`]; the encoder here serves tests and programs that
//! stand in for a board.

use crate::line::{Crc32, from_board};
use bitvec::prelude::{BitArray, Lsb0};
use bitvec::view::BitView;
use hapticore_contract::control::Faults;
use hapticore_contract::format::Format;
use hapticore_contract::frame::Field;
use hapticore_contract::frame::{Flags, Frame};
use hapticore_contract::profile::Profile;
use hapticore_protocol::drive::{PACKET_WORDS, status};
use hapticore_protocol::framing::{
    FLAGS_BYTE, STATUS_BYTES, VERSION, board_digest, data_bytes, flags, word_bytes,
};
use hapticore_protocol::output::{CLOCK, FULL_SCALE, Output, SETUP};
use hapticore_protocol::register::LINES;
use hapticore_protocol::{Register, WordFormats};

/// A board's words: frames' fields, or what has been written into registers.
type Words = [i64; Field::ALL.len()];

/// What every packet says of the line and of the commands that came over it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Status {
    /// Counts the frames of the core, modulo 65,536; the first after a reset is 1. A gap is a loss.
    pub sequence: u16,
    /// The ADC was late since the packet before; samples of it are wrong.
    pub late: bool,
    /// A command was refused since the packet before.
    pub refused: bool,
    /// The line was too slow: frames were dropped since the packet before.
    pub overrun: bool,
    /// Commands accepted since reset, modulo 16.
    pub commands: u8,
    /// The drive, of a board that has one.
    pub driven: Option<Driven>,
}

/// What a packet says of the drive, as it was when the packet began.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Driven {
    /// The last drive word, a raw code of the profile's `control.drive`.
    pub word: i64,
    /// Its pad; of a split one the last part.
    pub pad: u8,
    /// The drive is at zero and should be less.
    pub low: bool,
    /// The drive is at its rail and should be more.
    pub high: bool,
    /// The user leaves the pad's wall.
    pub free: bool,
    /// Every channel of the converter has been set to zero since reset.
    pub live: bool,
    /// What keeps all drives at zero.
    pub faults: Faults,
}

impl Driven {
    /// Of two words of a packet.
    fn of([word, bits]: [i64; 2], format: Format) -> Self {
        let is = |bit: u8| bits >> bit & 1 != 0;
        Driven {
            word: word & ((1 << format.width) - 1),
            pad: (bits >> status::PAD & 0xf) as u8,
            low: is(status::LOW),
            high: is(status::HIGH),
            free: is(status::FREE),
            live: is(status::LIVE),
            faults: Faults {
                silence: is(status::SILENCE),
                sensor: is(status::SENSOR),
                force: is(status::FORCE),
            },
        }
    }

    /// The words of a packet.
    fn words(&self) -> [i64; 2] {
        let bits = [
            (status::SILENCE, self.faults.silence),
            (status::SENSOR, self.faults.sensor),
            (status::FORCE, self.faults.force),
            (status::LOW, self.low),
            (status::HIGH, self.high),
            (status::FREE, self.free),
            (status::LIVE, self.live),
        ];
        let pad = i64::from(self.pad) << status::PAD;
        [self.word, bits.into_iter().fold(pad, |word, (bit, is)| word | i64::from(is) << bit)]
    }
}

/// A frame as it came over the line.
///
/// ```
/// use hapticore_host::{Decoder, Message, Packet, Profile, Status};
/// use hapticore_host::{Flags, Frame};
///
/// let profile = Profile::bundled("small")?;
/// let frame = Frame { pad: 2, codes: [-5, 6, -700, 800, 9, 1000, 11, 12], flags: Flags::default() };
/// let packet = Packet { status: Status { sequence: 7, ..Status::default() }, frame };
/// let bytes = Message::Frame(packet).encode(&profile);
/// assert_eq!(Decoder::new(&profile).decode(bytes).collect::<Vec<_>>(), [Ok(Message::Frame(packet))]);
/// # Ok::<(), hapticore_host::ProfileError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Packet {
    /// The line and its commands.
    pub status: Status,
    /// Decoded frame.
    pub frame: Frame,
}

/// What a board sends while it is disabled.
///
/// ```
/// use hapticore_host::{Heartbeat, Profile, Status, digest};
///
/// let profile = Profile::bundled("standard")?;
/// let heartbeat = Heartbeat::new(Status { commands: 3, ..Status::default() }, &profile, None);
/// assert_eq!(heartbeat.digest(), digest(&profile));
/// assert!(!heartbeat.calibrated && heartbeat.status.commands == 3);
/// # Ok::<(), hapticore_host::ProfileError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Heartbeat {
    /// The line and its commands; the sequence number is that of the last frame.
    pub status: Status,
    /// Since its reset the board has been given the last constant of a calibration.
    pub calibrated: bool,
    /// The version of the line's framing, [`VERSION`] here.
    pub version: u8,
    words: Words,
    bits: u8,
}

impl Heartbeat {
    /// Of a board that was made for the profile and the output and has just been reset.
    pub fn new(status: Status, profile: &Profile, output: Option<&Output>) -> Self {
        let layout = Layout::new(profile);
        let mut words = Words::default();
        words[Register::Control.number()] = layout.word(board_digest(profile, output).into());
        let told = output.map_or([0; 3], Output::words);
        for (number, word) in [SETUP, FULL_SCALE, CLOCK].into_iter().zip(told) {
            words[number] = layout.word(word.into());
        }
        Heartbeat { status, calibrated: false, version: VERSION, words, bits: layout.register_bits }
    }

    /// The same after a word of its number was written, as its low bits: for programs that stand in for a board.
    pub fn with_word(mut self, number: usize, bits: u64, profile: &Profile) -> Self {
        let data = 8 * data_bytes(&WordFormats::new(profile)) as u32;
        let width = u32::from(Field::word(profile).width);
        let above = u64::BITS - width;
        let kept = (bits & (u64::MAX >> (u64::BITS - data))) << above;
        self.words[number] = kept as i64 >> above;
        self
    }

    /// The same after a word was sent to the ADC, whose first line put out `answer` meanwhile.
    pub fn with_adc_answer(self, answer: u16, sent: u16, profile: &Profile) -> Self {
        // A bit more comes in than the answer has: the line stays as its last bit was.
        let bits = u64::from(sent) << 17 | u64::from(answer) << 1 | u64::from(answer & 1);
        self.with_word(Register::Adc.number(), bits, profile)
    }

    /// The low bits of the value last written into a constant's register, as many as fit a word of
    /// a frame, and their number. None of the other registers, which heartbeats do not report.
    pub fn register(&self, register: Register) -> Option<(u64, u8)> {
        let word = self.words[register.number()] as u64 & ((1 << self.bits) - 1);
        matches!(register, Register::Constant(_)).then_some((word, self.bits))
    }

    /// What the board says of its output: converter, wave, full scale, clock; in words.
    pub fn output(&self) -> String {
        Output::told([SETUP, FULL_SCALE, CLOCK].map(|number| self.words[number] as u16))
    }

    /// The code that the last test of a line has read, as bits; none where there is none yet, or where it was not the same
    /// each time.
    pub fn line_code(&self) -> Option<u64> {
        let code = self.words[LINES] as u64 & ((1 << self.bits) - 1);
        (code != 0).then_some(code)
    }

    /// The digest of the profile that the board was made for, and of its output.
    pub fn digest(&self) -> u16 {
        self.words[Register::Control.number()] as u16
    }

    /// What the ADC put out while the last word was sent to it: the register that the word before
    /// has read.
    pub fn adc_answer(&self) -> u8 {
        // A bit more has come in than the word has.
        (self.words[Register::Adc.number()] >> 1) as u8
    }
}

/// A packet of a board.
///
/// ```
/// use hapticore_host::{Heartbeat, Message, Profile, Status};
///
/// let profile = Profile::bundled("small")?;
/// let message = Message::Heartbeat(Heartbeat::new(Status::default(), &profile, None));
/// assert_eq!(message.frame(), None);
/// assert_eq!(message.encode(&profile).last(), Some(&hapticore_host::END));
/// # Ok::<(), hapticore_host::ProfileError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Message {
    /// A frame of a slot.
    Frame(Packet),
    /// The board is there, and disabled.
    Heartbeat(Heartbeat),
}

impl Message {
    /// The frame, if it is one.
    pub fn frame(self) -> Option<Packet> {
        match self {
            Message::Frame(packet) => Some(packet),
            Message::Heartbeat(_) => None,
        }
    }

    /// The heartbeat, if it is one.
    pub fn heartbeat(self) -> Option<Heartbeat> {
        match self {
            Message::Frame(_) => None,
            Message::Heartbeat(heartbeat) => Some(heartbeat),
        }
    }

    /// The bytes that a board of the profile sends.
    pub fn encode(&self, profile: &Profile) -> Vec<u8> {
        from_board::<Crc32>(&Layout::new(profile).payload(self))
    }
}

/// How the payload of a profile's packets is laid out.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Layout {
    word_bytes: usize,
    /// Bits of a register that a heartbeat tells.
    register_bits: u8,
    pads: u64,
    /// Of drive words, where the board has a drive.
    drive: Option<Format>,
}

impl Layout {
    pub fn new(profile: &Profile) -> Self {
        let data_bits = 8 * data_bytes(&WordFormats::new(profile)) as u8;
        let register_bits = Field::word(profile).width.min(data_bits);
        let drive = profile.control.as_ref().map(|control| control.drive);
        let word_bytes = word_bytes(profile) as usize;
        Layout { word_bytes, register_bits, pads: profile.pads, drive }
    }

    /// Bytes of a payload.
    pub fn payload_bytes(&self) -> usize {
        let of_drive = self.drive.map_or(0, |_| PACKET_WORDS as usize);
        STATUS_BYTES as usize + (Field::ALL.len() + of_drive) * self.word_bytes
    }

    /// Whether these are the first bytes of a heartbeat, stuffed, that ended early because one of its
    /// words was written. Its flags are not zero: they are on the line as they are.
    pub fn is_cut_heartbeat(&self, bytes: &[u8]) -> bool {
        let is_heartbeat = |flags: &u8| {
            flags >> flags::HEARTBEAT & 1 != 0 && flags >> flags::VERSION & 7 == VERSION
        };
        bytes.get(FLAGS_BYTE as usize).is_some_and(is_heartbeat)
    }

    /// What a payload of the right length says; the number of the pad where there is no such pad.
    pub fn message(&self, payload: &[u8]) -> Result<Message, u8> {
        let (&[high, low, pad, bits, more], words) =
            payload.split_first_chunk().expect("the length was checked");
        let mut words = words.chunks_exact(self.word_bytes).map(signed).collect::<Vec<_>>();
        let of_drive = words.split_off(Field::ALL.len());
        let words = Words::try_from(words).expect("the length was checked");
        let driven = self
            .drive
            .map(|format| Driven::of(of_drive.try_into().expect("the length was checked"), format));
        let sequence = u16::from_be_bytes([high, low]);
        let (commands, pad) = (pad >> 4, pad & 0xf);
        let version = bits >> flags::VERSION & 7;
        let bits = BitArray::<_, Lsb0>::new([bits, more]);
        let is = |flag: u8| bits[usize::from(flag)];
        let [late, refused, overrun] = [flags::LATE, flags::REFUSED, flags::OVERRUN].map(is);
        let status = Status { sequence, late, refused, overrun, commands, driven };
        if is(flags::HEARTBEAT) {
            let (calibrated, bits) = (is(flags::CALIBRATED), self.register_bits);
            return Ok(Message::Heartbeat(Heartbeat { status, calibrated, version, words, bits }));
        }
        if u64::from(pad) >= self.pads {
            return Err(pad);
        }
        let [clipped, saturated, invalid, lost, lifted] =
            [flags::CLIPPED, flags::SATURATED, flags::INVALID, flags::LOST, flags::LIFTED].map(is);
        let flags = Flags { clipped, saturated, invalid, lost, lifted };
        Ok(Message::Frame(Packet { status, frame: Frame { pad: pad.into(), codes: words, flags } }))
    }

    /// The payload of a message.
    pub fn payload(&self, message: &Message) -> Vec<u8> {
        let (status, pad, words) = match message {
            Message::Frame(Packet { status, frame }) => (status, frame.pad as u8, &frame.codes),
            Message::Heartbeat(heartbeat) => (&heartbeat.status, 0, &heartbeat.words),
        };
        let mut bits = BitArray::<[u8; 2], Lsb0>::ZERO;
        let set = [
            (flags::LATE, status.late),
            (flags::REFUSED, status.refused),
            (flags::OVERRUN, status.overrun),
        ];
        set.into_iter()
            .chain(self.own_flags(message))
            .for_each(|(flag, is)| bits.set(usize::from(flag), is));
        let [high, low] = status.sequence.to_be_bytes();
        let [bits, more] = bits.into_inner();
        let mut payload = vec![high, low, status.commands << 4 | pad, bits, more];
        let of_drive = self.drive.map(|_| status.driven.unwrap_or_default().words());
        words
            .iter()
            .chain(of_drive.iter().flatten())
            .for_each(|word| payload.extend(&word.to_be_bytes()[8 - self.word_bytes..]));
        payload
    }

    /// The flags that frames and heartbeats have in the same bits.
    fn own_flags(&self, message: &Message) -> Vec<(u8, bool)> {
        match message {
            Message::Frame(Packet { frame: Frame { flags, .. }, .. }) => vec![
                (flags::CLIPPED, flags.clipped),
                (flags::SATURATED, flags.saturated),
                (flags::INVALID, flags.invalid),
                (flags::LOST, flags.lost),
                (flags::LIFTED, flags.lifted),
            ],
            Message::Heartbeat(Heartbeat { calibrated, version, .. }) => {
                let version =
                    version.view_bits::<Lsb0>()[..3].iter().by_vals().zip(flags::VERSION..);
                let own = [(flags::HEARTBEAT, true), (flags::CALIBRATED, *calibrated)];
                own.into_iter().chain(version.map(|(is, flag)| (flag, is))).collect()
            }
        }
    }

    /// The word that these low bits stand for.
    fn word(&self, code: i64) -> i64 {
        signed(&code.to_be_bytes()[8 - self.word_bytes..])
    }
}

/// A two's complement word, most significant byte first.
fn signed(bytes: &[u8]) -> i64 {
    let sign = if bytes[0] & 0x80 != 0 { -1 } else { 0 };
    bytes.iter().fold(sign, |code, &byte| code << 8 | i64::from(byte))
}
