// SPDX-License-Identifier: MIT OR Apache-2.0
//! The curves of the page.

use plotters::coord::Shift;
use plotters::prelude::*;
use plotters::style::RGBColor;

use super::lock_in::amplitude::{Point, Sweep, sweeps};

const SIZE: (u32, u32) = (960, 420);

/// Colours that readers who confuse red and green can distinguish (Okabe and Ito).
const COLOURS: [RGBColor; 3] =
    [RGBColor(0x00, 0x72, 0xb2), RGBColor(0xd5, 0x5e, 0x00), RGBColor(0x00, 0x9e, 0x73)];

/// The figure of a name.
///
/// # Panics
/// Where there is none of that name.
pub fn svg(name: &str) -> String {
    let mut text = String::new();
    {
        let area = SVGBackend::with_string(&mut text, SIZE).into_drawing_area();
        match name {
            "amplitude" => amplitude(&area),
            _ => panic!("no figure {name}"),
        }
        .expect("a text can be drawn into");
    }
    text
}

type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;
/// An error of a point.
type Of = fn(&Point) -> f64;
type Drawn = Result<(), Box<dyn std::error::Error>>;

fn amplitude(area: &Area<'_>) -> Drawn {
    area.fill(&WHITE)?;
    let halves = area.split_evenly((1, 2));
    for (half, (dither, title)) in
        halves.iter().zip([(true, "Noise of ½ LSB rms"), (false, "No noise")])
    {
        draw(half, title, sweeps(dither))?;
    }
    Ok(())
}

fn draw(area: &Area<'_>, title: &str, sweeps: &[Sweep]) -> Drawn {
    let mut chart = ChartBuilder::on(area)
        .caption(title, ("sans-serif", 16))
        .margin(8)
        .x_label_area_size(40)
        .y_label_area_size(56)
        .build_cartesian_2d((1f64..131_072f64).log_scale(), (1e-5f64..100f64).log_scale())?;
    chart
        .configure_mesh()
        .x_desc("amplitude of the largest current, LSB of the ADC")
        .y_desc("error of the capacitance, % rms")
        .x_label_formatter(&|x| format!("{x:.0}"))
        .y_label_formatter(&|y| format!("{y}"))
        .light_line_style(WHITE)
        .draw()?;
    let kinds: [(&str, Of); 3] = [
        ("core", |point| point.core),
        ("floating point", |point| point.float),
        ("idsp", |point| point.idsp),
    ];
    for (sweep, colour) in sweeps.iter().zip(COLOURS) {
        for (n, (kind, of)) in kinds.into_iter().enumerate() {
            if n == 2 && sweep.name != "standard" {
                continue; // one curve of idsp is enough
            }
            let line = if n == 2 {
                BLACK.mix(0.7).stroke_width(1)
            } else {
                colour.mix([1.0, 0.4][n]).stroke_width([2, 5][n])
            };
            let points = sweep.points.iter().map(|point| (point.steps, of(point).max(1e-5)));
            let label =
                if n == 2 { "idsp, 18 bits".into() } else { format!("{kind}, {}", sweep.name) };
            chart
                .draw_series(LineSeries::new(points, line))?
                .label(label)
                .legend(move |(x, y)| PathElement::new([(x, y), (x + 18, y)], line));
        }
    }
    chart
        .configure_series_labels()
        .position(SeriesLabelPosition::UpperRight)
        .background_style(WHITE.mix(0.8))
        .border_style(BLACK.mix(0.3))
        .draw()?;
    Ok(())
}
