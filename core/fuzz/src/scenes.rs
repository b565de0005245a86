//! Scenes through the renderer's builder, in the order in which the exporter fills it.

use ciborium::Value;
use rgp_renderer::error::RenderError;
use rgp_renderer::scene::record::{CameraRecord, LampRecord, MaterialRecord, WorldRecord, matrix};
use rgp_renderer::scene::{CornerLayer, MeshArrays, ObjectInfo, ObjectLinks, Scene, SceneBuilder};

use crate::draw::Draw;
use crate::programs::{instruction_records, texture};
use crate::records::{Kind, Known, read, record, value};
use crate::shapes::{CAMERA, CLOSURE, LAMP, NORMAL, OBJECT_INFO, OBJECT_LINKS, OUTPUT, TANGENT};

/// Most pixels of a side.
const SIDE: usize = 4;

/// The scene that some bytes stand for. What the builder refuses on the way is left out of it.
///
/// # Errors
/// The renderer's own, of the finished scene.
pub fn scene(draw: &mut Draw<'_>) -> Result<Scene, RenderError> {
    let mut builder = SceneBuilder::default();
    let camera = camera(draw);
    let textures = draw.list(2, texture).into_iter().flatten().map(|t| builder.add_texture(t)).count();
    let materials = draw.list(3, |draw| material(draw, textures));
    let materials = materials.into_iter().map(|record| builder.add_material(record)).count();
    let meshes = draw.list(3, mesh);
    let vertices: Vec<usize> = meshes.iter().map(|arrays| arrays.positions.len()).collect();
    let meshes = meshes.into_iter().filter_map(|arrays| builder.add_mesh(arrays).ok()).count();
    draw.list(4, |draw| object(draw, &mut builder, meshes, materials));
    draw.list(2, |draw| {
        let mesh = draw.index(meshes);
        let count = vertices.get(mesh).copied().unwrap_or_default() + usize::from(draw.byte() == 255);
        let steps = draw.list(4, |draw| draw.flag().then(|| (0..count).map(|_| draw.singles()).collect()));
        builder.set_mesh_motion(mesh, steps)
    });
    for lamp in draw.list(3, |draw| lamp(draw, textures)) {
        builder.add_lamp(lamp);
    }
    builder.set_camera(camera);
    builder.set_world(world(draw, textures));
    builder.finish()
}

fn camera(draw: &mut Draw<'_>) -> CameraRecord {
    let Value::Map(mut entries) = record(draw, CAMERA, Known::default()) else { unreachable!("a record") };
    let mut pixels = |least: usize| Value::from((least + draw.below(SIDE)) as u64);
    let resolution = Value::Array(vec![pixels(1), pixels(1)]);
    let region = Value::Array(vec![pixels(0), pixels(0), pixels(0), pixels(0)]);
    entries.extend([("resolution".into(), resolution), ("region".into(), region)]);
    read(&Value::Map(entries))
}

fn material(draw: &mut Draw<'_>, textures: usize) -> MaterialRecord {
    let closures = Value::Array(draw.list(2, |draw| record(draw, CLOSURE, Known::default())));
    let program = if draw.flag() { program(draw, textures) } else { Value::Null };
    let name = value(draw, Kind::Name, Known::default());
    let absorption = value(draw, Kind::Numbers(3), Known::default());
    let entries = [("name", name), ("closures", closures), ("program", program), ("absorption", absorption)];
    read(&Value::Map(entries.map(|(name, value)| (name.into(), value)).to_vec()))
}

fn program(draw: &mut Draw<'_>, textures: usize) -> Value {
    let instructions = instruction_records(draw, 6, textures);
    let known = Known { registers: instructions.len(), textures };
    let outputs = value(draw, Kind::List(3, OUTPUT), known);
    let normal = if draw.flag() { value(draw, Kind::Register, known) } else { Value::Null };
    let normals = value(draw, Kind::List(2, NORMAL), known);
    let tangents = value(draw, Kind::List(2, TANGENT), known);
    let instructions = Value::Array(instructions);
    let entries = [
        ("instructions", instructions),
        ("outputs", outputs),
        ("normal", normal),
        ("normals", normals),
        ("tangents", tangents),
    ];
    Value::Map(entries.map(|(name, value)| (name.into(), value)).to_vec())
}

