// SPDX-License-Identifier: MIT OR Apache-2.0
//! The ranges of a profile's values, by themselves and against each other.
//!
//! Absent: whether a core's signals and clocks suffice, which only its blocks know
//! (`hapticore_model::check`).

use super::{ForceLaw, Method, Profile, ProfileError};
use crate::calibration::Layout;
use crate::control::Control;
use hapticore_hdl::format::Format;
use std::fmt::Display;

type Check = Result<(), ProfileError>;

pub(super) fn ensure(holds: bool, field: &str, expected: impl Display, got: impl Display) -> Check {
    if holds { Ok(()) } else { Err(ProfileError::value(field, expected, got)) }
}

pub(super) fn within(field: &str, value: u64, low: u64, high: u64) -> Check {
    ensure((low..=high).contains(&value), field, format_args!("{low} to {high}"), value)
}

impl Profile {
    /// Checks every value against its range, and values against each other; [`Profile::parse`] has
    /// done so.
    ///
    /// Whether a core can be built is asked of the core: `hapticore_model::check`, which begins
    /// with this.
    ///
    /// # Errors
    /// The first value that is out of its range, with its key.
    pub fn check_values(&self) -> Check {
        within("pads", self.pads, 1, 256)?;
        within("multiplier", self.multiplier.into(), 8, 64)?;
        self.check_terminals()?;
        self.check_formats()?;
        self.check_position()?;
        self.check_wall()?;
        self.check_slot()?;
        self.control.as_ref().map_or(Ok(()), Control::check)
    }

    fn check_terminals(&self) -> Check {
        let (x, y) = (&self.terminals.x, &self.terminals.y);
        within("terminals.x", x.len() as u64, 3, 16)?;
        ensure(
            y.len() == x.len(),
            "terminals.y",
            format_args!("{} signs, as terminals.x has", x.len()),
            y.len(),
        )?;
        for (field, signs) in [("terminals.x", x), ("terminals.y", y)] {
            ensure(
                signs.iter().all(|sign| (-1..=1).contains(sign)),
                field,
                "signs -1, 0 or 1",
                format_args!("{signs:?}"),
            )?;
            ensure(
                signs.contains(&1) && signs.contains(&-1),
                field,
                "both signs",
                format_args!("{signs:?}"),
            )?;
        }
        ensure(
            x != y,
            "terminals.y",
            "signs other than those of terminals.x",
            format_args!("{y:?}"),
        )
    }

    fn check_slot(&self) -> Check {
        let (samples, periods, windows) =
            (self.slot.integrate, self.carrier.periods, self.haptic.windows);
        within(
            "clocks_per_sample",
            self.clocks_per_sample,
            self.least_clocks_per_sample(),
            1 << 16,
        )?;
        ensure(
            windows.is_power_of_two() && windows <= 64,
            "haptic.windows",
            "a power of two, 64 at most",
            windows,
        )?;
        within("slot.open", self.slot.open, 1, 1 << 20)?;
        within("slot.settle", self.slot.settle, 0, 1 << 20)?;
        within("slot.integrate", samples, 8, 1 << 16)?;
        within("carrier.periods", periods, 2, samples / 3)?;
        let most = self.formats.oscillator.max_code() as u64;
        within("carrier.amplitude", self.carrier.amplitude, most / 2, most)?;
        match self.carrier.method {
            Method::Products => ensure(
                samples.is_multiple_of(4),
                "slot.integrate",
                "a multiple of four samples",
                samples,
            ),
            Method::Polyphase => self.check_polyphase(),
        }
    }

    /// Five sums of the window's values, one per phase of the carrier, must be the same: what a
    /// constant makes of them then leaves nothing.
    fn check_polyphase(&self) -> Check {
        let samples = self.slot.integrate;
        let expected =
            format_args!("five samples of each of {} periods", self.carrier.periods).to_string();
        ensure(samples == 5 * self.carrier.periods, "slot.integrate", expected, samples)?;
        let begins = self.slot.blanking();
        ensure(
            begins.is_multiple_of(5),
            "slot.settle",
            "whole periods of five samples before the window",
            begins,
        )?;
        let f = &self.formats;
        ensure(
            f.adc == Format::signed(16, 15),
            "formats.adc",
            "s16.15, with carrier.method polyphase",
            f.adc,
        )?;
        let waves = Format::signed(17, 16);
        ensure(
            f.oscillator == waves,
            "formats.oscillator",
            "s17.16, with carrier.method polyphase",
            f.oscillator,
        )
    }

    fn check_position(&self) -> Check {
        let position = &self.position;
        for (field, side) in
            [("position.columns", position.columns), ("position.rows", position.rows)]
        {
            within(field, side, 5, 2 * Layout::CELLS as u64 + 1)?;
            ensure(!side.is_multiple_of(2), field, "an odd number", side)?;
        }
        within("position.resistance_shift", position.resistance_shift.into(), 1, 4)?;
        within("position.steps", position.steps, 1, 15)?;
        let f = &self.formats;
        ensure((12..=27).contains(&f.table.width), "formats.table", "12 to 27 bits", f.table)?;
        let as_wide = f.position.width == f.table.width;
        ensure(as_wide, "formats.position", "as many bits as formats.table", f.position)?;
        let words = Layout::new(self).words();
        let most = f.table.max_code().min(1 << 14) as usize;
        ensure(
            words <= most,
            "position.columns",
            format!("a table of {most} words at most"),
            format_args!("{words}"),
        )
    }

