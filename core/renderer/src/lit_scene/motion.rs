//! Surfaces that move while the shutter is open. Materials, cells and lights know them as they are in the middle of its
//! time; here they are turned to where they are at the time of a ray, and back.

use glam::{DMat3, DQuat, DVec3, Quat, Vec3};

use super::{LitScene, Surface};
use crate::accel::{Hit, Ray};
use crate::light::{DirectSample, Emission, EmitterPoint, Receiver};

/// A triangle at one time.
struct Triangle {
    corners: [DVec3; 3],
    /// Unit normal, by the order of the corners.
    normal: DVec3,
    area: f32,
}

impl Triangle {
    fn new(corners: [DVec3; 3]) -> Self {
        let [a, b, c] = corners;
        let (normal, length) = (b - a).cross(c - a).normalize_and_length();
        Self { corners, normal, area: (0.5 * length) as f32 }
    }

    fn point(&self, barycentric: [f32; 2]) -> Vec3 {
        let [s, t] = barycentric.map(f64::from);
        let [a, b, c] = self.corners;
        (a * (1.0 - s - t) + b * s + c * t).as_vec3()
    }

    /// Pdf per solid angle of a point chosen uniformly over the area, at distance `t` along `wi`.
    fn pdf(&self, wi: Vec3, t: f32) -> f32 {
        let cos = wi.dot(self.normal.as_vec3()).abs();
        if cos == 0.0 { 0.0 } else { t * t / (self.area * cos) }
    }

    /// Axes that turn with it.
    fn axes(&self) -> DMat3 {
        let [a, b, _] = self.corners;
        let (along, up) = ((b - a).normalize_or_zero(), self.normal);
        DMat3::from_cols(along, up.cross(along), up)
    }
}

impl<'a> LitScene<'a> {
    /// True for objects that are not at all times where they are in the middle of the shutter's.
    #[inline]
    #[must_use]
    pub fn moves(&self, object: u32) -> bool {
        self.plan.motion_blur && self.accel.scene().objects[object as usize].moves()
    }

    /// As [`LitScene::surface`], for an object that moves: its material is that of the middle of the shutter's time, turned.
    #[inline(never)]
    pub(super) fn moving_surface(&'a self, ray: &Ray, hit: Hit, width: f32) -> Surface<'a> {
        let [still, now] = self.triangles(&hit, ray.time);
        let turn = turn(&still, &now);
        let direction = turn.inverse() * ray.direction;
        let origin = still.point(hit.barycentric) - direction * hit.t;
        let surface = self.still_surface(&Ray { origin, direction, ..*ray }, hit, width);
        Surface {
            p: ray.origin + ray.direction * hit.t,
            ng: turn * surface.ng,
            bsdf: surface.bsdf.turned(turn),
            ..surface
        }
    }

    /// The surface as it is in the middle of the shutter's time, and the light on it turned with it: what is stored and read.
    /// Also gives how large its triangle is then over how large it is now, which flux that is stored is multiplied with.
    #[must_use]
    pub fn at_rest<'b>(&self, surface: &Surface<'b>) -> (Surface<'b>, f32) {
        let [still, now] = self.triangles(&surface.hit, surface.time);
        let back = turn(&now, &still);
        let at_rest = Surface {
            p: still.point(surface.hit.barycentric),
            ng: back * surface.ng,
            bsdf: surface.bsdf.clone().turned(back),
            ..*surface
        };
        (at_rest, if now.area > 0.0 { still.area / now.area } else { 1.0 })
    }

    /// Unit geometric normal at a hit, outward as modelled.
    #[must_use]
    pub fn normal_met(&self, ray: &Ray, hit: &Hit) -> Vec3 {
        let ng = self.accel.geometric_normal(hit.object, hit.primitive);
        if !self.moves(hit.object) {
            return ng;
        }
        let [still, now] = self.triangles(hit, ray.time);
        turn(&still, &now) * ng
    }

    /// See [`crate::light::Lights::emitter_pdf`]: for the triangle a ray met at a distance from the receiver. Infinite where
    /// rays that are drawn from surfaces do not meet the light.
    #[must_use]
    pub fn emitter_pdf(&self, from: Receiver, ray: &Ray, hit: &Hit, distance: f32) -> f32 {
        if self.lights.is_left_to_sampling(hit.object) {
            return f32::INFINITY;
        }
        if !self.moves(hit.object) {
            return self.lights.emitter_pdf(from, hit.object, hit.primitive, ray.direction, distance);
        }
        let choice = self.lights.emitter_choice(from, hit.object, hit.primitive);
        choice
            * Triangle::new(self.corners_at(hit.object, hit.primitive, ray.time)).pdf(ray.direction, distance)
    }

    /// A point that was chosen to light a receiver, where it is at a time; `None` where it gives nothing then.
    #[inline(never)]
    pub(super) fn moved_sample(
        &self,
        sample: DirectSample,
        point: EmitterPoint,
        from: Receiver,
        time: f32,
    ) -> Option<DirectSample> {
        let triangle = Triangle::new(self.corners_at(point.object, point.primitive, time));
        let along = triangle.point(point.barycentric) - from.p;
        let (distance, wi) = (along.length(), along.try_normalize()?);
        let pdf =
            self.lights.emitter_choice(from, point.object, point.primitive) * triangle.pdf(wi, distance);
        if !(pdf > 0.0 && pdf.is_finite()) {
            return None;
        }
        let factor = sample.pdf_solid_angle / pdf;
        Some(DirectSample {
            wi,
            distance,
            radiance_over_pdf: sample.radiance_over_pdf * factor,
            pdf_solid_angle: pdf,
            point: Some(EmitterPoint {
                per_radiance: point.per_radiance * factor,
                cos: triangle.normal.as_vec3().dot(wi).abs(),
                ..point
            }),
            ..sample
        })
    }

    /// A photon that leaves a mesh, as it leaves it at a time.
    #[inline(never)]
    pub(super) fn moved_emission(&self, emission: Emission, point: EmitterPoint, time: f32) -> Emission {
        let hit =
            Hit { t: 0.0, barycentric: point.barycentric, object: point.object, primitive: point.primitive };
        let [still, now] = self.triangles(&hit, time);
        let (turn, factor) = (turn(&still, &now), now.area / still.area);
        Emission {
            origin: now.point(point.barycentric),
            direction: turn * emission.direction,
            normal: emission.normal.map(|normal| turn * normal),
            flux: emission.flux * factor,
            point: Some(EmitterPoint { per_radiance: point.per_radiance * factor, ..point }),
            ..emission
        }
    }

    fn corners_at(&self, object: u32, primitive: u32, time: f32) -> [DVec3; 3] {
        self.accel.scene().objects[object as usize].corners_at(primitive as usize, time)
    }

    /// The triangle of a hit, in the middle of the shutter's time and at a time.
    fn triangles(&self, hit: &Hit, time: f32) -> [Triangle; 2] {
        let object = &self.accel.scene().objects[hit.object as usize];
        let primitive = hit.primitive as usize;
        [object.corners(primitive), object.corners_at(primitive, time)].map(Triangle::new)
    }
}

/// The rotation that takes the axes of one triangle to those of another; none where one of them has no area.
fn turn(from: &Triangle, to: &Triangle) -> Quat {
    let rotation = to.axes() * from.axes().transpose();
    // Both are rotations, or zero where there is no area.
    if (rotation.determinant() - 1.0).abs() > 1e-3 {
        return Quat::IDENTITY;
    }
    DQuat::from_mat3(&rotation).normalize().as_quat()
}
