"""The settings that trade time for accuracy."""

from collections.abc import Mapping
from dataclasses import dataclass, fields
from typing import Any

Settings = Mapping[str, Mapping[str, Any]]
"""All settings as the core takes them: {group: {name: value}}."""

PLACES = {
    "finest": ("pyramid", "finest_resolution"),
    "bins": ("pyramid", "bins"),
    "photons": ("photon_pass", "photon_count"),
    "rays": ("gather", "rays"),
    "samples": ("gather", "camera_samples"),
}
"""Where each field of `Quality` stands among the settings."""

LIMITS = {"finest": (8, 1024), "photons": (1_000, 1_000_000_000), "rays": (1, 4096), "samples": (1, 1024)}
"""Least and greatest value that is measured."""


@dataclass(frozen=True, order=True)
class Quality:
    """One choice of them."""

    finest: int
    """Cells along the longest side of what is seen."""
    bins: str
    """Direction bins of glossy cells, such as "8x16"."""
    photons: int
    rays: int
    """Gather rays per pixel."""
    samples: int
    """Camera samples per pixel."""

    @classmethod
    def of(cls, settings: Settings) -> "Quality":
        """The choice that these settings make."""
        return cls(**{field: settings[group][name] for field, (group, name) in PLACES.items()})

    def settings(self) -> dict[str, Any]:
        """By full name, such as {"gather.rays": 256}."""
        return {f"{group}.{name}": getattr(self, field) for field, (group, name) in PLACES.items()}

    @classmethod
    def from_settings(cls, named: Mapping[str, Any]) -> "Quality":
        """The inverse of `settings`."""
        return cls(**{field: named[f"{group}.{name}"] for field, (group, name) in PLACES.items()})

    def put_into(self, settings: Settings) -> dict[str, dict[str, Any]]:
        """A copy of the settings with this choice."""
        changed = {group: dict(values) for group, values in settings.items()}
        for field, (group, name) in PLACES.items():
            changed[group][name] = getattr(self, field)
        return changed

    def scaled(self, field: str, factor: float) -> "Quality":
        """With one field multiplied, as far as its limits allow; bins by that factor in each direction."""
        if field == "bins":
            value: Any = "x".join(str(min(max(round(int(n) * factor), 1), 32)) for n in self.bins.split("x"))
        else:
            low, high = LIMITS[field]
            value = min(max(round(getattr(self, field) * factor), low), high)
        return Quality(**{f.name: value if f.name == field else getattr(self, f.name) for f in fields(self)})
