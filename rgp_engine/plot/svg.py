"""A drawing as SVG."""

from xml.sax.saxutils import escape, quoteattr

from .drawing import Box, Color, Disc, Drawing, Item, Line, Text

_FONT = "Inter, 'Helvetica Neue', Arial, sans-serif"


def to_svg(drawing: Drawing) -> str:
    """The drawing as a document that stands alone."""
    size = f'width="{drawing.width}" height="{drawing.height}"'
    head = f'<svg xmlns="http://www.w3.org/2000/svg" {size} viewBox="0 0 {drawing.width} {drawing.height}">'
    ground = f'<rect {size} fill="{_hex(drawing.ground)}"/>'
    group = f'<g font-family={quoteattr(_FONT)} stroke-linecap="round" stroke-linejoin="round">'
    return "\n".join([head, ground, group, *map(_element, drawing.items), "</g>", "</svg>", ""])


def _element(item: Item) -> str:
    if isinstance(item, Line):
        points = " ".join(f"{x:.2f},{y:.2f}" for x, y in item.points)
        dash = f' stroke-dasharray="{item.dash:g}"' if item.dash else ""
        stroke = f'stroke="{_hex(item.color)}" stroke-width="{item.width:g}"{dash}'
        return f'<polyline points="{points}" fill="none" {stroke}/>'
    if isinstance(item, Disc):
        x, y = item.center
        return f'<circle cx="{x:.2f}" cy="{y:.2f}" r="{item.radius:g}" fill="{_hex(item.color)}"/>'
    if isinstance(item, Box):
        (x, y), (width, height) = item.corner, item.size
        place = f'x="{x:.2f}" y="{y:.2f}" width="{width:.2f}" height="{height:.2f}"'
        return f'<rect {place} fill="{_hex(item.color)}"/>'
    return _text(item)


def _text(text: Text) -> str:
    x, y = text.at
    turn = f' transform="rotate(-90 {x:.2f} {y:.2f})"' if text.upwards else ""
    place = f'x="{x:.2f}" y="{y:.2f}" font-size="{text.size:g}" text-anchor="{text.anchor}"'
    return f'<text {place} fill="{_hex(text.color)}"{turn}>{escape(text.text)}</text>'


def _hex(color: Color) -> str:
    return "#{:02x}{:02x}{:02x}".format(*color)
