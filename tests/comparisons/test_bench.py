"""The benchmark on a made-up clock: runs and the order of runs, fits, and the fastest method."""

from __future__ import annotations

import json
from dataclasses import replace

import numpy as np
import pytest

from comparisons import cases, geometry, provenance
from comparisons.bench import measures, section
from comparisons.bench.running import CLOCKS, Contender, Outcome, Run, Session, contenders, sizes_of, trend
from comparisons.bench.section import TARGETS, ratios, seconds_at, standings
from comparisons.choices import Choices
from comparisons.cli.main import run
from comparisons.pairing import Solvers
from comparisons.writing import text_of
from cprbm_scene import Ending, Mistake, SceneError
from cprbm_scene.frozendict import frozendict
from tests.verdict.made_up import MadeUp

MACHINE = {"cpu": "made up", "cores": 3, "system": "none", "python": "0", "numpy": "1", "scipy": "2", "scikit-fem": "3"}
OF_RATIOS = {
    "auto": {"ratios": ("both",)},
    "slsqp": {"tolerance": 1e-6, "ratios": ("both",)},
    "ipopt": {"tolerance": 1e-6, "ratios": ("solve", "both")},
}
FEW = frozendict({"beam1": 30, "beam2": 40})


class Clock:
    """Time passes only while a planted method works: a law gives set-up, solve, iterations and ending at N."""

    def __init__(self, scene, **laws):
        self.now, self.calls, self.scene = 0.0, [], scene
        self.taking_part = tuple(self._contender(name.replace("_", "-"), law) for name, law in laws.items())

    def __call__(self):
        return self.now

    def _contender(self, name, law):
        def begin(scene, count, at_most):
            found = law(count if isinstance(count, int) else max(count.values()))
            if isinstance(found, SceneError):
                raise found
            setup, solve, iterations, ended, error = found

            def set_up():
                self.calls.append((name, count))
                self.now += setup
                return finish

            def finish():
                self.now += solve
                values = {
                    "B.displacement": np.array([1.0 + error, 0.0]),
                    "contact.force": np.array([2.0 + 20.0 * error]),
                }
                return Outcome(ended, "" if ended == "COMPLETED" else "why not", (iterations,) * 2, frozendict(values))

            return Run(set_up, lambda outcome: outcome)

        method = "cprbm" if name in ("auto", "paper") else name
        formulation = None if name == "fea" else name if method == "cprbm" else "paper"
        return Contender(name, method, formulation, name.upper(), begin, **OF_RATIOS.get(name, {}))

    def session(self, sizes=(40, 80, 160), **plan):
        CLOCKS["wall"] = self
        sizes = dict.fromkeys(self.taking_part, tuple(sizes))
        return Session(self.scene, MACHINE, sizes, KNOWN, **plan)

    def benchmark(self, sizes=(40, 80, 160), **plan):
        return self.session(sizes, **plan).after_all()


KNOWN = measures.Reference(
    "made up",
    frozendict({"B.displacement": np.array([1.0, 0.0]), "contact.force": np.array([2.0])}),
    frozendict({"B.displacement": np.array([0.0, 0.0]), "contact.force": np.array([1e-7])}),
)


def law(solve, setup=0.0, iterations=5, ended="COMPLETED", error=0.0):
    """A law of :class:`Clock` from the seconds of a solve at N."""
    return lambda n: (setup, solve(n), iterations, ended, error)


def power(exponent, setup=0.0, iterations=lambda n: 5, error=lambda n: 1.6 / n**2):
    return lambda n: (setup, 2e-3 * n**exponent - setup, iterations(n), "COMPLETED", error(n))


@pytest.fixture
def bent(hinge, monkeypatch):
    monkeypatch.setitem(CLOCKS, "wall", CLOCKS["wall"])  # a made-up clock ends with the test
    return measures.benchmark_scene(hinge)


