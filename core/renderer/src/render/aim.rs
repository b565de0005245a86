//! Photons from suns and the world go where the picture looks, where most would not (decision 18).

use std::time::Instant;

use crate::gather::{Seen, finds, landings};
use crate::lit_scene::LitScene;
use crate::pyramid::Reading;
use crate::settings::{RenderSettings, Switch};
use crate::stats::AimStats;

/// Where at least this share of a light's photons lands where the picture looks, they are left as they are.
const ENOUGH: f64 = 0.3;

/// A light is chosen by the flux it brings to what the picture looks at, and by so much of all its flux: light also comes
/// from around the corner.
const ELSEWHERE: f64 = 0.01;

/// Aims the photons of `lit`, which looks at the points `seen`; `None` where they are left as they are.
pub(super) fn aim(lit: &mut LitScene<'_>, seen: &[Reading], settings: &RenderSettings) -> Option<AimStats> {
    let clock = Instant::now();
    let (switch, seed) = (settings.photon_pass.aim, settings.render.seed);
    let distant = lit.lights.distant();
    if switch == Switch::Off || !lit.plan.indirect() || distant.is_empty() || seen.is_empty() {
        return None;
    }
    let seen = Seen::new(seen);
    let before: Vec<_> = distant.iter().map(|&light| landings(lit, light, &seen, seed)).collect();
    let lacks = |&index: &usize| switch == Switch::On || before[index].share < ENOUGH;
    let lacking: Vec<usize> = (0..distant.len()).filter(lacks).collect();
    if lacking.is_empty() {
        return None;
    }
    let finds = finds(lit, seed);
    let mut stats = AimStats { lights: lacking.len(), ..AimStats::default() };
    for &index in &lacking {
        let light = distant[index];
        lit.lights.aim(light, &finds);
        let after = landings(lit, light, &seen, seed);
        let whole = f64::from(lit.lights.flux_of(light).mean());
        lit.lights.weigh(light, after.flux + ELSEWHERE * whole);
        stats.seen_before += before[index].share / lacking.len() as f64;
        stats.seen_after += after.share / lacking.len() as f64;
    }
    stats.bytes = lit.lights.aim_bytes();
    stats.seconds = clock.elapsed().as_secs_f64();
    Some(stats)
}
