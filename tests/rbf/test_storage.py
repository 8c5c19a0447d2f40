import json
import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from studio.rbf import (
    NewrbRegressor,
    NotFittedError,
    PlainField,
    RBFRegressor,
    StableField,
    load_model,
    save_model,
)

INDEX = np.arange(1.0, 13.0)


def save(path, estimator):
    save_model(path, estimator, time_unit="index", duration=4.7)
    return path


@settings(deadline=None, derandomize=True, max_examples=40)
@given(
    seed=st.integers(0, 10_000),
    neurons=st.integers(1, 40),
    outputs=st.sampled_from([None, 1, 3]),
    kind=st.sampled_from(["rbf", "svd", "newrb", "matlab"]),
)
def test_a_model_predicts_the_same_bits_after_its_file(
    tmp_path_factory, seed, neurons, outputs, kind
):
    generator = np.random.default_rng(seed)
    inputs = np.sort(generator.uniform(0.0, 9.0, size=40))[generator.integers(0, 40, size=90)]
    targets = generator.normal(size=(90,) if outputs is None else (90, outputs))
    estimator = {
        "rbf": RBFRegressor(neurons),
        "svd": RBFRegressor(neurons, "random", "dmax", "svd", random_state=seed),
        "newrb": NewrbRegressor(spread=0.3, max_neurons=neurons),
        "matlab": NewrbRegressor(spread=0.3, max_neurons=neurons, duplicates="matlab"),
    }[kind].fit(inputs, targets)
    loaded = load_model(save(tmp_path_factory.mktemp("models") / "model.json", estimator))
    asked = np.linspace(-1.0, 10.0, 501)
    np.testing.assert_array_equal(loaded.estimator.predict(asked), estimator.predict(asked))
    assert repr(loaded.estimator) == repr(estimator)
    assert (loaded.time_unit, loaded.duration) == ("index", 4.7)


@pytest.mark.parametrize(
    "estimator",
    [
        RBFRegressor(5, centers=np.array([[1.0], [1.0], [4.0]])),
        RBFRegressor(5, centers=np.array([1.0, 5.0]), width=2, solver=1),
        NewrbRegressor(max_neurons=5),
    ],
)
def test_everything_learned_comes_back(tmp_path, estimator):
    estimator.fit(np.tile(INDEX, 2), np.random.default_rng(0).normal(size=(24, 2)))
    loaded = load_model(save(tmp_path / "model.json", estimator)).estimator
    assert vars(loaded).keys() == vars(estimator).keys()
    for name, value in vars(estimator).items():
        if name == "history_":
            for found, expected in zip(loaded.history_, value, strict=True):
                np.testing.assert_array_equal(found.mse, expected.mse)
                assert (found.neurons, found.floor_ratio, found.distinct_centers) == (
                    expected.neurons,
                    expected.floor_ratio,
                    expected.distinct_centers,
                )
        else:
            np.testing.assert_array_equal(getattr(loaded, name), value)
    refitted = loaded.fit(INDEX, INDEX)  # the settings came back as well
    np.testing.assert_array_equal(
        refitted.predict(INDEX),
        type(estimator)(**estimator.get_params()).fit(INDEX, INDEX).predict(INDEX),
    )


def test_infinite_condition_and_missing_floor_come_back(tmp_path):
    lonely = RBFRegressor(centers=[1.0, 1e9], width=1e-3).fit(INDEX, INDEX)
    assert lonely.condition_ == math.inf
    assert load_model(save(tmp_path / "a.json", lonely)).estimator.condition_ == math.inf
    unique = NewrbRegressor(max_neurons=2).fit(INDEX, INDEX)
    loaded = load_model(save(tmp_path / "b.json", unique)).estimator
    assert loaded.floor_ is None
    assert loaded.history_[0].floor_ratio is None


def test_a_generator_is_no_setting_to_write(tmp_path):
    drawn = RBFRegressor(3, "random", random_state=np.random.default_rng(0)).fit(INDEX, INDEX)
    assert load_model(save(tmp_path / "model.json", drawn)).estimator.random_state is None


def test_only_whole_models_are_written(tmp_path):
    with pytest.raises(NotFittedError):
        save(tmp_path / "model.json", RBFRegressor())
    fitted = RBFRegressor(2).fit(INDEX, INDEX)
    with pytest.raises(ValueError, match="names the unit"):
        save_model(tmp_path / "model.json", fitted, time_unit="", duration=1.0)
    with pytest.raises(ValueError, match="duration is a finite number above 0"):
        save_model(tmp_path / "model.json", fitted, time_unit="s", duration=0.0)
    assert list(tmp_path.iterdir()) == []
    save(tmp_path / "model.json", fitted)
    assert [path.name for path in tmp_path.iterdir()] == ["model.json"]


@pytest.mark.parametrize("field", [StableField([0.0, 0.0], 4), PlainField(7)])
def test_a_field_flows_the_same_after_its_file(tmp_path, field):
    field.fit([(INDEX, HOOK), (INDEX, 1.1 * HOOK)])
    loaded = load_model(save(tmp_path / "field.json", field)).estimator
    starts = np.random.default_rng(0).normal(scale=9.0, size=(30, 2))
    np.testing.assert_array_equal(loaded.velocity(starts), field.velocity(starts))
    np.testing.assert_array_equal(loaded.rollout(starts, 0.1, 50), field.rollout(starts, 0.1, 50))
    assert repr(loaded) == repr(field)
    assert vars(loaded).keys() == vars(field).keys()


