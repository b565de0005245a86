//! Collects records from the host, checks them once, and moves them into scene space.

use std::collections::BTreeMap;
use std::sync::Arc;

use glam::{DAffine3, DMat4, DVec3, Vec3};

use super::mesh::{self, MeshArrays};
use super::record::{
    CameraRecord, LampRecord, LampShape, MaterialRecord, ObjectInfo, WorldRecord, matrix, visibility,
};
use super::{
    Camera, Lamp, Lens, Material, MaterialProgram, Mesh, Object, Problem, Projection, Scene, SceneSpace,
    World,
};
use crate::color::Rgb;
use crate::error::RenderError;
use crate::shader::{Program, Texture};

#[derive(Debug)]
struct ObjectRecord {
    name: String,
    mesh: usize,
    world_from_object: DAffine3,
    materials: Vec<u32>,
    visibility: u32,
    info: ObjectInfo,
}

/// Takes the parts of a scene in any order.
#[derive(Debug, Default)]
pub struct SceneBuilder {
    meshes: Vec<MeshArrays>,
    objects: Vec<ObjectRecord>,
    materials: Vec<MaterialRecord>,
    textures: Vec<Texture>,
    lamps: Vec<LampRecord>,
    camera: Option<CameraRecord>,
    world: WorldRecord,
    problems: Problems,
}

/// What was found wrong, each kind once per subject.
#[derive(Debug, Default)]
pub(super) struct Problems(BTreeMap<(String, String), u64>);

impl Problems {
    pub(super) fn add(&mut self, subject: &str, message: impl Into<String>, count: u64) {
        if count > 0 {
            *self.0.entry((subject.to_owned(), message.into())).or_default() += count;
        }
    }

    fn into_list(self) -> Vec<Problem> {
        let list = self.0.into_iter();
        list.map(|((subject, message), count)| Problem { subject, message, count }).collect()
    }
}

impl SceneBuilder {
    /// Adds a material and returns its index.
    pub fn add_material(&mut self, record: MaterialRecord) -> usize {
        self.materials.push(record);
        self.materials.len() - 1
    }

    /// Adds an image for programs to look up, and returns its index.
    pub fn add_texture(&mut self, texture: Texture) -> usize {
        self.textures.push(texture);
        self.textures.len() - 1
    }

    /// Adds a mesh and returns its index. Bad triangles are dropped and reported.
    ///
    /// # Errors
    /// Arrays whose lengths do not fit together.
    pub fn add_mesh(&mut self, mut arrays: MeshArrays) -> Result<usize, RenderError> {
        arrays.check_lengths()?;
        arrays.drop_bad_triangles(&mut self.problems);
        self.meshes.push(arrays);
        Ok(self.meshes.len() - 1)
    }

    /// Adds a placed mesh and returns its index. `materials` is one index per slot.
    ///
    /// # Errors
    /// An index that does not exist.
    pub fn add_object(
        &mut self,
        name: &str,
        mesh: usize,
        world_from_object: DMat4,
        materials: Vec<u32>,
        visible_to: u32,
    ) -> Result<usize, RenderError> {
        let known = |index: usize, len: usize, what: &str| {
            let message =
                || RenderError::Scene(format!("object '{name}' uses {what} {index}, which does not exist"));
            (index < len).then_some(()).ok_or_else(message)
        };
        known(mesh, self.meshes.len(), "mesh")?;
        for &material in &materials {
            known(material as usize, self.materials.len(), "material")?;
        }
        let transform = DAffine3::from_mat4(world_from_object);
        self.objects.push(ObjectRecord {
            name: name.to_owned(),
            mesh,
            world_from_object: transform,
            materials,
            visibility: visible_to & (visibility::ALL | visibility::HOLDOUT),
            info: ObjectInfo::default(),
        });
        Ok(self.objects.len() - 1)
    }

    /// Says what materials may ask about an object.
    ///
    /// # Errors
    /// An object that does not exist.
    pub fn set_object_info(&mut self, object: usize, info: ObjectInfo) -> Result<(), RenderError> {
        let known = self.objects.get_mut(object).map(|object| object.info = info);
        known.ok_or_else(|| RenderError::Scene(format!("there is no object {object}")))
    }

