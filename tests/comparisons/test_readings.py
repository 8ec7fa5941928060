"""The study's own writing of the paper's minimum of energy, beside differences, formulas and a second writing."""

import json
from dataclasses import asdict, dataclass, field, replace

import numpy as np
import pytest

from comparisons import cases, documents
from comparisons.cli.main import run
from comparisons.studies import readings
from comparisons.studies.readings import NEAREST, Followed, Optimised, Readings, begun, bulging, pieces
from comparisons.studies.readings_optimisers import Answered, Ipopt, Slsqp
from comparisons.studies.readings_path import constraints, followed, hessian
from comparisons.studies.readings_peers import expressions
from comparisons.studies.readings_problem import PAPER, Problem, Reading
from comparisons.studies.readings_told import told

FEW = 12


def problem(links=FEW, **reading):
    return Problem(PAPER, Reading(**reading), links)


def bent(asked, seed=0):
    """Beams bulging towards each other, and a little uneven."""
    return bulging(asked, "inwards") + 0.02 * np.random.default_rng(seed).standard_normal(2 * asked.links)


def differences(values, z, step=1e-6):
    """Central differences, (…, 2N)."""
    moves = step * np.eye(len(z))
    return np.stack([(values(z + move) - values(z - move)) / (2.0 * step) for move in moves], axis=-1)


ASKED = [
    problem(),
    problem(degree=3, clamped=False),
    problem(degree=6, reach=0.06),
    replace(problem(), reading=NEAREST),
]


@pytest.mark.parametrize("asked", ASKED)
def test_gradients_are_those_of_differences(asked):
    z = bent(asked)
    np.testing.assert_allclose(asked.energy(z)[1], differences(lambda z: asked.energy(z)[0], z), atol=1e-8)
    for values in (lambda z: asked.closure(z, 0.3), asked.contact, lambda z: constraints(asked, z, 0.3)):
        finite = ~np.isinf(values(z)[0])  # an angle without a limit
        exact = differences(lambda z, values=values: np.where(np.isinf(values(z)[0]), 0.0, values(z)[0]), z)
        np.testing.assert_allclose(values(z)[1][finite], exact[finite], atol=1e-9)


@pytest.mark.parametrize("asked", ASKED)
def test_the_hessian_is_that_of_differences_of_the_slope(asked):
    z = bent(asked)
    multipliers = np.random.default_rng(1).uniform(0.0, 500.0, len(constraints(asked, z, 0.3)[0]))

    def slope(z):
        return asked.energy(z)[1] + constraints(asked, z, 0.3)[1].T @ multipliers

    H = hessian(asked, z, 0.3, multipliers)
    np.testing.assert_allclose(H, differences(slope, z), atol=1e-5 * np.max(np.abs(H)))
    np.testing.assert_allclose(H, H.T, atol=1e-12 * np.max(np.abs(H)))


def test_the_case_is_the_mechanism_of_the_paper():
    """Section 3.4, written down twice: in the case and in the study."""
    case, paper = asdict(readings.mechanism_of(cases.opened("prestressed"))), asdict(PAPER)
    assert case == pytest.approx(paper, rel=1e-14)


def test_an_even_bend_has_the_energy_and_the_place_of_an_arc():
    """Constant curvature: PE = ½ E·I φ²/L of each beam, and an end at R(1 − cos φ), R sin φ with R = L/φ."""
    phi, L = 1.1, PAPER.beam
    EI = 2.0e11 * 0.008 * 0.001**3 / 12.0
    asked = problem(160)
    turn = phi * np.arange(1, 161) / 160
    z = np.concatenate((np.pi / 2.0 + turn, np.pi / 2.0 - turn))
    assert asked.energy(z)[0] == pytest.approx(2.0 * 0.5 * EI * phi**2 / L, rel=1e-13)
    x, y = asked.places(z)
    R = L / phi
    np.testing.assert_allclose(
        x[:, -1], [-0.0005 - R * (1.0 - np.cos(phi)), 0.0005 + R * (1.0 - np.cos(phi))], atol=1e-6
    )
    np.testing.assert_allclose(y[:, -1], R * np.sin(phi), atol=1e-6)


def test_parallel_beams_keep_the_gap_that_is_between_them():
    """Straight beams 1.5 mm apart that are 1 mm thick: every joint is 0.5 mm from touching, whatever the curve."""
    apart = replace(PAPER, base=0.00075)
    for reading in (Reading(), Reading(degree=2), NEAREST):
        asked = Problem(apart, reading, FEW)
        np.testing.assert_allclose(asked.contact(asked.straight)[0], -0.0005, atol=1e-15)


