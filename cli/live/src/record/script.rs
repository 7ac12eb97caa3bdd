// SPDX-License-Identifier: MIT OR Apache-2.0
//! What a scene does with a pad by itself, as knots: exactly where it stays or has a `timeline`, else sampled.

use hapticore_scene::{Plant, Scene, Timing};
use toml::{Table, Value};

/// Knots of a value over time: time, s, and value. Linear between them, held outside.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Script {
    pub knots: Vec<[f64; 2]>,
    /// The knots are samples of something else.
    pub is_sampled: bool,
}

impl Script {
    fn constant(value: f64) -> Script {
        Script { knots: vec![[0.0, value]], is_sampled: false }
    }

    fn of_timeline(value: &Value) -> Option<Script> {
        let knots = value.as_array()?.iter().map(pair).collect::<Option<Vec<_>>>()?;
        (!knots.is_empty()).then_some(Script { knots, is_sampled: false })
    }

    /// The value at a time, as a scene has it.
    pub fn at(&self, time_s: f64) -> f64 {
        let after = self.knots.partition_point(|knot| knot[0] <= time_s);
        match (after.checked_sub(1).map(|n| self.knots[n]), self.knots.get(after)) {
            (None, Some(first)) => first[1],
            (Some([t0, v0]), Some([t1, v1])) => v0 + (v1 - v0) * (time_s - t0) / (t1 - t0),
            (Some(last), None) => last[1],
            (None, None) => 0.0,
        }
    }

    /// The knots between two times.
    pub fn between(&self, from_s: f64, to_s: f64) -> impl Iterator<Item = [f64; 2]> {
        self.knots.iter().copied().filter(move |knot| from_s < knot[0] && knot[0] < to_s)
    }

    /// Whether the value changes at a time that is no knot, so that a knot there is rounded.
    pub fn slopes_at(&self, time_s: f64) -> bool {
        let after = self.knots.partition_point(|knot| knot[0] <= time_s);
        match (after.checked_sub(1).map(|n| self.knots[n]), self.knots.get(after)) {
            (Some(before), Some(after)) => before[1] != after[1] && before[0] != time_s,
            _ => false,
        }
    }
}

/// The scripts of a scene.
pub(super) struct Scripts<'a> {
    root: &'a Table,
    end_s: f64,
    /// Samples of every pad, once they are asked for: time, place, load, voltage, target.
    samples: Option<Vec<Vec<[f64; 6]>>>,
}

/// Times between samples, s.
const SAMPLE_S: f64 = 1e-3;

impl<'a> Scripts<'a> {
    /// Of a scene until this time.
    pub fn new(root: &'a Table, end_s: f64) -> Scripts<'a> {
        Scripts { root, end_s, samples: None }
    }

    /// A value over time that a table has under a key.
    pub fn of_key(table: &Table, key: &str, default: f64) -> Option<Script> {
        match table.get(key) {
            None => Some(Script::constant(default)),
            Some(value) => number(value)
                .map(Script::constant)
                .or_else(|| Script::of_timeline(value.get("timeline")?)),
        }
    }

    /// A pad's value under a key.
    pub fn value(&mut self, pad: usize, key: &str, default: f64) -> Result<Script, String> {
        let table = self.root["pad"][pad].as_table().ok_or("record: expected tables [[pad]]")?;
        if let Some(script) = Scripts::of_key(table, key, default) {
            return Ok(script);
        }
        match key {
            "load_g" => self.sampled(pad, 3),
            "haptic_v_rms" => self.sampled(pad, 4),
            "target_n" => self.sampled(pad, 5),
            _ => Err(format!(
                "record: pad.{pad}.{key}: expected a number or a timeline; to log writes others"
            )),
        }
    }

    /// A pad's place, along x and y.
    pub fn place(&mut self, pad: usize) -> Result<[Script; 2], String> {
        let place = &self.root["pad"][pad]["position_mm"];
        if let Some(mm) = pair(place) {
            return Ok(mm.map(Script::constant));
        }
        let axis = |key: &str| match place.get("timeline")?.get(key) {
            None => Some(Script::constant(0.0)),
            Some(knots) => Script::of_timeline(knots),
        };
        match (axis("x_mm"), axis("y_mm")) {
            (Some(x), Some(y)) => Ok([x, y]),
            _ => Ok([self.sampled(pad, 1)?, self.sampled(pad, 2)?]),
        }
    }

    fn sampled(&mut self, pad: usize, of: usize) -> Result<Script, String> {
        if self.samples.is_none() {
            self.samples = Some(self.sample().map_err(|error| format!("record: {error}"))?);
        }
        let samples = self.samples.as_ref().and_then(|samples| samples.get(pad));
        let knots = samples.into_iter().flatten().map(|sample| [sample[0], sample[of]]).collect();
        Ok(Script { knots, is_sampled: true })
    }

    /// What the pads are set to, of a scene without any effect.
    fn sample(&self) -> Result<Vec<Vec<[f64; 6]>>, hapticore_scene::SceneError> {
        const KEPT: [&str; 5] = ["position_mm", "over_edge", "load_g", "haptic_v_rms", "target_n"];
        let mut root = self.root.clone();
        root.retain(|key, _| ["title", "duration_s", "pad", "device"].contains(&key));
        let controlled = self.root.contains_key("control");
        if controlled {
            root.insert("control".into(), Value::Table(Table::new()));
        }
        let kept = |key: &str| KEPT.contains(&key) && (controlled || key != "target_n");
        let pads = root.get_mut("pad").and_then(Value::as_array_mut).into_iter().flatten();
        for pad in pads.filter_map(Value::as_table_mut) {
            pad.retain(|key, _| kept(key));
        }
        let scene = Scene::parse(&root.to_string(), "recorded.toml", &[])?;
        let pads = scene.cases[0].pad_names().len();
        let timing = Timing {
            pads,
            slot_samples: 2,
            window_start: 0,
            window_samples: 2,
            samples_per_period: 10.0,
            signs: None,
        };
        // The plant knows the sample rate.
        let rate_hz = Plant::new(&scene, 0, &timing)?.device().sample_rate_hz;
        let slot_samples = (rate_hz * SAMPLE_S / pads as f64).ceil() as usize;
        let mut plant = Plant::new(&scene, 0, &Timing { slot_samples, ..timing })?;
        let slots = (self.end_s / SAMPLE_S).ceil() as usize * pads + pads;
        let mut samples = vec![Vec::new(); pads];
        for slot in 0..slots {
            let truth = plant.truth(slot);
            let set = truth.set;
            samples[truth.pad].push([
                truth.time_s,
                set.x_mm,
                set.y_mm,
                set.load_g,
                set.haptic_v_rms,
                set.target_n,
            ]);
        }
        Ok(samples)
    }
}

fn number(value: &Value) -> Option<f64> {
    value.as_float().or(value.as_integer().map(|value| value as f64))
}

fn pair(value: &Value) -> Option<[f64; 2]> {
    let list = value.as_array().filter(|list| list.len() == 2)?;
    Some([number(&list[0])?, number(&list[1])?])
}
