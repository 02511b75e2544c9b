"""The contacts of the last step of a space."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import pymunk

from colladaphy.engines.protocol import Contact

if TYPE_CHECKING:
    from colladaphy.engines.plane import Frame
    from colladaphy.engines.pymunk_engine.space import Model

__all__ = ["contacts_of"]


def contacts_of(model: Model, frame: Frame) -> list[Contact]:
    """All contacts, ordered by system ids; in world coordinates."""
    found: dict[tuple[int, int], list[Contact]] = {}
    bodies = [body.id for body in model.bodies]
    places = {id: place for place, id in enumerate(bodies)}

    def take(arbiter: pymunk.Arbiter, place: int) -> None:
        one, two = arbiter.bodies
        other = two if one.id == bodies[place] else one
        if places.get(other.id, place) < place:
            return  # seen from the other body already
        first, second = model.owners[one.id], model.owners[two.id]
        points = arbiter.contact_point_set
        sign = 1.0 if first < second else -1.0
        normal = np.array(points.normal) * sign
        impulse = abs(float(np.dot(arbiter.total_impulse, normal))) / max(len(points.points), 1)
        key = (min(first, second), max(first, second))
        for point in points.points:
            middle = (np.array(point.point_a) + np.array(point.point_b)) / 2
            x, y, z = frame.lift(middle, np.array(frame.offset)).tolist()
            nx, ny, nz = frame.lift(normal).tolist()
            found.setdefault(key, []).append(
                Contact(*key, (x, y, z), (nx, ny, nz), float(point.distance), impulse)
            )

    for place, body in enumerate(model.bodies):
        body.each_arbiter(take, place)
    return [contact for key in sorted(found) for contact in found[key]]
