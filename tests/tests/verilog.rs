// SPDX-License-Identifier: MIT OR Apache-2.0
//! Names in the printed Verilog that are words of the language.

use hapticore_hdl::block::{Block, Interpretation, State};
use hapticore_hdl::format::Format;
use hapticore_hdl::memory::Memory;
use hapticore_hdl::verilog::Design;

hapticore_hdl::block! {
    /// A block whose memory has a name that is a word of Verilog.
    struct Keeper("keeper") {}
    submodules {
        table: Memory,
    }
    inputs(keeper) {
        address: keeper.table.address(),
    }
    outputs(keeper) {
        word: keeper.table.format,
    }
    registers(keeper) {}
}

impl Block for Keeper {
    fn clock<V: Interpretation>(&self, state: &mut State<Self, V>, i: In<V>) -> Out<V> {
        let word = self.table.data(&mut state.submodules.table);
        self.table.read(&mut state.submodules.table, i.address);
        Outputs { word }
    }
}

#[test]
fn a_memory_named_by_a_word_of_the_language_has_one_other_name_throughout() {
    let table = Memory::table("table", Format::unsigned(4, 0), (0..8).map(f64::from).collect());
    let text = &Design::of(&Keeper { table }, "a test").modules[0].text;
    assert!(text.contains("reg [3:0] table_2 [0:7]") && text.contains("table_2[0] = "), "{text}");
    let words = text.split(|letter: char| !(letter.is_alphanumeric() || letter == '_'));
    assert_eq!(words.filter(|word| *word == "table").count(), 0, "{text}");
}
