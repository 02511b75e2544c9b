"""Many short texts at once: from ranges of bytes to strings, numbers and truth values.

A text is copied eight bytes at a time into a row of words as wide as the longest, so that whole
arrays are masked, compared and joined. Numbers go through a JSON parser, the fastest way from text
to floats there is here; what JSON does not spell as XML Schema does (INF, 1., +1, more blanks) is
read word by word.
"""

from __future__ import annotations

import re
import struct
from typing import Any, Final

import numpy as np
import orjson
from numpy.typing import NDArray

from colladaphy.columns.spans import places_of
from colladaphy.columns.words import LOW, Words

__all__ = [
    "Ranges",
    "boolean_lists_of",
    "booleans_of",
    "floats_of",
    "integers_of",
    "plain_numbers_of",
    "strings_of",
    "words_of",
]

Array = NDArray[Any]
U = np.uint64

_WIDEST = 96
"""Bytes of a text up to which a row of words for each is not wasteful."""
_PART = 1 << 13
"""Texts that are turned into numbers together, so that Python's objects for them are reused."""
_END = 1
"""A byte that no document holds, behind each text."""
_BLANK_BYTES = b" \t\n\r"


class Ranges:
    """Ranges of the bytes of a document, one a text."""

    __slots__ = ("all_words", "starts", "stops")

    def __init__(self, words: Words, starts: Array, stops: Array) -> None:
        self.all_words = words
        self.starts = starts
        self.stops = stops

    def __len__(self) -> int:
        return len(self.starts)

    def part(self, begin: int, end: int) -> Ranges:
        """Some of them, one after the other."""
        return Ranges(self.all_words, self.starts[begin:end], self.stops[begin:end])

    def take(self, rows: Array) -> Ranges:
        """Those of some rows."""
        return Ranges(self.all_words, self.starts[rows], self.stops[rows])

    def texts(self) -> list[bytes]:
        """The bytes of each, one by one."""
        data = self.all_words.data.data
        return [
            bytes(data[start:stop])
            for start, stop in zip(self.starts.tolist(), self.stops.tolist(), strict=True)
        ]

    def words(self, extra: int = 0) -> tuple[Array, Array] | None:
        """(n, k) words that hold the texts, zeros behind them, and their lengths; None if too wide.

        `extra` bytes at least are free behind the longest.
        """
        lengths = self.stops - self.starts
        longest = int(lengths.max(initial=0))
        if longest > _WIDEST and longest * len(lengths) > 4 * int(lengths.sum()) + 4096:
            return None
        count = (longest + extra + 7) // 8
        words = np.zeros((len(lengths), count), U)
        starts = self.starts.astype(np.int64, copy=False)
        if not len(starts) or not longest:
            return words, lengths
        if len(lengths) < longest >> 3:  # few long ones, which are copied as they are
            letters, data = words.view(np.uint8), self.all_words.data
            for row, (start, stop) in enumerate(
                zip(starts.tolist(), self.stops.tolist(), strict=True)
            ):
                letters[row, : stop - start] = data[start:stop]
            return words, lengths
        shortest = int(lengths.min())
        for place in range(0, longest, 8):
            word = self.all_words.at(starts + place if place else starts)
            if shortest < place + 8:
                word &= LOW[np.clip(lengths - place, 0, 8)]
            words[:, place >> 3] = word
        return words, lengths

    def joined(self, separator: int) -> bytes:
        """All texts, each followed by a separator; bytes of zero in them are left out."""
        made = self.words(1)
        if made is None:
            return b"".join(text + bytes([separator]) for text in self.texts()).replace(b"\0", b"")
        words, lengths = made
        letters = words.view(np.uint8).reshape(-1)
        letters[np.arange(len(lengths)) * (words.shape[1] * 8) + lengths] = separator
        return letters.tobytes().translate(None, b"\0")

    def all_equal(self) -> bool:
        """Whether all texts are the same, as far as is seen at once."""
        count = len(self)
        if count < 2:
            return count == 1
        lengths = self.stops - self.starts
        if lengths[0] != lengths[-1] or int(lengths[0]) > _WIDEST:
            return False
        if self.part(0, 1).texts() != self.part(count - 1, count).texts():
            return False
        if not bool(np.all(lengths == lengths[0])):
            return False
        made = self.words()
        return made is not None and bool(np.all(made[0] == made[0][0]))


