import builtins

import pytest

from studio.engine.errors import StudioError
from studio.engine.parallel import run_all


def square(number):
    return number * number


def without_joblib(monkeypatch):
    plain = builtins.__import__

    def refuse(name, *rest, **more):
        if name == "joblib":
            raise ModuleNotFoundError(name)
        return plain(name, *rest, **more)

    monkeypatch.setattr(builtins, "__import__", refuse)


def test_the_order_is_kept_and_nothing_is_nothing():
    assert run_all(square, range(5)) == [0, 1, 4, 9, 16]
    assert run_all(square, []) == []


def test_without_joblib_one_after_the_other_or_a_cure(monkeypatch):
    without_joblib(monkeypatch)
    assert run_all(square, [3, 4], jobs=1) == [9, 16]
    with pytest.raises(StudioError, match=r"2 jobs at once need joblib: pip install"):
        run_all(square, [3, 4], jobs=2)


def test_several_jobs_give_the_same():
    joblib = pytest.importorskip("joblib", reason="joblib comes with the extra compare")
    with joblib.parallel_config(backend="threading"):
        assert run_all(square, range(5), jobs=2) == [0, 1, 4, 9, 16]
