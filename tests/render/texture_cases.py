"""Cases of texture nodes: images, and patterns of every kind."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

import bpy

from tests.blender import build
from tests.render.node_scene import EDGES, IMAGE, SMOOTH, Make, NodeCase, noise_image, output_of


def _image(extension: str, interpolation: str) -> Make:
    def make(b_tree: Any) -> Any:
        b_image = b_tree.nodes.new("ShaderNodeTexImage")
        b_image.image = noise_image("sRGB")
        b_image.extension, b_image.interpolation = extension, interpolation
        b_mapping = b_tree.nodes.new("ShaderNodeMapping")
        b_mapping.inputs["Location"].default_value = (-0.6, 0.2, 0.0)
        b_mapping.inputs["Rotation"].default_value = (0.1, 0.2, 0.5)
        b_tree.links.new(b_tree.nodes.new("ShaderNodeUVMap").outputs[0], b_mapping.inputs[0])
        b_tree.links.new(b_mapping.outputs[0], b_image.inputs[0])
        return b_image.outputs["Color"]

    return make


def _saved(name: str, seed: int) -> str:
    """The path of a picture that is written to Blender's own folder for what is there for a moment."""
    b_image = noise_image("sRGB", seed=seed)
    b_image.filepath_raw, b_image.file_format = str(Path(bpy.app.tempdir) / name), "PNG"
    b_image.save()
    path = str(b_image.filepath_raw)
    bpy.data.images.remove(b_image)
    return path


def _sequence(**settings: Any) -> Make:
    """Six pictures, one for each frame; the scene is at frame 1."""

    def make(b_tree: Any) -> Any:
        first, *_ = [_saved(f"rgp_sequence_{number:03d}.png", number) for number in range(1, 7)]
        b_texture = b_tree.nodes.new("ShaderNodeTexImage")
        b_texture.image = bpy.data.images.load(first)
        b_texture.image.source = "SEQUENCE"
        for name, value in settings.items():
            setattr(b_texture.image_user, name, value)
        return b_texture.outputs["Color"]

    return make


def _tiled(numbers: tuple[int, ...], packed: bool = False) -> Make:
    """A picture for each tile; the plane lies on 1001 and 1002. Of those that are packed no file is left."""

    def make(b_tree: Any) -> Any:
        files = [_saved(f"rgp_tiles_{len(numbers)}.{number}.png", number) for number in numbers]
        folder = Path(bpy.app.tempdir)
        b_texture = b_tree.nodes.new("ShaderNodeTexImage")
        b_texture.image = bpy.data.images.load(str(folder / f"rgp_tiles_{len(numbers)}.{numbers[0]}.png"))
        b_texture.image.source = "TILED"
        b_texture.image.filepath = str(folder / f"rgp_tiles_{len(numbers)}.<UDIM>.png")
        b_texture.image.reload()
        if packed:
            b_texture.image.pack()
            for file in files:
                Path(file).unlink()
        return b_texture.outputs["Color"]

    return make


def _pictured(make: Make) -> Make:
    """The image of noise for the node that is made."""

    def make_with_image(b_tree: Any) -> Any:
        b_output = make(b_tree)
        b_output.node.image = noise_image("sRGB")
        return b_output

    return make_with_image


def _image_with_alpha(uses_alpha: bool) -> Make:
    def make(b_tree: Any) -> Any:
        b_image = b_tree.nodes.new("ShaderNodeTexImage")
        b_image.image = noise_image("sRGB", alpha=True)
        if not uses_alpha:
            return b_image.outputs["Color"]
        b_sum = b_tree.nodes.new("ShaderNodeVectorMath")
        b_tree.links.new(b_image.outputs["Color"], b_sum.inputs[0])
        b_tree.links.new(b_image.outputs["Alpha"], b_sum.inputs[1])
        return b_sum.outputs[0]

    return make


def _in_space(name: str, kind: str = "Image", *, is_float: bool = False, alpha: bool = False) -> Make:
    """A picture whose file is of a color space. That of floats is external: packed ones Cycles reads otherwise."""

    def make(b_tree: Any) -> Any:
        b_image = noise_image("Non-Color", alpha=alpha)
        if is_float:
            b_bytes, b_image = b_image, bpy.data.images.new("Floats", 8, 8, float_buffer=True, is_data=True)
            b_image.pixels = b_bytes.pixels[:]
            b_image.filepath_raw = str(Path(bpy.app.tempdir) / "rgp_floats.exr")
            b_image.file_format = "OPEN_EXR"
            b_image.save()
            path = b_image.filepath_raw
            bpy.data.images.remove(b_image)
            b_image = bpy.data.images.load(path)
        b_image.colorspace_settings.name = name
        b_texture = b_tree.nodes.new(f"ShaderNodeTex{kind}")
        b_texture.image = b_image
        return b_texture.outputs["Color"]

    return make


