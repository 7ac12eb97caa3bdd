// SPDX-License-Identifier: MIT OR Apache-2.0
//! Profiles: word lengths, counts and timings of a core, at run time. The one place where a width
//! is written.
//!
//! A profile is TOML. `small`, `standard`, `fine` and `fast` are bundled; [`Profile::parse`] reads
//! any other, and nothing needs to be compiled again.

mod check;
mod wall;

pub use wall::{Release, Wall};

use crate::control::{Control, Law};
use hapticore_hdl::format::Format;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::fmt::Display;

/// A profile: every width, count and time of a core.
///
/// ```
/// use hapticore_contract::profile::Profile;
///
/// let profile = Profile::bundled("standard")?;
/// assert_eq!(profile.channels(), 8, "six terminals, the sensing and the haptic voltage");
/// assert_eq!(profile.slot_clocks(), profile.slot.samples() * profile.clocks_per_sample);
/// assert_eq!(profile.formats.adc.to_string(), "s18.17");
/// # Ok::<(), hapticore_contract::profile::ProfileError>(())
/// ```
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Profile {
    /// What it is called.
    pub name: String,
    /// Number of pads, selected in turn; with `[wall]` slots, a multiple of its `parts`.
    #[schemars(range(min = 1, max = 256))]
    pub pads: u64,
    /// Clocks of the core from one ADC sample to the next.
    #[schemars(range(min = 1, max = 65536))]
    pub clocks_per_sample: u64,
    /// The width of the words that a hardware multiplier of the part takes; wider products take two
    /// clocks.
    #[schemars(range(min = 8, max = 64))]
    pub multiplier: u8,
    /// The current sensors.
    pub terminals: Terminals,
    /// How a pad's slot is spent.
    pub slot: Slot,
    /// The sensing carrier.
    pub carrier: Carrier,
    /// Position from ratios.
    pub position: Position,
    /// Capacitance from currents.
    pub capacitance: Capacitance,
    /// The haptic voltage.
    #[serde(default)]
    pub haptic: Haptic,
    /// The force controller, where there is one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub control: Option<Control>,
    /// Virtual walls of split pads, where the core has them; they need a force controller.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub wall: Option<Wall>,
    /// Force from capacitance and haptic voltage.
    #[serde(default)]
    pub force: Force,
    /// Formats of the core's words; all other widths derive from them.
    pub formats: Formats,
}

/// The current sensors at the sheet's edge, and where they stand in eqs. 2 and 3.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Terminals {
    /// The sign of each terminal's current in the numerator of r_x.
    #[schemars(inner(range(min = -1, max = 1)))]
    pub x: Vec<i8>,
    /// The sign of each terminal's current in the numerator of r_y.
    #[schemars(inner(range(min = -1, max = 1)))]
    pub y: Vec<i8>,
}

/// How a pad's slot is spent, in ADC samples.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Slot {
    /// Samples with no pad driven, so that the switch before breaks first.
    #[schemars(range(min = 1, max = 1048576))]
    pub open: u64,
    /// Samples for the new pad to settle.
    #[schemars(range(min = 0, max = 1048576))]
    pub settle: u64,
    /// Samples of the demodulator's window.
    #[schemars(range(min = 8, max = 65536))]
    pub integrate: u64,
}

/// The sensing carrier, made by the core itself.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Carrier {
    /// Periods in a window. With no divisor in common with the window's samples every sample meets
    /// another phase, so that harmonics of the carrier stay off it and undithered rounding averages
    /// out.
    #[schemars(range(min = 2))]
    pub periods: u64,
    /// The code that stands for one: of the carrier's words where a sample is multiplied by them,
    /// else of the window's.
    pub amplitude: u64,
    /// How a channel's in-phase and quadrature sums are made.
    pub method: Method,
    /// The window function.
    pub window: Window,
}

/// How a channel's in-phase and quadrature sums are made.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Method {
    /// Each sample times the windowed cosine and sine: any number of periods.
    Products,
    /// Each sample times the window, summed by phase of a carrier of five samples per period;
    /// cosine and sine are applied to the five sums at the end of the window.
    Polyphase,
}

/// The window function.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Window {
    /// (1 − cos) / 2.
    Hann,
    /// Rectangular window, w = 1.
    Rectangular,
}

/// The position table and its inversion.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Position {
    /// Coefficients of a ratio's spline along the long edges; an odd number, so that one lies in
    /// the middle.
    #[schemars(range(min = 5, max = 65))]
    pub columns: u64,
    /// Coefficients along the short edges, likewise.
    #[schemars(range(min = 5, max = 65))]
    pub rows: u64,
    /// The resistance's cells are `2^resistance_shift` of the ratios' wide and high.
    #[schemars(range(min = 1, max = 4))]
    pub resistance_shift: u8,
    /// Newton steps per slot.
    #[schemars(range(min = 1, max = 15))]
    pub steps: u64,
}

