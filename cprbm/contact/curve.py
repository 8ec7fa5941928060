"""Curves for contact, as pieces linear in the positions of nodes.

=========  =====================================================================================
symbol     meaning
=========  =====================================================================================
P_i        position of node i, a complex number x + iy
ξ          local parameter of a piece, from 0 to 1
w_i(ξ)     weight of node i, a cubic polynomial with complex coefficients
C(ξ)       position on the piece, Σ w_i(ξ) P_i
T          half thickness, linear along a piece
=========  =====================================================================================

Complex weights add up to 1, and C follows rigid motions exactly; C has no second derivative by the nodes.

1. A beam's curve is the neutral line of its chain, :mod:`cprbm.chain.spline`: real weights of at most six nodes,
   continuous second derivative.  At rest the spline meets the rest line at the joints.  A piece is a link; a corner of
   the thickness inside a link divides the link into two pieces, so that the thickness is exact.
2. A rigid curve moves with two nodes A and B of a body.  With w constant in time, P = A + w (B − A): the weights of a
   curve with positions p(ξ) at rest are 1 − w and w, w = (p − A)/(B − A).  A circle is a point with half thickness, a
   polyline has straight pieces, a smooth edge has the pieces of a cubic spline.
"""

from collections.abc import Sequence
from dataclasses import dataclass, field
from math import comb
from typing import NamedTuple

import numpy as np

from cprbm.chain import POWERS, BeamChain, Mechanism, lost_compliance
from cprbm_scene import FreeEnd
from cprbm_scene.answer import Array, Flags, Ints

STENCIL = 6
"""Nodes of a piece: four control points of a spline, each a second difference of nodes."""

CUBIC_POWERS = 4
"""Coefficients of a weight."""


CLOSED = 1e-9
"""Distance of a curve's ends, over its length, below which the curve is closed: round-off of coordinates."""


CORNER, BEND = 1, 2
"""Marks of pieces of a rigid curve that begin at a corner, and of pieces of a sharp bend."""

NO_SIDES = np.zeros((0, 2)), np.zeros((0, 2))
"""Points before and behind an edge without straight sides."""


@dataclass(frozen=True, eq=False)
class Curve:
    """A curve, by pieces; lengths are in the mechanism's units.

    Attributes:
        name: of the beam or the contact.
        stencil: index of the x of the nodes of every piece (pieces, STENCIL).
        weights: w (pieces, STENCIL, CUBIC_POWERS), complex, lowest power first.
        arcs: arc lengths of the pieces' ends (pieces + 1,); of a circle zeros.
        half_thickness: T at the pieces' ends (pieces + 1,).
        lost: compliance that a point force lacks on every piece (pieces, POWERS), lowest power first.
        angles: index of the angle of every link (pieces,), −1 without a link.
        corner: ``CORNER`` of a piece that begins at a corner with a place, ``BEND`` of a piece of a sharp bend, else 0.
        beam: name of the beam, empty for a rigid curve; body: name of the body of a rigid curve, else empty.
        closed: whether the last piece leads to the first.
    """

    name: str
    stencil: Ints
    weights: Array
    arcs: Array
    half_thickness: Array
    lost: Array
    angles: Ints
    corner: Ints
    beam: str = ""
    body: str = ""
    closed: bool = False

    @property
    def pieces(self) -> int:
        """Number of pieces."""
        return len(self.stencil)

    @property
    def is_point(self) -> bool:
        """True for a circle."""
        return bool(self.arcs[-1] == 0.0)


NO_PIECES = Curve(
    name="",
    stencil=np.zeros((0, STENCIL), dtype=np.int64),
    weights=np.zeros((0, STENCIL, CUBIC_POWERS), dtype=complex),
    arcs=np.zeros(1),
    half_thickness=np.zeros(1),
    lost=np.zeros((0, POWERS)),
    angles=np.zeros(0, dtype=np.int64),
    corner=np.zeros(0, dtype=np.int64),
)
"""A curve without pieces: the arrays of a scene without contacts have shapes too."""


class CurveArrays(NamedTuple):
    """Pieces of all curves, for the compiled kernels.

    ``first``, ``last`` (curves,) are the first and the last piece of a curve.  Per piece: ``stencil``; ``real``,
    ``imaginary`` parts of the weights; ``arc`` at the begin and arc length ``span``; length of the whole ``link``, the
    unit of distances between places, of a rigid curve the ``span``; ``thickness`` at the begin and the change
    ``thickening``; ``lost`` compliance; ``angle``; ``corner``.
    """

    first: Ints
    last: Ints
    is_point: Flags
    closed: Flags
    stencil: Ints
    real: Array
    imaginary: Array
    arc: Array
    span: Array
    link: Array
    thickness: Array
    thickening: Array
    lost: Array
    angle: Ints
    corner: Ints


