//! The scene as plain data: arrays of meshes, objects, materials and lamps that refer to each other by index.
//!
//! Everything is in *scene space*: the world recentred on its bounding box and scaled by a power of two to the unit
//! cube, computed in f64 before anything becomes f32. Radiance and irradiance keep their value; a lamp's power is scaled
//! by the square of the length scale, so that power over squared distance still is irradiance in W·m⁻².

mod builder;
mod equipment;
mod lamp;
mod layer;
mod lens;
mod links;
mod mesh;
mod motion;
mod object_info;
mod projection;
pub mod record;

use std::sync::Arc;

use glam::{DAffine3, DVec3, Vec3};

pub use builder::SceneBuilder;
pub use lamp::LampProgram;
pub use layer::CornerLayer;
pub use lens::Lens;
pub use links::{LightLinks, ObjectLinks};
pub use mesh::MeshArrays;
pub use motion::{MIDDLE, Shutter};
pub use projection::{Projection, Sight};
pub use record::{LampShape, ObjectInfo, visibility};

use crate::color::Rgb;
use crate::shader::{Program, Register, Texture};
use record::{NormalRecord, OutputRecord, TangentRecord, WeightedClosure};

/// Largest length that is worked with: its square is a number in f32 too.
const LARGEST: f64 = 1e18;

/// Where scene space lies in the world: `p_scene = (p_world - center) * scale`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SceneSpace {
    /// World position of the scene's origin (m).
    pub center: DVec3,
    /// Scene units per metre, a power of two.
    pub scale: f64,
}

impl SceneSpace {
    /// World to scene as a transform.
    #[must_use]
    pub fn scene_from_world(&self) -> DAffine3 {
        DAffine3::from_scale(DVec3::splat(self.scale)) * DAffine3::from_translation(-self.center)
    }
}

/// Triangles of one evaluated mesh, in the space of whoever owns them (scene space, or an instance's own).
#[derive(Debug, Default)]
pub struct Mesh {
    /// Vertex positions.
    pub positions: Vec<Vec3>,
    /// Vertex positions at even times while the shutter is open; empty where they stay the same.
    pub steps: Vec<Vec<Vec3>>,
    /// Vertex indices, counter-clockwise seen from outside.
    pub triangles: Vec<[u32; 3]>,
    /// Shading normal at each corner of each triangle; empty means flat.
    pub corner_normals: Vec<[Vec3; 3]>,
    /// Values at the corners that materials ask for.
    pub layers: Vec<CornerLayer>,
    /// Material slot of each triangle; empty means slot 0 everywhere.
    pub slots: Vec<u16>,
}

impl Mesh {
    /// Corner positions of triangle `index`.
    #[must_use]
    pub fn corners(&self, index: usize) -> [Vec3; 3] {
        self.triangles[index].map(|v| self.positions[v as usize])
    }

    fn corners_at(&self, index: usize, time: f32) -> [DVec3; 3] {
        if self.steps.is_empty() {
            return self.corners(index).map(Vec3::as_dvec3);
        }
        let (step, part) = motion::interval(time, self.steps.len());
        let position = |step: usize, v: u32| self.steps[step][v as usize].as_dvec3();
        self.triangles[index].map(|v| position(step, v).lerp(position(step + 1, v), part))
    }

    /// Material slot of triangle `index`.
    #[must_use]
    pub fn slot(&self, index: usize) -> usize {
        self.slots.get(index).map_or(0, |&s| s as usize)
    }
}

/// A mesh placed in the scene. The index of an object is its geometry id in the ray tracer.
#[derive(Debug, Clone)]
pub struct Object {
    /// Blender's name, for messages.
    pub name: String,
    /// Its triangles.
    pub mesh: Arc<Mesh>,
    /// Transform into scene space; `None` where the mesh already is in scene space (used once).
    pub scene_from_mesh: Option<DAffine3>,
    /// The same at even times while the shutter is open; empty where it stays the same.
    pub motion: Vec<DAffine3>,
    /// Scene space to the object's own.
    pub object_from_scene: DAffine3,
    /// What materials may ask about the object.
    pub info: ObjectInfo,
    /// Index into [`Scene::materials`] for each slot; never empty.
    pub materials: Vec<u32>,
    /// Ray kinds that see it, see [`visibility`].
    pub visibility: u32,
    /// Bit of its set of receivers.
    pub receiver: u32,
    /// What it lights where it emits.
    pub links: LightLinks,
}

impl Object {
    /// True where camera rays see a hole in the picture.
    #[must_use]
    pub const fn is_holdout(&self) -> bool {
        self.visibility & visibility::HOLDOUT != 0
    }

