"""The radiance of Blender's Sky Texture, as a picture of all directions with the sun's azimuth in the middle.

`single.py` is Blender's Single Scattering (Nishita before Blender 5.0), `multiple.py` its Multiple Scattering,
`preetham.py` and `hosek_wilkie.py` the older ones.
"""

from .hosek_wilkie import hosek_wilkie
from .model import HEIGHT, WIDTH, Air, Sun
from .multiple import multiple_scattering, multiple_sun
from .preetham import preetham
from .single import single_scattering, single_sun

__all__ = [
    "HEIGHT",
    "WIDTH",
    "Air",
    "Sun",
    "hosek_wilkie",
    "multiple_scattering",
    "multiple_sun",
    "preetham",
    "single_scattering",
    "single_sun",
]