def curve_arrays(curves: Sequence[Curve]) -> CurveArrays:
    """Arrays of all curves, in the order of the curves."""
    count, every = np.array([curve.pieces for curve in curves], dtype=np.int64), [NO_PIECES, *curves]
    angle = np.concatenate([curve.angles for curve in every])
    span = np.concatenate([np.diff(curve.arcs) for curve in every])
    return CurveArrays(
        first=np.cumsum(count) - count,
        last=np.cumsum(count) - 1,
        is_point=np.array([curve.is_point for curve in curves], dtype=bool),
        closed=np.array([curve.closed for curve in curves], dtype=bool),
        stencil=np.concatenate([curve.stencil for curve in every]),
        real=np.concatenate([curve.weights.real for curve in every]),
        imaginary=np.concatenate([curve.weights.imag for curve in every]),
        arc=np.concatenate([curve.arcs[:-1] for curve in every]),
        span=span,
        link=np.where(angle < 0, span, np.bincount(angle + 1, span, 1)[angle + 1]),
        thickness=np.concatenate([curve.half_thickness[:-1] for curve in every]),
        thickening=np.concatenate([np.diff(curve.half_thickness) for curve in every]),
        lost=np.concatenate([curve.lost for curve in every]),
        angle=angle,
        corner=np.concatenate([curve.corner for curve in every]),
    )


def beam_curve(m: Mechanism, beam: str, *, thick: bool) -> Curve:
    """Neutral line of a beam, with or without half the thickness."""
    chain = m.chains[beam]
    stencil, weights = _line_weights(chain)
    arcs, spans = _with_knots(chain) if thick else chain.arcs, np.diff(chain.arcs)
    link = np.searchsorted(chain.arcs, arcs[:-1], side="right") - 1
    begin, share = (arcs[:-1] - chain.arcs[link]) / spans[link], np.diff(arcs) / spans[link]
    return Curve(
        name=beam if thick else f"{beam} as a line",
        stencil=m.beam_nodes(beam)[stencil[link]],
        weights=weights[link] @ _powers(begin, share, CUBIC_POWERS),
        arcs=arcs,
        half_thickness=0.5 * chain.section.thickness(arcs) * thick,
        lost=np.einsum("pk,pkj->pj", _lost(m, chain)[link], _powers(begin, share, POWERS)),
        angles=m.beam_angles(beam)[link],
        corner=np.zeros(len(link), dtype=np.int64),
        beam=beam,
    )


def _with_knots(chain: BeamChain) -> Array:
    """Arc lengths of the nodes, and of the corners of the thickness between nodes; the plain chain has nodes alone."""
    between = np.interp(chain.knots, chain.arcs, chain.section.thickness(chain.arcs))
    missed = chain.corrected & (np.abs(chain.section.thickness(chain.knots) - between) > CLOSED * between)
    return np.union1d(chain.arcs, chain.knots[missed])


def _powers(offset: Array, scale: Array, size: int) -> Array:
    """Powers of o + r ξ by powers of ξ (pieces, size, size)."""
    shift = np.zeros((len(scale), size, size))
    for k in range(size):
        for j in range(k + 1):
            shift[:, k, j] = comb(k, j) * offset ** (k - j) * scale**j
    return shift


def _line_weights(chain: BeamChain) -> tuple[Ints, Array]:
    """Stencils and weights of the neutral line's pieces; unused places of a stencil repeat the last node."""
    line, pieces = chain.line, chain.links
    size = len(line.basis)
    # the line's own parameter is o + r ξ
    factors = np.einsum("ck,pkj->pcj", line.basis, _powers(line.offset, np.diff(line.arcs) / line.size, size))
    control = line.control.tocoo()
    first = np.full(pieces, len(chain.nodes))
    terms = []
    for c in range(size):
        piece = control.row - c
        inside = (piece >= 0) & (piece < pieces) & (control.data != 0.0)
        terms.append((piece[inside], control.col[inside], control.data[inside], c))
        np.minimum.at(first, piece[inside], control.col[inside])
    weights = np.zeros((pieces, STENCIL, CUBIC_POWERS), dtype=complex)
    for piece, column, value, c in terms:
        np.add.at(weights[:, :, :size], (piece, column - first[piece]), value[:, None] * factors[piece, c])
    return np.minimum(first[:, None] + np.arange(STENCIL), len(chain.nodes) - 1), weights


