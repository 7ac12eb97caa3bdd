// SPDX-License-Identifier: MIT OR Apache-2.0
//! Values of options: from an option's own list, else by its name, else by the name of its value.

use std::collections::BTreeMap;
use std::ffi::OsString;

use clap::Arg;
use fastrand::Rng;
use hapticore_contract::profile::BUNDLED;
use hapticore_scene::{Scene, gallery};

use super::desk::Desk;
use super::keys::{self, Key};
use super::settings::{NUMBERS, near, one, one_of, setting};

/// What is no value of any option.
const HOSTILE: [&str; 16] = [
    "",
    " ",
    "-",
    "--",
    "=",
    "a",
    "é\u{202e}",
    "\u{1b}[2J",
    "\n",
    "[]",
    "{}",
    "[[1, 2], [3]]",
    "\"",
    "no-such.toml",
    "folder.toml",
    "true",
];

/// Scenes that take less than half a second, each with effects of its own.
const QUICK: &str = "fig4 fig6 fig9 fig13 hockey minimal-charge minimal-coupling minimal-friction minimal-gap minimal-halves \
    minimal-sensor minimal-sheet minimal-shunt minimal-supply minimal-switching terminals-500-ohm";

/// Makes values.
#[derive(Debug)]
pub struct Values<'a> {
    desk: &'a Desk,
    keys: BTreeMap<String, Vec<Key>>,
    cases: BTreeMap<String, Vec<String>>,
}

impl<'a> Values<'a> {
    /// Of files, and of the keys and cases of the bundled scenes.
    pub fn new(desk: &'a Desk) -> Self {
        let cases = gallery::all().iter().map(|(name, text)| {
            let scene = Scene::parse(text, name, &[]).expect("a bundled scene");
            (name.to_string(), scene.cases.into_iter().map(|case| case.name).collect())
        });
        Values { desk, cases: cases.collect(), keys: keys::of_gallery() }
    }

    /// A value of an option of a subcommand on a scene.
    ///
    /// # Panics
    /// An option whose values are not known here.
    pub fn value(&self, rng: &mut Rng, of: &str, argument: &Arg, scene: &str) -> OsString {
        let listed = argument.get_possible_values();
        if !listed.is_empty() {
            return rng.choice(listed).expect("a value").get_name().into();
        }
        self.named(rng, of, argument, scene).into()
    }

    fn named(&self, rng: &mut Rng, of: &str, argument: &Arg, scene: &str) -> String {
        let files = &self.desk.files;
        match (of, argument.get_id().as_str()) {
            ("host", "port") => one_of(
                rng,
                "virtual virtual virtual:fig9 virtual:hockey virtual:none list tcp:127.0.0.1:9 tcp:none /dev/null no-port",
            ),
            ("host", "fault") => one_of(
                rng,
                "open=1 open=0 swapped=1,4 pad-missing=2 pads-swapped=0,3 line-low=5 line-shorted=0,1 noisy=7 lost=0.01 \
                 clock=1.03 clock=9 flipped=x burnt=1 open=99",
            ),
            ("host", "target") => one_of(rng, "0=0.2 0=0 0=0.05 9=0.1 0=-1 0=1e300 0=nan x"),
            ("host", "record" | "calibrate") => {
                one(rng, &["new.csv", "new.mcap", "nowhere/new.csv", "folder.toml"])
            }
            ("host", "serve") => one_of(rng, "127.0.0.1:0 127.0.0.1:x 192.0.2.1:1 - x"),
            ("tradeoff", "scene") => {
                one(rng, &["minimal-sheet", "minimal-gap", "fig6", "fig9", "wall-2d"])
            }
            ("reference", "key") => one_of(
                rng,
                "wall gap.rung pad.0.load_g force_n columns criteria profile calibration messages stimulus [[pad]] pad.position_mm.circle wal .. pad.0.0 x",
            ),
            ("reference", "man") => one_of(rng, "man man/man1 . empty.csv"),
            ("new", "file") => one_of(rng, "new.toml nowhere/new.toml folder.toml empty.csv ."),
            (_, "scene" | "show") => scene.to_string(),
            (_, "set") => self.setting(rng, scene),
            (_, "case") => self.case(rng, scene),
            (_, "profile") => either(rng, &BUNDLED.map(|(name, _)| name), &files.profiles),
            (_, "calibration") => one(rng, &files.calibrations),
            (_, "tuning") => one(rng, &files.tunings),
            ("replay", "capture") => one(rng, &files.captures),
            (_, "capture") => one(
                rng,
                &[
                    "new.csv",
                    "new.wav",
                    "new.txt",
                    "new",
                    "nowhere/new.csv",
                    "frames.csv",
                    "one.wav",
                ],
            ),
            (_, "data") => one(rng, &files.measurements),
            (_, "plan") => one(rng, &files.plans),
            (_, "line") => {
                let chunk = one(rng, &files.chunks);
                near(rng, &chunk)
            }
            (_, "store") => one(rng, &["store", "new", "empty.csv"]),
            (_, "out") => {
                one(rng, &["results", "a/b/c", ".", "results/", "empty.csv", "folder.toml", "é"])
            }
            (_, "waves_window") => {
                one(rng, &["0..0.001", "0..1e-9", "0.001..0.002", "0..1e300", "1..2", "0..0.003"])
            }
            (_, "channels") => one(rng, &CHANNELS),
            (_, "target") => one(rng, &TARGETS),
            (_, "wave") => format!(
                "{}{}",
                one(rng, &["dc", "square", "square:", "sine:", "sine"]),
                one(rng, &["", "1", "2", "0", "250", "-1", "1e3", "65536", "4294967296"])
            ),
            (_, "threads") => one(rng, &["1", "2", "3", "64"]),
            (_, "skip") => one_of(rng, "0 1 850 1700 100000 18446744073709551615 -1 0.5"),
            (_, "slots") => one(rng, &["1", "2", "3", "0", "5"]),
            (_, "pads" | "bits") => {
                one(rng, &["1", "2", "3", "4", "5", "8", "16", "18", "24", "32", "33", "256"])
            }
            (_, "bode") => one(rng, &["0.3", "0.05", "1e-9", "100", "1e300", "5e-324"]),
            (_, "clock_hz") => {
                one_of(rng, "25000000 12000000 1000000 200000000 48000000 25000000 999999 1e6")
            }
            ("hdl", "full_scale_v") => one_of(rng, "500 100 1 65535 0"),
            (_, "baud") => one_of(rng, "1000000 3000000 115200 1200 12000000 0 12000001"),
            (_, "seconds") => one_of(rng, "0.1 0.3 1e-3 1e300 0 -1 nan"),
            (_, "port" | "page_port") => one_of(rng, "0 0 0 8091 65535 65536 -1"),
            (_, "speed") => one_of(rng, "1 0.1 0 100 1e-300 -1 nan"),
            (_, "listen") => one_of(rng, "127.0.0.1 ::1 0.0.0.0 192.0.2.1 localhost"),
            (_, "token") => one_of(
                rng,
                "0123456789abcdef long-enough_to-be-one 0123456789abcde& A-token-of-25-characters short",
            ),
            (_, "full_scale_v") => one_of(rng, "10 5 1 0.5 1e-300 1e300 5e-324 0 nan"),
            _ => alternatives(rng, of, argument),
        }
    }

