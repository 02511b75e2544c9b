"""What can be wrong with transforms, cameras and lights in a document that is schema-valid."""

from __future__ import annotations

from colladaphy.findings import Rule, Severity

__all__ = ["RULES"]

TRANSFORM_NUMBER = Rule(
    "scene-transform-number",
    Severity.ERROR,
    "A transform has a number that is not finite.",
    "Replace NaN and INF by numbers.",
    "COLLADA 1.5 §node",
    "Nothing that stands in it has a place.",
)
ROTATE_AXIS = Rule(
    "scene-rotate-axis",
    Severity.WARNING,
    "A rotation has an angle, but an axis of length zero.",
    "Give it an axis: x, y, z, then the angle in degrees.",
    "COLLADA 1.5 §rotate",
    "It turns nothing, or makes NaN of everything, from reader to reader.",
)
SCALE_ZERO = Rule(
    "scene-scale-zero",
    Severity.WARNING,
    "A scale or matrix makes everything flat.",
    "Give all three axes a factor other than zero.",
    "COLLADA 1.5 §scale",
    "What stands in it has no volume, and the transform cannot be undone.",
)
MATRIX_COLUMNS = Rule(
    "scene-matrix-columns",
    Severity.WARNING,
    "The last row of a matrix is not 0 0 0 1.",
    "Write it row by row: the translation is the last value of each of the first three rows.",
    "COLLADA 1.5 §matrix",
    "Written column by column it is read as another transform, without the translation.",
)
LOOKAT = Rule(
    "scene-lookat",
    Severity.WARNING,
    "A lookat has no direction.",
    "The eye, the point of interest and up must not lie on one line.",
    "COLLADA 1.5 §lookat",
    "Which way it looks cannot be told.",
)
SKEW = Rule(
    "scene-skew",
    Severity.WARNING,
    "A skew has no direction.",
    "Give it two axes that are not parallel, and an angle between -90 and 90 degrees.",
    "COLLADA 1.5 §skew",
    why="Programs compute values that are no numbers.",
)
CAMERA_CLIP = Rule(
    "scene-camera-clip",
    Severity.WARNING,
    "A camera's near plane is not before its far plane.",
    "znear is less than zfar, and positive for a perspective.",
    "COLLADA 1.5 §perspective, §orthographic",
    "Nothing is seen by it.",
)
CAMERA_VIEW = Rule(
    "scene-camera-view",
    Severity.WARNING,
    "A camera sees no area.",
    "Fields of view are between 0 and 180 degrees; magnifications and ratios are positive.",
    "COLLADA 1.5 §perspective, §orthographic",
    "Nothing is seen by it, or everything upside down.",
)
LIGHT = Rule(
    "scene-light",
    Severity.WARNING,
    "A value of a light is out of its range.",
    "Attenuations are not negative and not all zero; a falloff angle is between 0 and 180 degrees.",
    "COLLADA 1.5 §light",
    why="Programs show no light, or one without end.",
)

COLOR = Rule(
    "scene-color",
    Severity.WARNING,
    "A colour is none.",
    "Components are from 0 to 1, and never NaN; those of bright lights may be larger.",
    "COLLADA 1.5 §color",
    "The surface is black, or brighter than everything.",
)
EFFECT_VALUE = Rule(
    "scene-effect-value",
    Severity.WARNING,
    "A number of an effect is out of its range.",
    "Transparency and reflectivity are from 0 to 1, shininess is not negative, the index of "
    "refraction is positive.",
    "COLLADA 1.5 §phong",
    why="Programs cut the number off, each in its own way.",
)

CAMERA_NODE = Rule(
    "scene-camera-node",
    Severity.WARNING,
    "The node of a rendering has no camera.",
    "Let camera_node refer to a node with an <instance_camera>.",
    "COLLADA 1.5 §render",
    why="Nothing says from where the scene is seen.",
)
RADIANS = Rule(
    "scene-radians",
    Severity.HINT,
    "An angle looks like radians.",
    "Give it in degrees: 90, not 1.5707963.",
    "COLLADA 1.5 §rotate",
    why="It turns by a degree or two where a large part of a circle is meant.",
)

LAYER = Rule(
    "scene-layer",
    Severity.WARNING,
    "A rendering is of a layer that no node is in.",
    "Name a layer that a node has, or give the layer to the nodes that are meant.",
    "COLLADA 1.5 §render",
    "Nothing is shown of it.",
)
IMAGE_SIZE = Rule(
    "scene-image-size",
    Severity.WARNING,
    "An image has no extent, or a file for a level that it has not.",
    "Sizes are positive, and levels are counted from 0 up to one less than there are.",
    "COLLADA 1.5 §create_2d",
    why="Programs refuse the image, or show nothing of it.",
)

RULES = (
    LAYER,
    IMAGE_SIZE,
    CAMERA_NODE,
    RADIANS,
    COLOR,
    EFFECT_VALUE,
    TRANSFORM_NUMBER,
    ROTATE_AXIS,
    SCALE_ZERO,
    MATRIX_COLUMNS,
    LOOKAT,
    SKEW,
    CAMERA_CLIP,
    CAMERA_VIEW,
    LIGHT,
)
