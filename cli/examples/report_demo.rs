// SPDX-License-Identifier: MIT OR Apache-2.0
//! Reports on made-up runs, to look at while working on the report: `cargo run -p hapticore
//! --example report_demo -- DIR`.
//!
//! The data only resemble a run: a rough sheet, a rough pull-in, a made-up noise.

use std::f64::consts::TAU;
use std::path::PathBuf;

use hapticore::report;
use hapticore_run::record::{
    Criterion, Effect, Quantities, Record, Reference, Row, SignalError, Truth,
};

fn main() -> std::io::Result<()> {
    let dir = PathBuf::from(std::env::args().nth(1).unwrap_or_else(|| ".".into()));
    std::fs::create_dir_all(&dir)?;
    let rows = [
        ("fig3", fig3()),
        ("fig4", sweep(&[20.0, 40.0, 60.0, 80.0, 100.0], 15)),
        ("fig6", sweep(&[20.0, 100.0], 36)),
    ];
    let rows =
        rows.into_iter().chain([("hockey", hockey()), ("other", hockey()), ("capture", capture())]);
    for (figure, rows) in rows {
        std::fs::write(
            dir.join(format!("{figure}.html")),
            report::html(&record(figure, rows), &[]),
        )?;
    }
    Ok(())
}

fn record(figure: &str, rows: Vec<Row>) -> Record {
    Record {
        scene: figure.into(),
        title: format!("Demonstration of {figure} <made up>"),
        summary: "Made-up numbers that resemble a run, so that the page can be looked at.".into(),
        figure: Some(figure.into()),
        profile: "paper".into(),
        fidelity: "fixed".into(),
        cases: if figure == "fig3" {
            CASES.iter().map(|c| c.0.to_string()).collect()
        } else {
            vec!["all".into()]
        },
        pads: ["left mallet", "right mallet", "puck", "spare"].map(String::from).to_vec(),
        effects: effects(),
        criteria: criteria(),
        errors: errors(),
        simulated_seconds: rows.last().map_or(0.0, |r| r.time_s),
        wall_seconds: 1.23,
        rows: rows.into_iter().collect(),
        ..Record::default()
    }
}

fn effects() -> Vec<Effect> {
    let effects = [
        ("sheet", "bicubic", 0.021),
        ("gap", "static", 0.43),
        ("noise", "on", 0.2),
        ("offset", "on", 1e-5),
    ];
    effects
        .map(|(name, level, seconds)| Effect {
            name: name.into(),
            level: level.into(),
            seconds,
            finer: None,
        })
        .to_vec()
}

fn criteria() -> Vec<Criterion> {
    let criterion =
        |name: &str, measured: f64, limit: f64, unit: &str, baseline: Option<(&str, f64)>| {
            Criterion {
                name: name.into(),
                measured,
                limit,
                pass: measured <= limit,
                applicable: true,
                bounds: None,
                unit: unit.into(),
                baseline: baseline.map(|(what, value)| (what.into(), value)),
            }
        };
    vec![
        criterion(
            "force spread over the sheet, pulled in",
            0.21,
            0.5,
            "%",
            Some(("eq. 6 alone", 4.7)),
        ),
        criterion("position", 0.12, 1.0, "mm", Some(("affine fit", 69.0))),
        criterion("force", 0.12, 0.1, "N", None),
    ]
}

fn errors() -> Vec<SignalError> {
    let error = |signal: &str, format: &str, max_error: f64, max_codes: f64| SignalError {
        signal: signal.into(),
        format: format.into(),
        max_error,
        max_codes,
    };
    vec![
        error("estimator.force_estimator.haptic_force", "u20.17", 6.1e-6, 0.8),
        error("demodulator.0.i", "s24.22", 1.2e-7, 0.5),
    ]
}

/// Name, series resistance of the sheet, capacitance.
const CASES: [(&str, f64, f64); 4] = [
    ("rest", 190.0, 318.0),
    ("500-ohm", 300.0, 318.0),
    ("500-ohm-760-pf", 300.0, 760.0),
    ("paper-760-pf", 500.0, 760.0),
];

fn fig3() -> Vec<Row> {
    let mut rows = Vec::new();
    for (case, (_, ohm, pf)) in CASES.into_iter().enumerate() {
        for point in 0..24 * 14 {
            let (x, y) =
                (f64::from(point % 24) * 36.0 - 414.0, f64::from(point / 24) * 36.0 - 234.0);
            let distance = (x / 430.0).powi(2) + (y / 250.0).powi(2);
            let sheet = ohm * (0.75 + 0.12 * distance);
            rows.push(slot(case, point, truth(x, y, pf, 150.0, 20.0, sheet, 0)));
        }
    }
    numbered(rows)
}