    /// Adds a lamp and returns its index.
    pub fn add_lamp(&mut self, record: LampRecord) -> usize {
        self.lamps.push(record);
        self.lamps.len() - 1
    }

    /// Sets the camera.
    pub fn set_camera(&mut self, record: CameraRecord) {
        self.camera = Some(record);
    }

    /// Sets the world.
    pub fn set_world(&mut self, record: WorldRecord) {
        self.world = record;
    }

    /// Checks everything and moves it into scene space.
    ///
    /// # Errors
    /// No camera, or a camera that cannot see; a material whose program cannot be run.
    pub fn finish(mut self) -> Result<Scene, RenderError> {
        let camera = self.camera.take().ok_or_else(|| {
            RenderError::Scene("the scene has no camera; add one and make it the active camera".into())
        })?;
        self.keep_usable_objects();
        let space = self.measure();
        let camera = place_camera(&camera, &space)?;
        let lamps = self.place_lamps(&space);
        let objects = self.place_objects(&space);
        let materials = self.take_materials()?;
        let bounds = bounds_of(&objects);
        let mut world = World {
            radiance: self.world.radiance.map(|c| c.max(0.0)),
            visibility: self.world.visibility,
            film_transparent: self.world.film_transparent,
        };
        if !self.world.radiance.is_finite() {
            self.problems.add("World", "its color is not a number; black is used", 1);
            world.radiance = Rgb::BLACK;
        }
        if objects.is_empty() {
            self.problems.add("Scene", "there is no surface to render; only the background is drawn", 1);
        }
        let problems = self.problems.into_list();
        let textures = self.textures;
        Ok(Scene { space, objects, materials, textures, lamps, camera, world, bounds, problems })
    }

    fn keep_usable_objects(&mut self) {
        let (meshes, problems) = (&self.meshes, &mut self.problems);
        self.objects.retain(|object| {
            let transform = &object.world_from_object;
            if !transform.is_finite() {
                problems.add(&object.name, "its transform is not a number; the object is left out", 1);
                return false;
            }
            if transform.matrix3.determinant() == 0.0 && !meshes[object.mesh].triangles.is_empty() {
                problems.add(&object.name, "its scale is zero along an axis; the object is left out", 1);
                return false;
            }
            object.visibility != 0 && !meshes[object.mesh].triangles.is_empty()
        });
    }

    /// Scene space from the bounds of everything, in f64.
    fn measure(&self) -> SceneSpace {
        let (mut low, mut high) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
        let mesh_bounds: Vec<_> = self.meshes.iter().map(MeshArrays::bounds).collect();
        for object in &self.objects {
            let [a, b] = mesh_bounds[object.mesh];
            for corner in 0..8 {
                let pick = |bit: i32, x: f64, y: f64| if corner & bit == 0 { x } else { y };
                let p = DVec3::new(pick(1, a.x, b.x), pick(2, a.y, b.y), pick(4, a.z, b.z));
                let p = object.world_from_object.transform_point3(p);
                (low, high) = (low.min(p), high.max(p));
            }
        }
        if !(low.is_finite() && high.is_finite()) {
            return SceneSpace { center: DVec3::ZERO, scale: 1.0 };
        }
        let extent = (high - low).max_element().max(f64::MIN_POSITIVE * 1e16);
        SceneSpace { center: (low + high) * 0.5, scale: (-extent.log2().ceil()).exp2() }
    }

    fn place_objects(&mut self, space: &SceneSpace) -> Vec<Object> {
        let mut uses = vec![0_usize; self.meshes.len()];
        for object in &self.objects {
            uses[object.mesh] += 1;
        }
        let scene_from_world = space.scene_from_world();
        let mut shared: Vec<Option<(Arc<Mesh>, DAffine3)>> = vec![None; self.meshes.len()];
        let default_material = u32::try_from(self.materials.len()).unwrap_or(u32::MAX);
        let mut placed = Vec::with_capacity(self.objects.len());
        let mut need_default = false;
        for mut object in std::mem::take(&mut self.objects) {
            if object.materials.is_empty() {
                need_default = true;
                object.materials.push(default_material);
            }
            let transform = scene_from_world * object.world_from_object;
            let (mesh, scene_from_mesh) = if uses[object.mesh] == 1 {
                let arrays = std::mem::take(&mut self.meshes[object.mesh]);
                (Arc::new(mesh::transformed(arrays, &transform, &mut self.problems)), None)
            } else {
                let (mesh, object_from_mesh) = shared[object.mesh].get_or_insert_with(|| {
                    let (mesh, object_from_mesh) =
                        mesh::normalized(std::mem::take(&mut self.meshes[object.mesh]));
                    (Arc::new(mesh), object_from_mesh)
                });
                (Arc::clone(mesh), Some(transform * *object_from_mesh))
            };
            placed.push(Object {
                name: object.name,
                mesh,
                scene_from_mesh,
                object_from_scene: transform.inverse(),
                info: object.info,
                materials: object.materials,
                visibility: object.visibility,
            });
        }
        if need_default {
            self.materials.push(MaterialRecord::default_gray());
        }
        placed.retain(|object| !object.mesh.triangles.is_empty());
        placed
    }

