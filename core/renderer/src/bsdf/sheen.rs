//! Sheen of fibers that stand on the surface, such as those of velvet and felt (Zeltner, Burley, Chiang 2022, "Practical
//! Multiple-Scattering Sheen Using Linearly Transformed Cosines"), Blender's "Microfiber".
//!
//! Light is spread as a cosine lobe w_z / π is, where w is what [`Sheen::straightened`] makes of the direction; how much
//! of it there is, the albedo says. Albedo and matrix depend on the roughness and on the direction to the viewer: here they
//! were found by measuring spheres that Cycles (Blender 5.0.1) renders under an even world and under six suns.

use std::f32::consts::FRAC_1_PI;

use glam::Vec3;

use super::ShadingFrame;
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
        let (row, down) = position(10.0 * roughness - 1.0, ROUGHNESSES);
        let (column, along) = position(8.0 * cos.sqrt() - 2.0, COSINES);
        let mixed = |value: usize| {
            let in_row = |row: usize| {
                let [a, b] = [MEASURED[row][column][value], MEASURED[row][column + 1][value]];
                a + (b - a) * along
            };
            let (a, b) = (in_row(row), in_row(row + 1));
            a + (b - a) * down
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

/// Of `count` nodes: the one before a place, and the rest of the way to the next.
fn position(place: f32, count: usize) -> (usize, f32) {
    let place = place.clamp(0.0, (count - 1) as f32);
    let before = (place as usize).min(count - 2);
    (before, place - before as f32)
}

const ROUGHNESSES: usize = 10;
const COSINES: usize = 7;

/// Albedo, [`Sheen::across`] and [`Sheen::lean`] at roughness 0.1, 0.2 … 1 and cosines whose roots are 2/8, 3/8 … 1.
#[rustfmt::skip]
static MEASURED: [[[f32; 3]; COSINES]; ROUGHNESSES] = [
    [[0.5937, 0.0808, 0.06], [0.1461, 0.0866, 0.06], [0.0001, 0.0924, 0.06], [0.0034, 0.1016, -0.0104],
     [0.0001, 0.1202, -0.036], [0.0002, 0.1556, -0.0418], [0.0001, 0.2177, -0.0387]],
    [[0.686, 0.1346, 0.06], [0.3032, 0.1443, 0.06], [0.03, 0.154, 0.06], [0.0056, 0.1693, -0.0104],
     [0.0005, 0.2003, -0.036], [0.0003, 0.2594, -0.0418], [0.0001, 0.3628, -0.0387]],
    [[0.7367, 0.2085, 0.06], [0.4334, 0.2289, 0.0416], [0.159, 0.2493, -0.0049], [0.0493, 0.2746, -0.0239],
     [0.0105, 0.2979, -0.0314], [0.0026, 0.3366, -0.0394], [0.0006, 0.4156, -0.0344]],
    [[0.7695, 0.2592, -0.0141], [0.5112, 0.2934, -0.0263], [0.2778, 0.3275, -0.0385], [0.1376, 0.3641, -0.037],
     [0.0502, 0.3925, -0.0351], [0.0154, 0.4272, -0.0367], [0.0041, 0.4858, -0.0284]],
    [[0.7914, 0.3321, -0.0843], [0.5616, 0.3699, -0.0811], [0.3665, 0.4077, -0.0779], [0.2302, 0.4501, -0.0615],
     [0.1172, 0.4836, -0.0468], [0.0499, 0.5175, -0.0387], [0.017, 0.5635, -0.0238]],
    [[0.808, 0.4168, -0.1033], [0.5993, 0.4575, -0.1024], [0.4344, 0.4982, -0.1015], [0.3127, 0.5427, -0.0872],
     [0.1948, 0.5796, -0.0654], [0.1064, 0.6112, -0.0445], [0.0487, 0.6445, -0.0189]],
    [[0.8223, 0.5155, -0.095], [0.6311, 0.5546, -0.0976], [0.4906, 0.5937, -0.1003], [0.3853, 0.6335, -0.0921],
     [0.2725, 0.6682, -0.0748], [0.177, 0.6972, -0.052], [0.1027, 0.7231, -0.0188]],
    [[0.8357, 0.6186, -0.0684], [0.6608, 0.6539, -0.0744], [0.5384, 0.6892, -0.0804], [0.4486, 0.7215, -0.0776],
     [0.3463, 0.7473, -0.0659], [0.2534, 0.7679, -0.0467], [0.1747, 0.7861, -0.0164]],
    [[0.849, 0.7086, -0.0223], [0.6887, 0.7393, -0.0327], [0.5808, 0.7699, -0.0431], [0.5031, 0.7959, -0.0461],
     [0.4129, 0.8145, -0.0412], [0.33, 0.8273, -0.0298], [0.2571, 0.8377, -0.0106]],
    [[0.8616, 0.7775, 0.0365], [0.7153, 0.8044, 0.0228], [0.6182, 0.8313, 0.0091], [0.55, 0.8527, 0.0014],
     [0.4727, 0.8665, -0.0003], [0.4019, 0.8746, 0.0], [0.3411, 0.8801, 0.0002]],
];
