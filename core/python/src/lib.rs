//! The Python door: what `rgp_core` exports, and nothing else. The typed surface is `rgp_core.pyi`.
#![forbid(unsafe_code)]

mod errors;
mod scene;
mod session;

use std::path::PathBuf;

use hw_skymodel::rgb::{SkyParams, SkyState};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use rgp_renderer::embree_version as version_of;
use rgp_renderer::render;
use rgp_renderer::settings::RenderSettings;

use errors::to_python;

/// Every setting with its range, default, unit and meaning.
#[pyfunction]
fn settings_schema(py: Python<'_>) -> PyResult<Bound<'_, PyAny>> {
    Ok(pythonize::pythonize(py, &RenderSettings::schema())?)
}

/// Raises when a group, a name or a value is not allowed.
#[pyfunction]
fn check_settings(settings: &Bound<'_, PyDict>) -> PyResult<()> {
    session::parse_settings(settings).map(|_| ())
}

/// What the sky model of Hosek and Wilkie 2012 tabulates for each of red, green and blue: nine parameters of the
/// distribution, and the mean radiance that it is multiplied by. The elevation is that of the sun (rad).
#[pyfunction]
fn hosek_wilkie(elevation: f32, turbidity: f32, albedo: f32) -> PyResult<Vec<([f32; 9], f32)>> {
    let params = SkyParams { elevation, turbidity, albedo: [albedo; 3] };
    let state = SkyState::new(&params).map_err(|error| PyValueError::new_err(error.to_string()))?;
    let (distributions, radiances) = state.raw();
    let (channels, _) = distributions.as_chunks::<9>();
    Ok(channels.iter().copied().zip(radiances).collect())
}

/// Version of the Embree library at a path.
#[pyfunction]
fn embree_version(embree_library: PathBuf) -> PyResult<String> {
    let (major, minor, patch) = version_of(&embree_library).map_err(to_python)?;
    Ok(format!("{major}.{minor}.{patch}"))
}

/// Gather rays of a render traced one by one, without shading, and the seconds that takes.
#[pyfunction]
fn trace_floor<'py>(
    py: Python<'py>,
    scene: &scene::Scene,
    settings: &Bound<'_, PyDict>,
    embree_library: PathBuf,
) -> PyResult<Bound<'py, PyAny>> {
    let settings = session::parse_settings(settings)?;
    let traced =
        py.detach(|| render::trace_floor(&scene.0, &settings, &embree_library)).map_err(to_python)?;
    Ok(pythonize::pythonize(py, &traced)?)
}

#[pymodule]
fn rgp_core(m: &Bound<'_, PyModule>) -> PyResult<()> {
    m.add("__version__", env!("CARGO_PKG_VERSION"))?;
    m.add("RenderError", m.py().get_type::<errors::RenderError>())?;
    m.add("SceneError", m.py().get_type::<errors::SceneError>())?;
    m.add("SettingsError", errors::settings_error(m.py())?)?;
    m.add("EmbreeError", m.py().get_type::<errors::EmbreeError>())?;
    m.add_function(wrap_pyfunction!(settings_schema, m)?)?;
    m.add_function(wrap_pyfunction!(check_settings, m)?)?;
    m.add_function(wrap_pyfunction!(embree_version, m)?)?;
    m.add_function(wrap_pyfunction!(hosek_wilkie, m)?)?;
    m.add_function(wrap_pyfunction!(trace_floor, m)?)?;
    m.add_class::<scene::SceneBuilder>()?;
    m.add_class::<scene::Scene>()?;
    m.add_class::<session::Session>()
}
