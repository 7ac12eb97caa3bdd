// SPDX-License-Identifier: MIT OR Apache-2.0
//! The page's files, embedded: no build step, and nothing to install.

/// A file of the page.
#[derive(Debug, Clone, Copy)]
pub struct File {
    path: &'static str,
    /// Its media type.
    pub kind: &'static str,
    /// What is in it.
    pub text: &'static str,
}

const HTML: &str = "text/html; charset=utf-8";
const SCRIPT: &str = "text/javascript; charset=utf-8";
const TEXT: &str = "text/plain; charset=utf-8";
const STYLE: &str = "text/css; charset=utf-8";

macro_rules! files {
    ($($path:literal, $kind:expr, $file:literal;)*) => {
        const FILES: &[File] = &[$(
            File { path: $path, kind: $kind, text: include_str!(concat!("../page/", $file)) },
        )*];
    };
}

files! {
    "/", HTML, "index.html";
    "/page.mjs", SCRIPT, "page.mjs";
    "/protocol.mjs", SCRIPT, "protocol.mjs";
    "/arena.mjs", SCRIPT, "arena.mjs";
    "/board.mjs", SCRIPT, "board.mjs";
    "/model.mjs", SCRIPT, "model.mjs";
    "/controls.mjs", SCRIPT, "controls.mjs";
    "/draw.mjs", SCRIPT, "draw.mjs";
    "/loupe.mjs", SCRIPT, "loupe.mjs";
    "/panels.mjs", SCRIPT, "panels.mjs";
    "/pointer.mjs", SCRIPT, "pointer.mjs";
    "/sheet.mjs", SCRIPT, "sheet.mjs";
    "/slot.mjs", SCRIPT, "slot.mjs";
    "/strips.mjs", SCRIPT, "strips.mjs";
    "/page.css", STYLE, "page.css";
    "/vendor/uPlot.iife.min.js", SCRIPT, "vendor/uPlot.iife.min.js";
    "/vendor/uPlot.min.css", STYLE, "vendor/uPlot.min.css";
    "/vendor/uPlot.LICENSE", TEXT, "vendor/uPlot.LICENSE";
}

/// The file of a path.
pub fn find(path: &str) -> Option<&'static File> {
    FILES.iter().find(|file| file.path == path)
}
