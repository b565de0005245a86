"""Plots drawn without any library but numpy: a chart becomes a drawing, a drawing becomes SVG or PNG."""

from .chart import Axis, Chart, Label, Level, Series, draw_chart
from .drawing import Drawing, Text
from .font import text_width
from .png import Pixels, write_png
from .raster import rasterize
from .scale import number_text
from .svg import to_svg

__all__ = [
    "Axis",
    "Chart",
    "Drawing",
    "Label",
    "Level",
    "Pixels",
    "Series",
    "Text",
    "draw_chart",
    "number_text",
    "rasterize",
    "text_width",
    "to_svg",
    "write_png",
]
