"""Which physics model a body stands in, and the order of the bodies in the file."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from colladaphy.mapper.tokens import token
from colladaphy.world.columns import BODY_FIELDS

if TYPE_CHECKING:
    from colladaphy.mapper.options import WriteOptions
    from colladaphy.world import World

__all__ = ["Arrangement", "arrange", "kept_names"]

Array = NDArray[Any]


@dataclass(slots=True)
class Arrangement:
    """The bodies that are no members, n rows in the order of the file."""

    bodies: dict[str, Array]
    """Their columns, ``sids`` and those of `BODY_FIELDS`."""
    names: list[str | None] | None
    """Names (n,); None if no body has one."""
    models: list[str]
    """Names of the physics models (m,), empty for none."""
    model: Array
    """(n,) the model that each body stands in, never descending."""


def arrange(world: World, options: WriteOptions) -> Arrangement:
    """All of a World in one model, or the models that the options name, as they are first named."""
    bodies: dict[str, Array] = {name: getattr(world, name) for name in ("sids", *BODY_FIELDS)}
    count = len(bodies["sids"])
    models, model = [""], np.zeros(count, np.int64)
    if options.group is not None:
        numbers: dict[str, int] = {}
        model = np.array(
            [numbers.setdefault(str(options.group(body)), len(numbers)) for body in world.bodies],
            dtype=np.int64,
        )
        models = list(numbers) or models
        if len(models) > 1:
            sorting = np.argsort(model, kind="stable")
            model = model[sorting]
            bodies = {name: column[sorting] for name, column in bodies.items()}
    names = None
    if world.names:
        names = [world.names.get(sid) for sid in bodies["sids"].tolist()]
    return Arrangement(bodies, names, models, model)


def kept_names(names: list[str | None] | None) -> list[str | None] | None:
    """The names that an attribute of the common profile would not keep; None for none."""
    if names is None:
        return None
    kept = [name if name is not None and token(name) != name else None for name in names]
    return None if kept.count(None) == len(kept) else kept
