//! Meshes as they arrive, what is dropped from them, and their way into scene space.

use std::iter::once;

use glam::{DAffine3, DMat3, DVec3, Vec3};

use super::builder::Problems;
use super::motion::MOST_STEPS;
use super::{CornerLayer, Mesh};
use crate::error::RenderError;

/// A mesh in its object's space, as the host hands it over.
#[derive(Debug, Default)]
pub struct MeshArrays {
    /// Blender's name, for messages.
    pub name: String,
    /// Vertex positions (m).
    pub positions: Vec<[f32; 3]>,
    /// The same at even times while the shutter is open, the middle left out; empty where they stay the same.
    pub steps: Vec<Vec<[f32; 3]>>,
    /// Vertex indices.
    pub triangles: Vec<[u32; 3]>,
    /// Normal at each corner of each triangle; empty: flat.
    pub corner_normals: Vec<[[f32; 3]; 3]>,
    /// Values at the corners that materials ask for: texture coordinates, colors.
    pub layers: Vec<CornerLayer>,
    /// Material slot of each triangle; empty: slot 0.
    pub slots: Vec<u16>,
}

impl MeshArrays {
    pub(super) fn check_lengths(&self) -> Result<(), RenderError> {
        let fault = |what: String| Err(RenderError::Scene(format!("mesh '{}': {what}", self.name)));
        let count = self.triangles.len();
        for (len, what) in
            [(self.corner_normals.len(), "corner normals"), (self.slots.len(), "material slots")]
        {
            if len != 0 && len != count {
                return fault(format!("{len} {what} for {count} triangles"));
            }
        }
        for layer in &self.layers {
            if !(1..=4).contains(&layer.channels) || layer.values.len() != count * 3 * layer.channels {
                return fault(format!(
                    "{} values of {} channels for the corners of {count} triangles",
                    layer.values.len(),
                    layer.channels
                ));
            }
        }
        let vertices = self.positions.len();
        if !is_step_count(self.steps.len()) || self.steps.iter().any(|step| step.len() != vertices) {
            return fault(format!("its steps are not two or more, in pairs, of {vertices} positions each"));
        }
        match self.triangles.iter().flatten().find(|&&v| v as usize >= vertices) {
            Some(v) => fault(format!("a triangle uses vertex {v} of {vertices}")),
            None => Ok(()),
        }
    }

    /// Drops triangles with corners that are not finite or without area, which have no normal.
    pub(super) fn drop_bad_triangles(&mut self, problems: &mut Problems) {
        let (mut not_finite, mut no_area) = (0, 0);
        let positions = &self.positions;
        let keep: Vec<bool> = self
            .triangles
            .iter()
            .map(|triangle| {
                let [a, b, c] = triangle.map(|v| Vec3::from(positions[v as usize]).as_dvec3());
                let bad = !(a.is_finite() && b.is_finite() && c.is_finite());
                let flat = !bad && is_degenerate([a, b, c]);
                not_finite += u64::from(bad);
                no_area += u64::from(flat);
                !(bad || flat)
            })
            .collect();
        problems.add(&self.name, "triangles with a vertex that is not a number are left out", not_finite);
        problems.add(&self.name, "triangles without area are left out", no_area);
        if not_finite + no_area > 0 {
            retain(&mut self.triangles, &keep);
            retain(&mut self.corner_normals, &keep);
            self.layers.iter_mut().for_each(|layer| layer.retain(&keep));
            retain(&mut self.slots, &keep);
        }
        let is_bad = |p: &[f32; 3]| !Vec3::from(*p).is_finite();
        if self.steps.iter().flatten().any(is_bad) {
            problems.add(&self.name, "it moves to where is no number; its shape is not blurred", 1);
            self.steps.clear();
        }
        let mut used = vec![false; self.positions.len()];
        self.triangles.iter().flatten().for_each(|&v| used[v as usize] = true);
        if used.contains(&false) {
            self.drop_unused_vertices();
        }
    }

    /// Vertices no triangle uses must not widen the bounds.
    fn drop_unused_vertices(&mut self) {
        let mut new_index = vec![u32::MAX; self.positions.len()];
        let mut kept = Vec::new();
        for v in self.triangles.iter_mut().flatten() {
            let slot = &mut new_index[*v as usize];
            if *slot == u32::MAX {
                *slot = u32::try_from(kept.len()).unwrap_or(u32::MAX);
                kept.push(*v as usize);
            }
            *v = *slot;
        }
        for positions in self.steps.iter_mut().chain(once(&mut self.positions)) {
            *positions = kept.iter().map(|&v| positions[v]).collect();
        }
    }