    fn check_formats(&self) -> Check {
        let f = &self.formats;
        for (name, format) in [
            ("adc", f.adc),
            ("oscillator", f.oscillator),
            ("iq", f.iq),
            ("total", f.total),
            ("ratio", f.ratio),
            ("table", f.table),
            ("position", f.position),
        ] {
            ensure(format.signed, &format!("formats.{name}"), "a signed format", format)?;
        }
        for (name, format) in [("adc", f.adc), ("oscillator", f.oscillator), ("table", f.table)] {
            let fraction = format.integer_bits() == 0 && (4..=24).contains(&format.width);
            ensure(
                fraction,
                &format!("formats.{name}"),
                "a fraction of 4 to 24 bits, such as s18.17",
                format,
            )?;
        }
        for (name, format) in [("iq", f.iq), ("total", f.total)] {
            let sound = (4..=30).contains(&format.width) && format.frac >= 0;
            ensure(
                sound,
                &format!("formats.{name}"),
                "4 to 30 bits with a point among them",
                format,
            )?;
        }
        let wide = f.iq.width + f.block_shift.min(63);
        ensure(
            wide <= 40,
            "formats.block_shift",
            format_args!("at most 40 bits with those of iq, {}", f.iq),
            wide,
        )?;
        let same_point = f.total.frac == f.iq.frac && f.total.width >= f.iq.width;
        let moved = f.block_shift > 0 && f.total.frac <= f.iq.frac;
        let expected = format_args!("the point of iq, {}, and no fewer bits", f.iq);
        ensure(same_point || moved, "formats.total", expected, f.total)?;
        let squared = f.block_shift == 0 || f.total.width <= 28;
        ensure(squared, "formats.total", "28 bits at most, with formats.block_shift", f.total)?;
        let fine = f.ratio.frac + 1 >= f.table.frac;
        ensure(
            fine,
            "formats.ratio",
            format_args!("half of which is as fine as table, {}", f.table),
            f.ratio,
        )?;
        ensure(
            f.ratio.integer_bits() == 1,
            "formats.ratio",
            "one integer bit, such as s20.18",
            f.ratio,
        )?;
        ensure((4..=30).contains(&f.ratio.width), "formats.ratio", "4 to 30 bits", f.ratio)?;
        let sound = (8..=28).contains(&f.position.width) && f.position.frac >= 0;
        ensure(sound, "formats.position", "8 to 28 bits with a point among them", f.position)?;
        ensure(f.admittance.frac >= 0, "formats.admittance", "fractional bits", f.admittance)?;
        self.check_unsigned(f.admittance, "admittance")?;
        self.check_unsigned(f.capacitance, "capacitance")?;
        self.check_unsigned(f.mean_square, "mean_square")?;
        self.check_unsigned(f.square, "square")?;
        self.check_unsigned(f.force, "force")?;
        self.check_unsigned(f.capacitance_gain, "capacitance_gain")?;
        self.check_unsigned(f.force_gain, "force_gain")?;
        self.check_force()
    }

    /// Voltages are fractions of full scale; cells of the force table begin at whole picofarads.
    fn check_force(&self) -> Check {
        let voltage = self.force.voltage;
        ensure(
            !voltage.signed && voltage.integer_bits() == 0 && (8..=28).contains(&voltage.width),
            "force.voltage",
            "an unsigned fraction of 8 to 28 bits, such as u24.24",
            voltage,
        )?;
        let capacitance = self.formats.capacitance;
        let cells = (0..=22).contains(&capacitance.frac);
        ensure(
            self.force.law == ForceLaw::Eq8 || cells,
            "formats.capacitance",
            "0 to 22 fractional bits, with force.law table",
            capacitance,
        )
    }

    fn check_unsigned(&self, format: Format, name: &str) -> Check {
        let holds = !format.signed && format.width <= 28 && (-16..=48).contains(&format.frac);
        ensure(
            holds,
            &format!("formats.{name}"),
            "an unsigned format of at most 28 bits, such as u18.8",
            format,
        )
    }
}

impl Control {
    /// Checks every value against its range.
    ///
    /// # Errors
    /// The first value that is out of its range, with its key.
    pub fn check(&self) -> Result<(), ProfileError> {
        let ensure = |holds: bool, field: &str, expected: &str, got: String| {
            if holds { Ok(()) } else { Err(ProfileError::value(field, expected, got)) }
        };
        let Control { drive, target, gain, .. } = self;
        let fraction = !drive.signed && drive.integer_bits() == 0;
        ensure(
            fraction && (8..=20).contains(&drive.width),
            "control.drive",
            "an unsigned fraction of 8 to 20 bits, such as u16.16",
            drive.to_string(),
        )?;
        let sound = !target.signed
            && (8..=20).contains(&target.width)
            && (1..=4).contains(&target.integer_bits());
        ensure(
            sound,
            "control.target",
            "an unsigned format of 8 to 20 bits, 1 to 4 of them integer, such as u16.15",
            target.to_string(),
        )?;
        let sound = !gain.signed && (8..=20).contains(&gain.width) && gain.frac >= 0;
        ensure(
            sound && (1..=8).contains(&gain.integer_bits()),
            "control.gain",
            "an unsigned format of 8 to 20 bits, 1 to 8 of them integer, such as u16.13",
            gain.to_string(),
        )?;
        let most = 1 << (drive.width - 4).min(10);
        let cells = self.cells.is_power_of_two() && (4..=most).contains(&self.cells);
        let expected = format!("a power of two from 4 to {most}");
        ensure(cells, "control.cells", &expected, self.cells.to_string())?;
        within("control.invalid_frames", self.invalid_frames, 1, 1 << 20)?;
        // Of ticks, a part of the first is over when the host is heard.
        within("control.silent_ms", self.silent_ms, 2, 1000)
    }
}
