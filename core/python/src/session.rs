//! One render on a thread of its own, watched from Python.

use std::path::PathBuf;
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::thread::JoinHandle;
use std::time::Duration;

use numpy::ndarray::{Array3, Array4, ShapeBuilder};
use numpy::{IntoPyArray, PyArray3, PyArray4, PyReadonlyArray4};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use rgp_renderer::error::RenderError as CoreError;
use rgp_renderer::film::{Film, FilmState};
use rgp_renderer::progress::Progress;
use rgp_renderer::render::{check_memory, fingerprint, render};
use rgp_renderer::scene;
use rgp_renderer::settings::RenderSettings;
use rgp_renderer::stats::Stats;

use crate::errors::{RenderError, to_python};
use crate::scene::Scene;

/// What the thread that renders shares with those that watch.
struct Shared {
    film: Film,
    progress: Progress,
    stats: Mutex<Stats>,
    ended: Mutex<bool>,
    signal: Condvar,
}

type Outcome = Result<(), CoreError>;

/// One render.
#[pyclass(module = "rgp_core", frozen)]
pub(crate) struct Session {
    scene: Arc<scene::Scene>,
    settings: RenderSettings,
    library: PathBuf,
    shared: Arc<Shared>,
    thread: Mutex<Option<JoinHandle<Outcome>>>,
}

#[pymethods]
impl Session {
    #[new]
    fn new(scene: &Scene, settings: &Bound<'_, PyDict>, embree_library: PathBuf) -> PyResult<Self> {
        let settings = parse_settings(settings)?;
        check_memory(&scene.0, &settings).map_err(to_python)?;
        let [_, _, width, height] = scene.0.camera.region;
        let shared = Shared {
            film: Film::new(width, height, &settings.film),
            progress: Progress::default(),
            stats: Mutex::default(),
            ended: Mutex::new(false),
            signal: Condvar::new(),
        };
        Ok(Self {
            scene: Arc::clone(&scene.0),
            settings,
            library: embree_library,
            shared: Arc::new(shared),
            thread: Mutex::new(None),
        })
    }

    fn fingerprint(&self, py: Python<'_>) -> String {
        format!("{:016x}", py.detach(|| fingerprint(&self.scene, &self.settings)))
    }

