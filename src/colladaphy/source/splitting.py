"""Texts so short that every reader takes them, at its usual limits.

libxml2 refuses a text of more than ten million characters, and so do we, unless `Limits` says
otherwise. A comment ends a text without changing what it says, so that long lists of numbers are
written with a comment here and there, and what we write can be read under the usual limits.
"""

from __future__ import annotations

__all__ = ["with_short_texts"]

_LONGEST = 8_000_000
_BREAK = b"<!-- -->"
_WINDOW = 1 << 16
_BLANKS = (b" ", b"\n", b"\r", b"\t")


def with_short_texts(data: bytes, longest: int = _LONGEST) -> bytes:
    """A well-formed document whose texts have no more than about `longest` characters."""
    made: list[bytes] = []
    done = position = 0
    size, step = len(data), max(min(_WINDOW, longest // 2), 1)
    while position < size:
        # Where a window holds the start of a tag, no text is longer than two of them.
        if data.find(b"<", position, position + step) >= 0:
            position += step
            continue
        start, end = data.rfind(b"<", 0, position), data.find(b"<", position + step)
        end = size if end < 0 else end
        text = data.find(b">", max(start, 0), end) + 1
        is_text = start >= 0 and text > 0 and data[start + 1 : start + 2] not in (b"!", b"?")
        if is_text and end - text > longest:
            for cut in _cuts(data, text, end, longest):
                made += [data[done:cut], _BREAK]
                done = cut
        position = end
    return b"".join([*made, data[done:]]) if made else data


def _cuts(data: bytes, begin: int, end: int, longest: int) -> list[int]:
    """Places in a text that are not within a reference or a letter; before blanks, if there are."""
    cuts = []
    at = begin
    while end - at > longest:
        cut = max(data.rfind(blank, at + 1, at + longest) for blank in _BLANKS)
        cut = at + longest if cut < 0 else cut
        reference = data.rfind(b"&", max(at, cut - 16), cut)
        if reference >= 0 and data.find(b";", reference, cut) < 0:
            cut = reference
        while cut > at and data[cut] & 0xC0 == 0x80:
            cut -= 1
        if cut <= at:
            break
        cuts.append(cut)
        at = cut
    return cuts
