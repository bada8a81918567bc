"""raypencil: exact answers to rays on meshes, and a rover's structured-light vision simulated twice.

``cast`` answers rays exactly, ``judge`` compares one's own answers with the truth; ``render``, ``validate``, ``pack``,
``check``, ``diff`` and ``drive`` are the commands of the same names. docs/guide/python.md has examples.
"""

from . import terrain, testing
from ._campaign import CampaignResult, campaign
from ._cast import cast, cast_chunks
from ._cast_result import AllHits, CastResult
from ._drive import Drive, ElevationMap, Frame, Sectors, Vectors, drive
from ._errors import RaypencilError, RaypencilFileError, RaypencilFileNotFoundError, RaypencilWarning
from ._judge import Judgement, judge
from ._load import load
from ._mesh import Mesh, load_mesh
from ._packs import CheckResult, check, pack, pack_rays, read
from ._raypencil import __version__
from ._render import RenderResult, render
from ._scene import Beam, Camera, Pose, RaySet, Returns, Scene
from ._sweep import SweepResult, sweep
from ._validate import DiffResult, ValidationResult, diff, validate

__all__ = [
    "AllHits",
    "Beam",
    "Camera",
    "CampaignResult",
    "CastResult",
    "CheckResult",
    "DiffResult",
    "Drive",
    "ElevationMap",
    "Frame",
    "Judgement",
    "Mesh",
    "Pose",
    "RaySet",
    "Returns",
    "RaypencilError",
    "RaypencilFileError",
    "RaypencilFileNotFoundError",
    "RaypencilWarning",
    "RenderResult",
    "Scene",
    "Sectors",
    "SweepResult",
    "ValidationResult",
    "Vectors",
    "__version__",
    "campaign",
    "cast",
    "cast_chunks",
    "check",
    "diff",
    "drive",
    "judge",
    "load",
    "load_mesh",
    "pack",
    "pack_rays",
    "read",
    "render",
    "sweep",
    "terrain",
    "testing",
    "validate",
]