    fn place_lamps(&mut self, space: &SceneSpace) -> Vec<Lamp> {
        let mut lamps = Vec::new();
        for record in std::mem::take(&mut self.lamps) {
            if let Some(lamp) = place_lamp(record, space, &mut self.problems) {
                lamps.push(lamp);
            }
        }
        lamps
    }

    fn take_materials(&mut self) -> Result<Vec<Material>, RenderError> {
        let textures = self.textures.len();
        let records = std::mem::take(&mut self.materials).into_iter();
        records.map(|record| checked_material(record, textures)).collect()
    }
}

fn checked_material(record: MaterialRecord, textures: usize) -> Result<Material, RenderError> {
    let MaterialRecord { name, mut closures, program } = record;
    let Some(record) = program else { return Ok(Material { name, closures, program: None }) };
    let fault = |what: String| RenderError::Scene(format!("material '{name}': {what}"));
    let program = Program::new(record.instructions, textures).map_err(fault)?;
    for output in &record.outputs {
        let closure = closures.get_mut(output.closure);
        if closure.and_then(|closure| closure.input_mut(output.input)).is_none() {
            return Err(fault(format!("closure {} has no input {:?}", output.closure, output.input)));
        }
    }
    let registers = record.outputs.iter().map(|output| output.register).chain(record.normal);
    if let Some(register) = registers.into_iter().find(|&register| register as usize >= program.len()) {
        return Err(fault(format!("its program has no register {register}")));
    }
    let program = MaterialProgram { program, outputs: record.outputs, normal: record.normal };
    Ok(Material { name, closures, program: Some(program) })
}

fn place_camera(record: &CameraRecord, space: &SceneSpace) -> Result<Camera, RenderError> {
    let fault = |what: &str| RenderError::Scene(format!("camera '{}': {what}", record.name));
    let matrix = DAffine3::from_mat4(matrix(&record.world_from_camera));
    if !matrix.is_finite() {
        return Err(fault("its transform is not a number"));
    }
    let [x, y, z] =
        [matrix.matrix3.x_axis, matrix.matrix3.y_axis, matrix.matrix3.z_axis].map(DVec3::try_normalize);
    let (Some(x), Some(y), Some(z)) = (x, y, z) else { return Err(fault("its scale is zero")) };
    let [left, right, bottom, top] = record.window;
    if !record.window.iter().all(|v| v.is_finite()) || left == right || bottom == top {
        return Err(fault("its field of view is empty"));
    }
    let [frame_w, frame_h] = record.resolution;
    let [rx, ry, rw, rh] = record.region;
    if rw == 0 || rh == 0 || rx.saturating_add(rw) > frame_w || ry.saturating_add(rh) > frame_h {
        return Err(fault("the part of the frame to render is empty or outside the frame"));
    }
    let origin = space.scene_from_world().transform_point3(matrix.translation);
    let length = match record.projection {
        Projection::Perspective => 1.0,
        Projection::Orthographic => space.scale,
    };
    #[expect(clippy::cast_possible_truncation, reason = "clip distances need no more than f32")]
    let clip = record.clip.map(|d| (d * space.scale) as f32);
    let lens = match &record.lens {
        Some(lens) => Lens::new(lens, space.scale).map_err(fault)?,
        None => None,
    };
    Ok(Camera {
        name: record.name.clone(),
        projection: record.projection,
        scene_from_camera: DAffine3::from_cols(x, y, z, origin),
        window: record.window.map(|v| v * length),
        resolution: record.resolution,
        region: record.region,
        clip,
        lens,
    })
}