    /// True where the camera sees what is missing of its light (Blender's shadow catcher). A hole stays a hole.
    #[must_use]
    pub const fn is_catcher(&self) -> bool {
        let flags = self.visibility & (visibility::CATCHER | visibility::HOLDOUT);
        flags == visibility::CATCHER
    }

    /// Material of triangle `primitive`; slots past the last use the last, as Blender does.
    #[must_use]
    pub fn material(&self, primitive: usize) -> usize {
        let slot = self.mesh.slot(primitive).min(self.materials.len() - 1);
        self.materials[slot] as usize
    }

    /// True where anything of it changes while the shutter is open.
    #[must_use]
    pub fn moves(&self) -> bool {
        !(self.motion.is_empty() && self.mesh.steps.is_empty())
    }

    /// As [`Object::corners`], at a time while the shutter is open.
    #[must_use]
    pub fn corners_at(&self, primitive: usize, time: f32) -> [DVec3; 3] {
        let corners = self.mesh.corners_at(primitive, time);
        match &self.scene_from_mesh {
            Some(_) if !self.motion.is_empty() => {
                let transform = motion::at(&self.motion, time);
                corners.map(|p| transform.transform_point3(p))
            }
            Some(transform) => corners.map(|p| transform.transform_point3(p)),
            None => corners,
        }
    }

    /// Corner positions of triangle `primitive` in scene space.
    #[must_use]
    pub fn corners(&self, primitive: usize) -> [DVec3; 3] {
        let corners = self.mesh.corners(primitive).map(Vec3::as_dvec3);
        match &self.scene_from_mesh {
            Some(transform) => corners.map(|p| transform.transform_point3(p)),
            None => corners,
        }
    }
}

/// A surface shader.
#[derive(Debug, Clone)]
pub struct Material {
    /// Blender's name, for messages.
    pub name: String,
    /// Weighted sum of closures. Inputs that vary over the surface hold a typical value here.
    pub closures: Vec<WeightedClosure>,
    /// What computes the inputs that vary.
    pub program: Option<MaterialProgram>,
    /// Absorption coefficient of the solid that the surface bounds (1/m).
    pub absorption: Rgb,
}

/// The part of a surface shader that differs from point to point.
#[derive(Debug, Clone)]
pub struct MaterialProgram {
    /// What is computed.
    pub program: Program,
    /// Which results are inputs of which closures.
    pub outputs: Vec<OutputRecord>,
    /// The result that is the shading normal of what has none of its own.
    pub normal: Option<Register>,
    /// Closures with a shading normal of their own.
    pub normals: Vec<NormalRecord>,
    /// Tangents of closures that are anisotropic.
    pub tangents: Vec<TangentRecord>,
}

/// A lamp in scene space.
#[derive(Debug, Clone)]
pub struct Lamp {
    /// Blender's name, for messages.
    pub name: String,
    /// Shape; lengths in scene units, the object's scale applied.
    pub shape: LampShape,
    /// Power per channel times the squared length scale (see the module); for a sun irradiance (W·m⁻²).
    pub power: Rgb,
    /// What computes a factor of the power, where that is no constant.
    pub program: Option<LampProgram>,
    /// Position.
    pub position: Vec3,
    /// Unit vectors: the lamp's local x and y, and `axis`, the direction it shines in (local −Z).
    pub x_axis: Vec3,
    /// See `x_axis`.
    pub y_axis: Vec3,
    /// See `x_axis`.
    pub axis: Vec3,
    /// Lengths of the object's x and y axes over that of its z axis: a spot's cone is stretched by them.
    pub stretch: [f32; 2],
    /// Ray kinds that see the lamp's shape.
    pub visibility: u32,
    /// False: its light passes through everything.
    pub casts_shadow: bool,
    /// What it lights.
    pub links: LightLinks,
}

/// The camera in scene space.
#[derive(Debug, Clone)]
pub struct Camera {
    /// Name, for messages.
    pub name: String,
    /// Projection.
    pub projection: Projection,
    /// Camera to scene, without scale.
    pub scene_from_camera: DAffine3,
    /// Left, right, bottom, top of the full frame, in the unit of its projection; lengths in scene units.
    pub window: [f64; 4],
    /// Pixels of the full frame.
    pub resolution: [u32; 2],
    /// Rendered part: x, y (from the bottom left), width, height.
    pub region: [u32; 4],
    /// Near and far clip distance along the view axis, or along each ray of a panorama, in scene units.
    pub clip: [f32; 2],
    /// Its lens; `None` for a pinhole.
    pub lens: Option<Lens>,
    /// `scene_from_camera` at even times while the shutter is open; empty where it stays the same.
    pub motion: Vec<DAffine3>,
    /// `window` at even times; empty where it stays the same.
    pub windows: Vec<[f64; 4]>,
    /// How long and how far it opens.
    pub shutter: Shutter,
}

