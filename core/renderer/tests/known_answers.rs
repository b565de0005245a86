//! Scenes with closed forms: spheres, a dome, a box, mirror ducts, one bounce, and each lamp's direct light.
//!
//! Φ is a lamp's flux, ρ an albedo, A the surface, E irradiance, B radiosity, M emitted exitance. In a sphere the kernel
//! cos cos′ / (π d²) is the same for any two points, so that its indirect light is uniform wherever the lamp is.

mod support;

use std::f64::consts::PI;

use glam::{DVec3, Vec3};
use rgp_renderer::color::Rgb;
use rgp_renderer::scene::record::{ClosureRecord, LampProgramRecord, LampRecord, MaterialRecord};
use rgp_renderer::scene::{LampShape, MeshArrays, SceneBuilder};
use rgp_renderer::shader::{Aside, Instruction, MathFunction, Quantity};
use support::*;

const PHOTONS: u64 = 400_000;
const RESOLUTION: u32 = 32;
const RAYS: u32 = 64;
const PIXELS: u32 = 24;

/// E = ρ Φ / ((1 − ρ) A), lamp off the center.
#[test]
fn sphere_with_a_lamp_off_its_center() {
    let (albedo, flux) = (0.6, 10.0);
    let ball = sphere(5, 1.0, Vec3::ZERO);
    let indirect = albedo * flux / ((1.0 - albedo) * area(&ball));
    let mut builder = SceneBuilder::default();
    place(&mut builder, ball, &[diffuse(albedo as f32)]);
    builder.add_lamp(point_lamp(flux as f32, DVec3::new(0.3, 0.1, 0.55)));
    builder.set_camera(camera(DVec3::new(-0.4, 0.1, 0.0), DVec3::X, 2.0, PIXELS));
    let pixels = finish_and_render(builder, &settings(PHOTONS, RESOLUTION, RAYS)).indirect_radiance();
    let exact = albedo / PI * indirect;
    assert_close(mean(&pixels), exact, 0.005);
    assert!(spread(&pixels, exact) < 0.02, "rms {}", spread(&pixels, exact));
}

/// Nodes multiply the light with the square of its way d: Φ with the mean of d², R² − a² / 3 for a lamp at a from the center,
/// in place of Φ; the same through a transparent shell around the lamp.
#[test]
fn sphere_with_a_lamp_that_does_not_fall_off() {
    let (albedo, flux, at) = (0.6, 10.0, DVec3::new(0.3, 0.1, 0.55));
    let ball = sphere(5, 1.0, Vec3::ZERO);
    let arriving = flux * (1.0 - at.length_squared() / 3.0);
    let exact = albedo / PI * albedo * arriving / ((1.0 - albedo) * area(&ball));
    for has_shell in [false, true] {
        let mut builder = SceneBuilder::default();
        place(&mut builder, sphere(5, 1.0, Vec3::ZERO), &[diffuse(albedo as f32)]);
        if has_shell {
            let shell = material(&[ClosureRecord::Transparent { color: Rgb::WHITE }]);
            place(&mut builder, sphere(3, 0.2, at.as_vec3()), &[shell]);
        }
        let length = Instruction::Geometry { quantity: Quantity::RayLength, aside: Aside::HERE };
        let squared = Instruction::Math { function: MathFunction::Multiply, a: 0, b: 0, c: 0 };
        let program = LampProgramRecord { instructions: vec![length, squared], factor: 1 };
        builder.add_lamp(LampRecord { program: Some(program), ..point_lamp(flux as f32, at) });
        builder.set_camera(camera(DVec3::new(-0.4, 0.1, 0.0), DVec3::X, 2.0, PIXELS));
        let pixels = finish_and_render(builder, &settings(PHOTONS, RESOLUTION, RAYS)).indirect_radiance();
        assert_close(mean(&pixels), exact, 0.01);
    }
}

