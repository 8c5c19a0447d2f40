"""What scikit-learn asks of every learner, without importing scikit-learn.

Settings are dataclass fields, set in ``__init__`` and judged in ``fit``; what ``fit`` learns ends
in an underscore. The learners delegate to these functions rather than inherit.
"""

import dataclasses
import sys
from collections.abc import Mapping
from typing import Any


class NotFittedError(ValueError, AttributeError):
    """A learner was asked before it was taught.

    Examples
    --------
    >>> from studio.rbf import RBFRegressor
    >>> RBFRegressor().predict([1.0])
    Traceback (most recent call last):
        ...
    studio.rbf.contract.NotFittedError: this RBFRegressor was taught nothing yet: call fit

    """


def get_settings(estimator: Any) -> dict[str, Any]:
    """Return the settings by name, as `get_params` of scikit-learn does."""
    return {field.name: getattr(estimator, field.name) for field in dataclasses.fields(estimator)}


def change_settings(estimator: Any, settings: Mapping[str, Any]) -> None:
    """Set some settings anew, as `set_params` of scikit-learn does.

    Raises
    ------
    ValueError
        Where there is no setting of such a name; nothing is changed then.

    """
    known = get_settings(estimator)
    for name in settings:
        if name not in known:
            raise ValueError(
                f"{type(estimator).__name__} has no setting {name!r}; it has {', '.join(known)}"
            )
    for name, value in settings.items():
        setattr(estimator, name, value)


def require_fitted(estimator: Any) -> None:
    """Raise NotFittedError unless `fit` has been called."""
    if not hasattr(estimator, "n_features_in_"):  # what `fit` sets last
        raise NotFittedError(f"this {type(estimator).__name__} was taught nothing yet: call fit")


def regressor_tags() -> Any:
    """Return what scikit-learn wants to know of a regressor of one or several outputs.

    Only scikit-learn asks, so its module is loaded by then and need not be imported here.
    """
    sklearn = sys.modules["sklearn.utils"]
    return sklearn.Tags(
        estimator_type="regressor",
        target_tags=sklearn.TargetTags(required=True, multi_output=True),
        regressor_tags=sklearn.RegressorTags(),
        input_tags=sklearn.InputTags(one_d_array=False),
    )