impl Camera {
    /// True where anything of it changes while the shutter is open.
    #[must_use]
    pub const fn moves(&self) -> bool {
        !(self.motion.is_empty() && self.windows.is_empty())
    }

    /// Camera to scene, and the window, at a time while the shutter is open.
    #[must_use]
    pub fn at(&self, time: f32) -> (DAffine3, [f64; 4]) {
        let place =
            if self.motion.is_empty() { self.scene_from_camera } else { motion::at(&self.motion, time) };
        let window = if self.windows.is_empty() {
            self.window
        } else {
            let (step, part) = motion::interval(time, self.windows.len());
            let [a, b] = [step, step + 1].map(|step| self.windows[step]);
            std::array::from_fn(|side| a[side] + (b[side] - a[side]) * part)
        };
        (place, window)
    }
}

/// Light from outside the scene.
#[derive(Debug, Clone, Default)]
pub struct World {
    /// Blender's name, for messages.
    pub name: String,
    /// Radiance (W·m⁻²·sr⁻¹); a typical value where a program computes it.
    pub radiance: Rgb,
    /// What computes the radiance where it differs from direction to direction.
    pub program: Option<WorldProgram>,
    /// Ray kinds that see it.
    pub visibility: u32,
    /// True: camera rays that leave the scene give alpha 0.
    pub film_transparent: bool,
}

impl World {
    /// True where no light comes from.
    #[must_use]
    pub fn is_black(&self) -> bool {
        self.radiance.is_black() && self.program.is_none()
    }

    /// Takes all light out of it.
    pub fn blacken(&mut self) {
        (self.radiance, self.program) = (Rgb::BLACK, None);
    }
}

/// The radiance of a world that differs from direction to direction.
#[derive(Debug, Clone)]
pub struct WorldProgram {
    /// What is computed.
    pub program: Program,
    /// The result that is the radiance.
    pub radiance: Register,
}

/// Something wrong with the input that does not stop the render.
#[derive(Debug, Clone, PartialEq, Eq, serde::Serialize)]
pub struct Problem {
    /// Name of the object, material or lamp.
    pub subject: String,
    /// What is wrong and what was done about it.
    pub message: String,
    /// How often.
    pub count: u64,
}

/// A checked scene, ready to be traced.
#[derive(Debug)]
pub struct Scene {
    /// Where scene space lies.
    pub space: SceneSpace,
    /// Objects, by geometry id.
    pub objects: Vec<Object>,
    /// Materials.
    pub materials: Vec<Material>,
    /// Images that programs look up.
    pub textures: Arc<[Texture]>,
    /// Lamps of non-zero power.
    pub lamps: Vec<Lamp>,
    /// Camera.
    pub camera: Camera,
    /// Background.
    pub world: World,
    /// Bounds of all objects, in scene space.
    pub bounds: [Vec3; 2],
    /// What was found wrong.
    pub problems: Vec<Problem>,
}

impl Scene {
    /// A shadow catcher that the camera sees.
    #[must_use]
    pub fn catcher(&self) -> Option<&Object> {
        let is_seen = |object: &&Object| object.is_catcher() && object.visibility & visibility::CAMERA != 0;
        self.objects.iter().find(is_seen)
    }

    /// The shadow catchers alone, as ordinary objects, with the lamps and the world that light them.
    #[must_use]
    pub fn without_objects(&self) -> Self {
        let catchers = self.objects.iter().filter(|object| object.is_catcher());
        let ordinary = |object: &Object| {
            let visibility = object.visibility & !visibility::CATCHER;
            Object { visibility, ..object.clone() }
        };
        let lamps = self.lamps.iter().filter(|lamp| lamp.visibility & visibility::CATCHER != 0);
        Self {
            space: self.space,
            objects: catchers.map(ordinary).collect(),
            materials: self.materials.clone(),
            textures: Arc::clone(&self.textures),
            lamps: lamps.cloned().collect(),
            camera: self.camera.clone(),
            world: self.world.clone(),
            bounds: self.bounds,
            problems: Vec::new(),
        }
    }

    /// Memory (bytes) of what changes while the shutter is open.
    #[must_use]
    pub fn motion_bytes(&self) -> usize {
        let moving = self.objects.iter().filter(|object| object.moves());
        let bytes = moving.map(|object| {
            let positions: usize = object.mesh.steps.iter().map(|step| size_of_val(step.as_slice())).sum();
            positions / Arc::strong_count(&object.mesh) + size_of_val(object.motion.as_slice())
        });
        bytes.sum::<usize>() + size_of_val(self.camera.motion.as_slice())
    }
}
