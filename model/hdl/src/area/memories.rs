// SPDX-License-Identifier: MIT OR Apache-2.0
//! The block RAMs that synthesis makes of a memory, where LUTs as memory or logic do not cost less.
//!
//! ```text
//! cells = ⌈banks · bits / w⌉,  banks = ⌈words / 2^a⌉,  bits = the word's, in whole bytes      for a shape of 2^a words of w bits
//! cost  = price · cells + (banks > 1) · ½ · ((banks − 1) · word's bits + banks) + 2
//! ```
//!
//! A byte is what one write enable covers; a memory that is never written has none. In logic a bit costs 1,
//! and 1/16 where it is never written. Of shapes that cost the same the narrowest is taken. Source: Yosys
//! 0.70, `memory_libmap`, with the libraries of `synth_ice40` and `synth_ecp5`.

use crate::interpretations::netlist::Ram;

/// A kind of memory cell: its shapes, words and their bits, from the narrowest on.
struct Cell {
    shapes: &'static [(usize, usize)],
    price: f64,
    /// Bits of a byte; of a shape that is narrower, all.
    byte: usize,
}

/// The memory cells of a family.
struct Family {
    block: Cell,
    /// Not for memories that are never written.
    distributed: Option<Cell>,
}

/// Those of iCE40 and ECP5.
const FAMILIES: [Family; 2] = [
    Family {
        block: Cell { shapes: &[(2048, 2), (1024, 4), (512, 8), (256, 16)], price: 64.0, byte: 1 },
        distributed: None,
    },
    Family {
        block: Cell {
            shapes: &[(16384, 1), (8192, 2), (4096, 4), (2048, 9), (1024, 18), (512, 36)],
            price: 128.0,
            byte: 9,
        },
        distributed: Some(Cell { shapes: &[(16, 4)], price: 4.0, byte: 4 }),
    },
];

impl Cell {
    /// Number of cells, and their cost.
    fn takes(&self, words: usize, bits: usize, is_written: bool) -> (usize, f64) {
        let of_shape = |&(depth, width): &(usize, usize)| {
            let byte = if is_written { self.byte.min(width) } else { 1 };
            let banks = words.div_ceil(depth);
            let cells = (banks * bits.next_multiple_of(byte)).div_ceil(width);
            let read = (banks - 1) * bits;
            let write = if is_written && banks > 1 { banks } else { 0 };
            (cells, self.price * cells as f64 + 0.5 * (read + write) as f64 + 2.0)
        };
        let cheaper = |best: (usize, f64), of: (usize, f64)| if of.1 < best.1 { of } else { best };
        self.shapes.iter().map(of_shape).reduce(cheaper).expect("a cell has a shape")
    }
}

impl Family {
    fn block_rams(&self, ram: &Ram) -> usize {
        let (words, is_written) = (ram.initial.len(), ram.write.is_some());
        let bits = if is_written { ram.format.width.into() } else { columns(ram) };
        let (blocks, cost) = self.block.takes(words, bits, is_written);
        let of_logic = (words * bits) as f64 * if is_written { 1.0 } else { 1.0 / 16.0 };
        let distributed = self.distributed.as_ref().filter(|_| is_written);
        let of_luts = distributed.map(|cell| cell.takes(words, bits, is_written).1);
        // The least cost so far is kept as a whole number.
        let other = of_luts.filter(|cost| *cost < of_logic.floor()).unwrap_or(of_logic).floor();
        if ram.block || cost < other { blocks } else { 0 }
    }
}

/// Bits of a word that is never written, without those that are the same in all words.
fn columns(ram: &Ram) -> usize {
    let (set, clear) =
        ram.initial.iter().fold((0, 0), |(set, clear), word| (set | word, clear | !word));
    let differ = (set & clear) as u64 & (u64::MAX >> (64 - u32::from(ram.format.width)));
    differ.count_ones() as usize
}

