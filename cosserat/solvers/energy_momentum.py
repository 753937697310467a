"""The implicit method of `solvers.integrate`, compiled: the midpoint rule with a discrete gradient.

Stresses come from the mean of the strains at both ends of a step (Simo & Tarnow, ZAMP 43, 757, 1992) and act along
the directions of its midpoint.  Strains of the midpoint itself would include t^2 / 8 for a pure rotation by t: a
compression beyond buckling for a thin body.

A further force sigma z makes the work of the forces equal the change of energy exactly (Gonzalez, J. Nonlinear Sci. 6,
449, 1996).  Gonzalez takes z along the step.  Here, for a free body, z is the step less its rigid part: the force then
has neither a resultant nor a moment and conserves linear and angular momentum.  The method is of second order.  If a
body hardly deforms in a step, z may not exist.  After some iterations the step then omits it, and its energy is right
to third order in the deformation.

Mass-proportional damping c multiplies all momenta by exp(-c h / 2) before and after an undamped step (Strang, SIAM J.
Numer. Anal. 5, 506, 1968): a mode loses energy at the rate c, resolved or not, while c omega h^2 < 8.  Damping of some
modes does the same to their momenta alone.

Stiffness-proportional damping T is the force T K (change of the DOFs) / h inside the step.  K is the stiffness of the
material at the midpoint of the step: its Hessian there with zero stresses, B^T C B with the rates of strain B.  So it
takes energy in every step, and none from a rotation, however large.  A mode of frequency omega loses energy at the rate
ln((1 + a + b) / (1 + a - b)) / h, a = (omega h / 2)^2, b = T omega^2 h / 2: for small b, T omega^2 / (1 + a).

Newton's method solves each step.  It keeps its matrix from one step to the next while the corrections shrink fast, as
they do if little changes in a step.

Functions that allocate nothing are compiled without reference counts, which take a fifth of a short step.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, TypeVar

import numpy as np
from numba import njit
from numpy.typing import NDArray

from cosserat.solvers.banded import Band, Mask, Vector
from cosserat.solvers.potential import COMMIT, GRADIENT, HESSIAN, STRAINS
from cosserat.solvers.step import CORRECTED, FORCED, Bodies, Room, Run

Fields = NDArray[np.float64]
F = TypeVar("F", bound=Callable[..., Any])
_uncounted: Callable[[F], F] = njit(cache=True, _nrt=False)  # type: ignore[call-overload] # an option of Numba all the same

TOLERANCE = 1e-11  # of the last correction, as a fraction of the step
MAX_ITERATIONS = 60
_REFACTOR_RATIO = 0.02  # ratio of two corrections above which the matrix is factored again
_MAX_SCALED_FRACTION = 0.1  # largest fraction by which stresses are scaled to balance the energy
_DIVERGENCE_RATIO = 0.5  # ratio of two corrections above which an older matrix is discarded
_CORRECTION_START = 1e-3  # relative correction below which the change of energy is imposed
_MAX_CORRECTED_ITERATIONS = 25  # iterations with sigma, which is not in the matrix; later ones omit it
_DAMPED, _DRIVEN, _WORKED = range(3)  # indices of `exchanged`
_FRESH, _JUDGED, _TURNING, _STIFFEST = range(4)  # indices of `memory`
_TINY = float(np.finfo(float).tiny)
STALL = 1e4  # corrections that stop shrinking below this multiple of round-off are round-off
_EPS = float(np.finfo(float).eps)
_UNROLLED = (0,) * 8
"""As many zeros as the width of the most common band: code for just this width is twice as fast."""
_MIN_DEFORMING_FRACTION = 0.1  # deforming fraction of a step below which sigma is omitted


@_uncounted
def _multiply(band: Band, x: Vector, y: Vector) -> None:
    """Overwrite y with H x."""
    n, width = band.shape
    y[:] = 0.0
    for j in range(n):
        y[j] += band[j, 0] * x[j]
        for k in range(1, min(width, n - j)):
            y[j + k] += band[j, k] * x[j]
            y[j] += band[j, k] * x[j + k]


@_uncounted
def _uncouple(band: Band, constrained: Mask) -> None:
    """Zero in place the rows and columns of the constrained DOFs of a symmetric or skew-symmetric matrix."""
    n, width = band.shape
    for j in range(n):
        for k in range(1, min(width, n - j)):
            if constrained[j] or constrained[j + k]:
                band[j, k] = 0.0


@_uncounted
def rotate(x: Vector, framed: NDArray[np.int64], axes: Fields, sense: float) -> None:
    """Rotate pairs of components in place: into frames with these axes for 1, out of them for -1."""
    for k in range(framed.size):
        i, c, s = framed[k], axes[0, k], sense * axes[1, k]
        x[i], x[i + 1] = c * x[i] + s * x[i + 1], c * x[i + 1] - s * x[i]


@_uncounted
def rotate_band(
    band: Band, framed: NDArray[np.int64], axes: Fields, sense: float, symmetric: bool
) -> None:
    """Rotate rows and columns of a symmetric or skew-symmetric matrix in place, as `rotate`.

    Both components of a pair must be coupled to the same others, as those of a vertex are.
    """
    n, width = band.shape
    for k in range(framed.size):
        i, c, s = framed[k], axes[0, k], sense * axes[1, k]
        for j in range(max(0, i + 2 - width), i):
            one, two = band[j, i - j], band[j, i + 1 - j]
            band[j, i - j], band[j, i + 1 - j] = c * one + s * two, c * two - s * one
        for j in range(i + 2, min(n, i + width)):
            one, two = band[i, j - i], band[i + 1, j - i - 1]
            band[i, j - i], band[i + 1, j - i - 1] = c * one + s * two, c * two - s * one
        if symmetric:
            one, both, two = band[i, 0], band[i, 1] if width > 1 else 0.0, band[i + 1, 0]
            band[i, 0] = c * c * one + 2 * c * s * both + s * s * two
            band[i + 1, 0] = s * s * one - 2 * c * s * both + c * c * two
            if width > 1:
                band[i, 1] = c * s * (two - one) + (c * c - s * s) * both


@_uncounted
def _cholesky(band: Band) -> bool:
    """Overwrite a symmetric band with its lower factor, its diagonal inverted; False if not positive."""
    n, width = band.shape
    for j in range(n):
        if not band[j, 0] > 0.0:
            return False
        inverse = 1 / np.sqrt(band[j, 0])
        band[j, 0] = inverse
        last = min(width, n - j)
        for k in range(1, last):
            band[j, k] *= inverse
        for k in range(1, last):
            factor = band[j, k]
            for m in range(k, last):
                band[j + k, m - k] -= factor * band[j, m]
    return True


@_uncounted
def _substitute(factor: Band, x: Vector) -> None:
    """Overwrite a right-hand side with the solution."""
    if factor.shape[1] == len(_UNROLLED):
        _solve(factor, x, _UNROLLED)
    else:
        _solve(factor, x, range(factor.shape[1]))


@_uncounted
def _solve(factor: Band, x: Vector, width: Any) -> None:
    """The substitution itself; width : something of this length, which compiled code may know."""
    n = x.size
    whole = max(0, n - len(width) + 1)  # rows that have all entries
    for j in range(whole):
        x[j] *= factor[j, 0]
        for k in range(1, len(width)):
            x[j + k] -= factor[j, k] * x[j]
    for j in range(whole, n):
        x[j] *= factor[j, 0]
        for k in range(1, n - j):
            x[j + k] -= factor[j, k] * x[j]
    for j in range(n - 1, whole - 1, -1):
        total = x[j]
        for k in range(1, n - j):
            total -= factor[j, k] * x[j + k]
        x[j] = total * factor[j, 0]
    for j in range(whole - 1, -1, -1):
        total = x[j]
        for k in range(1, len(width)):
            total -= factor[j, k] * x[j + k]
        x[j] = total * factor[j, 0]


@_uncounted
def _remove(part: Vector, x: Vector) -> None:
    """Make x orthogonal to part."""
    share, size = 0.0, 0.0
    for i in range(x.size):
        share += part[i] * x[i]
        size += part[i] * part[i]
    for i in range(x.size):
        x[i] -= share / size * part[i]


@_uncounted
def _deforming_part(
    change: Vector, middle: Vector, translations: Fields, rotations: Fields, z: Vector
) -> bool:
    """z: a change less its rigid part at the midpoint, the change itself where no translations are free.

    rotations : (d (d - 1) / 2, n) is overwritten.  DOFs are components of vectors of a space of dimension d, the number
    of translations.  True if hardly anything is left.
    """
    _copy(change, z)
    dimension = translations.shape[0]
    if dimension == 0:
        return False
    number = 0
    for a in range(dimension):
        for b in range(a + 1, dimension):
            spin = rotations[number]
            spin[:] = 0.0
            for i in range(0, change.size, dimension):
                spin[i + a], spin[i + b] = -middle[i + b], middle[i + a]
            for _ in range(2):  # twice: a rotation about a distant origin is nearly a translation
                for k in range(dimension):
                    _remove(translations[k], spin)
                for k in range(number):
                    _remove(rotations[k], spin)
            number += 1
    for _ in range(2):
        for k in range(dimension):
            _remove(translations[k], z)
        for k in range(number):
            _remove(rotations[k], z)
    deforming = whole = 0.0
    for i in range(z.size):
        deforming += z[i] * z[i]
        whole += change[i] * change[i]
    return deforming < _MIN_DEFORMING_FRACTION**2 * whole


@_uncounted
def _step_matrix(band: Band, mass: Band, inertia: float, constrained: Mask) -> float:
    """Overwrite a Hessian with half of it plus inertia times the mass, constrained DOFs uncoupled; stiffest entry."""
    n, width = band.shape
    stiffest = 0.0
    for j in range(n):
        stiffest = max(stiffest, abs(band[j, 0]))
        for k in range(width):
            band[j, k] *= 0.5
        for k in range(mass.shape[1]):
            band[j, k] += inertia * mass[j, k]
    _uncouple(band, constrained)
    return stiffest


@_uncounted
def _sigma(
    change: Vector, gradient: Vector, z: Vector, before: float, after: float, blur: float
) -> float:
    """The sigma that makes the work of gradient + sigma z the change of energy; zero where that is round-off.

    blur : sqrt(2 k) eps q: rounding a position by eps q changes an energy Pi = k u^2 / 2 by sqrt(2 k Pi) eps q.
    """
    work, along = 0.0, 0.0
    for i in range(change.size):
        work += gradient[i] * change[i]
        along += z[i] * change[i]
    missing, size = after - before - work, abs(before) + abs(after)
    if along == 0.0 or not abs(missing) > blur * np.sqrt(size) + _EPS * size:
        return 0.0
    return float(missing / along)


@_uncounted
def _lose(
    v: Vector, loss: Vector, mass: Band, constrained: Mask, work: Vector, exchanged: Vector
) -> None:
    """Add a loss to the velocities; exchanged: energy that damping takes and that supports give.  work : M v."""
    n = v.size
    before = 0.0
    for i in range(n):
        before += v[i] * work[i] / 2
    for i in range(n):
        v[i] += loss[i]
    _multiply(mass, loss, work)
    given = 0.0
    for i in range(n):
        if constrained[i]:
            given += v[i] * work[i]
    _multiply(mass, v, work)
    now = 0.0
    for i in range(n):
        now += v[i] * work[i] / 2
    exchanged[_DAMPED] += before - now + given
    exchanged[_DRIVEN] += given


@_uncounted
def _decay(v: Vector, run: Run, room: Room, share: float, exchanged: Vector) -> None:
    """Damp the momenta of the free DOFs: they lose a share."""
    work, loss = room.product, room.z
    _multiply(run.mass, v, work)
    for i in range(v.size):
        loss[i] = 0.0 if run.constrained[i] else -share * work[i]
    _substitute(room.mass_factor, loss)
    _lose(v, loss, run.mass, run.constrained, work, exchanged)


@_uncounted
def _fade(v: Vector, run: Run, room: Room, exchanged: Vector) -> None:
    """Damp the momenta of the damped modes for half a step."""
    loss = room.z
    loss[:] = 0.0
    _multiply(run.mass, v, room.product)
    for k in range(run.damped_modes.shape[0]):
        shape, amplitude = run.damped_modes[k], 0.0
        for i in range(v.size):
            amplitude += shape[i] * room.product[i]
        _add(loss, (np.exp(-run.modal_rates[k] * run.h / 2) - 1) * amplitude, shape)
    _lose(v, loss, run.mass, run.constrained, room.product, exchanged)


@_uncounted
def _damp(v: Vector, run: Run, room: Room, share: float, exchanged: Vector) -> None:
    """Damp momenta for half a step."""
    if share > 0.0:
        _decay(v, run, room, share, exchanged)
    if run.modal_rates.size > 0:
        _fade(v, run, room, exchanged)


@_uncounted
def _material(bodies: Bodies, run: Run, room: Room) -> None:
    """Overwrite `resisting` by the stiffness of the material at the midpoint: its Hessian with zero stresses."""
    room.resisting[:, :] = 0.0
    bodies.kernels[0](
        room.middle,
        run.reference,
        bodies.constants[0],
        bodies.history[0],
        run.rest_strains,
        HESSIAN,
        room.force,
        room.resisting,
        room.resisting[:0],
        bodies.terms[0],
    )
    rotate_band(room.resisting, run.framed, run.axes, 1.0, True)


@_uncounted
def _resist(bodies: Bodies, run: Run, room: Room, gradient: Vector) -> None:
    """Add the force of the stiffness-proportional damping to the gradient."""
    _material(bodies, run, room)
    _multiply(room.resisting, room.change, room.resisted)
    for i in range(room.resisted.size):
        room.resisted[i] *= run.damping_time / run.h
    _add(gradient, 1.0, room.resisted)


@_uncounted
def _body(bodies: Bodies, q: Vector, after: Vector, task: int, gradient: Vector, band: Band) -> float:
    """The energy of the body; adds its gradient and Hessian."""
    energy: float = bodies.kernels[0](
        q,
        after,
        bodies.constants[0],
        bodies.history[0],
        bodies.strains[0],
        task,
        gradient,
        band,
        band[:0],
        bodies.terms[0],
    )
    return energy


@_uncounted
def _corrected(
    bodies: Bodies, q: Vector, after: Vector, task: int, gradient: Vector, band: Band
) -> float:
    """The energy of what has a potential beside the body; adds its gradient and Hessian."""
    energy = 0.0
    for k in range(1, len(bodies.kernels)):
        if bodies.role[k] == CORRECTED:
            energy += bodies.kernels[k](
                q,
                after,
                bodies.constants[k],
                bodies.history[k],
                bodies.strains[k],
                task,
                gradient,
                band,
                band[:0],
                bodies.terms[k],
            )
    return energy


@_uncounted
def _forced(
    bodies: Bodies, run: Run, room: Room, task: int, gradient: Vector, band: Band, done: int
) -> None:
    """Add gradient and Hessian of the forced loads at the midpoint, times their factors; `pushed` is their gradient."""
    room.pushed[:] = 0.0
    for k in range(1, len(bodies.kernels)):
        if bodies.role[k] != FORCED:
            continue
        own, level = room.force, run.levels[done, k]
        own[:] = 0.0
        if task == HESSIAN:
            room.pushing[:, :] = 0.0
        bodies.kernels[k](
            room.middle,
            room.end,
            bodies.constants[k],
            bodies.history[k],
            bodies.strains[k],
            task,
            own,
            room.pushing,
            band[:0],
            bodies.terms[k],
        )
        _add(room.pushed, level, own)
        if task == HESSIAN:
            for j in range(band.shape[0]):
                for i in range(band.shape[1]):
                    band[j, i] += level * room.pushing[j, i]
    rotate(room.pushed, run.framed, run.axes, 1.0)
    _add(gradient, 1.0, room.pushed)


@_uncounted
def _place(run: Run, room: Room, q: Vector) -> None:
    """Overwrite `end` by DOFs along the axes of space."""
    _copy(q, room.end)
    rotate(room.end, run.framed, run.axes, -1.0)


@_uncounted
def _commit(bodies: Bodies, q: Vector, gradient: Vector, band: Band) -> None:
    """Overwrite the internal variables by those at q, an accepted state."""
    for k in bodies.counted:
        bodies.kernels[k](
            q,
            q[:0],
            bodies.constants[k],
            bodies.history[k],
            bodies.strains[k],
            COMMIT,
            gradient,
            band,
            band[:0],
            bodies.terms[k],
        )


@_uncounted
def _started(bodies: Bodies, q: Vector, gradient: Vector, band: Band) -> float:
    """The energy at the start of a step; stores the strains there."""
    energy = _body(bodies, q, q[:0], STRAINS, gradient, band)
    if bodies.loaded:
        energy += _corrected(bodies, q, q[:0], STRAINS, gradient, band)
    return energy


@_uncounted
def _predict(run: Run, room: Room, v: Vector, done: int, turning: bool) -> None:
    """The first guess of a step: an extrapolation of the last two changes, or the velocity."""
    h, load, constrained, moved = run.h, room.load, run.constrained, run.moved
    change, first, earlier, earliest, pull = (
        room.change,
        room.first,
        room.earlier,
        room.earliest,
        room.pull,
    )
    _copy(run.load, load)
    for k in range(run.varied.shape[0]):
        _add(load, run.factors[done, k], run.varied[k])
    _multiply(run.mass, v, pull)
    for i in range(v.size):
        pull[i] = load[i] + 2 / h * pull[i]
        guess = h * v[i] if done < 2 or turning else 2 * earlier[i] - earliest[i]
        change[i] = 0.0 if constrained[i] else guess
        first[i] = change[i]
    for i in range(moved.size):
        change[moved[i]] = first[moved[i]] = run.places[done + 1, i] - run.places[done, i]


@_uncounted
def _factorise(bodies: Bodies, run: Run, room: Room, memory: Vector, done: int) -> bool:
    """Assemble and factor Newton's matrix at the midpoint; False if that fails."""
    middle, end, gradient, factor = room.middle, room.end, room.gradient, room.factor
    factor[:, :] = 0.0
    if not np.isfinite(_body(bodies, middle, end, HESSIAN, gradient, factor)):
        return False
    if bodies.loaded:
        _corrected(bodies, middle, end, HESSIAN, gradient, factor)
    if bodies.forced:
        _forced(bodies, run, room, HESSIAN, gradient, factor, done)
    rotate_band(factor, run.framed, run.axes, 1.0, True)
    memory[_STIFFEST] = _step_matrix(factor, run.mass, 2 / run.h**2, run.constrained)
    if run.damping_time > 0.0:
        _material(bodies, run, room)
        for j in range(factor.shape[0]):
            for k in range(factor.shape[1]):
                factor[j, k] += run.damping_time / run.h * room.resisting[j, k]
        _uncouple(factor, run.constrained)
    memory[_FRESH], memory[_JUDGED] = 1.0, 0.0
    return _cholesky(factor)


