//! Building a scene from numpy arrays and plain dictionaries.

use std::sync::Arc;

use numpy::{PyReadonlyArrayDyn, PyUntypedArrayMethods};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList};
use rgp_renderer::error::RenderError;
use rgp_renderer::scene::{self as core, CornerLayer, MeshArrays, record};
use rgp_renderer::shader::{Encoding, Pixels, Texture};
use serde::de::DeserializeOwned;

use crate::errors::{SceneError, to_python};

/// Takes the parts of a scene in any order; `finish` checks them.
#[pyclass(module = "rgp_core")]
#[derive(Default)]
pub(crate) struct SceneBuilder(core::SceneBuilder);

/// A checked scene.
#[pyclass(module = "rgp_core", frozen)]
pub(crate) struct Scene(pub(crate) Arc<core::Scene>);

#[pymethods]
impl SceneBuilder {
    #[new]
    fn new() -> Self {
        Self::default()
    }

    fn add_material(&mut self, record: &Bound<'_, PyDict>) -> PyResult<usize> {
        Ok(self.0.add_material(parse(record, "material")?))
    }

    #[pyo3(signature = (name, pixels, encoding))]
    fn add_texture(&mut self, name: &str, pixels: &Bound<'_, PyAny>, encoding: &str) -> PyResult<usize> {
        let encoding = match encoding {
            "linear" => Encoding::Linear,
            "srgb" => Encoding::Srgb,
            other => {
                return Err(SceneError::new_err(format!("image '{name}': there is no encoding '{other}'")));
            }
        };
        let (size, pixels) = match pixels.extract::<PyReadonlyArrayDyn<'_, u8>>() {
            Ok(bytes) => (size_of_image(name, bytes.shape())?, Pixels::Bytes(texels(&bytes))),
            Err(_) => {
                let floats = pixels.extract::<PyReadonlyArrayDyn<'_, f32>>()?;
                (size_of_image(name, floats.shape())?, Pixels::Floats(texels(&floats)))
            }
        };
        let texture = Texture::new(size, pixels, encoding)
            .map_err(|fault| SceneError::new_err(format!("image '{name}': {fault}")))?;
        Ok(self.0.add_texture(texture))
    }

    #[pyo3(signature = (name, positions, triangles, corner_normals=None, layers=None, slots=None))]
    fn add_mesh(
        &mut self,
        name: String,
        positions: PyReadonlyArrayDyn<'_, f32>,
        triangles: PyReadonlyArrayDyn<'_, u32>,
        corner_normals: Option<PyReadonlyArrayDyn<'_, f32>>,
        layers: Option<Vec<(u32, PyReadonlyArrayDyn<'_, f32>)>>,
        slots: Option<PyReadonlyArrayDyn<'_, u16>>,
    ) -> PyResult<usize> {
        let arrays = MeshArrays {
            positions: rows(&name, "positions", &positions, &[3])?,
            steps: Vec::new(),
            triangles: rows(&name, "triangles", &triangles, &[3])?,
            corner_normals: match corner_normals {
                Some(array) => corners(rows::<f32, 9>(&name, "corner_normals", &array, &[3, 3])?),
                None => Vec::new(),
            },
            layers: (layers.unwrap_or_default().iter())
                .map(|(attribute, array)| layer(&name, *attribute, array))
                .collect::<PyResult<_>>()?,
            slots: match slots {
                Some(array) => rows::<u16, 1>(&name, "slots", &array, &[])?.into_flattened(),
                None => Vec::new(),
            },
            name,
        };
        self.0.add_mesh(arrays).map_err(to_python)
    }

    fn add_object(
        &mut self,
        name: &str,
        mesh: usize,
        world_from_object: PyReadonlyArrayDyn<'_, f64>,
        materials: Vec<u32>,
        visibility: u32,
    ) -> PyResult<usize> {
        let matrix: Vec<[f64; 4]> = rows(name, "world_from_object", &world_from_object, &[4])?;
        let matrix: [[f64; 4]; 4] = matrix
            .try_into()
            .map_err(|_| SceneError::new_err(format!("'{name}': world_from_object is not 4 x 4")))?;
        self.0.add_object(name, mesh, record::matrix(&matrix), materials, visibility).map_err(to_python)
    }

    fn set_object_motion(&mut self, index: usize, steps: PyReadonlyArrayDyn<'_, f64>) -> PyResult<()> {
        let matrices: Vec<[f64; 16]> = rows("in motion", "steps", &steps, &[4, 4])?;
        let matrix =
            |m: &[f64; 16]| record::matrix(&std::array::from_fn(|i| std::array::from_fn(|j| m[4 * i + j])));
        let matrices: Vec<_> = matrices.iter().map(matrix).collect();
        self.0.set_object_motion(index, &matrices).map_err(to_python)
    }

    fn set_mesh_motion(
        &mut self,
        index: usize,
        steps: Vec<Option<PyReadonlyArrayDyn<'_, f32>>>,
    ) -> PyResult<()> {
        let rows = |step: &PyReadonlyArrayDyn<'_, f32>| rows("in motion", "a step", step, &[3]);
        let steps = steps.iter().map(|step| step.as_ref().map(rows).transpose()).collect::<PyResult<_>>()?;
        self.0.set_mesh_motion(index, steps).map_err(to_python)
    }

    fn set_object_info(&mut self, index: usize, record: &Bound<'_, PyDict>) -> PyResult<()> {
        self.0.set_object_info(index, parse(record, "object")?).map_err(to_python)
    }

    fn set_object_links(&mut self, index: usize, record: &Bound<'_, PyDict>) -> PyResult<()> {
        self.0.set_object_links(index, parse(record, "object")?).map_err(to_python)
    }

    fn add_lamp(&mut self, record: &Bound<'_, PyDict>) -> PyResult<usize> {
        Ok(self.0.add_lamp(parse(record, "lamp")?))
    }

    fn set_camera(&mut self, record: &Bound<'_, PyDict>) -> PyResult<()> {
        self.0.set_camera(parse(record, "camera")?);
        Ok(())
    }

    fn set_world(&mut self, record: &Bound<'_, PyDict>) -> PyResult<()> {
        self.0.set_world(parse(record, "world")?);
        Ok(())
    }

    fn finish(&mut self, py: Python<'_>) -> PyResult<Scene> {
        let builder = std::mem::take(&mut self.0);
        let scene = py.detach(|| builder.finish()).map_err(to_python)?;
        Ok(Scene(Arc::new(scene)))
    }
}

