//! Sheen of fibers that stand on the surface, such as those of velvet and felt (Zeltner, Burley, Chiang 2022, "Practical
//! Multiple-Scattering Sheen Using Linearly Transformed Cosines"), Blender's "Microfiber".
//!
//! Light is spread as a cosine lobe w_z / π is, where w is what [`Sheen::straightened`] makes of the direction; how much
//! of it there is, the albedo says. Albedo and matrix depend on the roughness and on the direction to the viewer; they are
//! measured of Cycles, see `tests/render/measure_sheen.py`, at the roughnesses and cosines between which it interpolates.

use std::f32::consts::FRAC_1_PI;

use glam::Vec3;

use super::ShadingFrame;
use super::sheen_table::{MEASURED, STEPS};
use crate::math::Frame;
use crate::sampling::cosine_hemisphere;

/// A lobe of sheen, for a fixed direction to the viewer.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sheen {
    /// Of directions across the normal: how much they count.
    across: f32,
    /// How far directions along the normal lean away from the viewer.
    lean: f32,
}

impl Sheen {
    /// The lobe at Blender's roughness and the cosine to the viewer, and its albedo.
    pub(super) fn new(roughness: f32, cos: f32) -> (Self, f32) {
        let ((row, down), (column, along)) = (position(roughness), position(cos));
        let mixed = |value: usize| {
            let in_row = |row: usize| {
                let [a, b] = [column, column + 1].map(|column| f32::from(MEASURED[row][column][value]));
                a + (b - a) * along
            };
            let (a, b) = (in_row(row), in_row(row + 1));
            1e-4 * (a + (b - a) * down)
        };
        (Self { across: mixed(1), lean: mixed(2) }, mixed(0))
    }

    /// The frame about the normal whose tangent leads towards the viewer.
    fn basis(frame: &ShadingFrame, wo: Vec3) -> Frame {
        let normal = frame.ns;
        let towards = (wo - normal * wo.dot(normal)).try_normalize();
        let tangent = towards.unwrap_or_else(|| Frame::new(normal).tangent);
        Frame { tangent, bitangent: normal.cross(tangent), normal }
    }

    fn straightened(self, wi: Vec3) -> Vec3 {
        Vec3::new(self.across * wi.x + self.lean * wi.z, self.across * wi.y, wi.z)
    }

    /// The density of `sample` (per solid angle): BSDF times cosine, for an albedo of 1.
    pub(super) fn density(self, frame: &ShadingFrame, wo: Vec3, wi: Vec3) -> f32 {
        let wi = Self::basis(frame, wo).to_local(wi);
        let stretch = self.across / self.straightened(wi).length_squared();
        wi.z.max(0.0) * FRAC_1_PI * stretch * stretch
    }

    pub(super) fn sample(self, frame: &ShadingFrame, wo: Vec3, u: [f32; 2]) -> Vec3 {
        let w = cosine_hemisphere(u);
        let wi = Vec3::new((w.x - self.lean * w.z) / self.across, w.y / self.across, w.z);
        Self::basis(frame, wo).from_local(wi.normalize())
    }
}

/// The step before a value in [0, 1], and the rest of the way to the next.
fn position(value: f32) -> (usize, f32) {
    let place = value.clamp(0.0, 1.0) * (STEPS - 1) as f32;
    let before = (place as usize).min(STEPS - 2);
    (before, place - before as f32)
}