@_uncounted
def _meet_energy(
    change: Vector,
    middle: Vector,
    translations: Fields,
    rotations: Fields,
    z: Vector,
    gradient: Vector,
    before: float,
    after: float,
    blur: float,
) -> None:
    """Add the force to the gradient that makes the work of the forces the change of energy."""
    rigid = _deforming_part(change, middle, translations, rotations, z)
    if rigid:
        _copy(gradient, z)
    sigma = _sigma(change, gradient, z, before, after, blur)
    if rigid and abs(sigma) > _MAX_SCALED_FRACTION:
        sigma = 0.0
    if sigma != 0.0:
        _add(gradient, sigma, z)


@_uncounted
def _add(x: Vector, factor: float, y: Vector) -> None:
    """x += factor y."""
    for i in range(x.size):
        x[i] += factor * y[i]


@_uncounted
def _accelerate(
    change: Vector, moved: NDArray[np.int64], rates: Fields, done: int, h: float, gained: Vector
) -> None:
    """The change, with the constrained DOFs accelerated from one prescribed velocity to the next."""
    _copy(change, gained)
    for i in range(moved.size):
        gained[moved[i]] = h / 2 * (rates[done, i] + rates[done + 1, i])


@_uncounted
def _unbalance(
    constrained: Mask, pull: Vector, inertia: float, product: Vector, gradient: Vector, force: Vector
) -> None:
    """The unbalanced force."""
    for i in range(force.size):
        force[i] = 0.0 if constrained[i] else pull[i] - inertia * product[i] - gradient[i]