#[pymethods]
impl Scene {
    #[getter]
    fn problems<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyList>> {
        Ok(pythonize::pythonize(py, &self.0.problems)?.cast_into::<PyList>()?)
    }

    #[getter]
    fn triangle_count(&self) -> usize {
        self.0.objects.iter().map(|object| object.mesh.triangles.len()).sum()
    }
}

/// A record from a dictionary; a wrong key or type says which.
fn parse<T: DeserializeOwned>(record: &Bound<'_, PyDict>, what: &str) -> PyResult<T> {
    pythonize::depythonize(record.as_any()).map_err(|e| {
        let name = record.get_item("name").ok().flatten().map_or(String::new(), |name| format!(" '{name}'"));
        to_python(RenderError::Scene(format!("{what}{name}: {e}")))
    })
}

/// An array of shape (n, *inner) as n rows of N values.
fn rows<T: numpy::Element + Copy + Default, const N: usize>(
    name: &str,
    what: &str,
    array: &PyReadonlyArrayDyn<'_, T>,
    inner: &[usize],
) -> PyResult<Vec<[T; N]>> {
    let shape = array.shape();
    if shape.len() != inner.len() + 1 || &shape[1..] != inner {
        let wanted: String = inner.iter().map(|n| format!(", {n}")).collect();
        let message = format!("mesh '{name}': {what} has the shape {shape:?}; it should be (n{wanted})");
        return Err(SceneError::new_err(message));
    }
    let mut out = vec![[T::default(); N]; shape[0]];
    // numpy calls an array in Fortran's order contiguous too: Blender's matrices come that way.
    match array.as_slice().ok().filter(|_| array.is_c_contiguous()) {
        Some(values) => out.as_flattened_mut().copy_from_slice(values),
        None => {
            for (to, from) in out.as_flattened_mut().iter_mut().zip(array.as_array().iter()) {
                *to = *from;
            }
        }
    }
    Ok(out)
}

/// A layer of values at corners from an array of shape (T, 3, channels).
fn layer(name: &str, attribute: u32, array: &PyReadonlyArrayDyn<'_, f32>) -> PyResult<CornerLayer> {
    match *array.shape() {
        [_, 3, channels @ 1..=4] => {
            Ok(CornerLayer { attribute, channels, values: array.as_array().iter().copied().collect() })
        }
        ref other => {
            let message =
                format!("mesh '{name}': a layer has the shape {other:?}; it should be (n, 3, 1 to 4)");
            Err(SceneError::new_err(message))
        }
    }
}

/// Width and height of an array of shape (height, width, 4).
fn size_of_image(name: &str, shape: &[usize]) -> PyResult<[usize; 2]> {
    match *shape {
        [height, width, 4] => Ok([width, height]),
        ref other => {
            let message = format!("image '{name}' has the shape {other:?}; it should be (height, width, 4)");
            Err(SceneError::new_err(message))
        }
    }
}

fn texels<T: numpy::Element + Copy + Default>(array: &PyReadonlyArrayDyn<'_, T>) -> Vec<[T; 4]> {
    let values: Vec<T> = match array.as_slice().ok().filter(|_| array.is_c_contiguous()) {
        Some(values) => values.to_vec(),
        None => array.as_array().iter().copied().collect(),
    };
    values.as_chunks().0.to_vec()
}

/// Rows of three corners.
fn corners<const N: usize, const M: usize>(rows: Vec<[f32; N]>) -> Vec<[[f32; M]; 3]> {
    let corner = |row: &[f32; N], c: usize| std::array::from_fn(|i| row[c * M + i]);
    rows.iter().map(|row| std::array::from_fn(|c| corner(row, c))).collect()
}