    /// Bounds of the vertices at all times, in the object's space.
    pub(super) fn bounds(&self) -> [DVec3; 2] {
        (self.positions.iter().chain(self.steps.iter().flatten()))
            .map(|&p| Vec3::from(p).as_dvec3())
            .fold([DVec3::INFINITY, DVec3::NEG_INFINITY], |[low, high], p| [low.min(p), high.max(p)])
    }
}

/// Whether something may have so many steps besides the middle.
pub(super) const fn is_step_count(count: usize) -> bool {
    count.is_multiple_of(2) && count < MOST_STEPS
}

/// Area at most 10⁻¹⁴ of the longest edge squared: the normal is rounding noise.
fn is_degenerate([a, b, c]: [DVec3; 3]) -> bool {
    let longest = (b - a).length_squared().max((c - b).length_squared()).max((a - c).length_squared());
    let twice_area = (b - a).cross(c - a).length();
    twice_area <= 2e-14 * longest
}

fn retain<T>(items: &mut Vec<T>, keep: &[bool]) {
    let mut flags = keep.iter();
    items.retain(|_| *flags.next().unwrap_or(&true));
}

/// The mesh in scene space, for an object that is its only user.
pub(super) fn transformed(arrays: MeshArrays, scene_from_object: &DAffine3, problems: &mut Problems) -> Mesh {
    let mut mesh = placed(arrays, scene_from_object);
    if scene_from_object.matrix3.determinant() < 0.0 {
        mesh.triangles.iter_mut().for_each(|t| t.swap(1, 2));
        mesh.corner_normals.iter_mut().for_each(|n| n.swap(1, 2));
        mesh.layers.iter_mut().for_each(CornerLayer::turn);
    }
    // Rounding to f32 can flatten what was a triangle in the object's own space.
    let keep: Vec<bool> =
        (0..mesh.triangles.len()).map(|i| !is_degenerate(mesh.corners(i).map(Vec3::as_dvec3))).collect();
    let lost = keep.iter().filter(|&&k| !k).count() as u64;
    if lost > 0 {
        problems.add("Scene", "triangles too small beside the scene's size are left out", lost);
        retain(&mut mesh.triangles, &keep);
        retain(&mut mesh.corner_normals, &keep);
        mesh.layers.iter_mut().for_each(|layer| layer.retain(&keep));
        retain(&mut mesh.slots, &keep);
    }
    mesh
}

/// The mesh in a unit cube of its own, for instances, with the transform back to the object's space: far-off or huge
/// object coordinates then cost no precision.
pub(super) fn normalized(arrays: MeshArrays) -> (Mesh, DAffine3) {
    let [low, high] = arrays.bounds();
    let extent = (high - low).max_element();
    let (center, scale) = if extent.is_finite() && extent > 0.0 {
        ((low + high) * 0.5, extent.log2().ceil().exp2())
    } else {
        (DVec3::ZERO, 1.0)
    };
    let object_from_mesh = DAffine3::from_translation(center) * DAffine3::from_scale(DVec3::splat(scale));
    (placed(arrays, &object_from_mesh.inverse()), object_from_mesh)
}

fn placed(arrays: MeshArrays, transform: &DAffine3) -> Mesh {
    let normal_matrix: DMat3 = transform.matrix3.inverse().transpose();
    let normal = |n: [f32; 3]| {
        (normal_matrix * Vec3::from(n).as_dvec3()).try_normalize().map_or(Vec3::ZERO, DVec3::as_vec3)
    };
    let place = |positions: &[[f32; 3]]| -> Vec<Vec3> {
        let place = |&p: &[f32; 3]| transform.transform_point3(Vec3::from(p).as_dvec3()).as_vec3();
        positions.iter().map(place).collect()
    };
    let positions = place(&arrays.positions);
    let mut steps: Vec<_> = arrays.steps.iter().map(|step| place(step)).collect();
    if !steps.is_empty() {
        steps.insert(steps.len() / 2, positions.clone());
    }
    Mesh {
        positions,
        steps,
        triangles: arrays.triangles,
        corner_normals: arrays.corner_normals.into_iter().map(|corners| corners.map(normal)).collect(),
        layers: arrays.layers,
        slots: arrays.slots,
    }
}