    fn film_state<'py>(&self, py: Python<'py>) -> PyResult<Option<(u32, Bound<'py, PyArray4<f32>>)>> {
        let film = &self.shared.film;
        let Some(FilmState { passes, size, sums, values_per_pixel }) = py.detach(|| film.state()) else {
            return Ok(None);
        };
        let [width, height] = size;
        let array = Array4::from_shape_vec((2, height, width, values_per_pixel), sums);
        let array = array.map_err(|e| RenderError::new_err(e.to_string()))?;
        Ok(Some((passes, array.into_pyarray(py))))
    }

    fn restore_film(&self, passes: u32, sums: PyReadonlyArray4<'_, f32>) -> PyResult<()> {
        let thread = lock(&self.thread);
        if thread.is_some() || *lock(&self.shared.ended) {
            return Err(RenderError::new_err("this session has been started already"));
        }
        let sums = sums.as_array();
        let (_, height, width, values_per_pixel) = sums.dim();
        let sums = sums.iter().copied().collect();
        let state = FilmState { passes, size: [width, height], sums, values_per_pixel };
        let restored = self.shared.film.restore(&state, self.scene.world.film_transparent);
        restored.map_err(to_python)
    }

    fn start(&self) -> PyResult<()> {
        let mut thread = lock(&self.thread);
        if thread.is_some() || *lock(&self.shared.ended) {
            return Err(RenderError::new_err("this session has been started already"));
        }
        let (scene, settings, library) =
            (Arc::clone(&self.scene), self.settings.clone(), self.library.clone());
        let shared = Arc::clone(&self.shared);
        let work = move || {
            let _announce = AnnounceEnd(Arc::clone(&shared));
            let mut stats = Stats::default();
            let result = render(&scene, &settings, &library, &shared.film, &shared.progress, &mut stats);
            *lock(&shared.stats) = stats;
            result
        };
        let spawned = std::thread::Builder::new().name("rgp render".into()).spawn(work);
        *thread = Some(spawned.map_err(|e| RenderError::new_err(format!("no thread for the render: {e}")))?);
        Ok(())
    }

    fn cancel(&self) {
        self.shared.progress.cancel();
    }

    fn wait(&self, py: Python<'_>, timeout_seconds: f64) -> bool {
        let timeout = Duration::try_from_secs_f64(timeout_seconds.clamp(0.0, 1e9)).unwrap_or(Duration::MAX);
        py.detach(|| {
            let ended = lock(&self.shared.ended);
            let waited = self.shared.signal.wait_timeout_while(ended, timeout, |ended| !*ended);
            *waited.unwrap_or_else(PoisonError::into_inner).0
        })
    }

    fn progress<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let now = self.shared.progress.snapshot();
        let dict = PyDict::new(py);
        dict.set_item("stage", now.stage.label())?;
        dict.set_item("fraction", now.fraction)?;
        dict.set_item("passes_done", now.passes_done)?;
        dict.set_item("passes_total", now.passes_total)?;
        dict.set_item("seconds_elapsed", now.elapsed.as_secs_f64())?;
        dict.set_item("seconds_left", now.left.map(|left| left.as_secs_f64()))?;
        dict.set_item("error", now.outlook.map(|outlook| outlook.error))?;
        dict.set_item("error_at_end", now.outlook.map(|outlook| outlook.error_at_end))?;
        dict.set_item("seconds_to_target", now.outlook.and_then(|outlook| outlook.seconds_to_target))?;
        dict.set_item("memory_bytes", memory_stats::memory_stats().map_or(0, |memory| memory.physical_mem))?;
        Ok(dict)
    }

    fn picture<'py>(&self, py: Python<'py>, layer: &str) -> PyResult<Bound<'py, PyArray3<f32>>> {
        let film = &self.shared.film;
        let (pixels, channels) = match layer {
            "combined" => (py.detach(|| film.combined()), 4),
            "indirect" => (py.detach(|| film.indirect()), 3),
            "shadow_catcher" => (py.detach(|| film.shadow_catcher()), 3),
            "error" => (py.detach(|| film.error()), 1),
            "audit" => (py.detach(|| film.audit()), 1),
            other => {
                let known = "combined, indirect, shadow_catcher, error and audit";
                let message = format!("there is no layer '{other}'; there are {known}");
                return Err(PyValueError::new_err(message));
            }
        };
        let [width, height] = film.size();
        let array = Array3::from_shape_vec((height, width, channels).into_shape_with_order(), pixels);
        let array = array.map_err(|e| RenderError::new_err(e.to_string()))?;
        Ok(array.into_pyarray(py))
    }

    fn stats<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let stats = lock(&self.shared.stats).clone();
        let dict = pythonize::pythonize(py, &stats)?;
        dict.set_item("settings", pythonize::pythonize(py, &self.settings)?)?;
        Ok(dict)
    }

    fn finish(&self, py: Python<'_>) -> PyResult<bool> {
        let thread = lock(&self.thread).take();
        let Some(thread) = thread else {
            return Err(RenderError::new_err("this session is not running"));
        };
        match py.detach(|| thread.join()) {
            Ok(Ok(())) => Ok(true),
            Ok(Err(CoreError::Cancelled)) => Ok(false),
            Ok(Err(error)) => Err(to_python(error)),
            Err(panic) => Err(to_python(CoreError::Internal(panic_text(panic.as_ref())))),
        }
    }
}

impl Drop for Session {
    /// A session nobody waits for stops soon by itself.
    fn drop(&mut self) {
        self.shared.progress.cancel();
    }
}

/// Tells those who wait that the render has ended, also when it panicked.
struct AnnounceEnd(Arc<Shared>);

impl Drop for AnnounceEnd {
    fn drop(&mut self) {
        *lock(&self.0.ended) = true;
        self.0.signal.notify_all();
    }
}

/// Settings from a dictionary of groups.
pub(crate) fn parse_settings(settings: &Bound<'_, PyDict>) -> PyResult<RenderSettings> {
    let value: serde_json::Value = pythonize::depythonize(settings.as_any())
        .map_err(|e| to_python(CoreError::Settings(format!("settings: {e}"))))?;
    RenderSettings::from_json(&value).map_err(to_python)
}

fn panic_text(panic: &(dyn std::any::Any + Send)) -> String {
    let text = panic.downcast_ref::<&str>().map(|s| (*s).to_owned());
    text.or_else(|| panic.downcast_ref::<String>().cloned()).unwrap_or_else(|| "unknown".into())
}

fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    // What is behind these locks is only ever replaced whole.
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}
