// SPDX-License-Identifier: MIT OR Apache-2.0
//! Captures as SigMF (<https://sigmf.org>, version 1.2): `NAME.sigmf-meta` says what the samples in
//! `NAME.sigmf-data` are.
//!
//! Taken are real samples, interleaved, in one piece: `ri16_le`, `ri32_le`, `rf32_le`, `rf64_le`
//! and their `_be`.

use std::path::Path;

use anyhow::{Context, Result, anyhow, bail, ensure};
use serde_json::Value;

use super::Content;
use super::columns::Columns;
use super::input::{self, Input};
use super::raw::{Layout, Reader};
use super::stream::{Adc, Described};
use hapticore_host::text::read;

/// The files of a capture, by the name of either.
pub fn files(path: &Path) -> Result<Content> {
    let (meta, data) = (path.with_extension("sigmf-meta"), path.with_extension("sigmf-data"));
    Ok(Content::Sigmf {
        file: meta.display().to_string(),
        meta: read(&meta)?,
        data: input::file(&data)?,
    })
}

/// Opens a capture: the text of its meta data, called `file` in messages, and its samples.
pub fn open(
    file: &str,
    meta: &str,
    input: Input,
    adc: Adc,
    described: &Described,
) -> Result<Reader> {
    let value: Value =
        serde_json::from_str(meta).map_err(|error| anyhow!("{file}: expected JSON: {error}"))?;
    let head = Head::read(&value).with_context(|| file.to_string())?;
    let layout =
        layout(&head.datatype, described).with_context(|| format!("{file}: core:datatype"))?;
    let columns = Columns::counted(head.channels, described.channels.as_deref(), adc)
        .with_context(|| format!("{file}: core:num_channels"))?;
    let block = (layout.bytes * head.channels) as u64;
    let length = input.length.context("expected a file").with_context(|| input.name.clone())?;
    ensure!(
        length % block == 0 || described.truncated,
        "{}: expected whole samples of {block} bytes: it is cut short; --truncated takes what is there",
        input.name
    );
    Ok(Reader::new(input, adc, layout, columns, head.sample_rate_hz, Some(length / block)))
}

/// What the meta data say.
struct Head {
    datatype: String,
    channels: usize,
    sample_rate_hz: f64,
}

impl Head {
    fn read(value: &Value) -> Result<Head> {
        let global = &value["global"];
        let text = |key: &str| global[key].as_str().map(str::to_string);
        let whole = |of: &Value, key: &str| of[key].as_u64().unwrap_or(0);
        for key in ["core:dataset", "core:metadata_only"] {
            ensure!(
                global[key].is_null() || global[key] == false,
                "{key}: expected samples in a .sigmf-data file of the same name"
            );
        }
        let segments = value["captures"].as_array().map_or(&[][..], Vec::as_slice);
        ensure!(
            segments.len() <= 1,
            "captures: expected samples in one piece, got {} segments",
            segments.len()
        );
        let start = segments.first().map_or(0, |segment| whole(segment, "core:sample_start"));
        ensure!(start == 0, "captures: core:sample_start: expected 0, got {start}");
        for (of, key) in
            [(segments.first(), "core:header_bytes"), (Some(global), "core:trailing_bytes")]
        {
            let bytes = of.map_or(0, |of| whole(of, key));
            ensure!(bytes == 0, "{key}: expected a file of samples alone, got {bytes}");
        }
        let rate = global["core:sample_rate"].as_f64().filter(|rate| *rate > 0.0);
        Ok(Head {
            datatype: text("core:datatype")
                .context("core:datatype: expected text such as \"ri16_le\", but it is missing")?,
            channels: global["core:num_channels"].as_u64().unwrap_or(1) as usize,
            sample_rate_hz: rate.context("core:sample_rate: expected a number above 0")?,
        })
    }
}

fn layout(datatype: &str, described: &Described) -> Result<Layout> {
    let big_endian = datatype.ends_with("_be");
    match datatype.trim_end_matches("_le").trim_end_matches("_be") {
        "ri16" => Layout::integer(2, 16, described.bits, big_endian),
        "ri32" => Layout::integer(4, 32, described.bits, big_endian),
        "rf32" => Ok(Layout::float(4, described.full_scale_v, big_endian)),
        "rf64" => Ok(Layout::float(8, described.full_scale_v, big_endian)),
        _ if datatype.starts_with('c') => {
            bail!("expected real samples of the ADC, got complex ones ({datatype})")
        }
        _ => bail!("expected ri16, ri32, rf32 or rf64 with _le or _be, got {datatype}"),
    }
}
