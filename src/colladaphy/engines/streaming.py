"""Trajectories that stream to disk, in chunks, as zarr arrays that xarray reads by name."""

from __future__ import annotations

import os
from typing import TYPE_CHECKING, Any, Final, Self

import numpy as np
from numpy.typing import NDArray

from colladaphy.engines.checkpoint_rules import TRAJECTORY
from colladaphy.engines.rules import NOT_INSTALLED
from colladaphy.errors import EngineError, InputError
from colladaphy.source.rules import UNREADABLE

if TYPE_CHECKING:
    from colladaphy.world import World

__all__ = ["ZarrTrajectory"]

_CHUNK: Final = 4 << 20
"""Bytes of records that are kept in memory and written at once."""
_DIMENSIONS: Final = "_ARRAY_DIMENSIONS"  # as xarray has them in zarr 2
_COLUMNS: Final = {
    "positions": ("axis", "length"),
    "orientations": ("quaternion", "1"),
    "linear_velocities": ("axis", "length/s"),
    "angular_velocities": ("axis", "rad/s"),
}


class ZarrTrajectory:
    """Records the motion of all top-level bodies in a zarr group, with bounded memory.

    An observer for `Simulation.run`. The group holds `time` (k,), `step` (k,), `body` (n,) (system
    ids), `name` (n,), and positions (k, n, 3), orientations (k, n, 4), linear and angular
    velocities (k, n, 3), with units as attributes: ``xarray.open_zarr(folder,
    consolidated=False)`` reads it while the run goes on. Bodies have to stay the same ones:
    EngineError (``engine-trajectory``). `flush` writes what is still in memory; `close` does so
    too, as does leaving a ``with`` block. Needs the extra `zarr`.
    """

    def __init__(self, folder: str | os.PathLike[str], *, append_until: int | None = None) -> None:
        """A new group in `folder`, over an old one; or go on with it after a step of it."""
        try:
            import zarr
        except ImportError as error:
            message = f"Trajectories in zarr need its library: {error}."
            hint = "Install it: pip install 'colladaphy[zarr]'."
            raise EngineError(NOT_INSTALLED.at(message=message, hint=hint)) from error
        self._folder = os.fspath(folder)
        self._records: list[tuple[float, int, list[NDArray[np.float64]]]] = []
        self._sids: NDArray[np.int64] | None = None
        self._last = -1
        self._most = 1
        if append_until is None:
            self._group: Any = zarr.open_group(self._folder, mode="w", zarr_format=2)
            return
        try:
            self._group = zarr.open_group(self._folder, mode="r+")
            steps = self._group["step"][:]
            self._sids = np.asarray(self._group["body"][:])
        except (OSError, KeyError, ValueError) as error:
            message = f"The trajectory cannot be gone on with: {error}."
            raise InputError(UNREADABLE.at(message=message, file=self._folder)) from error
        self._cut(int(np.sum(steps <= append_until)))

    def _cut(self, count: int) -> None:
        for name in ("time", "step", *_COLUMNS):
            array = self._group[name]
            array.resize((count, *array.shape[1:]))
        assert self._sids is not None
        self._most = _records_at_once(len(self._sids))
        if count:
            self._last = int(self._group["step"][count - 1])

    def __call__(self, world: World) -> None:
        """Record how `world` is now, unless that was just recorded."""
        if world.step_count == self._last:
            return
        if self._sids is None:
            self._begin(world)
        elif not np.array_equal(self._sids, world.sids):
            message = "The bodies are not those that the trajectory began with."
            raise EngineError(TRAJECTORY.at(message=message, file=self._folder))
        self._last = world.step_count
        columns = [np.array(getattr(world, name)) for name in _COLUMNS]
        self._records.append((world.time, world.step_count, columns))
        if len(self._records) >= self._most:
            self.flush()

    def _begin(self, world: World) -> None:
        self._sids = np.array(world.sids)
        count = len(self._sids)
        at_once = self._most = _records_at_once(count)
        group, meter = self._group, world.unit_meter
        group.attrs.update(unit_name=world.unit_name, unit_meter=meter, time_step=world.time_step)
        names = np.array([world.names.get(sid, "") for sid in self._sids.tolist()])
        for name, values, dims in (
            ("body", self._sids, ["body"]),
            ("name", names.astype(f"<U{max(1, names.dtype.itemsize // 4)}"), ["body"]),
            ("axis", np.array(list("xyz")), ["axis"]),
            ("quaternion", np.array(list("wxyz")), ["quaternion"]),
        ):
            group.create_array(name, data=values, fill_value=None, attributes={_DIMENSIONS: dims})
        for name, dtype, attributes in (("time", "f8", {"unit": "s"}), ("step", "i8", {})):
            group.create_array(
                name, shape=(0,), chunks=(at_once,), dtype=dtype,
                fill_value=None, attributes={_DIMENSIONS: ["time"], **attributes},
            )  # fmt: skip
        length = f"{world.unit_name} ({meter:g} m)" if meter != 1.0 else "m"
        for name, (axis, unit) in _COLUMNS.items():
            width = 4 if axis == "quaternion" else 3
            group.create_array(
                name, shape=(0, count, width), chunks=(at_once, max(count, 1), width), dtype="f8",
                fill_value=None, attributes={
                    _DIMENSIONS: ["time", "body", axis],
                    "units": unit.replace("length", length),
                },
            )  # fmt: skip

    def flush(self) -> None:
        """Write what is in memory."""
        if not self._records:
            return
        count = self._group["time"].shape[0]
        stop = count + len(self._records)
        times, steps, rows = zip(*self._records, strict=True)
        # The times come last: whoever reads meanwhile sees no record that is not whole.
        columns = {name: np.stack(values) for name, values in zip(_COLUMNS, zip(*rows, strict=True),
                                                                  strict=True)}  # fmt: skip
        for name, values in (
            *columns.items(),
            ("step", np.array(steps)),
            ("time", np.array(times)),
        ):
            array = self._group[name]
            array.resize((stop, *array.shape[1:]))
            array[count:stop] = values
        self._records.clear()

    def __len__(self) -> int:
        written = self._group["time"].shape[0] if "time" in self._group else 0
        return int(written) + len(self._records)

    def close(self) -> None:
        """Write what is in memory; the trajectory can still be gone on with."""
        self.flush()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()


def _records_at_once(bodies: int) -> int:
    return max(1, _CHUNK // (8 * 13 * max(bodies, 1)))
