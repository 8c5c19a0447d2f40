"""What leaves the studio: one module a kind of file, and a registry of them."""

from studio.engine.export.kind import Job, Kind, StoppedError
from studio.engine.export.material import Material, Take
from studio.engine.export.registry import KINDS, export

__all__ = ["KINDS", "Job", "Kind", "Material", "StoppedError", "Take", "export"]