fn sweep(loads: &[f64], points: u32) -> Vec<Row> {
    let mut rows = Vec::new();
    for (l, load) in loads.iter().enumerate() {
        for point in 0..points {
            let volts = f64::from(point) / f64::from(points - 1) * 350.0;
            let pull = (0..8)
                .filter(|patch| volts > 230.0 + 15.0 * f64::from(*patch) - load / 2.0)
                .count();
            let pf = 300.0 + load / 2.0 + volts * volts / 5e3 + 40.0 * pull as f64;
            let group = l * points as usize + point as usize;
            for _ in 0..4 {
                rows.push(slot(0, point, truth(0.0, 0.0, pf, volts, *load, 140.0, group)));
            }
        }
    }
    numbered(rows)
}

fn hockey() -> Vec<Row> {
    let at = |pad: usize, t: f64| match pad {
        0 => (-280.0 + 90.0 * (TAU * 1.1 * t).sin(), 180.0 * (TAU * 0.7 * t).cos()),
        1 => (280.0 + 110.0 * (TAU * t / 0.9).cos(), 20.0 + 110.0 * (TAU * t / 0.9).sin()),
        2 => (-350.0 + 700.0 * t, -180.0 + 380.0 * t),
        _ => (-400.0, 225.0),
    };
    let rows = (0..4000_u32).map(|n| {
        let (pad, t) = (n as usize % 4, f64::from(n) / 4000.0);
        let (x, y) = at(pad, t);
        let volts = 150.0 + 25.0 * pad as f64 + 70.0 * (TAU * 2.0 * t).sin();
        Row {
            pad,
            time_s: t,
            ..slot(0, n, truth(x, y, 330.0 + volts / 5.0, volts, 30.0, 140.0, 0))
        }
    });
    rows.collect()
}

fn capture() -> Vec<Row> {
    hockey().into_iter().map(|row| Row { truth: None, reference: None, ..row }).collect()
}

fn numbered(rows: Vec<Row>) -> Vec<Row> {
    rows.into_iter().enumerate().map(|(n, row)| Row { time_s: n as f64 * 1e-3, ..row }).collect()
}

fn truth(
    x_mm: f64,
    y_mm: f64,
    capacitance_pf: f64,
    volts: f64,
    load_g: f64,
    sheet_ohm: f64,
    group: usize,
) -> Truth {
    let force_n = 6e-11 * (capacitance_pf * volts).powi(2) * (1.0 - 0.06 * (volts / 350.0).powi(3));
    let (r_x, r_y) = (x_mm / 550.0, y_mm / 320.0);
    let haptic_v_rms = volts;
    let quantities = Quantities {
        r_x,
        r_y,
        x_mm,
        y_mm,
        capacitance_pf,
        sheet_ohm,
        haptic_v_rms,
        force_n,
        direction: 0.0,
    };
    Truth { quantities, load_g, group, ..Truth::default() }
}

fn slot(case: usize, seed: u32, truth: Truth) -> Row {
    let noise = |salt: f64| {
        ((f64::from(seed) * 12.9898 + salt + truth.load_g).sin() * 43_758.545).fract() - 0.5
    };
    let q = truth.quantities;
    let ideal = Quantities { force_n: 6e-11 * (q.capacitance_pf * q.haptic_v_rms).powi(2), ..q };
    let tan = TAU * 1e5 * q.capacitance_pf * 1e-12 * q.sheet_ohm;
    let loss = 1.0 / (1.0 + tan * tan).sqrt();
    let measured = Quantities {
        x_mm: q.x_mm + 0.4 * noise(1.0) + q.y_mm / 900.0,
        y_mm: q.y_mm + 0.4 * noise(2.0),
        capacitance_pf: q.capacitance_pf * (1.0 + 8e-4 * noise(3.0)),
        force_n: ideal.force_n * (1.0 + 1.5e-3 * noise(3.0)),
        haptic_v_rms: q.haptic_v_rms + noise(4.0),
        ..q
    };
    let reference = Reference {
        quantities: ideal,
        capacitance_eq6_pf: q.capacitance_pf * loss,
        force_eq6_n: ideal.force_n * loss * loss,
    };
    Row {
        case,
        time_s: 0.0,
        pad: 0,
        measured,
        flags: String::new(),
        laws: None,
        truth: Some(truth),
        driven: None,
        game: None,
        reference: Some(reference),
    }
}
