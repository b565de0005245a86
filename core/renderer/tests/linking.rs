//! Light linking: what a lamp or an emissive mesh lights, and what blocks its light. Closed forms as in `known_answers.rs`.

mod support;

use std::f64::consts::PI;

use glam::{DMat4, DVec3, Vec3};
use rgp_renderer::color::Rgb;
use rgp_renderer::scene::record::{ClosureRecord, MaterialRecord, ObjectLinks};
use rgp_renderer::scene::{LampShape, LightLinks, MeshArrays, SceneBuilder, visibility};
use support::*;

const PIXELS: u32 = 16;
const FLUX: f64 = 10.0;
const ALBEDO: f64 = 0.6;

/// Lights the first set of receivers alone.
const FIRST: LightLinks = LightLinks { receivers: 1, blockers: None };

/// Adds a mesh in the sets of receivers and of blockers with a number.
fn add(builder: &mut SceneBuilder, mesh: MeshArrays, material: &MaterialRecord, set: u32, light: LightLinks) {
    let material = builder.add_material(material.clone()) as u32;
    let mesh = builder.add_mesh(mesh).expect("arrays that fit together");
    let object = builder.add_object("object", mesh, DMat4::IDENTITY, vec![material], visibility::ALL);
    let links = ObjectLinks { receiver_set: set, blocker_set: set, light };
    builder.set_object_links(object.expect("a mesh"), links).expect("an object");
}

/// The triangles of a mesh whose middle is above 0, or those below.
fn half(mut mesh: MeshArrays, above: bool) -> MeshArrays {
    let height = |t: &[u32; 3]| t.iter().map(|&v| mesh.positions[v as usize][2]).sum::<f32>();
    mesh.triangles.retain(|t| (height(t) > 0.0) == above);
    mesh
}

/// A sphere about a lamp that lights its upper half alone: what is reflected there lights both halves alike,
/// E = ρ Φ / (2 (1 − ρ) A).
#[test]
fn half_a_sphere_is_lit() {
    let ball = || sphere(5, 1.0, Vec3::ZERO);
    let direct = FLUX / area(&ball());
    let indirect = 0.5 * ALBEDO * direct / (1.0 - ALBEDO);
    for radius in [0.0, 0.1] {
        let mut builder = SceneBuilder::default();
        for (above, set) in [(true, 0), (false, 1)] {
            add(&mut builder, half(ball(), above), &diffuse(ALBEDO as f32), set, LightLinks::ALL);
        }
        let shape = LampShape::Point { radius, soft_falloff: false };
        let mut lamp = lamp(shape, FLUX as f32, DVec3::ZERO);
        lamp.links = FIRST;
        builder.add_lamp(lamp);
        builder.set_camera(camera(DVec3::new(-0.3, 0.0, 0.0), DVec3::X, 0.5, PIXELS));
        let pixels = finish_and_render(builder, &settings(200_000, 16, 64)).radiance();
        let (lower, upper) = pixels.split_at(pixels.len() / 2);
        assert_close(mean(lower), ALBEDO / PI * indirect, 0.02);
        assert_close(mean(upper), ALBEDO / PI * (indirect + direct), 0.02);
    }
}

/// A lamp within a black ball or a clear one, in a sphere: where the ball does not block or is clear, it is as bright as
/// without, once: E = Φ / ((1 − ρ) A); else all is dark.
#[test]
fn what_does_not_block_casts_no_shadow() {
    let ball = || sphere(5, 1.0, Vec3::ZERO);
    let exact = ALBEDO / PI * FLUX / (area(&ball()) * (1.0 - ALBEDO));
    let (black, clear) = (diffuse(0.0), material(&[ClosureRecord::Transparent { color: Rgb::WHITE }]));
    for (blockers, material, expected) in [
        (Some(0b01), &black, exact),
        (Some(0b10), &black, 0.0),
        (None, &black, 0.0),
        (Some(0b01), &clear, exact),
        (Some(0b10), &clear, exact),
        (None, &clear, exact),
    ] {
        let mut builder = SceneBuilder::default();
        add(&mut builder, ball(), &diffuse(ALBEDO as f32), 0, LightLinks::ALL);
        add(&mut builder, sphere(2, 0.02, Vec3::ZERO), material, 1, LightLinks::ALL);
        let mut lamp = lamp(LampShape::Point { radius: 0.01, soft_falloff: false }, FLUX as f32, DVec3::ZERO);
        lamp.links = LightLinks { receivers: u32::MAX, blockers };
        builder.add_lamp(lamp);
        builder.set_camera(camera(DVec3::new(0.1, 0.0, 0.0), DVec3::X, 0.5, PIXELS));
        let pixels = finish_and_render(builder, &settings(200_000, 16, 64)).radiance();
        if expected > 0.0 {
            assert_close(mean(&pixels), expected, 0.01);
        } else {
            assert_eq!(mean(&pixels), 0.0);
        }
    }
}

