//! Emissive meshes: the emitting triangles of one object as one light, chosen by area × radiance. Both sides emit.

use std::f32::consts::{FRAC_1_PI, TAU};
use std::sync::Arc;

use glam::{DAffine3, DVec3, Vec3};

use super::select::Cdf;
use super::{LightSample, Photon, is_in_reach, warp};
use crate::color::Rgb;
use crate::scene::{Mesh, Object};

/// The emitting triangles of one object.
#[derive(Clone, Debug)]
pub(super) struct MeshEmitter {
    mesh: Arc<Mesh>,
    scene_from_mesh: Option<DAffine3>,
    /// Radiance of each material slot; triangles of later slots have the last one.
    slot_radiance: Vec<Rgb>,
    /// Emitting triangles of the mesh.
    triangles: Vec<u32>,
    /// Over `triangles`, by area × mean radiance.
    cdf: Cdf,
    /// Sum of area × mean radiance.
    weight: f64,
    flux: Rgb,
    center: Vec3,
    /// Squared radius of the ball about the emitting triangles.
    radius_squared: f32,
}

impl MeshEmitter {
    /// `None` for an object that does not emit. `emission[m]` is the radiance of material m.
    pub(super) fn new(object: &Object, emission: &[Rgb]) -> Option<Self> {
        let slot_radiance: Vec<Rgb> = object.materials.iter().map(|&m| emission[m as usize]).collect();
        if slot_radiance.iter().all(|radiance| radiance.is_black()) {
            return None;
        }
        let mut triangles = Vec::new();
        let mut weights = Vec::new();
        let mut flux = [0.0; 3];
        let (mut low, mut high) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
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
            for corner in corners {
                low = low.min(corner);
                high = high.max(corner);
            }
        }
        let weight = weights.iter().sum();
        Some(Self {
            mesh: Arc::clone(&object.mesh),
            scene_from_mesh: object.scene_from_mesh,
            slot_radiance,
            cdf: Cdf::new(weights)?,
            triangles,
            weight,
            flux: Rgb(flux.map(|sum| sum as f32)),
            center: (0.5 * (low + high)).as_vec3(),
            radius_squared: (0.25 * (high - low).length_squared()) as f32,
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

    /// About the irradiance at `p`, for choosing between lights.
    pub(super) fn irradiance_estimate(&self, p: Vec3) -> f32 {
        let distance_squared = (p - self.center).length_squared();
        self.flux.mean() * (0.25 * FRAC_1_PI) / distance_squared.max(self.radius_squared).max(1e-12)
    }

    /// A point of the mesh as seen from `p`; `choice` chooses the triangle.
    pub(super) fn sample(&self, p: Vec3, choice: f32, u: [f32; 2]) -> Option<LightSample> {
        let triangle = self.triangle(choice);
        let along = (triangle.point(u) - p.as_dvec3()).as_vec3();
        let distance = along.length();
        let wi = along.try_normalize()?;
        let pdf = self.pdf(triangle.radiance, distance, wi.dot(triangle.normal));
        (pdf > 0.0 && pdf.is_finite()).then(|| LightSample {
            wi,
            distance,
            radiance_over_pdf: triangle.radiance / pdf,
            pdf,
            is_delta: false,
        })
    }

    /// Pdf per solid angle with which [`MeshEmitter::sample`] finds a point of triangle `primitive` at distance `t`,
    /// where its unit normal and the ray make the angle of cosine `cos`.
    pub(super) fn primitive_pdf(&self, primitive: usize, t: f32, cos: f32) -> f32 {
        self.pdf(self.radiance(primitive), t, cos)
    }

    /// A photon whose flux over its probability is the flux of the whole mesh, in the color of the chosen triangle.
    pub(super) fn emit(&self, choice: f32, position: [f32; 2], direction: [f32; 2]) -> Photon {
        let triangle = self.triangle(choice);
        let side = 2.0 * direction[0];
        let normal = if side < 1.0 { triangle.normal } else { -triangle.normal };
        Photon {
            origin: triangle.point(position).as_vec3(),
            direction: warp::cosine(normal, [side.fract(), direction[1]]),
            flux: triangle.radiance
                * (f64::from(TAU) * self.weight / f64::from(triangle.radiance.mean())) as f32,
            normal: Some(normal),
            lit_from: 0.0,
        }
    }

    /// A triangle is chosen by area × radiance and a point on it uniformly, so the pdf per area is radiance / weight.
    fn pdf(&self, radiance: Rgb, distance: f32, cos: f32) -> f32 {
        let pdf_area = (f64::from(radiance.mean()) / self.weight) as f32;
        if cos == 0.0 { 0.0 } else { pdf_area * distance * distance / cos.abs() }
    }

    fn radiance(&self, primitive: usize) -> Rgb {
        self.slot_radiance[self.mesh.slot(primitive).min(self.slot_radiance.len() - 1)]
    }

    fn triangle(&self, choice: f32) -> Triangle {
        let primitive = self.triangles[self.cdf.choose(choice).index] as usize;
        let corners = self.mesh.corners(primitive).map(Vec3::as_dvec3);
        let corners = match &self.scene_from_mesh {
            Some(transform) => corners.map(|p| transform.transform_point3(p)),
            None => corners,
        };
        let [a, b, c] = corners;
        Triangle {
            corners,
            normal: (b - a).cross(c - a).normalize().as_vec3(),
            radiance: self.radiance(primitive),
        }
    }
}

/// A triangle in scene space.
struct Triangle {
    corners: [DVec3; 3],
    normal: Vec3,
    radiance: Rgb,
}

impl Triangle {
    /// Uniform over the area (Heitz 2019, "A Low-Distortion Map Between Triangle and Square").
    fn point(&self, u: [f32; 2]) -> DVec3 {
        let [mut s, mut t] = u.map(f64::from);
        if t > s {
            s *= 0.5;
            t -= s;
        } else {
            t *= 0.5;
            s -= t;
        }
        let [a, b, c] = self.corners;
        a * (1.0 - s - t) + b * s + c * t
    }
}
