//! What the choice among lamps looks at of area lamps: one by one, or eight at a time where there are few lamps and all of
//! them are weighed at every point.

use std::f32::consts::FRAC_1_PI;

use arrayvec::ArrayVec;
use glam::{Vec2, Vec3};

use super::Receiver;
use super::cluster::incidence_of_ball;
use super::tree::FEW;

/// An area lamp's shape and strength.
#[derive(Clone, Copy, Debug)]
pub(super) struct Outline {
    pub center: Vec3,
    pub x_axis: Vec3,
    pub y_axis: Vec3,
    /// The side that shines.
    pub normal: Vec3,
    /// Half the sides or diameters.
    pub half: Vec2,
    /// The lamp's light goes so far aside per unit of height.
    pub reach: f32,
    /// Highest radiant intensity (W·sr⁻¹ × squared length scale).
    pub intensity: f32,
    pub area: f32,
    /// Sets of objects that it lights.
    pub receivers: u32,
}

impl Outline {
    /// About the irradiance the lamp gives the receiver; 0 only where there is none. Without branches: of several lamps at
    /// once it becomes vector code.
    #[inline(always)]
    pub(super) fn irradiance(&self, receiver: &Receiver) -> f32 {
        let v = receiver.p - self.center;
        let height = v.dot(self.normal);
        let x = (v.dot(self.x_axis).abs() - self.half.x).max(0.0);
        let y = (v.dot(self.y_axis).abs() - self.half.y).max(0.0);
        let is_lit = self.receivers & receiver.sets != 0;
        let is_reached = is_lit & (height > 0.0) & (x.max(y) <= self.reach * height);
        let irradiance = self.intensity / (x * x + y * y + height * height + self.area * FRAC_1_PI);
        let (normal, from_anywhere) = receiver.normal.map_or((Vec3::ZERO, true), |normal| (normal, false));
        let incidence = incidence_of_ball(-v.dot(normal), v.length_squared(), self.half.length());
        let incidence = if from_anywhere { 1.0 } else { incidence };
        if is_reached { irradiance * incidence } else { 0.0 }
    }
}

/// One number of each outline.
type Lanes = [f32; FEW];

/// The area lamps among a few emitters, side by side.
#[derive(Debug)]
pub(super) struct Outlines {
    center: [Lanes; 3],
    x_axis: [Lanes; 3],
    y_axis: [Lanes; 3],
    normal: [Lanes; 3],
    half: [Lanes; 2],
    reach: Lanes,
    intensity: Lanes,
    area: Lanes,
    receivers: [u32; FEW],
    /// By outline: the emitter.
    emitters: ArrayVec<usize, FEW>,
    /// Emitters that have none.
    pub(super) others: ArrayVec<usize, FEW>,
    instructions: pulp::Arch,
}

impl Outlines {
    /// Of a few emitters, those that are area lamps.
    pub(super) fn new(of_emitters: impl Iterator<Item = Option<Outline>>) -> Self {
        let zero = [0.0; FEW];
        let mut all = Self {
            center: [zero; 3],
            x_axis: [zero; 3],
            y_axis: [zero; 3],
            normal: [zero; 3],
            half: [zero; 2],
            reach: zero,
            intensity: zero,
            area: zero,
            receivers: [0; FEW],
            emitters: ArrayVec::new(),
            others: ArrayVec::new(),
            instructions: pulp::Arch::new(),
        };
        for (emitter, outline) in of_emitters.enumerate() {
            let Some(outline) = outline else {
                all.others.push(emitter);
                continue;
            };
            let lane = all.emitters.len();
            for axis in 0..3 {
                all.center[axis][lane] = outline.center[axis];
                all.x_axis[axis][lane] = outline.x_axis[axis];
                all.y_axis[axis][lane] = outline.y_axis[axis];
                all.normal[axis][lane] = outline.normal[axis];
            }
            all.half[0][lane] = outline.half.x;
            all.half[1][lane] = outline.half.y;
            all.reach[lane] = outline.reach;
            all.intensity[lane] = outline.intensity;
            all.area[lane] = outline.area;
            all.receivers[lane] = outline.receivers;
            all.emitters.push(emitter);
        }
        all
    }

    #[inline(always)]
    fn get(&self, lane: usize) -> Outline {
        let vector = |of: &[Lanes; 3]| Vec3::new(of[0][lane], of[1][lane], of[2][lane]);
        Outline {
            center: vector(&self.center),
            x_axis: vector(&self.x_axis),
            y_axis: vector(&self.y_axis),
            normal: vector(&self.normal),
            half: Vec2::new(self.half[0][lane], self.half[1][lane]),
            reach: self.reach[lane],
            intensity: self.intensity[lane],
            area: self.area[lane],
            receivers: self.receivers[lane],
        }
    }

