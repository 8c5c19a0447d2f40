from importlib.util import find_spec

import numpy as np
import pytest

from studio.engine.learners.rivals import RIVALS, Standardized, unstacked
from studio.engine.sweep import INPUTS, stacked
from studio.rbf import RBFRegressor, pooled_variance_floor
from tests.engine.sweeps import samples


def installed(kind):
    missing = [module for module in kind.needs if find_spec(module) is None]
    skip = pytest.mark.skipif(bool(missing), reason=f"needs {', '.join(missing)}")
    return pytest.param(kind, id=kind.name, marks=skip)


@pytest.mark.parametrize("kind", [installed(kind) for kind in RIVALS])
def test_each_learns_the_push_with_some_setting(kind):
    rows = samples().rows
    floor = pooled_variance_floor(rows).value.mean()
    ratios = []
    for settings in kind.settings[2:6]:
        model = kind.model(settings).fit(*stacked(rows))
        curve = model.predict(INPUTS)
        assert curve.shape == (142, 4)
        np.testing.assert_allclose(model.predict(INPUTS[[70, 3]]), curve[[70, 3]], atol=1e-6)
        ratios.append(np.square(rows - curve).mean() / floor)
    assert 1.0 - 1e-9 <= min(ratios) < 1.2


@pytest.mark.parametrize("kind", [installed(kind) for kind in RIVALS])
def test_the_same_data_give_the_same_answer(kind):
    inputs, rows = stacked(samples().rows)
    settings = kind.settings[3]
    first, second = (kind.model(settings).fit(inputs, rows).predict(INPUTS) for _ in range(2))
    np.testing.assert_array_equal(first, second)


def test_standardizing_changes_nothing_for_a_learner_that_knows_no_scale():
    inputs, rows = stacked(samples().rows)
    plain = RBFRegressor(15, width="dmax", solver="svd").fit(inputs, rows).predict(INPUTS)
    inner = RBFRegressor(15, width="dmax", solver="svd")
    np.testing.assert_allclose(
        Standardized(inner).fit(inputs, rows).predict(INPUTS), plain, atol=1e-8
    )


def test_outputs_that_never_change_stay_as_they_are():
    rows = np.column_stack([np.sin(INPUTS[:, 0] / 20.0), np.full(142, 0.3)])
    found = Standardized(RBFRegressor(15)).fit(INPUTS, rows).predict(INPUTS)
    np.testing.assert_allclose(found[:, 1], 0.3, atol=1e-15)


def test_unstacking_undoes_stacking():
    stamps, demonstrations = unstacked(*stacked(samples().rows))
    np.testing.assert_array_equal(stamps, INPUTS[:, 0])
    np.testing.assert_array_equal(demonstrations, samples().rows)