    /// A scene, bundled or a file; mostly one that is quickly run.
    pub fn scene(&self, rng: &mut Rng) -> String {
        match rng.u8(..20) {
            0..=13 => one_of(rng, QUICK),
            14..=16 => one(rng, &self.desk.files.scenes),
            _ => gallery::all()[rng.usize(..gallery::all().len())].0.into(),
        }
    }

    /// Whether a scene goes on in time rather than from point to point.
    pub fn is_timed(&self, scene: &str) -> bool {
        let own = |key: &Key| key.name == "duration_s" && key.own.is_some();
        self.keys.get(scene).is_some_and(|keys| keys.iter().any(own))
    }

    /// A case of a scene; of a file's those of any.
    fn case(&self, rng: &mut Rng, scene: &str) -> String {
        let any = self.cases.values().nth(rng.usize(..self.cases.len())).expect("a scene");
        one(rng, self.cases.get(scene).unwrap_or(any))
    }

    /// `KEY=VALUE` of a scene; of a file's those of any.
    fn setting(&self, rng: &mut Rng, scene: &str) -> String {
        let mut lists = self.keys.values();
        let list = match self.keys.get(scene) {
            Some(list) if rng.u8(..20) > 0 => list,
            _ => lists.nth(rng.usize(..self.keys.len())).expect("a scene"),
        };
        let key = rng.choice(list).expect("a scene has keys");
        format!("{}={}", key.name, setting(rng, key))
    }
}

/// Orders of channels.
const CHANNELS: [&str; 8] = [
    "i1,i2,i3,i4,i5,i6,v_sense,v_haptic",
    "_,i1,i2,i3,i4,i5,i6,v_sense",
    "i2,i1,i3,v_sense,v_haptic",
    "i1,i2,i3,v_haptic,v_sense,pad",
    "i1,i2,i3,i4,v_sense,v_haptic,pad",
    "_",
    "i1,i1",
    "v_sense,i1,i2,i3,i4,i5,i6,i7,v_haptic",
];

/// Errors that a profile shall meet.
const TARGETS: [&str; 7] = [
    "force=1mN",
    "position=0.1mm",
    "capacitance=0.1%",
    "force=10mN,position=1mm",
    "force=0mN",
    "force=1e-300mN",
    "force=nan",
];

/// A value that hardly any option takes.
pub fn hostile(rng: &mut Rng) -> OsString {
    match rng.u8(..8) {
        0 => "x".repeat(5000).into(),
        1 => not_text(),
        2..=4 => one_of(rng, NUMBERS).into(),
        _ => one(rng, &HOSTILE).into(),
    }
}

/// Bytes that are no text.
#[cfg(unix)]
fn not_text() -> OsString {
    std::os::unix::ffi::OsStringExt::from_vec(b"caf\xe9.csv".to_vec())
}

/// Bytes that are no text.
#[cfg(not(unix))]
fn not_text() -> OsString {
    "café.csv".into()
}

/// One of the words that the name of an option's value lists, as `ulx3s|icebreaker`.
fn alternatives(rng: &mut Rng, of: &str, argument: &Arg) -> String {
    let names = argument.get_value_names().unwrap_or_default();
    let words: Vec<&str> = names.iter().flat_map(|name| name.split('|')).collect();
    assert!(
        words.len() > 1,
        "{of} {argument}: a new option, whose values are to be added to {}",
        file!()
    );
    one(rng, &words)
}

/// One of two lists, and of that list one.
fn either(rng: &mut Rng, first: &[&str], second: &[String]) -> String {
    if rng.bool() { one(rng, first) } else { one(rng, second) }
}
