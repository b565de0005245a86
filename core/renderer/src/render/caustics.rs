//! Caustics from photons: what these are aimed at, and the maps they make.

use std::time::Instant;

use glam::Vec3;

use super::Work;
use crate::bsdf::{LobeSet, PreparedMaterial};
use crate::caustic_map::{CausticMap, CausticPhotons};
use crate::effects_plan::Effect;
use crate::error::RenderError;
use crate::light::Casters;
use crate::photon_pass::{self, Carry, PhotonPass};
use crate::progress::Stage;
use crate::scene::Scene;
use crate::stats::Stats;

/// What photons are aimed at: triangles of mirrors and glass.
pub(super) fn casters(scene: &Scene, materials: &[PreparedMaterial]) -> Option<Casters> {
    let mut boxes = Vec::new();
    for object in &scene.objects {
        let throws = |i: &usize| materials[object.material(*i)].classes().intersects(LobeSet::FOLLOWED);
        boxes.extend((0..object.mesh.triangles.len()).filter(throws).map(|i| {
            let [a, b, c] = object.corners(i).map(|corner| corner.as_vec3());
            [a.min(b).min(c), a.max(b).max(c)]
        }));
    }
    boxes.retain(|[low, high]: &[Vec3; 2]| low.is_finite() && high.is_finite());
    Casters::new(boxes)
}

impl Work<'_> {
    /// Whether there is a map.
    fn maps_caustics(&self) -> bool {
        self.lit.plan.caustics && self.lit.lights.has_mapped()
    }

    /// Memory (bytes) of the map while it is built, if every photon lands once.
    pub(super) fn caustic_bytes(&self) -> u64 {
        if self.maps_caustics() {
            self.settings.photon_pass.caustic_count * CausticMap::BYTES_PER_PHOTON
        } else {
            0
        }
    }

    /// A map for each of `sets` sets of photons; none where nothing calls for them.
    pub(super) fn caustics(&self, sets: usize, stats: &mut Stats) -> Result<Vec<CausticMap>, RenderError> {
        let (settings, lit) = (&self.settings.photon_pass, self.lit);
        if !self.maps_caustics() {
            return Ok(Vec::new());
        }
        self.progress.enter(Stage::PhotonPass);
        let clock = Instant::now();
        let photons = CausticPhotons::default();
        let pass = PhotonPass {
            carry: Carry::Caustics,
            count: settings.caustic_count,
            max_depth: settings.max_depth,
            seed: self.settings.render.seed,
            sets,
        };
        let counts = photon_pass::run(lit, pass, &photons, self.progress)?;
        let maps = photons.into_maps(sets, settings.caustic_nearest as usize);
        let seconds = clock.elapsed().as_secs_f64();
        stats.rays.photon += counts.segments;
        stats.photons.caustic = maps.iter().map(|map| map.len() as u64).sum();
        stats.seconds.photon_pass += seconds;
        counts.costs.charge(&mut stats.effects, seconds);
        stats.effects[Effect::Caustics as usize].bytes =
            (stats.photons.caustic * CausticMap::BYTES_PER_PHOTON) as usize;
        Ok(maps)
    }
}
