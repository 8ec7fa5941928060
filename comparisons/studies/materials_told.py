"""What is told of the materials: tables, sentences made of the numbers, and the documented JSON."""

from __future__ import annotations

from comparisons.claims import claim_met, claim_of
from comparisons.documents import Plain, plain, values
from comparisons.formats import percent, scaled_unit, vector
from comparisons.measures import Row
from comparisons.sheet import Sheet
from comparisons.studies.drawn import error_against_ratio
from comparisons.studies.materials import MATERIALS, WITHOUT_SHEAR, Materials, Sweep, Tested
from comparisons.studies.told import Told

_ABSENT = ("–",)


def told(found: Materials) -> Told:
    """Everything that is told of what was measured so far."""
    return Told(
        name="materials",
        title="Three materials at one deformation",
        words=_words(found),
        sheets=tuple(sheet for sheet in (_errors(found), _forces(found), _within(found), _ratios(found)) if sheet.rows),
        pictures=(error_against_ratio(found),) if found.sweeps else (),
        data=_data(found),
    )


def shear_ratio(poisson_ratio: float) -> float:
    """E/G = 2(1 + ν)."""
    return 2.0 * (1.0 + poisson_ratio)


def _rows(found: Materials, quantity: str) -> tuple[tuple[Tested, Row], ...]:
    return tuple(
        (tested, row) for tested in found.tested for row in tested.comparison.rows if row.probe.quantity == quantity
    )


def _errors(found: Materials) -> Sheet:
    body = []
    for tested, row in _rows(found, "displacement"):
        claim = claim_of(tested.comparison.scene, row)
        met = claim_met(claim, row)
        steps = row.steps
        body.append(
            (
                tested.specimen.case,
                tested.material,
                f"{row.station:.4g}",
                row.probe.of,
                percent(row.fraction(row.difference)),
                *(
                    (percent(row.fraction(part)) for part in (steps.own, steps.stretch, steps.shear))
                    if steps
                    else 3 * _ABSENT
                ),
                percent(row.fraction(row.bounds.total)) if row.bounds else "–",
                percent(claim.bound) if claim else "–",
                "–" if met is None else "met" if met else "not met",
                tested.comparison.verdict.word.value,
            )
        )
    unfinished = [tested for tested in found.tested if not tested.comparison.rows]
    body.extend(
        (tested.specimen.case, tested.material, *9 * _ABSENT, tested.comparison.verdict.word.value)
        for tested in unfinished
    )
    note = (
        "Difference of the CPRBM from the finite elements in shear, and the three steps whose sum it is: between the "
        "methods within bending, from bending to stretch, from stretch to shear. Theirs: below this for every material."
    )
    note += "".join(
        f" {each.specimen.case}, {each.material}: {each.comparison.verdict.sentence}" for each in unfinished
    )
    headers = ("case", "material", "load", "point", "difference", "methods", "stretch", "shear", "may be", "theirs")
    return Sheet("Displacement error, material by material", (*headers, "", "verdict"), tuple(body), note)


def _forces(found: Materials) -> Sheet:
    body = []
    for tested, row in _rows(found, "force"):
        factor, unit = scaled_unit(row.unit, row.scale / tested.scaled)
        body.append(
            (
                tested.specimen.case,
                tested.material,
                row.probe.of,
                unit,
                vector(row.cprbm / tested.scaled, factor),
                vector(row.fea / tested.scaled, factor),
                percent(row.fraction(row.difference)),
                percent(row.fraction(row.bounds.total)) if row.bounds else "–",
            )
        )
    return Sheet(
        "Contact forces times E₀/E",
        ("case", "material", "contact", "unit", "CPRBM", "FEA", "difference", "may be"),
        tuple(body),
        "E₀ is the modulus of the case's own material.",
    )


def _within(found: Materials) -> Sheet:
    body = tuple(
        (
            case,
            probe,
            *(f"{100.0 * errors[name]:.10f} %" if name in errors else "–" for name in MATERIALS),
            f"{_spread(errors):.1e}",
        )
        for (case, probe), errors in _bending(found).items()
    )
    return Sheet(
        "Within bending, to the tenth decimal",
        ("case", "probe", *MATERIALS, "largest less smallest"),
        body,
        "Error beside the finite elements in bending, a fraction of their value there; the last column is a fraction "
        "as well: what round-off and the tolerances of two iterations leave.",
    )


def _ratios(found: Materials) -> Sheet:
    body = [
        (
            sweep.specimen.case,
            probe,
            *(percent(sweep.without_shear[probe][kinematics]) for kinematics in WITHOUT_SHEAR),
            *map(percent, errors),
        )
        for sweep in found.sweeps
        for probe, errors in sweep.errors.items()
    ]
    ratios = found.sweeps[0].poisson_ratios if found.sweeps else ()
    return Sheet(
        "Error against Poisson's ratio",
        ("case", "probe", *WITHOUT_SHEAR, *(f"ν = {ratio:g}" for ratio in ratios)),
        tuple(body),
        "Beside the finite elements in bending, in stretch, and in shear with that ratio; with twice the elements.",
    )


