"""Energy of chains: gradient and Hessian, compiled.

=========  =====================================================================================
symbol     meaning
=========  =====================================================================================
θ_j        angle of link j; e_j unit vector at θ_j, e′_j its quarter turn
n_j        force in link j; N = n·e, Q = n·e′
p_j        position of node j
L, c, s    length of a link, compliances 1/EA and 1/GA_s
d_i        elastic turn of joint i: θ_{i+1} − θ_i less the turn at rest
b, k, m    turn of the neutral line along the element at rest, stiffness of the joint, first moment of flexibility
h, κ       length of an element, curvature; κ₀ at rest
=========  =====================================================================================

**The link.**  A link is a spring with a compliance.  With the force n as an unknown its Lagrangian is

    n·(p_{j+1} − p_j − L e) − L/2 (c N² + s Q² + β Q² r²),    r = 1 − (s − c) N.

The derivative by n is the link equation, without β p_{j+1} − p_j = L (e + c N e + s Q e′), the derivative by p the
balance of forces.  With c = s = β = 0 the links are rigid: the chain of the paper, in the same unknowns.

**The joint.**  The plain joint has the energy k d²/2.  Three corrections make the chain one of fourth order:

1. In an element the moment is M_i − Q r σ, σ measured from the middle, for the line of Reissner's beam gives N an arm.
   Its even part bends the joint.  The odd part has the energy Q² r² h³/(24 EI), β = h²/(12 EI) of the links.
2. An element of the curvature κ has its nodes at C − κ h²/8 of the curve.  The polygon of a strained element is longer
   than at rest by h³(κ² − κ₀²)/12.  With d = h(κ − κ₀) and b = hκ₀ that is h d(d + 2b)/12, half of it on either side:

       − d(d + 2b)/12 · S,    S = a₋ N₋ r₋ + a₊ N₊ r₊,    a half an inner link, or a whole end link.

3. Where EI varies along the element, the odd part of the moment turns the joint by m Q, with the first moment m of the
   flexibility.  With D = d + m(Q₋ + Q₊)/2 the energy is k D²/2 in this mixed form.

The half links at the ends carry their odd moment at their mean tangent, which is a quarter of the joint's turn away:
−w Q̂²/2 with Q̂ = n·e′(θ ± d/4) and w = β L.

Every joint is thus a function F(d, N₋, Q₋, N₊, Q₊).  The kernel sums the partial derivatives of F and of the links,
then turns them to the unknowns by dN = e·dn + Q dθ and dQ = e′·dn − N dθ.

**Energy.**  At a solution the Lagrangian equals the potential energy.  Terms linear in n vanish with the link
equations; quadratic terms change sign: Σ k d²/2 − ½ Σ [N (F_N − F_N⁰) + Q (F_Q − F_Q⁰)], the zero without forces.
The term T of β becomes T − n·∂T/∂n.
"""

from math import cos, sin
from typing import NamedTuple

import numpy as np

from cprbm.chain.compiled import compiled, compiled_inner
from cprbm.chain.mechanism import PER_LINK, Mechanism
from cprbm_scene.answer import Array, Ints


class Links(NamedTuple):
    """Links of all beams: ``first`` index of p_j; lengths; compliances c and s; β."""

    first: Ints
    length: Array
    stretch: Array
    shear: Array
    lean: Array


class Joints(NamedTuple):
    """Joints of all beams: the link ``before``; k, turn at rest, b, m; a₋, a₊; w₋, w₊."""

    before: Ints
    stiffness: Array
    rest: Array
    bend: Array
    skew: Array
    growth_before: Array
    growth_behind: Array
    half_before: Array
    half_behind: Array