@_uncounted
def _correct(factor: Band, force: Vector, change: Vector) -> tuple[float, float]:
    """Correct the change of the step; returns the largest correction and the largest change."""
    _substitute(factor, force)
    size = farthest = 0.0
    for i in range(change.size):
        change[i] += force[i]
        size, farthest = max(size, abs(force[i])), max(farthest, abs(change[i]))
    return size, farthest


@_uncounted
def _copy(x: Vector, y: Vector) -> None:
    """y = x."""
    for i in range(x.size):
        y[i] = x[i]


@_uncounted
def _largest(x: Vector) -> float:
    """The largest size of an entry."""
    size = 0.0
    for i in range(x.size):
        size = max(size, abs(x[i]))
    return size


@_uncounted
def _ends(run: Run, q: Vector, change: Vector, middle: Vector, end: Vector) -> None:
    """Midpoint and end of a step, along the axes of space."""
    for i in range(q.size):
        middle[i] = q[i] + change[i] / 2
        end[i] = q[i] + change[i]
    rotate(middle, run.framed, run.axes, -1.0)
    rotate(end, run.framed, run.axes, -1.0)


@_uncounted
def _solve_step(
    bodies: Bodies, run: Run, room: Room, q: Vector, memory: Vector, before: float, done: int
) -> bool:
    """Newton's method for the change of one step; False if it does not converge."""
    change, middle, end, z, gradient = room.change, room.middle, room.end, room.z, room.gradient
    gained, product, force, factor = room.gained, room.product, room.force, room.factor
    mass, constrained, inertia, pull = run.mass, run.constrained, 2 / run.h**2, room.pull
    kernel, constants, history = bodies.kernels[0], bodies.constants[0], bodies.history[0]
    strains, terms, none = bodies.strains[0], bodies.terms[0], factor[:0]
    translations, rotations, moved, rates = run.translations, room.rotations, run.moved, run.rates
    near, rounding = False, _EPS * _largest(q)
    turning = memory[_TURNING] != 0.0
    stale = memory[_FRESH] != 0.0 and not turning  # whether the matrix is of an earlier step
    memory[_FRESH] = 1.0 if stale else 0.0
    # last correction as a fraction of the step; the last two corrections
    relative = size = sized = np.inf
    for iteration in range(MAX_ITERATIONS):
        if stale and iteration > 0 and not size <= _DIVERGENCE_RATIO * sized:
            memory[_FRESH], memory[_TURNING] = 0.0, 1.0
            stale, near = False, False  # restart with a matrix of this step
            relative = size = np.inf
            _copy(room.first, change)
        _ends(run, q, change, middle, end)
        if memory[_FRESH] == 0.0:
            if not _factorise(bodies, run, room, memory, done):
                return False
            stale = False
        gradient[:] = 0.0
        after = kernel(middle, end, constants, history, strains, GRADIENT, gradient, none, none, terms)
        if bodies.loaded:
            after += _corrected(bodies, middle, end, GRADIENT, gradient, none)
        rotate(gradient, run.framed, run.axes, 1.0)
        if stale and not np.isfinite(after):
            size = np.inf
            continue
        if not np.isfinite(after):
            return False
        if near and iteration <= _MAX_CORRECTED_ITERATIONS:
            blur = rounding * np.sqrt(2 * memory[_STIFFEST])
            _meet_energy(change, middle, translations, rotations, z, gradient, before, after, blur)
        if bodies.forced:
            _forced(bodies, run, room, GRADIENT, gradient, none, done)
        if run.damping_time > 0.0:
            _resist(bodies, run, room, gradient)
        _accelerate(change, moved, rates, done, run.h, gained)
        _multiply(mass, gained, product)
        _unbalance(constrained, pull, inertia, product, gradient, force)
        sized = size
        size, farthest = _correct(factor, force, change)
        settled = size <= max(TOLERANCE * farthest, rounding)
        stalled = size > relative * farthest / 2 and size < STALL * rounding
        if near and (settled or stalled):
            return True
        if not (stale or np.isfinite(size)):
            return False
        if memory[_JUDGED] != 0.0 and size > _REFACTOR_RATIO * relative * farthest:
            memory[_FRESH] = 0.0
        memory[_JUDGED] = 1.0
        relative = size / max(farthest, _TINY)
        near = near or settled or stalled or relative < _CORRECTION_START
    return False


