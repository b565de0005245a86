//! Camera samples on constant Lambert surfaces, lane by lane in arrays: the common case, kept free of everything else so
//! that it becomes vector code.

use std::f32::consts::FRAC_1_PI;

use glam::Vec3;

use crate::accel::{LANES, OFFSET, Packet};
use crate::color::Rgb;
use crate::light::Receiver;
use crate::math::Frame;
use crate::sampling::cosine_hemisphere;
use crate::scene::MIDDLE;

type Lanes = [f32; LANES];

/// Sixteen camera samples; lanes that are not `set` hold something else, or nothing.
#[derive(Clone, Debug)]
pub(super) struct LambertLanes {
    pub(super) set: [bool; LANES],
    /// Albedo times the share of light that reaches the camera.
    pub(super) weight: [Rgb; LANES],
    pub(super) p: [Vec3; LANES],
    /// Shading and geometric normals, towards the camera.
    pub(super) ns: [Vec3; LANES],
    pub(super) ng: [Vec3; LANES],
    /// When each was seen, while the shutter is open.
    pub(super) time: Lanes,
    /// Bit of the set of receivers of each object.
    pub(super) sets: [u32; LANES],
    origin: [Lanes; 3],
    geometric: [Lanes; 3],
    /// Tangent, bitangent and shading normal, by axis.
    frame: [[Lanes; 3]; 3],
}

impl Default for LambertLanes {
    fn default() -> Self {
        let zero = [[0.0; LANES]; 3];
        Self {
            set: [false; LANES],
            weight: [Rgb::BLACK; LANES],
            p: [Vec3::ZERO; LANES],
            ns: [Vec3::ZERO; LANES],
            ng: [Vec3::ZERO; LANES],
            time: [MIDDLE; LANES],
            sets: [u32::MAX; LANES],
            origin: zero,
            geometric: zero,
            frame: [zero; 3],
        }
    }
}

impl LambertLanes {
    pub(super) fn clear(&mut self) {
        self.set = [false; LANES];
    }

    pub(super) fn any(&self) -> bool {
        self.set.contains(&true)
    }

    /// Puts a camera sample into a lane.
    pub(super) fn put(&mut self, lane: usize, p: Vec3, ng: Vec3, ns: Vec3, weight: Rgb, time: f32) {
        let frame = Frame::new(ns);
        let origin = p + ng * OFFSET;
        for axis in 0..3 {
            self.origin[axis][lane] = origin[axis];
            self.geometric[axis][lane] = ng[axis];
            self.frame[0][axis][lane] = frame.tangent[axis];
            self.frame[1][axis][lane] = frame.bitangent[axis];
            self.frame[2][axis][lane] = frame.normal[axis];
        }
        self.set[lane] = true;
        self.weight[lane] = weight;
        self.time[lane] = time;
        (self.p[lane], self.ng[lane], self.ns[lane]) = (p, ng, ns);
    }

    /// What lights a lane.
    pub(super) fn receiver(&self, lane: usize) -> Receiver {
        Receiver { p: self.p[lane], normal: Some(self.ns[lane]), sets: self.sets[lane] }
    }

    /// Aims one gather ray per lane at the points (x, y) of the unit square; gives the densities per solid angle.
    #[inline(always)]
    pub(super) fn aim(&self, [x, y]: [Lanes; 2], mask: u32, packet: &mut Packet) -> Lanes {
        let mut local = [[0.0; LANES]; 3];
        for lane in 0..LANES {
            let d = cosine_hemisphere([x[lane], y[lane]]);
            (local[0][lane], local[1][lane], local[2][lane]) = (d.x, d.y, d.z);
        }
        let mut directions = [[0.0; LANES]; 3];
        for (axis, direction) in directions.iter_mut().enumerate() {
            for lane in 0..LANES {
                direction[lane] = self.frame[0][axis][lane] * local[0][lane]
                    + self.frame[1][axis][lane] * local[1][lane]
                    + self.frame[2][axis][lane] * local[2][lane];
            }
        }
        let mut set = self.set;
        for lane in 0..LANES {
            let above = directions[0][lane] * self.geometric[0][lane]
                + directions[1][lane] * self.geometric[1][lane]
                + directions[2][lane] * self.geometric[2][lane];
            set[lane] &= above > 0.0 && local[2][lane] > 0.0;
        }
        packet.set_all(&self.origin, &directions, &self.time, &set, mask);
        local[2].map(|z| z * FRAC_1_PI)
    }
}
