//! The floor of the gather's time: the same gather rays, traced one by one and nothing else.

use std::sync::Mutex;
use std::time::{Duration, Instant};

use rayon::prelude::*;

use crate::accel::Ray;
use crate::estimator::Estimator;
use crate::film::{BLOCK, Film};

use super::Gatherer;
use super::block::Block;

/// Gather rays of the whole picture and the wall time their tracing takes on the threads of the current pool.
#[derive(Clone, Copy, Debug, Default, serde::Serialize)]
pub struct TraceFloor {
    /// Rays traced.
    pub rays: u64,
    /// Wall seconds of `rtcIntersect1` calls, spread evenly over the threads.
    pub seconds: f64,
}

/// Traces every gather ray of the picture one by one. Making the rays is not counted.
#[must_use]
pub fn trace_floor<E: Estimator>(gatherer: &Gatherer<'_, E>, film: &Film) -> TraceFloor {
    let busy = Mutex::new((0_u64, Duration::ZERO));
    for sample in 0..gatherer.camera_samples {
        film.tiles().par_iter().for_each(|tile| {
            let mut rays: Vec<Ray> = Vec::new();
            let mut block = Block::new(gatherer, sample);
            for y in (tile.y..tile.y + tile.height).step_by(BLOCK as usize) {
                for x in (tile.x..tile.x + tile.width).step_by(BLOCK as usize) {
                    block.collect_gather_rays(x, y, &mut rays);
                }
            }
            let clock = Instant::now();
            let met = rays.iter().filter(|ray| gatherer.lit.accel.intersect(ray).is_some()).count();
            let spent = clock.elapsed();
            std::hint::black_box(met);
            let mut busy = busy.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
            busy.0 += rays.len() as u64;
            busy.1 += spent;
        });
    }
    let (rays, busy) = busy.into_inner().unwrap_or_else(std::sync::PoisonError::into_inner);
    TraceFloor { rays, seconds: busy.as_secs_f64() / rayon::current_num_threads() as f64 }
}
