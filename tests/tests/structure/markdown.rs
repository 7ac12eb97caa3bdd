// SPDX-License-Identifier: MIT OR Apache-2.0
//! As much of Markdown as a check of links needs: headings, links and code, with GitHub's anchors.

use std::collections::BTreeSet;

/// What a document has and what it refers to.
#[derive(Debug, Default)]
pub struct Document {
    /// Anchors of its headings.
    pub anchors: BTreeSet<String>,
    /// Numbers of its sections: those with which headings begin.
    pub sections: BTreeSet<u32>,
    /// Targets of its links and images.
    pub links: Vec<String>,
    /// Names of files and folders in code spans.
    pub paths: Vec<String>,
}

impl Document {
    /// Reads a document.
    pub fn new(text: &str) -> Document {
        let mut document = Document::default();
        let mut fenced = false;
        for line in text.lines() {
            if line.trim_start().starts_with("```") {
                fenced = !fenced;
            } else if !fenced {
                document.line(line);
            }
        }
        document
    }

    fn line(&mut self, line: &str) {
        let title = line.trim_start_matches('#');
        if title.len() < line.len() && title.starts_with(' ') {
            self.heading(title.trim());
        }
        for (number, span) in line.split('`').enumerate() {
            match number % 2 {
                0 => self.links.extend(
                    span.split("](")
                        .skip(1)
                        .filter_map(|rest| Some(rest.split_once(')')?.0.into())),
                ),
                _ => self.paths.extend(Some(span).filter(|span| is_path(span)).map(str::to_string)),
            }
        }
    }

    fn heading(&mut self, title: &str) {
        let number = title.split('.').next().and_then(|number| number.parse::<u32>().ok());
        self.sections.extend(number);
        let slug = slug(title);
        let repeated = (1..).map(|n| format!("{slug}-{n}"));
        let mut tries = [slug.clone()].into_iter().chain(repeated);
        let anchor = tries.find(|anchor| !self.anchors.contains(anchor)).expect("one is free");
        self.anchors.insert(anchor);
    }
}

/// GitHub's anchor of a heading.
fn slug(title: &str) -> String {
    let kept = title.chars().filter(|c| c.is_alphanumeric() || " -_".contains(*c));
    kept.map(|c| if c == ' ' { '-' } else { c }).flat_map(char::to_lowercase).collect()
}

fn is_path(span: &str) -> bool {
    let no_path = |c: char| c.is_whitespace() || "*…:<>|={}()$,^'\"".contains(c);
    span.contains('/') && !span.starts_with(['-', '/', '.']) && !span.contains(no_path)
}

/// Sections that a text cites as `docs/physics.md §3` or `docs/physics.md §3, §4`.
pub fn citations(text: &str) -> Vec<(String, u32)> {
    let mut cited = Vec::new();
    for (start, _) in text.match_indices("docs/") {
        let Some((name, mut rest)) = text[start..].split_once(".md §") else { continue };
        if !name.chars().all(|c| c.is_ascii_alphanumeric() || "/-_".contains(c)) {
            continue;
        }
        loop {
            let digits = rest.len() - rest.trim_start_matches(|c: char| c.is_ascii_digit()).len();
            cited.extend(rest[..digits].parse().ok().map(|number| (format!("{name}.md"), number)));
            match rest[digits..]
                .strip_prefix(", §")
                .or_else(|| rest[digits..].strip_prefix(" and §"))
            {
                Some(next) if digits > 0 => rest = next,
                _ => break,
            }
        }
    }
    cited
}

#[test]
fn headings_links_paths_and_citations_are_read() {
    let text = "# A `b` (c)\n## 1. One, two\n# A `b` (c)\n[x](y.md#z) and [`p/q.rs`](p/q.rs)\n```\n[no](no)\n```\n";
    let document = Document::new(text);
    assert!(
        ["a-b-c", "1-one-two", "a-b-c-1"].iter().all(|anchor| document.anchors.contains(*anchor))
    );
    assert_eq!(document.links, ["y.md#z", "p/q.rs"]);
    assert_eq!((document.paths, document.sections), (vec!["p/q.rs".to_string()], [1].into()));
    let cited = citations("(docs/physics.md §1, §2); docs/boards.md; docs/decisions.md §9.");
    assert_eq!(
        cited,
        [
            ("docs/physics.md".into(), 1),
            ("docs/physics.md".into(), 2),
            ("docs/decisions.md".into(), 9)
        ]
    );
}
