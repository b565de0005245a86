"""Why a feature does not agree, or is not compared. A reason counts only while its feature fails."""

EXCLUSIONS: dict[str, str] = {
    "path/rough_closed_room": "gather rays read the light that arrives at rough diffuse surfaces without its "
    "direction: right in the mean, but light does not return to where it came from",
    "path/coated_emitter": "Cycles has two answers: it dims emission under a coat where a ray meets it, not where it "
    "samples it as a light; here both are dimmed",
    "path/rough_glass_lamp": "Cycles also refracts the light of lamps it samples to where no facet can send it, so "
    "that rough glass is too bright; where it finds an emitter by chance both agree (path/rough_glass_emitter)",
}
"""By feature: known reasons for a difference."""

_AS_DIFFUSE = "not supported yet; Diffuse BSDF is used instead, with a warning"
_LEFT_OUT = "not supported yet; left out, with a warning"
_SUBSURFACE = "approximated: light leaves where it enters, as from Diffuse BSDF, with a warning"
_TYPICAL = "not supported yet; a typical value is used instead, with a warning"

NOT_RENDERED: dict[str, str] = {
    "shader/Sheen BSDF, Ashikhmin": "Microfiber is used instead, with a warning",
    "shader/Toon BSDF": _AS_DIFFUSE,
    "shader/Hair BSDF": _AS_DIFFUSE,
    "shader/Subsurface Scattering": f"{_SUBSURFACE}; on a ball of 0.8 m at Scale 0.05 the mean is within 0.5%, pixels "
    "differ by up to 4.4% (RMS) where light fades",
    "shader/Principled BSDF, Subsurface": f"{_SUBSURFACE}; on a ball of 0.8 m at Scale 0.05 the mean is "
    "within 0.7%, pixels differ by up to 3.2% (RMS) where light fades",
    "shader/Volume Scatter, Principled Volume, Volume Coefficients that scatter or emit": _LEFT_OUT,
    "shader/Volume Absorption that varies": _TYPICAL,
    "world/volumes": _LEFT_OUT,
    "shader/Metallic, Glossy, Glass and Refraction BSDF, distributions Beckmann and Ashikhmin-Shirley": "GGX is used "
    "instead, with a warning",
    "shader/Principled BSDF, Thin Film": _LEFT_OUT,
    "shader/Metallic BSDF, Physical Conductor": "not supported yet; F82 is used instead, with a warning",
    "lamp_node/light that nodes make negative": "counts as none; Cycles takes it away from other light",
    "lamp/spot of scale 0": "its cone has no width in either engine; left out, with a warning",
    "node/Image Texture, movies, and UDIM tiles in projections other than flat": _TYPICAL,
    "node/Mapping of type Texture, inputs that vary": _TYPICAL,
    "node/Texture Coordinate, Window of a fisheye with a lens polynomial": _TYPICAL,
    "node/Geometry, Pointiness": _TYPICAL,
    "node/Light Path, singular rays, lengths (but for Ray Length of lamps) and depths": _TYPICAL,
    "node/Image Texture, packed floats of straight alpha and packed bytes of premultiplied alpha": "as unpacked; "
    "Cycles shows them otherwise when they are packed",
    "node/Attribute of instances made by geometry nodes, before Blender 4.5": "properties of objects are used instead, "
    "with a warning",
    "node/Gabor Texture": _TYPICAL,
    "node/Vector Displacement": _LEFT_OUT,
}
"""By feature: what takes its place. The warning names material and node."""
