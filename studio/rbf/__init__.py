"""Radial basis function networks for learning a motion from demonstrations.

Arrays in, arrays out: this package knows numpy and scipy, and nothing of robots. Learners follow
scikit-learn's contract without importing it.

RBFRegressor            the Gaussian network in one linear solve (Eq. 6 to 15, made safe)
NewrbRegressor          MATLAB's newrb, which grows it neuron by neuron (Table I)
StableField             the motion as a field x' = f(x) (Eq. 5), with a proof that it arrives
PlainField              the same as the paper prints it, without one
leave_one_demonstration_out, LeaveOneDemonstrationOut    the error on what was not seen
suggest_neurons         how many are enough, and why
smoothness              what a curve does between the samples
pooled_variance_floor   the error that no function of time can undercut
mean_squared_error, largest_error, r_squared    how good a fit is
save_model, load_model  one JSON file, exact in float64

Equation numbers are those of the source paper; ``seeds/equations.md`` lists where each one lives.
"""

from studio.rbf.certificate import Certificate
from studio.rbf.contract import NotFittedError
from studio.rbf.crossvalidation import (
    HeldOut,
    LeaveOneDemonstrationOut,
    leave_one_demonstration_out,
)
from studio.rbf.newrb import GrowthStep, NewrbRegressor
from studio.rbf.offgrid import Smoothness, smoothness
from studio.rbf.plain_field import PlainField
from studio.rbf.regressor import RBFRegressor
from studio.rbf.score import (
    Floor,
    largest_error,
    mean_squared_error,
    pooled_variance_floor,
    r_squared,
)
from studio.rbf.stable_field import StableField
from studio.rbf.storage import SavedModel, load_model, save_model
from studio.rbf.suggestion import Suggestion, suggest_from, suggest_neurons

__all__ = [
    "Certificate",
    "Floor",
    "GrowthStep",
    "HeldOut",
    "LeaveOneDemonstrationOut",
    "NewrbRegressor",
    "NotFittedError",
    "PlainField",
    "RBFRegressor",
    "SavedModel",
    "Smoothness",
    "StableField",
    "Suggestion",
    "largest_error",
    "leave_one_demonstration_out",
    "load_model",
    "mean_squared_error",
    "pooled_variance_floor",
    "r_squared",
    "save_model",
    "smoothness",
    "suggest_from",
    "suggest_neurons",
]
