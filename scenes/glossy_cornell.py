"""The Cornell box with a block of rough metal and a block of coated plastic.

GGX alpha is the square of Blender's roughness: 0.30 for the metal and 0.49 under the coat are wide lobes, the coat's
0.04 is a sharp one.
"""

from __future__ import annotations

from scenes import common, cornell_box


def build() -> None:
    """Room, lamp and camera of the Cornell box; the tall block metal, the short one coated plastic."""
    common.start_empty_file()
    metal = common.principled_material(
        "Rough metal", Base_Color=(0.9, 0.78, 0.5), Metallic=1.0, Roughness=0.55
    )
    plastic = common.principled_material(
        "Coated plastic",
        Base_Color=(0.1, 0.25, 0.6),
        Roughness=0.7,
        Coat_Weight=1.0,
        Coat_Roughness=0.2,
    )
    cornell_box.build_room(plastic, metal, common.diffuse_material("White", cornell_box.WHITE))
