"""Saving: the old file or the new one, never a part of either."""

from __future__ import annotations

import contextlib
import errno
import os
import re
import stat
import time
from pathlib import Path
from typing import BinaryIO

from colladaphy.errors import OutputError
from colladaphy.findings import Finding
from colladaphy.source import rules
from colladaphy.source.names import shown_name

__all__ = ["Target", "save"]

#: Where can be written: a path, or a binary file object.
Target = str | os.PathLike[str] | BinaryIO

_TEMPORARY = re.compile(r"\.colladaphy-(?:(\d{1,9})-)?[0-9a-f]{16}\.tmp")
_FRESH = 60.0
"""Seconds for which a file is left alone: of another computer, no process is known here."""
_OLD = 86400.0

_NEXT = {
    errno.ENOENT: ("the folder does not exist", "Create the folder first."),
    errno.ENOTDIR: ("a part of the path is not a folder", "Check the path."),
    errno.EISDIR: ("the target is a folder", "Name a file in the folder."),
    errno.EACCES: ("permission is denied", "Choose a folder that you may write to."),
    errno.EPERM: ("permission is denied", "Choose a folder that you may write to."),
    errno.EROFS: ("the file system is read-only", "Choose another folder."),
    errno.ENOSPC: ("the disk is full", "Free some space, or choose another disk."),
    errno.EDQUOT: ("your disk quota is used up", "Free some space, or choose another disk."),
    errno.EFBIG: ("the file would be too large for this file system", "Choose another disk."),
    errno.ENAMETOOLONG: ("the name is too long", "Choose a shorter name."),
}


def save(data: bytes, target: Target) -> None:
    """Write `data` to a path, atomically, or to a binary file object.

    A temporary file is written beside the target, flushed to the disk and put in the target's
    place; a kill at any moment leaves the old file or the new one. Permissions of an existing file
    are kept, a link is followed. OutputError says what to do next; the target is then untouched.
    """
    if not isinstance(target, str | os.PathLike):
        _to_stream(data, target)
        return
    shown = shown_name(target)
    try:
        _to_path(data, Path(os.path.realpath(target)))
    except (OSError, ValueError) as error:
        raise OutputError(_explain(error, shown)) from error


def _to_path(data: bytes, path: Path) -> None:
    try:
        existing = path.stat()
    except FileNotFoundError:
        existing = None
    if existing is not None:
        if stat.S_ISDIR(existing.st_mode):
            raise IsADirectoryError(errno.EISDIR, os.strerror(errno.EISDIR))
        if not stat.S_ISREG(existing.st_mode):  # a pipe or a device: nothing to replace
            path.write_bytes(data)
            return
        if not os.access(path, os.W_OK):
            raise PermissionError(errno.EACCES, os.strerror(errno.EACCES))
    temporary = path.with_name(f".colladaphy-{os.getpid()}-{os.urandom(8).hex()}.tmp")
    flags = os.O_WRONLY | os.O_CREAT | os.O_EXCL | getattr(os, "O_BINARY", 0)
    descriptor = os.open(temporary, flags, 0o666)
    try:
        with os.fdopen(descriptor, "wb") as stream:
            stream.write(data)
            stream.flush()
            os.fsync(stream.fileno())
        if existing is not None:
            temporary.chmod(stat.S_IMODE(existing.st_mode))
        temporary.replace(path)
    except BaseException:
        with contextlib.suppress(OSError):
            temporary.unlink()
        raise
    _sync_folder(path.parent)
    _sweep(path.parent)


def _sweep(folder: Path) -> None:
    """Remove what writers left that were killed: theirs are the files whose process is gone.

    Where it cannot be known (another computer's, a number that is in use again), a file has to be
    a day old.
    """
    with contextlib.suppress(OSError):
        for entry in os.scandir(folder):
            found = _TEMPORARY.fullmatch(entry.name)
            if found is None:
                continue
            with contextlib.suppress(OSError):
                age = time.time() - entry.stat(follow_symlinks=False).st_mtime
                if age > _OLD or (age > _FRESH and not _is_alive(int(found[1] or 0))):
                    os.unlink(entry.path)  # noqa: PTH108 (an entry of scandir)


def _is_alive(process: int) -> bool:
    if process <= 0 or os.name != "posix":
        return True
    try:
        os.kill(process, 0)
    except ProcessLookupError:
        return False
    except OSError:
        return True
    return True


def _sync_folder(folder: Path) -> None:
    """Make the new name durable; the file is complete already, so a refusal is not an error."""
    with contextlib.suppress(OSError):
        descriptor = os.open(folder, os.O_RDONLY)
        try:
            os.fsync(descriptor)
        finally:
            os.close(descriptor)


def _to_stream(data: bytes, stream: BinaryIO) -> None:
    name = getattr(stream, "name", None)
    shown = name if isinstance(name, str) else None
    if not callable(getattr(stream, "write", None)):
        message = f"Nothing can be written to {stream!r:.40}."
        hint = "Name a file, or pass a file object that is open in binary mode ('wb')."
        raise OutputError(rules.OUTPUT_FAILED.at(message=message, hint=hint))
    try:
        view = memoryview(data)
        while view:  # raw streams may take less than they are given
            written = stream.write(view)
            view = view[len(view) if written is None else written :]
    except TypeError:
        message = "The file object takes text, not bytes."
        hint = "Open it in binary mode ('wb')."
        raise OutputError(rules.OUTPUT_FAILED.at(message=message, file=shown, hint=hint)) from None
    except (OSError, ValueError) as error:
        raise OutputError(_explain(error, shown)) from error


def _explain(error: Exception, shown: str | None) -> Finding:
    number = getattr(error, "errno", None)
    reason, hint = _NEXT.get(number or 0, (getattr(error, "strerror", None) or str(error), None))
    message = f"The output cannot be written: {reason}."
    return rules.OUTPUT_FAILED.at(message=message, file=shown, hint=hint)
