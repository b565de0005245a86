//! The product's answer for the light at the end of a gather ray: a look-up in the pyramid.

use glam::Vec3;

use crate::accel::LANES;
use crate::bsdf::LobeSet;
use crate::color::Rgb;
use crate::estimator::{Estimator, Footprint};
use crate::lit_scene::Surface;
use crate::math::Side;
use crate::pyramid::{Place, View};
use crate::sampling::Rng;

/// Reads a finished pyramid as one set of photons filled it.
pub struct PyramidLookup<'a> {
    pyramid: View<'a>,
    /// Rays shorter than this many cells are followed.
    retrace_distance: f32,
}

impl<'a> PyramidLookup<'a> {
    /// Look-ups in `pyramid`; rays shorter than `retrace_distance` cells are followed.
    #[must_use]
    pub const fn new(pyramid: View<'a>, retrace_distance: f32) -> Self {
        Self { pyramid, retrace_distance }
    }

    /// True where a look-up would read a cell that the ray's start may lie in, or where a mirror-like ray would see cells.
    fn too_short(&self, surface: &Surface<'_>, footprint: Footprint) -> bool {
        let area = footprint.area();
        let level = self.pyramid.level_for(area);
        // Direction bins are those of cells that are not refined.
        let finest = if surface.bsdf.has(LobeSet::ROUGH) { self.pyramid.base_level() } else { level };
        let cell = self.pyramid.cell_size(surface.p, level.min(finest));
        let near = footprint.travelled < self.retrace_distance * cell;
        near || (footprint.sharp && area < cell * cell)
    }
}

impl Estimator for PyramidLookup<'_> {
    type Place = Place;

    const READS_BOTH_SIDES: bool = true;

    /// `None` for rays too short for the cell they would read.
    #[inline(always)]
    fn place(&self, p: Vec3, side: Side, _wo: Vec3, footprint: Footprint) -> Option<Place> {
        let level = self.pyramid.existing_level(p, self.pyramid.level_for(footprint.area()));
        let near = footprint.travelled < self.retrace_distance * self.pyramid.nominal_cell_size(level);
        #[expect(clippy::cast_possible_truncation, reason = "classes and levels are few")]
        let place = || Place { p, class: self.pyramid.class(side) as u32, level: level as u32 };
        (!near).then(place)
    }

    #[inline(always)]
    fn read(&self, place: &Place) -> Option<Rgb> {
        self.pyramid.irradiance(place.p, place.class as usize, place.level as usize)
    }

    #[inline(always)]
    fn read_all(&self, places: &[Place; LANES], set: &mut [bool; LANES]) -> [Rgb; LANES] {
        self.pyramid.irradiances(places, set)
    }

    /// From the cell's irradiance and, for glossy lobes, its direction bins.
    fn radiance(
        &self,
        surface: &Surface<'_>,
        lobes: LobeSet,
        footprint: Footprint,
        rng: &mut Rng,
    ) -> Option<Rgb> {
        if self.too_short(surface, footprint) {
            return None;
        }
        let bsdf = &surface.bsdf;
        let level = self.pyramid.level_for(footprint.area());
        let side = bsdf.frame.side();
        let class = self.pyramid.class(side);
        let mut radiance = Rgb::BLACK;
        // Asked for whatever is read, so that the same rays are followed whichever effects are on.
        let irradiance = self.pyramid.irradiance(surface.p, class, level)?;
        if bsdf.has(lobes.and(LobeSet::DIFFUSE)) {
            radiance += bsdf.diffuse_albedo() * irradiance * std::f32::consts::FRAC_1_PI;
        }
        if bsdf.has(LobeSet::TRANSLUCENT) {
            let irradiance = self.pyramid.irradiance(surface.p, self.pyramid.class(side.other()), level)?;
            radiance +=
                bsdf.albedo(lobes.and(LobeSet::TRANSLUCENT)) * irradiance * std::f32::consts::FRAC_1_PI;
        }
        if bsdf.has(LobeSet::ROUGH) {
            let tint = bsdf.specular_tint() * bsdf.rough_gain();
            let shift = [rng.draw() - 0.5, rng.draw() - 0.5];
            if lobes.intersects(LobeSet::ROUGH) {
                radiance += tint * self.pyramid.glossy_radiance(surface.p, class, level, bsdf.wo(), shift);
            }
        }
        Some(radiance)
    }
}
