import builtins

import pytest

from studio.engine import parallel
from studio.engine.errors import StudioError
from studio.engine.parallel import most_jobs, run_all, run_each


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


def test_each_result_comes_as_soon_as_it_is_there(monkeypatch):
    done = []

    def noted(number):
        done.append(number)
        return number

    found = run_each(noted, [1, 2, 3], jobs=1)
    assert next(found) == 1
    assert done == [1]
    without_joblib(monkeypatch)
    found = run_each(noted, [4, 5], jobs=1)
    assert (next(found), done) == (4, [1, 4])


def test_as_many_jobs_as_processors_or_one_without_joblib(monkeypatch):
    assert most_jobs() >= 1
    monkeypatch.setattr(parallel, "has_joblib", lambda: False)
    assert most_jobs() == 1


def test_several_jobs_give_the_same():
    joblib = pytest.importorskip("joblib", reason="joblib comes with the extra compare")
    with joblib.parallel_config(backend="threading"):
        assert run_all(square, range(5), jobs=2) == [0, 1, 4, 9, 16]
