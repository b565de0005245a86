//! Shadow catchers: the camera does not see them, but what is missing of their light.
//!
//! Where the camera meets one, the same point is lit once more, by the scene without what is not a catcher: the same light
//! samples and gather rays, in a ray tracer that holds the catchers alone. There are no photons in that scene; its paths are
//! followed to their ends. The film divides one light by the other.

use crate::accel::{Hit, LANES, Ray};
use crate::color::Rgb;
use crate::effects_plan::{Costs, Effect};
use crate::estimator::Estimator;
use crate::film::{BLOCK, CatcherSample, TileRect};
use crate::lit_scene::Surface;
use crate::stats::RayCounts;

use super::Gatherer;
use super::block::Block;
use super::path::Met;

/// A camera sample that met a shadow catcher.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Caught {
    /// Light from before the catcher: lamps, and what shines through.
    before: Rgb,
    /// Light that the catcher emits.
    emitted: Rgb,
    /// Light of the world behind it; black where the film is transparent.
    background: Rgb,
}

impl<E: Estimator> Gatherer<'_, E> {
    /// True where a camera ray met a shadow catcher.
    #[inline]
    pub(super) fn is_catcher(&self, hit: &Hit) -> bool {
        self.lit.plan.shadow_catcher && self.lit.accel.scene().objects[hit.object as usize].is_catcher()
    }

    /// The world as a camera ray would see it, were there nothing else.
    pub(super) fn behind_catcher(&self, ray: &Ray) -> Caught {
        let background =
            if self.lit.accel.scene().world.film_transparent { Rgb::BLACK } else { self.background(ray) };
        Caught { background, ..Caught::default() }
    }

    /// A camera ray that ended at `surface`, which is a catcher's, with what it met.
    pub(super) fn caught(&self, ray: &Ray, surface: &Surface<'_>, met: &Met) -> Caught {
        let opacity = 1.0 - surface.bsdf.transparency.mean().clamp(0.0, 1.0);
        let emitted = met.through * surface.bsdf.emission * opacity;
        let background = met.through * self.behind_catcher(ray).background;
        Caught { before: met.light - emitted, emitted, background }
    }
}

/// The catchers of one tile, lit without the other objects.
pub(super) struct CatcherTile<'a, 'g, E: Estimator> {
    block: Block<'a, 'g, E>,
    tile: TileRect,
    /// By pixel of the tile.
    samples: Vec<CatcherSample>,
}

impl<'a, 'g, E: Estimator> CatcherTile<'a, 'g, E> {
    /// Nothing is caught yet. `without` gathers in the scene without other objects.
    pub(super) fn new(without: &'g Gatherer<'a, E>, sample: u32, tile: TileRect) -> Self {
        let pixels = tile.width as usize * tile.height as usize;
        Self { block: Block::new(without, sample), tile, samples: vec![CatcherSample::default(); pixels] }
    }

    /// Lights the catchers that `seen`, at (x, y), has met. Takes its vertices.
    #[inline(never)]
    pub(super) fn light<F: Estimator>(&mut self, seen: &mut Block<'a, '_, F>, x: u32, y: u32) {
        if !self.block.take_caught(seen) {
            return;
        }
        let meter = &mut self.block.traces.meter;
        meter.begin(self.block.gatherer.is_clocked(self.block.sample, x, y));
        meter.enter(Effect::ShadowCatcher);
        self.block.light();
        self.block.gather();
        self.block.traces.meter.end();
        let share = self.block.gatherer.direct_share;
        for lane in 0..LANES {
            let (px, py) = (x + lane as u32 % BLOCK, y + lane as u32 / BLOCK);
            let is_inside = px < self.tile.x + self.tile.width && py < self.tile.y + self.tile.height;
            let Some(caught) = seen.caught[lane].filter(|_| is_inside) else { continue };
            let light = &self.block.samples[lane];
            let pixel = (py - self.tile.y) * self.tile.width + px - self.tile.x;
            self.samples[pixel as usize] = CatcherSample {
                is_caught: true,
                before: caught.before,
                without: light.direct + light.indirect * share + caught.emitted,
                background: caught.background,
            };
        }
    }

    /// The samples, and what they cost.
    pub(super) fn finish(self) -> (Vec<CatcherSample>, RayCounts, Costs) {
        let traces = self.block.finish();
        (self.samples, traces.rays, traces.meter.costs.all_for(Effect::ShadowCatcher))
    }
}

impl<'a, E: Estimator> Block<'a, '_, E> {
    /// Takes over the points on catchers that `seen` has met; false where there are none.
    fn take_caught<F: Estimator>(&mut self, seen: &mut Block<'a, '_, F>) -> bool {
        let is_caught = seen.caught.map(|caught| caught.is_some());
        if !is_caught.contains(&true) {
            return false;
        }
        self.packet.clear();
        (self.keys, self.seeds) = (seen.keys, seen.seeds);
        self.lambert.clone_from(&seen.lambert);
        self.others = [None; LANES];
        self.has_vertices = false;
        for (lane, is_caught) in is_caught.into_iter().enumerate() {
            self.lambert.set[lane] &= is_caught;
            self.vertices[lane] = seen.vertices[lane].take().filter(|_| is_caught);
            self.has_vertices |= self.vertices[lane].is_some();
            (self.samples[lane].direct, self.samples[lane].indirect) = (Rgb::BLACK, Rgb::BLACK);
        }
        true
    }
}
