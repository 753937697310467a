"""Arguments of the compiled loop of `solvers.climb`: bodies that differ in numbers alone, settings, and answers."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numba import types as numba_types
from numpy.typing import NDArray

Vector = NDArray[np.float64]
Fields = NDArray[np.float64]
Mask = NDArray[np.bool_]
types: Any = numba_types  # which says nothing of its own types

FRACTION, RATES, PREDICTED = range(3)
"""Tasks of the kernel of a configuration space."""
SPACE_KERNEL = types.float64(
    types.int64,
    types.float64[::1],
    types.float64[::1],
    types.float64[::1],
    types.boolean[::1],
    types.float64[:, ::1],
)
"""A compiled `cosserat.solvers.system.ConfigurationSpace`: (task, placed, q, change, constrained, rates) -> number.

placed : (n,) added to q.  FRACTION : the largest fraction of a step, the change.  RATES : overwrites the rates.
PREDICTED : overwrites the change by the DOFs after motions, the rates; constrained ones stay as they are in the change.
"""

LEFT, REACHED = range(2)
"""Whether the loop has left the body to others, or reached the full load."""


class Members(NamedTuple):
    """Bodies that differ in numbers alone.

    constants : (M, bytes) of the potential.  origin : (M, n) added to the DOFs by the potential.
    placed : (M, n) added to the DOFs by the configuration space.  scale, start : (M, n) as in
    `cosserat.solvers.system`.  dead : (M, n) the loads [N].  sizes : (M, 2) the largest of all loads and their sum [N].
    """

    constants: NDArray[np.uint8]
    origin: Fields
    placed: Fields
    scale: Fields
    start: Fields
    dead: Fields
    sizes: Fields


class Limits(NamedTuple):
    """Settings: tolerance, most iterations, longest increment; numbers of terms and parts, and width of bands."""

    tolerance: float
    max_iterations: int
    longest: float
    terms: int
    parts: int
    width: int


class Answers(NamedTuple):
    """What the loop overwrites.

    q, reaction : (M, n) [m, N].  forces : (M, 3) residual, tolerance and rounding [N].  counts : (M, 2) iterations and
    cutbacks.  status : (M,) whether each is solved.
    """

    q: Fields
    reaction: Fields
    forces: Fields
    counts: NDArray[np.int64]
    status: NDArray[np.int64]

    @classmethod
    def empty(cls, members: int, dofs: int) -> Answers:
        """Of bodies that nobody has looked at."""
        q, reaction = np.zeros((2, members, dofs))
        return cls(
            q,
            reaction,
            np.zeros((members, 3)),
            np.zeros((members, 2), dtype=np.int64),
            np.zeros(members, dtype=np.int64),
        )


REGULAR, CRITICAL, UNSTABLE = range(3)
"""Whether an equilibrium has rates: it is stable; it is at a critical load; its Hessian is not positive."""


class Ways(NamedTuple):
    """How K parameters change M equilibria of a family, in rows (M K, ...), those of one equilibrium together.

    softened : (M K, F) constants of the potential whose gradient is the rate of the gradient, with the strains kept and
    forces counted in the lengths of the reference; the constants of the body besides.
    places : (P, F) where these are among its constants, as numbers.
    softens : (K,) which parameters change the body itself.
    scaled : (M K, n) rates of these lengths, as fractions, by DOF.
    dead : (M K, n) rates of the loads [N].
    """

    softened: Fields
    places: NDArray[np.int64]
    softens: Mask
    scaled: Fields
    dead: Fields


class Rates(NamedTuple):
    """What the loop overwrites.

    q, reaction : (M K, n) rates of the equilibria [m, N].  rounding : (M K,) of the forces that cause them, as a
    fraction.  status : (M,) whether each equilibrium has some.
    """

    q: Fields
    reaction: Fields
    rounding: Vector
    status: NDArray[np.int64]

    @classmethod
    def empty(cls, members: int, parameters: int, dofs: int) -> Rates:
        """Of equilibria that nobody has looked at."""
        rows = members * parameters
        return cls(
            np.zeros((rows, dofs)),
            np.zeros((rows, dofs)),
            np.zeros(rows),
            np.full(members, UNSTABLE),
        )


class Body(NamedTuple):
    """One of them, with its kernels and work space for compiled code."""

    kernel: Any
    space: Any
    data: NDArray[np.uint8]
    origin: Vector
    placed: Vector
    scale: Vector
    dead: Vector
    held: Mask
    load: float
    total: float
    at: Vector
    gradient: Vector
    room: Vector
    band: Fields
    skew: Fields
    terms: Vector
    none: Vector


STEPS, BALANCED, UNDEFINED = range(3)
"""What comes of a correction: a step, a balance, no energy there or no step."""
STATE = 13
(
    FACTOR,
    RESIDUAL,
    TOLERANCE,
    ROUNDING,
    CHANGE,
    COUNT,
    NEGATIVE,
    SINGULAR,
    LOG,
    TRIED,
    LENGTH,
    SLOPE,
    SPENT,
) = range(STATE)
"""Numbers of the state of corrections: load factor, forces as in `Answers`, change of the factor, steps taken, and, of
a balance, how many eigenvalues of the Hessian are negative, whether it is singular, and the logarithm of the size of
its determinant; constrained DOFs do not count.  Of the end of an arc the length that was tried first, the length,
change of the load factor along the path, and steps of all tries."""


class Plane(NamedTuple):
    """A plane normal to a path at a distance from a point of it, where an equilibrium is to be found.

    start : (n,) DOFs of the point.  direction : (n,) of the path.  factor, slope : of the load, and their change along
    the path.  ds : the distance.  weight : of the factor in products.  load : largest one at the factor one [N].
    tolerance : fraction of it.  most : steps.
    """

    start: Vector
    direction: Vector
    factor: float
    slope: float
    ds: float
    weight: float
    load: float
    tolerance: float
    most: int


class Arcs(NamedTuple):
    """How a path is followed by arcs.

    factor, slope, negative : at the start, as in `Plane`, and how many eigenvalues are negative there.
    ds, smallest, longest : length of the first arc, that to which it may be halved, and that of the longest.
    stray : largest distance of a point from the tangent, as a fraction of the arc.  cosine : least one of its turn.
    until, limit : load factors where it ends.  load, tolerance : as in `Plane`.
    """

    factor: float
    slope: float
    negative: int
    ds: float
    smallest: float
    longest: float
    stray: float
    cosine: float
    until: float
    limit: float
    load: float
    tolerance: float


class Found(NamedTuple):
    """The ends of K arcs.

    q, direction, rate, reaction : (K, n) DOFs, direction of the path, rate of the DOFs with the load factor, and forces
    of the constrained DOFs [N].  state : (K, STATE).  lost : (1,) steps of an arc that has no end.
    """

    q: Fields
    direction: Fields
    rate: Fields
    reaction: Fields
    state: Fields
    lost: Vector

    @classmethod
    def empty(cls, arcs: int, dofs: int) -> Found:
        """Nothing found yet."""
        q, direction, rate = np.empty((3, arcs, dofs))
        reaction, state = np.empty((arcs, dofs)), np.empty((arcs, STATE))
        return cls(q, direction, rate, reaction, state, np.empty(1))


class Around(NamedTuple):
    """Work space of corrections.

    gradient, rate : (n,) assembled last, and its derivative by the load factor [N].  band, skew : (n, w) the Hessian,
    as in `solvers.system`.  scale, held : (n,) as in `Body`.  factor, rooms : (n + w, w) and (2, n + w).
    lu, pivots : as of `solvers.climb.decompose`.
    """

    gradient: Vector
    rate: Vector
    band: Fields
    skew: Fields
    scale: Vector
    held: Mask
    factor: Fields
    rooms: Fields
    lu: Fields
    pivots: NDArray[np.int64]


class Numbers(NamedTuple):
    """One body of `Members`; terms : of its energy."""

    data: NDArray[np.uint8]
    origin: Vector
    placed: Vector
    dead: Vector
    terms: int
