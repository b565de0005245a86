//! The picture is the same to the last bit for any number of threads, any tile size, on every run.

mod support;

use rgp_renderer::scene::Scene;
use rgp_renderer::scene::record::MaterialRecord;
use support::*;

fn room(ball: MaterialRecord) -> Scene {
    Room { ball, pixels: 37, ..Room::default() }.builder().finish().expect("a scene")
}

/// 37 pixels: no tile size divides it, so that tiles and blocks are cut at the edge.
fn same_bits_however_it_is_cut(scene: &Scene) {
    let picture = |threads: u32, tile_size: u32| {
        let mut settings = settings(100_000, 32, 32);
        settings.render.threads = threads;
        settings.film.tile_size = tile_size;
        let picture = render(scene, &settings);
        let bits: Vec<u32> = picture.combined.iter().chain(&picture.indirect).map(|v| v.to_bits()).collect();
        (bits, picture.stats)
    };
    let (bits, stats) = picture(1, 64);
    assert!(stats.photons.deposited > 100_000 && stats.rays.gather > 30_000, "{stats:?}");
    for (threads, tile_size) in [(1, 64), (2, 64), (7, 64), (2, 8), (7, 20), (1, 20), (2, 64)] {
        let (other, counted) = picture(threads, tile_size);
        let differing = bits.iter().zip(&other).filter(|(a, b)| a != b).count();
        assert_eq!(differing, 0, "{threads} threads, tiles of {tile_size}: differing numbers");
        assert_eq!(counted.rays, stats.rays);
        assert_eq!(counted.photons, stats.photons);
    }
}

#[test]
fn diffuse_scene() {
    same_bits_however_it_is_cut(&room(diffuse(0.5)));
}

#[test]
fn glossy_scene() {
    let scene = room(glossy(0.8, 0.7));
    let picture = render(&scene, &settings(100_000, 32, 32));
    assert!(picture.stats.pyramid.glossy_cells > 100, "direction bins are in use");
    same_bits_however_it_is_cut(&scene);
}

#[test]
fn another_seed_is_another_picture() {
    let scene = room(diffuse(0.5));
    let mut settings = settings(100_000, 32, 32);
    let first = render(&scene, &settings);
    settings.render.seed = 1;
    let second = render(&scene, &settings);
    assert_ne!(first.combined, second.combined);
    assert_close(mean(&second.radiance()), mean(&first.radiance()), 0.01);
}
