// SPDX-License-Identifier: MIT OR Apache-2.0
//! How GTKWave shows a signal: flags, bit ranges, fixed points.

use hapticore_hdl::format::Format;

use crate::declarations::{Encoding, Signal};
use crate::view::Style;

/// Bits of a trace's flags line.
pub(crate) mod flag {
    pub(crate) const HEX: u64 = 1 << 1;
    pub(crate) const DECIMAL: u64 = 1 << 2;
    pub(crate) const BINARY: u64 = 1 << 3;
    pub(crate) const RIGHT_JUSTIFY: u64 = 1 << 5;
    pub(crate) const BLANK: u64 = 1 << 9;
    pub(crate) const SIGNED: u64 = 1 << 10;
    pub(crate) const FILE_TRANSLATE: u64 = 1 << 13;
    pub(crate) const ANALOG_STEP: u64 = 1 << 15;
    pub(crate) const INTERPOLATED: u64 = 1 << 16;
    pub(crate) const STRETCH: u64 = 1 << 17;
    pub(crate) const REAL: u64 = 1 << 18;
    pub(crate) const CLOSED: u64 = 1 << 22;
    pub(crate) const GROUP_BEGIN: u64 = 1 << 23;
    pub(crate) const GROUP_END: u64 = 1 << 24;
    pub(crate) const FIXED_POINT: u64 = 1 << 30;
}

/// The least integer bits (the most leading zeros of a fraction) with which numbers are shown as
/// fixed point.
const LEAST_INTEGER_BITS: i16 = -8;

/// The path as GTKWave spells it: with the bit range of a vector.
pub(crate) fn viewer_path(signal: &Signal) -> String {
    match signal.encoding.width() {
        Some(width @ 2..) => format!("{}[{}:0]", signal.path(), width - 1),
        _ => signal.path(),
    }
}

/// The bits after the point, where the viewer is to put one.
pub(crate) fn fixed_point(encoding: &Encoding, style: Style) -> Option<i8> {
    match (encoding, style) {
        (_, Style::Hex | Style::Binary) => None,
        (Encoding::Code(format), _) if is_fixed_point(*format) => Some(format.frac),
        _ => None,
    }
}

fn is_fixed_point(format: Format) -> bool {
    (1..63).contains(&format.frac)
        && format.width > 1
        && format.integer_bits() >= LEAST_INTEGER_BITS
}

/// Instances that a row's name begins with, beside the signal's own.
const NAMED_INSTANCES: usize = 2;

/// What a row is called: the signal behind its block, without the instances above; and what the values shown are worth,
/// where they alone do not say so.
pub(crate) fn alias(signal: &Signal) -> String {
    let instances = signal.scope.iter().map(|scope| scope.strip_prefix("u_").unwrap_or(scope));
    let skipped = signal.scope.len().saturating_sub(NAMED_INSTANCES);
    let blocks: Vec<_> = instances.skip(skipped).skip_while(|name| *name == BENCH).collect();
    // GTKWave shows what is behind the last dot.
    let name = format!("{}/{}", blocks.join("/"), signal.name);
    match &signal.encoding {
        Encoding::Real(unit) if !unit.is_empty() => format!("{name} ({unit})"),
        Encoding::Code(format) if format.frac != 0 && !is_fixed_point(*format) => {
            format!("{name} (2^{})", -i16::from(format.frac))
        }
        _ => name,
    }
}

/// The scope around a core, which says nothing in a row's name.
const BENCH: &str = "bench";

/// The flags of a trace.
pub(crate) fn flags(encoding: &Encoding, style: Style) -> u64 {
    let curve = match style {
        Style::Step => flag::ANALOG_STEP,
        Style::Line => flag::INTERPOLATED,
        Style::Number | Style::Hex | Style::Binary => 0,
    };
    let point = if fixed_point(encoding, style).is_some() { flag::FIXED_POINT } else { 0 };
    flag::RIGHT_JUSTIFY | curve | point | radix(encoding, style)
}

fn radix(encoding: &Encoding, style: Style) -> u64 {
    match (encoding, style) {
        (Encoding::Real(_), _) => flag::REAL,
        (_, Style::Hex) => flag::HEX,
        (_, Style::Binary) => flag::BINARY,
        (Encoding::State(..), Style::Number) => flag::DECIMAL | flag::FILE_TRANSLATE,
        (Encoding::Code(format) | Encoding::State(format, _), _) if format.signed => {
            flag::DECIMAL | flag::SIGNED
        }
        _ => flag::DECIMAL,
    }
}