/// Albedo ρ₁ above, ρ₂ below, lamp on the axis at height a: u = (1 + a / √(R² + a²)) / 2 of the flux goes up, and
/// E = (ρ₁ u + ρ₂ (1 − u)) Φ / (4π R²) / (1 − (ρ₁ + ρ₂) / 2), the same above and below.
#[test]
fn sphere_of_two_albedos() {
    let (above, below, height, flux) = (0.8, 0.2, 0.4_f64, 10.0);
    let mut ball = sphere(5, 1.0, Vec3::ZERO);
    let lower = |t: &[u32; 3]| t.iter().map(|&v| ball.positions[v as usize][2]).sum::<f32>() < 0.0;
    ball.slots = ball.triangles.iter().map(|t| u16::from(lower(t))).collect();
    let up = 0.5 * (1.0 + height / (1.0 + height * height).sqrt());
    let direct = flux / area(&ball);
    let indirect = (above * up + below * (1.0 - up)) * direct / (1.0 - 0.5 * (above + below));
    let mut builder = SceneBuilder::default();
    place(&mut builder, ball, &[diffuse(above as f32), diffuse(below as f32)]);
    builder.add_lamp(point_lamp(flux as f32, DVec3::new(0.0, 0.0, height)));
    builder.set_camera(camera(DVec3::ZERO, DVec3::X, 1.5, PIXELS));
    let pixels = finish_and_render(builder, &settings(PHOTONS, RESOLUTION, RAYS)).indirect_radiance();
    let (lower, upper) = pixels.split_at(pixels.len() / 2);
    for (pixels, albedo) in [(lower, below), (upper, above)] {
        let exact = albedo / PI * indirect;
        assert_close(mean(pixels), exact, 0.01);
        assert!(spread(pixels, exact) < 0.03, "rms {}", spread(pixels, exact));
    }
}

/// Inner sphere (radius r₁, albedo ρ₁) emits M, outer (r₂, ρ₂) reflects: F = (r₁ / r₂)² of what leaves the outer meets
/// the inner, B₂ = ρ₂ F M / (1 − ρ₂ (1 − F) − ρ₂ F ρ₁), B₁ = M + ρ₁ B₂.
#[test]
fn concentric_spheres() {
    let (inner, outer, emitted) = (0.5, 0.8, 1.0);
    let factor = 0.36;
    let outer_radiosity = outer * factor * emitted / (1.0 - outer * (1.0 - factor) - outer * factor * inner);
    let inner_radiosity = emitted + inner * outer_radiosity;
    for (at, radiosity) in [(DVec3::ZERO, inner_radiosity), (DVec3::X, outer_radiosity)] {
        let mut builder = SceneBuilder::default();
        let glowing = emitter(inner as f32, (emitted / PI) as f32);
        place(&mut builder, sphere(5, 0.6, Vec3::ZERO), &[glowing]);
        place(&mut builder, sphere(5, 1.0, Vec3::ZERO), &[diffuse(outer as f32)]);
        builder.set_camera(camera(DVec3::new(0.8, 0.0, 0.0), at, 0.7, PIXELS));
        let pixels = finish_and_render(builder, &settings(PHOTONS, RESOLUTION, RAYS)).radiance();
        assert_close(mean(&pixels), radiosity / PI, 0.01);
    }
}

