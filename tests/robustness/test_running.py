"""The run of random scenes, on scenes whose fate is known: every way of ending, what is kept, what is shrunk."""

import json
import os
import subprocess
import sys
import time
import tomllib
from dataclasses import replace
from pathlib import Path

import pytest

from comparisons import cases
from comparisons.audit import audit
from comparisons.cli.main import run as command
from comparisons.pairing import Solvers
from cprbm_scene import Ending, SceneError, read, scene_from
from tests.comparisons.programs import interrupted
from tests.robustness import auditing
from tests.robustness.command import exit_code
from tests.robustness.fates import FATES, WAYS, fated, fated_solvers, nothing
from tests.robustness.judging import Effort, judged
from tests.robustness.kept import Kept, digest
from tests.robustness.limited import Limits, OutOfTime, Returned, calls_of
from tests.robustness.outcomes import Outcome, Way, packed, shares, totals, unpacked
from tests.robustness.running import FAILURES, Crew, Plan, run
from tests.robustness.shrinking import Patience, shrunk, steps
from tests.robustness.tables import document
from tests.robustness.toml import toml_of
from tests.verdict.made_up import MadeUp

ROOT = Path(__file__).parents[2]
PLAN = Plan(0, limits=Limits(seconds=1.0, waiting=120.0))
GRIPPER = cases.data("gripper")


def last(steps_):
    return list(steps_)[-1]


@pytest.fixture(scope="module")
def whole(tmp_path_factory):
    """A scene of every fate, judged in two children."""
    folder = tmp_path_factory.mktemp("robustness")
    crew = Crew(fated_solvers(str(folder / "asked")), 2, fated, Patience(attempts=5))
    return folder, last(run(PLAN, len(FATES), folder, [], crew))


def test_every_fate_ends_in_its_one_way(whole):
    _, there = whole
    assert {FATES[index]: outcome.way.value for index, outcome in there.outcomes.items()} == WAYS
    assert list(there.outcomes) == sorted(there.outcomes)


def test_totals_sum_to_the_scenes_and_the_json_says_so(whole):
    _, there = whole
    data = json.loads(json.dumps(document(there), allow_nan=False))
    assert data["scenes"] == len(FATES) == sum(data[way.value] for way in Way)
    assert data["crashed"] == 4
    assert data["timed_out"] == 1
    assert data["wrong"] == 2
    assert [record["index"] for record in data["records"]] == list(range(len(FATES)))
    assert all(0.0 <= share <= 1.0 for share in data["strata"].values())
    assert data["strata"]["beams: line"] == 1.0
    assert data["worst"]["difference"]["scene"] == "right-0-0"
    assert 0.0 < data["worst"]["uncertainty"]["value"] < 0.015


@pytest.mark.parametrize(
    ("fate", "said"),
    [
        ("raises", "ZeroDivisionError: a beam of no length (robustness/fates.py:"),
        ("segfault", "ended with -11"),
        ("leaves", "ended with 7"),
        ("spins", "1 seconds of the processor"),
        ("devours", "memory"),
        ("stiffer", "rows differ"),
        ("nan", "not finite"),
        ("early", "STEP_TOO_SMALL, Too small."),
        ("refused", "none of these"),
        ("vague", "are undecided"),
    ],
)
def test_the_sentence_says_what_happened(whole, fate, said):
    _, there = whole
    outcome = there.outcomes[FATES.index(fate)]
    assert said in outcome.sentence
    assert outcome.name == f"{fate}-0-{FATES.index(fate)}"


def test_a_call_that_waits_for_ever_is_ended():
    with calls_of(1, nothing) as calls:
        ((asked, end),) = calls.each(time.sleep, [600.0], Limits(seconds=1.0, waiting=1.5))
    assert asked == 600.0
    assert end == OutOfTime("no end was reached in 1.5 seconds of the clock")


def test_a_child_that_ended_by_force_is_replaced():
    with calls_of(1, nothing) as calls:
        ((_, end),) = calls.each(os._exit, [3], Limits())
        assert "ended with 3" in end.sentence
        assert list(calls.each(abs, [-3], Limits())) == [(-3, Returned(3))]


def test_an_answer_that_ended_early_names_its_ending(whole):
    _, there = whole
    assert {outcome.ending for outcome in there.outcomes.values()} == {"", "STEP_TOO_SMALL"}


def test_what_fails_is_saved_as_a_smaller_scene_that_is_read(whole):
    folder, there = whole
    failed = {index for index, outcome in there.outcomes.items() if outcome.way in FAILURES}
    assert failed == set(there.saved)
    assert len(failed) == 7
    for index in failed:
        smaller = read(folder / there.saved[index])
        assert smaller.name == there.outcomes[index].name
        assert [len(smaller.stages[0].stations), len(smaller.probes)] < [2, 6]
    assert "# wrong: " in (folder / there.saved[FATES.index("stiffer")]).read_text("utf-8")


