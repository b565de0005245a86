"""What moves while the shutter is open: the scene when it opens, and when it is shut, beside the middle of its time."""

import hashlib
import math
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from typing import Any

import numpy as np
import numpy.typing as npt

from .camera import camera_view
from .context import ExportContext
from .coordinates import mark_infinite, matrix_array

_STEPS = (-0.5, 0.5)
"""Times besides the middle, in shutter times from it: as many before as after."""
_MIDDLES = {"START": 0.5, "CENTER": 0.0, "END": -0.5}
"""Of the shutter's time from the frame, in shutter times, for each shutter position."""
_CURVE_POINTS = 257

_Key = tuple[Any, ...]


@dataclass
class Shutter:
    """When it is open, in frames."""

    frame: float
    """The frame that is rendered."""
    middle: float
    """Of the time it is open."""
    steps: tuple[float, ...]
    """Times besides the middle."""


def shutter(b_depsgraph: Any) -> Shutter | None:
    """The shutter of a scene with motion blur; None without."""
    b_scene = b_depsgraph.scene_eval
    b_render = b_scene.render
    wanted = b_render.use_motion_blur and b_scene.rgp.effects.motion_blur != "off"
    in_layer = b_depsgraph.view_layer_eval.use_motion_blur
    if not (wanted and in_layer) or b_render.motion_blur_shutter <= 0.0:
        return None
    frame, length = b_scene.frame_current + b_scene.frame_subframe, b_render.motion_blur_shutter
    middle = frame + _MIDDLES[b_render.motion_blur_position] * length
    return Shutter(frame, middle, tuple(middle + step * length for step in _STEPS))


def shutter_curve(b_scene: Any) -> list[float]:
    """How open the shutter is at even times; empty where that is all the same."""
    b_mapping = b_scene.render.motion_blur_shutter_curve
    b_mapping.initialize()
    b_curve = b_mapping.curves[0]
    times = np.linspace(0.0, 1.0, _CURVE_POINTS)
    values = [max(b_mapping.evaluate(b_curve, time), 0.0) for time in times]
    return [] if min(values) == max(values) else values


@contextmanager
def at_middle(context: ExportContext, times: Shutter) -> Iterator[None]:
    """The scene as in the middle of the shutter's time; afterwards it is again at the frame that is rendered."""
    try:
        if times.middle != times.frame:
            _go_to(context, times.middle)
        yield
    finally:
        _go_to(context, times.frame)


@dataclass
class Placed:
    """An object of the core's, as it is in the middle of the shutter's time."""

    index: int
    mesh: int
    matrix: npt.NDArray[np.float64]
    name: str
    deforms: bool
    """Changes of its shape are blurred."""


@dataclass
class Shape:
    """A mesh at one time. Digests tell whether it is the same at another."""

    name: str
    topology: bytes
    digest: bytes
    positions: npt.NDArray[np.float32] | None
    """Of a step whose shape is another than in the middle."""


class Moving:
    """Objects that may move while the shutter is open, as they are in the middle of its time."""

    def __init__(self) -> None:
        self.placed: dict[_Key, Placed | None] = {}
        """None for those that cannot be told apart at other times."""
        self.shapes: dict[int, Shape] = {}
        """Meshes, by index in the builder."""

    def note(self, b_instance: Any, index: int, mesh: int) -> None:
        """Keeps what must be known to find an object that was just exported at another time."""
        if not _toggles(b_instance, "use_motion_blur"):
            return
        key = _key(b_instance)
        if key in self.placed:
            self.placed[key] = None
            return
        b_object, matrix = b_instance.object, matrix_array(b_instance.matrix_world)
        deforms = _toggles(b_instance, "use_deform_motion")
        self.placed[key] = Placed(index, mesh, matrix, b_object.name, deforms)
        if deforms and mesh not in self.shapes:
            self.shapes[mesh] = _shape(b_object, None)

    def export(self, context: ExportContext, camera: dict[str, Any], times: Shutter) -> None:
        """Hands the core where objects and vertices are at the shutter's steps, and completes the camera's record.
        Leaves the scene at the last of them."""
        steps = []
        for time in times.steps:
            _go_to(context, time)
            steps.append(self._step(context))
        _hand_over_camera(camera, steps)
        camera["shutter"] = shutter_curve(context.b_depsgraph.scene_eval)
        for key, placed in self.placed.items():
            if placed is not None:
                _hand_over_object(context, placed, [step.matrices.get(key) for step in steps])
        for index, shape in self.shapes.items():
            _hand_over_mesh(context, index, shape, [step.shapes.get(index) for step in steps])

    def _step(self, context: ExportContext) -> "_Step":
        """The scene as it is now."""
        step = _Step(camera_view(context))
        for b_instance in context.b_depsgraph.object_instances:
            b_object = b_instance.object
            context.tick(f"motion of {b_object.name}")
            placed = self.placed.get(_key(b_instance)) if b_object.type == "MESH" else None
            if placed is None:
                continue
            step.matrices[_key(b_instance)] = matrix_array(b_instance.matrix_world)
            if placed.deforms and placed.mesh not in step.shapes:
                step.shapes[placed.mesh] = _shape(b_object, self.shapes[placed.mesh])
        return step


