// SPDX-License-Identifier: MIT OR Apache-2.0
//! CRC-32/ISO-HDLC: what guards every packet, a byte a step.
//!
//! ```text
//! x = crc[7:0] ⊕ byte
//! crc' = (crc » 8) ⊕ Σ xₖ·Tₖ          Tₖ: eight steps of the polynomial EDB88320 (hex, reflected) from 1 « k; sums modulo 2
//! ```
//!
//! Begins at all ones, least significant bit first. A packet carries the complement, least
//! significant byte first; with these four bytes the CRC of any packet is [`RESIDUE`]. Functions,
//! not a block: the sender or receiver holds the state. Source: IEEE 802.3, §3.2.9; the catalogue's
//! check value is cbf43926 (hex).

use super::bits::{word, xor};
use hapticore_hdl::format::Format;
use hapticore_hdl::signal::{Signal, Value, code};

/// The format of a CRC.
pub const CRC: Format = Format::unsigned(32, 0);

/// What the CRC of a packet is with the packet's own CRC.
pub const RESIDUE: u64 = 0xdebb_20e3;

/// The polynomial, the least significant bit first.
const POLYNOMIAL: u32 = 0xedb8_8320;

/// What each bit of a byte becomes in a CRC.
const FED_BACK: [u32; 8] = {
    let mut all = [0; 8];
    let mut k = 0;
    while k < 8 {
        all[k] = steps(1 << k);
        k += 1;
    }
    all
};

/// Eight steps of the polynomial.
const fn steps(mut crc: u32) -> u32 {
    let mut step = 0;
    while step < 8 {
        crc = crc >> 1 ^ (POLYNOMIAL & (crc & 1).wrapping_neg());
        step += 1;
    }
    crc
}

/// What a CRC begins with.
#[inline(always)]
pub fn begin<V: Value>() -> Signal<V> {
    code(0xffff_ffff, CRC)
}

/// The CRC with one more byte.
#[inline(always)]
pub fn with<V: Value>(crc: Signal<V>, byte: Signal<V>) -> Signal<V> {
    let x = |k: u8| xor(crc.bits(k, 1), byte.bits(k, 1));
    word((0..32u8).map(|bit| {
        let shifted = (bit < 24).then(|| crc.bits(bit + 8, 1));
        let fed_back = (0..8).filter(|&k| FED_BACK[usize::from(k)] >> bit & 1 != 0).map(x);
        shifted.into_iter().chain(fed_back).reduce(xor).expect("every bit is fed back to")
    }))
}

#[cfg(test)]
mod tests {
    use super::*;
    use hapticore_hdl::signal::int;

    fn over(bytes: impl IntoIterator<Item = u8>) -> i64 {
        let step = |crc, byte| with(crc, int(u64::from(byte)).bits(0, 8));
        bytes.into_iter().fold(begin::<i64>(), step).value
    }

    #[test]
    fn it_is_the_catalogue_s() {
        let theirs = crc::Crc::<u32>::new(&crc::CRC_32_ISO_HDLC);
        let all: String = (0..=255).map(char::from).collect();
        for text in ["123456789", "", "a", "\u{0}\u{0}", &all] {
            let ours = !over(text.bytes()) as u32;
            assert_eq!(ours, theirs.checksum(text.as_bytes()), "{text:?}");
        }
    }

    #[test]
    fn with_its_own_bytes_it_is_the_residue() {
        for text in ["123456789", "", "\u{0}"] {
            let own = (!over(text.bytes()) as u32).to_le_bytes();
            assert_eq!(over(text.bytes().chain(own)), RESIDUE as i64, "{text:?}");
        }
    }
}