def strings_of(ranges: Ranges, kind: str, *, attribute: bool, entities: bool) -> list[str]:
    """The texts as strings; `kind` says what becomes of white space.

    `entities` says that references such as &amp; have to be looked for.
    """
    if not len(ranges):
        return []
    blob = ranges.joined(_END)
    texts = blob.decode("utf-8").split(chr(_END))
    texts.pop()
    if b"\r" in blob:
        texts = [text.replace("\r\n", "\n").replace("\r", "\n") for text in texts]
    blanks = any(blank in blob for blank in (b" ", b"\t", b"\n", b"\r"))
    if attribute and blanks:
        texts = [text.translate(_FLAT) for text in texts]
    if entities and b"&" in blob:
        texts = [_resolved(text) if "&" in text else text for text in texts]
        blanks = True
    if blanks:
        if kind in ("token", "name", "datetime", "hex", "base64"):
            collapse = kind == "token"
            texts = [
                " ".join(words_of(text)) if collapse else text.strip(" \t\n\r") for text in texts
            ]
        elif kind == "normalized":
            texts = [text.translate(_FLAT) for text in texts]
    return texts


def words_of(text: str) -> list[str]:
    """What XML's blanks separate (str.split knows others, too)."""
    return [word for word in text.translate(_FLAT).split(" ") if word]


_FLAT = str.maketrans("\t\n\r", "   ")
_NAMED = {"lt": "<", "gt": ">", "amp": "&", "quot": '"', "apos": "'"}


def _resolved(text: str) -> str:
    """Predefined entities and references to characters; no others can be in a document."""
    parts = text.split("&")
    for place, part in enumerate(parts[1:], 1):
        name, _, rest = part.partition(";")
        if name.startswith("#x"):
            parts[place] = chr(int(name[2:], 16)) + rest
        elif name.startswith("#"):
            parts[place] = chr(int(name[1:])) + rest
        else:
            parts[place] = _NAMED[name] + rest
    return "".join(parts)


def _words_of(text: bytes) -> list[bytes]:
    text = text.replace(b"\0", b"")
    if b"&" in text:
        text = _resolved(text.decode()).encode()
    return text.split()


def floats_of(ranges: Ranges, width: int | None) -> tuple[Array, Array | None]:
    """All numbers in the texts, and how many are in each (None: the same count in all).

    `width` is how many there are in each, if that is known; it is not looked at then.
    """
    return _numbers(ranges, np.float64, float, width)


def integers_of(ranges: Ranges, width: int | None) -> tuple[Array, Array | None]:
    """The same for integers; those beyond 64 bits make an array of Python's integers."""
    return _numbers(ranges, np.int64, int, width)


def _numbers(
    ranges: Ranges, dtype: Any, parse: Any, width: int | None
) -> tuple[Array, Array | None]:
    if not len(ranges):
        return np.zeros(0, dtype), None
    if dtype is np.float64 and (known := _known(ranges)) is not None:
        return known
    if len(ranges) > 1 and ranges.all_equal():
        one, _ = _part(ranges.part(0, 1), dtype, parse, width)
        return np.tile(one, len(ranges)), None
    values: list[Array] = []
    counts: list[Array] = []
    for begin in range(0, len(ranges), _PART):
        numbers, count = _part(ranges.part(begin, begin + _PART), dtype, parse, width)
        values.append(numbers)
        if count is not None:
            counts.append(count)
    found = values[0] if len(values) == 1 else np.concatenate(values)
    if width is not None:
        return found, None
    every = np.concatenate(counts)
    return found, None if bool(np.all(every == every[0])) else every


def _known(ranges: Ranges) -> tuple[Array, Array | None] | None:
    """What was remembered of some texts, and what they have beyond; None if nothing was."""
    words = ranges.all_words
    if (kept := words.kept(ranges.starts)) is not None:
        values, counts = kept
        return values, None if counts is None or bool(np.all(counts == counts[0])) else counts
    parts = words.kept_of_some(ranges.starts)
    if not parts:
        return None
    rest = np.ones(len(ranges), np.bool_)
    for rows, _, _ in parts:
        rest[rows] = False
    others = np.flatnonzero(rest)
    if len(others):
        parts.append((others, *_numbers(ranges.take(others), np.float64, float, None)))
    counts = np.empty(len(ranges), np.int64)
    for rows, numbers, every in parts:
        counts[rows] = len(numbers) // len(rows) if every is None else every
    ends = np.cumsum(counts)
    starts = ends - counts
    values = np.empty(int(ends[-1]))
    for rows, numbers, _ in parts:
        values[places_of(starts[rows], counts[rows])] = numbers
    return values, None if bool(np.all(counts == counts[0])) else counts


def _part(ranges: Ranges, dtype: Any, parse: Any, width: int | None) -> tuple[Array, Array | None]:
    """The numbers in some texts, and how many each has."""
    text = _json(ranges, width)
    if text is not None:
        made = _parsed(text[0], "d" if dtype is np.float64 else "q")
        if made is not None:
            return made, text[1]
    words = [_words_of(each) for each in ranges.texts()]
    flat = [parse(word) for each in words for word in each]
    counts = np.array([len(each) for each in words], dtype=np.int64)
    if dtype is np.float64:
        return np.array(flat, dtype=np.float64), counts
    try:
        return np.array(flat, dtype=np.int64), counts
    except OverflowError:
        return np.array(flat, dtype=object), counts


