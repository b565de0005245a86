//! The scene in the ray tracer: which triangle a ray meets first, and what is known about the surface there.

mod packet;

use std::path::Path;

use glam::{DAffine3, DMat3, Vec3};
use rgp_embree::{BuildQuality, CommittedScene, Device, Library, Ray as EmbreeRay, SceneBuilder};

pub use packet::{LANES, Packet};

use crate::error::RenderError;
use crate::light::LampProxy;
use crate::progress::Progress;
use crate::scene::{Mesh, Object, Scene, visibility};

/// Rays leave a surface this far along its geometric normal (scene units): some ulp of a coordinate of the unit cube,
/// above the rounding of a hit and below anything modelled.
pub const OFFSET: f32 = 6e-7;

/// A ray in scene space; `direction` is a unit vector.
#[derive(Clone, Copy, Debug)]
pub struct Ray {
    /// Where it starts.
    pub origin: Vec3,
    /// Where it goes.
    pub direction: Vec3,
    /// Kinds of ray that see (bits of [`visibility`]).
    pub mask: u32,
    /// When, while the shutter is open: 0 to 1.
    pub time: f32,
}

impl Ray {
    /// A ray leaving a surface at `p`, on the side of the unit geometric normal `ng` it points to.
    #[must_use]
    pub fn leaving(p: Vec3, ng: Vec3, direction: Vec3, mask: u32, time: f32) -> Self {
        let side = if direction.dot(ng) < 0.0 { -OFFSET } else { OFFSET };
        Self { origin: p + ng * side, direction, mask, time }
    }
}

/// What a ray met.
#[derive(Clone, Copy, Debug)]
pub struct Hit {
    /// Distance (scene units).
    pub t: f32,
    /// Barycentric weights of the second and third corner.
    pub barycentric: [f32; 2],
    /// Index into [`Scene::objects`], or past them a lamp's proxy.
    pub object: u32,
    /// Triangle of the object's mesh.
    pub primitive: u32,
}

/// Precomputed for the triangles of every mesh. Instances have materials of their own.
#[derive(Clone, Copy, Debug)]
struct TriangleRecord {
    ng: Vec3,
    material: u32,
}

#[derive(Clone, Copy, Debug)]
enum ObjectRecord {
    /// Index of the first triangle's record.
    Flat(usize),
    /// Normal matrix of an instance, and the record of its mesh's first triangle, whose normal is the mesh's own.
    Instance(DMat3, usize),
}

/// The ray tracer over one scene.
pub struct Accel<'a> {
    scene: &'a Scene,
    embree: CommittedScene,
    records: Vec<TriangleRecord>,
    objects: Vec<ObjectRecord>,
    sees_lamps: bool,
    camera_sees_lamps: bool,
    bounds: [Vec3; 2],
}

