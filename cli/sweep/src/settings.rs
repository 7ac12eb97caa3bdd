// SPDX-License-Identifier: MIT OR Apache-2.0
//! What a point sets: keys of a profile, and keys of a scene.

use hapticore_contract::profile::Profile;
use hapticore_tradeoff::knobs::Knob;
use serde_json::Value;

use crate::axis::Settings;

/// The profile with keys set, whether or not a core can be built of it. A key is a knob of
/// `hapticore tradeoff`, in bits or samples, or a key of a profile such as `carrier.window`; knobs are
/// turned last, in the order of [`Knob::ALL`].
///
/// # Errors
/// No such key, or a value that it cannot have; the message says what was expected.
pub fn turned(profile: &Profile, set: &Settings) -> Result<Profile, String> {
    let knob = |key: &String| Knob::ALL.into_iter().find(|knob| knob.key() == key);
    let mut turned = profile.clone();
    let plain = || set.iter().filter(|(key, _)| knob(key).is_none());
    if plain().next().is_some() {
        let mut tree = serde_json::to_value(profile).expect("a profile is plain data");
        for (key, value) in plain() {
            put(&mut tree, key, value)?;
        }
        turned = serde_json::from_value(tree).map_err(|error| error.to_string())?;
    }
    for knob in Knob::ALL {
        let Some(value) = set.get(knob.key()) else { continue };
        let whole = value.as_u64().ok_or_else(|| expected(knob, value))?;
        turned = knob.turn(&turned, whole).ok_or_else(|| expected(knob, value))?;
        if knob.value(&turned) != whole {
            return Err(format!(
                "expected a multiple of 5 samples with carrier.method = \"polyphase\", got {whole}"
            ));
        }
    }
    Ok(turned)
}

fn expected(knob: Knob, value: &Value) -> String {
    let what = match knob {
        Knob::Window => "a number of samples",
        Knob::BlockShift => "a number of bits",
        _ => "a number of bits above 2",
    };
    format!("expected {what}, got {value}")
}

fn put(tree: &mut Value, key: &str, value: &Value) -> Result<(), String> {
    let place = key.split('.').try_fold(tree, |tree, part| tree.get_mut(part));
    *place.ok_or_else(|| {
        let knobs = Knob::ALL.map(Knob::key).join(", ");
        format!("expected a knob among {knobs}, or a key of a profile such as carrier.window")
    })? = value.clone();
    Ok(())
}

/// The overrides of a scene, as `simulate --set` takes them.
pub fn overrides(set: &Settings) -> Vec<(String, String)> {
    set.iter().map(|(key, value)| (key.clone(), toml_text(value))).collect()
}

/// A value as TOML, of which JSON's texts, numbers, flags and lists are part.
fn toml_text(value: &Value) -> String {
    toml::Value::try_from(value).map_or_else(|_| value.to_string(), |value| value.to_string())
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    fn set(pairs: &[(&str, Value)]) -> Settings {
        pairs.iter().map(|(key, value)| (key.to_string(), value.clone())).collect()
    }

    #[test]
    fn knobs_and_keys_of_a_profile_are_set() {
        let standard = Profile::bundled("standard").unwrap();
        let all = [
            ("adc", json!(16)),
            ("slot.integrate", json!(500)),
            ("carrier.window", json!("rectangular")),
        ];
        let profile = turned(&standard, &set(&all)).unwrap();
        assert_eq!(profile.formats.adc.to_string(), "s16.15");
        assert_eq!(
            (profile.slot.integrate, profile.carrier.periods),
            (500, 51),
            "the carrier stays"
        );
        assert_ne!(profile.carrier.window, standard.carrier.window);
        assert_eq!(turned(&standard, &Settings::new()), Ok(standard));
    }

    #[test]
    fn what_cannot_be_set_is_told() {
        let small = Profile::bundled("small").unwrap();
        for (key, value, words) in [
            ("adcs", json!(16), "a knob among adc, oscillator"),
            ("carrier.windows", json!("hann"), "a key of a profile"),
            ("carrier.window", json!("round"), "unknown variant `round`"),
            ("adc", json!("s16.15"), "a number of bits above 2, got \"s16.15\""),
            ("adc", json!(400), "got 400"),
            ("slot.integrate", json!(502), "a multiple of 5"),
        ] {
            let message = turned(&small, &set(&[(key, value)])).unwrap_err();
            assert!(message.contains(words), "{key}: {message}");
        }
    }

    #[test]
    fn values_of_a_scene_are_toml() {
        let of = |value: Value| overrides(&set(&[("k", value)]))[0].1.clone();
        assert_eq!(of(json!("bicubic")), "\"bicubic\"");
        assert_eq!(of(json!([1, 2.5])), "[1, 2.5]");
        assert_eq!(of(json!(false)), "false");
        assert_eq!(of(json!({"sweep": [20, 50]})), "{ sweep = [20, 50] }");
    }
}
