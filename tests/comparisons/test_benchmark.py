"""The benchmark on a clock of its own: what it runs, in which order, and what it fits."""

from __future__ import annotations

import json
from dataclasses import replace

import pytest

from comparisons import benchmark_drawn, documents, machine, sheets
from comparisons.benchmark import Plan, measured, sizes_of, trend
from comparisons.choices import Choices
from comparisons.cli.main import run
from comparisons.pairing import Solvers
from scene import Ending
from tests.comparisons.made_up import MadeUp

MACHINE = {"cpu": "made up", "cores": 3, "system": "none", "python": "0", "numpy": "1", "scipy": "2", "scikit-fem": "3"}


class Clock:
    """Time that passes only while a planted solver works: ``law`` of its N, and each call in ``calls``."""

    def __init__(self, *laws):
        self.now, self.calls = 0.0, []
        self.solvers = Solvers(*(self._timed(name, law) for name, law in zip(("cprbm", "fea"), laws, strict=True)))

    def __call__(self):
        return self.now

    def _timed(self, name, law):
        made_up = MadeUp(name, 1e-3)

        def answer(scene, choices):
            n = choices.links if name == "cprbm" else choices.elements
            taken, iterations, ending = law(n)
            self.calls.append((name, n))
            self.now += taken
            found = made_up(scene, choices)
            stations = tuple(
                replace(station, certificate=replace(station.certificate, iterations=iterations))
                for station in found.stations
            )
            return replace(found, stations=stations[: None if ending is Ending.COMPLETED else 4], ending=ending)

        return answer


def power(exponent, iterations=lambda n: 5):
    return lambda n: (2e-3 * n**exponent, iterations(n), Ending.COMPLETED)


def benchmark(hinge, clock, sizes=(40, 80, 160), **plan):
    both = {"cprbm": sizes, "fea": sizes}
    return measured(hinge, Plan(both, Choices(kinematics="bending"), **plan), clock.solvers, MACHINE, clock=clock)


def test_the_exponent_is_that_of_the_law(hinge):
    found = benchmark(hinge, Clock(power(1.2), power(0.9)), repeat=3)
    for method, exponent in (("cprbm", 1.2), ("fea", 0.9)):
        fit = trend(found, method)
        assert fit.exponent == pytest.approx(exponent, rel=1e-9)
        assert fit.factor == pytest.approx(2e-3, rel=1e-9)
        assert fit.sizes == (40, 80, 160)


def test_the_fit_is_by_least_squares_of_the_logarithms(hinge):
    """log₂ of 1, 2 and 8 s at three doublings: slope (3 − 0)/2."""
    times = {40: 1.0, 80: 2.0, 160: 8.0}
    law = lambda n: (times[n], 5, Ending.COMPLETED)  # noqa: E731
    assert trend(benchmark(hinge, Clock(law, law), repeat=1), "fea").exponent == pytest.approx(1.5, rel=1e-12)


def test_smaller_sizes_take_no_part_in_the_fit(hinge):
    law = lambda n: (1.0 if n < 40 else 2e-3 * n, 5, Ending.COMPLETED)  # noqa: E731
    fit = trend(benchmark(hinge, Clock(law, law), sizes=(10, 40, 80), repeat=1), "cprbm")
    assert fit.exponent == pytest.approx(1.0, rel=1e-9)
    assert fit.sizes == (40, 80)


def test_one_size_has_no_exponent(hinge):
    fit = trend(benchmark(hinge, Clock(power(1.0), power(1.0)), sizes=(40,), repeat=2), "cprbm")
    assert fit.exponent is fit.iterations is None


def test_runs_are_interleaved_after_one_that_does_not_count(hinge):
    clock = Clock(power(1.0), power(1.0))
    benchmark(hinge, clock, sizes=(40, 80), repeat=2)
    once = [("cprbm", 40), ("fea", 40), ("cprbm", 80), ("fea", 80)]
    assert clock.calls == [("cprbm", 40), ("fea", 40), *once, *once]


def test_median_and_quartiles(hinge):
    """1, 2, 3, 4 and 10 s: the median is 3, the quartiles 2 and 4."""
    times = iter([99.0, 3.0, 10.0, 1.0, 4.0, 2.0])  # the first does not count
    clock = Clock(lambda n: (next(times), 5, Ending.COMPLETED), power(1.0))
    found = measured(hinge, Plan({"cprbm": (40,)}, Choices(), repeat=5), clock.solvers, MACHINE, clock=clock)
    assert (found.timings[0].median, found.timings[0].spread) == (3.0, 2.0)


