// SPDX-License-Identifier: MIT OR Apache-2.0
//! Where the terminals of `[sheet]` are: on the sheet's edge, mm from its middle.

use crate::error::SceneError;
use crate::few::Few;
use crate::format::{Key, Limits, Table, keys};

pub use hapticore_sheet::{LEAST_TERMINALS, MOST_TERMINALS};

/// ADC channels beside the terminals' currents: the sensing voltage, then the haptic voltage.
pub(crate) const VOLTAGES: usize = 2;

/// The most ADC channels.
pub(crate) const MOST_CHANNELS: usize = MOST_TERMINALS + VOLTAGES;

/// One value per terminal, held in place: no slot or sample allocates.
pub type PerTerminal<T> = Few<T, MOST_TERMINALS>;

keys! { KEYS:
    /// Places of 3 to 16 terminals on the sheet's edge, from its middle.
    TERMINALS_MM: Option<Vec<[f64; 2]>> = Key::pairs("terminals_mm").usually("the corners and the middles of two edges");
    /// Number of terminals: 4, the corners, or 6, with the middles of two edges.
    TERMINALS: Option<u64> =
        Key::whole("terminals", LEAST_TERMINALS as u64, MOST_TERMINALS as u64).usually("6");
    /// Terminals 5 and 6 are in the middles of the bottom and the top edge (`long`) or of the left and the right one.
    MIDDLES: &'static str = Key::choice("middles", || vec!["long", "short"]).or("long");
    /// Place of terminal 5 on the sheet's edge.
    TERMINAL_5_MM: Option<[f64; 2]> = Key::pair("terminal_5_mm", Limits::ANY).usually("as `middles` says");
    /// Place of terminal 6 on the sheet's edge.
    TERMINAL_6_MM: Option<[f64; 2]> = Key::pair("terminal_6_mm", Limits::ANY).usually("as `middles` says");
}

/// Keys that say where terminals are in another way than `terminals_mm`.
const OTHERS: [&str; 4] = ["terminals", "middles", "terminal_5_mm", "terminal_6_mm"];

/// How far off the edge a place still counts as on it, mm: what decimal fractions lose.
const SLACK_MM: f64 = 1e-6;

/// Places of the terminals on a sheet of this size, mm from its middle; a device without `[sheet]`
/// has six.
pub(crate) fn terminals_mm(root: &Table, size_mm: [f64; 2]) -> Result<Vec<[f64; 2]>, SceneError> {
    let edge = Edge { half: size_mm.map(|size| size / 2.0) };
    root.table("sheet")?.map_or_else(|| Ok(edge.usual("long")), |table| read(table, &edge))
}

/// The same from `[sheet]`.
fn read(table: &Table, edge: &Edge) -> Result<Vec<[f64; 2]>, SceneError> {
    let count = table.get(&TERMINALS)?.map(|count| count as usize);
    let middles = table.get(&MIDDLES)?;
    let fifth = edge.place(table, &TERMINAL_5_MM)?;
    let sixth = edge.place(table, &TERMINAL_6_MM)?;
    if let Some(places) = table.get(&TERMINALS_MM)? {
        return listed(table, edge, &places);
    }
    let mut places = edge.usual(middles);
    [fifth, sixth]
        .into_iter()
        .zip(&mut places[4..])
        .for_each(|(given, place)| *place = given.unwrap_or(*place));
    if places[4] == places[5] {
        let got = places[5];
        return Err(table.error(
            "terminal_6_mm",
            format!("expected a place other than terminal 5's, got {got:?}"),
        ));
    }
    match count {
        None | Some(6) => {}
        Some(4) => places.truncate(4),
        Some(count) => {
            let message = format!(
                "expected 4 or 6, got {count}; terminals_mm takes the places of any other number"
            );
            return Err(table.error("terminals", message));
        }
    }
    Ok(places)
}

/// The places that `terminals_mm` lists.
fn listed(table: &Table, edge: &Edge, places: &[[f64; 2]]) -> Result<Vec<[f64; 2]>, SceneError> {
    let fail = |message: String| Err(table.error("terminals_mm", message));
    if let Some(other) = OTHERS.into_iter().find(|key| table.node(key).is_some()) {
        return Err(
            table.error(other, "expected none, since terminals_mm says where all terminals are")
        );
    }
    if !(LEAST_TERMINALS..=MOST_TERMINALS).contains(&places.len()) {
        return fail(format!(
            "expected {LEAST_TERMINALS} to {MOST_TERMINALS} places, got {}",
            places.len()
        ));
    }
    let mut terminals: Vec<[f64; 2]> = Vec::new();
    for (n, place) in places.iter().enumerate() {
        let Some(place) = edge.hold(*place) else {
            let [x, y] = edge.half;
            let expected = format!("expected places on the sheet's edge, x = ±{x} or y = ±{y}");
            return fail(format!("{expected}, got {place:?} as terminal {}", n + 1));
        };
        if let Some(same) = terminals.iter().position(|other| *other == place) {
            return fail(format!(
                "expected different places, got {place:?} as terminals {} and {}",
                same + 1,
                n + 1
            ));
        }
        terminals.push(place);
    }
    Ok(terminals)
}

/// The sheet's edge, by half its width and height.
struct Edge {
    half: [f64; 2],
}

impl Edge {
    /// The corners, then two edges' middles.
    fn usual(&self, middles: &str) -> Vec<[f64; 2]> {
        let [x, y] = self.half;
        let [fifth, sixth] =
            if middles == "short" { [[-x, 0.0], [x, 0.0]] } else { [[0.0, -y], [0.0, y]] };
        vec![[-x, y], [-x, -y], [x, -y], [x, y], fifth, sixth]
    }

    /// A place on the edge, put on it exactly.
    fn hold(&self, place: [f64; 2]) -> Option<[f64; 2]> {
        let beyond = [0, 1].map(|axis| place[axis].abs() - self.half[axis]);
        let on_edge =
            beyond.iter().any(|mm| mm.abs() <= SLACK_MM) && beyond.iter().all(|mm| *mm <= SLACK_MM);
        let held = |axis: usize| match beyond[axis].abs() <= SLACK_MM {
            true => self.half[axis].copysign(place[axis]),
            false => place[axis],
        };
        on_edge.then(|| [held(0), held(1)])
    }

    /// A place on the edge between corners.
    fn place(
        &self,
        table: &Table,
        key: &Key<Option<[f64; 2]>>,
    ) -> Result<Option<[f64; 2]>, SceneError> {
        let Some(place) = table.get(key)? else { return Ok(None) };
        let [x, y] = self.half;
        match self.hold(place).filter(|[at_x, at_y]| at_x.abs() < x || at_y.abs() < y) {
            Some(place) => Ok(Some(place)),
            None => {
                let expected = "expected a place on the sheet's edge between corners";
                Err(table.error(
                    key.about.name,
                    format!("{expected}, x = ±{x} or y = ±{y}, got {place:?}"),
                ))
            }
        }
    }
}