fn lamp(draw: &mut Draw<'_>, textures: usize) -> LampRecord {
    let program = light_program(draw, textures, "factor");
    let Value::Map(mut entries) = record(draw, LAMP, Known::default()) else { unreachable!("a record") };
    entries.push(("program".into(), program));
    read(&Value::Map(entries))
}

/// A program with one result, or none.
fn light_program(draw: &mut Draw<'_>, textures: usize, result: &str) -> Value {
    if !draw.flag() {
        return Value::Null;
    }
    let instructions = instruction_records(draw, 5, textures);
    let known = Known { registers: instructions.len(), textures };
    let register = value(draw, Kind::Register, known);
    let entries = [("instructions", Value::Array(instructions)), (result, register)];
    Value::Map(entries.map(|(name, value)| (name.into(), value)).to_vec())
}

fn world(draw: &mut Draw<'_>, textures: usize) -> WorldRecord {
    let program = light_program(draw, textures, "radiance");
    let mut field = |name: &str, kind| (name.into(), value(draw, kind, Known::default()));
    read(&Value::Map(vec![
        field("name", Kind::Name),
        field("radiance", Kind::Numbers(3)),
        field("visibility", Kind::Whole(32)),
        field("film_transparent", Kind::Flag),
        ("program".into(), program),
    ]))
}

/// Arrays that nearly always fit together.
fn mesh(draw: &mut Draw<'_>) -> MeshArrays {
    let positions = draw.list(6, Draw::singles);
    let triangles = draw.list(5, |draw| std::array::from_fn(|_| draw.index(positions.len()) as u32));
    let count = triangles.len();
    let fits = |draw: &mut Draw<'_>| if draw.byte() == 255 { draw.below(9) } else { count };
    let mut layers = Vec::new();
    for attribute in 0..draw.below(3) as u32 {
        let channels = 1 + draw.below(5);
        let values = (0..fits(draw) * 3 * channels).map(|_| draw.single()).collect();
        layers.push(CornerLayer { attribute, channels, values });
    }
    let has_normals = draw.flag();
    let normals = if has_normals { fits(draw) } else { 0 };
    let has_slots = draw.flag();
    let slots = if has_slots { fits(draw) } else { 0 };
    MeshArrays {
        name: "Mesh".into(),
        corner_normals: (0..normals).map(|_| std::array::from_fn(|_| draw.singles())).collect(),
        slots: (0..slots).map(|_| draw.index(3) as u16).collect(),
        steps: Vec::new(),
        positions,
        triangles,
        layers,
    }
}

fn object(draw: &mut Draw<'_>, builder: &mut SceneBuilder, meshes: usize, materials: usize) -> Option<()> {
    let transform = |draw: &mut Draw<'_>| matrix(&read(&value(draw, Kind::Matrix, Known::default())));
    let mesh = draw.index(meshes);
    let slots = draw.list(3, |draw| draw.index(materials) as u32);
    let place = transform(draw);
    let visibility = if draw.flag() { 31 } else { u32::from_le_bytes(draw.bytes()) };
    let object = builder.add_object("Object", mesh, place, slots, visibility).ok()?;
    if draw.flag() {
        let info: ObjectInfo = read(&record(draw, OBJECT_INFO, Known::default()));
        let links: ObjectLinks = read(&record(draw, OBJECT_LINKS, Known::default()));
        let known = object + usize::from(draw.byte() == 255);
        builder.set_object_info(known, info).ok()?;
        builder.set_object_links(known, links).ok()?;
    }
    if draw.flag() {
        let steps = draw.list(4, transform);
        builder.set_object_motion(object, &steps).ok()?;
    }
    Some(())
}
