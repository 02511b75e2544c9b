"""Free joints for the bodies of a compiled model: what MuJoCo's compiler is slow at.

It looks at every degree of freedom of the scene for every body that moves, so that its time grows
with the square of their number. Bodies that are free have nothing to do with each other. So they
are compiled without joints, which takes no time, and the joints are put into the binary form of
the model: copies of what the compiler makes of one such body, with the addresses of each. It is
done only where it makes a small scene into the same model as the compiler, in this version of
MuJoCo.
"""

from __future__ import annotations

from functools import cache
from typing import TYPE_CHECKING, Any, Final

import mujoco
import numpy as np
from mujoco.introspect import structs
from numpy.typing import NDArray

from colladaphy.engines.mujoco_engine.quiet import quiet

if TYPE_CHECKING:
    from colladaphy.engines.mujoco_engine.forest import Forest

__all__ = ["add_free_joint", "can_free", "differing", "freed", "is_quick"]

Ints = NDArray[np.int64]
Arrays = dict[str, NDArray[Any]]

_WIDTHS: Final = {"nq": 7, "nv": 6, "njnt": 1, "ntree": 1, "nD": 36}
"""How much of an array belongs to a free body, by the size that is the array's length."""
_OF_BODIES: Final = ("body_weldid", "body_jntnum", "body_jntadr", "body_dofnum", "body_dofadr",
                     "body_treeid", "body_invweight0", "B_rownnz")  # fmt: skip
_BASES: Final = {
    "joint": ("body_jntadr", "body_treeid", "dof_jntid", "dof_treeid"),
    "body": ("body_weldid", "jnt_bodyid", "dof_bodyid", "tree_bodyadr"),
    "position": ("jnt_qposadr",),
    "dof": ("body_dofadr", "jnt_dofadr", "dof_parentid", "tree_dofadr", "M_colind", "D_colind"),
    "old": ("dof_Madr", "mapM2M"),
    "mass": ("M_rowadr", "mapM2D"),
    "dense": ("D_rowadr", "mapD2M"),
}
"""Arrays of addresses, by what they count; -1 is none."""
_AT_ONCE: Final = 100  # bodies that are compiled together: the square of it should be little
_ALIGNED: Final = 64  # bytes, of arrays in MuJoCo's memory
_HEADER: Final = 20  # bytes
_LEAST: Final = 1e-5  # the size of a body, at least


def freed(held: Any, ids: Ints) -> Any:
    """`held` with a free joint for each of the bodies of `ids` (n,), ascending, at the world.

    Raises ValueError or mujoco.FatalError where that cannot be done.
    """
    sizes, middle, arrays = _parted(held)
    columns = (held.body_mass[ids, None], held.body_inertia[ids], held.body_iquat[ids])
    kinds, kind_of = np.unique(np.hstack(columns), axis=0, return_inverse=True)
    made, ragged = _patterns(kinds)
    kind_of = kind_of.reshape(-1)
    lengths = np.array([len(each) for each in ragged["M_colind"]])[kind_of]
    count = len(ids)
    bases = _bases(np.arange(count), ids, np.cumsum(lengths) - lengths)
    for name, pattern in made.items():
        values = _moved(name, pattern[kind_of], bases, 1)
        if name in _OF_BODIES:
            arrays[name] = arrays[name].copy()
            arrays[name][ids] = values[:, 0]
        else:
            arrays[name] = values.reshape(count * values.shape[1], *values.shape[2:])
    steps = np.repeat(np.arange(count), lengths)
    spread = {name: base[steps] for name, base in bases.items()}
    for name, parts in ragged.items():
        arrays[name] = _moved(name, np.concatenate([parts[k] for k in kind_of]), spread, 1)
    dofs = 6 * count
    arrays["B_rownnz"][0] = dofs
    arrays["B_rowadr"] = _starts(arrays["B_rownnz"])
    arrays["B_colind"] = np.concatenate([np.arange(dofs), np.arange(dofs)]).astype(np.int32)
    arrays["dof_simplenum"] = _runs(arrays["dof_simplenum"] > 0)
    _measure(held, ids, arrays)
    named = _name(held, arrays, count)
    sizes |= named | {
        "nq": 7 * count, "nv": dofs, "njnt": count, "ntree": count, "nM": 21 * count,
        "nB": 2 * dofs, "nC": int(lengths.sum()), "nD": 36 * count,
        "nbuffer": _padded(arrays),
    }  # fmt: skip
    model = _joined(held, sizes, middle, arrays)
    model.stat.meaninertia = np.cumsum(arrays["dof_M0"])[-1] / dofs
    return model


def is_quick(forest: Forest) -> bool:
    """Whether nothing but free bodies moves, and MuJoCo's models are as they are taken to be."""
    return not forest.links and not forest.loops and can_free()