    /// What [`Outline::irradiance`] says of each, by emitter; 0 for `others`.
    pub(super) fn irradiance(&self, receiver: &Receiver) -> [f32; FEW] {
        let by_outline = self.instructions.dispatch(OfEach { outlines: self, receiver });
        let mut by_emitter = [0.0; FEW];
        for (&emitter, &value) in self.emitters.iter().zip(&by_outline) {
            by_emitter[emitter] = value;
        }
        by_emitter
    }
}

/// [`Outlines::irradiance`] by outline, for whichever vector instructions this processor has.
struct OfEach<'a> {
    outlines: &'a Outlines,
    receiver: &'a Receiver,
}

impl pulp::NullaryFnOnce for OfEach<'_> {
    type Output = Lanes;

    // What is inlined into this function, and only that, is compiled for the wider instructions.
    #[inline(always)]
    fn call(self) -> Lanes {
        let mut irradiance = [0.0; FEW];
        let receiver = *self.receiver;
        for (lane, value) in irradiance.iter_mut().enumerate().take(self.outlines.emitters.len()) {
            *value = self.outlines.get(lane).irradiance(&receiver);
        }
        irradiance
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sampling::{Rng, hash};

    fn unit(draw: &mut impl FnMut() -> f32) -> Vec3 {
        Vec3::new(draw() - 0.5, draw() - 0.5, draw() - 0.5).normalize_or(Vec3::Z)
    }

    fn lamp(draw: &mut impl FnMut() -> f32) -> Outline {
        let normal = unit(draw);
        let x_axis = normal.any_orthonormal_vector();
        let narrow = draw() < 0.5;
        Outline {
            center: Vec3::new(draw(), draw(), draw()),
            x_axis,
            y_axis: normal.cross(x_axis),
            normal,
            half: Vec2::new(draw(), draw()) * 0.5,
            reach: if narrow { draw() } else { f32::INFINITY },
            intensity: 1.0 + draw(),
            area: 0.1,
            receivers: 1 + u32::from(draw() < 0.5),
        }
    }

    fn receiver(draw: &mut impl FnMut() -> f32) -> Receiver {
        let normal = (draw() < 0.8).then(|| unit(draw));
        Receiver { p: Vec3::new(draw(), draw(), draw()), normal, sets: 1 }
    }

    /// A place of a lamp from which light arrives means irradiance, and no less than the place's cosine allows.
    #[test]
    fn what_is_lit_has_irradiance() {
        let mut rng = Rng::new(hash(1, 0));
        let mut draw = || rng.draw();
        let mut lit = 0;
        for _ in 0..20_000 {
            let (lamp, receiver) = (lamp(&mut draw), receiver(&mut draw));
            let place = Vec2::new(2.0 * draw() - 1.0, 2.0 * draw() - 1.0) * lamp.half;
            let to = lamp.center + lamp.x_axis * place.x + lamp.y_axis * place.y - receiver.p;
            let height = -to.dot(lamp.normal);
            let aside = [lamp.x_axis, lamp.y_axis].map(|axis| to.dot(axis).abs() / height);
            let cos = receiver.normal.map_or(1.0, |normal| to.normalize().dot(normal));
            let is_lit = height > 1e-3
                && cos > 1e-3
                && aside[0].max(aside[1]) < 0.999 * lamp.reach
                && lamp.receivers == 1;
            let weight = lamp.irradiance(&receiver);
            if is_lit {
                lit += 1;
                let farthest = to.length_squared() + lamp.area * FRAC_1_PI;
                assert!(weight >= 0.999 * lamp.intensity * cos / farthest, "{lamp:?} {receiver:?}");
            }
            if receiver
                .normal
                .is_some_and(|normal| (lamp.center - receiver.p).dot(normal) < -lamp.half.length())
                || lamp.receivers != 1
            {
                assert_eq!(weight, 0.0, "{lamp:?} {receiver:?}");
            }
        }
        assert!(lit > 1000, "{lit}");
    }

    #[test]
    fn together_they_have_what_each_has() {
        let mut rng = Rng::new(hash(2, 0));
        let mut draw = || rng.draw();
        let lamps: Vec<Option<Outline>> =
            (0..FEW).map(|number| (number % 5 > 0).then(|| lamp(&mut draw))).collect();
        let outlines = Outlines::new(lamps.iter().copied());
        assert_eq!(outlines.others.len(), FEW.div_ceil(5));
        for _ in 0..100 {
            let receiver = receiver(&mut draw);
            for (lamp, together) in lamps.iter().zip(outlines.irradiance(&receiver)) {
                let alone = lamp.map_or(0.0, |lamp| lamp.irradiance(&receiver));
                assert!((together - alone).abs() <= 1e-6 * alone, "{together} for {alone}");
            }
        }
    }
}