impl<'a> Accel<'a> {
    /// Builds the tree. `proxies` are lamps that rays can meet. Where nothing `moves`, everything is where it is in the
    /// middle of the shutter's time, whatever the time of a ray.
    ///
    /// # Errors
    /// Embree missing or out of memory; [`RenderError::Cancelled`].
    pub fn build(
        scene: &'a Scene,
        proxies: &[LampProxy],
        moves: bool,
        library: &Path,
        threads: usize,
        progress: &Progress,
    ) -> Result<Self, RenderError> {
        let library = Library::open(library)?;
        let device = Device::new(&library, threads)?;
        let keep_going = |fraction: f64| {
            progress.set_fraction(fraction);
            !progress.is_cancelled()
        };
        let mut top = SceneBuilder::new(&device, BuildQuality::High)?;
        let mut shared: Vec<(*const Mesh, CommittedScene, usize)> = Vec::new();
        let (mut records, mut objects) = (Vec::new(), Vec::with_capacity(scene.objects.len()));
        for (id, object) in scene.objects.iter().enumerate() {
            progress.check()?;
            let id = geometry_id(id)?;
            if let Some(transform) = &object.scene_from_mesh {
                let key = std::sync::Arc::as_ptr(&object.mesh);
                let known = shared.iter().rev().find(|(mesh, ..)| *mesh == key);
                let known = known.map(|(_, built, first)| (built.clone(), *first));
                let (built, first) = match known {
                    Some(known) => known,
                    None => {
                        let mut builder = SceneBuilder::new(&device, BuildQuality::High)?;
                        add_mesh(&mut builder, 0, &object.mesh, moves, u32::MAX)?;
                        let built = builder.commit(&keep_going)?;
                        shared.push((key, built.clone(), records.len()));
                        records.extend(records_of(object));
                        (built, records.len() - object.mesh.triangles.len())
                    }
                };
                let steps = if moves && !object.motion.is_empty() {
                    object.motion.iter().map(columns).collect()
                } else {
                    vec![columns(transform)]
                };
                top.add_moving_instance(id, &built, &steps, object.visibility)?;
                objects.push(ObjectRecord::Instance(transform.matrix3.inverse().transpose(), first));
            } else {
                add_mesh(&mut top, id, &object.mesh, moves, object.visibility)?;
                objects.push(ObjectRecord::Flat(records.len()));
                records.extend(records_of(object));
            }
        }
        for (i, proxy) in proxies.iter().enumerate() {
            let positions: Vec<[f32; 3]> = proxy.positions.iter().map(|p| p.to_array()).collect();
            top.add_triangles(
                geometry_id(scene.objects.len() + i)?,
                &positions,
                &proxy.triangles,
                visibility::LAMP,
            )?;
        }
        let embree = top.commit(&keep_going)?;
        let camera_sees_lamps = proxies.iter().any(|proxy| proxy.visibility & visibility::CAMERA != 0);
        let (sees_lamps, bounds) = (!proxies.is_empty(), embree.bounds().map(Vec3::from));
        Ok(Self { scene, embree, records, objects, sees_lamps, camera_sees_lamps, bounds })
    }

    /// The scene that is traced.
    #[must_use]
    pub const fn scene(&self) -> &'a Scene {
        self.scene
    }

    /// Bounds of all surfaces and of the lamps that rays can meet; empty where there are none.
    #[must_use]
    pub const fn bounds(&self) -> [Vec3; 2] {
        self.bounds
    }

    /// The lamp bit for rays that may meet lamps, 0 where there are none to meet.
    #[must_use]
    pub const fn lamp_bit(&self) -> u32 {
        if self.sees_lamps { visibility::LAMP } else { 0 }
    }

    /// The lamp bit for camera rays, which see lamps only where Blender's object says so.
    #[must_use]
    pub const fn camera_lamp_bit(&self) -> u32 {
        if self.camera_sees_lamps { visibility::LAMP } else { 0 }
    }

    /// True when the hit is a lamp's proxy.
    #[must_use]
    pub const fn is_lamp(&self, object: u32) -> bool {
        object as usize >= self.objects.len()
    }

    /// The first surface along a ray.
    #[must_use]
    pub fn intersect(&self, ray: &Ray) -> Option<Hit> {
        let hit = self.embree.intersect(&embree_ray(ray, f32::INFINITY))?;
        Some(Hit { t: hit.t, barycentric: [hit.u, hit.v], object: hit.object, primitive: hit.primitive })
    }

    /// True when something lies before distance `t_far`.
    #[must_use]
    pub fn occluded(&self, ray: &Ray, t_far: f32) -> bool {
        self.embree.occluded(&embree_ray(ray, t_far))
    }

    /// Unit geometric normal of a triangle, outward as modelled, in the middle of the shutter's time.
    #[must_use]
    #[inline]
    pub fn geometric_normal(&self, object: u32, primitive: u32) -> Vec3 {
        match &self.objects[object as usize] {
            ObjectRecord::Flat(first) => self.records[first + primitive as usize].ng,
            ObjectRecord::Instance(normal_matrix, first) => {
                let local = self.records[first + primitive as usize].ng;
                (*normal_matrix * local.as_dvec3()).normalize_or_zero().as_vec3()
            }
        }
    }

    /// Unit geometric normal, as in [`Accel::geometric_normal`], and material of a triangle, in one look.
    #[must_use]
    #[inline]
    pub fn triangle(&self, object: u32, primitive: u32) -> (Vec3, usize) {
        if let ObjectRecord::Flat(first) = &self.objects[object as usize] {
            let record = &self.records[first + primitive as usize];
            return (record.ng, record.material as usize);
        }
        (self.geometric_normal(object, primitive), self.material(object, primitive))
    }

    /// Index into [`Scene::materials`].
    #[must_use]
    #[inline]
    pub fn material(&self, object: u32, primitive: u32) -> usize {
        match &self.objects[object as usize] {
            ObjectRecord::Flat(first) => self.records[first + primitive as usize].material as usize,
            ObjectRecord::Instance(..) => self.scene.objects[object as usize].material(primitive as usize),
        }
    }

    /// Unit shading normal in the middle of the shutter's time, interpolated where the mesh is smooth.
    #[must_use]
    pub fn shading_normal(&self, hit: &Hit) -> Vec3 {
        let mesh = &self.scene.objects[hit.object as usize].mesh;
        let ng = self.geometric_normal(hit.object, hit.primitive);
        let Some([a, b, c]) = mesh.corner_normals.get(hit.primitive as usize) else { return ng };
        let [u, v] = hit.barycentric;
        let n = *a * (1.0 - u - v) + *b * u + *c * v;
        let n = match &self.objects[hit.object as usize] {
            ObjectRecord::Flat(_) => n,
            ObjectRecord::Instance(normal_matrix, _) => (*normal_matrix * n.as_dvec3()).as_vec3(),
        };
        n.try_normalize().unwrap_or(ng)
    }

    /// Traces sixteen rays for the nearest hit.
    pub fn intersect_packet(&self, packet: &mut Packet) {
        packet.clear_hits();
        self.embree.intersect16(&packet.valid, &mut packet.rays, true);
    }

    /// Traces sixteen shadow rays; see [`Packet::is_free`].
    pub fn occluded_packet(&self, packet: &mut Packet) {
        self.embree.occluded16(&packet.valid, &mut packet.rays.ray, true);
    }
}

