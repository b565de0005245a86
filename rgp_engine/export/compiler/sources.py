"""Nodes that look at the hit: textures, coordinates, geometry, attributes."""

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from ..arithmetic import clamp
from ..fold import Varying
from ..ies import UNREADABLE, IesError, web_of
from ..nodes import Output
from .images import texture_of, tiles_of, unassociates
from .mapping import own_mapping
from .places import camera_position, inverse_rows, window_position
from .sky import sky_texture

if TYPE_CHECKING:
    from .compiler import Compiler, Operand, Register

_EXTENSIONS = {"REPEAT": "repeat", "EXTEND": "extend", "CLIP": "clip", "MIRROR": "mirror"}
_INTERPOLATIONS = {"Linear": "linear", "Closest": "closest", "Cubic": "cubic", "Smart": "cubic"}
FILTER_WIDTH = 0.1
"""Widths of the ray over which slopes are taken where no Bump node says it, as in Blender 4.2."""
_FILTER_WIDTHS = (1e-3, 1e3)
"""Least and most that are kept of what one says."""


def _image(c: "Compiler", source: Output) -> "Operand | None":
    b_node = source.b_node
    texture, tiles = texture_of(c, b_node), tiles_of(c, b_node)
    if not _is_rendered(b_node.projection, texture, tiles):
        return None
    fields = {
        "extension": _EXTENSIONS[b_node.extension],
        "interpolation": _INTERPOLATIONS[b_node.interpolation],
        "unassociate": unassociates(b_node),
    }
    vector = own_mapping(c, b_node, c.input(source, "Vector") if c.linked(source, "Vector") else _uv(c))
    if b_node.projection == "BOX":
        normal = c.quantity("object_normal")
        blend = float(b_node.projection_blend)
        color = c.emit("box_image", texture=texture, vector=vector, normal=normal, blend=blend, **fields)
    elif tiles:
        color = c.emit("tiled_image", tiles=tiles, vector=vector, **fields)
    else:
        if b_node.projection != "FLAT":
            vector = c.emit("panorama", vector=vector, projection=b_node.projection.lower())
        color = c.emit("image", texture=texture, vector=vector, **fields)
    return c.emit("alpha", of=color) if source.b_socket.identifier == "Alpha" else color


def _is_rendered(projection: str, texture: int | None, tiles: "list[dict[str, int]]") -> bool:
    return projection == "FLAT" if tiles else texture is not None


def _environment(c: "Compiler", source: Output) -> "Operand | None":
    b_node = source.b_node
    texture = texture_of(c, b_node)
    if texture is None:
        return None
    direction = c.input(source, "Vector") if c.linked(source, "Vector") else c.quantity("position")
    direction = own_mapping(c, b_node, direction)
    place = c.emit("panorama", vector=direction, projection=b_node.projection.lower())
    interpolation = _INTERPOLATIONS[b_node.interpolation]
    fields = {"texture": texture, "extension": "repeat", "interpolation": interpolation}
    return c.emit("image", vector=place, unassociate=False, **fields)


def _luminaire(c: "Compiler", source: Output) -> "Operand | None":
    strength = c.input(source, "Strength")
    try:
        web = web_of(source.b_node).record()
    except IesError as error:
        c.report_node(source.b_node, f"{error}; an intensity of {UNREADABLE:g} is used instead, as in Cycles")
        return c.math("MULTIPLY", strength, UNREADABLE)
    vector = c.input(source, "Vector") if c.linked(source, "Vector") else c.quantity("object_incoming")
    return c.math("MULTIPLY", strength, c.emit("photometric_web", vector=vector, web=web))


def _uv(c: "Compiler") -> "Register":
    return c.attribute("uv")


def _uv_map(c: "Compiler", source: Output) -> "Operand | None":
    b_node = source.b_node
    if b_node.from_instancer:
        return None
    return c.attribute(_uv_layer(b_node))


def _uv_layer(b_node: Any) -> str:
    """The layer of a node that names a UV map, or none for the mesh's first."""
    return f"uv:{b_node.uv_map}" if b_node.uv_map else "uv"


def _tangent(c: "Compiler", source: Output) -> "Operand | None":
    b_node = source.b_node
    if c.of_world or c.of_lamp:
        return None
    if b_node.direction_type == "RADIAL":
        return c.radial_tangent(b_node.axis.lower())
    layer = _uv_layer(b_node)
    c.attributes.add(layer)
    return c.emit("uv_tangent", attribute=c.context.attribute_number(layer))