/// Hemisphere of albedo ρ₁ on a disk that emits M and reflects ρ₂. Any point of it sees the disk with the factor ½:
/// B₁ = ρ₁ M / (2 − ρ₁ − ρ₁ ρ₂), B₂ = M + ρ₂ B₁, constant up to the rim.
#[test]
fn dome_on_a_glowing_disk() {
    let (dome_albedo, disk_albedo, emitted) = (0.7, 0.5, 1.0);
    let dome_radiosity = dome_albedo * emitted / (2.0 - dome_albedo - dome_albedo * disk_albedo);
    let disk_radiosity = emitted + disk_albedo * dome_radiosity;
    let (dome, disk) = dome_and_disk();
    let middle = DVec3::new(0.0, 0.0, 0.3);
    let rim = |z: f64| DVec3::new((1.0 - z * z).sqrt(), 0.0, z);
    let from_above = DVec3::new(0.3, 0.0, 0.5);
    let views = [
        (middle, DVec3::new(0.1, 0.2, 1.0), 1.0, dome_radiosity),
        (middle, DVec3::new(0.1, 0.0, 0.0), 1.0, disk_radiosity),
        (from_above, rim(0.05), 0.03, dome_radiosity),
        (from_above, DVec3::new(0.94, 0.0, 0.0), 0.03, disk_radiosity),
    ];
    for (from, at, half_width, radiosity) in views {
        let mut builder = SceneBuilder::default();
        let triangles = |mesh: &[[Vec3; 3]]| soup("part", mesh.iter().copied());
        place(&mut builder, triangles(&dome), &[diffuse(dome_albedo as f32)]);
        place(&mut builder, triangles(&disk), &[emitter(disk_albedo as f32, (emitted / PI) as f32)]);
        builder.set_camera(camera(from, at, half_width, PIXELS));
        let pixels = finish_and_render(builder, &settings(PHOTONS, RESOLUTION, RAYS)).radiance();
        assert_close(mean(&pixels), radiosity / PI, 0.01);
    }
}

/// The upper half of a sphere, and the disk that closes it exactly.
fn dome_and_disk() -> (Vec<[Vec3; 3]>, Vec<[Vec3; 3]>) {
    let ball = sphere(5, 1.0, Vec3::ZERO);
    let faces = ball.triangles.iter().map(|t| t.map(|v| Vec3::from(ball.positions[v as usize])));
    let dome: Vec<_> = faces.filter(|face| face.iter().map(|p| p.z).sum::<f32>() > 0.0).collect();
    let mut rim: Vec<Vec3> = dome.iter().flatten().copied().filter(|p| p.z.abs() < 1e-6).collect();
    rim.sort_by(|a, b| a.y.atan2(a.x).total_cmp(&b.y.atan2(b.x)));
    rim.dedup_by(|a, b| a.distance(*b) < 1e-4);
    let next = rim.iter().cycle().skip(1);
    let disk = rim.iter().zip(next).map(|(&a, &b)| [Vec3::ZERO, a, b]).collect();
    (dome, disk)
}

/// A closed box of any shape: each photon lands 1 / (1 − ρ) times, and the mean over the surface of E is
/// ρ Φ / ((1 − ρ) A). Six cameras with parallel rays see each side evenly.
#[test]
fn energy_balance_of_a_closed_box() {
    let (low, high) = (Vec3::ZERO, Vec3::new(1.0, 2.0, 0.7));
    let (albedo, flux) = ([0.8_f64, 0.6, 0.2], 10.0);
    let color = Rgb(albedo.map(|c| c as f32));
    let (mut light, mut surface) = ([0.0; 3], 0.0);
    for (side, corners) in walls(low, high).into_iter().enumerate() {
        let mut builder = SceneBuilder::default();
        place(
            &mut builder,
            cuboid(low, high),
            &[material(&[ClosureRecord::Diffuse { color, roughness: 0.0 }])],
        );
        builder.add_lamp(point_lamp(flux as f32, DVec3::new(0.2, 1.5, 0.3)));
        builder.set_camera(facing_wall(side, corners));
        let picture = finish_and_render(builder, &settings(200_000, RESOLUTION, RAYS));
        let wall = area(&quad(corners));
        surface += wall;
        for (c, sum) in light.iter_mut().enumerate() {
            let pixels: Vec<f64> = picture.indirect.chunks(3).map(|p| f64::from(p[c])).collect();
            *sum += mean(&pixels) * PI / albedo[c] * wall;
        }
        // Roulette follows the largest channel.
        let landings = picture.stats.photons.deposited as f64 / picture.stats.photons.emitted as f64;
        assert_close(landings, 1.0 / (1.0 - albedo[0]), 0.01);
    }
    for c in 0..3 {
        let exact = albedo[c] * flux / ((1.0 - albedo[c]) * surface);
        assert_close(light[c] / surface, exact, 0.005);
    }
}

