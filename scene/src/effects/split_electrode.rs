// SPDX-License-Identifier: MIT OR Apache-2.0
//! `[halves]`: a pad of several electrodes, which reads the direction of the push.
//!
//!   W_i = W·(1 + e·x_i/ρ²),   ρ² = Σs_i·x_i²;   of quadrants + e_y·y_i/ρ_y², too           (CoP)
//!   Δx = Σa_i·x_i/Σa_i − Σx_i/2,   x_i = ∓x_c,   a_i ∝ C_i                                 (eq. 10)
//!
//! A push off the centre, a pad's `eccentricity_mm`, presses one side more than the other; its gap
//! closes further, and eq. 10 reads a part of e. The hand of `[hand]` pushes at `push_height_mm`
//! above the sheet, 5 by default, which adds height·F/W to e; where the pad tips, e is at its end.
//! Each electrode has gaps of its own, at the level of `[gap]`, with its
//! share s_i of the pad's area and the load per area W_i.
//!
//! | `strips` | electrodes | senses |
//! | --- | --- | --- |
//! | 2 | halves, whose centres lie a quarter of the pad's diameter off its own | both |
//! | 4 | strips of a disc: the outer two have `outer_share_percent` of its area | the outer two, at `sensing_v_rms` at most where that is set |
//! | `quadrants = true` in place of strips | quadrants of a disc: top left, bottom left, bottom right, top right; the hand's push tilts the pad along y, too | all |
//!
//! | electrodes on the left are | by | reads as |
//! | --- | --- | --- |
//! | larger | `mismatch_percent` | a constant offset |
//! | higher: their patches that bear no load | `height_mismatch_percent` | an offset that depends on the voltage, above all where the sides pull in one after the other |
//! | at a higher haptic voltage than the pad's | `source_mismatch_percent` | an offset that grows with the voltage |
//!
//! The first and the last are of electrodes that sense. With `senses = "each"` a pad has a slot for each of its parts: see `part`. The truth's direction is Δx over half the sheet's width, as the ratios of eq. 10 are. Source:
//! docs/physics.md §4.

use super::effect::{Effect, PadEffect};
use super::gap;
use super::pad::Pad;
use super::spec::{Level, Rung, Setting, Spec};
use super::tick::Tick;
use crate::device::Device;
use crate::drive::{Electrode, PadDrive, Pull};
use crate::error::SceneError;
use crate::format::{Key, Limits, Table, keys};

/// Where a hand pushes, mm above the sheet, where the scene does not say it: at the sheet no push tilts the pad, and its
/// direction cannot be read.
const HEIGHT_MM: f64 = 5.0;

keys! { KEYS:
    /// Level of the split electrode.
    RUNG: Option<&'static str> = Rung::choice("rung", || vec!["gaps"]).usually("gaps");
    /// Whether a pad has one slot, in which all its electrodes are connected, or one for each part.
    SENSES: &'static str = Key::choice("senses", || vec!["together", "each"]).or("together");
    /// Number of electrodes: 2 halves, or 4 strips of which the outer two sense.
    STRIPS: u64 = Key::whole("strips", 2, 4).or(2);
    /// The pad is split in four quadrants in place of strips, all of which sense and brake.
    QUADRANTS: bool = Key::flag("quadrants");
    /// Share of the pad's area that the outer two of four strips have together.
    OUTER_SHARE_PERCENT: f64 = Key::number("outer_share_percent", Limits::within(1.0, 90.0)).or(20.0);
    /// Largest haptic voltage of the outer two of four strips; with `strips`.
    SENSING_V_RMS: Option<f64> = Key::number("sensing_v_rms", Limits::within(0.0, 1e5)).usually("no limit");
    /// Height above the sheet at which the hand pushes; with `[hand]`.
    PUSH_HEIGHT_MM: Option<f64> = Key::number("push_height_mm", Limits::within(0.0, 1e3)).usually("5 with [hand], else 0");
    /// How much larger the electrodes on the left are.
    MISMATCH_PERCENT: f64 = Key::number("mismatch_percent", Limits::within(-50.0, 50.0)).or(0.0);
    /// How much higher the patches on the left that bear no load are.
    HEIGHT_MISMATCH_PERCENT: f64 = Key::number("height_mismatch_percent", Limits::within(-20.0, 20.0)).or(0.0);
    /// How much higher the haptic voltage of the electrodes on the left is.
    SOURCE_MISMATCH_PERCENT: f64 = Key::number("source_mismatch_percent", Limits::within(-50.0, 50.0)).or(0.0);
}

