// SPDX-License-Identifier: MIT OR Apache-2.0
//! Where rust-hdl 0.46's simulation and its Verilog disagree in silence. Each must be seen by the
//! harness: these are tests of it, and the reason why no arithmetic of this project is written in
//! rust-hdl's kernels.

use crate::harness::{Design, Ports, mismatch};
use rust_hdl_core::prelude::*;
use std::process::Command;

/// A kernel of two words in and one out.
macro_rules! kernel {
    ($(#[$meta:meta])* $name:ident: $in_type:ty, $width:literal => $out_type:ty, $out_width:literal;
        set $set:expr; get $get:expr; $($update:tt)*) => {
        $(#[$meta])*
        #[derive(LogicBlock, Default)]
        struct $name {
            a: Signal<In, $in_type>,
            b: Signal<In, $in_type>,
            y: Signal<Out, $out_type>,
        }

        impl Logic for $name {
            $($update)*
        }

        impl Design for $name {
            const PORTS: (Ports, Ports) =
                (&[("a", $width), ("b", $width)], &[("y", $out_width)]);

            fn set(&mut self, inputs: &[u64]) {
                let set: fn(u64) -> $in_type = $set;
                (self.a.next, self.b.next) = (set(inputs[0]), set(inputs[1]));
            }

            fn get(&self) -> Vec<u64> {
                let get: fn($out_type) -> u64 = $get;
                vec![get(self.y.val())]
            }
        }
    };
}

kernel! {
    /// Prints a 16-bit product, which Verilog then widens: the high bits are gone.
    Product: Signed<16>, 16 => Signed<40>, 40;
    set |word| signed_cast(bits(word)); get |y| unsigned_cast(y).to_u64();
    #[hdl_gen]
    fn update(&mut self) {
        self.y.next = signed_bit_cast::<40, 32>(self.a.val() * self.b.val());
    }
}

kernel! {
    /// Compares with an unsigned zero: nothing is less.
    Negative: Signed<16>, 16 => Bit, 1;
    set |word| signed_cast(bits(word)); get |y| y.into();
    #[hdl_gen]
    fn update(&mut self) {
        self.y.next = self.a.val() < 0.into();
    }
}

kernel! {
    /// Loses the extension by the sign.
    Extended: Signed<8>, 8 => Bits<16>, 16;
    set |word| signed_cast(bits(word)); get |y| y.to_u64();
    #[hdl_gen]
    fn update(&mut self) {
        self.y.next = unsigned_cast(signed_bit_cast::<16, 8>(self.a.val()));
    }
}

kernel! {
    /// Rust binds `&` tighter than `==`, Verilog looser; the parentheses are not printed.
    Masked: Bits<8>, 8 => Bit, 1;
    set |word| bits(word); get |y| y.into();
    #[hdl_gen]
    fn update(&mut self) {
        self.y.next = self.a.val() & self.b.val() == 3;
    }
}

kernel! {
    /// Rust drops the carry of the 8-bit sum, Verilog's context keeps it.
    Halved: Bits<8>, 8 => Bits<16>, 16;
    set |word| bits(word); get |y| y.to_u64();
    #[hdl_gen]
    fn update(&mut self) {
        self.y.next = bit_cast::<16, 8>(self.a.val() + self.b.val()) >> 1;
    }
}

kernel! {
    /// No trap: what the harness must find alike.
    Sum: Bits<8>, 8 => Bits<8>, 8;
    set |word| bits(word); get |y| y.to_u64();
    #[hdl_gen]
    fn update(&mut self) {
        self.y.next = self.a.val() + self.b.val();
    }
}

/// Pairs of 16 bits, cut to a width, none the most negative: that is a trap of its own.
fn pairs(width: usize) -> Vec<Vec<u64>> {
    let mask = (1u64 << width) - 1;
    let word = |k: u64| (k * 40_503 + 77) >> 4 & mask;
    let avoid = |word: u64| if word == 1 << (width - 1) { word + 1 } else { word };
    (0..200).map(|k| vec![avoid(word(k)), avoid(word(k * 31 + 5))]).collect()
}

/// Holds that the harness sees the trap, and says what it saw.
fn caught<D: Design + Default>(width: usize) {
    let seen = mismatch(D::default(), &pairs(width)).expect("the harness sees the trap");
    println!("{seen}");
}

#[test]
#[cfg_attr(not(tool = "iverilog"), ignore = "needs iverilog: ./test fetches what is missing")]
fn a_product_that_is_widened_is_caught() {
    caught::<Product>(16);
}

#[test]
#[cfg_attr(not(tool = "iverilog"), ignore = "needs iverilog: ./test fetches what is missing")]
fn a_sign_compared_without_sign_is_caught() {
    caught::<Negative>(16);
}

#[test]
#[cfg_attr(not(tool = "iverilog"), ignore = "needs iverilog: ./test fetches what is missing")]
fn an_extension_without_sign_is_caught() {
    caught::<Extended>(8);
}

#[test]
#[cfg_attr(not(tool = "iverilog"), ignore = "needs iverilog: ./test fetches what is missing")]
fn parentheses_lost_are_caught() {
    caught::<Masked>(8);
}

#[test]
#[cfg_attr(not(tool = "iverilog"), ignore = "needs iverilog: ./test fetches what is missing")]
fn a_carry_kept_is_caught() {
    caught::<Halved>(8);
}

#[test]
#[cfg_attr(not(tool = "iverilog"), ignore = "needs iverilog: ./test fetches what is missing")]
fn what_is_alike_is_found_alike() {
    assert_eq!(mismatch(Sum::default(), &pairs(8)), None);
}

/// Not a test of its own: it ends the process.
#[test]
#[ignore = "overflows the stack, as the test below expects of a process of its own"]
fn widen_the_most_negative() {
    let most_negative: Signed<8> = signed_cast(bits(0x80));
    println!("{:?}", signed_bit_cast::<16, 8>(most_negative));
}

#[test]
fn the_most_negative_code_overflows_the_stack() {
    let tests = std::env::current_exe().expect("this very program");
    let alone = ["--exact", "traps::widen_the_most_negative", "--ignored", "--nocapture"];
    let output = Command::new(tests).args(alone).output().expect("it runs");
    let log = String::from_utf8_lossy(&output.stderr);
    assert!(
        !output.status.success() && log.contains("overflowed its stack"),
        "{}: {log}",
        output.status
    );
}
