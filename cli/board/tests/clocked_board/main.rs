// SPDX-License-Identifier: MIT OR Apache-2.0
//! A virtual board against the gateware that it stands for: the clocked model of the whole board, from which the Verilog is
//! printed.
//!
//! ```text
//! host ─ bytes ─┬─ VirtualBoard ──────────────────────────────────┬─ packets, compared byte for byte; findings of the check
//!               └─ ClockedBoard: Board ═ pins ═ ADC ─ codes ─ plant ┘
//! ```
//!
//! The models of what stands at its pins are those of the gateware's own tests, included by path, as others include what
//! draws inputs. A library for them would need a crate of its own: `rtl` uses the host's side in its tests only.

#[path = "../../../../rtl/tests/board/dac.rs"]
#[allow(dead_code)]
mod dac;
#[path = "../../../../rtl/tests/board/pins.rs"]
#[allow(dead_code)]
mod pins;

mod bytes;
mod clocked;
mod wiring;

use hapticore_board::virtual_board::{Made, VirtualBoard};
use hapticore_contract::profile::Profile;
use hapticore_host::{Dac, Output, Wave};
use hapticore_run::case::Case;
use hapticore_scene::Scene;

/// Clocks per bit of the serial line.
const BIT_CLOCKS: u64 = 4;
/// Samples of a window of [`small`].
const WINDOW: u64 = 100;

/// A virtual board of a scene's case, made as its gateware can be clocked: at the profile's clocks per sample.
fn virtual_board(scene: Scene, index: usize, profile: &Profile) -> VirtualBoard {
    VirtualBoard::new(scene, index, profile, made).expect("a board of the scene")
}

/// Two pads: the check of their wiring takes few slots.
fn two_pads() -> Scene {
    const TEXT: &str = r#"
        title = "two pads"
        duration_s = 1
        [[pad]]
        position_mm = [-100, 50]
        load_g = 40
        [[pad]]
        position_mm = [100, -50]
        load_g = 30
        [sheet]
        rung = "bicubic"
        [gap]
        rung = "static"
        [carrier]
        rung = "samples"
        [sensor]
        noise_ppm_rms = 18
        quantisation_bits = 16
    "#;
    Scene::parse(TEXT, "two-pads.toml", &[]).expect("a scene")
}

/// The bundled profile whose slots are the shortest, with fewer words to be sent and a window no longer than the check of
/// the wiring needs.
fn small() -> Profile {
    let mut profile = Profile::bundled("small").expect("bundled");
    (profile.position.columns, profile.position.rows, profile.position.steps) = (17, 11, 4);
    let with_settle = |settle: u64| {
        let mut profile = profile.clone();
        profile.slot.settle = settle;
        let profile = profile.with_window(WINDOW);
        hapticore_model::check(&profile).is_ok().then_some(profile)
    };
    // Of the same point in a period of five samples.
    (5..70)
        .find_map(|periods| with_settle(5 * periods))
        .expect("slots as long as an estimate takes")
}

fn made(case: &Case) -> Made {
    let clock_hz = case.profile.clocks_per_sample as f64 * case.clock.sample_rate_hz();
    let output = case.plan().map(|plan| Output {
        dac: Dac::Ad5664r,
        wave: Wave::Dc,
        full_scale_v: plan.full_scale_v.round() as u16,
        clock_hz: clock_hz as u64,
    });
    Made { baud: (clock_hz / BIT_CLOCKS as f64) as u32, clock_hz, output }
}