class Blocks(NamedTuple):
    """Hessian of all chains by links, without the constant entries ±1 between n and p.

    Attributes:
        turn: ∂²/∂θ_j².
        next_turn: ∂²/∂θ_j ∂θ_{j+1}.
        coupling: (links, 3, 2), n_j by θ of links j − 1, j, j + 1.
        compliance: (links, 3, 2, 2), n_j by n of links j − 1, j, j + 1.
    """

    turn: Array
    next_turn: Array
    coupling: Array
    compliance: Array


def link_arrays(m: Mechanism) -> tuple[Links, Joints]:
    """Links and joints of all beams in the order of the unknowns."""
    chains = m.chains.values()
    first = np.concatenate([m.starts[name] + PER_LINK * np.arange(chain.links) for name, chain in m.chains.items()])
    links = Links(
        first.astype(np.int64),
        np.concatenate([chain.link_length for chain in chains]),
        np.concatenate([chain.stretch for chain in chains]),
        np.concatenate([chain.shear for chain in chains]),
        np.concatenate([chain.lean for chain in chains]),
    )
    offsets = np.cumsum([0, *(chain.links for chain in chains)])
    joints = Joints(
        np.concatenate([at + np.arange(chain.links - 1) for at, chain in zip(offsets, chains, strict=False)]),
        np.concatenate([chain.stiffness for chain in chains]),
        np.concatenate([np.diff(chain.link_angle) for chain in chains]),
        np.concatenate([chain.bend for chain in chains]),
        np.concatenate([chain.skew for chain in chains]),
        np.concatenate([chain.growth[:, 0] for chain in chains]),
        np.concatenate([chain.growth[:, 1] for chain in chains]),
        np.concatenate([chain.half_lean[:-1] for chain in chains]),
        np.concatenate([chain.half_lean[1:] for chain in chains]),
    )
    return links, joints


@compiled_inner
def _partials_of_links(z: Array, links: Links, force: Array) -> None:  # pragma: no cover
    """Write F_N, F_Q, F_NN, F_NQ, F_QQ, N, Q, cos θ, sin θ, r and s − c of the links alone to ``force`` (links, 11)."""
    for j in range(links.first.size):
        i, L, c, s, beta = links.first[j], links.length[j], links.stretch[j], links.shear[j], links.lean[j]
        a, b = cos(z[i + 4]), sin(z[i + 4])
        N, Q, arm = z[i + 2] * a + z[i + 3] * b, z[i + 3] * a - z[i + 2] * b, s - c
        r = 1.0 - arm * N
        force[j, 0], force[j, 1], force[j, 2], force[j, 3], force[j, 4] = (
            -L * (1.0 + c * N - beta * Q * Q * r * arm),
            -L * (s + beta * r * r) * Q,
            -L * (c + beta * (Q * arm) ** 2),
            L * 2.0 * beta * Q * r * arm,
            -L * (s + beta * r * r),
        )
        force[j, 5], force[j, 6], force[j, 7], force[j, 8], force[j, 9], force[j, 10] = N, Q, a, b, r, arm


@compiled_inner
def _partials_of_joints(
    z: Array, links: Links, joints: Joints, force: Array, rate: Array, cross: Array
) -> None:  # pragma: no cover
    """Add the joints' partials to those of the links.

    Writes F_d, F_dd, F_dN₋, F_dQ₋, F_dN₊, F_dQ₊ to ``rate`` (joints, 6), the derivative by both forces to ``cross``.
    """
    for i in range(joints.stiffness.size):
        j = joints.before[i]
        left, right, of = force[j], force[j + 1], rate[i]
        d = z[links.first[j + 1] + 4] - z[links.first[j] + 4] - joints.rest[i]
        k, b, m = joints.stiffness[i], joints.bend[i], 0.5 * joints.skew[i]
        before, behind = joints.growth_before[i], joints.growth_behind[i]
        D = d + m * (left[6] + right[6])
        S = before * left[5] * left[9] + behind * right[5] * right[9]
        grown, slope = d * (d + 2.0 * b) / 12.0, (d + b) / 6.0
        cross[i] = k * m * m
        of[0], of[1] = k * D, k
        of[2], of[3], of[4], of[5] = 0.0, k * m, 0.0, k * m
        left[1] += k * D * m
        right[1] += k * D * m
        left[4] += k * m * m
        right[4] += k * m * m
        if before != 0.0:
            of[0] -= slope * S
            of[1] -= S / 6.0
            of[2] -= slope * before * (2.0 * left[9] - 1.0)
            of[4] -= slope * behind * (2.0 * right[9] - 1.0)
            left[0] -= grown * before * (2.0 * left[9] - 1.0)
            right[0] -= grown * behind * (2.0 * right[9] - 1.0)
            left[2] += 2.0 * grown * before * left[10]
            right[2] += 2.0 * grown * behind * right[10]
        if joints.half_before[i] != 0.0:
            _add_half(left, of, 2, joints.half_before[i], 0.25, d)
        if joints.half_behind[i] != 0.0:
            _add_half(right, of, 4, joints.half_behind[i], -0.25, d)