fn place_lamp(record: LampRecord, space: &SceneSpace, problems: &mut Problems) -> Option<Lamp> {
    let transform = DAffine3::from_mat4(matrix(&record.world_from_lamp));
    if !transform.is_finite() || !record.power.is_finite() {
        problems.add(&record.name, "its transform or power is not a number; the lamp is left out", 1);
        return None;
    }
    if record.power.0.iter().any(|&c| c < 0.0) {
        problems.add(&record.name, "its power is negative; zero is used", 1);
    }
    let power = record.power.map(|c| c.max(0.0));
    if power.is_black() {
        return None;
    }
    let axes = transform.matrix3;
    let scales = DVec3::new(axes.x_axis.length(), axes.y_axis.length(), axes.z_axis.length());
    let z = axes.z_axis.try_normalize();
    let Some(z) = z else {
        problems.add(&record.name, "its scale is zero; the lamp is left out", 1);
        return None;
    };
    let fallback = z.any_orthonormal_pair();
    let x = axes.x_axis.try_normalize().unwrap_or(fallback.0);
    let y = axes.y_axis.try_normalize().unwrap_or(fallback.1);
    let shape = match record.shape {
        LampShape::Point { radius, soft_falloff } => {
            LampShape::Point { radius: length(radius, space.scale), soft_falloff }
        }
        LampShape::Spot { radius, soft_falloff, cone_angle, blend } => {
            LampShape::Spot { radius: length(radius, space.scale), soft_falloff, cone_angle, blend }
        }
        LampShape::Sun { angle } => LampShape::Sun { angle },
        LampShape::Rectangle { size, spread } => {
            LampShape::Rectangle { size: lamp_size(size, scales, space.scale), spread }
        }
        LampShape::Ellipse { size, spread } => {
            LampShape::Ellipse { size: lamp_size(size, scales, space.scale), spread }
        }
    };
    if let LampShape::Rectangle { size, .. } | LampShape::Ellipse { size, .. } = shape
        && !(size[0] > 0.0 && size[1] > 0.0)
    {
        problems.add(&record.name, "its size is zero; the lamp is left out", 1);
        return None;
    }
    if matches!(shape, LampShape::Spot { .. }) && scales.x.min(scales.y) <= 0.0 {
        problems.add(&record.name, "its scale is zero across its cone; the lamp is left out", 1);
        return None;
    }
    let is_sun = matches!(shape, LampShape::Sun { .. });
    #[expect(clippy::cast_possible_truncation, reason = "the factor is a power of two")]
    let power = if is_sun { power } else { power * (space.scale * space.scale) as f32 };
    Some(Lamp {
        name: record.name,
        shape,
        power,
        position: space.scene_from_world().transform_point3(transform.translation).as_vec3(),
        x_axis: x.as_vec3(),
        y_axis: y.as_vec3(),
        axis: -z.as_vec3(),
        stretch: [scales.x, scales.y].map(|length| (length / scales.z) as f32),
        visibility: record.visibility & visibility::ALL,
        casts_shadow: record.casts_shadow,
    })
}

#[expect(clippy::cast_possible_truncation, reason = "lengths in scene space are near one")]
fn length(metres: f32, scale: f64) -> f32 {
    (f64::from(metres) * scale).max(0.0) as f32
}

#[expect(clippy::cast_possible_truncation, reason = "lengths in scene space are near one")]
fn lamp_size(size: [f32; 2], scales: DVec3, scale: f64) -> [f32; 2] {
    [(f64::from(size[0]) * scales.x * scale) as f32, (f64::from(size[1]) * scales.y * scale) as f32]
}

fn bounds_of(objects: &[Object]) -> [Vec3; 2] {
    let (mut low, mut high) = (Vec3::INFINITY, Vec3::NEG_INFINITY);
    for object in objects {
        for p in &object.mesh.positions {
            let p = object.scene_from_mesh.map_or(*p, |t| t.transform_point3(p.as_dvec3()).as_vec3());
            (low, high) = (low.min(p), high.max(p));
        }
    }
    if low.is_finite() && high.is_finite() { [low, high] } else { [Vec3::splat(-0.5), Vec3::splat(0.5)] }
}
