"""Synthetic demonstrations that end in a goal, for the fields."""

import numpy as np
from numpy.typing import NDArray


def bent_reach(
    seed: int, count: int = 3, samples: int = 80, dimension: int = 2
) -> list[tuple[NDArray[np.float64], NDArray[np.float64]]]:
    """Return (times, positions) of hands that swing to the origin, each a little differently."""
    generator = np.random.default_rng(seed)
    phase = np.linspace(0.0, 1.0, samples)
    eased = 3.0 * phase**2 - 2.0 * phase**3  # begins and ends at rest
    waves = generator.normal(scale=0.35, size=(3, dimension))
    straight = generator.normal(size=dimension)
    straight *= 3.0 / np.linalg.norm(straight)
    demonstrations = []
    for _ in range(count):
        start = straight + 0.1 * generator.normal(size=dimension)
        bend = sum(
            np.sin((k + 1) * np.pi * eased)[:, np.newaxis]
            * (wave + 0.03 * generator.normal(size=dimension))
            for k, wave in enumerate(waves)
        )
        times = phase * generator.uniform(1.5, 2.0)
        demonstrations.append((times, (1.0 - eased)[:, np.newaxis] * (start + 2.0 * bend)))
    return demonstrations
