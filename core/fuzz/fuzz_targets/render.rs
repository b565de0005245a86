//! Every scene that is not refused becomes a picture of numbers, or a message.
#![no_main]

use std::path::PathBuf;
use std::sync::LazyLock;

use libfuzzer_sys::fuzz_target;
use rgp_fuzz::draw::Draw;
use rgp_fuzz::scenes::scene;
use rgp_renderer::film::Film;
use rgp_renderer::progress::Progress;
use rgp_renderer::render;
use rgp_renderer::settings::RenderSettings;
use rgp_renderer::stats::Stats;

static EMBREE: LazyLock<PathBuf> = LazyLock::new(|| {
    std::env::var_os("RGP_EMBREE_LIBRARY").expect("RGP_EMBREE_LIBRARY names the Embree library").into()
});

fuzz_target!(|bytes: &[u8]| {
    let mut draw = Draw(bytes);
    let settings = settings(&mut draw);
    let Ok(scene) = scene(&mut draw) else { return };
    let [_, _, width, height] = scene.camera.region;
    let film = Film::new(width, height, &settings.film);
    let mut stats = Stats::default();
    let done = render::render(&scene, &settings, &EMBREE, &film, &Progress::default(), &mut stats);
    if done.is_ok() {
        assert_eq!(stats.nonfinite_pixels, 0, "{:?}", scene.problems);
        assert!(film.combined().iter().all(|value| value.is_finite()), "{:?}", film.combined());
    }
});

/// As little work as shows everything.
fn settings(draw: &mut Draw<'_>) -> RenderSettings {
    let mut settings = RenderSettings::default();
    settings.photon_pass.photon_count = 200;
    settings.photon_pass.caustic_count = if draw.flag() { 200 } else { 0 };
    settings.photon_pass.max_depth = 1 + draw.below(8) as u32;
    settings.pyramid.finest_resolution = 1 + draw.below(16) as u32;
    settings.pyramid.bins = draw.choice(&["8x16", "1x1", "32x64"]).to_string();
    settings.gather.rays = 1 + draw.below(4) as u32;
    settings.gather.camera_samples = 1 + draw.below(2) as u32;
    settings.gather.max_depth = 1 + draw.below(8) as u32;
    settings.gather.audit = draw.below(2) as u32;
    settings.render.threads = 1;
    settings
}