def _texture_coordinate(c: "Compiler", source: Output) -> "Operand | None":
    name = source.b_socket.identifier
    if source.b_node.from_instancer and name in ("Generated", "UV"):
        return None
    if name == "Generated":
        return c.generated()
    if name == "UV":
        return _uv(c)
    if name == "Normal":
        return c.quantity("object_normal")
    if name == "Reflection":
        return c.quantity("reflection")
    if name == "Object":
        b_object = source.b_node.object
        if b_object is None:
            return c.quantity("object_position")
        return c.transformed(c.quantity("position"), inverse_rows(b_object.matrix_world))
    if name == "Camera":
        return camera_position(c)
    return window_position(c) if name == "Window" else None


_GEOMETRY = {
    "Position": "position",
    "Normal": "normal",
    "True Normal": "true_normal",
    "Incoming": "incoming",
    "Parametric": "parametric",
    "Backfacing": "backfacing",
}


def _geometry(c: "Compiler", source: Output) -> "Operand | None":
    has_mesh = not (c.of_world or c.of_lamp)
    if source.b_socket.identifier == "Tangent" and has_mesh:
        return c.radial_tangent("z")
    if source.b_socket.identifier == "Random Per Island" and has_mesh:
        return c.attribute("island")
    name = _GEOMETRY.get(source.b_socket.identifier)
    return None if name is None else c.quantity(name)


_OBJECT_INFO = {
    "Location": "object_location",
    "Color": "object_color",
    "Object Index": "object_index",
    "Random": "object_random",
}


def _object_info(c: "Compiler", source: Output) -> "Operand | None":
    name = source.b_socket.identifier
    if name == "Material Index":
        return float(c.material_index)
    c.asks_object = True
    if name == "Alpha":
        return c.emit("alpha", of=c.quantity("object_color"))
    known = _OBJECT_INFO.get(name)
    return None if known is None else c.quantity(known)


_LIGHT_PATH = {
    "Is Camera Ray": "is_camera",
    "Is Shadow Ray": "is_shadow",
    "Is Diffuse Ray": "is_diffuse",
    "Is Glossy Ray": "is_glossy",
    "Is Reflection Ray": "is_reflection",
    "Is Transmission Ray": "is_transmission",
}


def _light_path(c: "Compiler", source: Output) -> "Operand | None":
    if source.b_socket.identifier == "Ray Length" and c.of_lamp:
        return c.quantity("ray_length")
    name = _LIGHT_PATH.get(source.b_socket.identifier)
    return None if name is None else c.quantity(name)


def _light_falloff(c: "Compiler", source: Output) -> "Operand | None":
    """Strength, made up for a part of what light of a lamp loses on its way; suns lose nothing."""
    strength = c.input(source, "Strength")
    if c.is_sun:
        return strength
    length = c.quantity("ray_length")
    squared = c.math("MULTIPLY", length, length)
    made_up_for = {"Linear": length, "Constant": squared}.get(source.b_socket.identifier)
    if made_up_for is not None:
        strength = c.math("MULTIPLY", strength, made_up_for)
    smooth = c.math("MAXIMUM", c.input(source, "Smooth"), 0.0)
    return c.math("MULTIPLY", strength, c.math("DIVIDE", squared, c.math("ADD", smooth, squared)))


def _falls_off(c: "Compiler", source: Output) -> bool:
    """False where the node gives its strength, as everywhere but on lamps."""
    if not c.of_lamp:
        return False
    is_plain = source.b_socket.identifier == "Quadratic" and c.value(source.input("Smooth")) == 0.0
    return not is_plain or isinstance(c.value(source.input("Strength")), Varying)


def _attribute(c: "Compiler", source: Output) -> "Operand | None":
    kind, which = source.b_node.attribute_type, source.b_node.attribute_name
    # Those of view layers are constants.
    if kind == "VIEW_LAYER" or not which:
        return None
    is_layer = kind == "GEOMETRY"
    layer = c.attribute(f"attribute:{which}") if is_layer else c.object_value(f"{kind.lower()}:{which}")
    name = source.b_socket.identifier
    if name == "Alpha":
        return c.emit("alpha", of=layer)
    return c.emit("mean", of=layer) if name == "Fac" else layer


def _color_attribute(c: "Compiler", source: Output) -> "Operand | None":
    name = source.b_node.layer_name
    layer = c.attribute(f"attribute:{name}" if name else "color")
    return c.emit("alpha", of=layer) if source.b_socket.identifier == "Alpha" else layer


