"""Virtual worlds in space: bodies of any shape and material, which may move, with friction.

::

    from ebac import Scenario, simulate, worlds

    ball = worlds.Body(solid=worlds.Placed(worlds.Sphere(radius=0.02), at=(0.02, 0, 0)), friction=0.3)
    trace = simulate(Scenario(environment=worlds.World(ball)), "ebac")
"""

from ebac._core import (
    Box,
    BridgeParams,
    Capsule,
    Cylinder,
    Elastic,
    EngineTiming,
    HuntCrossley,
    Layer,
    Plane,
    Sphere,
    Swing,
    Texture,
    Torus,
)
from ebac._util.lazy import unknown
from ebac.worlds.answers import LocalModel
from ebac.worlds.closed_forms import Puncture
from ebac.worlds.engine_process import EngineProcess
from ebac.worlds.engine_thread import EngineError, EngineThread
from ebac.worlds.engines import Bridge, BridgeReport, FunctionWorld
from ebac.worlds.force_depth import ForceDepth, force_depth
from ebac.worlds.height_field import HeightField
from ebac.worlds.mesh import Mesh
from ebac.worlds.mujoco import MujocoEngine
from ebac.worlds.presets import PRESETS, WorldPreset, preset
from ebac.worlds.serving import serve_engine
from ebac.worlds.solids import (
    Cavity,
    Difference,
    Intersection,
    Placed,
    Textured,
    Tube,
    Union,
    distance,
)
from ebac.worlds.triangles import GridError
from ebac.worlds.world import Body, Layered, Touch, World

__all__ = [
    "PRESETS",
    "Body",
    "Box",
    "Bridge",
    "BridgeParams",
    "BridgeReport",
    "Capsule",
    "Cavity",
    "Cylinder",
    "Difference",
    "Elastic",
    "EngineError",
    "EngineProcess",
    "EngineThread",
    "EngineTiming",
    "ForceDepth",
    "FunctionWorld",
    "GridError",
    "HeightField",
    "HuntCrossley",
    "Intersection",
    "Layer",
    "Layered",
    "LocalModel",
    "Mesh",
    "MujocoEngine",
    "Placed",
    "Plane",
    "Puncture",
    "Sphere",
    "Swing",
    "Texture",
    "Textured",
    "Torus",
    "Touch",
    "Tube",
    "Union",
    "World",
    "WorldPreset",
    "distance",
    "force_depth",
    "preset",
    "serve_engine",
]


def __dir__() -> list[str]:
    return __all__


def __getattr__(name: str) -> object:
    raise unknown(__name__, name, __all__)
