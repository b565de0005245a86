//! A few camera and gather rays ahead of all else: where light will be read, and how finely.

use glam::DVec2;
use rayon::prelude::*;

use super::camera::camera_ray;
use super::widest_stratum;
use crate::accel::Ray;
use crate::bsdf::{LobeSet, TransportMode};
use crate::lit_scene::{LitScene, Surface, ray_kind};
use crate::pyramid::Reading;
use crate::sampling::{Rng, hash};
use crate::scene::{MIDDLE, visibility};

/// Where the camera and gather rays, `rays` per pixel, see surface, and how fine the cells there should be: a pilot.
#[must_use]
pub fn readings(lit: &LitScene<'_>, rays: u32, seed: u32) -> Vec<Reading> {
    const EDGE: u32 = 64;
    const GATHER_RAYS: u32 = 16;
    const MAX_DEPTH: u32 = 8;
    let camera = &lit.accel.scene().camera;
    let frame = DVec2::from(camera.resolution.map(f64::from));
    let readings = (0..EDGE * EDGE).into_par_iter().flat_map_iter(|i| {
        let mut rng = Rng::new(hash(hash(u64::from(seed), 0x70_69_6c_6f_74), u64::from(i)));
        // The whole frame, so that a border crops the picture and changes nothing in it.
        let at = DVec2::new(f64::from(i % EDGE), f64::from(i / EDGE)) + 0.5;
        let position = at / f64::from(EDGE) * frame;
        let mut readings = Vec::new();
        if let Some(seen) = camera_ray(camera, lit, position, None, MIDDLE)
            && let Some(surface) = first_scatterer(lit, seen.ray, MAX_DEPTH, &mut rng)
        {
            readings.push(Reading { p: surface.p, cell_size: f32::INFINITY });
            for _ in 0..GATHER_RAYS {
                let sample =
                    surface.bsdf.sample(rng.draw(), rng.draw2(), LobeSet::ALL, TransportMode::Radiance);
                let Some(sample) = sample else { continue };
                let ray = surface.leaving(sample.wi, ray_kind(&sample));
                let solid_angle = (1.0 / (rays as f32 * sample.pdf_solid_angle)).min(widest_stratum(rays));
                readings.extend(first_scatterer(lit, ray, MAX_DEPTH, &mut rng).map(|seen| Reading {
                    p: seen.p,
                    cell_size: 0.5 * solid_angle.sqrt() * seen.p.distance(surface.p),
                }));
            }
        }
        readings
    });
    readings.collect()
}

/// The first surface along a ray that is not only mirror, glass or transparent; lamps do not count.
pub(super) fn first_scatterer<'a>(
    lit: &'a LitScene<'a>,
    mut ray: Ray,
    max_depth: u32,
    rng: &mut Rng,
) -> Option<Surface<'a>> {
    ray.mask &= !visibility::LAMP;
    for _ in 0..max_depth {
        let hit = lit.accel.intersect(&ray)?;
        let surface = lit.surface(&ray, hit, 0.0);
        if rng.draw() < surface.bsdf.transparency.mean() {
            ray = surface.leaving(ray.direction, ray.mask);
        } else if surface.bsdf.has(LobeSet::NON_DELTA) {
            return Some(surface);
        } else {
            let sample =
                surface.bsdf.sample(rng.draw(), rng.draw2(), LobeSet::ALL, TransportMode::Radiance)?;
            ray = surface.leaving(sample.wi, ray_kind(&sample));
        }
    }
    None
}