/// A panel above the camera shines on the floor or not; a mirror shows it where it is lit by it.
#[test]
fn emissive_meshes_are_linked() {
    let panel =
        || quad([(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)].map(|(x, y)| Vec3::new(x, y, 1.0)));
    let render = |material: &MaterialRecord, links: LightLinks| {
        let mut builder = SceneBuilder::default();
        add(&mut builder, floor(50.0, 0.0), material, 1, LightLinks::ALL);
        add(&mut builder, panel(), &emitter(0.0, 3.0), 0, links);
        builder.set_camera(camera(DVec3::new(0.0, 0.0, 0.5), DVec3::ZERO, 0.2, PIXELS));
        let mut settings = settings(1000, 16, 64);
        settings.gather.light_samples = 128;
        mean(&finish_and_render(builder, &settings).radiance())
    };
    let mirror = glossy(1.0, 0.0);
    for material in [&diffuse(0.5), &mirror, &glossy(0.8, 0.3)] {
        assert_eq!(render(material, FIRST), 0.0);
        let lit = render(material, LightLinks { receivers: 0b10, blockers: None });
        assert_close(lit, render(material, LightLinks::ALL), 1e-6);
        let freely = render(material, LightLinks { receivers: u32::MAX, blockers: Some(0b11) });
        assert_close(freely, lit, 0.02);
    }
    assert_close(render(&mirror, LightLinks::ALL), 3.0, 1e-3);
}

/// Of many lamps, those that do not light a surface are not asked.
#[test]
fn many_lamps_are_linked() {
    let mut means = [0.0; 2];
    for (linked, mean_of) in [true, false].into_iter().zip(&mut means) {
        let mut builder = SceneBuilder::default();
        add(&mut builder, floor(1.0, 0.0), &diffuse(0.5), 1, LightLinks::ALL);
        for i in 0..200_u32 {
            let place = DVec3::new(f64::from(i % 20) * 0.1 - 1.0, f64::from(i / 20) * 0.2 - 1.0, 1.0);
            let mut lamp = point_lamp(1.0, place);
            lamp.links = LightLinks { receivers: if i % 4 == 0 { 0b10 } else { 0b01 }, blockers: None };
            if linked || i % 4 == 0 {
                builder.add_lamp(lamp);
            }
        }
        builder.set_camera(camera(DVec3::new(0.0, 0.0, 2.0), DVec3::ZERO, 0.4, PIXELS));
        let mut settings = settings(1000, 16, 64);
        settings.gather.light_samples = 16;
        *mean_of = mean(&finish_and_render(builder, &settings).radiance());
    }
    assert_close(means[0], means[1], 0.01);
}

#[test]
fn sets_that_do_not_exist_are_refused() {
    let mut builder = SceneBuilder::default();
    let mesh = builder.add_mesh(floor(1.0, 0.0)).expect("a mesh");
    builder.add_object("object", mesh, DMat4::IDENTITY, Vec::new(), visibility::ALL).expect("an object");
    let links =
        |receiver_set, blocker_set| ObjectLinks { receiver_set, blocker_set, ..ObjectLinks::default() };
    assert!(builder.set_object_links(0, links(31, 23)).is_ok());
    assert!(builder.set_object_links(0, links(32, 0)).is_err());
    assert!(builder.set_object_links(0, links(0, 24)).is_err());
    assert!(builder.set_object_links(1, links(0, 0)).is_err());
}
