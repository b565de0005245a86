"""Objects and instances: what is where, made of which materials, seen by which rays."""

from typing import Any

from .context import ExportContext
from .coordinates import matrix_array
from .light import export_light
from .material import material_index
from .mesh import mesh_arrays
from .motion import Moving
from .object_info import object_info
from .visibility import instance_bits, owner

# Without triangles of their own. What curves, texts, surfaces and metaballs look like comes as an instance of a mesh.
_WITHOUT_TRIANGLES = ("CURVE", "SURFACE", "FONT", "META")
_INVISIBLE = ("EMPTY", "CAMERA", "ARMATURE", "LATTICE", "SPEAKER", "LIGHT_PROBE")


def export_instances(context: ExportContext, moving: Moving | None) -> None:
    """Everything the depsgraph shows: objects, and instances of collections, faces, particles and geometry nodes.
    What may move is noted."""
    for b_instance in context.b_depsgraph.object_instances:
        b_object = b_instance.object
        context.tick(b_object.name)
        if not b_instance.show_self:
            continue
        kind = b_object.type
        if kind == "LIGHT":
            export_light(context, b_instance)
        elif kind == "MESH":
            _export_mesh(context, b_instance, moving)
        elif kind not in _INVISIBLE + _WITHOUT_TRIANGLES:
            name = b_object.bl_rna.properties["type"].enum_items[kind].name
            context.log.add(b_object.name, f"objects of type {name} are not supported yet; left out")


def _export_mesh(context: ExportContext, b_instance: Any, moving: Moving | None) -> None:
    """One placed mesh."""
    visibility = instance_bits(context, b_instance)
    if visibility == 0:
        return
    b_object = b_instance.object
    # Never keyed by name: instances that geometry nodes make all bear the name of their object.
    materials = _materials(context, b_object)
    layers = frozenset[str]().union(*(context.layers_read[index] for index in materials))
    key = (b_object.data.as_pointer(), layers)
    if key not in context.meshes:
        context.meshes[key] = _add_mesh(context, b_object, layers)
    _report_unsupported(context, b_instance)
    mesh = context.meshes[key]
    if mesh is None:
        return
    matrix = matrix_array(b_instance.matrix_world)
    index = context.builder.add_object(b_object.name, mesh, matrix, materials, visibility)
    asked = [context.asking_objects[material] for material in materials if material in context.asking_objects]
    if asked:
        names = frozenset[str]().union(*asked)
        context.builder.set_object_info(index, object_info(context, b_instance, names))
    if context.linking.is_used:
        context.builder.set_object_links(index, context.linking.of_object(owner(b_instance)))
    if moving is not None:
        moving.note(b_instance, index, mesh)


def _add_mesh(context: ExportContext, b_object: Any, layers: frozenset[str]) -> int | None:
    """Hands an object's mesh and some layers to the core, named as the artist sees it; None without triangles."""
    arrays = mesh_arrays(b_object.data, sorted(layers))
    if arrays is None:
        return None
    for name in sorted(layers - arrays.layers.keys()):
        context.log.add(
            b_object.name, f"its material reads {_layer_text(name)}, which the mesh does not have; 0 is used"
        )
    index: int = context.builder.add_mesh(
        b_object.name,
        arrays.positions,
        arrays.triangles,
        arrays.corner_normals,
        [(context.attribute_number(name), values) for name, values in arrays.layers.items()],
        arrays.slots,
    )
    return index


def _layer_text(name: str) -> str:
    kind, _, which = name.partition(":")
    return {"uv": f'the UV map "{which}"' if which else "a UV map", "color": "a color attribute"}.get(
        kind, f'the attribute "{which}"'
    )


def _materials(context: ExportContext, b_object: Any) -> list[int]:
    """Index of the material in each slot; the view layer's override replaces all."""
    b_override = context.b_depsgraph.view_layer_eval.material_override
    b_materials = [b_override] if b_override is not None else _slot_materials(b_object)
    return [material_index(context, b_material) for b_material in b_materials or [None]]


def _slot_materials(b_object: Any) -> list[Any]:
    """The evaluated mesh's materials, which geometry nodes may have set, where the object does not have its own."""
    b_materials = list(b_object.data.materials)
    for index, b_slot in enumerate(b_object.material_slots):
        if b_slot.link == "OBJECT":
            b_materials += [None] * (index + 1 - len(b_materials))
            b_materials[index] = b_slot.material
    return b_materials


def _report_unsupported(context: ExportContext, b_instance: Any) -> None:
    """What the object asks for beyond its triangles."""
    b_object, log = b_instance.object, context.log
    for b_system in () if b_instance.is_instance else b_object.particle_systems:
        b_settings = b_system.settings
        if b_settings.type == "HAIR" and b_settings.render_type == "PATH":
            log.add(b_object.name, f'hair "{b_system.name}" is not supported yet; left out')
