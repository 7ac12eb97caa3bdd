// SPDX-License-Identifier: MIT OR Apache-2.0
//! How cells stand in a line: what separates them, and which sign is the decimal point.
//!
//! | a line with | is separated by | and its commas are |
//! | --- | --- | --- |
//! | a tab | tabs | decimal points |
//! | a semicolon | semicolons | decimal points |
//! | a comma | commas | decimal points within quotes |
//! | none of them | blanks | – |

/// How cells stand in a line.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Dialect {
    separator: Option<char>,
}

impl Dialect {
    /// That of a line.
    pub fn of(line: &str) -> Dialect {
        Dialect { separator: ['\t', ';', ','].into_iter().find(|sign| line.contains(*sign)) }
    }

    /// The cells of a line, without quotes and blanks around them.
    pub fn cells<'a>(&self, line: &'a str) -> impl Iterator<Item = &'a str> + use<'a> {
        let separator = self.separator;
        let mut rest = Some(line.trim_matches([' ', '\r', '\n']));
        std::iter::from_fn(move || {
            let text = rest?;
            let (cell, after) = match (separator, text.trim_start_matches(' ').strip_prefix('"')) {
                (_, Some(quoted)) => {
                    let (cell, after) = quoted.split_once('"').unwrap_or((quoted, ""));
                    (cell, separator.map_or(after.split_once(' '), |sign| after.split_once(sign)))
                }
                (Some(sign), None) => match text.split_once(sign) {
                    Some((cell, after)) => (cell, Some(("", after))),
                    None => (text, None),
                },
                (None, None) => match text.split_once(' ') {
                    Some((cell, after)) => (cell, Some(("", after.trim_start()))),
                    None => (text, None),
                },
            };
            rest = after.map(|(_, after)| after);
            Some(cell.trim())
        })
    }

    /// The number that a cell is.
    pub fn number(cell: &str) -> Option<f64> {
        let number: Option<f64> = match (cell.contains(','), cell.contains('.')) {
            (false, _) => cell.parse().ok(),
            (true, false) if cell.matches(',').count() == 1 => cell.replace(',', ".").parse().ok(),
            _ => None,
        };
        number.filter(|number| number.is_finite())
    }

    /// The cells of a row of numbers, two at least; none where a cell is no number. An empty cell at
    /// the end is none.
    pub fn numbers(&self, line: &str) -> Option<usize> {
        let cells: Vec<_> = self.cells(line).collect();
        let (last, others) = cells.split_last()?;
        let count = if last.is_empty() { others.len() } else { cells.len() };
        let all = cells[..count].iter().all(|cell| Dialect::number(cell).is_some());
        (all && count >= 2).then_some(count)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cells(line: &str) -> Vec<&str> {
        Dialect::of(line).cells(line).collect()
    }

    #[test]
    fn cells_are_found_whatever_separates_them() {
        for line in ["1,-2.5,3", "1;-2.5;3", "1\t-2.5\t3", "1 -2.5  3", " 1 , -2.5 , 3 \r\n"] {
            assert_eq!(cells(line), ["1", "-2.5", "3"], "{line}");
        }
        assert_eq!(cells("\"1,5\",\"a\" , 3,"), ["1,5", "a", "3", ""]);
        assert_eq!(cells("1,5;;2"), ["1,5", "", "2"]);
    }

    #[test]
    fn a_comma_is_a_decimal_point_where_it_separates_nothing() {
        let number = Dialect::number;
        assert_eq!(
            [number("1,5"), number("-2.5E-3"), number("7")].map(Option::unwrap),
            [1.5, -2.5e-3, 7.0]
        );
        for bad in ["1.234,5", "1,2,3", "", "NaN", "inf", "∞", "0x10"] {
            assert_eq!(number(bad), None, "{bad}");
        }
        assert_eq!(Dialect::of("0;1,5;2;").numbers("0;1,5;2;"), Some(3));
        assert_eq!(Dialect::of("0,a").numbers("0,a"), None);
    }
}