def test_times_are_fitted_by_least_squares_at_the_larger_sizes_and_stand_in_the_document(bent):
    found = Clock(bent, auto=power(1.2, setup=1e-3), fea=power(0.9)).benchmark(repeat=3)
    for name, exponent in (("auto", 1.2), ("fea", 0.9)):
        assert trend(found.rows(name))[:2] == ((40, 80, 160), pytest.approx(exponent, rel=1e-9))
    assert found.rows("auto")[0].median("set-up") == pytest.approx(1e-3)
    assert found.rows("auto")[0].median("solve") == pytest.approx(2e-3 * 40**1.2 - 1e-3)
    data = json.loads(text_of(section.document(found)))
    assert {"case", "machine", "rows", "trends", "fastest", "ratios", "left_out", "reference", "tolerance"} <= set(data)
    assert data["machine"]["cpu"] == "made up"
    assert len(data["rows"]) == 6
    for row in data["rows"]:
        assert {"method", "formulation", "n", "setup_seconds", "seconds", "spread", "error", "ended"} <= set(row)
        assert row["formulation"] == ("auto" if row["method"] == "cprbm" else None)
    assert data["rows"][0]["error"] == pytest.approx(1e-3)
    assert data["rows"][0]["force_error"] == pytest.approx(1e-2)
    assert [each["exponent"] for each in data["trends"]] == pytest.approx([1.2, 0.9])
    for sizes, method, used, exponent in (
        ((40, 80, 160), law({40: 1.0, 80: 2.0, 160: 8.0}.get), (40, 80, 160), 1.5),  # log₂ at three doublings: 3/2
        ((10, 40, 80), law(lambda n: 1.0 if n < 40 else 2e-3 * n), (40, 80), 1.0),
        ((40,), power(1.0), (40,), None),
    ):
        fit = trend(Clock(bent, auto=method).benchmark(sizes=sizes, repeat=1).rows("auto"))
        assert fit[:2] == (used, None if exponent is None else pytest.approx(exponent, rel=1e-9)), sizes
    assert fit[2] is None


def test_the_order_of_runs_and_the_runs_that_count(bent):
    slow = law(lambda n: n / 400.0, setup=1.0)
    clock = Clock(bent, auto=slow, fea=slow)
    clock.benchmark(sizes=(400, 800), repeat=2, at_most=9.0)
    again = [("auto", 800), ("fea", 800)]
    once = [("auto", 400), ("fea", 400), *again]
    # one run of every method and size warms up; the sizes of the other rounds are interleaved
    assert clock.calls == [("auto", 400), ("auto", 400), ("fea", 400), ("fea", 400), *again, *once]
    # of two runs of less than a second in a row the second counts
    times = iter([0.9, 0.7, 0.2, 0.9, 0.3, 0.8, 0.4, 3.0])
    found = Clock(bent, auto=law(lambda n: next(times))).benchmark(sizes=(40,), repeat=4)
    assert [solve for _, solve in found.rows()[0].seconds] == pytest.approx((0.2, 0.3, 0.4, 3.0))
    # a run above the limit of time is not repeated, and no larger size follows
    found = Clock(bent, auto=law(lambda n: n / 40.0), fea=power(0.1)).benchmark(repeat=4, at_most=1.5)
    assert [(timing.n, len(timing.seconds)) for timing in found.rows("auto")] == [(40, 2), (80, 1)]
    assert list(found.omissions()) == [("auto", 160, "more than 1.5 s")]


