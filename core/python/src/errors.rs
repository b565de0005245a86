//! The one mapping from the renderer's errors to Python's.

use pyo3::create_exception;
use pyo3::exceptions::{PyException, PyValueError};
use pyo3::prelude::*;
use pyo3::sync::PyOnceLock;
use pyo3::types::{PyDict, PyTuple, PyType};
use rgp_renderer::error::RenderError as CoreError;

create_exception!(rgp_core, RenderError, PyException, "A render that cannot be made.");
create_exception!(rgp_core, SceneError, RenderError, "A scene that cannot be rendered.");
create_exception!(
    rgp_core,
    EmbreeError,
    RenderError,
    "The Embree library is missing, of another version, or failed."
);

static SETTINGS_ERROR: PyOnceLock<Py<PyType>> = PyOnceLock::new();

/// `SettingsError`, a `RenderError` that also is a `ValueError`.
pub(crate) fn settings_error(py: Python<'_>) -> PyResult<Bound<'_, PyType>> {
    let made = SETTINGS_ERROR.get_or_try_init(py, || {
        let bases = PyTuple::new(py, [py.get_type::<RenderError>(), py.get_type::<PyValueError>()])?;
        let members = PyDict::new(py);
        members.set_item("__module__", "rgp_core")?;
        members.set_item("__doc__", "An unknown setting or a value out of range.")?;
        let made = py.get_type::<PyType>().call1(("SettingsError", bases, members))?;
        Ok::<_, PyErr>(made.cast_into::<PyType>()?.unbind())
    })?;
    Ok(made.bind(py).clone())
}

/// The Python exception for a renderer error.
pub(crate) fn to_python(error: CoreError) -> PyErr {
    let message = error.to_string();
    match error {
        CoreError::Scene(_) => SceneError::new_err(message),
        CoreError::Settings(_) => Python::attach(|py| match settings_error(py) {
            Ok(kind) => PyErr::from_type(kind, message),
            Err(error) => error,
        }),
        CoreError::Embree(_) => EmbreeError::new_err(message),
        CoreError::Memory(_) | CoreError::Cancelled | CoreError::Internal(_) => RenderError::new_err(message),
    }
}