@compiled_inner
def _add_half(side: Array, of: Array, at: int, w: float, quarter: float, d: float) -> None:  # pragma: no cover
    """Add the partials of −w Q̂²/2 of a half link to those of its link and its joint."""
    a, b = cos(quarter * d), sin(quarter * d)
    N, Q = side[5] * a + side[6] * b, side[6] * a - side[5] * b
    of[0] += w * quarter * Q * N
    of[1] += w * quarter * quarter * (Q * Q - N * N)
    of[at] += w * quarter * (Q * a - N * b)
    of[at + 1] += w * quarter * (N * a + Q * b)
    side[0] += w * Q * b
    side[1] -= w * Q * a
    side[2] -= w * b * b
    side[3] += w * a * b
    side[4] -= w * a * a


@compiled
def evaluate_chains(z: Array, links: Links, joints: Joints, gradient: Array) -> Blocks:  # pragma: no cover
    """Blocks of the Hessian; adds the chains' gradient to ``gradient``."""
    count, turning = links.length.size, joints.stiffness.size
    force, rate, cross = np.empty((count, 11)), np.empty((turning, 6)), np.empty(turning)
    _partials_of_links(z, links, force)
    _partials_of_joints(z, links, joints, force, rate, cross)
    blocks = Blocks(np.empty(count), np.empty(count), np.empty((count, 3, 2)), np.empty((count, 3, 2, 2)))
    _write_blocks(z, links, force, blocks, gradient)
    for i in range(turning):
        _turn_joint(joints.before[i], links, force, rate[i], cross[i], blocks, gradient)
    return blocks


@compiled_inner
def _write_blocks(z: Array, links: Links, force: Array, blocks: Blocks, gradient: Array) -> None:  # pragma: no cover
    """Write the blocks of all links, and add the links' gradient."""
    for j in range(links.first.size):
        i = links.first[j]
        F_N, F_Q, F_NN, F_NQ, F_QQ = force[j, 0], force[j, 1], force[j, 2], force[j, 3], force[j, 4]
        N, Q, a, b = force[j, 5], force[j, 6], force[j, 7], force[j, 8]
        gradient[i] -= z[i + 2]
        gradient[i + 1] -= z[i + 3]
        gradient[i + 5] += z[i + 2]
        gradient[i + 6] += z[i + 3]
        gradient[i + 2] += z[i + 5] - z[i] + F_N * a - F_Q * b
        gradient[i + 3] += z[i + 6] - z[i + 1] + F_N * b + F_Q * a
        gradient[i + 4] += F_N * Q - F_Q * N
        by_N, by_Q = F_NN * Q - F_NQ * N, F_NQ * Q - F_QQ * N
        C, K = blocks.coupling[j], blocks.compliance[j]
        C[::2], K[::2] = 0.0, 0.0
        C[1, 0] = by_N * a - by_Q * b - F_N * b - F_Q * a
        C[1, 1] = by_N * b + by_Q * a + F_N * a - F_Q * b
        K[1, 0, 0] = F_NN * a * a - 2.0 * F_NQ * a * b + F_QQ * b * b
        K[1, 1, 1] = F_NN * b * b + 2.0 * F_NQ * a * b + F_QQ * a * a
        K[1, 0, 1] = (F_NN - F_QQ) * a * b + F_NQ * (a * a - b * b)
        K[1, 1, 0] = K[1, 0, 1]
        blocks.turn[j] = by_N * Q - by_Q * N - F_N * N - F_Q * Q
        blocks.next_turn[j] = 0.0


