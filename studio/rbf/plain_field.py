"""The paper's Eq. 5 as it is printed: velocities learned where demonstrations went, and no more."""

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any, Self

import numpy as np
from numpy.typing import ArrayLike

from studio.rbf.basis import FloatArray
from studio.rbf.contract import change_settings, get_settings, require_fitted
from studio.rbf.regressor import RBFRegressor
from studio.rbf.trajectories import as_states, read_demonstrations
from studio.rbf.validation import number_above, whole_number


@dataclass(eq=False)
class PlainField:
    """A field ``x' = f(x)`` with the f of Eq. 6 to 15, and nothing that holds it.

    The network learns the demonstrated velocities; where no demonstration went it answers their
    mean, and nothing makes its paths end at the goal. It stands here to be compared with
    `StableField`: most of its paths stop on the way or pass the goal.

    Parameters
    ----------
    n_neurons : int, default 50
        Gaussians, centered on samples that are spread out, of the width of Eq. 13.

    Attributes
    ----------
    network_ : RBFRegressor
        From positions (n, d) to velocities (n, d).
    n_features_in_ : int
        The dimension d.

    Examples
    --------
    >>> import numpy as np
    >>> t = np.linspace(0.0, 3.0, 60)
    >>> line = np.column_stack([np.exp(-t), 2.0 * np.exp(-t)])  # x' = -x
    >>> field = PlainField(n_neurons=10).fit([(t, line)])
    >>> field.velocity(line[30]).round(1)
    array([-0.2, -0.4])
    >>> field.rollout([1.0, 2.0], dt=0.1, steps=20).shape
    (21, 2)

    """

    n_neurons: int = 50

    def fit(
        self,
        demonstrations: Iterable[ArrayLike] | Iterable[tuple[ArrayLike, ArrayLike]],
        dt: float | None = None,
    ) -> Self:
        """Learn from demonstrations, given as to `StableField.fit`.

        Raises
        ------
        ValueError, TypeError
            Where a setting or a demonstration cannot be used; the message says which and why.

        """
        trajectories = read_demonstrations(demonstrations, dt)
        network = RBFRegressor(self.n_neurons, centers="grid", width="dmax", solver="svd")
        self.network_ = network.fit(
            np.concatenate([each.positions for each in trajectories]),
            np.concatenate([each.velocities for each in trajectories]),
        )
        self.n_features_in_ = trajectories[0].positions.shape[1]
        return self

    def velocity(self, x: ArrayLike) -> FloatArray:
        """Return the velocity at points (d,) or (n, d), of the same shape.

        Raises
        ------
        NotFittedError
            Before `fit`.
        ValueError
            Where the points cannot be used.

        """
        require_fitted(self)
        points, shape = as_states(x, self.n_features_in_)
        return self.network_.predict(points).reshape(shape)

    def rollout(self, x0: ArrayLike, dt: float, steps: int) -> FloatArray:
        """Return the path from a start (d,): (steps + 1, d); of several (n, d): (steps + 1, n, d).

        By Runge-Kutta's fourth order.

        Raises
        ------
        NotFittedError
            Before `fit`.
        ValueError, TypeError
            Where the starts, dt or steps cannot be used.

        """
        require_fitted(self)
        step = number_above(dt, "dt", 0.0, inclusive=False)
        points, shape = as_states(x0, self.n_features_in_)
        path = [points]
        for _ in range(whole_number(steps, "steps")):
            path.append(self._moved(path[-1], step))
        return np.stack(path).reshape(-1, *shape)

    def get_params(self, deep: bool = True) -> dict[str, Any]:  # noqa: ARG002 scikit-learn's name
        """Return the settings by name."""
        return get_settings(self)

    def set_params(self, **params: Any) -> Self:
        """Change settings by name; raise ValueError for a name that is none."""
        change_settings(self, params)
        return self

    def _moved(self, points: FloatArray, step: float) -> FloatArray:
        velocity = self.network_.predict
        first = velocity(points)
        second = velocity(points + 0.5 * step * first)
        third = velocity(points + 0.5 * step * second)
        fourth = velocity(points + step * third)
        moved: FloatArray = points + step / 6.0 * (first + 2.0 * (second + third) + fourth)
        return moved
