"""What can go wrong with a robot, found before its mission from its knowledge model alone."""

from rosa_verification.causes import Cause, Region
from rosa_verification.choices import Choices, Flapping, NeverSelected
from rosa_verification.cut_sets import CutSets, MinimalSets, PathSets
from rosa_verification.gaps import Contradiction, Gap
from rosa_verification.model_findings import ModelFindings, verify_model
from rosa_verification.structure import Structure

__all__ = [
    "Cause",
    "Choices",
    "Contradiction",
    "CutSets",
    "Flapping",
    "Gap",
    "MinimalSets",
    "ModelFindings",
    "NeverSelected",
    "PathSets",
    "Region",
    "Structure",
    "verify_model",
]