def test_what_was_out_of_time_is_shrunk_in_less_and_its_file_says_so(whole):
    folder, there = whole
    texts = {index: (folder / file).read_text("utf-8") for index, file in there.saved.items()}
    hurried = {
        index for index, text in texts.items() if "# Each smaller scene took more than 0.1 s of the processor" in text
    }
    assert hurried == {index for index, outcome in there.outcomes.items() if outcome.way is Way.TIMED_OUT}
    assert hurried


def test_a_finished_run_is_not_begun_again(whole):
    folder, there = whole
    asked = (folder / "asked").read_text("utf-8")
    crew = Crew(fated_solvers(str(folder / "asked")), 1, fated)
    again = last(run(PLAN, len(FATES), folder, [], crew))
    assert again.outcomes == there.outcomes
    assert again.before == len(FATES)
    assert (folder / "asked").read_text("utf-8") == asked


def test_one_host_finds_what_two_do(whole, tmp_path):
    _, there = whole
    alone = last(run(PLAN, 3, tmp_path, [], Crew(fated_solvers(), 1, fated, Patience(attempts=2))))
    assert [untimed(alone.outcomes[index]) for index in range(3)] == [
        untimed(there.outcomes[index]) for index in range(3)
    ]


def untimed(outcome):
    return replace(outcome, seconds=0.0)


KILLED = """
import sys
from pathlib import Path
from comparisons.pairing import Solvers
from tests.robustness.running import FAILURES, Crew, Plan, Stress, run
from tests.robustness.fates import fated, fated_solvers, slow

if __name__ == "__main__":
    crew = Crew(Solvers(slow, fated_solvers().fea), 1, fated)
    for there in run(Plan(5), 40, Path(sys.argv[1]), [], crew):
        print(len(there.outcomes), flush=True)
"""


def test_a_run_that_is_killed_goes_on_from_what_it_had(tmp_path):
    program = tmp_path / "program.py"
    program.write_text(KILLED, "utf-8")
    process = subprocess.Popen(
        [sys.executable, str(program), str(tmp_path)],
        stdout=subprocess.PIPE,
        text=True,
        env={**os.environ, "PYTHONPATH": str(ROOT)},
        start_new_session=True,
    )
    assert process.stdout is not None
    while int(process.stdout.readline()) < 2:
        pass
    process.kill()
    process.wait()
    process.stdout.close()
    begun = time.monotonic()
    while _alive(process.pid):  # the host notices the end of the command, and ends the forked processes
        assert time.monotonic() < begun + 30.0
        time.sleep(0.05)
    kept = Kept(tmp_path / f"outcomes-{digest(Plan(5))}.jsonl")
    before, _ = kept.read()
    assert 2 <= len(before) < 40
    asked = tmp_path / "asked"
    there = last(run(Plan(5), len(before) + 2, tmp_path, [], Crew(fated_solvers(str(asked)), 1, fated)))
    assert {index: there.outcomes[index] for index in before} == before
    assert there.before == len(before)
    assert {way for way, count in totals(there.outcomes.values()).items() if count} == {Way.AGREE}
    names = {line for line in asked.read_text("utf-8").splitlines() if line.startswith("right-5")}
    assert names == {f"right-5-{index}" for index in (len(before), len(before) + 1)}


def _alive(group):
    try:
        os.killpg(group, 0)
    except ProcessLookupError:
        return False
    return True


def test_a_line_that_was_cut_short_anywhere_is_dropped_and_no_other(tmp_path):
    outcomes = {index: Outcome(f"s{index}", Way.AGREE, "größer", difference=0.37) for index in range(3)}
    kept = Kept(tmp_path / "outcomes.jsonl")
    for index, outcome in outcomes.items():
        kept.ended(index, outcome)
    content = kept.path.read_bytes()
    ends = [place + 1 for place, byte in enumerate(content) if byte == ord("\n")]
    for cut in range(len(content) + 1):
        kept.path.write_bytes(content[:cut])
        found, _ = kept.read()
        assert len(found) == sum(end <= cut for end in ends)
    kept.path.write_bytes(content[:-5])
    kept.read()
    kept.ended(2, outcomes[2])
    assert kept.read() == (outcomes, {})


def test_another_question_is_kept_elsewhere():
    assert (
        len({digest(plan) for plan in (Plan(1), Plan(2), Plan(1, Effort(sizes=2)), Plan(1, limits=Limits(7.0)))}) == 4
    )
    assert digest(Plan(1)) == digest(Plan(1))


def test_an_outcome_is_the_same_after_json():
    outcome = Outcome("s", Way.ENDED, "why", "BRANCH_ENDS", 0.3, None, None, 20, 20, 1.7, 41, ("a", "b"), (), ("w",))
    assert unpacked(json.loads(json.dumps(packed(outcome)))) == outcome


