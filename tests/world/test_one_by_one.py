"""Bodies created one by one are, to the last bit, what they are when created together."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from colladaphy.errors import WorldError
from colladaphy.world import BodyColumns, Kind, World, compare

sizes = st.floats(1e-200, 1e200) | st.floats(0.01, 10.0) | st.sampled_from([5e-324, 1.7e308])
COLUMNS = {Kind.SPHERE: [0], Kind.BOX: [0, 1, 2], Kind.CAPSULE: [0, 1, 2, 3],
           Kind.CYLINDER: [1, 2, 3], Kind.ELLIPSOID: [0, 1, 2]}  # fmt: skip


def create(world: World, kind: Kind, size: list[float], **options: Any) -> None:
    where = (1.0, 2.0, 3.0)
    match kind:
        case Kind.SPHERE:
            world.create_sphere(7, where, size[0], "iron", **options)
        case Kind.BOX:
            world.create_box(7, where, size[:3], "iron", **options)
        case Kind.CAPSULE:
            world.create_capsule(7, where, size[:3], size[3], "iron", **options)
        case Kind.CYLINDER:
            world.create_cylinder(7, where, size[1:3], size[3], "iron", **options)
        case _:
            world.create_ellipsoid(7, where, size[:3], "iron", **options)


@settings(max_examples=150)
@given(
    st.sampled_from(list(COLUMNS)),
    st.lists(sizes, min_size=4, max_size=4),
    st.none() | st.floats(0.0, 1e300),
    st.none() | st.lists(st.floats(-1e300, 1e300), min_size=9, max_size=9),
    st.booleans(),
)
def test_one_by_one_as_together(
    kind: Kind, size: list[float], mass: float | None, inertia: list[float] | None, fixed: bool
) -> None:
    options: dict[str, Any] = {"fixed": fixed}
    row = np.zeros((1, 4))
    row[0, COLUMNS[kind]] = np.array(size)[COLUMNS[kind]]
    one, many = World(), World()
    columns = BodyColumns(kinds=np.array([kind], dtype=np.int8), dimensions=row)
    columns.uids, columns.positions = np.array([7]), np.array([[1.0, 2.0, 3.0]])
    columns.fixed = np.array([fixed])
    columns.material_ids = np.array([one.materials["iron"].id])
    if mass is not None:
        options["mass"], columns.masses = mass, np.array([mass])
    if inertia is not None:
        options["inertia"] = np.reshape(inertia, (3, 3))
        columns.inertias = np.reshape(inertia, (1, 3, 3))
    try:
        many.extend(columns)
    except WorldError as error:
        with pytest.raises(WorldError) as caught:
            create(one, kind, size, **options)
        assert caught.value.findings == error.findings
    else:
        create(one, kind, size, **options)
    assert compare(one, many) == []
