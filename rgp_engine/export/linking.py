"""Light linking: which objects a lamp or an emissive mesh lights, and which block its light.

As in Cycles, objects that no light tells apart are one set, and an emitter names the sets it means. What a collection
says is Blender's rule: where it includes any object, only those are meant; else all but those it excludes.
"""

from collections.abc import Iterator
from typing import Any

from ..report import ProblemLog

RECEIVER_SETS, BLOCKER_SETS = 32, 24
"""What the core can tell apart; the first set is of everything that no collection names."""


class _Meaning:
    """The objects a collection means, by their addresses."""

    def __init__(self, b_collection: Any) -> None:
        states: dict[str, set[int]] = {"INCLUDE": set(), "EXCLUDE": set()}
        for b_object, state in _members(b_collection):
            states[state].add(b_object.as_pointer())
        self.included, self.excluded = states["INCLUDE"], states["EXCLUDE"]

    def means(self, address: int | None) -> bool:
        """True for what is meant; None is an object that the collection does not name."""
        return address not in self.excluded and (not self.included or address in self.included)


def _members(b_collection: Any) -> Iterator[tuple[Any, str]]:
    """Objects of a collection and of those in it, each with what the collection it is in is told to do."""
    for b_object, b_settings in zip(b_collection.objects, b_collection.collection_objects, strict=True):
        yield b_object, b_settings.light_linking.link_state
    for b_child, b_settings in zip(b_collection.children, b_collection.collection_children, strict=True):
        yield from _inherited(b_child, b_settings.light_linking.link_state)


def _inherited(b_collection: Any, state: str) -> Iterator[tuple[Any, str]]:
    for b_object in b_collection.objects:
        yield b_object, state
    for b_child, b_settings in zip(b_collection.children, b_collection.collection_children, strict=True):
        yield from _inherited(b_child, b_settings.light_linking.link_state)


class _Sets:
    """Sets of objects that some collections tell apart."""

    def __init__(self, b_collections: list[Any], most: int, log: ProblemLog) -> None:
        self._meanings = {b.as_pointer(): _Meaning(b) for b in b_collections}
        self._numbers: dict[tuple[bool, ...], int] = {self._verdicts(None): 0}
        self._number_of: dict[int, int] = {}
        named = (meaning.included | meaning.excluded for meaning in self._meanings.values())
        for address in sorted(set[int]().union(*named)):
            verdicts = self._verdicts(address)
            if verdicts not in self._numbers and len(self._numbers) >= most:
                log.add(
                    "Scene", f"lights are linked to more than {most} sets of objects; not all are followed"
                )
                continue
            self._number_of[address] = self._numbers.setdefault(verdicts, len(self._numbers))

    def _verdicts(self, address: int | None) -> tuple[bool, ...]:
        return tuple(meaning.means(address) for meaning in self._meanings.values())

    def number(self, b_object: Any) -> int:
        """The set of an object."""
        return self._number_of.get(b_object.as_pointer(), 0)

    def mask(self, b_collection: Any) -> int:
        """A bit for each set that a collection means."""
        place = list(self._meanings).index(b_collection.as_pointer())
        return sum(1 << number for verdicts, number in self._numbers.items() if verdicts[place])


class Linking:
    """The links of a scene."""

    def __init__(self, b_depsgraph: Any, log: ProblemLog) -> None:
        b_links = [b_object.original.light_linking for b_object in b_depsgraph.objects]
        receivers = {b.receiver_collection for b in b_links} - {None}
        blockers = {b.blocker_collection for b in b_links} - {None}
        self.is_used = bool(receivers or blockers)
        """False where every light lights everything and everything blocks it."""
        self._receivers = _Sets(sorted(receivers, key=_name), RECEIVER_SETS, log)
        self._blockers = _Sets(sorted(blockers, key=_name), BLOCKER_SETS, log)

    def of_emitter(self, b_owner: Any) -> dict[str, Any]:
        """The core's LightLinks of an object that may emit, or of its instancer."""
        b_linking = b_owner.original.light_linking
        b_lit, b_blocking = b_linking.receiver_collection, b_linking.blocker_collection
        return {
            "receivers": (1 << RECEIVER_SETS) - 1 if b_lit is None else self._receivers.mask(b_lit),
            "blockers": None if b_blocking is None else self._blockers.mask(b_blocking),
        }

    def of_object(self, b_owner: Any) -> dict[str, Any]:
        """The core's ObjectLinks of an object, or of its instancer."""
        return {
            "receiver_set": self._receivers.number(b_owner.original),
            "blocker_set": self._blockers.number(b_owner.original),
            "light": self.of_emitter(b_owner),
        }


def _name(b_collection: Any) -> str:
    return str(b_collection.name_full)
