// SPDX-License-Identifier: MIT OR Apache-2.0
//! The live page, served from a thread.

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::channel;
use std::sync::{Arc, Mutex};
use std::thread::{self, JoinHandle};

use anyhow::{Context, Result, ensure};
use hapticore_live::protocol::{Opening, SPEEDS};
use hapticore_live::server::{Config, Server};
use pyo3::prelude::*;

use crate::apart::{apart, held};
use crate::failure;

/// A server of the live page.
#[pyclass(frozen, module = "hapticore._core")]
pub struct Page {
    url: String,
    stops: Arc<AtomicBool>,
    thread: Mutex<Option<JoinHandle<()>>>,
}

impl Page {
    fn serve(config: Config) -> Result<Page> {
        let stops = Arc::new(AtomicBool::new(false));
        let (asked, (bound, binding)) = (stops.clone(), channel());
        let thread = thread::Builder::new().name("live".into()).spawn(move || {
            let server = Server::bind(config);
            let _ = bound.send(match &server {
                Ok(server) => Ok(server.url()),
                Err(error) => Err(anyhow::anyhow!("{error:#}")),
            });
            // What ends a server early is that no thread can be started: then no connection is answered.
            let _ = server.map(|server| server.run(&|| asked.load(Ordering::Relaxed)));
        })?;
        let url = binding.recv().context("live: the server has ended")??;
        Ok(Page { url, stops, thread: Mutex::new(Some(thread)) })
    }
}

#[pymethods]
impl Page {
    #[new]
    #[pyo3(signature = (scene, *, set, core, case, profile, port, speed))]
    #[expect(clippy::too_many_arguments, reason = "as Python's keywords")]
    fn new(
        py: Python<'_>,
        scene: String,
        set: Vec<(String, String)>,
        core: String,
        case: Option<String>,
        profile: Option<String>,
        port: u16,
        speed: f64,
    ) -> PyResult<Page> {
        apart(py, || {
            let [least, most] = SPEEDS;
            let within = speed == 0.0 || (least..=most).contains(&speed);
            ensure!(within, "speed: expected 0, or {least} to {most}, got {speed}");
            failure::scene(&scene, &set)?;
            let opening = Opening { scene, set, case, profile, core: Some(core) };
            Page::serve(Config { opening, port, listen: None, speed })
        })
    }

    /// The page's address.
    #[getter]
    fn url(&self) -> &str {
        &self.url
    }

    /// Ends the server; later calls do nothing.
    fn close(&self, py: Python<'_>) {
        py.detach(|| {
            self.stops.store(true, Ordering::Relaxed);
            let thread = held(&self.thread).take();
            thread.map(JoinHandle::join);
        });
    }
}

impl Drop for Page {
    fn drop(&mut self) {
        self.stops.store(true, Ordering::Relaxed);
    }
}
