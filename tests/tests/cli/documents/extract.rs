// SPDX-License-Identifier: MIT OR Apache-2.0
//! Code blocks and commands of a document.

/// A fenced block.
#[derive(Debug)]
pub struct Block {
    /// Document and line.
    pub place: String,
    /// The language, then perhaps a file's name.
    pub head: String,
    /// What it holds.
    pub text: String,
}

/// A line of commands: of a block, or a span of code in prose.
#[derive(Debug)]
pub struct Snippet {
    /// Document and line.
    pub place: String,
    /// As it stands there, without comments.
    pub text: String,
    /// Whether readers copy it as it is.
    pub in_block: bool,
}

/// The fenced blocks.
pub fn blocks(document: &str, text: &str) -> Vec<Block> {
    let mut blocks: Vec<Block> = Vec::new();
    let mut open = false;
    for (number, line) in (1..).zip(text.lines()) {
        match (line.trim_start().strip_prefix("```"), open) {
            (Some(head), false) => {
                let place = format!("{document}:{number}");
                blocks.push(Block { place, head: head.into(), text: String::new() });
                open = true;
            }
            (Some(_), true) => open = false,
            (None, true) => blocks.last_mut().expect("an open block").text += &format!("{line}\n"),
            (None, false) => (),
        }
    }
    assert!(!open, "{document}: every fence is closed");
    blocks
}

/// The lines of its blocks of commands, and its spans of code that begin as a command does.
pub fn snippets(document: &str, text: &str) -> Vec<Snippet> {
    let of_block = |block: &Block| {
        let text = joined(&block.text);
        let lines = text.lines().map(without_comment).filter(|line| !line.is_empty());
        let snippet = |text: String| Snippet { place: block.place.clone(), text, in_block: true };
        lines.map(snippet).collect::<Vec<_>>()
    };
    let blocks = blocks(document, text).into_iter().filter(|block| block.head == "sh");
    let mut snippets: Vec<_> = blocks.flat_map(|block| of_block(&block)).collect();
    snippets.extend(spans(document, text).into_iter().filter(|span| is_command(&span.text)));
    snippets
}

/// A block whose lines that end with a backslash are one with the next.
fn joined(block: &str) -> String {
    block.split("\\\n").map(str::trim_start).collect()
}

/// Spans of code outside blocks; one may go on in the next line.
fn spans(document: &str, text: &str) -> Vec<Snippet> {
    let mut prose = String::new();
    let mut open = false;
    for line in text.lines() {
        let fence = line.trim_start().starts_with("```");
        open ^= fence;
        // A paragraph's spans are closed within it.
        let line = if fence || open { "" } else { line };
        prose += &format!("{line}\n");
    }
    let mut spans = Vec::new();
    let mut number = 1;
    for paragraph in prose.split_inclusive("\n\n") {
        for (index, part) in paragraph.split('`').enumerate() {
            if index % 2 == 1 {
                let text = part.split_whitespace().collect::<Vec<_>>().join(" ");
                spans.push(Snippet {
                    place: format!("{document}:{number}"),
                    text,
                    in_block: false,
                });
            }
            number += part.matches('\n').count();
        }
    }
    spans
}

/// Whether a span begins as a command line of this project, its tools or its tests.
fn is_command(span: &str) -> bool {
    let words: Vec<_> = span.split(' ').skip_while(|word| is_variable(word)).collect();
    match words[..] {
        [] | [""] => false,
        ["cargo" | "hapticore", ..] => words.len() > 1,
        // The command without its name, where it has an argument.
        [first, second, ..] if super::parse::is_subcommand(first) => {
            !second.starts_with(['=', '('])
        }
        [first, _, ..] => is_script(first),
        [first] => is_script(first) && !span.ends_with('/'),
    }
}

/// Whether a word is a file of the project that can be run.
pub fn is_script(word: &str) -> bool {
    let path = super::root().join(word);
    let words = ["run", "test", "planted", "netlist", "tools", "formal", "lines"];
    path.is_file() && path.file_name().is_some_and(|name| words.iter().any(|word| name == *word))
}

/// Whether a word sets a variable of the environment: `CI=true`.
pub fn is_variable(word: &str) -> bool {
    let is_name =
        |name: &str| !name.is_empty() && name.chars().all(|c| c.is_ascii_uppercase() || c == '_');
    word.split_once('=').is_some_and(|(name, _)| is_name(name))
}

/// A line of a shell without its comment.
pub fn without_comment(line: &str) -> String {
    let line = line.split_once(" #").map_or(line, |(line, _)| line);
    if line.starts_with('#') { String::new() } else { line.trim().into() }
}

#[test]
fn blocks_lines_and_spans_are_found() {
    let text = "a `b` and `hapticore simulate\nfig6` but `x`.\n\n```sh\nls  # all\n# no\nhapticore scenes \\\n  --json\n```\n`replay FILE`, `replay`\n";
    let found = snippets("d.md", text);
    let texts: Vec<_> =
        found.iter().map(|snippet| (snippet.place.as_str(), snippet.text.as_str())).collect();
    let expected = [
        ("d.md:4", "ls"),
        ("d.md:4", "hapticore scenes --json"),
        ("d.md:1", "hapticore simulate fig6"),
        ("d.md:10", "replay FILE"),
    ];
    assert_eq!(texts, expected);
}
