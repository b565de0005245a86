//! Emissive meshes: the emitting triangles of one object as one light. Both sides emit. Photons choose among its triangles
//! by area × radiance; direct light chooses each triangle for itself.

use std::f32::consts::{FRAC_PI_2, TAU};
use std::sync::Arc;

use glam::{DAffine3, DVec3, Vec3};

use super::cluster::Bounds;
use super::select::Cdf;
use super::{LightSample, Photon, is_in_reach, warp};
use crate::color::Rgb;
use crate::scene::{Mesh, Object};

/// A point that was chosen on an emissive mesh. Lights know the typical radiance of its material; where that differs from
/// point to point or with the direction, the radiance that is really emitted replaces it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EmitterPoint {
    /// Index into [`crate::scene::Scene::objects`].
    pub object: u32,
    /// Triangle of its mesh.
    pub primitive: u32,
    /// Weights of the triangle's second and third corner.
    pub barycentric: [f32; 2],
    /// What one unit of radiance counts there: of a photon's flux, or over the pdf of direct light.
    pub per_radiance: f32,
    /// Cosine between the triangle's normal and the direction of the light, whichever side it leaves.
    pub cos: f32,
}

impl EmitterPoint {
    pub(super) fn chosen_with(self, probability: f32) -> Self {
        Self { per_radiance: self.per_radiance / probability, ..self }
    }
}

/// The emitting triangles of one object.
#[derive(Clone, Debug)]
pub(super) struct MeshEmitter {
    /// Index of the object in the scene.
    object: u32,
    mesh: Arc<Mesh>,
    scene_from_mesh: Option<DAffine3>,
    /// Radiance of each material slot; triangles of later slots have the last one.
    slot_radiance: Vec<Rgb>,
    /// Emitting triangles of the mesh, in order.
    triangles: Vec<u32>,
    /// Over `triangles`, by area × mean radiance.
    cdf: Cdf,
    /// Sum of area × mean radiance.
    weight: f64,
    flux: Rgb,
}

impl MeshEmitter {
    /// `None` for an object that does not emit. `number` is its index in the scene, `emission[m]` the radiance of
    /// material m.
    pub(super) fn new(number: u32, object: &Object, emission: &[Rgb]) -> Option<Self> {
        let slot_radiance: Vec<Rgb> = object.materials.iter().map(|&m| emission[m as usize]).collect();
        if slot_radiance.iter().all(|radiance| radiance.is_black()) {
            return None;
        }
        let mut triangles = Vec::new();
        let mut weights = Vec::new();
        let mut flux = [0.0; 3];
        for index in 0..object.mesh.triangles.len() {
            let radiance = emission[object.material(index)];
            let corners = object.corners(index);
            let area = 0.5 * (corners[1] - corners[0]).cross(corners[2] - corners[0]).length();
            let weight = area * f64::from(radiance.mean());
            if !(weight > 0.0 && corners.iter().all(|corner| is_in_reach(corner.as_vec3()))) {
                continue;
            }
            triangles.push(index as u32);
            weights.push(weight);
            for (sum, channel) in flux.iter_mut().zip(radiance.0) {
                *sum += f64::from(channel) * area * f64::from(TAU);
            }
        }
        let weight = weights.iter().sum();
        Some(Self {
            object: number,
            mesh: Arc::clone(&object.mesh),
            scene_from_mesh: object.scene_from_mesh,
            slot_radiance,
            cdf: Cdf::new(weights)?,
            triangles,
            weight,
            flux: Rgb(flux.map(|sum| sum as f32)),
        })
    }

    /// Memory (bytes).
    pub(super) fn bytes(&self) -> usize {
        self.triangles.len() * size_of::<u32>() + self.cdf.bytes()
    }

    /// Flux emitted by both sides together.
    pub(super) fn flux(&self) -> Rgb {
        self.flux
    }

    /// Where the light of each emitting triangle is and goes.
    pub(super) fn bounds(&self) -> impl Iterator<Item = Bounds> {
        (0..self.triangles.len()).map(|which| {
            let triangle = self.triangle(which);
            let [a, b, c] = triangle.corners.map(|corner| corner.as_vec3());
            Bounds {
                low: a.min(b).min(c),
                high: a.max(b).max(c),
                axis: triangle.normal,
                spread: 0.0,
                reach: FRAC_PI_2,
                two_sided: true,
                distant: false,
                intensity: triangle.radiance.mean() * triangle.area,
                receivers: u32::MAX,
            }
        })
    }

