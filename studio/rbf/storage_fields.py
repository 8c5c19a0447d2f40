"""Reading a stored field with suspicion: the certificate is worked out anew, never believed."""

from dataclasses import asdict

import numpy as np

from studio.rbf.certificate import Certificate
from studio.rbf.diffeomorphism import Diffeomorphism
from studio.rbf.pace import Pace
from studio.rbf.plain_field import PlainField
from studio.rbf.regressor import RBFRegressor
from studio.rbf.stable_field import StableField
from studio.rbf.storage_reader import MOST_FEATURES, Table, rbf_from, settings_of


def stable_field_from(settings: Table, learned: Table) -> StableField:
    """Return a stable field, or raise ValueError where it is mangled or its map may fold."""
    field = StableField(**settings_of(settings, StableField))
    dimension = learned.count("n_features_in", MOST_FEATURES)
    chain, pace = learned.table("map"), learned.table("pace")
    centers = chain.array("centers", (None, dimension))
    try:
        field.map_ = Diffeomorphism(
            centers,
            chain.array("shifts", centers.shape),
            chain.array("widths", centers.shape[:1]),
        )
    except ValueError as error:
        raise ValueError(f"{chain.place}: {error}") from error
    field.pace_ = Pace(
        _network(pace, dimension, outputs=None),
        slowest=pace.number("slowest", positive=True),
        fastest=pace.number("fastest", positive=True),
    )
    field.n_features_in_ = dimension
    field.goal_ = learned.array("goal", (dimension,))
    field.unit_ = learned.number("unit", positive=True)
    field.error_ = learned.number("error")
    field.certificate_ = Certificate.of(field.map_, field.pace_)
    if not field.certificate_.holds:
        raise pace.fault("fastest", "no less than the slowest rate")
    written = learned.table("certificate")
    for name, value in asdict(field.certificate_).items():
        written.expect(name, value)
    return field


def plain_field_from(settings: Table, learned: Table) -> PlainField:
    """Return a plain field, or raise ValueError where it is mangled."""
    field = PlainField(**settings_of(settings, PlainField))
    dimension = learned.count("n_features_in", MOST_FEATURES)
    field.network_ = _network(learned, dimension, outputs=dimension)
    field.n_features_in_ = dimension
    return field


def _network(table: Table, inputs: int, outputs: int | None) -> RBFRegressor:
    """Return the network in a table; outputs None stands for a single number."""
    network = table.table("network")
    found = rbf_from(network.table("settings"), network.table("learned"))
    if found.n_features_in_ != inputs or np.shape(found.bias_) != (
        () if outputs is None else (outputs,)
    ):
        raise table.fault("network", f"a network of {inputs} inputs and {outputs or 1} outputs")
    return found