@pytest.mark.parametrize(
    ("limits", "line"),
    [("pin", lambda own, other: other - own), ("away", lambda own, other: own - other)],
)
@pytest.mark.parametrize("alpha", [0.0, 0.9])
@pytest.mark.parametrize("sense", [1, -1])
def test_at_a_limit_the_end_makes_45_degrees_with_its_line(limits, line, alpha, sense):
    asked = problem(limits=limits, sense=sense)
    pins = asked.pins(alpha)
    for b, (own, other) in enumerate((pins, pins[::-1])):
        for angle in asked.limited(alpha)[b]:
            into = -np.array([np.cos(angle), np.sin(angle)])
            towards = line(own, other)
            assert into @ towards / np.linalg.norm(towards) == pytest.approx(np.cos(np.pi / 4.0), rel=1e-12)


def test_the_second_writing_is_the_same():
    """CasADi's expressions beside NumPy's, at several shapes."""
    ca = pytest.importorskip("casadi")
    for asked in ASKED[:3]:
        z, pins, energy, rows = expressions(asked)
        both = ca.Function("both", [z, pins], [energy, rows])
        for seed in range(3):
            at = bent(asked, seed)
            theirs = both(at, asked.pins(0.4).ravel())
            ours = np.concatenate((asked.closure(at, 0.4)[0], asked.contact(at)[0]))
            assert float(theirs[0]) == pytest.approx(float(asked.energy(at)[0]), rel=1e-13)
            np.testing.assert_allclose(np.array(theirs[1]).ravel(), ours, atol=1e-13)
    with pytest.raises(ValueError, match="fitted"):
        expressions(ASKED[3])


@pytest.fixture(scope="module")
def path():
    """The branch with true contact, in steps of two degrees."""
    asked = Problem(PAPER, NEAREST, FEW)
    start = begun(asked, 0.0, bulging(asked, "inwards"))
    return asked, followed(asked, start, np.radians(np.arange(0.0, 90.0, 2.0)))


def test_the_assembled_state_is_symmetric_and_needs_no_moment(path):
    _, branch = path
    first, furthest = branch.states[0], max(state.moment for state in branch.states)
    np.testing.assert_allclose(first.z[:FEW] + first.z[FEW:], np.pi, atol=1e-9)
    assert furthest > 1.0
    assert abs(first.moment) < 1e-9 * furthest
    assert len(first.acting) > 0


def test_the_moment_is_the_slope_of_the_energy():
    """PE(b) − PE(a) = ∫ M dα, by Simpson's rule, with a fitted curve: a polygon's normal turns by steps."""
    asked = problem()
    start = begun(asked, 0.0, bulging(asked, "inwards"))
    states = followed(asked, start, np.radians(np.arange(0.0, 41.0, 1.0))).states
    assert len(states) == 41
    for a, b, c in zip(states[:-2:2], states[1:-1:2], states[2::2], strict=True):
        work = (a.moment + 4.0 * b.moment + c.moment) * (c.alpha - a.alpha) / 6.0
        assert c.energy - a.energy == pytest.approx(work, rel=1e-4)


def test_the_branch_ends_where_a_general_optimiser_leaves_it(path):
    """SLSQP by steps of a fifth of a degree knows nothing of curvatures; its first jump is across the end."""
    asked, branch = path
    assert branch.end.kind == "contact lets go"
    assert branch.end.before > 0.0 > branch.end.left
    z, jumps = branch.last.z, []
    for degrees in np.degrees(branch.end.alpha) + np.arange(-0.5, 0.6, 0.2):
        answer = Slsqp("J, m", stops_at=1e-12)(asked, np.radians(degrees), z, 60.0)
        assert answer.why == ""
        jumps.append(np.max(np.abs(answer.z - z)) > readings.JUMP)
        z = answer.z
    assert jumps == [False, False, False, True, False, False]


@dataclass(frozen=True)
class Planted:
    """Answers a straight line in α until it goes over, and nothing at some stations."""

    over: float
    silent: tuple[int, ...] = ()
    asked: list = field(default_factory=list, compare=False)

    def __call__(self, problem, alpha, start, seconds):
        self.asked.append(start)
        degrees = round(np.degrees(alpha))
        z = problem.straight + alpha
        z[problem.links :] += 1.5 * (degrees > self.over)
        return Answered(z, "breaks the closure" if degrees in self.silent else "", 1, timed_out=degrees in self.silent)


