"""Log posterior density and gradient of one question, compiled.

The position x of a sampler is ``[u (K-1), side_effect, log gaps | log_nu, log subject_sd, v (S, K-1)]``;
parts that a model lacks are left out. ``ability = basis @ u`` with the basis of ``analysis.zero_sum``. A
participant's own abilities are ``ability + subject_sd z[s]``; pooled, there is one participant without
deviations. Participants stand in the position partly centred, each by a ``c`` of their own from 0 to 1, and
without what a linear approximation knows of them from a pull ``g`` and an information ``h``:
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
from analysis.engines.likelihood import adjacent, cumulative
from analysis.model import CUT_GAP_SCALE, LOG_NU_SD, SIDE_EFFECT_SD, SUBJECT_SD_SCALE, Problem

HEADER = 8
"""Whole numbers at the start of the packed data: the sizes and switches below, in that order."""
_CELLS, _MODES, _PARTICIPANTS, _LEVELS, _ADJACENT, _HIERARCHICAL, _SIDE, _GAPS = range(HEADER)
N_REALS = 5
"""Prior scales that follow the header: abilities, side effect, gaps, log_nu, subject_sd."""

Floats = NDArray[np.float64]
Places = NDArray[np.uint32]


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


def packed(problem: Problem, form: Form | None = None) -> NDArray[np.int64]:
    """Everything the density reads, in one block of memory: what a raw pointer can name.

    Parameters
    ----------
    problem : Problem
    form : Form, optional
        Without it the form is non-centred.

    Returns
    -------
    ndarray of int64, shape (HEADER + N_REALS + levels + (K + 1) * participants + (1 + levels) * cells,)
        Header; bits of float64: prior scales, the total of every answer, ``c``, ``h`` and ``g``; by cell,
        the places of A and B among all participants' abilities (participant * modes + mode), two uint32;
        bits of float64: the counts by level, then by cell. Answers go from B much to A much (the order of
        the cut-points).
    """
    counts, model = problem.counts, problem.model
    header = [
        len(counts.mode_a),
        len(counts.modes),
        len(counts.participants),
        counts.levels,
        model.link == "adjacent",
        model.hierarchical,
        model.side_effect,
        model.n_gaps,
    ]
    scales = [model.prior_sd, SIDE_EFFECT_SD, CUT_GAP_SCALE, LOG_NU_SD, SUBJECT_SD_SCALE]
    ascending = counts.responses[:, ::-1].T
    form = form or non_centred(len(counts.participants), len(counts.modes) - 1)
    stand = [form.centring, form.information, form.pull.ravel()]
    reals = np.concatenate([scales, ascending.sum(axis=1), *stand])
    first = counts.participant * len(counts.modes)
    places = np.stack([first + counts.mode_a, first + counts.mode_b]).astype(np.uint32)
    return np.concatenate(
        [
            np.array(header, dtype=np.int64),
            reals.view(np.int64),
            places.ravel().view(np.int64),
            ascending.astype(np.float64).ravel().view(np.int64),
        ]
    )


@compiled(REGROUPED)
def _spread(v: Floats, centre: Floats, scale: float, base: Floats, out: Floats) -> float:
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
def _gather(
    g: Floats, scale: float, v: Floats, centre: Floats, c: float, weight: float, out: Floats
) -> float:
    """``out = scale * basis.T @ g - weight * y`` with ``y = v - centre`` in O(K), the adjoint of ``_spread``.

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
def _set_own(
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
        squares = _spread(v[s * free : (s + 1) * free], centre, np.exp((1.0 - c) * log_sd), common, here)
        logp -= 0.5 * squares * np.exp(-2.0 * c * log_sd) + free * c * log_sd
    return logp


@compiled(REGROUPED)
def _set_own_slopes(
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
    """The adjoint of ``_set_own``; ``d_u`` is what comes by way of ``v``. Returns the slope in ``log_sd``."""
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
        slope += _gather(here, scale, v[s * free : (s + 1) * free], centre, c, weight, pull) - free * c
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


@compiled(REGROUPED)
def _set_leads(own: Floats, a: Places, b: Places, side: float, eta: Floats) -> None:
    """``eta = own[a] - own[b] + side``, cell by cell."""
    for i in range(eta.shape[0]):
        eta[i] = own[a[i]] - own[b[i]] + side


@compiled(REGROUPED)
def _add_lead_slopes(d_eta: Floats, a: Places, b: Places, d_own: Floats) -> float:
    """The adjoint of ``_set_leads``; returns the slope in ``side``."""
    total = 0.0
    for i in range(d_eta.shape[0]):
        d_own[a[i]] += d_eta[i]
        d_own[b[i]] -= d_eta[i]
        total += d_eta[i]
    return total


@compiled(REGROUPED)
def _normal(x: float, sd: float, gradient: Floats, at: int) -> float:
    """Log density of Normal(0, sd), its slope added."""
    gradient[at] -= x / sd**2
    return -0.5 * (x / sd) ** 2


@compiled(REGROUPED)
def _log_half_normal(log_x: float, sd: float, gradient: Floats, at: int) -> float:
    """Log density of HalfNormal(sd) in the logarithm, Jacobian included, its slope added."""
    square = (np.exp(log_x) / sd) ** 2
    gradient[at] += 1.0 - square
    return log_x - 0.5 * square


@compiled(REGROUPED)
def log_density(x: Floats, gradient: Floats, data: NDArray[np.int64]) -> float:
    """Log posterior density, up to a constant of x, at ``x``; its gradient goes to ``gradient``.

    Parameters
    ----------
    x, gradient : ndarray, shape (n_dim,)
    data : ndarray of int64
        What ``packed`` returns.
    """
    n_cells, n_modes, n_participants = data[_CELLS], data[_MODES], data[_PARTICIPANTS]
    levels, n_gaps = data[_LEVELS], data[_GAPS]
    is_adjacent, is_hierarchical, has_side = data[_ADJACENT] == 1, data[_HIERARCHICAL] == 1, data[_SIDE] == 1
    at_form = HEADER + N_REALS + levels
    at_places = at_form + (n_modes + 1) * n_participants
    at_counts = at_places + n_cells
    scales = data[HEADER : HEADER + N_REALS].view(np.float64)
    totals = data[HEADER + N_REALS : at_form].view(np.float64)
    form = data[at_form:at_places].view(np.float64)
    places = data[at_places:at_counts].view(np.uint32)
    a, b = places[:n_cells], places[n_cells:]
    counts = data[at_counts : at_counts + levels * n_cells].view(np.float64)
    free = n_modes - 1
    at_shape = free + (1 if has_side else 0)
    at_spread = at_shape + (1 if is_adjacent else n_gaps)
    at_own = at_spread + 1

    u, v = x[:free], x[at_own:]
    side = x[free] if has_side else 0.0
    common, zero = np.empty(n_modes), np.zeros(n_modes)
    logp = -0.5 * _spread(u, zero, 1.0, zero, common) / scales[0] ** 2
    own = common
    if is_hierarchical:
        own = np.empty(n_participants * n_modes)
        logp += _set_own(v, u, form, n_participants, x[at_spread], common, own)
    eta, d_eta = np.empty(n_cells), np.empty(n_cells)
    _set_leads(own, a, b, side, eta)

    gradient[free : at_own if is_hierarchical else at_spread] = 0.0
    if is_adjacent:
        log_nu = x[at_shape]
        logp += adjacent(eta, counts, log_nu, d_eta, gradient[at_shape : at_shape + 1])
        logp += _normal(log_nu, scales[3], gradient, at_shape)
    else:
        half = levels // 2
        theta, d_theta = np.zeros(levels - 1), np.zeros(levels - 1)
        cut = 0.0
        for j in range(n_gaps):
            cut += np.exp(x[at_shape + j])
            theta[half + j], theta[half - 1 - j] = cut, -cut
            logp += _log_half_normal(x[at_shape + j], scales[2], gradient, at_shape + j)
        logp += cumulative(eta, counts, totals, theta, d_eta, d_theta)
        outward = 0.0
        for j in range(n_gaps - 1, -1, -1):
            outward += d_theta[half + j] - d_theta[half - 1 - j]
            gradient[at_shape + j] += np.exp(x[at_shape + j]) * outward

    d_own = np.zeros(own.shape[0])
    d_side = _add_lead_slopes(d_eta, a, b, d_own)
    d_common, d_u = d_own, np.zeros(free)
    if is_hierarchical:
        d_common = np.zeros(n_modes)
        gradient[at_spread] += _set_own_slopes(
            d_own, v, u, form, n_participants, x[at_spread], d_common, gradient[at_own:], d_u
        )
        logp += _log_half_normal(x[at_spread], scales[4], gradient, at_spread)
    if has_side:
        gradient[free] += d_side
        logp += _normal(side, scales[1], gradient, free)
    _gather(d_common, 1.0, u, zero, 0.0, 1.0 / scales[0] ** 2, gradient[:free])
    gradient[:free] += d_u
    return logp
