"""What differs in each scene and why, written by hand after looking at the pictures."""

NOTES = {
    "hdri_window": (
        "Nothing differs but noise, which is what this scene is for: walls that the picture of the sky lights "
        "through the window, without a portal."
    ),
    "awkward_cad": (
        "Nothing differs at a glance. In the pictures of Cycles the caustics of the knot of metal are sparks; "
        "ours come from the caustic map."
    ),
    "bevy_gi_hall": "Nothing differs at a glance. The walls have the distribution GGX, which loses light.",
    "cornell_original": (
        "Nothing differs at a glance. Both have sparks round the lamp: it is a closed box of emissive faces right "
        "below the ceiling, and what shines upwards lights the ceiling from 1 cm."
    ),
    "dupliverts_nested": (
        "Nothing differs. The view layer has Environment off, so that there is no light from the world; this file "
        "showed that it was not followed."
    ),
    "ignis_diamond": (
        "Our picture is brighter in the shadow and on the stand below the diamond: caustics, which in Cycles are "
        "sparks that are rarely found (and here clipped before they are compared). The rest differs by noise."
    ),
    "japanese_classroom": (
        "Nothing differs at a glance, both pictures are noisy: the room is lit by sun and sky through windows of "
        "glass, which in both engines is found by chance."
    ),
    "modern_hall": "Nothing differs at a glance.",
    "sibenik": (
        "Nothing differs at a glance but noise. Cells are coarse in the nave of 30 m, as the file has a ground of "
        "126 m round it."
    ),
    "veach_ajar": "Nothing differs but noise: light comes through a gap alone, and Cycles is as noisy as bright.",
    "water_caustic": (
        "**Our picture is several times brighter:** the lamp is a square of 5 mm, and nearly all light below the "
        "water is a caustic. Paths meet such a lamp behind glass next to never: Cycles misses the light at any "
        "number of samples that anyone waits for, `gather.estimator=path` as well, and ours comes from the "
        "caustic map. The mean of Cycles' picture is that of the few sparks it found, a sixth of ours in one run and "
        "twice ours in the next, so that the figures say nothing. With a lamp of 50 cm, which paths find, both engines "
        "agree within 1 % at the surface of the water. That surface was black in ours until smooth normals were "
        "turned where they mirror to below the surface: the file's normals all point straight up, whatever the "
        "waves do."
    ),
    "wooden_staircase": "Nothing differs at a glance. Cycles is noisier where the one lamp does not shine.",
}