@_uncounted
def _exchange(run: Run, room: Room, exchanged: Vector) -> None:
    """Add the work of the loads that vary, and the energy that the stiffness-proportional damping takes."""
    for i in range(room.change.size):
        varied = room.load[i] - run.load[i] - room.pushed[i]
        exchanged[_WORKED] += varied * room.change[i]
        exchanged[_DAMPED] += room.resisted[i] * room.change[i]


@_uncounted
def _accept(
    run: Run, room: Room, q: Vector, v: Vector, exchanged: Vector, turned: Vector, done: int
) -> None:
    """Accept the step: DOFs, velocities, and the energy that moved supports have given."""
    h, load, moved = run.h, room.load, run.moved
    change, earlier, earliest, gradient = room.change, room.earlier, room.earliest, room.gradient
    for i in range(moved.size):
        k = moved[i]
        pushed = 2 / h**2 * room.product[k] - (room.pull[k] - load[k])
        exchanged[_DRIVEN] += pushed * room.gained[k] + (gradient[k] - load[k]) * change[k]
    for i in range(0, q.size, run.dimension):
        square = 0.0
        for k in range(i, i + run.dimension):
            square += change[k] * change[k]
        turned[0] = max(turned[0], run.weights[i] * np.sqrt(square))
    for i in range(q.size):
        q[i] += change[i]
        v[i] = 2 / h * change[i] - v[i]
        earliest[i], earlier[i] = earlier[i], change[i]
    for i in range(moved.size):
        v[moved[i]] = run.rates[done + 1, i]


