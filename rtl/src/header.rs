// SPDX-License-Identifier: MIT OR Apache-2.0
//! What a bench of the core must know, as `localparam`s to be included within its module: widths of
//! the ports, counts, and the binary points of a frame's words.

use std::fmt::Write;

use hapticore_contract::frame::Field;
use hapticore_contract::profile::{Profile, ProfileError};
use hapticore_model::blocks::core::Core;
use hapticore_model::blocks::force_loop::ForceLoop;

use hapticore_hdl::verilog::{Design, Heading, PREFIX};

use crate::board::drive_output::{Converter, DriveOutput, STALE_MS, Wave};
use crate::board::framing::digest;
use crate::netlist;

/// The file's name.
pub const NAME: &str = "hapticore.vh";

/// The words of a frame, in the order of [`Field::ALL`].
const FIELDS: [&str; Field::ALL.len()] =
    ["R_X", "R_Y", "X", "Y", "SHEET", "CAPACITANCE", "FORCE", "MEAN_SQUARE"];

/// What the names of a profile's modules begin with, so that cores of two profiles may stand in one design: letters, digits
/// and underscores of the profile's name.
pub fn prefix(profile: &Profile) -> String {
    let letter = |letter: char| if letter.is_ascii_alphanumeric() { letter } else { '_' };
    format!("{PREFIX}_{}", profile.name.chars().map(letter).collect::<String>())
}

/// Prints the core of a profile, with its force controller where it has one, as `hapticore hdl
/// --profile` does.
///
/// # Panics
/// Where a controller cannot be; [`hapticore_model::check`] says why.
pub fn design(profile: &Profile) -> Design {
    let core = Core::new(profile);
    let mut heading = Heading {
        command: format!("hapticore hdl --profile {}", profile.name),
        source: source(profile),
        interface: interface(&core, profile),
        prefix: prefix(profile),
    };
    if let Some(control) = &profile.control {
        let force_loop = ForceLoop::try_new(profile).unwrap_or_else(|error| panic!("{error}"));
        heading.command += &format!(" --control {}", control.law.name());
        heading.interface.extend(interface_of_loop(&force_loop, profile));
    }
    let netlist = netlist::of_profile(profile).unwrap_or_else(|error| panic!("{error}"));
    Design::print(&netlist, heading)
}

/// Prints the drive output of a profile's force loop, as `hapticore hdl --dac` does beside the loop.
///
/// # Errors
/// A profile without a controller, or more pads than the converter has channels.
pub fn drive_output(
    profile: &Profile,
    wave: Wave,
    converter: Converter,
    clock_hz: u64,
    options: &str,
) -> Result<Design, ProfileError> {
    let output = DriveOutput::of_profile(profile, wave, converter, clock_hz)?;
    let interface = [
        format!("- drive_valid, drive_pad, drive, serve, closed, *_fault: the outputs of {}_loop of these names; enable: not its clear.", prefix(profile)),
        format!("- drives_clear: no drive word came in time, all channels go to zero; to the input of {}_loop of this name.", prefix(profile)),
        "- dac_*: pins of the converter; words are magnitudes, 0 is 0 V; dac_polarity: the sign of each channel's amplifier.".into(),
        "- dac_live: the converter is set up, and nothing is off; gate the high voltage with it.".into(),
        format!("- clock: {clock_hz} Hz; drive words that cease are zero after {STALE_MS} ms at most."),
        format!("- converter: {}.", converter.dac().advice()),
    ];
    let law = profile.control.as_ref().map(|control| control.law.name());
    let law = law.map_or(String::new(), |law| format!(" --control {law}"));
    let heading = Heading {
        command: format!("hapticore hdl --profile {}{law} {options}", profile.name),
        source: source(profile),
        interface: interface.to_vec(),
        prefix: prefix(profile),
    };
    Ok(Design::of(&output, heading))
}

/// What a user of the force loop must know besides.
fn interface_of_loop(force_loop: &ForceLoop, profile: &Profile) -> Vec<String> {
    let mut lines = vec![
        format!("- drive_valid: a drive word, {} cycles after its slot's last strobe.", force_loop.latency()),
        "- target_write, target_pad, target_word: a pad's target, taken as its slot's estimate is given; a sign of life.".into(),
        "- curve_write, curve_address, curve_word: a word of the curve per cycle, while no drive word is being made.".into(),
        "- proportional, correction, full_drive, rail, slew, force_cap: taken as a slot's estimate is given.".into(),
        "- tick: one cycle every millisecond, of which a silent host is missed after so many; without ticks nothing is driven.".into(),
        "- clear, drives_clear, enable low, a fault: every drive is zero in the same cycle and begins at zero; clear takes targets and walls, too.".into(),
        format!(
            "- full_drive: one over MEAN_SQUARE at a drive of full scale V_drive: (V_adc/V_drive)²/{:.6}.",
            profile.square_gain()
        ),
        "- least_drive to most_force: of all pads, of valid estimates since extremes_read.".into(),
    ];
    if let Some(split_pad) = &force_loop.drives.split_pad {
        let parts = split_pad.parts();
        lines.extend([
            format!("- pads are split: {parts} slots in a row make a frame of one; its targets, walls and drive words bear the number of the last."),
            "- wall_write, wall_pad, wall_surface, wall_right: a pad's wall; wall_stiffness, wall_most, wall_factory: taken as settings are.".into(),
        ]);
    }
    lines
}

