//! Rays, hits, and the queries of a committed scene.

use crate::CommittedScene;
use crate::sys::{ActiveLanes, QueryArguments, SingleHit, SingleRay, SingleRayHit};

/// The id in a hit where there is no such thing: no geometry was hit, or the hit is not inside an instance.
pub const INVALID_ID: u32 = u32::MAX;

static INCOHERENT: QueryArguments = QueryArguments::new(false);
static COHERENT: QueryArguments = QueryArguments::new(true);

// SAFETY: the statics are never written, and their pointers are null.
unsafe impl Sync for QueryArguments {}

/// A ray: the points `origin + t * direction` with `t_near <= t <= t_far`. The direction need not be a unit
/// vector.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ray {
    /// Where it starts.
    pub origin: [f32; 3],
    /// Where it goes; the unit of `t` is this vector's length.
    pub direction: [f32; 3],
    /// Start of the part that counts, at least 0.
    pub t_near: f32,
    /// End of the part that counts; may be infinite.
    pub t_far: f32,
    /// Geometry is seen if its own mask shares a bit with this.
    pub mask: u32,
    /// When, from 0 to 1; what does not move is the same at all times.
    pub time: f32,
}

/// Where a ray first meets a triangle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit {
    /// How far along the ray, in lengths of its direction.
    pub t: f32,
    /// Barycentric weight of the triangle's second corner.
    pub u: f32,
    /// Barycentric weight of the triangle's third corner; the first has `1 - u - v`.
    pub v: f32,
    /// Unnormalized geometric normal `(p1 - p0) × (p2 - p0)`; in an instance, in the instance's own space.
    ///
    /// Embree takes it from corners relative to the ray's origin, so it carries rounding that varies from ray
    /// to ray; whoever needs the same normal every time takes it from the positions.
    pub normal: [f32; 3],
    /// Index of the triangle in its mesh.
    pub primitive: u32,
    /// Id of the instance if the triangle is in one, else of the mesh.
    pub object: u32,
}

/// Sixteen rays, one per lane (`RTCRay16`). The default sees everything from the origin on, but points
/// nowhere.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(64))]
pub struct Ray16 {
    /// Origins, x.
    pub org_x: [f32; 16],
    /// Origins, y.
    pub org_y: [f32; 16],
    /// Origins, z.
    pub org_z: [f32; 16],
    /// Starts of the parts that count, at least 0.
    pub t_near: [f32; 16],
    /// Directions, x.
    pub dir_x: [f32; 16],
    /// Directions, y.
    pub dir_y: [f32; 16],
    /// Directions, z.
    pub dir_z: [f32; 16],
    /// Times, as in [`Ray::time`].
    pub time: [f32; 16],
    /// Ends of the parts that count. A hit shortens it to the hit's distance; an occluded lane gets -∞.
    pub t_far: [f32; 16],
    /// Masks, as in [`Ray::mask`].
    pub mask: [u32; 16],
    /// The caller's own; not read.
    pub id: [u32; 16],
    /// Reserved by Embree; leave 0.
    pub flags: [u32; 16],
}

impl Default for Ray16 {
    fn default() -> Self {
        Self {
            org_x: [0.0; 16],
            org_y: [0.0; 16],
            org_z: [0.0; 16],
            t_near: [0.0; 16],
            dir_x: [0.0; 16],
            dir_y: [0.0; 16],
            dir_z: [0.0; 16],
            time: [0.0; 16],
            t_far: [f32::INFINITY; 16],
            mask: [u32::MAX; 16],
            id: [0; 16],
            flags: [0; 16],
        }
    }
}

/// Sixteen hits (`RTCHit16`). In a lane without a hit `geom_id` is [`INVALID_ID`] and the rest says nothing.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(64))]
pub struct Hit16 {
    /// Unnormalized geometric normals, x; inside instances, in the instance's own space.
    pub ng_x: [f32; 16],
    /// Normals, y.
    pub ng_y: [f32; 16],
    /// Normals, z.
    pub ng_z: [f32; 16],
    /// Barycentric weights of the second corner.
    pub u: [f32; 16],
    /// Barycentric weights of the third corner.
    pub v: [f32; 16],
    /// Indices of the triangles in their meshes.
    pub prim_id: [u32; 16],
    /// Ids of the meshes, or [`INVALID_ID`] where nothing was hit.
    pub geom_id: [u32; 16],
    /// Ids of the instances, or [`INVALID_ID`] where the mesh is not in one.
    pub inst_id: [u32; 16],
    /// Written by libraries built with instance arrays; not used.
    pub inst_prim_id: [u32; 16],
}

