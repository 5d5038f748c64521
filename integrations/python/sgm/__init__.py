"""Shape grammars and their fields in Python: grammar -> parameters -> mesh, values, level set.

    import sgm
    grammar = sgm.load("tower.sgm")
    mesh = grammar.model(floors=12).mesh(resolution=256)
    mesh.positions, mesh.triangles      # NumPy arrays that show the mesh's own memory

Lengths are metres, y is up.
"""
from __future__ import annotations

import json
import os
from typing import Any, Dict, Iterable, List, Mapping, NamedTuple, Optional, Tuple, Union

import numpy as np

from . import _sgm
from .errors import BudgetError, Cancelled, Diagnostic, Error, GrammarError, InternalError, UsageError
from .mesh import Material, Mesh, Part, Place, Point, Progress, Scene, SceneObject

__all__ = [
    "BudgetError", "Cancelled", "Diagnostic", "Error", "Grammar", "GrammarError", "InternalError", "LevelSet", "Live",
    "Material", "Mesh", "Model", "Parameter", "Part", "Place", "Scene", "SceneObject", "Style", "UsageError", "load", "parse",
]
__version__: str = _sgm.version

Value = Union[bool, int, float, str, Iterable[float]]


class Parameter(NamedTuple):
    """A parameter of a grammar. Numbers are in `unit`: "m", "deg", "%", "/m" or ""."""

    name: str
    kind: str  # "integer", "real", "vector", "choice", "color", "boolean", "text", "rotation", "axis"
    default: Any
    minimum: Any = None
    maximum: Any = None
    unit: str = ""
    choices: Tuple[str, ...] = ()
    label: str = ""
    group: str = ""
    line: int = 0


class Style(NamedTuple):
    """A named set of values; `start` is "" where it is for any start."""

    name: str
    start: str
    values: Dict[str, Any]


def load(path: Union[str, "os.PathLike[str]"]) -> Grammar:
    """The grammar of a file. Raises GrammarError where it has errors or can't be read."""
    return Grammar(_sgm.Grammar.load(os.fspath(path)))


def parse(text: str, name: str = "grammar.sgm") -> Grammar:
    """The grammar that a text says. `name` is what diagnostics call it; files that it uses lie in that name's folder."""
    return Grammar(_sgm.Grammar.parse(text, name))


def _number_text(number: Any, unit: str) -> str:
    return (str(number) if isinstance(number, int) else np.format_float_positional(number, trim="-")) + unit


def _text_of(parameter: Parameter, value: Any) -> str:
    """A value as the grammar's language writes it."""
    if isinstance(value, np.generic):
        value = value.item()
    if parameter.kind == "text":
        return '"' + str(value).replace("\\", "\\\\").replace('"', '\\"') + '"'
    if isinstance(value, str):
        return value
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, (int, float)):
        return _number_text(value, parameter.unit)
    return "(" + ", ".join(_number_text(number, parameter.unit) for number in np.asarray(value).tolist()) + ")"


