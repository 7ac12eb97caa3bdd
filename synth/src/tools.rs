// SPDX-License-Identifier: MIT OR Apache-2.0
//! The tools that `synth/tools` puts into `.tools/`.

use anyhow::{Context, Result, bail};
use std::path::{Path, PathBuf};
use std::process::Command;

/// The project's folder.
pub fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).parent().expect("the workspace").into()
}

/// The fetched tools.
#[derive(Debug, Clone)]
pub struct Tools {
    bin: PathBuf,
}

impl Tools {
    /// Finds them.
    ///
    /// # Errors
    /// They are not there.
    pub fn find() -> Result<Tools> {
        let bin = root().join(".tools/bin");
        if !bin.join("yosys").is_file() {
            bail!("no {}: synth/tools fetches what is missing", bin.join("yosys").display());
        }
        Ok(Tools { bin })
    }

    /// A command with the tools before all others on its path.
    pub fn command(&self, program: &str) -> Command {
        let path = std::env::var_os("PATH").unwrap_or_default();
        let folders = std::iter::once(self.bin.clone()).chain(std::env::split_paths(&path));
        let mut command = Command::new(match self.bin.join(program) {
            tool if tool.is_file() => tool,
            _ => program.into(),
        });
        command.env("PATH", std::env::join_paths(folders).expect("folders without separators"));
        command
    }

    /// Runs a tool in a folder; its output. Files are named relative to the folder: the tools are
    /// WebAssembly, and have a `/tmp` of their own.
    ///
    /// # Errors
    /// It cannot be started, or fails; with the end of its output.
    pub fn run<S: AsRef<str>>(
        &self,
        program: &str,
        arguments: &[S],
        folder: &Path,
    ) -> Result<String> {
        let arguments = arguments.iter().map(AsRef::as_ref);
        let output = self.command(program).args(arguments).current_dir(folder).output();
        let output = output.with_context(|| format!("{program} does not start"))?;
        let log = format!(
            "{}{}",
            String::from_utf8_lossy(&output.stdout),
            String::from_utf8_lossy(&output.stderr)
        );
        if !output.status.success() {
            let lines: Vec<_> = log.lines().collect();
            bail!(
                "{program} failed in {}:\n{}",
                folder.display(),
                lines[lines.len().saturating_sub(30)..].join("\n")
            );
        }
        Ok(log)
    }
}