def _normal(c: "Compiler", source: Output) -> "Register":
    """A node's own normal input; what is unlinked is the surface's."""
    return c.input(source, "Normal") if c.linked(source, "Normal") else c.quantity("normal")


def _fresnel(c: "Compiler", source: Output) -> "Operand | None":
    return c.emit("fresnel", ior=c.input(source, "IOR"), normal=_normal(c, source))


def _layer_weight(c: "Compiler", source: Output) -> "Operand | None":
    facing = source.b_socket.identifier == "Facing"
    return c.emit("layer_weight", blend=c.input(source, "Blend"), normal=_normal(c, source), facing=facing)


def _normal_map(c: "Compiler", source: Output) -> "Operand | None":
    b_node = source.b_node
    space = {"TANGENT": "tangent", "OBJECT": "object", "WORLD": "world"}.get(b_node.space)
    if space is None:
        return None
    layer = _uv_layer(b_node)
    if space == "tangent":
        c.attributes.add(layer)
    return c.emit(
        "normal_map",
        color=c.input(source, "Color"),
        strength=c.input(source, "Strength"),
        space=space,
        attribute=c.context.attribute_number(layer),
    )


def heights(c: "Compiler", source: Output, filter_width: float) -> "dict[str, Register | float]":
    """The height of a node that tilts the normal: at the hit, and `filter_width` widths of the ray aside along two
    tangents."""
    here = c.aside
    found: dict[str, Register | float] = {"filter_width": filter_width}
    places = {"height": (0.0, 0.0), "height_x": (filter_width, 0.0), "height_y": (0.0, filter_width)}
    for name, aside in places.items():
        c.aside = aside
        found[name] = c.input(source, "Height")
    c.aside = here
    return found


def _bump(c: "Compiler", source: Output) -> "Operand | None":
    entry = source.find("Filter Width")
    # A link to it means nothing to Cycles either.
    filter_width = FILTER_WIDTH if entry is None else clamp(entry.b_socket.default_value, *_FILTER_WIDTHS)
    return c.emit(
        "bump",
        strength=c.input(source, "Strength"),
        distance=c.input(source, "Distance"),
        normal=_normal(c, source),
        invert=bool(source.b_node.invert),
        **heights(c, source, filter_width),
    )


def _always(_c: "Compiler", _source: Output) -> bool:
    return True


def _known(emit: "Callable[[Compiler, Output], Operand | None]") -> "Callable[[Compiler, Output], bool]":
    """For nodes that are sources where their use is known, and cost nothing to ask."""
    return lambda c, source: emit(c, source) is not None


NODES: "dict[str, Callable[[Compiler, Output], Operand | None]]" = {
    "TEX_IMAGE": _image,
    "TEX_ENVIRONMENT": _environment,
    "TEX_SKY": sky_texture,
    "TEX_IES": _luminaire,
    "UVMAP": _uv_map,
    "TEX_COORD": _texture_coordinate,
    "NEW_GEOMETRY": _geometry,
    "TANGENT": _tangent,
    "OBJECT_INFO": _object_info,
    "LIGHT_PATH": _light_path,
    "LIGHT_FALLOFF": _light_falloff,
    "ATTRIBUTE": _attribute,
    "VERTEX_COLOR": _color_attribute,
    "FRESNEL": _fresnel,
    "LAYER_WEIGHT": _layer_weight,
    "NORMAL_MAP": _normal_map,
    "BUMP": _bump,
}
"""Instructions of the nodes that look at the hit."""

SOURCES: "dict[str, Callable[[Compiler, Output], bool]]" = {
    **dict.fromkeys(("FRESNEL", "LAYER_WEIGHT", "NORMAL_MAP", "BUMP", "TEX_SKY", "TEX_IES"), _always),
    "TEX_IMAGE": lambda c, source: _is_rendered(
        source.b_node.projection, texture_of(c, source.b_node), tiles_of(c, source.b_node)
    ),
    "TEX_ENVIRONMENT": lambda c, source: texture_of(c, source.b_node) is not None,
    "UVMAP": _known(_uv_map),
    "TEX_COORD": _known(_texture_coordinate),
    "NEW_GEOMETRY": _known(_geometry),
    "TANGENT": _known(_tangent),
    "OBJECT_INFO": _known(_object_info),
    "LIGHT_PATH": _known(_light_path),
    "LIGHT_FALLOFF": _falls_off,
    "ATTRIBUTE": _known(_attribute),
    "VERTEX_COLOR": _known(_color_attribute),
}
"""Whether a node looks at the hit; where not, it folds to a constant and is reported."""