/// A camera with parallel rays that sees exactly one side of a box from inside.
fn facing_wall(side: usize, corners: [Vec3; 4]) -> rgp_renderer::scene::record::CameraRecord {
    let center = corners.iter().sum::<Vec3>().as_dvec3() / 4.0;
    let mut inward = DVec3::ZERO;
    inward[side / 2] = if side.is_multiple_of(2) { 1.0 } else { -1.0 };
    let mut record = parallel_camera(center + inward * 0.3, center, 1.0, PIXELS);
    let world = rgp_renderer::scene::record::matrix(&record.world_from_camera);
    let half = |axis: DVec3| corners.iter().map(|p| (p.as_dvec3() - center).dot(axis)).fold(0.0, f64::max);
    let (x, y) = (half(world.x_axis.truncate()), half(world.y_axis.truncate()));
    record.window = [-x, x, -y, y];
    record
}

/// Two plates between four mirrors are infinite plates: B₁ = M / (1 − ρ₁ ρ₂), B₂ = ρ₂ B₁, whatever their distance.
#[test]
fn plates_between_mirrors() {
    let (glowing, gray, emitted) = (0.4, 0.7, 1.0);
    let plate = emitted / (1.0 - glowing * gray);
    let mirror = material(&[ClosureRecord::Glossy {
        color: Rgb::WHITE,
        roughness: 0.0,
        anisotropy: 0.0,
        rotation: 0.0,
        multiscatter: true,
    }]);
    let (low, high) = (Vec3::new(-0.5, -0.5, 0.0), Vec3::new(0.5, 0.5, 0.6));
    for (at, radiosity) in [(-DVec3::Z, plate), (DVec3::Z, gray * plate)] {
        let mut builder = SceneBuilder::default();
        let materials: [MaterialRecord; 2] =
            [emitter(glowing as f32, (emitted / PI) as f32), diffuse(gray as f32)];
        for (side, corners) in walls(low, high).into_iter().enumerate() {
            let material = if side < 4 { &mirror } else { &materials[side - 4] };
            place(&mut builder, quad(corners), std::slice::from_ref(material));
        }
        let middle = DVec3::new(0.1, 0.0, 0.3);
        builder.set_camera(camera(middle, middle + at, 1.0, PIXELS));
        let pixels = finish_and_render(builder, &settings(PHOTONS, RESOLUTION, RAYS)).radiance();
        assert_close(mean(&pixels), radiosity / PI, 0.01);
    }
}

/// Lamp of intensity 1 at height ½ over a disk of radius 2 and albedo ½: one bounce gives E = 0.3856086 at height 1
/// above it (quadrature; 0.3877339 for an infinite floor).
#[test]
fn one_bounce_off_a_floor() {
    let corner = |i: u32| {
        let (sin, cos) = (std::f32::consts::TAU * i as f32 / 256.0).sin_cos();
        Vec3::new(2.0 * cos, 2.0 * sin, 0.0)
    };
    let disk: MeshArrays = soup("disk", (0..256).map(|i| [Vec3::ZERO, corner(i), corner(i + 1)]));
    let mut builder = SceneBuilder::default();
    place(&mut builder, disk, &[diffuse(0.5)]);
    place(&mut builder, floor(0.01, 1.0), &[diffuse(0.8)]);
    builder.add_lamp(point_lamp(4.0 * PI as f32, DVec3::new(0.0, 0.0, 0.5)));
    let receiver = DVec3::new(0.0, 0.0, 1.0);
    builder.set_camera(parallel_camera(receiver - DVec3::Z * 0.1, receiver, 0.005, PIXELS));
    let pixels = finish_and_render(builder, &settings(1_000_000, 128, 256)).indirect_radiance();
    assert_close(mean(&pixels), 0.8 / PI * 0.385_608_62, 0.01);
}

