// SPDX-License-Identifier: MIT OR Apache-2.0
//! `hapticore hdl`: Verilog from the model.

use anyhow::Result;
use hapticore_model::blocks::core::Core;
use hapticore_rtl::verilog::Design;
use serde_json::json;

use crate::args::HdlArgs;
use crate::inputs;
use crate::output::Output;

/// The profile where none is named.
const PROFILE: &str = "standard";

/// Prints the core into the folder.
///
/// # Errors
/// No such profile, or a folder that cannot be written.
pub fn run(args: &HdlArgs) -> Result<bool> {
    let profile = inputs::profile(args.profile.as_deref().unwrap_or(PROFILE))?;
    let output = Output::new(&args.out)?;
    let design = Design::of(&Core::new(&profile), &format!("hapticore hdl --profile {}", profile.name));
    for file in &design.modules {
        output.write(&format!("{}.v", file.name), &file.text)?;
    }
    let files = output.keep()?;
    if args.json {
        println!(
            "{}",
            serde_json::to_string_pretty(&json!({ "profile": profile.name, "top": design.top(), "files": files }))?
        );
        return Ok(true);
    }
    println!("{}: {} modules, top {}, in {}", profile.name, files.len(), design.top(), args.out.display());
    Ok(true)
}
