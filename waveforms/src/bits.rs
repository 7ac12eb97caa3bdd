// SPDX-License-Identifier: MIT OR Apache-2.0
//! Codes as the binary digits that both file formats want.

/// The eight digits of every byte: a code is spelled a byte at a time.
const DIGITS: [[u8; 8]; 256] = digits_of_bytes();

const fn digits_of_bytes() -> [[u8; 8]; 256] {
    let mut table = [[b'0'; 8]; 256];
    let mut byte = 0;
    while byte < 256 {
        let mut bit = 0;
        while bit < 8 {
            table[byte][bit] += (byte >> (7 - bit) & 1) as u8;
            bit += 1;
        }
        byte += 1;
    }
    table
}

/// The low `width` bits of `code`: two's complement of a negative one.
pub(crate) fn masked(code: i64, width: u8) -> u64 {
    code as u64 & (u64::MAX >> (64 - width))
}

/// All 64 digits of `bits`, most significant first.
pub(crate) fn digits(bits: u64) -> [u8; 64] {
    let mut text = [0; 64];
    for (eight, byte) in text.chunks_exact_mut(8).zip(bits.to_be_bytes()) {
        eight.copy_from_slice(&DIGITS[usize::from(byte)]);
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn digits_are_those_of_the_formatter() {
        for code in [0, 1, -1, 0x5aa5, i64::MIN, i64::MAX, -0x1234_5678] {
            for width in [1, 7, 8, 9, 63] {
                let bits = masked(code, width);
                assert_eq!(std::str::from_utf8(&digits(bits)).unwrap(), format!("{bits:064b}"));
                assert!(bits < 1 << width);
            }
        }
    }
}
