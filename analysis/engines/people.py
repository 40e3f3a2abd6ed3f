"""How the participants stand in a sampler's position, and their own abilities, compiled.

A participant's own abilities are ``ability + subject_sd z[s]``. Participants stand in the position partly
centred, each by a ``c`` of their own from 0 to 1, and without what a linear approximation knows of them from
a pull ``g`` and an information ``h``:
``subject_sd z[s] = subject_sd^(1-c) basis @ (v[s] - c u + tau g)``, ``v[s] ~ N(c u - tau g, subject_sd^c)``,
with ``tau = subject_sd^(1+c) / (1 + subject_sd^2 h)``. If g is zero, ``c = 0`` is the non-centred form,
``z[s] = basis @ v[s]``, and with ``c = 1`` v is their own ability.

References
----------
Papaspiliopoulos, Roberts, Skoeld 2007, "A general framework for the parametrization of hierarchical models",
Statistical Science 22 (partly centred forms).
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from analysis.engines.compiled import REGROUPED, compiled

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class Form:
    """How the participants stand in the position; see `form.py` for what makes a good one.

    Attributes
    ----------
    centring : ndarray, shape (participant,)
        ``c``, from 0 to 1.
    pull : ndarray, shape (participant, K-1)
        ``g``, the slope of a participant's log-likelihood in their deviation, without one.
    information : ndarray, shape (participant,)
        ``h``, how fast that slope falls along itself.
    """

    centring: Floats
    pull: Floats
    information: Floats


def non_centred(n_participants: int, n_own: int) -> Form:
    """Everybody as a deviation from the group."""
    return Form(np.zeros(n_participants), np.zeros((n_participants, n_own)), np.zeros(n_participants))


@compiled(REGROUPED)
def spread(v: Floats, centre: Floats, scale: float, base: Floats, out: Floats) -> float:
    """``out = base + scale * basis @ y`` with ``y = v - centre`` in O(K); returns ``y @ y``."""
    n = out.shape[0]
    total, squares = 0.0, 0.0
    for j in range(n - 1):
        y = v[j] - centre[j]
        total += y
        squares += y * y
    root = np.sqrt(n)
    shift = total / (root + n)
    for j in range(n - 1):
        out[j] = base[j] + scale * (v[j] - centre[j] - shift)
    out[n - 1] = base[n - 1] - scale * total / root
    return squares


@compiled(REGROUPED)
def gather(g: Floats, scale: float, v: Floats, centre: Floats, c: float, weight: float, out: Floats) -> float:
    """``out = scale * basis.T @ g - weight * y`` with ``y = v - centre`` in O(K), the adjoint of ``spread``.

    Returns ``(1 - c) scale * y @ basis.T @ g + c weight * y @ y``.
    """
    n = g.shape[0]
    total = 0.0
    for j in range(n - 1):
        total += g[j]
    root = np.sqrt(n)
    shift = total / (root + n) + g[n - 1] / root
    along, squares = 0.0, 0.0
    for j in range(n - 1):
        y = v[j] - centre[j]
        pull = scale * (g[j] - shift)
        along += y * pull
        squares += y * y
        out[j] = pull - weight * y
    return (1.0 - c) * along + c * weight * squares


@compiled(REGROUPED)
def _lean(c: float, information: float, log_sd: float) -> tuple[float, float]:
    """``tau``, and its slope in ``log_sd``."""
    sd = np.exp(log_sd)
    t = information * sd * sd
    tau = np.exp((1.0 + c) * log_sd) / (1.0 + t)
    return tau, tau * (1.0 + c - 2.0 * t / (1.0 + t))


@compiled(REGROUPED)
def _set_centre(c: float, u: Floats, tau: float, g: Floats, centre: Floats) -> None:
    """Where a participant's ``v`` is expected."""
    for j in range(centre.shape[0]):
        centre[j] = c * u[j] - tau * g[j]


@compiled(REGROUPED)
def set_own(
    v: Floats, u: Floats, form: Floats, n_participants: int, log_sd: float, common: Floats, own: Floats
) -> float:
    """Every participant's abilities, ``common + subject_sd z[s]``; returns the log prior of ``v``."""
    n_modes = common.shape[0]
    free = n_modes - 1
    centre = np.empty(free)
    logp = 0.0
    for s in range(n_participants):
        c = form[s]
        tau, _ = _lean(c, form[n_participants + s], log_sd)
        g = form[2 * n_participants + s * free : 2 * n_participants + (s + 1) * free]
        _set_centre(c, u, tau, g, centre)
        here = own[s * n_modes : (s + 1) * n_modes]
        squares = spread(v[s * free : (s + 1) * free], centre, np.exp((1.0 - c) * log_sd), common, here)
        logp -= 0.5 * squares * np.exp(-2.0 * c * log_sd) + free * c * log_sd
    return logp


@compiled(REGROUPED)
def set_own_slopes(
    d_own: Floats,
    v: Floats,
    u: Floats,
    form: Floats,
    n_participants: int,
    log_sd: float,
    d_common: Floats,
    d_v: Floats,
    d_u: Floats,
) -> float:
    """The adjoint of ``set_own``; ``d_u`` is what comes by way of ``v``. Returns the slope in ``log_sd``."""
    n_modes = d_common.shape[0]
    free = n_modes - 1
    centre = np.empty(free)
    slope = 0.0
    for s in range(n_participants):
        c = form[s]
        tau, d_tau = _lean(c, form[n_participants + s], log_sd)
        g = form[2 * n_participants + s * free : 2 * n_participants + (s + 1) * free]
        _set_centre(c, u, tau, g, centre)
        here, pull = d_own[s * n_modes : (s + 1) * n_modes], d_v[s * free : (s + 1) * free]
        scale, weight = np.exp((1.0 - c) * log_sd), np.exp(-2.0 * c * log_sd)
        slope += gather(here, scale, v[s * free : (s + 1) * free], centre, c, weight, pull) - free * c
        for j in range(n_modes):
            d_common[j] += here[j]
        along = 0.0
        for j in range(free):
            along += g[j] * pull[j]
        slope += d_tau * along
        if c > 0.0:
            for j in range(free):
                d_u[j] -= c * pull[j]
    return slope