/// Block RAMs of a memory on iCE40 and on ECP5.
pub(super) fn block_rams(ram: &Ram) -> [usize; 2] {
    FAMILIES.each_ref().map(|family| family.block_rams(ram))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::format::Format;
    use crate::interpretations::netlist::Node;
    use crate::memory::Collision;

    fn memory(words: usize, bits: u8, write: bool) -> Ram {
        let node = Node(0);
        let pattern = (0..words as i64).map(|word| word & ((1 << bits) - 1));
        Ram {
            name: "memory",
            format: Format::unsigned(bits, 0),
            collision: Collision::DontCare,
            block: false,
            initial: pattern.collect(),
            address: Some(node),
            write: write.then_some((node, node, node)),
        }
    }

    /// As Yosys 0.70 maps such memories, one by one.
    #[test]
    fn block_rams_are_those_of_synthesis() {
        let of = |words, bits, write| block_rams(&memory(words, bits, write));
        assert_eq!(of(256, 16, true), [1, 1]);
        assert_eq!(of(257, 16, true), [2, 1]);
        assert_eq!(of(32, 24, true), [2, 0], "LUTs as memory");
        assert_eq!(of(4, 4, true), [0, 0], "flip-flops");
        assert_eq!(of(16, 8, false), [0, 0], "a table as logic");
        assert_eq!(of(64, 6, false), [0, 0], "a longer table as logic");
        assert_eq!(of(2500, 24, true), [15, 4]);
        assert_eq!(of(512, 36, true), [5, 1]);
        let shortened = Ram { format: Format::unsigned(20, 0), ..memory(512, 16, false) };
        assert_eq!(block_rams(&shortened), [2, 1], "of 20 bits, 11 are always zero");
    }

    /// Cells and cost by the formula at the head, worked by hand.
    #[test]
    fn cells_and_their_cost() {
        let [ice40, ecp5] = &FAMILIES;
        assert_eq!(ice40.block.takes(256, 16, true), (1, 66.0));
        assert_eq!(ice40.block.takes(257, 16, true), (2, 130.0));
        assert_eq!(ice40.block.takes(2049, 2, true), (2, 0.5 * (2.0 + 2.0) + 130.0));
        assert_eq!(ice40.block.takes(2049, 2, false), (2, 0.5 * 2.0 + 130.0));
        assert_eq!(ecp5.block.takes(512, 36, true), (1, 130.0));
        // 11 cells of 16 bits cost the same: the narrower ones are taken.
        assert_eq!(ice40.block.takes(2591, 16, false), (12, 786.0));
        // At the same cost as flip-flops, 33 × 2 bits, there is no block.
        assert_eq!(
            (ice40.block.takes(33, 2, true).1, ice40.block_rams(&memory(33, 2, true))),
            (66.0, 0)
        );
        assert_eq!(ecp5.block.takes(512, 37, true), (2, 258.0), "a byte has nine bits");
        let distributed = ecp5.distributed.as_ref().expect("it has some");
        assert_eq!(distributed.takes(16, 4, true), (1, 6.0));
        assert_eq!(distributed.takes(32, 5, true), (4, 4.0 * 4.0 + 0.5 * (5.0 + 2.0) + 2.0));
    }

    #[test]
    fn bits_that_are_the_same_in_all_words_take_no_memory() {
        let table = |initial: &[i64], bits| Ram {
            initial: initial.to_vec(),
            format: Format::signed(bits, 0),
            ..memory(1, bits, false)
        };
        assert_eq!(columns(&table(&[0b0101, 0b0110, 0b0100], 4)), 2);
        assert_eq!(columns(&table(&[-1, 0], 5)), 5);
        assert_eq!(columns(&table(&[-1, -1], 5)), 0);
    }

    #[test]
    fn a_memory_may_ask_for_a_block() {
        let small = Ram { block: true, ..memory(16, 8, true) };
        assert_eq!(block_rams(&small), [1, 1]);
    }
}