def _lost(m: Mechanism, chain: BeamChain) -> Array:
    """Lost compliance of a beam's pieces; none for the plain chain: a polygon spreads no force."""
    if not chain.corrected:
        return np.zeros((chain.links, POWERS))
    beam, h, kind = (
        m.scene.beams[chain.name],
        chain.borders[1] - chain.borders[0],
        np.zeros(chain.links, dtype=np.int64),
    )
    kind[0], kind[-1] = 1 + isinstance(beam.start, FreeEnd), 3 + isinstance(beam.end, FreeEnd)
    bending = 12.0 * h * (chain.lean + chain.half_lean / chain.link_length)
    sheared = lost_compliance("shear")[kind] * (h * chain.shear)[:, None]
    return np.asarray(lost_compliance("bending")[kind] * bending[:, None] + sheared)


@dataclass(eq=False)
class Frames:
    """Pairs of nodes of bodies, a unit apart, that carry rigid curves; made at first use."""

    mechanism: Mechanism
    nodes: dict[str, tuple[int, int]] = field(default_factory=dict)

    def of(self, body: str) -> tuple[int, int]:
        """Indices of the x of a body's two nodes."""
        if body not in self.nodes:
            place = self.mechanism.reference(body)
            a, b = (self.mechanism.attach_node(body, place + arm) for arm in ((0.0, 0.0), (1.0, 0.0)))
            self.nodes[body] = a, b
        return self.nodes[body]

    def rigid_curve(self, name: str, body: str, polynomials: Array, arcs: Array, radius: float = 0.0) -> Curve:
        """Curve of a body from positions by powers of ξ (pieces, at most CUBIC_POWERS), complex, and arc lengths."""
        a, b = self.of(body)
        origin = complex(*self.mechanism.reference(body))
        pieces, size = polynomials.shape
        weights = np.zeros((pieces, STENCIL, CUBIC_POWERS), dtype=complex)
        weights[:, 1, :size] = polynomials
        weights[:, 1, 0] -= origin
        weights[:, 0] = -weights[:, 1]
        weights[:, 0, 0] += 1.0
        return Curve(
            name=name,
            stencil=np.tile(np.array([a, b, b, b, b, b], dtype=np.int64), (pieces, 1)),
            weights=weights,
            arcs=arcs,
            half_thickness=np.full(pieces + 1, radius),
            lost=np.zeros((pieces, POWERS)),
            angles=np.full(pieces, -1, dtype=np.int64),
            corner=np.zeros(pieces, dtype=np.int64),
            body=body,
            closed=pieces > 1 and abs(polynomials[-1].sum() - polynomials[0, 0]) < CLOSED * arcs[-1],
        )

    def circle(self, name: str, body: str, centre: Array, radius: float) -> Curve:
        """Circle about ``centre`` (2,)."""
        return self.rigid_curve(name, body, np.array([[complex(*centre)]]), np.zeros(2), radius)

    def polyline(self, name: str, body: str, points: Array) -> Curve:
        """Straight pieces between ``points`` (k, 2)."""
        places = points @ np.array([1.0, 1.0j])
        chords = np.diff(places)
        return self.rigid_curve(
            name, body, np.column_stack([places[:-1], chords]), np.concatenate([[0.0], np.cumsum(np.abs(chords))])
        )

    def smooth_edge(
        self, name: str, body: str, points: Array, tangents: Array, length: float, sides: tuple[Array, Array] = NO_SIDES
    ) -> Curve:
        """Cubic spline through ``points`` (k, 2), even by arc length, with unit ``tangents`` at both ends.

        Args:
            name, body: of the curve.
            points: places on the edge; a closed edge repeats the first.
            tangents: unit tangents (k, 2) at the points.
            length: arc length of the edge.
            sides: points (j, 2) of straight pieces before and behind the spline.
        """
        from scipy.interpolate import CubicSpline  # scenes without smooth edges do not load it

        places, slopes = points @ np.array([1.0, 1.0j]), tangents @ np.array([1.0, 1.0j])
        pieces = len(points) - 1
        step = length / pieces
        spline = CubicSpline(np.arange(pieces + 1.0), places, bc_type=((1, step * slopes[0]), (1, step * slopes[-1])))
        begin, end = (
            np.concatenate(ends) @ np.array([1.0, 1.0j]) for ends in ((sides[0], points[:1]), (points[-1:], sides[1]))
        )
        straight = [np.column_stack([at[:-1], np.diff(at), 0.0 * at[1:], 0.0 * at[1:]]) for at in (begin, end)]
        spans = np.concatenate([np.abs(np.diff(begin)), np.full(pieces, step), np.abs(np.diff(end))])
        return self.rigid_curve(
            name,
            body,
            np.concatenate([straight[0], spline.c[::-1].T, straight[1]]),
            np.concatenate([[0.0], np.cumsum(spans)]),
        )
