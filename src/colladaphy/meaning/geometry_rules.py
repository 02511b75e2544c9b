"""What can be wrong with geometries in a document that is schema-valid."""

from __future__ import annotations

from colladaphy.findings import Rule, Severity

__all__ = ["RULES"]

ARRAY_COUNT = Rule(
    "geometry-array-count",
    Severity.ERROR,
    "An array holds more or fewer values than its count says.",
    "Correct the count, or the values.",
    "COLLADA 1.5 §float_array",
    "A value too many or too few shifts all that come after it; readers refuse it or read rubbish.",
)
ACCESSOR_RANGE = Rule(
    "geometry-accessor-range",
    Severity.ERROR,
    "An accessor reads past the end of its array.",
    "Correct the count, the stride or the offset of the accessor.",
    "COLLADA 1.5 §accessor",
    "What is read there is not in the file.",
)
ACCESSOR_SHORT = Rule(
    "geometry-accessor-short",
    Severity.ERROR,
    "An accessor reads fewer items than are used, though its array has them.",
    "Correct the count of the accessor.",
    "COLLADA 1.5 §accessor",
    "Readers that rely on the count refuse the indices past it, or the whole geometry.",
)
ACCESSOR_STRIDE = Rule(
    "geometry-accessor-stride",
    Severity.ERROR,
    "An accessor has more parameters than its stride.",
    "The stride is the number of values from one item to the next; it is 1 where it is left out.",
    "COLLADA 1.5 §accessor",
    "The items overlap, and every position is another than was meant.",
)
PARAM_TYPE = Rule(
    "geometry-param-type",
    Severity.WARNING,
    "A parameter of an accessor is of another type than its array.",
    "Let the type be that of the array's values.",
    "COLLADA 1.5 §param",
    why="Programs that go by the type misread the values.",
)
INPUT_TWICE = Rule(
    "geometry-input-twice",
    Severity.ERROR,
    "Two inputs of one element have the same semantic and set.",
    "Give them different sets, or remove one.",
    "COLLADA 1.5 §input",
    "Which of them is meant cannot be told.",
)
INPUT_MISSING = Rule(
    "geometry-input-missing",
    Severity.ERROR,
    "An input that is needed is not there.",
    "Add an <input> of that semantic.",
    "COLLADA 1.5 §input",
    "Without it the element has no meaning, and readers refuse it.",
)
PRIMITIVE_COUNT = Rule(
    "geometry-primitive-count",
    Severity.ERROR,
    "A primitive has more or fewer faces than its count says.",
    "Correct the count, or the indices.",
    "COLLADA 1.5 §triangles, §polylist",
    "Faces are lost, or read from what is not there.",
)
INDEX_LACKING = Rule(
    "geometry-index-lacking",
    Severity.ERROR,
    "A list of indices does not have the same number of them for every corner.",
    "Every corner has one index for each offset of the inputs.",
    "COLLADA 1.5 §p",
    "All corners after the one that lacks an index are wrong.",
)
VCOUNT = Rule(
    "geometry-vcount",
    Severity.ERROR,
    "The numbers of corners do not fit the polygons, or are not there.",
    "<vcount> has one number for each polygon, and they add up to the corners in <p>.",
    "COLLADA 1.5 §polylist",
    "Where a polygon ends cannot be told.",
)
INDEX_RANGE = Rule(
    "geometry-index-range",
    Severity.ERROR,
    "An index is past the end of its source.",
    "Correct the index, or add the value that it means.",
    "COLLADA 1.5 §p",
    "There is no such vertex; readers refuse the mesh, or crash.",
)
FEW_CORNERS = Rule(
    "geometry-few-corners",
    Severity.WARNING,
    "A face, fan, strip or line has too few corners to be one.",
    "Remove it; a face has at least three corners, a line two.",
    "COLLADA 1.5 §polygons",
    why="There is nothing to show or to collide with.",
)
NUMBER = Rule(
    "geometry-number",
    Severity.ERROR,
    "An array holds NaN or INF.",
    "Replace it by a number.",
    "COLLADA 1.5 §float_array",
    "What is computed of it, be it a volume or a picture, is no number either.",
)
NORMAL = Rule(
    "geometry-normal",
    Severity.WARNING,
    "A normal has no length.",
    "Give it a direction, of length 1.",
    "COLLADA 1.5 §input",
    "The surface is black there, or lit at random.",
)
OPEN = Rule(
    "geometry-open",
    Severity.WARNING,
    "The surface of a convex mesh, or of a body that moves, is not closed.",
    'Close the holes, or use the convex hull: <convex_mesh convex_hull_of="#id"/>.',
    "COLLADA 1.5 §convex_mesh",
    "It encloses no volume, so that mass, centre and inertia are computed of something else.",
)
INWARD = Rule(
    "geometry-inward",
    Severity.WARNING,
    "A convex mesh is turned inside out.",
    "List the corners of every face counter-clockwise as seen from outside.",
    "COLLADA 1.5 §convex_mesh",
    "Its volume is negative, and to many readers everything else is inside.",
)
MIXED_WINDING = Rule(
    "geometry-mixed-winding",
    Severity.WARNING,
    "Some faces of a closed surface are wound the other way than those beside them.",
    "List the corners of every face counter-clockwise as seen from outside.",
    "COLLADA 1.5 §mesh",
    "Volume, centre and inertia are computed wrong.",
)
NOT_CONVEX = Rule(
    "geometry-not-convex",
    Severity.WARNING,
    "A convex mesh is not convex.",
    'Make it a <mesh>, or let it be a hull: <convex_mesh convex_hull_of="#id"/>.',
    "COLLADA 1.5 §convex_mesh",
    "Collisions and inertia are those of its hull in some readers, of the mesh in others.",
)
NO_VOLUME = Rule(
    "geometry-no-volume",
    Severity.WARNING,
    "The surface of a body encloses no volume.",
    "Give it a thickness.",
    "COLLADA 1.5 §convex_mesh",
    "It has neither mass nor inertia, and the body cannot be loaded.",
)

