"""AGREE, DIFFER or UNDECIDED, and the row that decided.

With the symbols of :mod:`comparisons.measures`, a row says

* DIFFER if  |v_c − v_f| > u_c + u_f + |v_b − v_f| + r   or   |v_c − v_b| > u_c + u_b + r;
* UNDECIDED if it does not differ, but one of the two sums is more than the ``verdict_limit`` (the probe's own or the
  scene's) of the probe's scale: such a sum would have excused a wrong answer too;
* AGREE otherwise.

Where the exact value x is known, the row also says DIFFER if |v_c − x| > F (u_c + r + q) or |v_b − x| > F (u_b + r + q)
with F = 2: two solvers that agree on what is wrong do not agree with the truth.  A stated uncertainty is to hold in
95 % of the rows and not in all of them; a true error between once and F times the stated one is therefore named in
the sentence and leaves the word alone, and one beyond F is no chance of where a mesh stands.

The second condition makes the first one tight.  By the triangle inequality
|v_c − v_f| ≤ |v_c − v_b| + |v_b − v_f|, so with the first alone a wrong CPRBM could hide in a large step
between the theories; within one theory it has only the two discretisations to hide behind.

Of contacts that press a beam at one place the sum of the forces alone is determined (:mod:`comparisons.shared`): a row
that asks for one of them says DIFFER if the sums do, and UNDECIDED otherwise.  So does one that would not agree and
asks for the force of a contact within an element of its beam's joint (:mod:`comparisons.beside`), by the sum of both;
one that would not and asks where such a contact presses is UNDECIDED.

Rows at which the answers are not on one branch, or near where one ends, say what their place makes them say
(:mod:`comparisons.branches`); a critical value says what :mod:`comparisons.criticals` makes of it.

A case differs if any row or critical value does, is undecided if a solver did not complete or any of them is
undecided, and agrees only if every one does.  The centre and the ends of a contact and its closing load are absent
while it is open; where one answer has such a value and another does not, the contact's force at that station (zero in
one, not in the other) decides, and the row itself is undecided only if the scene does not ask for that force.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace

from comparisons.audit import Audit, audit
from comparisons.branches import Place
from comparisons.calibration import FAR, JUDGED, every, held, tally
from comparisons.criticals import CriticalRow, critical_rows
from comparisons.formats import number, percent
from comparisons.gone_over import why_apart
from comparisons.measures import Bounds, Row, rows_of
from comparisons.pairing import Runs
from comparisons.per_branch import BranchVerdict, branch_verdicts, critical_word, told
from comparisons.reach import within_reach
from comparisons.reactions import WorkEnergyReaction, perturbed_scene, reactions
from comparisons.soundness import ABSENT_WHILE_OPEN, complaints, sound_part
from comparisons.tolerances.search import Tolerance
from comparisons.words import Word, worst_of
from cprbm_scene import Answer, Scene
from cprbm_scene.frozendict import frozendict

Auditor = Callable[[Scene, Answer], Audit]
"""What finds in an answer to a scene what does not hold."""


@dataclass(frozen=True, slots=True)
class Verdict:
    """The verdict on a case.

    Attributes:
        word: of the case.
        sentences: which row decided, or why nothing could be decided, that first; then whatever else is to be said.
        words: one per row, in the order of the rows; None for a row that takes no part.
        completed: whether every run gave a whole answer.
        branches: what the rows of each branch say.
    """

    word: Word
    sentences: tuple[str, ...]
    words: tuple[Word | None, ...]
    completed: bool
    branches: tuple[BranchVerdict, ...] = ()

    @property
    def sentence(self) -> str:
        """All that is said."""
        return " ".join(self.sentences)

    @property
    def because(self) -> str:
        """The first sentence: what decided."""
        return next(iter(self.sentences), "")


@dataclass(frozen=True, slots=True)
class Comparison:
    """A scene, all answers to it, the rows and critical values, the verdict, reactions by two ways, how N was found.

    ``audits`` are of the two answers that are compared, and of the solid's finest, by solver, where these are whole.
    """

    scene: Scene
    runs: Runs
    rows: tuple[Row, ...]
    verdict: Verdict
    criticals: tuple[CriticalRow, ...] = ()
    reactions: tuple[WorkEnergyReaction, ...] = ()
    tolerances: tuple[Tolerance, ...] = ()
    audits: Mapping[str, Audit] = frozendict()


def compared(scene: Scene, runs: Runs, look: Auditor = audit) -> Comparison:
    """Put the answers beside each other and judge them.

    Rows stand only if every run gave a whole answer, or one that is whole up to where its branch ends; the drives'
    reactions if those at N and n did.

    Args:
        scene: the question.
        runs: the answers.
        look: the audit, or one that remembers what it has looked at.
    """
    reach = within_reach(scene, runs)
    within, cut = (scene, runs) if reach is None else reach
    found: dict[str, list[str]] = {}
    for name, answer in cut.everything():
        what = complaints(within, answer)
        if what:
            more = f" (and {len(what) - 1} more)" if len(what) > 1 else ""
            found.setdefault(f"{what[0]}{more}", []).append(name)
    if found:
        sentence = "; ".join(f"{', '.join(names)} gave no whole answer: {what}" for what, names in found.items())
        verdict = Verdict(Word.UNDECIDED, (sentence + ".",), (), completed=False)
        return Comparison(scene, runs, (), verdict, critical_rows(scene, runs), _reactions(scene, runs))
    # nothing rests on what stands beside, so that where it fails it leaves no more than a gap
    paper, exact = (None if answer is None else sound_part(within, answer) for answer in (cut.paper, cut.exact))
    rows = rows_of(within, replace(cut, paper=paper, exact=exact))
    criticals = critical_rows(scene, runs)
    verdict = judged(within, rows, criticals)
    verdict = replace(verdict, sentences=(*verdict.sentences, *why_apart(within, cut, rows, verdict.words)))
    if reach is not None:
        verdict = _up_to_there(verdict, rows[-1])
    audits = {answer.solver: look(within, answer) for answer in (cut.cprbm[0], cut.reference)}
    verdict = _as_audited(verdict, audits)
    if cut.solid is not None and cut.solid[-1].completed:  # on which no verdict rests
        audits["solid"] = look(within, cut.solid[-1])
    return Comparison(scene, runs, rows, verdict, criticals, _reactions(scene, runs), audits=audits)


def _as_audited(verdict: Verdict, audits: Mapping[str, Audit]) -> Verdict:
    """The verdict where an audit fails, since two answers may agree on no equilibrium, or where shapes cross."""
    said = []
    for name, found in audits.items():
        if found.complaints:
            more = f" (and {len(found.complaints) - 1} more)" if len(found.complaints) > 1 else ""
            said.append(f"The audit of {name}'s answer fails: {found.complaints[0]}{more}.")
    said += next((found.remarks for found in audits.values() if found.remarks), ())
    if not said:
        return verdict
    word = Word.UNDECIDED if verdict.word is Word.AGREE else verdict.word
    return replace(verdict, word=word, sentences=(*said, *verdict.sentences))


def _up_to_there(verdict: Verdict, last: Row) -> Verdict:
    """The verdict on what comes before a branch ends: the stations behind it have no answer to agree on."""
    differs = verdict.word is Word.DIFFER
    there = verdict.word if differs else worst_of(verdict.words) or Word.UNDECIDED
    word = verdict.word if differs else Word.UNDECIDED
    said = f"The branch ends before the last station; up to {last.stage} {last.station:g}: {there.value}."
    return replace(verdict, word=word, sentences=(said, *verdict.sentences), completed=False)


def _reactions(scene: Scene, runs: Runs) -> tuple[WorkEnergyReaction, ...]:
    """The drives' reactions, also beside a failed finer run: the answers at N and n and the perturbed run suffice."""
    perturbed = perturbed_scene(scene)
    if perturbed is None or runs.perturbed is None:
        return ()
    if complaints(scene, runs.cprbm[0]) or complaints(scene, runs.reference):
        return ()
    return reactions(scene, runs.cprbm[0], runs.reference, sound_part(perturbed, runs.perturbed))


