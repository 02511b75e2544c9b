"""What watches a run."""

from __future__ import annotations

import io
import os
import zipfile
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any, Self

import numpy as np
from numpy.typing import NDArray

from colladaphy.errors import InputError
from colladaphy.source import save
from colladaphy.source.rules import UNREADABLE

if TYPE_CHECKING:
    from colladaphy.world import World

__all__ = ["Observer", "Trajectory"]

Observer = Callable[["World"], None]
"""Called with the World, up to date, at the intervals that `Simulation.run` is given."""

Floats = NDArray[np.float64]


class Trajectory:
    """Records the motion of all top-level bodies, in memory, and saves it as ``.npz``.

    `file` is where `save_again` saves it.
    """

    def __init__(self, file: str | os.PathLike[str] | None = None) -> None:
        self._file = file
        self._times: list[float] = []
        self._steps: list[int] = []
        self._columns: dict[str, list[Floats]] = {
            "positions": [],
            "orientations": [],
            "linear_velocities": [],
            "angular_velocities": [],
        }
        self._sids: NDArray[np.int64] = np.zeros(0, dtype=np.int64)

    def __call__(self, world: World) -> None:
        """Record how `world` is now, unless that was just recorded."""
        if self._steps and self._steps[-1] == world.step_count:
            return
        self._times.append(world.time)
        self._steps.append(world.step_count)
        self._sids = np.array(world.sids)
        for name, rows in self._columns.items():
            rows.append(np.array(getattr(world, name)))

    def __len__(self) -> int:
        return len(self._times)

    @property
    def times(self) -> Floats:
        """The times of the records (k,)."""
        return np.array(self._times)

    def column(self, name: str) -> Floats:
        """A column of the World over time: "positions" is (k, n, 3)."""
        return np.stack(self._columns[name])

    @classmethod
    def load(cls, file: str | os.PathLike[str], *, until: int | None = None) -> Self:
        """Go on with what was saved: all records, or those up to a step.

        InputError if the file is no trajectory.
        """
        record = cls(file)
        try:
            with Path(file).open("rb") as stream, np.load(stream, allow_pickle=False) as arrays:
                steps = arrays["step_counts"].astype(np.int64)
                count = len(steps) if until is None else int(np.sum(steps <= until))
                record._steps = steps[:count].tolist()
                record._times = arrays["times"][:count].tolist()
                record._sids = arrays["sids"]
                for name, rows in record._columns.items():
                    if count:
                        rows.extend(arrays[name][:count])
        except (OSError, ValueError, KeyError, EOFError, zipfile.BadZipFile) as error:
            message = f"The trajectory cannot be gone on with: {error}."
            raise InputError(UNREADABLE.at(message=message, file=os.fsdecode(file))) from error
        return record

    def save_again(self) -> None:
        """Save to the file that it was made with, if any."""
        if self._file is not None:
            self.save(self._file)

    def save(self, target: str | os.PathLike[str]) -> None:
        """Write times (k,), step_counts (k,), sids (n,) and the columns as ``.npz``, atomically.

        OutputError if it cannot be written.
        """
        arrays: dict[str, NDArray[Any]] = {
            "times": self.times,
            "step_counts": np.array(self._steps, dtype=np.int64),
            "sids": self._sids,
        }
        if self._times:
            arrays |= {name: self.column(name) for name in self._columns}
        buffer = io.BytesIO()
        with zipfile.ZipFile(buffer, "w", zipfile.ZIP_DEFLATED) as archive:
            for name, array in arrays.items():
                with archive.open(f"{name}.npy", "w", force_zip64=True) as stream:
                    np.lib.format.write_array(stream, array, allow_pickle=False)
        save(buffer.getvalue(), target)