def test_iterations_are_counted_in_all_per_station_and_against_the_smallest(hinge):
    found = benchmark(hinge, Clock(power(1.0, lambda n: n // 40), power(1.0)), repeat=1)
    stations = len(hinge.stages[0].stations)
    assert [timing.total_iterations for timing in found.of("cprbm")] == [stations, 2 * stations, 4 * stations]
    assert [timing.iterations_per_station for timing in found.of("cprbm")] == [1.0, 2.0, 4.0]
    assert trend(found, "cprbm").iterations == 4.0
    assert trend(found, "fea").iterations == 1.0


def test_a_run_that_does_not_complete_is_shown_and_not_fitted(hinge):
    ends = lambda n: (100.0, 5, Ending.STEP_TOO_SMALL) if n == 80 else power(1.0)(n)  # noqa: E731
    found = benchmark(hinge, Clock(ends, power(1.0)), repeat=2, at_most=1e3)
    assert [timing.ending for timing in found.of("cprbm")] == [
        Ending.COMPLETED,
        Ending.STEP_TOO_SMALL,
        Ending.COMPLETED,
    ]
    assert trend(found, "cprbm").sizes == (40, 160)
    assert trend(found, "cprbm").exponent == pytest.approx(1.0, rel=1e-9)
    row = next(row for row in documents.benchmark(found)["rows"] if (row["method"], row["n"]) == ("cprbm", 80))
    assert row["ended"] == "STEP_TOO_SMALL"
    assert row["iterations"] == 4 * 5
    assert any("STEP_TOO_SMALL" in line for line in sheets.of_benchmark(found)[0].rows)


def test_what_takes_too_long_is_not_repeated_and_not_exceeded(hinge):
    clock = Clock(lambda n: (n / 40.0, 5, Ending.COMPLETED), power(1.0))
    found = benchmark(hinge, clock, repeat=3, at_most=1.5)
    assert [(timing.n, len(timing.seconds)) for timing in found.of("cprbm")] == [(40, 3), (80, 1)]
    assert found.left_out == {"cprbm": (160,), "fea": ()}
    assert sheets.of_benchmark(found)[1].rows[0][-1] == "160"


def test_sizes_that_are_named_count_for_both_and_the_usual_ones_are_cut_for_the_elements():
    assert sizes_of("cprbm", None) == (40, 80, 160, 320, 640, 1280, 2560, 5120)
    assert sizes_of("fea", None) == (40, 80, 160, 320, 640, 1280)
    assert sizes_of("fea", (5120, 40, 40)) == (40, 5120)


def test_the_document_has_the_documented_keys(hinge):
    data = json.loads(documents.text(documents.benchmark(benchmark(hinge, Clock(power(1.2), power(0.9)), repeat=2))))
    assert {"case", "machine", "rows", "trends"} <= set(data)
    assert data["machine"]["cpu"] == "made up"
    assert len(data["rows"]) == 6
    for row in data["rows"]:
        assert {"method", "formulation", "n", "setup_seconds", "seconds", "spread", "error", "ended"} <= set(row)
        assert row["formulation"] == ("auto" if row["method"] == "cprbm" else None)
        assert row["setup_seconds"] is row["error"] is None
    assert [found["exponent"] for found in data["trends"]] == pytest.approx([1.2, 0.9])


def test_the_figure_is_the_same_bytes_every_time(hinge):
    ends = lambda n: (0.1, 5, Ending.STEP_TOO_SMALL) if n == 80 else power(1.0)(n)  # noqa: E731
    drawn = [benchmark_drawn.of_benchmark(benchmark(hinge, Clock(ends, power(1.0)), repeat=2)) for _ in range(2)]
    assert drawn[0] == drawn[1]
    assert b"<dc:date>" not in drawn[0].svg


def test_the_machine_is_described():
    found = machine.described()
    assert set(found) == set(MACHINE)
    assert found["cores"] >= 1
    assert all(found.values())


def test_bench_prints_writes_and_ends_with_0(right, capsys, tmp_path):
    arguments = ["bench", "hinge", "--sizes", "40,80", "--repeat", "2", "--out", str(tmp_path / "out")]
    assert run([*arguments, "--json", str(tmp_path / "bench.json")], right) == 0
    captured = capsys.readouterr()
    assert "exponent of time" in captured.out
    assert captured.err == ""
    data = json.loads((tmp_path / "bench.json").read_text("utf-8"))
    assert [(row["method"], row["n"], row["repeats"]) for row in data["rows"]] == [
        ("cprbm", 40, 2),
        ("cprbm", 80, 2),
        ("fea", 40, 2),
        ("fea", 80, 2),
    ]
    assert json.loads((tmp_path / "out" / "hinge" / "bench.json").read_text("utf-8")) == data
    assert (tmp_path / "out" / "hinge" / "bench.svg").is_file()
    assert (tmp_path / "out" / "hinge" / "bench.png").is_file()


def test_bench_keeps_standard_output_for_json_and_asks_one_solver_if_told(right, capsys):
    arguments = ["bench", "hinge", "--sizes", "40", "--repeat", "1", "--solver", "fea", "--json", "-"]
    assert run(arguments, right) == 0
    data = json.loads(capsys.readouterr().out)
    assert {row["method"] for row in data["rows"]} == {"fea"}


def test_bench_ends_with_1_if_a_run_does_not_complete(right, capsys, tmp_path):
    clock = Clock(lambda n: (0.1, 5, Ending.STEP_TOO_SMALL), power(1.0))
    arguments = ["bench", "hinge", "--sizes", "40", "--repeat", "1", "--solver", "cprbm", "--out", str(tmp_path)]
    assert run(arguments, Solvers(clock.solvers.cprbm, right.fea)) == 1
    assert (tmp_path / "hinge" / "bench.svg").is_file()
    assert "cprbm at N = 40: " + Ending.STEP_TOO_SMALL.value in capsys.readouterr().err


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["--sizes", "40,many"], "'many'"),
        (["--sizes", ""], "''"),
        (["--repeat", "0"], "'0'"),
        (["--at-most", "-1"], "'-1'"),
        (["--at-most", "nan"], "'nan'"),
        (["--formulation", "other"], "'other'"),
    ],
)
def test_a_wrong_option_is_named(right, capsys, arguments, said):
    assert run(["bench", "hinge", *arguments], right) == 2
    assert said in capsys.readouterr().err
