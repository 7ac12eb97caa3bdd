// SPDX-License-Identifier: MIT OR Apache-2.0
//! Where results go by default: a folder of their own for each scene, capture and way to run it.
//!
//! | run | folder |
//! | --- | --- |
//! | `simulate fig6` | `out/fig6` |
//! | `simulate fig6 --core clock --profile small` | `out/fig6-clock-small` |
//! | `simulate fig3 --case rest --set seed=5` | `out/fig3-rest-seed=5` |
//! | `replay hockey.wav` | `out/replay-hockey.wav` |
//!
//! The same run goes to the same folder, in place of its earlier results.

use std::ffi::OsStr;
use std::path::{Path, PathBuf};

use hapticore_run::engine::Fidelity;
use hapticore_scene::gallery;

use crate::args::{CoreArgs, ReplayArgs, SimulateArgs};

/// The longest name of a folder.
const LONGEST: usize = 100;

/// The folder of a scene of this name.
pub fn of_scene(args: &SimulateArgs, name: &str) -> PathBuf {
    let bundled = gallery::find(name).is_some();
    let mine = bundled && gallery::find(&args.scene).is_none();
    let mut words = vec![if mine { format!("{name}.toml") } else { name.to_string() }];
    words.extend(of_core(&args.core));
    words.extend(args.case.iter().cloned());
    words.extend(args.bode.map(|force_n| format!("bode={force_n}")));
    words.extend(args.set.iter().map(|(key, value)| format!("{key}={value}")));
    folder(&words)
}

/// The folder of a capture.
pub fn of_capture(args: &ReplayArgs) -> PathBuf {
    let name = args.capture.file_name().filter(|name| *name != "-").unwrap_or(OsStr::new("stdin"));
    let mut words = vec!["replay".to_string(), name.to_string_lossy().into_owned()];
    words.extend(of_core(&args.core));
    words.extend(args.calibration.as_deref().and_then(stem));
    words.extend(args.pads.map(|pads| format!("pads={pads}")));
    words.extend(args.channels.as_ref().map(|names| format!("channels={}", names.join(","))));
    words.extend(args.bits.map(|bits| format!("bits={bits}")));
    words.extend(args.full_scale_v.map(|volts| format!("full-scale-v={volts}")));
    words.extend(args.skip.map(|samples| format!("skip={samples}")));
    words.extend(args.truncated.then(|| "truncated".to_string()));
    folder(&words)
}

fn of_core(args: &CoreArgs) -> Vec<String> {
    let core = (args.fidelity() != Fidelity::Fixed).then(|| args.fidelity().name().to_string());
    core.into_iter()
        .chain(args.profile.as_deref().and_then(|profile| stem(Path::new(profile))))
        .collect()
}

fn stem(path: &Path) -> Option<String> {
    path.file_stem().map(|stem| stem.to_string_lossy().into_owned())
}

/// `out` and a name of these words; where it cannot hold them as they are, it ends with a number
/// that they alone have.
fn folder(words: &[String]) -> PathBuf {
    let whole = words.join("-");
    let plain = |c: char| if c.is_ascii_alphanumeric() || "-_.=".contains(c) { c } else { '_' };
    let mut name: String = whole.chars().map(plain).take(LONGEST).collect();
    if name != whole {
        name += &format!("-{:08x}", hash(&whole));
    }
    Path::new("out").join(name)
}

/// FNV-1a, <http://www.isthe.com/chongo/tech/comp/fnv/>: the same name with every compiler.
fn hash(text: &str) -> u32 {
    text.bytes().fold(0x811c_9dc5, |hash, byte| (hash ^ u32::from(byte)).wrapping_mul(0x0100_0193))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn name(words: &[&str]) -> String {
        folder(&words.iter().map(ToString::to_string).collect::<Vec<_>>()).display().to_string()
    }

    #[test]
    fn every_run_has_a_folder_of_its_own() {
        assert_eq!(name(&["fig6"]), "out/fig6");
        assert_eq!(name(&["fig6", "pad.0.load_g=50"]), "out/fig6-pad.0.load_g=50");
        let [a, b] = ["[0, 1]", "[0. 1]"]
            .map(|place| name(&["fig6", &format!("pad.0.position_mm={place}")]));
        assert!(a.starts_with("out/fig6-pad.0.position_mm=_0__1_-") && a != b, "{a} {b}");
        assert!(name(&["x", &"y".repeat(1000)]).len() < 120);
    }
}