def integrate_steps(
    bodies: Bodies, run: Run, room: Room, q: Vector, v: Vector, exchanged: Vector, turned: Vector
) -> int:
    """Take steps, overwriting q, v and the internal variables; returns how many, fewer if one does not converge.

    exchanged : energy that the damping has taken, that moved supports have given, and work of the loads that depend on
    time or have no potential; added to [J].
    turned : (1,) largest change of a vector that rotates, in one step, as a fraction of its length; raised.
    """
    memory = room.memory
    memory[:] = 0.0
    steps = run.places.shape[0] - 1
    exchanging = bodies.forced or run.varied.shape[0] > 0 or run.damping_time > 0.0
    damped = run.damping_rate > 0.0 or run.modal_rates.size > 0
    fraction = 1 - np.exp(-run.damping_rate * run.h / 2)
    if run.damping_rate > 0.0:
        _uncouple(room.mass_factor, run.constrained)
        _cholesky(room.mass_factor)
    _place(run, room, q)
    before = _started(bodies, room.end, room.gradient, room.factor)
    for done in range(steps):
        if damped:
            _damp(v, run, room, fraction, exchanged)
        _predict(run, room, v, done, memory[_TURNING] != 0.0)
        if not _solve_step(bodies, run, room, q, memory, before, done):
            return done
        if exchanging:
            _exchange(run, room, exchanged)
        _accept(run, room, q, v, exchanged, turned, done)
        if damped:
            _damp(v, run, room, fraction, exchanged)
        _place(run, room, q)
        if bodies.counted.size > 0:
            _commit(bodies, room.end, room.gradient, room.factor)
        before = _started(bodies, room.end, room.gradient, room.factor)
        if not np.isfinite(before):
            return done
    return int(steps)
