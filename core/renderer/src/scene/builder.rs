//! Collects records from the host, checks them once, and moves them into scene space.

use std::collections::BTreeMap;
use std::sync::Arc;

use glam::{DAffine3, DMat4, DVec3, Vec3};

use super::equipment::{place_camera, place_lamp};
use super::mesh::{self, MeshArrays, is_step_count};
use super::record::{
    CameraRecord, LampProgramRecord, LampRecord, MaterialRecord, ObjectInfo, ObjectLinks, ProgramRecord,
    WorldProgramRecord, WorldRecord, matrix, visibility,
};
use super::{
    LARGEST, Lamp, LampProgram, Material, MaterialProgram, Mesh, Object, Problem, Scene, SceneSpace, World,
    WorldProgram, motion,
};
use crate::color::Rgb;
use crate::error::RenderError;
use crate::shader::{Instruction, Program, Register, Texture};

#[derive(Debug)]
struct ObjectRecord {
    name: String,
    mesh: usize,
    world_from_object: DAffine3,
    /// The same at even times while the shutter is open, the middle left out; empty where it stays the same.
    steps: Vec<DAffine3>,
    materials: Vec<u32>,
    visibility: u32,
    info: ObjectInfo,
    links: ObjectLinks,
}

impl ObjectRecord {
    /// Where it is at even times while the shutter is open; once where it stays.
    fn placements(&self) -> Vec<DAffine3> {
        let (before, after) = self.steps.split_at(self.steps.len() / 2);
        [before, &[self.world_from_object], after].concat()
    }
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
    pub fn add_mesh(&mut self, arrays: MeshArrays) -> Result<usize, RenderError> {
        arrays.check_lengths()?;
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
            steps: Vec::new(),
            materials,
            visibility: visible_to & (visibility::ALL | visibility::HOLDOUT | visibility::CATCHER),
            info: ObjectInfo::default(),
            links: ObjectLinks::default(),
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

    /// Says which lights light an object and are blocked by it, and what it lights itself.
    ///
    /// # Errors
    /// An object or a set that does not exist.
    pub fn set_object_links(&mut self, object: usize, links: ObjectLinks) -> Result<(), RenderError> {
        let is_known = links.receiver_set < u32::BITS && links.blocker_set < visibility::BLOCKER_SETS;
        let record = self.objects.get_mut(object).filter(|_| is_known);
        let known = record.map(|record| record.links = links);
        known.ok_or_else(|| RenderError::Scene(format!("there is no object {object}, or no such link set")))
    }

    /// Says where an object is at even times while the shutter is open, the middle left out.
    ///
    /// # Errors
    /// An object that does not exist, or steps that are not two or more, in pairs.
    pub fn set_object_motion(&mut self, object: usize, steps: &[DMat4]) -> Result<(), RenderError> {
        let Some(record) = self.objects.get_mut(object).filter(|_| is_step_count(steps.len())) else {
            return Err(RenderError::Scene(format!("there are no {} steps of object {object}", steps.len())));
        };
        record.steps = steps.iter().map(|&step| DAffine3::from_mat4(step)).collect();
        if !record.steps.iter().all(DAffine3::is_finite) {
            let what = "it moves to where is no number; its motion is not blurred";
            self.problems.add(&record.name, what, 1);
            record.steps.clear();
        }
        Ok(())
    }

    /// Says where the vertices of a mesh are at even times while the shutter is open, the middle left out; `None` is where
    /// they are in the mesh.
    ///
    /// # Errors
    /// A mesh that does not exist, or steps that do not fit to it.
    pub fn set_mesh_motion(
        &mut self,
        mesh: usize,
        steps: Vec<Option<Vec<[f32; 3]>>>,
    ) -> Result<(), RenderError> {
        let Some(arrays) = self.meshes.get_mut(mesh) else {
            return Err(RenderError::Scene(format!("there is no mesh {mesh}")));
        };
        let positions = |step: Option<_>| step.unwrap_or_else(|| arrays.positions.clone());
        arrays.steps = steps.into_iter().map(positions).collect();
        arrays.check_lengths().inspect_err(|_| arrays.steps.clear())
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
    /// No camera, or a camera that cannot see; a program that cannot be run.
    pub fn finish(mut self) -> Result<Scene, RenderError> {
        let camera = self.camera.take().ok_or_else(|| {
            RenderError::Scene("the scene has no camera; add one and make it the active camera".into())
        })?;
        self.meshes.iter_mut().for_each(|mesh| mesh.drop_bad_triangles(&mut self.problems));
        let bounds: Vec<_> = self.meshes.iter().map(MeshArrays::bounds).collect();
        self.keep_usable_objects(&bounds);
        let space = self.measure(&bounds);
        let camera = place_camera(&camera, &space)?;
        let lamps = self.place_lamps(&space)?;
        let objects = self.place_objects(&space);
        let materials = self.take_materials()?;
        let bounds = bounds_of(&objects);
        let world = self.take_world()?;
        if objects.is_empty() {
            self.problems.add("Scene", "there is no surface to render; only the background is drawn", 1);
        }
        let problems = self.problems.into_list();
        let textures = self.textures.into();
        Ok(Scene { space, objects, materials, textures, lamps, camera, world, bounds, problems })
    }

    fn keep_usable_objects(&mut self, bounds: &[[DVec3; 2]]) {
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
            if object.visibility == 0 || meshes[object.mesh].triangles.is_empty() {
                return false;
            }
            let boxes = object.placements().into_iter().map(|place| box_about(bounds[object.mesh], &place));
            let is_near = |corner: DVec3| corner.abs().max_element() <= LARGEST;
            if !(boxes.flatten().all(is_near) && transform.inverse().is_finite()) {
                let what = "it is larger, smaller or farther away than numbers go; the object is left out";
                problems.add(&object.name, what, 1);
                return false;
            }
            true
        });
    }

