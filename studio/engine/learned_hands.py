"""What the hands do when Baxter does alone what it learned: wrists in the mean, the grip learned.

The grip is one more column: 1 where a demonstration's gripper was closed and 0 where it was open,
learned over index time by a network of Eq. 13 and 14 with as many neurons as the arms'. Above one
half of what it tells the fingers close. That is what one network with that column more would learn,
for each column has weights of its own. Beside the other learners it is the same network: between
the Gaussians of `newrb`, of spread 1, fingers would open again and again, and a field (Eq. 5) knows
no time.
"""

from collections.abc import Sequence
from dataclasses import replace
from typing import Protocol

import numpy as np

from studio.engine.demonstration import SAMPLES, DemonstrationSet
from studio.engine.hands import HandTrack
from studio.engine.skeleton import FloatArray

CLOSED_ABOVE = 0.5  # of what the network tells, 0 for open and 1 for closed


class _Learner(Protocol):
    def fit(self, X: FloatArray, Y: FloatArray) -> object: ...
    def predict(self, X: FloatArray) -> FloatArray: ...


def grip_rows(tracks: Sequence[HandTrack]) -> FloatArray:
    """Return the column (K, 142) of K demonstrations: 1 closed, 0 open."""
    shares = np.linspace(0.0, 1.0, SAMPLES)
    return np.array(
        [
            [float(bool(track.at(share * float(track.times[-1])).closed)) for share in shares]
            for track in tracks
        ]
    )


def learned_hands(
    taught: DemonstrationSet, model: _Learner, index_time: FloatArray
) -> HandTrack | None:
    """Return what the hands do, the grip by ``model``, which is trained here; None without hands.

    ``index_time`` (142,) is the learner's input at the rows.
    """
    mean = taught.hands
    if mean is None or not mean.options.gripper:
        return mean
    tracks = [each.hands for each in taught.demonstrations if each.hands is not None]
    rows = grip_rows([track for track in tracks if track.options == mean.options])
    model.fit(np.tile(index_time, len(rows)), rows.reshape(-1, 1))
    told = model.predict(index_time).reshape(-1)
    return replace(mean, closed=told > CLOSED_ABOVE)
