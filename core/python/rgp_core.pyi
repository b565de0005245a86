"""Native core of RGP Engine. World space, metres, watts; see the renderer's `scene/record.rs` for every record."""

from typing import Any, final

import numpy as np
import numpy.typing as npt

__version__: str

class RenderError(Exception):
    """A render that cannot be made; the message is for the artist."""

class SceneError(RenderError):
    """A scene that cannot be rendered: no camera, nothing in it, a record that does not make sense."""

class SettingsError(RenderError, ValueError):
    """An unknown setting or a value out of range; the message lists what exists."""

class EmbreeError(RenderError):
    """The Embree library is missing, of another version, or failed."""

def settings_schema() -> list[dict[str, Any]]:
    """Every setting: {group, name, type ("int" | "float" | "bool" | "enum" | "bins"), default, minimum, maximum,
    choices, unit, description}. Fields that do not apply are None."""

def check_settings(settings: dict[str, dict[str, Any]]) -> None:
    """Raises SettingsError when a group, a name or a value is not allowed."""

def embree_version(embree_library: str) -> str:
    """Version of the Embree library at that path, such as "4.4.0". Raises EmbreeError."""

def hosek_wilkie(elevation: float, turbidity: float, albedo: float) -> list[tuple[list[float], float]]:
    """What the sky model of Hosek and Wilkie 2012 tabulates for each of red, green and blue: nine parameters of the
    distribution, and the mean radiance that it is multiplied by. elevation of the sun 0 to π/2 rad, turbidity 1 to 10,
    albedo 0 to 1; raises ValueError beyond."""

def trace_floor(scene: Scene, settings: dict[str, dict[str, Any]], embree_library: str) -> dict[str, Any]:
    """Gather rays of a render traced one by one, without shading: {"rays", "seconds"}. What a gather is measured by."""

@final
class SceneBuilder:
    """Takes the parts of a scene in any order; `finish` checks them once. Methods return the part's index."""

    def __new__(cls) -> SceneBuilder: ...
    def add_material(self, record: dict[str, Any]) -> int:
        """`{"name", "closures": [{"weight": [r, g, b], "closure": {"kind": ..., ...}}], "program": {"instructions",
        "outputs", "normal"}}`; without `program` every input is the constant in its closure."""

    def add_texture(
        self, name: str, pixels: npt.NDArray[np.uint8] | npt.NDArray[np.float32], encoding: str
    ) -> int:
        """pixels (height, width, 4), rows from the bottom, the color multiplied by alpha; encoding "srgb" or "linear"."""

    def add_mesh(
        self,
        name: str,
        positions: npt.NDArray[np.float32],
        triangles: npt.NDArray[np.uint32],
        corner_normals: npt.NDArray[np.float32] | None = None,
        layers: list[tuple[int, npt.NDArray[np.float32]]] | None = None,
        slots: npt.NDArray[np.uint16] | None = None,
    ) -> int:
        """positions (V, 3); triangles (T, 3); corner_normals (T, 3, 3), None for flat shading; layers are the number of an
        attribute and its values (T, 3, 1 to 4); slots (T,). Wrong shapes raise SceneError; bad values are dropped and reported as problems."""

    def add_object(
        self,
        name: str,
        mesh: int,
        world_from_object: npt.NDArray[np.float64],
        materials: list[int],
        visibility: int,
    ) -> int:
        """world_from_object (4, 4), as Blender's matrix_world; `materials` one per slot (empty: Blender's default grey)."""

    def set_object_info(self, index: int, record: dict[str, Any]) -> None:
        """What materials may ask about an object: `{"color": [r, g, b, a], "index", "random"}`."""

    def set_object_links(self, index: int, record: dict[str, Any]) -> None:
        """Light linking: `{"receiver_set", "blocker_set", "light": {"receivers", "blockers"}}`; sets are numbers below 32 and
        24, `receivers` and `blockers` (or None: everything) have a bit for each set that an emitter lights or is blocked by."""

    def set_object_motion(self, index: int, steps: npt.NDArray[np.float64]) -> None:
        """world_from_object at even times while the shutter is open, from when it opens until it is shut, the middle left
        out: (N, 4, 4), N even."""

    def set_mesh_motion(self, index: int, steps: list[npt.NDArray[np.float32] | None]) -> None:
        """Positions at such times, (V, 3) each; None where they are those of the mesh."""

    def add_lamp(self, record: dict[str, Any]) -> int: ...
    def set_camera(self, record: dict[str, Any]) -> None: ...
    def set_world(self, record: dict[str, Any]) -> None: ...
    def finish(self) -> Scene:
        """Checks everything and moves it out; the builder is empty afterwards. Raises SceneError."""

@final
class Scene:
    """A checked scene. Immutable; can be rendered any number of times."""

    @property
    def problems(self) -> list[dict[str, Any]]:
        """[{"subject", "message", "count"}]."""

    @property
    def triangle_count(self) -> int:
        """Triangles that are traced, instances counted once per object."""

@final
class Session:
    """One render, on threads of its own. Nothing here holds the GIL while it waits."""

    def __new__(cls, scene: Scene, settings: dict[str, dict[str, Any]], embree_library: str) -> Session: ...
    def fingerprint(self) -> str:
        """Hexadecimal digits that two sessions share only if they make the same picture. All of the scene is read for them."""

    def film_state(self) -> tuple[int, npt.NDArray[np.float32]] | None:
        """Passes that are complete, and their sums (2, H, W, N), to go on from in another session; None where the last pass
        was cut short."""

    def restore_film(self, passes: int, sums: npt.NDArray[np.float32]) -> None:
        """Before the start: takes up the passes of an earlier session of the same fingerprint. Raises RenderError when they
        are of a picture of another size."""

    def start(self) -> None: ...
    def cancel(self) -> None:
        """Asks the render to stop; returns at once. What is finished stays readable."""

    def wait(self, timeout_seconds: float) -> bool:
        """True once the render has ended: finished, cancelled or failed."""

    def progress(self) -> dict[str, Any]:
        """{"stage", "fraction", "passes_done", "passes_total", "seconds_elapsed", "seconds_left", "error", "error_at_end",
        "seconds_to_target", "memory_bytes"}; seconds_left, error (% of the picture's mean) and error_at_end are None while
        unknown, seconds_to_target also where there is no target or it will not be reached."""

    def picture(self, layer: str) -> npt.NDArray[np.float32]:
        """Mean of the passes so far, rows from the bottom: "combined" (H, W, 4), "indirect" (H, W, 3),
        "shadow_catcher" (H, W, 3); "error" (H, W, 1) is the standard error of combined; "audit" (H, W, 1) the part of the light that an audit found wrong,
        from -1 (all is missing) to 1 (there should be none), 0 where nothing is known to be wrong."""

    def stats(self) -> dict[str, Any]:
        """The stats file's content, less what only the host knows (seconds.export, versions of Blender)."""

    def finish(self) -> bool:
        """Joins the render. True when it ran to its end, False when it was cancelled; raises RenderError when it failed."""
