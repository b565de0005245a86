//! Sixteen rays traced together.

use glam::Vec3;
use rgp_embree::{INVALID_ID, RayHit16};

use super::{Hit, Ray};

/// Rays of a packet.
pub const LANES: usize = 16;

/// Sixteen rays and what they meet. Lanes that are not set are left alone.
#[derive(Clone, Debug)]
pub struct Packet {
    pub(super) valid: [i32; LANES],
    pub(super) rays: RayHit16,
}

impl Default for Packet {
    fn default() -> Self {
        Self { valid: [0; LANES], rays: RayHit16::default() }
    }
}

impl Packet {
    /// Takes every lane out.
    pub fn clear(&mut self) {
        self.valid = [0; LANES];
    }

    /// Lanes that are set.
    #[must_use]
    #[inline(always)]
    pub fn len(&self) -> usize {
        self.valid.map(|valid| (valid & 1) as usize).into_iter().sum()
    }

    /// True when no lane is set.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.valid == [0; LANES]
    }

    /// Sets a lane.
    #[inline]
    pub fn set(&mut self, lane: usize, ray: &Ray, t_far: f32) {
        let rays = &mut self.rays.ray;
        rays.org_x[lane] = ray.origin.x;
        rays.org_y[lane] = ray.origin.y;
        rays.org_z[lane] = ray.origin.z;
        rays.dir_x[lane] = ray.direction.x;
        rays.dir_y[lane] = ray.direction.y;
        rays.dir_z[lane] = ray.direction.z;
        rays.t_near[lane] = 0.0;
        rays.t_far[lane] = t_far;
        rays.time[lane] = ray.time;
        rays.mask[lane] = ray.mask;
        self.valid[lane] = -1;
    }

    /// Sets every lane from arrays: origins and directions by axis, and times. Lanes that are not `set` stay out.
    #[inline(always)]
    pub fn set_all(
        &mut self,
        origins: &[[f32; LANES]; 3],
        directions: &[[f32; LANES]; 3],
        times: &[f32; LANES],
        set: &[bool; LANES],
        mask: u32,
    ) {
        let rays = &mut self.rays.ray;
        [rays.org_x, rays.org_y, rays.org_z] = *origins;
        [rays.dir_x, rays.dir_y, rays.dir_z] = *directions;
        rays.t_near = [0.0; LANES];
        rays.t_far = [f32::INFINITY; LANES];
        rays.time = *times;
        rays.mask = [mask; LANES];
        self.valid = set.map(|set| -i32::from(set));
    }

    /// True where the lane is set.
    #[must_use]
    pub const fn is_set(&self, lane: usize) -> bool {
        self.valid[lane] != 0
    }

    /// The ray of a lane.
    #[must_use]
    #[inline(always)]
    pub fn ray(&self, lane: usize) -> Ray {
        let rays = &self.rays.ray;
        Ray {
            origin: Vec3::new(rays.org_x[lane], rays.org_y[lane], rays.org_z[lane]),
            direction: Vec3::new(rays.dir_x[lane], rays.dir_y[lane], rays.dir_z[lane]),
            mask: rays.mask[lane],
            time: rays.time[lane],
        }
    }

    /// What the lane's ray met.
    #[must_use]
    #[inline(always)]
    pub fn hit(&self, lane: usize) -> Option<Hit> {
        let hit = &self.rays.hit;
        (hit.geom_id[lane] != INVALID_ID).then(|| Hit {
            t: self.rays.ray.t_far[lane],
            barycentric: [hit.u[lane], hit.v[lane]],
            object: hit.object(lane),
            primitive: hit.prim_id[lane],
        })
    }

    /// True where a shadow ray reached its end.
    #[must_use]
    pub fn is_free(&self, lane: usize) -> bool {
        self.is_set(lane) && self.rays.ray.t_far[lane] >= 0.0
    }

    pub(super) fn clear_hits(&mut self) {
        self.rays.hit.geom_id = [INVALID_ID; LANES];
        self.rays.hit.inst_id = [INVALID_ID; LANES];
    }
}
