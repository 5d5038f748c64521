"""Meshes, and scenes of objects that stand at many places."""
from __future__ import annotations

import os
from typing import Any, Callable, Dict, List, Mapping, NamedTuple, Optional, Tuple, Union

import numpy as np

from . import _sgm
from .errors import Diagnostic

Progress = Optional[Callable[[str, float], Any]]
Point = Tuple[float, float, float]


class Part(NamedTuple):
    """A shape that owns surface: its path in the shape tree, and the rule and line that made it."""

    path: str
    symbol: str
    rule: str
    file: str
    line: int
    material: int


class Material(NamedTuple):
    """How a part looks: a linear colour, roughness and metalness of 0 to 1."""

    name: str
    color: Point
    roughness: float
    metallic: float


class Mesh:
    """A closed, oriented mesh of triangles. Its arrays show its own memory: they are read-only and keep it alive."""

    def __init__(self, core: _sgm.Mesh) -> None:
        self._core = core

    def __repr__(self) -> str:
        return f"<sgm.Mesh, {len(self.positions)} vertices, {len(self.triangles)} triangles>"

    @property
    def positions(self) -> np.ndarray:
        """Vertices, float32 of shape (n, 3), metres."""
        return self._core.positions

    @property
    def normals(self) -> np.ndarray:
        """Unit normals by vertex, float32 of shape (n, 3); on hard edges see corner_normals."""
        return self._core.normals

    @property
    def triangles(self) -> np.ndarray:
        """Vertices of each triangle, uint32 of shape (m, 3), counter-clockwise seen from outside."""
        return self._core.triangles

    @property
    def origins(self) -> np.ndarray:
        """The part of each triangle, uint32 of shape (m,): indices into parts."""
        return self._core.origins

    @property
    def corner_normals(self) -> np.ndarray:
        """Unit normals by corner of triangle, float32 of shape (m, 3, 3), hard edges included; made when asked for."""
        return self._core.corner_normals

    @property
    def parts(self) -> List[Part]:
        """What `origins` counts; the first stands for nobody's."""
        return [Part(*row) for row in self._core.parts]

    @property
    def materials(self) -> List[Material]:
        """What Part.material counts."""
        return [Material(*row) for row in self._core.materials]

    @property
    def triangle_materials(self) -> np.ndarray:
        """The material of each triangle, uint32 of shape (m,)."""
        return np.array([row[5] for row in self._core.parts], np.uint32)[self.origins]

    @property
    def cell(self) -> float:
        """The edge of the cells that it was made with, metres."""
        return self._core.cell

    @property
    def stages(self) -> Dict[str, float]:
        """Seconds that its making took, by stage; "arrays" is what the arrays cost."""
        return self._core.stages

    def report(self) -> Dict[str, Any]:
        """Figures: `mesh` (triangles, components, cavities among them, edges that aren't closed, volume, area, bounds,
        how many components float), `field` (instructions, evaluations) and `stages`."""
        return {"mesh": self._core.figures, "field": self._core.field_figures, "stages": self.stages}

    def save(self, path: Union[str, "os.PathLike[str]"], *, objects: str = "", collider: str = "", levels: int = 1,
             options: Optional[Mapping[str, str]] = None, progress: Progress = None) -> None:
        """Writes it in the format that the file's ending names, all or nothing: as `sgm build -o` does, `objects`,
        `collider` and `levels` being --objects, --collider and --lod, `options` those of the format."""
        self._core.save(os.fspath(path), objects, collider, levels, dict(options or {}), progress)


class Place(NamedTuple):
    """The shape that holds an object of a scene: its path in the shape tree, and the rule and line that made it."""

    path: str
    rule: str
    file: str
    line: int


class SceneObject(NamedTuple):
    """An object that stands at one or more places: a name that no other has, what decides it, its mesh in its own frame."""

    name: str
    values: Dict[str, str]
    mesh: Mesh


class Scene:
    """The objects that `place` puts into a model, each once, and their places.

        scene = grammar.model(apart=True).scene()
        for number, matrix in zip(scene.object_of, scene.matrices):
            scene.objects[number].mesh, matrix
    """

    def __init__(self, core: _sgm.Scene) -> None:
        self._core = core
        self._objects = [SceneObject(name, values, Mesh(mesh)) for name, values, mesh in core.objects]

    def __repr__(self) -> str:
        return f"<sgm.Scene, {len(self._objects)} objects at {len(self.object_of)} places>"

    @property
    def objects(self) -> List[SceneObject]:
        """The different objects."""
        return list(self._objects)

    @property
    def object_of(self) -> np.ndarray:
        """For each place the object that stands there, uint32 of shape (n,): indices into objects."""
        return self._core.object_of

    @property
    def matrices(self) -> np.ndarray:
        """For each place the matrix that takes the object's frame to the model's, float64 of shape (n, 4, 4): columns are
        the axes and the origin, so that a point p of the object is at M[:3, :3] @ p + M[:3, 3]. Turns and moves alone."""
        return self._core.matrices

    @property
    def places(self) -> List[Place]:
        """The shape behind each place."""
        return [Place(*row) for row in self._core.places]

    @property
    def warnings(self) -> Tuple[Diagnostic, ...]:
        """What the derivations of the objects warned of, each once."""
        return Diagnostic._read(self._core.warnings)

    @property
    def stages(self) -> Dict[str, float]:
        """Seconds that its making took, by stage."""
        return self._core.stages

    def save(self, path: Union[str, "os.PathLike[str]"], ground: Optional[Mesh] = None, *,
             options: Optional[Mapping[str, str]] = None, progress: Progress = None) -> None:
        """Writes all of it beside the mesh of the model itself, as `sgm build -o` does: formats that hold instances
        have each object once, others one mesh of everything."""
        self._core.save(os.fspath(path), None if ground is None else ground._core, dict(options or {}), progress)