def judged(scene: Scene, rows: tuple[Row, ...], criticals: tuple[CriticalRow, ...] = ()) -> Verdict:
    """The verdict on the rows and the critical values of whole answers."""
    rows = tuple(_with_joint(scene, row) for row in rows)
    words = tuple(_word(scene, row) for row in rows)
    of_rows, of_them = _judged_rows(scene, rows, words)
    branches = branch_verdicts(rows, words)
    of_criticals = worst_of(critical_word(each) for each in criticals)
    word = worst_of((of_rows, of_criticals)) or of_rows
    more = told(rows, branches, criticals)
    # what decides comes first
    sentences = (*of_them, *more) if word is of_rows else (*more, *of_them)
    return Verdict(word, sentences, words, completed=True, branches=branches)


def _judged_rows(scene: Scene, rows: tuple[Row, ...], words: tuple[Word | None, ...]) -> tuple[Word, tuple[str, ...]]:
    """The word of all rows, a sentence that names the one which decided, and what else is to be said of them."""
    judged_rows = [(row, word) for row, word in zip(rows, words, strict=True) if word is not None]
    for word in (Word.DIFFER, Word.UNDECIDED):
        worst = [row for row, said in judged_rows if said is word]
        if worst:
            row = max(worst, key=lambda row: _pressure(scene, row, word))
            return word, (_sentence(scene, row, word, len(worst), len(judged_rows)), *_exactly(rows))
    if not judged_rows:
        return Word.UNDECIDED, ("There is no row that could be compared.",)
    row = max((row for row, _ in judged_rows), key=lambda row: max(_between(row)))
    said = _sentence(scene, row, Word.AGREE, len(judged_rows), len(judged_rows))
    return Word.AGREE, (said, *_allowed(scene), *_exactly(rows))


