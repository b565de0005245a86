//! Sixteen rays at a time answer as sixteen single rays.

mod common;

use common::{Random, commit, device, mesh_scene, ray};
use rgp_embree::{BuildQuality, CommittedScene, INVALID_ID, Ray, Ray16, RayHit16, SceneBuilder};

/// A soup of triangles, and instances of another.
fn soup() -> CommittedScene {
    let device = device();
    let mut random = Random(21);
    let (positions, triangles) = random.soup(300, 0.1);
    let small = mesh_scene(&device, 0, &positions, &triangles);
    let mut builder = SceneBuilder::new(&device, BuildQuality::High).expect("a builder");
    for id in 0..10 {
        let [x, y, z] = random.vector();
        let columns = [0.8, 0.2, 0.0, -0.2, 0.8, 0.0, 0.0, 0.0, 0.6, x, y, z];
        builder.add_instance(id, &small, &columns, 0b01).expect("a valid instance");
    }
    let (positions, triangles) = random.soup(500, 0.2);
    builder.add_triangles(10, &positions, &triangles, 0b10).expect("a valid mesh");
    commit(builder)
}

fn random_rays(random: &mut Random) -> [Ray; 16] {
    std::array::from_fn(|lane| Ray {
        t_far: if lane % 4 == 0 { 0.3 } else { f32::INFINITY },
        mask: [0b11, 0b01, 0b10][lane % 3],
        ..ray(random.vector(), random.vector())
    })
}

fn packet(rays: &[Ray; 16]) -> Ray16 {
    let mut packet = Ray16::default();
    for (lane, ray) in rays.iter().enumerate() {
        [packet.org_x[lane], packet.org_y[lane], packet.org_z[lane]] = ray.origin;
        [packet.dir_x[lane], packet.dir_y[lane], packet.dir_z[lane]] = ray.direction;
        (packet.t_near[lane], packet.t_far[lane], packet.mask[lane]) = (ray.t_near, ray.t_far, ray.mask);
    }
    packet
}

/// The bits of one lane: of the ray, then of the hit.
fn lane_bits(packet: &RayHit16, lane: usize) -> Vec<u32> {
    let (ray, hit) = (&packet.ray, &packet.hit);
    let floats = [
        ray.org_x, ray.org_y, ray.org_z, ray.t_near, ray.dir_x, ray.dir_y, ray.dir_z, ray.time, ray.t_far,
        hit.ng_x, hit.ng_y, hit.ng_z, hit.u, hit.v,
    ];
    let integers = [ray.mask, ray.id, ray.flags, hit.prim_id, hit.geom_id, hit.inst_id, hit.inst_prim_id];
    floats.iter().map(|value| value[lane].to_bits()).chain(integers.iter().map(|value| value[lane])).collect()
}

#[test]
fn packets_answer_like_single_rays() {
    let scene = soup();
    let mut random = Random(31);
    let (mut on_mesh, mut on_instance, mut missed) = (0, 0, 0);
    for round in 0..500 {
        let rays = random_rays(&mut random);
        let mut asked = RayHit16 { ray: packet(&rays), ..RayHit16::default() };
        let mut shadow = asked.ray;
        scene.intersect16(&[-1; 16], &mut asked, round % 2 == 0);
        scene.occluded16(&[-1; 16], &mut shadow, round % 2 == 0);
        for (lane, ray) in rays.iter().enumerate() {
            let single = scene.intersect(ray);
            assert_eq!(shadow.t_far[lane] == f32::NEG_INFINITY, single.is_some());
            assert_eq!(scene.occluded(ray), single.is_some());
            let Some(single) = single else {
                assert_eq!((asked.hit.geom_id[lane], asked.hit.object(lane)), (INVALID_ID, INVALID_ID));
                assert_eq!((asked.ray.t_far[lane], shadow.t_far[lane]), (ray.t_far, ray.t_far));
                missed += 1;
                continue;
            };
            assert_eq!((asked.hit.object(lane), asked.hit.prim_id[lane]), (single.object, single.primitive));
            let t = asked.ray.t_far[lane];
            assert!((t - single.t).abs() <= 1e-6 * single.t, "{t} and {}", single.t);
            assert!(
                (asked.hit.u[lane] - single.u).abs() < 1e-4 && (asked.hit.v[lane] - single.v).abs() < 1e-4
            );
            let normal = [asked.hit.ng_x[lane], asked.hit.ng_y[lane], asked.hit.ng_z[lane]];
            assert_eq!(normal, single.normal);
            *if single.object == 10 { &mut on_mesh } else { &mut on_instance } += 1;
        }
    }
    assert!(on_mesh > 500 && on_instance > 500 && missed > 500, "{on_mesh}, {on_instance}, {missed}");
}

#[test]
fn inactive_lanes_are_left_alone() {
    let scene = soup();
    let mut random = Random(41);
    for round in 0..200_u32 {
        let valid: [i32; 16] =
            std::array::from_fn(|lane| if (round >> (lane % 8)) & 1 == 1 { -1 } else { 0 });
        let mut before = RayHit16 { ray: packet(&random_rays(&mut random)), ..RayHit16::default() };
        before.hit.geom_id = [77; 16];
        before.hit.inst_id = [78; 16];
        let (mut after, mut shadow) = (before, before);
        scene.intersect16(&valid, &mut after, false);
        scene.occluded16(&valid, &mut shadow.ray, false);
        for lane in (0..16).filter(|&lane| valid[lane] == 0) {
            assert_eq!(lane_bits(&after, lane), lane_bits(&before, lane));
            assert_eq!(lane_bits(&shadow, lane), lane_bits(&before, lane));
        }
    }
}

#[test]
fn a_packet_can_be_used_again_and_any_nonzero_lane_is_active() {
    let scene = soup();
    let mut random = Random(51);
    let mut reused = RayHit16::default();
    for _ in 0..100 {
        let ray = packet(&random_rays(&mut random));
        let mut fresh = RayHit16 { ray, ..RayHit16::default() };
        reused.ray = ray;
        scene.intersect16(&[-1; 16], &mut fresh, false);
        scene.intersect16(&[1; 16], &mut reused, false);
        assert_eq!((fresh.hit.geom_id, fresh.hit.inst_id), (reused.hit.geom_id, reused.hit.inst_id));
        assert_eq!(fresh.ray.t_far, reused.ray.t_far);
    }
}