def test_shares_of_what_answers_show_are_of_those_that_agree():
    some = [
        Outcome("a", Way.AGREE, "", stated=("line",), met=("closed",)),
        Outcome("b", Way.AGREE, "", stated=("arc",)),
        Outcome("c", Way.UNDECIDED, "", stated=("arc",), met=("closed",)),
    ]
    assert shares(some) == {"arc": pytest.approx(2 / 3), "line": pytest.approx(1 / 3), "closed": 0.5}


@pytest.mark.parametrize(
    ("ways", "code"),
    [
        ([], 0),
        ([Way.AGREE], 0),
        ([Way.AGREE, Way.UNDECIDED], 3),
        ([Way.REFUSED], 3),
        ([Way.UNDECIDED, Way.ENDED], 1),
        ([Way.WRONG, Way.AGREE], 1),
        ([Way.CRASHED], 1),
        ([Way.TIMED_OUT], 1),
    ],
)
def test_exit_codes(ways, code):
    assert exit_code([Outcome("s", way, "") for way in ways]) == code


class Drifting:
    """A CPRBM whose error does not fall as it says: at four times the links its value is another."""

    def __call__(self, scene, choices):
        stiffness = 1.2 if choices.links >= 320 else 1.0
        return MadeUp("cprbm", 0.24, stiffness=stiffness, contact=False)(scene, choices)


def test_a_value_that_leaves_its_refinement_is_wrong():
    scene = scene_from(fated(1, 0).data)
    drifting = Solvers(Drifting(), MadeUp("fea", 2e-3, contact=False))
    steady = Solvers(MadeUp("cprbm", 0.24, contact=False), drifting.fea)
    assert judged(scene, steady, Effort()).way is Way.AGREE
    assert judged(scene, drifting, Effort()).way is Way.WRONG


def test_only_the_solver_that_states_too_much_is_asked_once_more():
    scene = scene_from(fated(1, 0).data)
    asked = {"cprbm": set(), "fea": set()}

    def noting(name, error):
        right = MadeUp(name, error, contact=False)

        def answer(scene, choices):
            asked[name].add(choices.links if name == "cprbm" else choices.elements)
            return right(scene, choices)

        return answer

    for errors, expected in (
        ((0.4, -5e-4), {"cprbm": {80, 160, 320, 640}, "fea": {40, 80}}),
        ((0.1, -5e-4), {"cprbm": {80, 160, 320}, "fea": {40, 80}}),
        ((2e-3, -0.1), {"cprbm": {80, 160}, "fea": {40, 80, 160, 320}}),
        # a sixteenth of 1.25 times 0.16 leaves no room for 1.25 times 0.02, nor for a quarter of that, in 0.015
        ((0.64, -2e-2), {"cprbm": {80, 160, 320, 640}, "fea": {40, 80, 160, 320}}),
        # 1.25 times 1.6 of the scale, and a sixteenth of that, are beyond what two further sizes could tell
        ((6.4, -5e-4), {"cprbm": {80, 160}, "fea": {40, 80}}),
        ((2e-3, -5e-4), {"cprbm": {80, 160}, "fea": {40, 80}}),
    ):
        asked = {"cprbm": set(), "fea": set()}
        judged(scene, Solvers(noting("cprbm", errors[0]), noting("fea", errors[1])), Effort())
        # between N and 2N every size has a third grid
        assert {name: {n for n in sizes if n % 40 == 0} for name, sizes in asked.items()} == expected


def test_an_exact_answer_that_is_far_is_wrong():
    scene = scene_from(fated(1, 0).data)
    right = fated_solvers()
    exact = MadeUp("exact", 0.0, contact=False)
    off = MadeUp("exact", 0.0, stiffness=1.05, contact=False)

    def way(third, effort):
        return judged(scene, replace(right, exact=lambda scene, choices: third(scene, replace(choices, links=10**6,
            elements=10**6, kinematics="bending"))), effort).way  # fmt: skip

    assert way(exact, Effort()) is Way.AGREE
    assert way(off, Effort()) is Way.WRONG
    # the exact answer is in bending alone
    in_shear = Effort(replace(Effort().first, theory="shear"))
    alone = judged(scene, replace(right, exact=None), in_shear).way
    assert way(off, in_shear) is alone is not Way.WRONG


def test_an_answer_is_audited_once_however_often_it_is_compared(monkeypatch):
    looked = []

    def noted(scene, answer):
        looked.append((answer.solver, answer.settings.get("links", answer.settings.get("elements"))))
        return audit(scene, answer)

    monkeypatch.setattr(auditing, "audit", noted)
    scene, right = scene_from(fated(1, 0).data), fated_solvers()

    def exact(scene, choices):
        return MadeUp("exact", 0.0, contact=False)(scene, replace(choices, links=10**6, elements=10**6))

    # 1.25 times 0.16 is too much to be told at 80 links and not at 320; the exact answer is asked beside what agrees
    doubtful = MadeUp("cprbm", 0.16, contact=False)
    outcome = judged(scene, Solvers(doubtful, right.fea, exact=exact), Effort())
    assert outcome.links > 80
    assert len(looked) == len(set(looked)) > 2
    assert {solver for solver, _ in looked} == {"cprbm", "fea"}