def found_of(*variants, **how):
    found = Readings()
    for piece in pieces(PAPER, variants, links=FEW, **how):
        found = found.with_piece(piece())
    return found


def test_a_planted_jump_is_found_where_it_is_and_said():
    (track,) = found_of(Optimised("planted", Reading(), Planted(35.0), step=1)).tracks
    ((jump,),) = (track.jumps,)
    assert np.degrees([jump.before, jump.after]) == pytest.approx([35.0, 36.0])
    assert jump.beam == 2
    assert track.as_theirs
    words = told(Readings((track,))).words
    assert any(sentence.startswith("Between 35° and 36°: planted") for sentence in words)


@pytest.mark.parametrize("over", [34.0, 36.0, 90.0])
def test_a_jump_elsewhere_is_not_taken_for_the_papers(over):
    (track,) = found_of(Optimised("planted", Reading(), Planted(over), step=1)).tracks
    assert len(track.jumps) == (over < 90.0)
    assert not track.as_theirs
    assert any(sentence.startswith("Nothing that was asked") for sentence in told(Readings((track,))).words)


def test_stations_without_an_answer_are_counted_and_not_started_from():
    planted = Planted(91.0, silent=(10, 30))
    (track,) = found_of(Optimised("planted", Reading(), planted, step=10)).tracks
    assert [round(np.degrees(alpha)) for alpha, _ in track.failed] == [10, 30]
    assert track.timed_out == 2
    assert len(track.stood) == 8
    np.testing.assert_array_equal(planted.asked[1], planted.asked[2])
    always = Planted(91.0)
    found_of(Optimised("planted", Reading(), always, "straight beams", step=30))
    assert all(np.all(start == np.pi / 2.0) for start in always.asked)


@pytest.fixture(scope="module")
def few():
    return found_of(
        Followed("true contact", NEAREST, step=10, back=True),
        Followed("degree 4", Reading(), step=10, back=True),
        Optimised("SLSQP", Reading(), Slsqp("J, m"), step=10),
    )


def test_the_study_on_a_few_stations(few):
    ahead, back = few.of(NEAREST, "forwards"), few.of(NEAREST, "backwards")
    assert [round(np.degrees(each.alpha)) for each in ahead.stood] == list(range(0, 91, 10))
    assert [round(np.degrees(each.alpha)) for each in back.stood] == list(range(90, -1, -10))
    assert len(ahead.jumps) == 1
    assert np.radians(60.0) <= ahead.ends[0].alpha <= np.radians(90.0)
    assert ahead.jumps[0].before <= ahead.ends[0].alpha <= ahead.jumps[0].after
    assert back.stood[0].energy == pytest.approx(ahead.stood[-1].energy, rel=1e-9)
    assert back.stood[-1].energy > ahead.stood[0].energy  # over, and held at its limit
    assert all(each.held for each in back.stood)


def test_everything_told_is_whole(few):
    shown = told(few)
    for sheet in shown.sheets:
        assert {len(row) for row in sheet.rows} == {len(sheet.headers)}
    assert len(shown.sheets) == 4
    assert shown.pictures[0].png.startswith(b"\x89PNG")
    data = json.loads(documents.text(shown.data))
    assert [track["way"] for track in data["tracks"]] == ["forwards", "backwards", "forwards", "backwards", "forwards"]
    assert data["tracks"][0]["ends"][0]["kind"] == "contact lets go"
    assert told(Readings()).sheets == ()


def test_without_casadi_its_variants_are_left_out(monkeypatch):
    monkeypatch.setattr(readings.peers, "there", lambda: False)
    found = found_of(Optimised("IPOPT", Reading(), Ipopt("J, m")))
    assert found.tracks == ()
    assert any("CasADi is not installed" in sentence for sentence in told(found).words)


def test_the_command_writes_page_numbers_and_figure(monkeypatch, capsys, tmp_path):
    planted = (Optimised("planted", Reading(), Planted(50.0), step=10),)
    monkeypatch.setattr(readings, "pieces", lambda: pieces(PAPER, planted, links=FEW))
    assert run(["study", "readings", "--out", str(tmp_path), "--json", str(tmp_path / "r.json")]) == 0
    assert "50° to 60°" in capsys.readouterr().out
    assert json.loads((tmp_path / "r.json").read_text("utf-8"))["tracks"][0]["jumps"][0]["beam"] == 2
    assert (tmp_path / "readings.html").is_file()
    assert (tmp_path / "readings.png").is_file()