def _with_joint(scene: Scene, row: Row) -> Row:
    """The row that speaks for one: of a force that does not agree, and no mesh resolves, the one with the joint beside.

    Where an exact value says whose force is wrong, it does.
    """
    if row.beside is None or any(each.pressure > 1.0 for each in every(row)):
        return row
    return row if _word(scene, row) in (Word.AGREE, None) else row.beside


def _word(scene: Scene, row: Row) -> Word | None:
    if row.place in _OF_PLACE:
        return _OF_PLACE[row.place]
    if (_lacking(row) and not _spoken_for(scene, row)) or (row.shared and row.bounds is None):
        return Word.UNDECIDED
    if row.bounds is None:
        return None
    if _contradicted(row, row.bounds):
        return Word.UNDECIDED if row.place is Place.DOUBTFUL or row.hardly_open else Word.DIFFER
    tellable = max(row.bounds.total, row.bounds.same_theory) <= scene.limit(row.probe) * row.scale and not row.shared
    return Word.AGREE if tellable else Word.UNDECIDED


def _contradicted(row: Row, bounds: Bounds) -> bool:
    """Whether values are farther from each other, or from an exact one, than may be."""
    within = row.difference <= bounds.total and row.same_theory <= bounds.same_theory
    return not within or any(each.pressure > 1.0 for each in every(row))


_OF_PLACE: Mapping[Place, Word | None] = {
    Place.NEAR: None,
    Place.BETWEEN: None,
    Place.APART: Word.DIFFER,
    Place.UNSETTLED: Word.UNDECIDED,
}
"""What rows say by their place alone."""


def _lacking(row: Row) -> bool:
    """Whether a value is absent in one of the runs, or in the exact answer alone."""
    return row.bounds is None or (row.exact is not None and row.exact.shape != row.fea.shape)


def _spoken_for(scene: Scene, row: Row) -> bool:
    """Whether a row without a value has nothing to say, or leaves it to the contact's force."""
    if row.probe.quantity not in ABSENT_WHILE_OPEN:
        return False
    if row.cprbm.size == 0 and row.fea.size == 0 and (row.exact is None or row.exact.size == 0):
        return True
    return any(probe.of == row.probe.of and probe.quantity == "force" for probe in scene.probes)


def _share(part: float, whole: float) -> float:
    if whole > 0.0:
        return part / whole
    return 0.0 if part == 0.0 else float("inf")


def _pressure(scene: Scene, row: Row, word: Word) -> float:
    """How hard a row presses towards a word: a difference on its sum, or a sum on its limit."""
    if row.bounds is None or (word is Word.UNDECIDED and (_lacking(row) or row.shared)):
        return float("inf")
    if word is Word.UNDECIDED and _contradicted(row, row.bounds):
        return float("inf")
    if word is Word.UNDECIDED:
        return _share(max(row.bounds.total, row.bounds.same_theory), scene.limit(row.probe) * row.scale)
    return max(*_between(row), *(each.pressure for each in every(row)))


def _between(row: Row) -> tuple[float, float]:
    """How hard the two solvers' differences press on their sums, in the chosen theory and within one."""
    assert row.bounds is not None
    return _share(row.difference, row.bounds.total), _share(row.same_theory, row.bounds.same_theory)