/// Irradiance on the floor beside a glowing panel just above it, from where it is seen at a few degrees: a difference of two
/// parallel rectangles with a corner above the point, on both sides. Rays to the panel must not end in it.
#[test]
fn glowing_panel_just_above_a_floor() {
    let radiance = 100.0;
    for height in [0.1_f32, 0.02] {
        let corners = [(-0.5, -0.5), (0.5, -0.5), (0.5, 0.5), (-0.5, 0.5)];
        let factor = |a: f64| parallel_rectangle(a / f64::from(height), 0.5 / f64::from(height));
        let irradiance = PI * radiance * 2.0 * (factor(1.5) - factor(0.5));
        let mut builder = SceneBuilder::default();
        let panel = quad(corners.map(|(x, y)| Vec3::new(x, y, height)));
        place(&mut builder, panel, &[emitter(0.0, radiance as f32)]);
        place(&mut builder, floor(20.0, 0.0), &[diffuse(0.5)]);
        let seen = DVec3::new(1.0, 0.0, 0.0);
        builder.set_camera(parallel_camera(seen + DVec3::Z, seen, 0.001, 64));
        let mut settings = settings(0, RESOLUTION, 16);
        settings.gather.camera_samples = 64;
        let found = mean(&finish_and_render(builder, &settings).radiance()) * PI / 0.5;
        assert!((found / irradiance - 1.0).abs() < 0.02, "{height}: {found} is not {irradiance}");
    }
}

/// Form factor of a rectangle of sides a and b as seen from an element under its corner, parallel to it and one below.
fn parallel_rectangle(a: f64, b: f64) -> f64 {
    let (u, v) = ((1.0 + a * a).sqrt(), (1.0 + b * b).sqrt());
    (a / u * (b / u).atan() + b / v * (a / v).atan()) / (2.0 * PI)
}

/// Irradiance on the floor straight below a lamp, as the picture shows it: L = ρ E / π.
#[test]
fn direct_light_of_each_lamp() {
    let (power, height, spread) = (10.0, 2.0_f64, std::f32::consts::PI);
    let intensity = power / (4.0 * PI);
    let square_distance = height * height;
    let rectangle = 4.0 * parallel_rectangle(0.5 / height, 0.25 / height) * power / 0.5;
    let disk = 0.25 / (0.25 + square_distance) * power / (PI * 0.25);
    let (radius, soft_falloff) = (0.3, false);
    let lamps = [
        (LampShape::Point { radius: 0.0, soft_falloff }, intensity / square_distance),
        (LampShape::Point { radius, soft_falloff }, intensity / square_distance),
        (LampShape::Point { radius, soft_falloff: true }, intensity / (square_distance + 0.09)),
        (
            LampShape::Spot { radius: 0.0, soft_falloff, cone_angle: 0.8, blend: 0.2 },
            intensity / square_distance,
        ),
        (LampShape::Sun { angle: 0.1 }, power),
        (LampShape::Rectangle { size: [1.0, 0.5], spread }, rectangle),
        (LampShape::Ellipse { size: [1.0, 1.0], spread }, disk),
    ];
    for (shape, irradiance) in lamps {
        let mut builder = SceneBuilder::default();
        builder.add_lamp(lamp(shape.clone(), power as f32, DVec3::new(0.0, 0.0, height)));
        assert_floor(builder, irradiance, &format!("{shape:?}"));
    }
    let mut builder = SceneBuilder::default();
    builder.set_world(world(0.7));
    assert_floor(builder, 0.7 * PI, "world");
    let mut builder = SceneBuilder::default();
    let panel =
        quad([(-0.5, -0.25), (0.5, -0.25), (0.5, 0.25), (-0.5, 0.25)].map(|(x, y)| Vec3::new(x, y, 2.0)));
    place(&mut builder, panel, &[emitter(0.0, (power / (0.5 * PI)) as f32)]);
    assert_floor(builder, rectangle, "emissive mesh");
}

fn assert_floor(mut builder: SceneBuilder, irradiance: f64, what: &str) {
    place(&mut builder, floor(1.0, 0.0), &[diffuse(0.5)]);
    builder.set_camera(parallel_camera(DVec3::Z, DVec3::ZERO, 0.01, 64));
    let mut settings = settings(0, RESOLUTION, 16);
    settings.gather.camera_samples = 16;
    let found = mean(&finish_and_render(builder, &settings).radiance()) * PI / 0.5;
    assert!((found / irradiance - 1.0).abs() < 0.002, "{what}: {found} is not {irradiance}");
}