/// Capacitance from currents.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Capacitance {
    /// Takes the sheet's resistance out (docs/physics.md §2); without it, eq. 6 alone.
    pub sheet_correction: bool,
}

/// The haptic voltage.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Haptic {
    /// Windows of a pad over which the mean square is taken: a power of two.
    #[schemars(range(min = 1, max = 64))]
    pub windows: u64,
}

/// The last window alone.
impl Default for Haptic {
    fn default() -> Self {
        Haptic { windows: 1 }
    }
}

/// Force from capacitance and haptic voltage.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Force {
    /// The law.
    pub law: ForceLaw,
    /// The format of the voltages that the table's law keeps; one is full scale.
    #[serde(default = "force_voltage")]
    pub voltage: Format,
}

/// The law by which force follows from capacitance and haptic voltage.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum ForceLaw {
    /// F = k·(C·V)² with one k (eq. 8).
    Eq8,
    /// Eq. 8 with k from a table of capacitance and past voltage (docs/physics.md §3).
    Table,
}

/// Eq. 8.
impl Default for Force {
    fn default() -> Self {
        Force { law: ForceLaw::Eq8, voltage: force_voltage() }
    }
}

/// So fine that a filter of 1.5 s at frames of 0.25 ms stands still within 1e-4 of full scale.
const fn force_voltage() -> Format {
    Format::unsigned(24, 24)
}

/// Word formats. Every other width of the core derives from these.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Formats {
    /// ADC codes; one is full scale. A signed fraction of 4 to 24 bits.
    pub adc: Format,
    /// Cosine, sine and window.
    pub oscillator: Format,
    /// In-phase and quadrature words of a channel; one is full scale.
    pub iq: Format,
    /// In-phase and quadrature words of the sum over all terminals.
    pub total: Format,
    /// Bits by which in-phase and quadrature words may be moved up, those of all terminals
    /// together, so that the largest fills its word; 0 leaves the point where it is. `total` is
    /// then the format of the amplitudes after that.
    pub block_shift: u8,
    /// The ratios of eqs. 2 and 3.
    pub ratio: Format,
    /// Words of the position table; all are fractions of 12 to 27 bits.
    pub table: Format,
    /// Positions, mm.
    pub position: Format,
    /// Total current over sensing voltage, the sheet's resistance taken out.
    pub admittance: Format,
    /// Capacitances, pF.
    pub capacitance: Format,
    /// Mean square of the haptic voltage; one is full scale squared.
    pub mean_square: Format,
    /// Intermediate words of the force: square picofarads.
    pub square: Format,
    /// Haptic forces, N.
    pub force: Format,
    /// Calibration: gain of the capacitance, pF at an admittance of 1.
    pub capacitance_gain: Format,
    /// Calibration: newtons per square picofarad at the full haptic mean square.
    pub force_gain: Format,
}

/// A profile that cannot be.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum ProfileError {
    /// The text is no profile.
    #[error("{0}")]
    Syntax(String),
    /// A value is out of its range.
    #[error("{field}: expected {expected}, got {got}")]
    Value {
        /// Key of the offending value, such as `slot.integrate`.
        field: String,
        /// What it may be.
        expected: String,
        /// The value found.
        got: String,
    },
    /// No bundled profile has this name.
    #[error("expected a file or a profile among {bundled}, got \"{name}\"", bundled = BUNDLED.map(|(name, _)| name).join(", "))]
    Unknown {
        /// Name that was asked for.
        name: String,
    },
}

impl ProfileError {
    /// A value of `field` other than what is expected.
    pub fn value(field: &str, expected: impl Display, got: impl Display) -> Self {
        ProfileError::Value {
            field: field.into(),
            expected: expected.to_string(),
            got: got.to_string(),
        }
    }
}

/// What an in-phase wave has for one under [`Method::Polyphase`]: its five values are integers over
/// 2^16, and this is the first of them.
pub const POLYPHASE_GAIN: f64 = 57230.0 / 65536.0;

/// Keys that are refused with a reason of their own.
const RETIRED: [(&str, &str); 2] = [
    (
        "control.folded",
        "expected no such key, whatever its value: no board can use a folded controller (the iCEBreaker has \
         no pins for a drive, the ULX3S runs at 25 MHz and needs none)",
    ),
    (
        "control.silent_frames",
        "expected control.silent_ms, milliseconds at any length of slots, 2 to 1000 (100 without the key)",
    ),
];

/// How the reader of TOML begins to refuse a key, of its last part.
fn unknown(key: &str) -> String {
    format!("unknown field `{}`", key.rsplit('.').next().unwrap_or(key))
}

