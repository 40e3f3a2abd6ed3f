"""The three methods on the planar arm, iteration by iteration: thesis, sections 3.2.1, 3.2.2 and 4.1."""

from dataclasses import dataclass

import numpy as np

from sim_trials.reproductions.mulumbwa.arms import planar_jacobian, planar_position
from sim_trials.reproductions.solvers import (
    damped_least_squares,
    pseudo_inverse,
    selectively_damped,
    singular_value_filtering,
)

JP, DLS, SVF_SDLS = "JP", "DLS", "SVF+SDLS"
METHODS = (JP, DLS, SVF_SDLS)
DAMPING = 1e-3
"""lambda of the DLS: the thesis says "in the range of" this (section 2.4.3)."""
GAMMA_MAX = np.pi / 4
"""Largest joint step of the SDLS [rad]; the thesis gives none, this is the method's source's."""
INTERVALS = 100
"""N: not printed; table 3 counts up to 100."""
NORMS = (1e-2, 1e-3, 1e-5, 1e-7)
PUBLISHED_ITERATIONS = {JP: (89, 97, 98, 98), DLS: (88, 98, 99, 100), SVF_SDLS: (7, 9, 9, 10)}
"""Table 3."""


@dataclass(frozen=True)
class Iterations:
    """One solve, one row per iteration from the start on.

    Attributes
    ----------
    q : ndarray, shape (n + 1, 3)
        Joint angles [rad].
    error : ndarray, shape (n + 1,)
        Norm of the task error [m].
    sigma : ndarray, shape (n + 1, 2)
        Singular values of the arm's own Jacobian, largest first [m].
    """

    q: np.ndarray
    error: np.ndarray
    sigma: np.ndarray

    def needed(self, norm: float) -> int | None:
        """Iterations until the error is within ``norm``; None if it never is."""
        within = np.flatnonzero(self.error <= norm)
        return int(within[0]) if within.size else None

    @property
    def largest_step(self) -> float:
        """Largest turn of a joint in one iteration [rad]."""
        return float(np.abs(np.diff(self.q, axis=0)).max())

    @property
    def reversals(self) -> int:
        """How often a joint turns back by more than 0.01 rad a step."""
        steps = np.diff(self.q, axis=0)
        steps = np.where(np.abs(steps) < 0.01, 0.0, steps)
        return int((steps[1:] * steps[:-1] < 0).sum())


def solve(
    method: str,
    target: tuple[float, ...],
    start: np.ndarray,
    *,
    is_scheduled: bool,
    gamma_max: float = GAMMA_MAX,
    n: int = INTERVALS,
) -> Iterations:
    """Run one method for ``n`` iterations.

    Parameters
    ----------
    is_scheduled : bool
        Whether JP and DLS take the share 1 / (N + 1 - k) of the error in iteration k, steps 4 to 6 of
        section 3.2.1, or all of it. SVF+SDLS takes all of it (section 3.2.2).
    """
    q = np.array(start, float)
    qs, errors, sigmas = [q], [], []
    for k in range(1, n + 2):
        e = np.array(target) - planar_position(q)
        J = planar_jacobian(q)
        errors.append(float(np.linalg.norm(e)))
        sigmas.append(np.linalg.svd(J, compute_uv=False))
        if k == n + 1:
            break
        share = 1.0 / (n + 1 - k) if is_scheduled else 1.0
        if method == JP:
            q = q + pseudo_inverse.step(J, share * e)
        elif method == DLS:
            q = q + damped_least_squares.step(J, share * e, DAMPING)
        else:
            q = q + selectively_damped.step(singular_value_filtering.filtered(J), e, gamma_max)
        qs.append(q)
    return Iterations(np.array(qs), np.array(errors), np.array(sigmas))


def condition_number(method: str, sigma: np.ndarray) -> float:
    """The condition number the thesis plots for a method: eqs. (16), (26), (32)."""
    if method == JP:
        return float(sigma[0] / sigma[-1]) if sigma[-1] > 0 else float("inf")
    if method == DLS:
        return damped_least_squares.condition_number(sigma, DAMPING)
    return singular_value_filtering.condition_number(sigma)


def manipulability(method: str, sigma: np.ndarray) -> float:
    """Product of the singular values, eq. (15), of the matrix the method inverts; filtered for SVF+SDLS."""
    values = singular_value_filtering.lifted(sigma) if method == SVF_SDLS else sigma
    return float(np.prod(values))
