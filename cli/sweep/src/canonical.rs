// SPDX-License-Identifier: MIT OR Apache-2.0
//! Canonical JSON (RFC 8785: keys sorted, numbers in one form, no spaces), and names made of it.

use canon_json::CanonJsonSerialize;
use serde::Serialize;

/// The canonical text of a value.
///
/// # Panics
/// Where a number is not finite: what is named or stored has been checked for that.
pub fn text(value: &impl Serialize) -> String {
    value.to_canon_json_string().expect("plain data with finite numbers")
}

/// The BLAKE3 hash of a value's canonical text, 64 hexadecimal digits.
///
/// # Panics
/// As [`text`].
pub fn name(value: &impl Serialize) -> String {
    blake3::hash(text(value).as_bytes()).to_hex().to_string()
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn order_of_keys_and_form_of_numbers_do_not_matter() {
        let (a, b) = (json!({"b": 20.0, "a": [1, 1e-7]}), json!({"a": [1.0, 0.0000001], "b": 20}));
        assert_eq!(text(&a), r#"{"a":[1,1e-7],"b":20}"#);
        assert_eq!(name(&a), name(&b));
        assert_ne!(name(&a), name(&json!({"a": [1, 1e-7], "b": 21})));
    }
}