def _toggles(b_instance: Any, name: str) -> bool:
    """A switch of the object and of its instancer. They are Cycles' and gone when its add-on is disabled."""
    b_owners = [b_instance.object, b_instance.parent]
    groups = [getattr(b_owner, "cycles", None) for b_owner in b_owners if b_owner is not None]
    return all(getattr(b_group, name, True) for b_group in groups)


def _key(b_instance: Any) -> _Key:
    """What an instance is known by at every time: names and addresses of evaluated things change."""
    b_parent = b_instance.parent
    parent = b_parent.original.as_pointer() if b_parent is not None else 0
    return (b_instance.object.original.as_pointer(), parent, *b_instance.persistent_id)


@dataclass
class _Step:
    """Everything that was exported, at one other time."""

    camera: tuple[list[list[float]], list[float]]
    matrices: dict[_Key, npt.NDArray[np.float64]] = field(default_factory=dict)
    shapes: dict[int, Shape] = field(default_factory=dict)


def _shape(b_object: Any, middle: Shape | None) -> Shape:
    """The object's mesh now; its positions are kept where they differ from the middle's."""
    attributes = b_object.data.attributes
    positions = np.empty((len(b_object.data.vertices), 3), np.float32)
    corners = np.empty(len(b_object.data.loops), np.int32)
    if len(corners):
        attributes["position"].data.foreach_get("vector", positions.reshape(-1))
        attributes[".corner_vert"].data.foreach_get("value", corners)
    digest, topology = _digest(positions), _digest(corners) + str(len(positions)).encode()
    differs = middle is not None and digest != middle.digest
    return Shape(b_object.name, topology, digest, mark_infinite(positions) if differs else None)


def _digest(array: npt.NDArray[Any]) -> bytes:
    return hashlib.blake2b(array.tobytes(), digest_size=16).digest()


def _go_to(context: ExportContext, time: float) -> None:
    frame = math.floor(time)
    context.engine.frame_set(frame, subframe=time - frame)


def _hand_over_camera(camera: dict[str, Any], steps: list[_Step]) -> None:
    middle = (camera["world_from_camera"], camera["window"])
    views = [step.camera for step in steps]
    if camera["projection"]["kind"] not in ("perspective", "orthographic"):
        # As in Cycles, changes of what a panorama shows are not blurred.
        views = [(matrix, camera["window"]) for matrix, _ in views]
    if any(view != middle for view in views):
        camera["steps"] = [{"world_from_camera": matrix, "window": window} for matrix, window in views]


def _hand_over_object(
    context: ExportContext, placed: Placed, found: list[npt.NDArray[np.float64] | None]
) -> None:
    matrices = [matrix for matrix in found if matrix is not None]
    if len(matrices) < len(found):
        context.log.add(
            placed.name, "it is not there all the time the shutter is open; its motion is not blurred"
        )
    elif any(not np.array_equal(matrix, placed.matrix) for matrix in matrices):
        context.builder.set_object_motion(placed.index, np.array(matrices))


def _hand_over_mesh(context: ExportContext, index: int, shape: Shape, steps: list[Shape | None]) -> None:
    found = [step for step in steps if step is not None]
    if any(step.topology != shape.topology for step in found):
        context.log.add(
            shape.name,
            "its mesh has other vertices or faces at other times; changes of its shape are not blurred",
        )
    elif len(found) == len(steps) and any(step.positions is not None for step in found):
        context.builder.set_mesh_motion(index, [step.positions for step in found])