pub(super) fn read(root: &Table, device: &Device) -> Result<Option<Spec>, SceneError> {
    let Some(table) = root.table("halves")? else { return Ok(None) };
    let raised = table.get(&HEIGHT_MISMATCH_PERCENT)?;
    let (left, right) = (gap::read_raised(root, device, 0.01 * raised)?, gap::read(root, device)?);
    let (Some(left), Some(right)) = (left, right) else {
        return Err(table.error("", "expected [gap] too, which the push closes on one side"));
    };
    let mismatch = 0.01 * table.get(&MISMATCH_PERCENT)?;
    let has_hand = root.table("hand")?.is_some();
    let usual_mm = if has_hand { HEIGHT_MM } else { 0.0 };
    let height_mm = table.get(&PUSH_HEIGHT_MM.or(usual_mm))?;
    if height_mm > 0.0 && !has_hand {
        return Err(
            table.error("push_height_mm", "expected [hand] too, which pushes at that height")
        );
    }
    let strips = read_strips(table, mismatch, device)?;
    let newton_per_g = device.weight_n(1.0);
    let build = move |setting: &Setting| {
        let side = |strip: &Strip| if strip.centre_mm[0] < 0.0 { &left } else { &right };
        let gaps = strips.iter().map(|strip| side(strip).build(setting)).collect();
        let half_width_mm = 0.5 * setting.device.width_mm;
        Effect::Pad(Box::new(SplitElectrode {
            gaps,
            strips: strips.clone(),
            push_mm_g_per_n: height_mm / newton_per_g,
            half_width_mm,
        }))
    };
    Spec::with_levels("halves", Some(table), &RUNG, vec![Level::new("gaps", 1e3, build)], "gaps")
}

/// One electrode.
#[derive(Clone, Copy, Debug)]
pub(super) struct Strip {
    /// Share of the pad's area.
    area: f64,
    /// Where its centre lies, mm right of the pad's and above it.
    pub centre_mm: [f64; 2],
    pub electrode: Electrode,
}

/// The electrodes from left to right; of quadrants from the top left one anticlockwise.
pub(super) fn read_strips(
    table: &Table,
    mismatch: f64,
    device: &Device,
) -> Result<Vec<Strip>, SceneError> {
    let source = table.get(&SOURCE_MISMATCH_PERCENT)?;
    let left_source_share = 1.0 + 0.01 * source;
    if table.get(&QUADRANTS)? {
        if let Some(key) = ["strips", "outer_share_percent", "sensing_v_rms"]
            .into_iter()
            .find(|key| table.node(key).is_some())
        {
            return Err(table.error(key, "expected none with quadrants, which all sense and brake"));
        }
        return Ok(quadrants(0.5 * device.pad_diameter_mm, mismatch, left_source_share));
    }
    let strips = table.get(&STRIPS)?;
    if strips == 3 {
        return Err(table.error("strips", "expected 2 or 4, got 3"));
    }
    let mut sides = vec![[0.5, device.electrode_offset_mm()]];
    let mut sensing_v_rms = f64::INFINITY;
    if strips == 4 {
        let outer = table.get(&OUTER_SHARE_PERCENT)?;
        let most_v = table.get(&SENSING_V_RMS)?;
        sensing_v_rms = most_v.unwrap_or(sensing_v_rms);
        sides = disc_strips(0.005 * outer, 0.5 * device.pad_diameter_mm).to_vec();
    }
    let outer_mm = sides[0][1];
    let mean_square_mm2: f64 = sides.iter().map(|[area, mm]| 2.0 * area * mm * mm).sum();
    let strip = |side: f64, n: usize| Strip {
        area: sides[n][0] * if n == 0 { 1.0 - 0.5 * side * mismatch } else { 1.0 },
        centre_mm: [side * sides[n][1], 0.0],
        electrode: Electrode {
            lean_per_mm: [side * sides[n][1] / mean_square_mm2, 0.0],
            reach_mm: mean_square_mm2 / outer_mm,
            source_share: if n == 0 && side < 0.0 { left_source_share } else { 1.0 },
            most_v_rms: if n == 0 { sensing_v_rms } else { f64::INFINITY },
            ..Electrode::WHOLE
        },
    };
    let left = (0..sides.len()).map(|n| strip(-1.0, n));
    Ok(left.chain((0..sides.len()).rev().map(|n| strip(1.0, n))).collect())
}

/// The quadrants of a disc, whose centres are 4r/3π off its own along either axis.
fn quadrants(radius_mm: f64, mismatch: f64, left_source_share: f64) -> Vec<Strip> {
    let centre_mm = 4.0 * radius_mm / (3.0 * std::f64::consts::PI);
    let quadrant = |[x, y]: [f64; 2]| Strip {
        area: 0.25 * (1.0 - 0.5 * x * mismatch),
        centre_mm: [x * centre_mm, y * centre_mm],
        electrode: Electrode {
            lean_per_mm: [x / centre_mm, y / centre_mm],
            reach_mm: centre_mm,
            source_share: if x < 0.0 { left_source_share } else { 1.0 },
            ..Electrode::WHOLE
        },
    };
    [[-1.0, 1.0], [-1.0, -1.0], [1.0, -1.0], [1.0, 1.0]].map(quadrant).to_vec()
}

