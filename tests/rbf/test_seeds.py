import csv
import importlib
import re
import tomllib
from pathlib import Path

import numpy as np
import pytest

SEEDS = Path(__file__).resolve().parents[2] / "seeds"


def table_1():
    with (SEEDS / "table1.csv").open(newline="") as file:
        return list(csv.DictReader(file))


def constants():
    return tomllib.loads((SEEDS / "constants.toml").read_text("utf-8"))


def test_table_1_is_whole():
    rows = table_1()
    values = np.array([[float(cell) for cell in row.values()] for row in rows])
    assert list(rows[0]) == [
        "neurons",
        *(f"mse_{joint}" for joint in constants()["driven_joints"]["value"]),
    ]
    assert values[:, 0].tolist() == constants()["neurons"]["value"]
    assert (np.diff(values[:, 1:], axis=0) <= 0.0).all()  # its errors never rise
    assert values[:, 1:].sum() == pytest.approx(0.0528 + 0.1010 + 0.0426)  # no digit was mistyped


def test_every_constant_says_where_it_stands():
    for name, entry in constants().items():
        assert {"value", "where"} <= entry.keys() <= {"value", "unit", "where"}, name
        assert re.search(r"Section|Fig\.|Table", entry["where"]), name


def test_constants_agree_with_each_other():
    stated = {name: entry["value"] for name, entry in constants().items()}
    assert stated["columns"] == len(stated["driven_joints"])
    assert str(stated["samples"]) in stated["network_input"]
    assert stated["gate_sequence"] == ["lasso", "open", "closed"]
    assert stated["remote_api_port"] == 19999


def dotted_names(document):
    text = (SEEDS / document).read_text("utf-8")
    return sorted(set(re.findall(r"`(studio(?:\.\w+)+)`", text)))


@pytest.mark.parametrize("name", dotted_names("equations.md") + dotted_names("slips.md"))
def test_every_function_named_exists(name):
    parts = name.split(".")
    for length in range(len(parts), 0, -1):
        try:
            found = importlib.import_module(".".join(parts[:length]))
        except ModuleNotFoundError:
            continue
        for attribute in parts[length:]:
            found = getattr(found, attribute)  # AttributeError: the index names what is not there
        return
    pytest.fail(f"{name} is nowhere")


def test_every_equation_has_a_row():
    text = (SEEDS / "equations.md").read_text("utf-8")
    named = set()
    for row in re.findall(r"^\| (.*?) \|", text, flags=re.MULTILINE):
        for first, last in re.findall(r"Eq\. (\d+)(?: to (\d+))?", row):
            named |= set(range(int(first), int(last or first) + 1))
        named |= {int(number) for number in re.findall(r", (\d+)", row)}
    assert named >= set(range(1, 16))
