import numpy as np
import pytest
from scipy.sparse import csr_array

from studio.rbf import NewrbRegressor, RBFRegressor
from studio.rbf.validation import as_inputs, as_targets

LEARNERS = [RBFRegressor(3), NewrbRegressor()]


@pytest.mark.parametrize(
    ("X", "words"),
    [
        ([1.0, np.nan], r"X must be finite, but X\[\(1,\)\] is NaN or inf"),
        ([[1.0, np.inf]], r"X\[\(0, 1\)\] is NaN or inf"),
        ([], "found 0 samples"),
        (np.empty((3, 0)), r"0 feature\(s\)"),
        (np.zeros((2, 2, 2)), r"shape \(n,\) or \(n, d\), not \(2, 2, 2\)"),
        (3.0, "shape"),
        ([1j], "Complex data not supported"),
        (csr_array(np.eye(2)), "sparse"),
    ],
)
def test_inputs_are_refused_in_words(X, words):
    with pytest.raises(ValueError, match=words):
        as_inputs(X)


@pytest.mark.parametrize(
    ("y", "words"),
    [
        (None, "requires y to be passed"),
        ([1.0], "X has 2 samples, but y has 1"),
        ([1.0, np.nan], "y must be finite"),
        (np.empty((2, 0)), "y has shape"),
        (np.zeros((2, 1, 1)), "y has shape"),
    ],
)
def test_targets_are_refused_in_words(y, words):
    with pytest.raises(ValueError, match=words):
        as_targets(y, 2)


@pytest.mark.parametrize("learner", LEARNERS)
def test_prediction_asks_for_the_features_that_were_taught(learner):
    learner.fit(np.arange(6.0).reshape(3, 2), [0.0, 1.0, 2.0])
    with pytest.raises(ValueError, match=r"X has 1 features, but .* is expecting 2 features"):
        learner.predict([[1.0]])
    with pytest.raises(ValueError, match=r"was taught 2 features\. Reshape your data"):
        learner.predict([1.0, 2.0])
    with pytest.raises(ValueError, match="must be finite"):
        learner.predict([[np.nan, 0.0]])
