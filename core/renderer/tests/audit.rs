//! The auditor: what it says about pictures whose error is known, and that it leaves them alone.

mod support;

use glam::{DVec3, Vec3};
use rgp_renderer::scene::{Scene, SceneBuilder};
use rgp_renderer::settings::RenderSettings;
use rgp_renderer::stats::AuditStats;
use support::*;

/// Albedo of the furnace; its radiance is 1 / (1 − albedo), of which 1 + albedo is emitted or direct.
const ALBEDO: f64 = 0.5;

fn furnace(pixels: u32) -> Scene {
    let mut builder = SceneBuilder::default();
    let walls = cuboid(Vec3::new(-1.0, -0.7, 0.0), Vec3::new(1.0, 0.7, 1.2));
    place(&mut builder, walls, &[emitter(ALBEDO as f32, 1.0)]);
    builder.set_camera(camera(DVec3::new(-0.8, -0.5, 0.2), DVec3::new(1.0, 0.6, 0.6), 1.5, pixels));
    builder.finish().expect("a scene with a camera")
}

fn audited(every: u32) -> RenderSettings {
    let mut settings = settings(100_000, 32, 64);
    settings.gather.audit = every;
    settings
}

fn audit(picture: &Picture) -> &AuditStats {
    picture.stats.audit.as_ref().expect("an audit")
}

/// By how much look-ups make the picture of the furnace too bright (percent of its mean).
fn true_bias(picture: &Picture) -> f64 {
    let exact = ALBEDO / (1.0 - ALBEDO) - ALBEDO;
    100.0 * (mean(&picture.indirect_radiance()) - exact) / mean(&picture.radiance())
}

/// The intervals of twenty seeds hold the error of their pictures, as they should at 95 %: seventeen at the least.
#[test]
fn the_interval_holds_the_error_of_the_picture() {
    let scene = furnace(24);
    let mut held = 0;
    let mut intervals = Vec::new();
    for seed in 0..20 {
        let mut settings = audited(16);
        settings.render.seed = seed;
        let picture = render(&scene, &settings);
        let audit = audit(&picture);
        held += u32::from((audit.bias - true_bias(&picture)).abs() <= audit.interval);
        intervals.push(audit.interval);
        assert_eq!(audit.cells, [], "all is well in seed {seed}");
        assert!(audit.cells_tested > 0);
    }
    let interval = mean(&intervals);
    assert!(held >= 17, "{held} of 20 intervals of ±{interval:.2} % hold the error");
    assert!(interval < 3.0, "±{interval:.2} % says nothing");
}

/// Photons that end where they land first leave out all but the direct light at the ends of gather rays.
#[test]
fn missing_light_is_measured() {
    let mut settings = audited(16);
    settings.photon_pass.max_depth = 1;
    let picture = render(&furnace(64), &settings);
    let (audit, expected) = (audit(&picture), true_bias(&picture));
    assert_close(expected, -100.0 * 0.25 / 1.75, 0.02);
    assert!((audit.bias - expected).abs() <= audit.interval, "{audit:?} for {expected}");
    assert!(audit.bias + 3.0 * audit.interval < 0.0, "{audit:?}");
    let worst = &audit.cells[0];
    assert!(audit.cells_disagreeing > 0 && worst.significance < 0.001, "{audit:?}");
    assert_close(worst.ratio.expect("there is light"), 0.5, 0.15);
}

/// A lit room seen from below a bucket that is put over a part of its floor. In a cell much larger than the bucket the floor is
/// lit as if nothing stood there.
fn leaking_room() -> Scene {
    let mut builder = SceneBuilder::default();
    // Corners the other way around look inwards.
    let room = cuboid(Vec3::new(1.0, 0.5, 1.0), Vec3::new(-1.0, -0.5, 0.0));
    place(&mut builder, room, &[diffuse(0.8)]);
    let half = Vec3::new(0.06, 0.06, 0.0);
    let bucket = walls(BUCKET - half, BUCKET + half + 0.1 * Vec3::Z);
    for side in bucket.into_iter().filter(|side| side.iter().any(|corner| corner.z > 0.0)) {
        place(&mut builder, quad(side), &[diffuse(0.8)]);
    }
    builder.add_lamp(point_lamp(10.0, DVec3::new(-0.5, 0.0, 0.8)));
    let (eye, target) = (BUCKET + Vec3::new(0.04, 0.04, 0.02), BUCKET + Vec3::new(-0.04, -0.04, 0.08));
    builder.set_camera(camera(eye.as_dvec3(), target.as_dvec3(), 1.0, 64));
    builder.finish().expect("a scene with a camera")
}

/// Middle of the floor below it.
const BUCKET: Vec3 = Vec3::new(0.37, 0.13, 0.0);

#[test]
fn a_leak_is_measured_and_found() {
    let scene = leaking_room();
    let mut settings = audited(16);
    settings.gather.retrace_distance = 0.0;
    settings.pyramid.finest_resolution = 4;
    settings.pyramid.adaptive_levels = 0;
    settings.pyramid.photons_per_cell = 1;
    let film = rgp_renderer::film::Film::new(64, 64, &settings.film);
    let mut stats = rgp_renderer::stats::Stats::default();
    let progress = rgp_renderer::progress::Progress::default();
    rgp_renderer::render::render(&scene, &settings, library(), &film, &progress, &mut stats)
        .expect("it renders");
    let audit = stats.audit.expect("an audit");
    // No path finds light here: all there is has come through the wall.
    assert!((audit.bias - 100.0).abs() <= audit.interval && audit.interval < 30.0, "{audit:?}");
    let worst = &audit.cells[0];
    assert!(
        worst.ratio.is_none() && DVec3::from(worst.position).as_vec3().distance(BUCKET) < 0.5,
        "{audit:?}"
    );
    let shown = film.audit();
    assert!(
        shown.contains(&1.0) && shown.iter().all(|&v| v == 0.0 || v == 1.0),
        "black where nothing is wrong"
    );
}

/// With and without, on any number of threads: the same picture to the last bit, and the same finding.
#[test]
fn no_pixel_changes() {
    let scene = Room { ball: glossy(0.7, 0.6), ..Room::default() }.builder().finish().expect("a room");
    let render_with = |every: u32, threads: u32| {
        let mut settings = audited(every);
        settings.render.threads = threads;
        render(&scene, &settings)
    };
    let [plain, one, three] = [render_with(0, 1), render_with(20, 1), render_with(20, 3)];
    assert!(plain.stats.audit.is_none());
    for other in [&one, &three] {
        assert_eq!(plain.combined, other.combined);
        assert_eq!(plain.indirect, other.indirect);
        assert_eq!(plain.stats.rays, other.stats.rays);
    }
    let [a, b] = [audit(&one), audit(&three)];
    assert_eq!((a.hits, a.bias.to_bits(), &a.cells), (b.hits, b.bias.to_bits(), &b.cells));
    assert!(a.bias.abs() <= 2.0 * a.interval, "{a:?}");
}