impl Default for Hit16 {
    fn default() -> Self {
        Self {
            ng_x: [0.0; 16],
            ng_y: [0.0; 16],
            ng_z: [0.0; 16],
            u: [0.0; 16],
            v: [0.0; 16],
            prim_id: [INVALID_ID; 16],
            geom_id: [INVALID_ID; 16],
            inst_id: [INVALID_ID; 16],
            inst_prim_id: [INVALID_ID; 16],
        }
    }
}

impl Hit16 {
    /// What [`Hit::object`] is for a single ray: the instance if there is one, else the mesh; [`INVALID_ID`]
    /// on a miss.
    pub fn object(&self, lane: usize) -> u32 {
        object(self.geom_id[lane], self.inst_id[lane])
    }
}

/// Sixteen rays and their hits (`RTCRayHit16`).
#[derive(Clone, Copy, Debug, Default)]
#[repr(C)]
pub struct RayHit16 {
    /// What is asked.
    pub ray: Ray16,
    /// What is answered.
    pub hit: Hit16,
}

impl CommittedScene {
    /// The first hit along the ray.
    pub fn intersect(&self, ray: &Ray) -> Option<Hit> {
        let mut query = SingleRayHit { ray: single_ray(ray), hit: NO_HIT };
        // SAFETY: the scene is alive and committed; the structure has the layout, alignment and room Embree
        // expects.
        unsafe { (self.api().intersect1)(self.handle(), &raw mut query, &raw const INCOHERENT) };
        let SingleRayHit { ray, hit } = query;
        (hit.geom_id != INVALID_ID).then(|| Hit {
            t: ray.t_far,
            u: hit.u,
            v: hit.v,
            normal: hit.normal,
            primitive: hit.prim_id,
            object: object(hit.geom_id, hit.inst_id),
        })
    }

    /// Whether anything lies on the ray.
    pub fn occluded(&self, ray: &Ray) -> bool {
        let mut query = single_ray(ray);
        // SAFETY: the scene is alive and committed; the structure has the layout and alignment Embree
        // expects.
        unsafe { (self.api().occluded1)(self.handle(), &raw mut query, &raw const INCOHERENT) };
        query.t_far == f32::NEG_INFINITY
    }

    /// The first hits of sixteen rays. Lanes with a nonzero `valid` are traced, the others left as they are.
    ///
    /// The hits of traced lanes are cleared first. Say `coherent` if the rays start close together and run
    /// alike: it changes the speed, not the answer.
    pub fn intersect16(&self, valid: &[i32; 16], packet: &mut RayHit16, coherent: bool) {
        let active = active_lanes(valid);
        for lane in 0..16 {
            packet.hit.geom_id[lane] |= active.0[lane].cast_unsigned();
            packet.hit.inst_id[lane] |= active.0[lane].cast_unsigned();
        }
        // SAFETY: the scene is alive and committed; lanes and packet have the layout, alignment and room
        // Embree expects.
        unsafe { (self.api().intersect16)(&raw const active, self.handle(), packet, arguments(coherent)) };
    }

    /// Whether anything lies on each of sixteen rays: `t_far` becomes -∞ where something does.
    ///
    /// Lanes with a nonzero `valid` are traced, the others left as they are. For `coherent` see
    /// [`intersect16`](Self::intersect16).
    pub fn occluded16(&self, valid: &[i32; 16], packet: &mut Ray16, coherent: bool) {
        let active = active_lanes(valid);
        // SAFETY: the scene is alive and committed; lanes and packet have the layout and alignment Embree
        // expects.
        unsafe { (self.api().occluded16)(&raw const active, self.handle(), packet, arguments(coherent)) };
    }
}

const NO_HIT: SingleHit = SingleHit {
    normal: [0.0; 3],
    u: 0.0,
    v: 0.0,
    prim_id: INVALID_ID,
    geom_id: INVALID_ID,
    inst_id: INVALID_ID,
    inst_prim_id: INVALID_ID,
};

fn single_ray(ray: &Ray) -> SingleRay {
    SingleRay {
        origin: ray.origin,
        t_near: ray.t_near,
        direction: ray.direction,
        time: ray.time,
        t_far: ray.t_far,
        mask: ray.mask,
        id: 0,
        flags: 0,
    }
}

fn object(geom_id: u32, inst_id: u32) -> u32 {
    if inst_id == INVALID_ID { geom_id } else { inst_id }
}

fn arguments(coherent: bool) -> &'static QueryArguments {
    if coherent { &COHERENT } else { &INCOHERENT }
}

/// Embree reads the lanes with aligned loads, and takes only -1 for active.
fn active_lanes(valid: &[i32; 16]) -> ActiveLanes {
    ActiveLanes(valid.map(|lane| if lane == 0 { 0 } else { -1 }))
}