/// Area share and centre of the outer and of the inner strip on one side of a disc. The outer strip
/// is a segment of this share: (acos t − t√(1−t²))/π for one that begins at t radii.
fn disc_strips(outer: f64, radius_mm: f64) -> [[f64; 2]; 2] {
    use std::f64::consts::PI;
    let segment = |t: f64| (t.acos() - t * (1.0 - t * t).sqrt()) / PI;
    let (mut low, mut high) = (0.0, 1.0);
    while high - low > 1e-12 {
        let middle = 0.5 * (low + high);
        *(if segment(middle) > outer { &mut low } else { &mut high }) = middle;
    }
    // Of what lies beyond t radii: its first moment, over the disc's area, in radii.
    let moment = |t: f64| 2.0 / 3.0 * (1.0 - t * t).powf(1.5) / PI;
    [[outer, moment(low)], [0.5 - outer, moment(0.0) - moment(low)]]
        .map(|[area, moment]| [area, radius_mm * moment / area])
}

struct SplitElectrode {
    /// The gap effect of each electrode from left to right.
    gaps: Vec<Effect>,
    strips: Vec<Strip>,
    /// Height of the push over the weight of a gram, mm·g/N.
    push_mm_g_per_n: f64,
    half_width_mm: f64,
}

impl SplitElectrode {
    /// Lets `act` see the gap of each electrode, the electrode, and what is done to it; then takes
    /// them together.
    fn for_all(&mut self, pad: &mut Pad, act: impl Fn(&mut dyn PadEffect, &mut Pad, Electrode)) {
        let tilt_mm = self.tilt_mm(pad);
        let (mut electrodes_f, mut attraction_n) = ([0.0; 4], 0.0);
        let each = self.gaps.iter_mut().zip(&self.strips).zip(&mut electrodes_f);
        for ((gap, strip), farad) in each {
            let Effect::Pad(gap) = gap else { continue };
            let electrode = Electrode { tilt_mm, ..strip.electrode };
            let Pull { source_v_rms, load_g } =
                electrode.of_pad(pad.source_v_rms, pad.load_g, pad.eccentricity_mm);
            let mut part = Pad { source_v_rms, load_g, ..pad.clone() };
            act(gap.as_mut(), &mut part, electrode);
            *farad = strip.area * part.capacitance_f;
            attraction_n += strip.area * part.attraction_n;
        }
        pad.electrodes_f = electrodes_f;
        pad.capacitance_f = electrodes_f.iter().sum();
        pad.haptic_v_rms = pad.haptic_v_at(pad.capacitance_f);
        pad.attraction_n = attraction_n;
        pad.uneven = true;
        let last = &self.strips[self.strips.len() - 1];
        let [a, b] = sides_f(&electrodes_f, self.has_quadrants(), self.strips.len());
        pad.direction = last.centre_mm[0] * (b - a) / (a + b) / self.half_width_mm;
    }

    fn has_quadrants(&self) -> bool {
        self.strips[0].centre_mm[1] != 0.0
    }

    /// What the push of the hand adds to the eccentricity: along y of quadrants only.
    fn tilt_mm(&self, pad: &Pad) -> [f64; 2] {
        let along = |newtons: f64| {
            let moment_mm_g = self.push_mm_g_per_n * newtons;
            if moment_mm_g == 0.0 || pad.load_g <= 0.0 { 0.0 } else { moment_mm_g / pad.load_g }
        };
        let [x_n, y_n] = pad.hand_n;
        [along(x_n), if self.has_quadrants() { along(y_n) } else { 0.0 }]
    }
}

/// Capacitances that sense on the left and on the right.
pub(crate) fn sides_f(electrodes_f: &[f64; 4], quadrants: bool, count: usize) -> [f64; 2] {
    match (quadrants, electrodes_f) {
        (true, [a, b, c, d]) => [a + b, c + d],
        (false, all) => [all[0], all[count - 1]],
    }
}

impl PadEffect for SplitElectrode {
    fn act(&mut self, pad: &mut Pad) {
        self.for_all(pad, |gap, electrode, _| gap.act(electrode));
    }

    fn follow(&mut self, pad: &mut Pad, drive: &PadDrive) {
        self.for_all(pad, |gap, part, electrode| gap.follow(part, &drive.of(electrode)));
    }

    /// All gaps keep their states at the same times.
    fn due(&self, pad: &Pad, drive: &PadDrive) -> Option<Tick> {
        match &self.gaps[0] {
            Effect::Pad(gap) => gap.due(pad, drive),
            _ => None,
        }
    }

    fn keep(&mut self, pad: &Pad, tick: Tick, drive: &PadDrive) {
        let tilt_mm = self.tilt_mm(pad);
        for (gap, strip) in self.gaps.iter_mut().zip(&self.strips) {
            if let Effect::Pad(gap) = gap {
                let electrode = Electrode { tilt_mm, ..strip.electrode };
                gap.keep(pad, tick, &drive.of(electrode));
            }
        }
    }
}
