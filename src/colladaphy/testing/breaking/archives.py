"""Faults of archives, around documents in which nothing is wrong."""

from __future__ import annotations

import io
import zipfile
from collections.abc import Callable

from hypothesis import strategies as st

__all__ = ["ARCHIVES", "zipped"]

Make = Callable[[st.DrawFn, bytes], bytes]


def zipped(*entries: tuple[str, bytes]) -> bytes:
    """A zip archive of these files."""
    stream = io.BytesIO()
    with zipfile.ZipFile(stream, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, data in entries:
            archive.writestr(zipfile.ZipInfo(name), data, zipfile.ZIP_DEFLATED)
    return stream.getvalue()


def _with(*names: str, data: bytes = b"") -> Make:
    """The document, and one more file."""

    def make(draw: st.DrawFn, document: bytes) -> bytes:
        return zipped(("a.dae", document), (draw(st.sampled_from(names)), data))

    return make


def _blank(size: int) -> Make:
    """A document with a comment that packs to next to nothing."""

    def make(draw: st.DrawFn, document: bytes) -> bytes:
        return zipped(("a.dae", document + b"<!--" + b" " * size + b"-->"))

    return make


def _damaged(draw: st.DrawFn, document: bytes) -> bytes:
    whole = zipped(("a.dae", document))
    return whole[: draw(st.integers(5, len(whole) - 23))]


def _without_root(draw: st.DrawFn, document: bytes) -> bytes:
    return zipped((draw(st.sampled_from(["a.txt", "b/c.png"])), document))


def _plain(draw: st.DrawFn, document: bytes) -> bytes:
    return zipped((draw(st.sampled_from(["a.dae", "b/c.dae"])), document))


ARCHIVES: dict[str, tuple[Make, Make]] = {
    "io-archive-bomb": (_blank(4_000_000), _blank(20_000)),
    "io-archive-broken": (_damaged, _plain),
    "io-archive-root": (_without_root, _plain),
    "io-archive-unsafe": (
        _with("../evil.png", "/evil.png", "b/../../evil.png"),
        _with("b/good.png", "b..png"),
    ),
}
"""By rule: what breaks it, and what nearly does."""
