"""Planted violations: the sentence names the promise, the fault and the next step."""

import pytest

from .declared import Change, broken, declared, meant

KEEP_OR_DECLARE = "Keep the promise, or declare the change in tests/contract/declared.toml."

GONE = {
    "an option": "cprbm solve option --json",
    "a short option": "cprbm compare option -q",
    "a choice": "cprbm compare choice --kinematics bending",
    "an argument": "cprbm compare argument 1",
    "a command": "cprbm converge",
    "a key of JSON": "cprbm compare json document: cases[].rows[].difference",
    "a column": "python comparisons.records column unit",
    "a name": "python cprbm.answer",
    "an exported name": "python cprbm exports answer",
    "a parameter": "python comparisons.compare parameter choices",
    "a field": "python cprbm.Settings field links",
    "a key of scenes": "scene key beams.*.thickness",
    "a kind in scenes": "scene choice contacts.*.kind beam-circle",
    "a case": "scene case hinge",
    "a file of a report": "cprbm compare file comparison.json",
}

ALTERED = {
    "an exit code": ("cprbm compare exit: UNDECIDED", 0, "was 3 and is 0"),
    "a default": ("cprbm solve default -n", "50", "was '40' and is '50'"),
    "a case that does not read": ("scene case wrapped", "refused: bodies", "was 'Scene' and is 'refused: bodies'"),
    "a file that does not read": ("scene file hinge.toml", "refused: bodies", "was 'Scene' and is 'refused: bodies'"),
    "a further demand": ("cprbm solve requires", ["--force", "argument 1"], "demands --force, which 3c78333 did not"),
    "a place of a parameter": ("python cprbm.answer parameter scene", "place 2", "was 'place 1' and is 'place 2'"),
}


@pytest.fixture(scope="module")
def now(promised, changes):
    """A program that keeps every promise and makes every declared change."""
    pairs = [(each, item) for each in changes for pattern in each.promise for item in meant(pattern, promised)]
    ended = {item for each, item in pairs if not each.shown_by}
    kept = {item: value for item, value in promised.items() if item not in ended}
    moved = {new: promised[item] for each in changes for item in promised if (new := each.becoming(item))}
    altered = {item: each.value for each, item in pairs if each.value is not None}
    return {**kept, **moved, **altered}


def change(*promise, **further):
    return Change(promise, "a test", "nothing", **further)


def test_gone_promises_are_named(promised, now, changes):
    """All at once: a comparison of all promises takes a second."""
    less = {item: value for item, value in now.items() if item not in GONE.values()}
    sentences = [f"The promise '{item}' is gone. {KEEP_OR_DECLARE}" for item in GONE.values()]
    assert sorted(broken(promised, less, changes)) == sorted(sentences)
    assert broken(promised, less, [*changes, *map(change, GONE.values())]) == []


def test_altered_promises_are_named(promised, now, changes):
    other = {**now, **{item: value for item, value, _ in ALTERED.values()}}
    sentences = [f"The promise '{item}' {wrong}. {KEEP_OR_DECLARE}" for item, _, wrong in ALTERED.values()]
    assert sorted(broken(promised, other, changes)) == sorted(sentences)
    assert broken(promised, other, [*changes, *(change(item) for item, *_ in ALTERED.values())]) == []


def test_further_keys_and_options_break_nothing(promised, now, changes):
    further = {"cprbm solve option --fast": "flag", "cprbm compare json document: cases[].weight": ""}
    assert broken(promised, {**now, **further}, changes) == []


def test_a_demand_that_is_dropped_breaks_nothing():
    assert broken({"cprbm import requires": ["--width"]}, {"cprbm import requires": []}) == []


def test_a_change_of_what_is_kept_is_stale(promised, now, changes):
    found = broken(promised, now, [*changes, change("cprbm solve option --js*")])
    assert found == [
        "The promise 'cprbm solve option --json' is declared to change by 'cprbm solve option --js*', and is kept. "
        "Delete or narrow the change."
    ]


def test_a_change_of_no_promise_is_stale(promised, now, changes):
    found = broken(promised, now, [*changes, change("cprbm sovle")])
    assert found == ["The declared change of 'cprbm sovle' is of no promise. Correct the change or delete it."]


def test_a_pattern_that_covers_more_than_what_changed_is_stale():
    promised = {"a key 1": "", "a key 2": ""}
    (sentence,) = broken(promised, {"a key 2": ""}, [change("a key *")])
    assert "'a key 2' is declared to change by 'a key *', and is kept" in sentence


def test_a_promise_that_moves_is_kept_under_its_further_name():
    moved = change("cprbm old", "cprbm old *", becomes=("cprbm new", "cprbm new *"))
    promised = {"cprbm old": "command", "cprbm old option --json": "value"}
    assert broken(promised, {"cprbm new": "command", "cprbm new option --json": "value"}, [moved]) == []
    assert broken(promised, {"cprbm new": "command"}, [moved]) == [
        "The promise 'cprbm old option --json' is declared to become 'cprbm new option --json', which is gone. "
        "Mend the program or the change."
    ]


def test_a_declared_value_is_a_promise_again():
    promised, altered = {"cprbm solve default -n": "40"}, change("cprbm solve default -n", value="60")
    assert broken(promised, {"cprbm solve default -n": "60"}, [altered]) == []
    assert broken(promised, {"cprbm solve default -n": "50"}, [altered]) == [
        "The promise 'cprbm solve default -n' is declared to be '60' and is '50'. Mend the program or the change."
    ]


def test_what_goes_on_in_a_checkout_is_kept_there():
    moved = change("cprbm stress", shown_by=("stress",))
    assert broken({"cprbm stress": "command"}, {"cprbm stress": "command"}, [moved]) == []
    (sentence,) = broken({"cprbm stress": "command"}, {}, [moved])
    assert sentence == f"The promise 'cprbm stress' is gone. {KEEP_OR_DECLARE}"


@pytest.mark.parametrize(
    ("table", "said"),
    [
        ('promise = "a"\ninstead = "b"', "needs a promise, a reason"),
        ('promise = "a"\nreason = "r"\ninstead = "b"\nwhy = "c"', "found why; allowed: becomes"),
        ('promise = "a *"\nreason = "r"\ninstead = "b"\nbecomes = "c"', "same number"),
        ('promise = "a"\nreason = "r"\ninstead = "b"\nbecomes = "c"\nvalue = 1', "allowed: one of them"),
    ],
)
def test_a_change_that_says_too_little_is_refused(tmp_path, table, said):
    file = tmp_path / "declared.toml"
    file.write_text(f"[[change]]\n{table}\n", "utf-8")
    with pytest.raises(ValueError, match=said):
        declared(file)
