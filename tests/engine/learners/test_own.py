import numpy as np
import pytest
from scipy.interpolate import make_smoothing_spline

from studio.engine.errors import StudioError
from studio.engine.learners import BUDGET, LEARNER_KINDS, LearnerKind, kind_of, require
from studio.engine.learners.own import OWN, SmoothingSpline
from studio.engine.sweep import INPUTS, stacked
from tests.engine.sweeps import samples


def test_all_learners_have_the_same_budget_and_unlike_settings():
    for kind in LEARNER_KINDS.values():
        assert len(kind.settings) == BUDGET, kind.name
        assert len({str(settings) for settings in kind.settings}) == BUDGET, kind.name


@pytest.mark.parametrize("kind", OWN, ids=lambda kind: kind.name)
def test_every_setting_of_our_own_learners_answers(kind):
    rows = samples().rows[:2]
    few = (kind.settings[0], kind.settings[-1])  # of fields, which take half a second each
    for settings in few if kind.name == "field" else kind.settings:
        curve = kind.model(settings).fit(*stacked(rows)).predict(INPUTS)
        assert curve.shape == (142, 4)
        assert np.isfinite(curve).all()


def test_the_spline_is_scipys_through_the_means():
    rows = samples().rows
    found = SmoothingSpline(3.0).fit(*stacked(rows)).predict(INPUTS)
    mean = rows.mean(axis=0)
    weights = np.full(142, 4.0)
    for place in range(4):
        spline = make_smoothing_spline(INPUTS[:, 0], mean[:, place], weights, 3.0)
        np.testing.assert_allclose(found[:, place], spline(INPUTS[:, 0]), atol=1e-12)


def test_unknown_learners_and_missing_packages_are_told_with_the_cure():
    with pytest.raises(StudioError, match="unknown learner 'magic'; there are newrb, rbf, gcv"):
        kind_of("magic")
    absent = LearnerKind("x", "x", lambda: None, (), needs=("no_such_package.at_all",))
    for use in (lambda: require(absent), lambda: absent.model({})):
        with pytest.raises(StudioError, match=r"pip install 'teaching-studio\[compare\]'"):
            use()