@compiled_inner
def _turn_joint(
    j: int, links: Links, force: Array, of: Array, X: float, blocks: Blocks, gradient: Array
) -> None:  # pragma: no cover
    """Add what a joint couples: gradient, both turns, and forces and turns of its two links."""
    g = j + 1
    N, Q, a, b = force[j, 5], force[j, 6], force[j, 7], force[j, 8]
    M, R, u, v = force[g, 5], force[g, 6], force[g, 7], force[g, 8]
    gradient[links.first[j] + 4] -= of[0]
    gradient[links.first[g] + 4] += of[0]
    C, E = blocks.coupling[j], blocks.coupling[g]
    # F_N and F_Q of either link by the turns of both
    C[1, 0] -= of[2] * a - of[3] * b
    C[1, 1] -= of[2] * b + of[3] * a
    E[1, 0] += of[4] * u - of[5] * v
    E[1, 1] += of[4] * v + of[5] * u
    ahead, back = of[3] - X * M, -of[5] - X * N
    C[2, 0], C[2, 1] = of[2] * a - ahead * b, of[2] * b + ahead * a
    E[0, 0], E[0, 1] = -of[4] * u - back * v, -of[4] * v + back * u
    blocks.turn[j] += of[1] - 2.0 * (of[2] * Q - of[3] * N)
    blocks.turn[g] += of[1] + 2.0 * (of[4] * R - of[5] * M)
    blocks.next_turn[j] = -(of[1] + of[4] * R - of[5] * M) + of[2] * Q - ahead * N
    if X != 0.0:
        K, P = blocks.compliance[j], blocks.compliance[g]
        K[2, 0, 0], K[2, 0, 1], K[2, 1, 0], K[2, 1, 1] = X * b * v, -X * b * u, -X * a * v, X * a * u
        P[0, 0, 0], P[0, 0, 1], P[0, 1, 0], P[0, 1, 1] = X * b * v, -X * a * v, -X * b * u, X * a * u


def strain_energy(z: Array, links: Links, joints: Joints) -> float:
    """Energy of joints and links at a solution of the link equations."""
    unloaded, turns = z.copy(), np.diff(z[links.first + 4])[joints.before] - joints.rest
    unloaded[links.first + 2], unloaded[links.first + 3] = 0.0, 0.0
    force, free = np.empty((2, len(links.length), 11))
    _partials_of_links(z, links, force)
    _partials_of_links(unloaded, links, free)
    N, Q = force[:, 5], force[:, 6]
    leaning = links.lean * force[:, 9] * (3.0 * force[:, 9] - 2.0)
    stored = links.length * (links.stretch * N * N + (links.shear + leaning) * Q * Q)
    # the links' own forces at rest would cover the small parts of the joints by round-off
    force[:, :2] = free[:, :2] = 0.0
    scratch = np.empty((len(joints.stiffness), 6)), np.empty(len(joints.stiffness))
    _partials_of_joints(z, links, joints, force, *scratch)
    _partials_of_joints(unloaded, links, joints, free, *scratch)
    stored -= N * (force[:, 0] - free[:, 0]) + Q * (force[:, 1] - free[:, 1])
    return 0.5 * float(joints.stiffness @ turns**2 + stored.sum())
