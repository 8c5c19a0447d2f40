"""Learners of a motion, from time to joint angles.

`kind` says what a learner is to a sweep, `own` and `rivals` are the learners, `registry` finds
them by name.
"""

from studio.engine.learners.kind import BUDGET, LearnerKind, Settings, require
from studio.engine.learners.registry import LEARNER_KINDS, kind_of

__all__ = ["BUDGET", "LEARNER_KINDS", "LearnerKind", "Settings", "kind_of", "require"]
