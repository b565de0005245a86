"""The radiance of Blender's Sky Texture, as a picture of all directions with the sun's azimuth in the middle.

`single.py` is Blender's Single Scattering (Nishita before Blender 5.0), `multiple.py` its Multiple Scattering,
`preetham.py` the oldest one.
"""

from .model import HEIGHT, WIDTH, Air, Sun
from .multiple import multiple_scattering, multiple_sun
from .preetham import preetham
from .single import single_scattering, single_sun

__all__ = [
    "HEIGHT",
    "WIDTH",
    "Air",
    "Sun",
    "multiple_scattering",
    "multiple_sun",
    "preetham",
    "single_scattering",
    "single_sun",
]