/// The bundled profiles: their names and texts.
pub const BUNDLED: [(&str, &str); 4] = [
    ("small", include_str!("small.toml")),
    ("standard", include_str!("standard.toml")),
    ("fine", include_str!("fine.toml")),
    ("fast", include_str!("fast.toml")),
];

impl Profile {
    /// Reads a profile, and checks the ranges of its values.
    ///
    /// ```
    /// use hapticore_contract::profile::{BUNDLED, Profile};
    ///
    /// let (_, text) = BUNDLED[0];
    /// let wider = Profile::parse(&text.replace("pads = 4", "pads = 16"))?;
    /// assert_eq!(wider.pads, 16);
    ///
    /// let message = |text: &str| Profile::parse(text).unwrap_err().to_string();
    /// assert_eq!(message(&text.replace("pads = 4", "pads = 300")), "pads: expected 1 to 256, got 300");
    /// assert!(message(&text.replace("pads = 4", "pads = four")).starts_with("4: "), "the line is named");
    /// # Ok::<(), hapticore_contract::profile::ProfileError>(())
    /// ```
    ///
    /// # Errors
    /// Where the text is no profile, or a value is out of its range; the message names line or key.
    pub fn parse(text: &str) -> Result<Profile, ProfileError> {
        let profile: Profile = toml::from_str(text).map_err(|error| {
            let line = error
                .span()
                .map_or(1, |span| text[..span.start.min(text.len())].matches('\n').count() + 1);
            let message = error.message();
            let retired = RETIRED.iter().find(|(key, _)| message.starts_with(&unknown(key)));
            let said =
                retired.map_or(message.replace('\n', " "), |(key, why)| format!("{key}: {why}"));
            ProfileError::Syntax(format!("{line}: {said}"))
        })?;
        profile.check_values()?;
        Ok(profile)
    }

    /// A bundled profile.
    ///
    /// ```
    /// use hapticore_contract::profile::Profile;
    ///
    /// assert_eq!(Profile::bundled("small")?.pads, 4);
    /// let message = Profile::bundled("tiny").unwrap_err().to_string();
    /// assert_eq!(message, "expected a file or a profile among small, standard, fine, fast, got \"tiny\"");
    /// # Ok::<(), hapticore_contract::profile::ProfileError>(())
    /// ```
    ///
    /// # Errors
    /// Where none has the name.
    pub fn bundled(name: &str) -> Result<Profile, ProfileError> {
        let found = BUNDLED.iter().find(|(bundled, _)| *bundled == name);
        Profile::parse(found.ok_or_else(|| ProfileError::Unknown { name: name.into() })?.1)
    }

    /// All bundled profiles.
    pub fn all() -> Vec<Profile> {
        BUNDLED
            .iter()
            .map(|(_, text)| Profile::parse(text).expect("bundled profiles are tested"))
            .collect()
    }

    /// The bundled profiles of which no two compute with the same words: tests of arithmetic need no
    /// others.
    pub fn of_distinct_words() -> Vec<Profile> {
        let mut distinct: Vec<Profile> = Vec::new();
        for profile in Self::all() {
            if distinct.iter().all(|other| other.formats != profile.formats) {
                distinct.push(profile);
            }
        }
        distinct
    }

    /// Channels that are demodulated: the terminals and the sensing voltage.
    pub fn demodulated(&self) -> u64 {
        self.terminals.x.len() as u64 + 1
    }

    /// ADC channels: the terminals, the sensing voltage and the haptic voltage.
    pub fn channels(&self) -> usize {
        self.terminals.x.len() + 2
    }

    /// The fewest clocks from one sample to the next: in them a core asks for the code of every
    /// channel and has used the last.
    ///
    /// ```
    /// use hapticore_contract::profile::Profile;
    ///
    /// let mut profile = Profile::bundled("standard")?;
    /// assert_eq!(profile.least_clocks_per_sample(), 24, "six terminals");
    /// profile.terminals.x.extend([1, -1]);
    /// assert_eq!(profile.least_clocks_per_sample(), 28, "eight");
    /// # Ok::<(), hapticore_contract::profile::ProfileError>(())
    /// ```
    pub fn least_clocks_per_sample(&self) -> u64 {
        match self.carrier.method {
            Method::Products => 2 * self.demodulated() + 10,
            Method::Polyphase => self.demodulated() + 6,
        }
    }

    /// Whether a word of a block RAM goes into a register before anything is done with it. Parts with wide
    /// multipliers have quick clocks, of which a block RAM alone takes more than half (ECP5, speed 6: 5.8 of 10 ns).
    pub fn registers_block_rams(&self) -> bool {
        self.multiplier > 16
    }

    /// The core's clocks in a slot.
    pub fn slot_clocks(&self) -> u64 {
        self.slot.samples() * self.clocks_per_sample
    }

