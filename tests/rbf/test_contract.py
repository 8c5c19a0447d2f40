import doctest
import importlib
import warnings

import numpy as np
import pytest
from sklearn.base import clone, is_regressor
from sklearn.model_selection import GridSearchCV, LeaveOneGroupOut
from sklearn.pipeline import make_pipeline
from sklearn.preprocessing import StandardScaler
from sklearn.utils.estimator_checks import estimator_checks_generator
from sklearn.utils.validation import check_is_fitted

import studio.rbf
from studio.rbf import NewrbRegressor, NotFittedError, RBFRegressor

INDEX = np.arange(1.0, 143.0)
LEARNERS = [
    RBFRegressor(random_state=0),
    RBFRegressor(centers="ols"),
    NewrbRegressor(),
    NewrbRegressor(duplicates="matlab"),
]
DO_NOT_APPLY = {
    "check_fit1d": "inputs of one axis are welcome here: they are time",
    "check_estimators_unfitted": "asks for scikit-learn's NotFittedError, which is not imported",
}


def all_checks():
    found = []
    with warnings.catch_warnings():  # we follow the contract, and inherit nothing
        warnings.filterwarnings("ignore", message=".*does not inherit from `sklearn.base")
        for learner in LEARNERS:
            for estimator, check in estimator_checks_generator(learner):
                found.append(pytest.param(estimator, check, id=f"{learner}-{check.func.__name__}"))
    return found


@pytest.mark.parametrize(("estimator", "check"), all_checks())
def test_scikit_learns_own_checks(estimator, check):
    if check.func.__name__ in DO_NOT_APPLY:
        with pytest.raises(AssertionError):  # the day it passes, it leaves the list
            check(estimator)
    else:
        check(estimator)


@pytest.mark.parametrize("learner", LEARNERS)
def test_clone_and_parameters(learner):
    copy = clone(learner)
    assert copy is not learner
    assert copy.get_params() == learner.get_params()
    assert is_regressor(learner)
    own = RBFRegressor(centers=np.array([1.0, 2.0]))
    np.testing.assert_array_equal(clone(own).centers, own.centers)


def test_unknown_settings_are_refused_and_nothing_changes():
    model = RBFRegressor()
    with pytest.raises(ValueError, match="RBFRegressor has no setting 'neurons'; it has n_neurons"):
        model.set_params(width=3.0, neurons=5)
    assert model.width == "gcv"
    assert model.set_params(width=3.0) is model
    assert model.width == 3.0


def test_not_fitted_is_what_scikit_learns_would_be():
    assert issubclass(NotFittedError, ValueError)
    assert issubclass(NotFittedError, AttributeError)
    model = RBFRegressor(3)
    with pytest.raises(ValueError, match="not fitted"):
        check_is_fitted(model)
    check_is_fitted(model.fit(INDEX, INDEX))


def test_scikit_learns_tools_accept_the_learners(demonstrations, pool):
    index, rows = pool(demonstrations(0, samples=40))
    groups = np.repeat(np.arange(4), 40)  # by demonstration, never by frame
    search = GridSearchCV(RBFRegressor(), {"n_neurons": [3, 12]}, cv=LeaveOneGroupOut())
    search.fit(index[:, np.newaxis], rows, groups=groups)
    assert search.best_params_ == {"n_neurons": 12}
    line = make_pipeline(StandardScaler(), NewrbRegressor(spread=0.5, max_neurons=15))
    assert line.fit(index[:, np.newaxis], rows).score(index[:, np.newaxis], rows) > 0.5


@pytest.mark.parametrize("learner", LEARNERS)
def test_settings_are_judged_in_fit_only(learner):
    type(learner)(**dict.fromkeys(learner.get_params(), object()))  # raises nothing


@pytest.mark.parametrize("name", studio.rbf.__all__)
def test_every_public_name_has_an_example_that_runs(name):
    found = getattr(studio.rbf, name)
    module = importlib.import_module(found.__module__)
    examples = doctest.DocTestFinder().find(found, name, globs=vars(module).copy())
    assert any(example.examples for example in examples)
    runner = doctest.DocTestRunner()
    for example in examples:
        runner.run(example)
    assert runner.summarize().failed == 0
