//! Orthonormal frames and sides of surfaces. Vectors are glam's.

use glam::Vec3;

/// A right-handed orthonormal frame about a unit normal.
#[derive(Clone, Copy, Debug)]
pub struct Frame {
    /// First tangent.
    pub tangent: Vec3,
    /// Second tangent.
    pub bitangent: Vec3,
    /// The normal the frame is built on.
    pub normal: Vec3,
}

impl Frame {
    /// Frame about the unit vector `normal` (Duff et al. 2017, "Building an Orthonormal Basis, Revisited").
    #[must_use]
    pub fn new(normal: Vec3) -> Self {
        let (tangent, bitangent) = normal.any_orthonormal_pair();
        Self { tangent, bitangent, normal }
    }

    /// Local coordinates (z along the normal) to the space the frame lives in.
    #[must_use]
    pub fn from_local(&self, v: Vec3) -> Vec3 {
        self.tangent * v.x + self.bitangent * v.y + self.normal * v.z
    }

    /// The inverse of [`Frame::from_local`].
    #[must_use]
    pub fn to_local(&self, v: Vec3) -> Vec3 {
        Vec3::new(v.dot(self.tangent), v.dot(self.bitangent), v.dot(self.normal))
    }
}

/// One side of a surface.
#[derive(Clone, Copy, Debug, Default)]
pub struct Side {
    /// Unit geometric normal, away from the surface on this side.
    pub normal: Vec3,
    /// Whether it is the back of the triangle, whose own normal points away.
    pub back: bool,
}

impl Side {
    /// The side of a triangle with the unit normal `ng` that a ray along `direction` meets.
    #[must_use]
    #[inline(always)]
    pub fn met(ng: Vec3, direction: Vec3) -> Self {
        let back = direction.dot(ng) > 0.0;
        Self { normal: ng * if back { -1.0 } else { 1.0 }, back }
    }

    /// The other side of the same surface.
    #[must_use]
    pub fn other(self) -> Self {
        Self { normal: -self.normal, back: !self.back }
    }

    /// Front and back of a triangle with the unit normal `ng`.
    #[must_use]
    pub fn both(ng: Vec3) -> [Self; 2] {
        [Self { normal: ng, back: false }, Self { normal: -ng, back: true }]
    }
}
