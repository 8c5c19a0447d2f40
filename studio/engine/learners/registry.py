"""All learners by name, the studio's own first."""

from studio.engine.errors import StudioError
from studio.engine.learners.kind import LearnerKind
from studio.engine.learners.own import OWN
from studio.engine.learners.rivals import RIVALS

LEARNER_KINDS = {kind.name: kind for kind in (*OWN, *RIVALS)}


def kind_of(name: str) -> LearnerKind:
    """Return a learner by name; raise StudioError with the names there are."""
    if name not in LEARNER_KINDS:
        raise StudioError(f"unknown learner {name!r}; there are {', '.join(LEARNER_KINDS)}, all")
    return LEARNER_KINDS[name]
