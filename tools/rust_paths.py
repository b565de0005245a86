"""Finds which top-level modules of its own crate a Rust file names. Knows comments, strings and `use` trees."""

from __future__ import annotations

import re
from collections.abc import Iterator

_OPAQUE = re.compile(
    r"""//[^\n]*                      # comment to the end of the line
      | \bb?r(?P<hashes>\#*)".*?"(?P=hashes)   # raw string
      | "(?:\\.|[^"\\])*"             # string
      | '(?:\\[^\n]*?|[^'\\\n])'      # character; a lifetime has no closing quote
    """,
    re.VERBOSE | re.DOTALL,
)
_BLOCK_COMMENT = re.compile(r"/\*(?:(?!/\*|\*/).)*\*/", re.DOTALL)
_ROOT = re.compile(r"(?<![\w:])(?:\$?crate\s*::|(?P<supers>(?:super\s*::\s*)+))\s*")
_NAME = re.compile(r"\s*(?:r#)?([A-Za-z_]\w*)")


def blank(text: str) -> str:
    """The source with comments and literals made empty; line numbers stay."""

    def lines_only(match: re.Match[str]) -> str:
        return "\n" * match[0].count("\n")

    text = _OPAQUE.sub(lambda match: lines_only(match) or " ", text)
    while _BLOCK_COMMENT.search(text):
        text = _BLOCK_COMMENT.sub(lines_only, text)
    return text


def crate_modules(text: str, depth: int) -> Iterator[tuple[int, str]]:
    """(line, name) of every `crate::name` in a file that lies `depth` modules below the crate's root.

    `super::` chains that climb to the root count too; `crate::{a, b::c}` gives both `a` and `b`.
    """
    source = blank(text)
    for match in _ROOT.finditer(source):
        if match["supers"] and match["supers"].count("super") < depth:
            continue
        line = source.count("\n", 0, match.start()) + 1
        for name in _first_names(source, match.end()):
            yield line, name


def _first_names(source: str, start: int) -> Iterator[str]:
    """The first name of every path in the `use` tree, or the one path, that starts there."""
    if not source.startswith("{", start):
        if match := _NAME.match(source, start):
            yield match[1]
        return
    nesting = 0
    for position in range(start, len(source)):
        character = source[position]
        nesting += (character == "{") - (character == "}")
        if nesting == 0:
            return
        if nesting == 1 and character in "{," and (match := _NAME.match(source, position + 1)):
            yield match[1]