fn geometry_id(index: usize) -> Result<u32, RenderError> {
    u32::try_from(index)
        .map_err(|_| RenderError::Scene("there are more objects than the ray tracer can number".into()))
}

fn add_mesh(
    builder: &mut SceneBuilder,
    id: u32,
    mesh: &Mesh,
    moves: bool,
    mask: u32,
) -> Result<(), RenderError> {
    let still = std::slice::from_ref(&mesh.positions);
    let steps = if moves && !mesh.steps.is_empty() { mesh.steps.as_slice() } else { still };
    let steps: Vec<Vec<[f32; 3]>> =
        steps.iter().map(|step| step.iter().map(|p| p.to_array()).collect()).collect();
    let steps: Vec<&[[f32; 3]]> = steps.iter().map(Vec::as_slice).collect();
    Ok(builder.add_moving_triangles(id, &steps, &mesh.triangles, mask)?)
}

/// Of the triangles of an object's mesh.
fn records_of(object: &Object) -> impl Iterator<Item = TriangleRecord> {
    (0..object.mesh.triangles.len()).map(|primitive| TriangleRecord {
        ng: normal_of(&object.mesh, primitive),
        material: u32::try_from(object.material(primitive)).unwrap_or(0),
    })
}

fn normal_of(mesh: &Mesh, primitive: usize) -> Vec3 {
    let [a, b, c] = mesh.corners(primitive).map(Vec3::as_dvec3);
    (b - a).cross(c - a).normalize_or_zero().as_vec3()
}

#[expect(clippy::cast_possible_truncation, reason = "Embree traces in f32")]
fn columns(transform: &DAffine3) -> [f32; 12] {
    transform.to_cols_array().map(|v| v as f32)
}

fn embree_ray(ray: &Ray, t_far: f32) -> EmbreeRay {
    let (origin, direction) = (ray.origin.to_array(), ray.direction.to_array());
    EmbreeRay { origin, direction, t_near: 0.0, t_far, mask: ray.mask, time: ray.time }
}