    /// The core's clocks from a pad's slot to its next.
    pub fn frame_clocks(&self) -> u64 {
        self.pads * self.slot_clocks()
    }
}

impl Control {
    /// A controller with words as wide as the profile's multipliers take in one product.
    ///
    /// ```
    /// use hapticore_contract::control::{Control, Law};
    /// use hapticore_contract::profile::Profile;
    ///
    /// let control = Control::of(&Profile::bundled("small")?, Law::Inverse);
    /// assert_eq!((control.drive.to_string(), control.target.to_string()), ("u15.15".into(), "u15.14".into()));
    /// # Ok::<(), hapticore_contract::profile::ProfileError>(())
    /// ```
    pub fn of(profile: &Profile, law: Law) -> Self {
        let width = profile.multiplier.clamp(9, 19) - 1;
        let frac = width as i8;
        Control {
            law,
            drive: Format::unsigned(width, frac),
            target: Format::unsigned(width, frac - 1),
            gain: Format::unsigned(width, frac - 3),
            cells: 64,
            invalid_frames: 8,
            silent_ms: Control::SILENT_MS,
        }
    }
}

impl Slot {
    /// Samples of the whole slot.
    pub fn samples(&self) -> u64 {
        self.open + self.settle + self.integrate
    }

    /// Samples before the window.
    pub fn blanking(&self) -> u64 {
        self.open + self.settle
    }
}

impl Window {
    /// The mean of the window function, 0 to 1.
    pub fn mean(self) -> f64 {
        match self {
            Window::Hann => 0.5,
            Window::Rectangular => 1.0,
        }
    }
}

impl Profile {
    /// The carrier's frequency, turns per sample.
    pub fn turns_per_sample(&self) -> f64 {
        self.carrier.periods as f64 / self.slot.integrate as f64
    }

    /// ADC samples in a period of the carrier.
    pub fn samples_per_period(&self) -> f64 {
        1.0 / self.turns_per_sample()
    }

    /// The profile with a window of another length, its carrier as near to what it was as whole
    /// periods are.
    ///
    /// ```
    /// use hapticore_contract::profile::Profile;
    ///
    /// let profile = Profile::bundled("small")?.with_window(250);
    /// assert_eq!((profile.slot.integrate, profile.carrier.periods, profile.samples_per_period()), (250, 50, 5.0));
    /// profile.check_values()?;
    /// # Ok::<(), hapticore_contract::profile::ProfileError>(())
    /// ```
    pub fn with_window(mut self, samples: u64) -> Self {
        self.carrier.periods = (self.turns_per_sample() * samples as f64).round() as u64;
        self.slot.integrate = samples;
        self
    }

    /// The number that the carrier's amplitude stands for.
    pub fn amplitude(&self) -> f64 {
        self.carrier.amplitude as f64 * self.formats.oscillator.lsb()
    }

    /// The mean of the window function over the samples of a window.
    pub fn window_mean(&self) -> f64 {
        self.carrier.window.mean() * self.amplitude()
    }

    /// The format of the sheet's resistance: a word of the position table that is never negative.
    pub fn sheet(&self) -> Format {
        let word = self.formats.table;
        Format::unsigned(word.width - 1, word.frac)
    }

    /// The format of the amplitudes of total current and sensing voltage. Each is the square root
    /// of two squares of a total's word: one more bit than the word without its sign and one for
    /// the square root's rounding.
    pub fn amplitude_format(&self) -> Format {
        Format::unsigned(self.formats.total.width + 1, self.formats.total.frac)
    }

    /// Bits by which the demodulator's sums are scaled down, so that a full-scale tone is a little
    /// below one.
    pub fn sum_shift(&self) -> i8 {
        shift(self.slot.integrate as f64 * self.carrier.window.mean() / 2.0)
    }

    /// Bits by which the sum of squares is scaled down, so that a full-scale square wave is a
    /// little below one.
    pub fn square_shift(&self) -> i8 {
        shift(self.slot.integrate as f64 * self.carrier.window.mean())
    }

    /// What an in-phase word is for a tone at full scale.
    pub fn tone_gain(&self) -> f64 {
        let wave = match self.carrier.method {
            Method::Products => self.amplitude(),
            Method::Polyphase => POLYPHASE_GAIN,
        };
        self.slot.integrate as f64 * self.window_mean() * wave / 2.0
            * 2f64.powi(-i32::from(self.sum_shift()))
    }

    /// What the mean square's word is for a constant at full scale.
    pub fn square_gain(&self) -> f64 {
        self.slot.integrate as f64 * self.window_mean() * 2f64.powi(-i32::from(self.square_shift()))
    }
}

fn shift(scale: f64) -> i8 {
    scale.log2().ceil() as i8
}

#[cfg(test)]
mod tests;