_SPACES = ("Linear Rec.709", "Linear Rec.2020", "ACEScg", "Filmic sRGB", "AgX Base sRGB", "Display P3")
"""All of these are known since Blender 4.2."""


def _spaces() -> Iterator[tuple[str, NodeCase]]:
    """Images of every color space."""
    for name in _SPACES:
        yield f"Image Texture/{name}", NodeCase(_in_space(name))
    for name in ("ACEScg", "Filmic sRGB"):
        yield f"Image Texture/{name} with alpha", NodeCase(_in_space(name, alpha=True))
        yield f"Environment Texture/{name}", NodeCase(_in_space(name, "Environment"))
    for name in ("sRGB", "Non-Color", "ACEScg", "Display P3"):
        for alpha in (False, True):
            of = "floats with alpha" if alpha else "floats"
            yield f"Image Texture/{name}, {of}", NodeCase(_in_space(name, is_float=True, alpha=alpha))


def _white_noise(dimensions: str) -> Make:
    def make(b_tree: Any) -> Any:
        b_whole = b_tree.nodes.new("ShaderNodeVectorMath")
        b_whole.operation, b_whole.inputs[1].default_value = "SNAP", (0.5, 0.5, 0.5)
        b_tree.links.new(b_tree.nodes.new("ShaderNodeUVMap").outputs[0], b_whole.inputs[0])
        b_noise = b_tree.nodes.new("ShaderNodeTexWhiteNoise")
        b_noise.noise_dimensions = dimensions
        build.socket(b_noise.inputs, "W").default_value = 0.3
        b_tree.links.new(b_whole.outputs[0], build.socket(b_noise.inputs, "Vector"))
        return b_noise.outputs["Color"]

    return make


def _textures() -> Iterator[tuple[str, NodeCase]]:
    """Images, and patterns of one kind of feature."""
    for extension in ("REPEAT", "EXTEND", "CLIP", "MIRROR"):
        for interpolation in ("Linear", "Closest", "Cubic"):
            is_smooth = interpolation != "Closest" and (interpolation, extension) != ("Linear", "CLIP")
            bound = SMOOTH if is_smooth else EDGES
            case = NodeCase(_image(extension, interpolation), bound)
            yield f"Image Texture/{extension} {interpolation}", case
    for uses_alpha in (True, False):
        name = "with alpha" if uses_alpha else "without its alpha"
        yield f"Image Texture/{name}", NodeCase(_image_with_alpha(uses_alpha))
    for projection in ("SPHERE", "TUBE", "BOX"):
        make = output_of("TexImage", inputs={0: "TexCoord"}, projection=projection)
        yield f"Image Texture/{projection}", NodeCase(_pictured(make), EDGES)
    sequences = {
        "sequence": {"frame_duration": 6, "frame_offset": 2},
        "sequence, its end": {"frame_duration": 4, "frame_start": -20},
        "sequence, cyclic": {
            "frame_duration": 4,
            "frame_start": -5,
            "use_cyclic": True,
            "use_auto_refresh": True,
        },
    }
    for name, settings in sequences.items():
        yield f"Image Texture/{name}", NodeCase(_sequence(**settings))
    yield "Image Texture/UDIM tiles", NodeCase(_tiled((1001, 1002)), EDGES)
    yield "Image Texture/UDIM tiles, packed", NodeCase(_tiled((1001, 1002), packed=True), EDGES)
    yield "Image Texture/UDIM with a tile missing", NodeCase(_tiled((1001,)), EDGES)
    kinds = ("LINEAR", "QUADRATIC", "EASING", "DIAGONAL", "RADIAL", "QUADRATIC_SPHERE", "SPHERICAL")
    for kind in kinds:
        yield f"Gradient Texture/{kind}", NodeCase(output_of("TexGradient", gradient_type=kind))
    for dimensions in ("1D", "2D", "3D", "4D"):
        yield f"White Noise Texture/{dimensions}", NodeCase(_white_noise(dimensions), EDGES)
    for depth in (0, 1, 2, 5, 10):
        inputs = {"Scale": 2.0, "Distortion": 1.2}
        make = output_of("TexMagic", "Color", inputs, turbulence_depth=depth)
        yield f"Magic Texture/depth {depth}", NodeCase(make)
    bricks = {"Scale": 3.0, "Mortar Smooth": 0.4, "Bias": 0.1, "Mortar Size": 0.05}
    offsets = {"offset": 0.3, "offset_frequency": 2, "squash": 0.6, "squash_frequency": 3}
    for output in ("Color", "Fac"):
        yield f"Brick Texture/{output}", NodeCase(output_of("TexBrick", output, bricks, **offsets), EDGES)
    yield "Checker Texture", NodeCase(output_of("TexChecker"), EDGES)