class Grammar:
    """A checked grammar: its parameters, and the models that they make."""

    def __init__(self, core: _sgm.Grammar) -> None:
        self._core = core
        panel = json.loads(core.panel)
        names = Parameter._fields
        self._parameters = {
            entry["name"]: Parameter(**{name: tuple(entry[name]) if name == "choices" else entry[name]
                                        for name in names if name in entry})
            for entry in panel["parameters"]
        }
        self._panel = panel

    def __repr__(self) -> str:
        return f"<sgm.Grammar {self.name!r}, {len(self._parameters)} parameters>"

    @property
    def name(self) -> str:
        """What diagnostics call it: its file."""
        return self._core.name

    @property
    def text(self) -> str:
        """Its source text."""
        return self._core.text

    @property
    def parameters(self) -> Dict[str, Parameter]:
        """The parameters by name, in the order of the text."""
        return dict(self._parameters)

    @property
    def starts(self) -> List[str]:
        """The start symbols; the first is taken where none is said."""
        return [start["name"] for start in self._panel["starts"]]

    @property
    def styles(self) -> List[Style]:
        """The named sets of values."""
        return [Style(style["name"], style.get("start", ""), dict(style["values"])) for style in self._panel["styles"]]

    @property
    def ways(self) -> List[str]:
        """The names of its `derive` lines."""
        return list(self._panel["ways"])

    @property
    def warnings(self) -> Tuple[Diagnostic, ...]:
        """What the checker warned of."""
        return Diagnostic._read(self._core.warnings)

    def model(self, parameters: Optional[Mapping[str, Value]] = None, /, *, seed: int = 1, start: str = "",
              style: str = "", derive: str = "", max_shapes: int = 250_000, max_seconds: float = 600, threads: int = 0,
              apart: bool = False, progress: Progress = None, **more: Value) -> Model:
        """The model of these values of parameters, by a mapping or by keywords; the others have their defaults.

        Numbers are in the parameter's unit, colours are "#rrggbb", and a text is read as the language writes values:
        "3m", "45deg". `threads` 0 takes all. `progress(stage, fraction)` is called now and then; an exception from it
        ends the work. Objects that `place` puts are part of the field, or where `apart` is said left out of it: then
        Model.scene makes each of them once. Raises UsageError for unknown names, GrammarError for values that don't fit and for errors of
        the derivation, BudgetError where it makes too much.
        """
        choice = self._choice(parameters, more, seed, start, style, derive, max_shapes, max_seconds)
        return Model(self._core.model(choice, threads, apart, progress))

    def live(self, *, resolution: int = 128, cell: Optional[float] = None, surface: str = "crisp",
             tolerance: Optional[float] = 0, threads: int = 0) -> Live:
        """A model that follows its parameters: see Live. By default its meshes aren't simplified."""
        return Live(self, _request(resolution, cell, surface, "all", 0, 1, tolerance), threads)

    def _choice(self, parameters: Optional[Mapping[str, Value]], more: Mapping[str, Value], seed: int, start: str,
                style: str, derive: str, max_shapes: int, max_seconds: float) -> _sgm.Choice:
        settings = []
        for name, value in {**(parameters or {}), **more}.items():
            known = self._parameters.get(name, Parameter(name, "", None))
            settings.append(f"{name}={_text_of(known, value)}")
        return _sgm.Choice(settings, seed, start, style, derive, max_shapes, max_seconds)


def _request(resolution: int, cell: Optional[float], surface: str, keep: str, smooth: int, simplify: float,
             tolerance: Optional[float]) -> _sgm.MeshRequest:
    return _sgm.MeshRequest(resolution, cell, surface, keep, smooth, simplify, tolerance)