def test_the_part_that_was_reached_can_be_wrong():
    """A solver ends early with certified stations that differ."""
    scene = scene_from(fated(1, 0).data)
    stiff = MadeUp("cprbm", 2e-3, stiffness=1.02, contact=False)

    def early(scene, choices):
        found = stiff(scene, choices)
        if len(found.stations) == 1:
            return found
        return replace(found, stations=found.stations[:1], ending=Ending.STEP_TOO_SMALL)

    assert judged(scene, Solvers(early, fated_solvers().fea), Effort()).way is Way.WRONG


def is_scene(data):
    try:
        scene_from(data)
    except SceneError:
        return False
    return True


def test_shrinking_keeps_what_is_asked_and_makes_the_rest_smaller():
    def alike(data):
        return is_scene(data) and "circle" in data.get("contacts", {}) and max(data["stages"][-1]["stations"]) > 11.0

    assert alike(GRIPPER)
    small = shrunk(GRIPPER, alike, Patience(attempts=400, seconds=60.0))
    assert alike(small)
    assert list(small["contacts"]) == ["circle"]
    assert len(small["probes"]) == 1
    assert [len(stage["stations"]) for stage in small["stages"]] == [1]
    assert len(toml_of(small)) < 0.5 * len(toml_of(GRIPPER))
    assert not any(alike(smaller) for smaller in steps(small))


def test_shrinking_ends_when_patience_does():
    tried = []
    assert shrunk(GRIPPER, lambda data: tried.append(data) is not None, Patience(attempts=7)) == GRIPPER
    assert len(tried) == 7
    assert shrunk(GRIPPER, lambda data: True, Patience(seconds=0.0)) == GRIPPER


@pytest.mark.parametrize("name", cases.names())
def test_every_step_is_another_scene_and_leaves_the_first_alone(name):
    text = (Path(cases.__file__).parent / f"{name}.toml").read_text("utf-8")
    data = tomllib.loads(text)
    if "question" in data:
        return
    found = list(steps(data))
    assert found
    assert data == tomllib.loads(text)
    assert all(each != data for each in found)
    assert any(is_scene(each) for each in found)


def test_the_command_prints_totals_and_writes_json(tmp_path, capsys):
    arguments = ["robustness", "--scenes", "3", "--seed", "7", "--out", str(tmp_path / "out"), "--json", "-"]
    right = fated_solvers()
    code = command(arguments, right)
    data = json.loads(capsys.readouterr().out)
    assert {"scenes", *(way.value for way in Way), "strata", "worst"} <= set(data)
    assert data["scenes"] == 3 == sum(data[way.value] for way in Way)
    assert code == exit_code(unpacked({key: value for key, value in record.items() if key not in ("index", "file")})
                             for record in data["records"])  # fmt: skip


def test_a_scene_is_replayed_from_its_file(tmp_path, capsys):
    file = tmp_path / "leaves.toml"
    file.write_text(fated(0, FATES.index("leaves")).text, "utf-8")
    assert command(["robustness", "--replay", str(file)], fated_solvers()) == 1
    assert "crashed. a process ended with 7" in capsys.readouterr().out


def test_the_option_theory_reaches_the_solvers(tmp_path, capsys):
    file = tmp_path / "theory.toml"
    file.write_text(toml_of({**fated(0, 0).data, "name": "theory"}), "utf-8")
    for theory in ("shear", "bending"):
        assert command(["robustness", "--replay", str(file), "--theory", theory], fated_solvers()) == 3
        assert f"refused. theory: found {theory}" in " ".join(capsys.readouterr().out.split())


INTERRUPTED = """
from comparisons.pairing import Solvers
import comparisons.cli.main as main
from tests.robustness.fates import fated_solvers, slow
import sys

if __name__ == "__main__":
    sys.exit(main.run(["robustness", "--scenes", "400", "--seed", "3", "--out", sys.argv[1]],
                      Solvers(slow, fated_solvers().fea)))
"""


def test_an_interrupt_leaves_what_is_finished_and_says_so(tmp_path):
    (tmp_path / "program.py").write_text(INTERRUPTED, "utf-8")
    out = interrupted(["out"], tmp_path, lambda: any((tmp_path / "out").glob("*.jsonl")))
    assert "scenes:" in out
    (file,) = (tmp_path / "out").glob("*.jsonl")
    assert Kept(file).read()[0]