def plain_numbers_of(ranges: Ranges, width: int | None) -> tuple[Array, Array | None] | None:
    """Lists of numbers, and how many each has; None where any is spelled unlike JSON's.

    Where a `width` is given, None too if any list has another, and no numbers of them if not.
    """
    text = _json(ranges, 1 if width == 1 else None)
    if text is None or b"u" in text[0] or b"l" in text[0]:  # true, false, null
        return None
    made = _parsed(text[0], "d")
    if made is None:
        return None
    counts = text[1]
    # More numbers than blanks tell of are parted by commas.
    if len(made) != (len(ranges) if counts is None else int(counts.sum())):
        return None
    if width is not None and counts is not None and bool(np.any(counts != width)):
        return None
    return made, counts


def _parsed(text: bytes, kind: str) -> Array | None:
    """The numbers of a JSON list; None where a number is not spelled as JSON has it."""
    try:
        numbers = orjson.loads(text)
        # The quickest way from a list of numbers to an array.
        made = np.frombuffer(struct.pack(f"{len(numbers)}{kind}", *numbers), kind)
    except (ValueError, struct.error, TypeError, OverflowError):
        return None
    if kind == "d" and not bool(np.all(made)) and b"-0" in text:
        # To JSON, -0 is an integer, which has no sign.
        fresh = _NEGATIVE_ZERO.sub(b"-0.0", text)
        if fresh != text:
            return _parsed(fresh, kind)
    return made


_NEGATIVE_ZERO = re.compile(rb"-0(?=[, \]])")


def _json(ranges: Ranges, width: int | None) -> tuple[bytes, Array | None] | None:
    """The texts as one JSON list, and how many numbers each has; None where that would be wrong.

    The numbers are not counted where `width` says how many there are.
    """
    made = ranges.words(1)
    if made is None:
        return _long_json(ranges)
    words, lengths = made
    if not bool(np.all(lengths)):
        return None
    counts = _blanks(words) + 1 if width is None else None
    letters = words.view(np.uint8)
    letters.reshape(-1)[np.arange(len(lengths)) * letters.shape[1] + lengths] = _COMMA
    text = letters.tobytes().translate(_TO_JSON).rstrip(b" ")
    return b"[%b]" % text[:-1], counts


def _blanks(words: Array) -> Array:
    """How many blanks are in each row (n,) of words (n, k)."""
    # Bytes that are 0x20, or 9 to 13 (of which XML allows blanks only), have their top bit set.
    low = words & _SEVENS
    space = ((low ^ _SPACES) + _SEVENS) | words
    line = ((low + _FROM_9) & ~(low + _FROM_14)) & ~words
    found = np.bitwise_count((~space | line) & _TOPS)
    return np.asarray(found.sum(axis=1, dtype=np.int64))


_BYTES: Final = 0x0101010101010101
_SEVENS, _TOPS, _SPACES = U(0x7F * _BYTES), U(0x80 * _BYTES), U(0x20 * _BYTES)
_FROM_9, _FROM_14 = U((128 - 9) * _BYTES), U((128 - 14) * _BYTES)
_COMMA: Final = 44
# What stands behind the texts, zeros, are the blanks of JSON.
_TO_JSON: Final = bytes.maketrans(_BLANK_BYTES + b"\0", b",,,, ")


def _long_json(ranges: Ranges) -> tuple[bytes, Array] | None:
    texts = ranges.texts()
    if not all(texts):
        return None
    counts = np.array([text.count(b" ") + 1 for text in texts], dtype=np.int64)
    joined = b",".join(texts)
    if joined.count(b",") != len(texts) - 1 or b"\0" in joined:
        return None
    return b"[%b]" % joined.replace(b" ", b","), counts


def booleans_of(ranges: Ranges) -> Array:
    """xs:boolean (n,)."""
    made = ranges.words()
    if made is not None and made[0].shape[1] == 1:
        words = made[0][:, 0]
        true = (words == _TRUE) | (words == _ONE)
        if bool(np.all(true | (words == _FALSE) | (words == _ZERO))):
            return np.asarray(true)
    return np.array([b"".join(_words_of(text)) in (b"true", b"1") for text in ranges.texts()],
                    dtype=np.bool_)  # fmt: skip


def boolean_lists_of(ranges: Ranges, _: int | None) -> tuple[Array, Array]:
    """All truth values in lists, and how many are in each."""
    words = [_words_of(text) for text in ranges.texts()]
    values = [word in (b"true", b"1") for each in words for word in each]
    return np.array(values, np.bool_), np.array([len(each) for each in words], np.int64)


_TRUE, _FALSE, _ONE, _ZERO = (
    U(int.from_bytes(text, "little")) for text in (b"true", b"false", b"1", b"0")
)
