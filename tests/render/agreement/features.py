"""What is compared: every node, every kind of lamp, every simple material, and ways of light."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial

import bpy

from tests.render import (
    cases,
    catcher_cases,
    lamp_node_cases,
    linking_cases,
    motion_cases,
    node_cases,
    node_scene,
    panorama_cases,
    path_cases,
    thin_wall_cases,
    world_cases,
)


@dataclass(frozen=True)
class Feature:
    """One thing that both engines should show alike, alone in a scene."""

    name: str
    """Its group and its own name, such as `lamp/sun`."""
    build: Callable[[], bpy.types.Scene]
    box_filter: bool = False


def features() -> list[Feature]:
    """All that are compared, group by group."""
    return [
        *(Feature(case, partial(cases.build, case)) for case in cases.CASES),
        *(
            Feature(f"lamp_node/{name}", partial(lamp_node_cases.build, name))
            for name in lamp_node_cases.LAMPS
        ),
        *(Feature(f"world/{name}", partial(world_cases.build, name)) for name in world_cases.WORLDS),
        *(Feature(f"path/{name}", partial(path_cases.build, name)) for name in path_cases.PATHS),
        *(
            Feature(f"thin_wall/{name}", partial(thin_wall_cases.build, name))
            for name in thin_wall_cases.THIN_WALLS
        ),
        *(Feature(f"motion/{name}", partial(motion_cases.build, name)) for name in motion_cases.MOTIONS),
        *(
            Feature(f"node/{name}", partial(node_scene.node_scene, case), box_filter=True)
            for name, case in node_cases.NODES.items()
        ),
        *(Feature(f"linking/{name}", partial(linking_cases.build, name)) for name in linking_cases.LINKINGS),
        *(Feature(f"catcher/{name}", partial(catcher_cases.build, name)) for name in catcher_cases.CATCHERS),
        *(
            # Filters reach beyond the frame, where a place in the picture may start anew.
            Feature(f"panorama/{name}", partial(panorama_cases.build, name), "window" in name)
            for name in panorama_cases.PANORAMAS
        ),
    ]