def add_free_joint(body: Any) -> None:
    """What `freed` does, in a specification."""
    joint = body.add_joint()
    joint.type = mujoco.mjtJoint.mjJNT_FREE
    joint.align = mujoco.mjtAlignFree.mjALIGNFREE_FALSE


def differing(one: Any, other: Any) -> list[str]:
    """The names of the fields in which two models are not the same, bit by bit."""
    first, second = (_sizes_of(model) | _arrays_of(model) for model in (one, other))
    found = [
        name
        for name, value in first.items()
        if np.asarray(value).tobytes() != np.asarray(second[name]).tobytes()
    ]
    stats = ("center", "extent", "meaninertia", "meanmass", "meansize")
    return found + [
        name
        for name in stats
        if not np.array_equal(getattr(one.stat, name), getattr(other.stat, name), equal_nan=True)
    ]


@cache
def can_free() -> bool:
    """Whether this version of MuJoCo's models are as `freed` takes them to be."""
    try:
        with quiet():
            held, free = (_sample(joined=joined).compile() for joined in (False, True))
            return not differing(freed(held, np.arange(2, held.nbody)), free)
    except (AttributeError, KeyError, IndexError, TypeError, ValueError, mujoco.FatalError):
        return False


def _sample(*, joined: bool) -> Any:
    """Something of all that matters: what stands, and bodies with and without a mass frame."""
    spec = mujoco.MjSpec()
    spec.compiler.alignfree = False
    spec.memory = 1 << 20  # or it would be more with joints
    floor = spec.worldbody.add_body(name="floor")
    floor.add_geom(type=mujoco.mjtGeom.mjGEOM_PLANE, size=[0, 0, 1], name="ground")
    for number in range(4):
        turn = [0.8, 0.6, 0.0, 0.0] if number == 1 else [1.0, 0.0, 0.0, 0.0]
        body = _add_body(spec, [1.0 + number % 3, 2.0, 2.5, 3.0, *turn], joined=joined)
        body.name = f"body{number}"
        for place in range(number):
            geom = body.add_geom(type=mujoco.mjtGeom.mjGEOM_SPHERE, size=[1, 0, 0])
            geom.pos, geom.mass = [0.3, 0.1, place], 0.0
    return spec


def _add_body(spec: Any, kind: Any, *, joined: bool) -> Any:
    body = spec.worldbody.add_body()
    body.mass, body.inertia, body.iquat = kind[0], kind[1:4], kind[4:8]
    body.ipos = np.zeros(3)
    body.explicitinertial = True
    if joined:
        add_free_joint(body)
    return body


def _patterns(kinds: NDArray[np.float64]) -> tuple[Arrays, dict[str, list[NDArray[Any]]]]:
    """What the compiler makes of free bodies of each kind (k, 8), with all addresses from 0.

    Arrays (k, width, …), and those of different lengths (k of them).
    """
    whole: dict[str, list[NDArray[Any]]] = {}
    ragged: dict[str, list[NDArray[Any]]] = {}
    for start in range(0, len(kinds), _AT_ONCE):
        spec = mujoco.MjSpec()
        spec.compiler.alignfree = False
        chunk = kinds[start : start + _AT_ONCE]
        for kind in chunk:
            _add_body(spec, kind, joined=True)
        model = spec.compile()
        count = len(chunk)
        lengths = np.asarray(model.M_rownnz).reshape(count, 6).sum(axis=1)
        begins = _starts(lengths)
        bases = _bases(np.arange(count), np.arange(1, count + 1), begins)
        for name, size in _lengths().items():
            array = np.asarray(getattr(model, name))
            if size in _WIDTHS:
                array = array.reshape(count, _WIDTHS[size], *array.shape[1:])
            elif name in _OF_BODIES:
                array = array[1:, None]
            elif size == "nC":
                parts = np.split(array, begins[1:])
                ragged.setdefault(name, []).extend(
                    _moved(name, part, {key: base[row] for key, base in bases.items()}, -1)
                    for row, part in enumerate(parts)
                )
                continue
            else:
                continue
            whole.setdefault(name, []).append(_moved(name, array, bases, -1))
    return {name: np.concatenate(parts) for name, parts in whole.items()}, ragged


def _bases(rows: Ints, ids: Ints, mass: Ints) -> dict[str, Any]:
    return {
        "joint": rows, "body": ids, "position": 7 * rows, "dof": 6 * rows, "old": 21 * rows,
        "mass": mass, "dense": 36 * rows,
    }  # fmt: skip


def _moved(name: str, values: NDArray[Any], bases: dict[str, Any], sign: int) -> NDArray[Any]:
    """Values with the bases of what they count added, or taken away."""
    key = _counted().get(name)
    if key is None:
        return values
    base = np.asarray(bases[key])
    base = base.reshape(base.shape + (1,) * (values.ndim - base.ndim))
    return np.where(values >= 0, values + sign * base, values).astype(values.dtype)


