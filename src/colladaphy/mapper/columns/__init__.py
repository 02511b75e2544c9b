"""The quick path of loading: regular bodies field by field, as columns.

Most bodies of a large document look alike: one primitive, its material, a node, velocities. Their
values are taken out of the tree a field at a time, for some hundred records together, and never
become Python objects. The schema says how often an element may stand in a record; what it leaves
open is asked of every record with a predicate, so that equally many values and records prove that
each record has its own. A record that is not plainly regular, or whose two profiles are not
plainly the same, is left to the path for everything (`mapper.bodies`), which gives equal results.
"""

from colladaphy.mapper.columns.regular import RegularBodies

__all__ = ["RegularBodies"]