def _bending(found: Materials) -> dict[tuple[str, str], dict[str, float]]:
    """The errors beside the finite elements in bending, over their own value, by case and probe, then by material.

    A row's fraction within one theory is of the chosen theory's value, in which Poisson's ratio has a part.
    """
    errors: dict[tuple[str, str], dict[str, float]] = {}
    for tested in found.tested:
        for row in tested.comparison.rows:
            error = tested.error(row.probe.name, "bending", finer=False)
            if error is not None:
                errors.setdefault((tested.specimen.case, row.probe.name), {})[tested.material] = error
    return errors


def _spread(errors: dict[str, float]) -> float:
    return max(errors.values()) - min(errors.values())


def _words(found: Materials) -> tuple[str, ...]:
    words = [
        "Every material carries the case's own loads times the ratio of its modulus to the case's own. In the bending "
        "of lines that keep their length a modulus E stands in one place, the stiffness E·I: the potential energy over "
        "E·I, with the loads over E·I, is one and the same function of the shape, and so are its minimum, the contacts "
        "and every relative error. An error of the CPRBM within bending can therefore not depend on E, and to claim "
        "it for three moduli is to claim it once."
    ]
    spreads = [_spread(errors) for errors in _bending(found).values() if len(errors) > 1]
    if spreads:
        words.append(
            f"The numbers say so: within bending the errors of the materials are {max(spreads):.1e} apart at "
            "most, as a fraction."
        )
    words.append(
        "What the finite elements have besides is stretch, by the ratio of E·I to E·A, which is the section's alone "
        "(t²/12 over the square of a length), and shear, by that of E·I to κ·G·A with κ = 5/6 of a rectangle: E/G = "
        "2(1 + ν). Poisson's ratio is the one property of a material that the error can tell."
    )
    words.extend(_slope(sweep) for sweep in found.sweeps if _whole(sweep))
    missed = {
        (tested.specimen.case, tested.specimen.bound)
        for tested, row in _rows(found, "displacement")
        if claim_met(claim_of(tested.comparison.scene, row), row) is False
    }
    words.extend(
        f"The source's {percent(bound)} for the {case} is not met throughout: the tables say which part of each "
        "difference is theory. The source gives no Poisson's ratio."
        for case, bound in sorted(missed)
    )
    return tuple(words)


def _whole(sweep: Sweep) -> bool:
    return all(error is not None for errors in sweep.errors.values() for error in errors)


def _slope(sweep: Sweep) -> str:
    first, last = sweep.poisson_ratios[0], sweep.poisson_ratios[-1]
    parts = [
        f"{probe} from {percent(errors[0])} to {percent(errors[-1])}, {percent(sweep.without_shear[probe]['stretch'])} "
        "without shear"
        for probe, errors in sweep.errors.items()
    ]
    return f"{sweep.specimen.case}: from ν = {first:g} to {last:g} the error goes for {'; for '.join(parts)}."


def _data(found: Materials) -> Plain:
    return {
        "study": "materials",
        "rows": [_row(tested, row) for tested in found.tested for row in tested.comparison.rows],
        "verdicts": [
            {
                "case": tested.specimen.case,
                "material": tested.material,
                "verdict": tested.comparison.verdict.word.value,
                "sentence": tested.comparison.verdict.sentence,
            }
            for tested in found.tested
        ],
        "bending_spread": [
            {"case": case, "probe": probe, "materials": list(errors), "spread": _spread(errors)}
            for (case, probe), errors in _bending(found).items()
        ],
        "poisson": [
            {
                "case": sweep.specimen.case,
                "probe": probe,
                "poisson_ratio": list(sweep.poisson_ratios),
                "difference": list(errors),
                **{kinematics: sweep.without_shear[probe][kinematics] for kinematics in WITHOUT_SHEAR},
            }
            for sweep in found.sweeps
            for probe, errors in sweep.errors.items()
        ],
    }


def _row(tested: Tested, row: Row) -> Plain:
    claim = claim_of(tested.comparison.scene, row)
    own, steps, bounds = tested.properties, row.steps, row.bounds
    scaled = tested.scaled if row.probe.quantity == "force" else 1.0
    return {
        "case": tested.specimen.case,
        "material": tested.material,
        "youngs_modulus": own.youngs_modulus,
        "poisson_ratio": own.poisson_ratio,
        "shear_ratio": shear_ratio(own.poisson_ratio),
        "settings": {"links": plain(tested.specimen.links), "elements": plain(tested.specimen.choices.elements)},
        "stage": row.stage,
        "station": row.station,
        "probe": row.probe.name,
        "unit": row.unit,
        "cprbm": values(row.probe, row.cprbm),
        "fea": values(row.probe, row.fea),
        "scaled_by": scaled,
        "difference": row.fraction(row.difference),
        "difference_bending": tested.error(row.probe.name, "bending", finer=False),
        "uncertainty": None if bounds is None else row.fraction(bounds.total),
        "steps": None
        if steps is None
        else {key: row.fraction(getattr(steps, key)) for key in ("own", "stretch", "shear")},
        "claim": None if claim is None else claim.bound,
        "claim_met": claim_met(claim, row),
    }
