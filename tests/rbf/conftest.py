"""Synthetic demonstrations of the paper's task, with its floors."""

from collections.abc import Callable, Iterator

import numpy as np
import pytest
from numpy.typing import NDArray
from threadpoolctl import threadpool_limits  # comes with scikit-learn

Demonstrations = Callable[..., NDArray[np.float64]]

PAPER_FLOORS = np.array([0.0079, 0.0106, 0.0070])  # where Table I levels out: s0, s1, e1


def make_demonstrations(seed: int, count: int = 4, samples: int = 142) -> NDArray[np.float64]:
    """Return (count, samples, 3): an arm that pushes down and returns, each time differently.

    The difference is smooth, as between a person's repetitions, with a little sensor noise, and
    scaled so that the pooled variance is exactly what the paper's table levels out at.
    """
    generator = np.random.default_rng(seed)
    phase = np.linspace(0.0, 1.0, samples)
    push = np.exp(-0.5 * ((phase - 0.5) / 0.13) ** 2)
    task = np.column_stack(
        [
            0.2 + 0.35 * push * np.cos(3.0 * phase),
            -0.4 + 0.9 * push - 0.15 * np.sin(2.0 * np.pi * phase),
            1.1 + 0.5 * push + 0.1 * np.sin(4.0 * np.pi * phase),
        ]
    )
    waves = np.cos(np.pi * np.arange(6)[:, np.newaxis] * phase)  # (6, samples)
    sizes = generator.normal(size=(count, 3, 6)) / np.arange(1, 7)
    varied = np.einsum("kdw,wt->ktd", sizes, waves)
    varied += 0.02 * generator.normal(size=varied.shape)
    around = varied - varied.mean(axis=0)
    return task + varied * np.sqrt(PAPER_FLOORS / np.square(around).mean(axis=(0, 1)))


def pooled(demonstrations: NDArray[np.float64]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return index time 1..T repeated for each demonstration (K T,), and the rows (K T, D)."""
    count, samples, outputs = demonstrations.shape
    index = np.tile(np.arange(1.0, samples + 1.0), count)
    return index, demonstrations.reshape(-1, outputs)


@pytest.fixture(autouse=True, scope="package")
def one_thread() -> Iterator[None]:
    """Keep BLAS to one thread: for matrices this small, more only wait for each other."""
    with threadpool_limits(1):
        yield


@pytest.fixture
def demonstrations() -> Demonstrations:
    return make_demonstrations


@pytest.fixture
def pool() -> Callable[..., tuple[NDArray[np.float64], NDArray[np.float64]]]:
    return pooled