def test_a_certificate_is_worked_out_and_not_believed(tmp_path):
    field = StableField(n_translations=4, n_neurons=4).fit([(INDEX, HOOK)])
    path = save(tmp_path / "field.json", field)
    assert load_model(path).estimator.certificate_ == field.certificate_
    document = json.loads(path.read_text("utf-8"))
    flattered = put(document, ("learned", "certificate", "steepness"), 0.01)
    folded = put(document, ("learned", "map", "widths", 0), 1e-6)
    for forged, words in ((flattered, "steepness: expected"), (folded, "map: translation 0 has")):
        path.write_text(json.dumps(forged), "utf-8")
        with pytest.raises(ValueError, match=words):
            load_model(path)


def test_a_missing_file_is_told_as_such(tmp_path):
    with pytest.raises(FileNotFoundError):
        load_model(tmp_path / "none.json")


HOOK = np.column_stack([12.0 - INDEX, np.sin(INDEX / 4.0) * (12.0 - INDEX)])


@pytest.fixture(params=["rbf", "newrb", "stable", "plain"])
def document(request, tmp_path):
    if request.param in ("rbf", "newrb"):
        estimator = RBFRegressor(3) if request.param == "rbf" else NewrbRegressor(max_neurons=2)
        estimator.fit(np.tile(INDEX, 2), np.random.default_rng(0).normal(size=(24, 2)))
    else:
        small = StableField(n_translations=2, n_neurons=2)
        estimator = small if request.param == "stable" else PlainField(2)
        estimator.fit([(INDEX, HOOK)])
    return json.loads(save(tmp_path / "good.json", estimator).read_text("utf-8"))


def complaint_about(path):
    """Return what loading complains of, or None if the model can be used."""
    try:
        estimator = load_model(path).estimator
    except ValueError as error:
        return str(error)
    is_field = hasattr(estimator, "velocity")
    answer = estimator.velocity(HOOK) if is_field else estimator.predict(INDEX)
    assert answer.shape == (12, 2)
    return None


def places(value, path=()):
    yield path
    entries = (
        value.items()
        if isinstance(value, dict)
        else enumerate(value)
        if isinstance(value, list)
        else ()
    )
    for key, entry in entries:
        yield from places(entry, (*path, key))


def put(document, path, value):
    copy = json.loads(json.dumps(document))
    *parents, last = path
    target = copy
    for key in parents:
        target = target[key]
    target[last] = value
    return copy


@pytest.mark.parametrize(
    "value",
    ["text", True, [], {}, [[[1.0]]], float("nan"), float("inf"), -7, 10**400],
    ids=["text", "true", "list", "object", "nested", "nan", "inf", "negative", "huge"],
)
def test_a_wrong_value_anywhere_is_refused_with_its_place(document, tmp_path, value):
    path = tmp_path / "bad.json"
    for place in places(document):
        if not place or "settings" in place or place == ("time", "unit"):
            continue
        path.write_text(json.dumps(put(document, place, value)), "utf-8")
        complaint = complaint_about(path)
        if complaint is None:  # a number for a number
            assert value == -7
        else:
            assert str(path) in complaint
            assert any(key in complaint for key in place if isinstance(key, str)), place


@pytest.mark.parametrize("document", ["rbf", "newrb"], indirect=True)
def test_a_network_of_no_features_is_refused(document, tmp_path):
    empty = put(document, ("learned", "n_features_in"), 0)
    empty = put(empty, ("learned", "centers"), [[] for _ in document["learned"]["centers"]])
    path = tmp_path / "bad.json"
    path.write_text(json.dumps(empty), "utf-8")
    with pytest.raises(ValueError, match=r"centers: expected finite numbers of shape"):
        load_model(path)


def test_a_missing_value_anywhere_is_refused(document, tmp_path):
    path = tmp_path / "bad.json"
    for place in places(document):
        if not place or not isinstance(place[-1], str):
            continue
        copy = put(document, place, None)
        target = copy
        for key in place[:-1]:
            target = target[key]
        del target[place[-1]]
        path.write_text(json.dumps(copy), "utf-8")
        with pytest.raises(ValueError, match=place[-1]):
            load_model(path)


def test_every_cut_and_every_flipped_byte_is_refused_or_harmless(document, tmp_path):
    path = tmp_path / "bad.json"
    content = json.dumps(document).encode()
    for length in range(len(content)):
        path.write_bytes(content[:length])
        with pytest.raises(ValueError, match=r"bad\.json"):
            load_model(path)
    generator = np.random.default_rng(0)
    for place in generator.integers(0, len(content), size=400):
        broken = bytearray(content)
        broken[place] ^= 1 << int(generator.integers(0, 8))
        path.write_bytes(bytes(broken))
        complaint = complaint_about(path)
        assert complaint is None or "bad.json" in complaint  # None: a digit became another digit


@pytest.mark.parametrize(
    ("content", "words"),
    [
        (b"", "not a JSON file"),
        (b"\xff\xfe", "not a JSON file"),
        (b"[" * 100_000, "not a JSON file"),
        (b"[]", "expected a JSON object, found \\[\\]"),
        (b"{}", "format: expected 'teaching-studio rbf model', found nothing"),
        (b'{"format": "teaching-studio rbf model", "schema": 3}', "schema: expected 2, found 3"),
    ],
)
def test_what_is_no_model_is_refused_in_words(tmp_path, content, words):
    path = tmp_path / "other.json"
    path.write_bytes(content)
    with pytest.raises(ValueError, match=words):
        load_model(path)