def _sentence(scene: Scene, row: Row, word: Word, count: int, rows: int) -> str:
    place = f"{row.probe.name} at {row.stage} {row.station:g}"
    if row.place is Place.APART:
        return f"{count} of {rows} rows differ, first of all {place}: the two solvers are on different branches."
    if row.place is Place.UNSETTLED:
        return (
            f"{count} of {rows} rows cannot be told, first of all {place}: one solver's runs are on different branches."
        )
    if row.shared and word is Word.UNDECIDED:
        return f"{count} of {rows} rows cannot be told, first of all {place}: {_of_shared(scene, row)}"
    if row.bounds is None or (word is Word.UNDECIDED and _lacking(row)):
        return f"{place} has no value in one of the runs, and no force of that contact is asked."
    if word is Word.UNDECIDED and _contradicted(row, row.bounds):
        return f"{count} of {rows} rows cannot be told, first of all {place}: {_doubt(row)}."
    chosen, within = _between(row)
    off = max(every(row), key=lambda each: each.pressure, default=None)
    if word is Word.DIFFER and off is not None and off.pressure > max(chosen, within):
        return (
            f"{count} of {rows} rows differ, most of all {place}: {_NAMES[off.solver]} are off the exact answer by "
            f"{_of_scale(off.true, row)} of the scale, more than {FAR:g} times the stated {_of_scale(off.stated, row)}."
        )
    tight = within > chosen
    difference = row.same_theory if tight else row.difference
    total = row.bounds.same_theory if tight else row.bounds.total
    theory = " within one theory" if tight else ""
    said = f"{_of_scale(difference, row)} of the scale{theory} against a stated {_of_scale(total, row)}"
    match word:
        case Word.DIFFER:
            made_of = _sum(row.bounds, row, tight=tight)
            return f"{count} of {rows} rows differ, most of all {place}: {said} ({made_of})."
        case Word.UNDECIDED:
            largest = max(row.bounds.total, row.bounds.same_theory)
            return (
                f"{count} of {rows} rows cannot be told, least of all {place}: the stated uncertainty is "
                f"{_of_scale(largest, row)} of the scale, more than {percent(scene.limit(row.probe))}."
            )
        case Word.AGREE:
            return f"All {rows} rows agree; the closest call is {place}: {said}."


def _doubt(row: Row) -> str:
    """Why what would differ is not told."""
    if row.hardly_open:
        names = " and ".join(sorted(row.hardly_open))
        return f"{names} presses in one solver, and is open in the other by less than its meshes tell"
    return "one solver alone went on over an end of the branch near by, which the other may have behind it"


def _of_shared(scene: Scene, row: Row) -> str:
    """Why the force of a contact cannot be told that shares a place with others or a joint, and what all of them do."""
    beam, others = scene.contacts[row.probe.of].beams[0], " and ".join(sorted(row.shared))
    if row.shared <= scene.contacts.keys():
        why = f"{others} and {row.probe.of} press {beam} at one place, and no mechanics says how they share the force"
    else:
        why = f"{row.probe.of} presses {beam} within an element of its joint at {others}, which no such mesh resolves"
    if row.together is None:
        return f"{why}."
    mine, theirs = (f"{number(float(value[0]), 5)} {row.unit}" for value in row.together)
    return f"{why}. Together they press with {mine} in the CPRBM and with {theirs} in the finite elements."


_NAMES = {"cprbm": "the CPRBM's values", "fea": "the finite elements' in bending"}


def _exactly(rows: tuple[Row, ...]) -> tuple[str, ...]:
    """How the true errors stand to the stated ones, in a sentence; none where no exact value is known."""
    found = held(rows)
    said = []
    for solver in JUDGED:
        mine = tally(found, solver, worst=1)
        if mine.rows == mine.within:
            continue
        (worst,) = mine.worst
        said.append(
            f"{_NAMES[solver]} are off by more than stated in {mine.rows - mine.within} of {mine.rows} rows, at most "
            f"{number(worst.ratio)} times ({worst.row.probe.name} at {worst.row.stage} {worst.row.station:g})"
        )
    if said:
        return (f"Beside the exact answer {'; '.join(said)}.",)
    return ("The true errors, beside the exact answer in bending, are within the stated ones.",) if found else ()


def _allowed(scene: Scene) -> tuple[str, ...]:
    """Which probes the scene allows a larger uncertainty than the others, in a sentence; none if none is."""
    wider = [probe for probe in scene.probes if scene.limit(probe) > scene.verdict_limit]
    if not wider:
        return ()
    said = ", ".join(f"{percent(scene.limit(probe))} for {probe.name}" for probe in wider)
    return (f"The scene allows stated uncertainties of up to {percent(scene.verdict_limit)} of the scale; {said}.",)


def _sum(bounds: Bounds, row: Row, *, tight: bool) -> str:
    parts = {"cprbm": bounds.cprbm, "fea": bounds.bending if tight else bounds.fea}
    if not tight:
        parts["theory"] = bounds.theory
    return ", ".join(f"{name} {_of_scale(part, row)}" for name, part in parts.items())


def _of_scale(value: float, row: Row) -> str:
    return percent(_share(value, row.scale))