    /// Half the area of its triangles, what they cover on average as seen from all sides if none hides another.
    pub(super) fn mean_shadow(&self) -> f32 {
        (0..self.triangles.len()).map(|which| 0.5 * self.triangle(which).area).sum()
    }

    /// Which of the emitting triangles triangle `primitive` of the mesh is.
    pub(super) fn which(&self, primitive: u32) -> Option<usize> {
        self.triangles.binary_search(&primitive).ok()
    }

    /// A point of one of the emitting triangles as seen from `p`.
    pub(super) fn sample(&self, p: Vec3, which: usize, u: [f32; 2]) -> Option<LightSample> {
        let triangle = self.triangle(which);
        let barycentric = uniform_barycentric(u);
        let along = (triangle.point(barycentric) - p.as_dvec3()).as_vec3();
        let distance = along.length();
        let wi = along.try_normalize()?;
        let pdf = triangle.pdf(wi, distance);
        (pdf > 0.0 && pdf.is_finite()).then(|| LightSample {
            wi,
            distance,
            radiance_over_pdf: triangle.radiance / pdf,
            pdf,
            is_delta: false,
            point: Some(self.point(which, barycentric, 1.0 / pdf, triangle.normal.dot(wi))),
        })
    }

    /// A photon whose flux over its probability is the flux of the whole mesh, in the color of the chosen triangle.
    pub(super) fn emit(&self, choice: f32, position: [f32; 2], direction: [f32; 2]) -> Photon {
        let which = self.cdf.choose(choice).index;
        let triangle = self.triangle(which);
        let barycentric = uniform_barycentric(position);
        let per_radiance = (f64::from(TAU) * self.weight / f64::from(triangle.radiance.mean())) as f32;
        let side = 2.0 * direction[0];
        let normal = if side < 1.0 { triangle.normal } else { -triangle.normal };
        let direction = warp::cosine(normal, [side.fract(), direction[1]]);
        Photon {
            origin: triangle.point(barycentric).as_vec3(),
            direction,
            flux: triangle.radiance * per_radiance,
            normal: Some(normal),
            lit_from: 0.0,
            point: Some(self.point(which, barycentric, per_radiance, normal.dot(direction))),
        }
    }

    fn point(&self, which: usize, barycentric: [f32; 2], per_radiance: f32, cos: f32) -> EmitterPoint {
        let primitive = self.triangles[which];
        EmitterPoint { object: self.object, primitive, barycentric, per_radiance, cos: cos.abs() }
    }

    fn radiance(&self, primitive: usize) -> Rgb {
        self.slot_radiance[self.mesh.slot(primitive).min(self.slot_radiance.len() - 1)]
    }

    /// One of the emitting triangles.
    pub(super) fn triangle(&self, which: usize) -> Triangle {
        let primitive = self.triangles[which] as usize;
        let corners = self.mesh.corners(primitive).map(Vec3::as_dvec3);
        let corners = match &self.scene_from_mesh {
            Some(transform) => corners.map(|p| transform.transform_point3(p)),
            None => corners,
        };
        let [a, b, c] = corners;
        let (normal, length) = (b - a).cross(c - a).normalize_and_length();
        Triangle {
            corners,
            normal: normal.as_vec3(),
            area: (0.5 * length) as f32,
            radiance: self.radiance(primitive),
        }
    }
}

/// A triangle in scene space.
pub(super) struct Triangle {
    corners: [DVec3; 3],
    normal: Vec3,
    area: f32,
    radiance: Rgb,
}

impl Triangle {
    /// Pdf per solid angle of a point chosen uniformly over the area, at distance `t` along `wi`.
    pub(super) fn pdf(&self, wi: Vec3, t: f32) -> f32 {
        let cos = wi.dot(self.normal).abs();
        if cos == 0.0 { 0.0 } else { t * t / (self.area * cos) }
    }

    fn point(&self, barycentric: [f32; 2]) -> DVec3 {
        let [s, t] = barycentric.map(f64::from);
        let [a, b, c] = self.corners;
        a * (1.0 - s - t) + b * s + c * t
    }
}

/// Weights of a triangle's second and third corner, uniform over the area (Heitz 2019, "A Low-Distortion Map Between
/// Triangle and Square").
fn uniform_barycentric([s, t]: [f32; 2]) -> [f32; 2] {
    if t > s { [0.5 * s, t - 0.5 * s] } else { [s - 0.5 * t, 0.5 * t] }
}