/// The versions of what a design is made from.
pub fn source(profile: &Profile) -> String {
    format!(
        "hapticore {}, profile {}, digest {:04x}",
        env!("CARGO_PKG_VERSION"),
        profile.name,
        digest(profile)
    )
}

/// What a user of the core must know besides its ports.
fn interface(core: &Core, profile: &Profile) -> Vec<String> {
    let (clocks, codes) = (profile.clocks_per_sample, core.demodulator().least_clocks_per_sample());
    let mut lines: Vec<String> = vec![
        String::new(),
        "Interface".into(),
        format!("- strobe: one cycle for each set of ADC codes; at least {clocks} cycles from one to the next, else overrun."),
        "- code: the code of the channel that `channel` named one cycle earlier, of the set announced by the last strobe;".into(),
        format!("  a set is read from the strobe's cycle on, and is stable for {codes} cycles."),
        format!("- channels 0 to {}: terminals, sensing voltage, haptic voltage.", profile.channels() - 1),
        format!("- slots of {} samples, pad after pad; a frame follows its slot's last strobe by at most {} cycles.", profile.slot.samples(), core.latency()),
        "- capacitance_gain, force_gain, contact_capacitance: stable from a slot's last strobe to its frame's `done`.".into(),
        "- write, address, word: a word of the position table per cycle; a slot that is estimated meanwhile gives a frame of".into(),
        "  neither table. Reset does not clear the table.".into(),
        "- frame words, in the order of `index`, as two's complement integers whose least significant bit is 2^-fraction:".into(),
    ];
    for (index, (field, name)) in (0..).zip(Field::ALL.into_iter().zip(FIELDS)) {
        let format = field.format(profile);
        lines.push(format!("  {index} {name:<12} {format} (fraction {})", format.frac));
    }
    lines.push(format!(
        "- MEAN_SQUARE: {:.6} times the mean of V²/V_adc², V the haptic voltage, V_adc the full scale of its ADC channel.",
        profile.square_gain()
    ));
    lines
}

/// The text of [`NAME`] for a core.
pub fn of_core(profile: &Profile, design: &Design) -> String {
    let mut text = format!(
        "// For benches of the core of profile {}: to be included within a module.\n\
         // Generated by `hapticore hdl`; do not edit.\n",
        profile.name
    );
    let mut parameter = |name: &str, value: i64, about: &str| {
        writeln!(text, "localparam HAPTICORE_{name} = {value}; // {about}")
            .expect("a string takes all");
    };
    parameter("PADS", profile.pads as i64, "served in turn");
    parameter(
        "CHANNELS",
        profile.channels() as i64,
        "of the ADC: terminals, sensing voltage, haptic voltage",
    );
    parameter("CLOCKS_PER_SAMPLE", profile.clocks_per_sample as i64, "from one strobe to the next");
    parameter("SLOT_SAMPLES", profile.slot.samples() as i64, "of a pad's slot");
    parameter(
        "LATENCY",
        Core::new(profile).latency() as i64,
        "clocks from a slot's last strobe to its frame's last word",
    );
    let table = Core::new(profile).estimator().table().words;
    parameter("TABLE_WORDS", table as i64, "of the position table");
    for port in &design.ports {
        parameter(
            &format!("{}_BITS", port.name.to_uppercase()),
            port.format.width.into(),
            "of the port",
        );
    }
    for (index, (field, name)) in (0..).zip(Field::ALL.into_iter().zip(FIELDS)) {
        let format = field.format(profile);
        parameter(&format!("FRAME_{name}"), index, "the word's index in a frame");
        parameter(
            &format!("FRAME_{name}_FRAC"),
            format.frac.into(),
            "bits behind its binary point",
        );
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_there_once() {
        let profile = Profile::bundled("small").expect("bundled");
        let text = of_core(&profile, &design(&profile));
        let names =
            text.lines().filter_map(|line| line.strip_prefix("localparam ")?.split(' ').next());
        let names: Vec<_> = names.collect();
        let mut distinct = names.clone();
        distinct.sort_unstable();
        distinct.dedup();
        assert_eq!(distinct.len(), names.len());
        assert!(
            text.contains("localparam HAPTICORE_CODE_BITS = 16;")
                && text.contains("HAPTICORE_FRAME_X = 2;"),
            "{text}"
        );
    }
}