def test_median_quartiles_and_iterations(bent):
    # 1, 2, 3, 4 and 10 s: the median is 3, the quartiles 2 and 4.
    times = iter([99.0, 3.0, 10.0, 1.0, 4.0, 2.0])  # the first does not count
    found = Clock(bent, auto=lambda n: (0.5, next(times), 5, "COMPLETED", 0.0)).benchmark(sizes=(40,), repeat=5)
    (row,) = found.rows()
    assert (row.median("set-up"), row.median("solve"), row.median("both"), row.spread("solve")) == (0.5, 3.0, 3.5, 2.0)
    found = Clock(bent, auto=power(1.0, iterations=lambda n: n // 40)).benchmark(repeat=1)
    assert [timing.iterations for timing in found.rows("auto")] == [2, 4, 8]
    assert [timing.iterations_per_station for timing in found.rows("auto")] == [1.0, 2.0, 4.0]
    assert trend(found.rows("auto"))[2] == 4.0


def test_rows_that_do_not_complete_or_have_a_worse_error_do_not_count(bent):
    gave_up = law(lambda n: 1e-6, ended="GAVE_UP")
    found = Clock(bent, paper=power(1.0), ipopt=lambda n: (gave_up if n == 80 else power(1.0))(n)).benchmark(repeat=2)
    assert trend(found.rows("ipopt"))[0] == (40, 160)
    row = next(row for row in section.document(found)["rows"] if (row["method"], row["n"]) == ("ipopt", 80))
    assert (row["ended"], row["why"], row["counts"]) == ("GAVE_UP", "why not", False)
    assert any("GAVE_UP" in line for line in section.tables_of(found)[0].rows)
    assert [one["n"] for one in ratios(found)] == [40, 160]
    clock = Clock(bent, auto=power(1.0), paper=power(1.0), ipopt=gave_up)
    (one,) = ratios(clock.benchmark(sizes=(40,), repeat=1))
    assert one["auto_both"] == pytest.approx(1.0)
    assert (one["ipopt_solve"], one["ipopt_both"]) == (None, None)
    assert section.pictures(Clock(bent, auto=gave_up).benchmark(repeat=1)) == ()
    # a peer solves the problem of ``paper``; the finite elements solve another
    wrong = lambda n: (0.0, 1e-6, 5, "COMPLETED", 3.2 / n**2 if n == 80 else 1.6 / n**2)  # noqa: E731
    found = Clock(bent, paper=power(1.0), ipopt=wrong, fea=power(1.0, error=lambda n: 1.0)).benchmark(repeat=1)
    assert [timing.counts for timing in found.rows("ipopt")] == [True, False, True]
    assert [timing.counts for timing in found.rows("fea")] == [True, True, True]
    assert [section.ending_of(timing) for timing in found.rows("ipopt")] == ["COMPLETED", "WORSE", "COMPLETED"]


def test_a_refused_size_is_left_out_and_a_question_that_all_methods_refuse_is_refused(bent):
    refused = SceneError([Mistake("contacts.contact.paper", "2 joints", "3")])
    found = Clock(bent, paper=lambda n: refused if n == 40 else power(1.0)(n)).benchmark(repeat=2)
    assert [timing.n for timing in found.rows()] == [80, 160]
    why = "contacts.contact.paper: found 2 joints; allowed: 3"
    assert list(found.omissions()) == [("paper", 40, why)]
    assert ("paper", "40", why) in section.tables_of(found)[-1].rows
    refused = SceneError([Mistake("beams", "none", "some")])
    with pytest.raises(SceneError, match="beams"):
        Clock(bent, auto=lambda n: refused, fea=lambda n: refused).benchmark(repeat=1).rows()


def test_sizes_end_with_the_method_and_may_be_numbers_by_beam(bent):
    found = Clock(bent, auto=power(1.0), paper=power(1.0)).benchmark(sizes=(20, FEW), repeat=1)
    assert [timing.n for timing in found.rows("auto")] == [20.0, 35.0]
    assert section.size_text(FEW) == "30, 40"
    assert section.document(found)["rows"][1]["n"] == {"beam1": 30, "beam2": 40}
    auto, paper, fea = contenders(Solvers(), Choices())
    assert [sizes_of(one, ())[-1] for one in (auto, paper, fea)] == [5120, 640, 1280]
    assert sizes_of(replace(auto, largest=80), ()) == (10, 20, 40, 80)
    assert sizes_of(auto, (5120, 40, 40)) == (40, 5120)


def test_when_an_error_is_reached_and_who_is_fastest(bent):
    for points, target, seconds in (
        ([(1e-1, 1.0), (1e-3, 4.0)], 1e-2, 2.0),  # half-way in both logarithms
        ([(1e-1, 1.0), (1e-3, 4.0)], 1e-1, 1.0),
        ([(1e-3, 7.0), (1e-5, 9.0)], 1e-2, 7.0),  # no point is before
        ([(1e-1, 1.0), (5e-2, 4.0)], 1e-2, None),
        ([(1e-1, 1.0), (1e-3, 2.0), (1e-1, 3.0), (1e-3, 4.0)], 1e-2, 12.0**0.5),  # the first was an accident
        ([(1e-3, 1.0), (1e-1, 2.0)], 1e-2, None),
        ([], 1e-2, None),
    ):
        assert seconds_at(points, target) == (None if seconds is None else pytest.approx(seconds, rel=1e-12)), points
    # errors 1.6/N²: 1e-3 at N = 40 and a quarter of the error per doubling
    slow = lambda n: (0.03, 1e-3 * n, 5, "COMPLETED", 1.6 / n**2)  # noqa: E731
    fast = lambda n: (0.0, 2e-3 * n, 5, "COMPLETED", 1.6 / n**2)  # noqa: E731
    found = Clock(bent, auto=slow, fea=fast).benchmark(sizes=(20, 40, 80, 160), repeat=1)
    by_key = {(one["measure"], one["error"], one["clocked"]): one for one in standings(found)}
    assert len(by_key) == 2 * 2 * len(TARGETS)
    solve, both = (by_key["places", 1e-3, clocked] for clocked in ("solve", "both"))
    assert solve["fastest"] == "auto"
    assert solve["ahead"] == pytest.approx(2.0)
    assert both["seconds"] == pytest.approx({"auto": 0.07, "fea": 0.08})
    # at 1e-4, N = 126.5: 0.253 s, and for the other method between 0.11 s and 0.19 s
    fine = by_key["places", 1e-4, "both"]
    assert fine["seconds"]["fea"] == pytest.approx(2e-3 * 16000**0.5, rel=1e-12)
    # forces: 10 times the error
    assert by_key["forces", 1e-4, "both"]["seconds"] == {}
    assert by_key["forces", 1e-4, "both"]["fastest"] is None


def test_ratios_are_of_solves_and_of_both(bent):
    found = Clock(
        bent,
        auto=law(lambda n: 2.0, setup=1.0, iterations=6, error=0.1),
        paper=law(lambda n: 1.0, setup=1.0, error=0.1),
        slsqp=law(lambda n: 800.0, error=0.1),
        ipopt=law(lambda n: 3.0, setup=17.0, error=0.1),
    ).benchmark(sizes=(40,), repeat=1, at_most=1e6)
    (one,) = ratios(found)
    expected = {"auto_both": 1.5, "slsqp_both": 400.0, "ipopt_solve": 3.0, "ipopt_both": 10.0}
    assert one == {"n": 40, **expected, "iterations_per_station": 5.0}
    assert section.document(found)["ratios"] == [one]
    (table,) = (sheet for sheet in section.tables_of(found) if sheet.title.startswith("How many times longer"))
    assert table.headers == ("N", "AUTO", "SLSQP", "IPOPT, solve", "IPOPT, both", "iterations per station")


def test_an_error_is_the_worst_of_its_measure_over_the_size_of_the_probe(bent):
    off = {"B.displacement": np.array([1.0, 2e-3]), "D.displacement": np.array([1e-5, 0.0])}
    known = replace(
        KNOWN, values=frozendict({"B.displacement": np.array([1.0, 0.0]), "D.displacement": np.array([0.0, 0.0])})
    )
    assert measures.errors(bent, known, off) == {"places": pytest.approx(1e-2)}
    assert measures.errors(bent, known, {}) == {}
    assert measures.uncertainties(bent, KNOWN) == {"places": 0.0, "forces": pytest.approx(5e-8)}
    known = replace(KNOWN, values=frozendict({"B.displacement": np.zeros(2)}))
    longest = max(geometry.length(beam.curve) for beam in bent.beams.values())
    # 1e-4 of the longest beam is the least
    off = {"B.displacement": np.array([0.0, 3e-13 * longest])}
    assert measures.errors(bent, known, off) == {"places": pytest.approx(3e-9)}


def test_the_question_has_the_last_loads_and_the_reference_is_exact_or_extrapolated(bent):
    asked = measures.benchmark_scene(cases.opened("gripper-driven"))
    assert [len(stage.stations) for stage in asked.stages] == [1]
    assert {probe.name for probe in asked.probes} >= {"A.reaction", "circle.force", "contact.force"}
    assert not {"C.reaction", "contact.closing_load", "beam1.bending_stress"} & {probe.name for probe in asked.probes}
    assert asked.claims == ()
    in_shear = cases.opened("gripper-driven").model_copy(update={"theory": "shear"})
    assert measures.benchmark_scene(in_shear) == asked  # all methods answer in the theory of the errors
    # the made-up error is C/N²: the limit is the law without the error
    right = MadeUp("cprbm", 2e-3)
    limited = measures.reference(bent, Solvers(cprbm=right, fea=right))
    truth = MadeUp("exact", 0.0)(bent, Choices(kinematics="bending")).stations[-1].values
    assert "limit" in limited.by
    np.testing.assert_allclose(limited.values["BD.rotation"], truth["BD.rotation"], rtol=1e-9)
    exact = measures.reference(bent, Solvers(cprbm=right, fea=right, exact=MadeUp("exact", 0.0)))
    assert exact.by == "the exact answer"
    np.testing.assert_array_equal(exact.values["B.displacement"], truth["B.displacement"])
    ended = lambda scene, choices: replace(right(scene, choices), ending=Ending.NOT_CERTIFIED)  # noqa: E731
    assert measures.reference(bent, Solvers(cprbm=ended, fea=right)).values == {}


@pytest.mark.usefixtures("printed")
def test_bench_prints_and_writes_numbers_figures_and_the_machine(right, capsys, tmp_path):
    arguments = ["bench", "hinge", "--sizes", "40,80", "--repeat", "1", "--out", str(tmp_path / "out")]
    arguments += ["--method", "auto", "--method", "fea", "--json", str(tmp_path / "bench.json")]
    assert run(arguments, right) == 0
    captured = capsys.readouterr()
    assert "exponent of time" in captured.out
    assert captured.err == ""
    data = json.loads((tmp_path / "bench.json").read_text("utf-8"))
    rows = [(row["method"], row["n"], row["repeats"]) for row in data["rows"]]
    assert rows == [("cprbm", 40, 1), ("cprbm", 80, 1), ("fea", 40, 1), ("fea", 80, 1)]
    assert set(MACHINE) <= set(data["machine"])
    assert data["machine"]["cores"] >= 1
    assert all(provenance.machine().values())
    assert json.loads((tmp_path / "out" / "hinge" / "bench.json").read_text("utf-8")) == data
    for name in ("bench", "bench-precision"):
        assert (tmp_path / "out" / "hinge" / f"{name}.svg").is_file()
        assert (tmp_path / "out" / "hinge" / f"{name}.png").is_file()


def test_bench_runs_the_real_ones_beside_the_peers(capsys):
    arguments = ["bench", "hinge", "--sizes", "15", "--repeat", "1", "--method", "paper", "--method", "slsqp"]
    assert run([*arguments, "--json", "-"]) == 0
    data = json.loads(capsys.readouterr().out)
    assert [row["ended"] for row in data["rows"]] == ["COMPLETED", "COMPLETED"]
    ours, theirs = (row["error"] for row in data["rows"])
    assert theirs == pytest.approx(ours, rel=1e-3)
    assert data["rows"][0]["setup_seconds"] > 0.0
    assert data["reference"]["by"] == "the exact answer"
    assert data["ratios"][0]["slsqp_both"] > 0.0


def bench(capsys, *words, solvers):
    """The JSON of a benchmark that ends with 0."""
    assert run(["bench", *words, "--sizes", "40", "--repeat", "1", "--json", "-"], solvers) == 0
    return json.loads(capsys.readouterr().out)


def test_peers_that_cannot_take_part_are_left_out_with_a_reason(right, capsys, monkeypatch):
    methods = ["--method", "auto", "--method", "ipopt"]
    data = bench(capsys, "hinge", "--stations", "all", *methods, solvers=right)
    assert len(data["rows"][0]["iterations_by_station"]) == 10
    assert data["stations"] == "all"
    assert [(one["method"], one["n"]) for one in data["left_out"]] == [("ipopt", None)]
    (left_out,) = bench(capsys, "prestressed", *methods[:3], "slsqp", solvers=right)["left_out"]
    assert left_out["method"] == "slsqp"
    assert "assembly" in left_out["why"]
    monkeypatch.setattr("benchmarks.peers.ipopt.there", lambda: False)
    assert run(["bench", "hinge", "--sizes", "40", "--repeat", "1", *methods], right) == 0
    assert "CasADi is not installed (the extra 'peers')" in capsys.readouterr().out
    assert run(["bench", "hinge", "--method", "ipopt"], right) == 2
    assert "CasADi is not installed" in capsys.readouterr().err


def test_bench_ends_with_1_if_a_run_does_not_complete_and_an_interruption_keeps_finished_rows(right, capsys, tmp_path):
    def ended(scene, choices):
        return replace(right.cprbm(scene, choices), ending=Ending.STEP_TOO_SMALL, sentence="it ended early")

    arguments = ["bench", "hinge", "--sizes", "40", "--repeat", "1", "--method", "auto", "--out", str(tmp_path)]
    assert run(arguments, Solvers(ended, right.fea)) == 1
    assert (tmp_path / "hinge" / "bench.json").is_file()
    assert "CPRBM auto at N = 40: it ended early" in capsys.readouterr().err
    calls = []

    def interrupted(scene, choices):
        calls.append(choices.elements)
        if len(calls) == 4:  # after the run that warms up and the two runs of 40
            raise KeyboardInterrupt
        return right.fea(scene, choices)

    arguments = ["bench", "hinge", "--sizes", "40,80", "--repeat", "2", "--method", "fea", "--out", str(tmp_path)]
    assert run(arguments, Solvers(right.cprbm, interrupted)) == 130
    data = json.loads((tmp_path / "hinge" / "bench.json").read_text("utf-8"))
    assert [(row["n"], row["repeats"]) for row in data["rows"]] == [(40, 1)]
    assert [(one["n"], one["why"]) for one in data["left_out"]] == [(80, "interrupted")]
