//! A render stops within half a second of being asked to, at any moment, and its film stays readable.

mod support;

use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

use rgp_renderer::error::RenderError;
use rgp_renderer::film::Film;
use rgp_renderer::progress::{Progress, Stage};
use rgp_renderer::render::render;
use rgp_renderer::settings::RenderSettings;
use rgp_renderer::stats::Stats;
use support::{Room, library, settings};

/// Tells that a render is over, also by a panic.
struct Over<'a>(&'a AtomicBool);

impl Drop for Over<'_> {
    fn drop(&mut self) {
        self.0.store(true, Ordering::Relaxed);
    }
}

/// Renders a picture that takes minutes, asks to stop as soon as `now` says so, and checks what it left behind.
fn stop(settings: &RenderSettings, now: impl Fn(&Progress) -> bool + Send + Sync) -> Film {
    let scene = Room { pixels: 256, ..Room::default() }.builder().finish().expect("a scene");
    let film = Film::new(256, 256, &settings.film);
    let (progress, over) = (Progress::default(), AtomicBool::new(false));
    let (result, asked, ended) = std::thread::scope(|scope| {
        let watcher = scope.spawn(|| {
            while !now(&progress) && !over.load(Ordering::Relaxed) {
                std::thread::sleep(Duration::from_millis(1));
            }
            progress.cancel();
            Instant::now()
        });
        let _over = Over(&over);
        let result = render(&scene, settings, library(), &film, &progress, &mut Stats::default());
        (result, watcher.join().expect("the watcher ends"), Instant::now())
    });
    assert!(matches!(result, Err(RenderError::Cancelled)), "{result:?}");
    let late = ended.saturating_duration_since(asked);
    assert!(late < Duration::from_millis(500), "stopped {late:?} after it was asked to");
    assert_eq!(film.combined().len(), 256 * 256 * 4);
    assert!(film.combined().iter().chain(&film.indirect()).all(|v| v.is_finite() && *v >= 0.0));
    film
}

fn endless() -> RenderSettings {
    settings(100_000_000, 256, 4096)
}

#[test]
fn before_it_begins() {
    let film = stop(&endless(), |_| true);
    assert!(film.combined().iter().all(|&v| v == 0.0));
}

#[test]
fn after_some_time() {
    for milliseconds in [0, 5, 20, 100, 400] {
        let began = Instant::now();
        stop(&endless(), |_| began.elapsed() >= Duration::from_millis(milliseconds));
    }
}

#[test]
fn among_the_photons() {
    stop(&endless(), |progress| {
        let now = progress.snapshot();
        now.stage == Stage::PhotonPass && now.fraction > 0.0
    });
}

/// What was gathered until then stays in the film.
#[test]
fn among_the_gather_rays() {
    let film = stop(&settings(10_000, 64, 4096), |progress| {
        let now = progress.snapshot();
        now.stage == Stage::Gather && now.fraction > 0.0
    });
    assert!(film.combined().iter().any(|&v| v > 0.0));
}