def _noises() -> Iterator[tuple[str, NodeCase]]:
    """Noise and waves."""
    octaves = {"W": 0.7, "Scale": 3.0, "Detail": 2.5, "Roughness": 0.6, "Lacunarity": 2.2, "Distortion": 0.4}
    for dimensions in ("1D", "2D", "3D", "4D"):
        for output in ("Fac", "Color"):
            make = output_of("TexNoise", output, octaves, noise_dimensions=dimensions)
            yield f"Noise Texture/{dimensions} {output}", NodeCase(make)
    musgrave = {"Scale": 3.0, "Detail": 2.5, "Offset": 0.7, "Gain": 0.9}
    for kind in ("MULTIFRACTAL", "RIDGED_MULTIFRACTAL", "HYBRID_MULTIFRACTAL", "HETERO_TERRAIN"):
        make = output_of("TexNoise", "Fac", musgrave, noise_type=kind)
        yield f"Noise Texture/{kind}", NodeCase(make)
    waves = {"Scale": 1.5, "Distortion": 1.2, "Detail": 1.5, "Detail Scale": 1.1, "Phase Offset": 0.3}
    bands = (("BANDS", "X", "SIN"), ("BANDS", "DIAGONAL", "TRI"))
    for kind, direction, profile in (*bands, ("RINGS", "Z", "SIN"), ("RINGS", "SPHERICAL", "TRI")):
        options = {"wave_type": kind, f"{kind.lower()}_direction": direction, "wave_profile": profile}
        make = output_of("TexWave", "Color", waves, **options)
        yield f"Wave Texture/{kind} {direction} {profile}", NodeCase(make)


def _cells() -> Iterator[tuple[str, NodeCase]]:
    """Voronoi's cells."""
    cells = {"W": IMAGE, "Scale": 3.0, "Smoothness": 0.6, "Exponent": 0.7, "Randomness": 0.8}
    for dimensions in ("1D", "2D", "3D", "4D"):
        space = {"voronoi_dimensions": dimensions}
        for feature in ("F1", "F2", "SMOOTH_F1", "DISTANCE_TO_EDGE"):
            for metric in ("EUCLIDEAN", "MINKOWSKI") if dimensions in ("2D", "3D") else ("EUCLIDEAN",):
                options = {**space, "feature": feature, "distance": metric}
                make = output_of("TexVoronoi", "Distance", cells, **options)
                yield f"Voronoi Texture/{dimensions} {feature} {metric}", NodeCase(make)
        make = output_of("TexVoronoi", "Radius", cells, feature="N_SPHERE_RADIUS", **space)
        yield f"Voronoi Texture/{dimensions} N-Sphere Radius", NodeCase(make, EDGES)
        for output in ("Color", "W" if dimensions in ("1D", "4D") else "Position"):
            make = output_of("TexVoronoi", output, cells, **space)
            yield f"Voronoi Texture/{dimensions} {output}", NodeCase(make, EDGES)
    for feature in ("F2", "SMOOTH_F1"):
        make = output_of("TexVoronoi", "Color", {"Scale": 3.0}, feature=feature)
        yield f"Voronoi Texture/{feature} Color", NodeCase(make, EDGES)
    yield from _lattices({**cells, "Detail": 2.5, "Roughness": 0.6, "Lacunarity": 2.2})


def _lattices(inputs: Mapping[Any, Any]) -> Iterator[tuple[str, NodeCase]]:
    """Voronoi's cells with finer ones on top."""
    features = (
        ("1D", "DISTANCE_TO_EDGE"),
        ("2D", "F1"),
        ("2D", "DISTANCE_TO_EDGE"),
        ("3D", "F2"),
        ("4D", "F1"),
    )
    for normalize in (True, False):
        how = "normalized" if normalize else "as it is"
        for dimensions, feature in features:
            options = {"voronoi_dimensions": dimensions, "feature": feature, "normalize": normalize}
            make = output_of("TexVoronoi", "Distance", inputs, **options)
            yield f"Voronoi Texture/{dimensions} {feature} Detail, {how}", NodeCase(make)
        for output in ("Color", "Position"):
            make = output_of("TexVoronoi", output, inputs, normalize=normalize)
            yield f"Voronoi Texture/{output} Detail, {how}", NodeCase(make, EDGES)


TEXTURES: dict[str, NodeCase] = dict(
    case for part in (_textures, _spaces, _noises, _cells) for case in part()
)
"""By the node's name and what is special."""