    /// Scene space from the bounds of everything, in f64.
    fn measure(&self, bounds: &[[DVec3; 2]]) -> SceneSpace {
        let (mut low, mut high) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
        for object in &self.objects {
            for placement in object.placements() {
                let [a, b] = box_about(bounds[object.mesh], &placement);
                (low, high) = (low.min(a), high.max(b));
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
        let deforms: Vec<bool> = self.meshes.iter().map(|mesh| !mesh.steps.is_empty()).collect();
        let mut placed = Vec::with_capacity(self.objects.len());
        let mut need_default = false;
        for mut object in std::mem::take(&mut self.objects) {
            if object.materials.is_empty() {
                need_default = true;
                object.materials.push(default_material);
            }
            let transform = scene_from_world * object.world_from_object;
            let keys = object.placements();
            let moves = keys.len() > 1 || deforms[object.mesh];
            let mut motion = Vec::new();
            let (mesh, scene_from_mesh) = if uses[object.mesh] == 1 && !moves {
                let arrays = std::mem::take(&mut self.meshes[object.mesh]);
                (Arc::new(mesh::transformed(arrays, &transform, &mut self.problems)), None)
            } else {
                let (mesh, object_from_mesh) = shared[object.mesh].get_or_insert_with(|| {
                    let (mesh, object_from_mesh) =
                        mesh::normalized(std::mem::take(&mut self.meshes[object.mesh]));
                    (Arc::new(mesh), object_from_mesh)
                });
                if keys.len() > 1 {
                    let steps = motion::refined(&keys).into_iter();
                    motion = steps.map(|step| scene_from_world * step * *object_from_mesh).collect();
                }
                (Arc::clone(mesh), Some(transform * *object_from_mesh))
            };
            let is_blocker = object.visibility & visibility::SHADOW != 0;
            let blocker = if is_blocker { visibility::blocker(object.links.blocker_set) } else { 0 };
            placed.push(Object {
                name: object.name,
                mesh,
                scene_from_mesh,
                motion,
                object_from_scene: transform.inverse(),
                info: object.info,
                materials: object.materials,
                visibility: object.visibility | blocker,
                receiver: 1 << object.links.receiver_set,
                links: object.links.light,
            });
        }
        if need_default {
            self.materials.push(MaterialRecord::default_gray());
        }
        placed.retain(|object| !object.mesh.triangles.is_empty());
        placed
    }

    fn place_lamps(&mut self, space: &SceneSpace) -> Result<Vec<Lamp>, RenderError> {
        let mut lamps = Vec::new();
        for mut record in std::mem::take(&mut self.lamps) {
            let (program, info) = (record.program.take(), std::mem::take(&mut record.info));
            let world_from_lamp = DAffine3::from_mat4(matrix(&record.world_from_lamp));
            let Some(mut lamp) = place_lamp(record, space, &mut self.problems) else { continue };
            if let Some(LampProgramRecord { instructions, factor }) = program {
                let subject = format!("lamp '{}'", lamp.name);
                let program = checked_program(&subject, instructions, factor, self.textures.len())?;
                let lamp_from_world = world_from_lamp.inverse();
                lamp.program = Some(LampProgram { program, factor, info, lamp_from_world });
            }
            lamps.push(lamp);
        }
        Ok(lamps)
    }

    fn take_world(&mut self) -> Result<World, RenderError> {
        let WorldRecord { name, radiance, program, visibility, film_transparent } =
            std::mem::take(&mut self.world);
        if !radiance.is_finite() {
            self.problems.add(&name, "the world's color is not a number; black is used", 1);
        }
        let radiance = if radiance.is_finite() { radiance.map(|c| c.max(0.0)) } else { Rgb::BLACK };
        let textures = self.textures.len();
        let checked = |WorldProgramRecord { instructions, radiance }| {
            let program = checked_program(&format!("world '{name}'"), instructions, radiance, textures)?;
            Ok::<_, RenderError>(WorldProgram { program, radiance })
        };
        let program = program.map(checked).transpose()?;
        Ok(World { name, radiance, program, visibility, film_transparent })
    }

    fn take_materials(&mut self) -> Result<Vec<Material>, RenderError> {
        let textures = self.textures.len();
        let records = std::mem::take(&mut self.materials).into_iter();
        records.map(|record| checked_material(record, textures)).collect()
    }
}

/// A program with a result of this number.
fn checked_program(
    subject: &str,
    instructions: Vec<Instruction>,
    result: Register,
    textures: usize,
) -> Result<Program, RenderError> {
    let fault = |what: String| RenderError::Scene(format!("{subject}: {what}"));
    let program = Program::new(instructions, textures).map_err(fault)?;
    if result as usize >= program.len() {
        return Err(fault(format!("its program has no register {result}")));
    }
    Ok(program)
}

fn checked_material(record: MaterialRecord, textures: usize) -> Result<Material, RenderError> {
    let MaterialRecord { name, mut closures, program, absorption } = record;
    let Some(record) = program else { return Ok(Material { name, closures, program: None, absorption }) };
    let fault = |what: String| RenderError::Scene(format!("material '{name}': {what}"));
    let program = Program::new(record.instructions, textures).map_err(fault)?;
    for output in &record.outputs {
        let closure = closures.get_mut(output.closure);
        if closure.and_then(|closure| closure.input_mut(output.input)).is_none() {
            return Err(fault(format!("closure {} has no input {:?}", output.closure, output.input)));
        }
    }
    if let Some(normal) = record.normals.iter().find(|normal| normal.closure >= closures.len()) {
        return Err(fault(format!("it has a normal for closure {} of {}", normal.closure, closures.len())));
    }
    if let Some(tangent) = record.tangents.iter().find(|tangent| tangent.closure >= closures.len()) {
        return Err(fault(format!("it has a tangent for closure {} of {}", tangent.closure, closures.len())));
    }
    let normals = record.normals.iter().map(|normal| normal.register).chain(record.normal);
    let tangents = record.tangents.iter().map(|tangent| tangent.register);
    let registers = record.outputs.iter().map(|output| output.register).chain(normals).chain(tangents);
    if let Some(register) = registers.into_iter().find(|&register| register as usize >= program.len()) {
        return Err(fault(format!("its program has no register {register}")));
    }
    let ProgramRecord { outputs, normal, normals, tangents, .. } = record;
    let program = MaterialProgram { program, outputs, normal, normals, tangents };
    Ok(Material { name, closures, program: Some(program), absorption })
}

/// The box about a box that was moved.
fn box_about([a, b]: [DVec3; 2], transform: &DAffine3) -> [DVec3; 2] {
    let corner = |corner: i32| {
        let pick = |bit: i32, x: f64, y: f64| if corner & bit == 0 { x } else { y };
        transform.transform_point3(DVec3::new(pick(1, a.x, b.x), pick(2, a.y, b.y), pick(4, a.z, b.z)))
    };
    (0..8)
        .map(corner)
        .fold([DVec3::INFINITY, DVec3::NEG_INFINITY], |[low, high], p| [low.min(p), high.max(p)])
}

/// Bounds of all objects at all times.
fn bounds_of(objects: &[Object]) -> [Vec3; 2] {
    let (mut low, mut high) = (Vec3::INFINITY, Vec3::NEG_INFINITY);
    for object in objects {
        for step in &object.motion {
            // Meshes of what moves are in a unit cube of their own.
            let [a, b] = box_about([DVec3::splat(-0.5), DVec3::splat(0.5)], step);
            (low, high) = (low.min(a.as_vec3()), high.max(b.as_vec3()));
        }
        for p in object.mesh.steps.iter().flatten() {
            let p = object.scene_from_mesh.map_or(*p, |t| t.transform_point3(p.as_dvec3()).as_vec3());
            (low, high) = (low.min(p), high.max(p));
        }
        for p in &object.mesh.positions {
            let p = object.scene_from_mesh.map_or(*p, |t| t.transform_point3(p.as_dvec3()).as_vec3());
            (low, high) = (low.min(p), high.max(p));
        }
    }
    if low.is_finite() && high.is_finite() { [low, high] } else { [Vec3::splat(-0.5), Vec3::splat(0.5)] }
}