INPUT_VALUES = Rule(
    "geometry-input-values",
    Severity.ERROR,
    "The values of an input are not what its semantic needs.",
    "Let it lead to a source of that kind: three numbers for positions and normals, 16 for "
    "matrices, names for joints.",
    "COLLADA 1.5 §input",
    "Readers refuse it, or take values for others.",
)
ACCESSOR_MISSING = Rule(
    "geometry-accessor-missing",
    Severity.ERROR,
    "A source does not say how it is read.",
    "Add <technique_common> with an <accessor>.",
    "COLLADA 1.5 §source",
    "How many values make an item cannot be told.",
)
VERTEX_COUNT = Rule(
    "geometry-vertex-count",
    Severity.ERROR,
    "The inputs of vertices differ in number.",
    "Give every vertex one position, and one value of each other input.",
    "COLLADA 1.5 §vertices",
    "Vertices are left without a value, or have that of another one.",
)
PARAM_TWICE = Rule(
    "geometry-param-twice",
    Severity.WARNING,
    "Two parameters of an accessor have the same name.",
    "Name them X Y Z, S T P, or R G B A.",
    "COLLADA 1.5 §param",
    "Readers that go by the names take one value twice, and lose another.",
)
NO_FACES = Rule(
    "geometry-no-faces",
    Severity.WARNING,
    "The geometry of a shape has no faces, or is no mesh.",
    'Give it triangles or polygons, or use its convex hull: <convex_mesh convex_hull_of="#id"/>.',
    "COLLADA 1.5 §shape",
    "It encloses no volume, and the body cannot be loaded.",
)
ARRAY_BOUNDS = Rule(
    "geometry-array-bounds",
    Severity.WARNING,
    "An array holds a number that is not between the bounds that it states.",
    "Correct the number, or minInclusive and maxInclusive.",
    "COLLADA 1.5 §int_array",
    why="Programs that rely on the bounds refuse the number, or cut it off.",
)

SEMANTIC = Rule(
    "geometry-semantic",
    Severity.WARNING,
    "The semantic of an input is spelled nearly as one of the standard.",
    "Correct its spelling; semantics are in capitals.",
    "COLLADA 1.5 §input",
    why="Programs pass over what they do not know, so the values are not seen.",
)

RULES = (
    SEMANTIC,
    INPUT_VALUES,
    ACCESSOR_MISSING,
    VERTEX_COUNT,
    PARAM_TWICE,
    NO_FACES,
    ARRAY_BOUNDS,
    ARRAY_COUNT,
    ACCESSOR_RANGE,
    ACCESSOR_SHORT,
    ACCESSOR_STRIDE,
    PARAM_TYPE,
    INPUT_TWICE,
    INPUT_MISSING,
    PRIMITIVE_COUNT,
    INDEX_LACKING,
    VCOUNT,
    INDEX_RANGE,
    FEW_CORNERS,
    NUMBER,
    NORMAL,
    OPEN,
    INWARD,
    MIXED_WINDING,
    NOT_CONVEX,
    NO_VOLUME,
)