@cache
def _counted() -> dict[str, str]:
    return {name: key for key, names in _BASES.items() for name in names}


def _measure(held: Any, ids: Ints, arrays: Arrays) -> None:
    """The length by which MuJoCo measures the turning of a body: how far its shapes reach."""
    reach = np.full(held.nbody, _LEAST)
    x, y, z = np.asarray(held.geom_pos).T
    far = np.asarray(held.geom_rbound) + np.sqrt(x * x + y * y + z * z)
    bounded = np.asarray(held.geom_rbound) > 0
    np.maximum.at(reach, np.asarray(held.geom_bodyid)[bounded], far[bounded])
    lengths = np.ones((len(ids), 6))
    lengths[:, 3:] = reach[ids, None]
    arrays["dof_length"] = lengths.reshape(-1)


def _name(held: Any, arrays: Arrays, count: int) -> dict[str, int]:
    """Empty names for the joints, behind those of the bodies."""
    names = np.asarray(arrays["names"])
    last = int(held.name_bodyadr[-1])
    place = last + names.tobytes()[last:].index(b"\0") + 1
    for name, array in arrays.items():
        if name.startswith("name_"):
            arrays[name] = np.where(array >= place, array + count, array).astype(array.dtype)
    arrays["name_jntadr"] = (place + np.arange(count)).astype(np.int32)
    arrays["names"] = np.insert(names, [place] * count, 0)
    known = 2 * int(held.nbody)
    arrays["names_map"] = np.insert(arrays["names_map"], [known] * (2 * count), -1)
    return {"nnames": len(arrays["names"]), "nnames_map": len(arrays["names_map"])}


def _runs(flags: NDArray[np.bool_]) -> NDArray[np.int32]:
    """How many are true in a row from each place on (n,)."""
    places = np.arange(len(flags))
    ends = np.where(flags, len(flags), places)[::-1]
    return (np.minimum.accumulate(ends)[::-1] - places).astype(np.int32)


def _starts(lengths: NDArray[Any]) -> NDArray[Any]:
    starts: NDArray[Any] = np.cumsum(lengths) - lengths
    return starts.astype(lengths.dtype)


# --- MuJoCo's binary form: a header, sizes, settings, arrays


def _fields() -> list[Any]:
    return list(structs.STRUCTS["mjModel"].fields)


@cache
def _places() -> tuple[list[str], list[str], dict[str, str]]:
    """Names of sizes and arrays in their order, and the size that is an array's length."""
    fields = _fields()
    names = [field.name for field in fields]
    sizes = [f.name for f in fields[: names.index("opt")] if not f.name.startswith("flg_")]
    pointers = fields[names.index("buffer") + 1 : names.index("signature")]
    lengths = {f.name: str(f.array_extent[0]) for f in pointers}
    return sizes, [field.name for field in pointers], lengths


def _lengths() -> dict[str, str]:
    return _places()[2]


def _sizes_of(model: Any) -> dict[str, int]:
    return {name: int(getattr(model, name)) for name in _places()[0]}


def _arrays_of(model: Any) -> Arrays:
    values = ((name, getattr(model, name)) for name in _places()[1])
    return {
        name: np.frombuffer(value, np.uint8) if isinstance(value, bytes) else np.asarray(value)
        for name, value in values
    }


def _binary(model: Any) -> bytes:
    content = np.empty(mujoco.mj_sizeModel(model), np.uint8)
    mujoco.mj_saveModel(model, None, content)
    return content.tobytes()


def _parted(model: Any) -> tuple[dict[str, int], bytes, Arrays]:
    """Sizes, settings and arrays; ValueError if they do not make the binary form again."""
    sizes, arrays, content = _sizes_of(model), _arrays_of(model), _binary(model)
    begin = _HEADER + 8 * len(sizes)
    end = len(content) - sum(array.nbytes for array in arrays.values())
    middle = content[begin:end]
    if _content(content, sizes, middle, arrays) != content or _padded(arrays) != sizes["nbuffer"]:
        raise ValueError("MuJoCo's binary form is not known")
    return sizes, middle, arrays


def _padded(arrays: Arrays) -> int:
    """The bytes of MuJoCo's memory for arrays."""
    end = 0
    for array in arrays.values():
        end += -end % _ALIGNED + array.nbytes
    return end + _ALIGNED - 1


def _content(header: bytes, sizes: dict[str, int], middle: bytes, arrays: Arrays) -> bytes:
    numbers = np.array(list(sizes.values()), dtype=np.int64).tobytes()
    parts = (array.tobytes() for array in arrays.values())
    return b"".join([header[:_HEADER], numbers, middle, *parts])


def _joined(held: Any, sizes: dict[str, int], middle: bytes, arrays: Arrays) -> Any:
    content = _content(_binary(held), sizes, middle, arrays)
    return mujoco.MjModel.from_binary_path("freed.mjb", {"freed.mjb": content})