class Model:
    """A field made by a grammar: negative inside, in metres."""

    def __init__(self, core: _sgm.Model) -> None:
        self._core = core

    def __repr__(self) -> str:
        return f"<sgm.Model, {self._core.shapes} shapes, {self._core.instructions} instructions>"

    @property
    def bounds(self) -> Tuple[Point, Point]:
        """The lowest and the highest corner of a box that holds the surface."""
        return self._core.bounds

    @property
    def seed(self) -> int:
        """The seed of all random choices."""
        return self._core.seed

    @property
    def parameters(self) -> Dict[str, str]:
        """The values of all parameters, as the language writes them."""
        return self._core.parameters

    @property
    def warnings(self) -> Tuple[Diagnostic, ...]:
        """What the derivation warned of: closed joints, cuts that remove nothing."""
        return Diagnostic._read(self._core.warnings)

    @property
    def lipschitz(self) -> float:
        """How fast the field's values may change, metres a metre."""
        return self._core.lipschitz

    @property
    def stages(self) -> Dict[str, float]:
        """Seconds that its making took, by stage."""
        return self._core.stages

    def values(self, points: Any) -> np.ndarray:
        """The field at points of shape (..., 3), as float32 of shape (...). Points that aren't float32 are converted."""
        return self._core.values(points)

    def gradients(self, points: Any) -> Tuple[np.ndarray, np.ndarray]:
        """The values and the derivatives by x, y and z, of shapes (...) and (..., 3); at a kink those of one side."""
        return self._core.gradients(points)

    def origins(self, points: Any) -> np.ndarray:
        """For each point the part whose surface decides the field there: indices into Mesh.parts."""
        return self._core.origins(points)

    def mesh(self, resolution: int = 128, *, cell: Optional[float] = None, surface: str = "crisp", keep: str = "all",
             smooth: int = 0, simplify: float = 1, tolerance: Optional[float] = None,
             progress: Progress = None) -> Mesh:
        """The closed mesh, with so many cells along the longest side of the bounds, or cells of `cell` metres.

        The others are as the options of `sgm build`: surface "crisp" or "cubes", keep "all", "grounded" or "largest",
        passes of smoothing, simplification to a share of the triangles or to a tolerance in metres, which for a crisp
        mesh is a hundredth of a cell where nothing is said; 0 keeps all triangles.
        """
        return Mesh(self._core.mesh(_request(resolution, cell, surface, keep, smooth, simplify, tolerance), progress))

    def scene(self, resolution: int = 128, *, cell: Optional[float] = None, surface: str = "crisp", keep: str = "all",
              smooth: int = 0, simplify: float = 1, tolerance: Optional[float] = None, max_places: int = 250_000,
              progress: Progress = None) -> Scene:
        """The objects that `place` puts, each meshed once, and where they stand. The model is one of `apart=True`; its
        own mesh is that of Model.mesh. Arguments are those of Model.mesh, cells being counted along each object."""
        request = _request(resolution, cell, surface, keep, smooth, simplify, tolerance)
        return Scene(self._core.scene(request, max_places, progress))

    def level_set(self, resolution: int = 128, *, cell: Optional[float] = None, half_width: int = 3,
                  progress: Progress = None) -> LevelSet:
        """Signed distances in a narrow band of `half_width` voxels (1 to 32) to each side of the surface."""
        return LevelSet(self._core.level_set(resolution, cell, half_width, progress))


class LevelSet:
    """A narrow band of distances to the surface, negative inside, metres."""

    def __init__(self, core: _sgm.LevelSet) -> None:
        self._core = core

    @property
    def values(self) -> np.ndarray:
        """The voxels of the band's box, float32, by x, y, z; beyond the band the band's width. Read-only."""
        return self._core.values

    @property
    def origin(self) -> Point:
        """Where voxel (0, 0, 0) is, metres."""
        return self._core.origin

    @property
    def voxel(self) -> float:
        """The edge of a voxel, metres."""
        return self._core.voxel

    @property
    def stages(self) -> Dict[str, float]:
        """Seconds that its making took, by stage."""
        return self._core.stages

    def save(self, path: Union[str, "os.PathLike[str]"], *, options: Optional[Mapping[str, str]] = None,
             progress: Progress = None) -> None:
        """Writes a .vdb, all or nothing; `options` are those of the format, as {"grids": "fog"}."""
        self._core.save(os.fspath(path), dict(options or {}), progress)


class Live:
    """A model whose parameters change: every stage keeps what a change doesn't reach. One caller at a time.

        live = grammar.live(resolution=128)
        for height in range(3, 12):
            mesh = live.mesh(height=height)

    All meshes lie on one grid while the model fits into it.
    """

    def __init__(self, grammar: Grammar, request: _sgm.MeshRequest, threads: int) -> None:
        self._grammar = grammar
        self._core = _sgm.Live(grammar._core, request, threads)

    def mesh(self, parameters: Optional[Mapping[str, Value]] = None, /, *, seed: int = 1, start: str = "",
             style: str = "", derive: str = "", max_shapes: int = 250_000, max_seconds: float = 600,
             progress: Progress = None, **more: Value) -> Mesh:
        """The mesh of these values; arguments and exceptions are those of Grammar.model. Earlier meshes stay."""
        choice = self._grammar._choice(parameters, more, seed, start, style, derive, max_shapes, max_seconds)
        return Mesh(self._core.mesh(choice, progress))

    @property
    def followed(self) -> bool:
        """Whether no stage up to the field had to start over for the last mesh."""
        return self._core.followed

    @property
    def blocks_made(self) -> int:
        """Blocks of 32 x 32 x 32 cells that the last mesh made anew."""
        return self._core.blocks_made

    @property
    def blocks_kept(self) -> int:
        """Blocks that it kept."""
        return self._core.blocks_kept
