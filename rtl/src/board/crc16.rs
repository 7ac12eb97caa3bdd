// SPDX-License-Identifier: MIT OR Apache-2.0
//! CRC-16/IBM-3740: what guards every packet, a byte a step.
//!
//! ```text
//! x = crc[15:8] ⊕ byte,   y = x ⊕ (x » 4)
//! crc' = (crc « 8) ⊕ (y « 12) ⊕ (y « 5) ⊕ y            polynomial x¹⁶ + x¹² + x⁵ + 1
//! ```
//!
//! Begins at all ones, most significant bit first; after the two bytes of a packet's own CRC it is
//! zero. Functions, not a block: the state lies with whoever sends or receives. Source: ITU-T V.41;
//! the catalogue's check value is 29b1 (hex).

use super::bits::{word, xor};
use hapticore_hdl::format::Format;
use hapticore_hdl::signal::{Signal, Value, code};

/// The format of a CRC.
pub const CRC: Format = Format::unsigned(16, 0);

/// What a CRC begins with.
#[inline(always)]
pub fn begin<V: Value>() -> Signal<V> {
    code(0xffff, CRC)
}

/// The CRC with one more byte.
#[inline(always)]
pub fn with<V: Value>(crc: Signal<V>, byte: Signal<V>) -> Signal<V> {
    let x = |k: u8| xor(crc.bits(8 + k, 1), byte.bits(k, 1));
    let y = |k: u8| if k < 4 { xor(x(k), x(k + 4)) } else { x(k) };
    word((0..16u8).map(|k| {
        let shifted = (k >= 8).then(|| crc.bits(k - 8, 1));
        let fed_back = [k.checked_sub(12), k.checked_sub(5), Some(k)];
        let fed_back = fed_back.into_iter().flatten().filter(|&k| k < 8).map(y);
        shifted.into_iter().chain(fed_back).reduce(xor).expect("every bit is fed back to")
    }))
}

#[cfg(test)]
mod tests {
    use super::*;
    use hapticore_hdl::signal::int;

    #[test]
    fn it_is_the_catalogue_s() {
        let theirs = crc::Crc::<u16>::new(&crc::CRC_16_IBM_3740);
        for text in ["123456789", "", "a", "\u{0}\u{0}", "END and ESC are \u{c0}\u{db}"] {
            let ours = text
                .bytes()
                .fold(begin::<i64>(), |crc, byte| with(crc, int(u64::from(byte)).bits(0, 8)));
            assert_eq!(ours.value, i64::from(theirs.checksum(text.as_bytes())), "{text:?}");
        }
    }

    #[test]
    fn its_own_bytes_make_it_zero() {
        let all = [0x31, 0x32, 0x33, 0x34, 0x35, 0x36, 0x37, 0x38, 0x39, 0x29, 0xb1];
        assert_eq!(
            all.into_iter().fold(begin::<i64>(), |crc, byte| with(crc, int(byte).bits(0, 8))).value,
            0
        );
    }
}
