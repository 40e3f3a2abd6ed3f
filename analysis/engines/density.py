"""Log posterior density and gradient of one question, compiled.

The position x of a sampler is ``[u (K-1), side_effect, log gaps | log_nu, logit lapse, side_drift,
learning (K-1), log subject_sd, log side_sd, log scale_sd, v (S, K-1), s (S), w (S)]``; parts that a model
lacks are left out. ``ability = basis @ u`` with the basis of ``analysis.zero_sum``, and so with learning. How
the participants' deviations stand in ``v`` is said in ``people.py``; pooled, there is one participant without
deviations. The options of ``analysis.model`` add to the leads (``leads.py``) or mix the answers
(``mixture.py``).
"""

import numpy as np
from numpy.typing import NDArray

from analysis.engines.compiled import REGROUPED, compiled
from analysis.engines.leads import add_option_slopes, add_options, add_slopes, set_leads
from analysis.engines.likelihood import adjacent, cumulative
from analysis.engines.mixture import mixed_adjacent, mixed_cumulative
from analysis.engines.people import Form, gather, non_centred, set_own, set_own_slopes, spread
from analysis.model import (
    CUT_GAP_SCALE,
    LAPSE_BETA,
    LEARNING_SD,
    LOG_NU_SD,
    SCALE_SD_SCALE,
    SIDE_DRIFT_SD,
    SIDE_EFFECT_SD,
    SIDE_SD_SCALE,
    SUBJECT_SD_SCALE,
    Problem,
)

HEADER = 12
"""Whole numbers at the start of the packed data: the sizes and switches below, in that order."""
_CELLS, _MODES, _PARTICIPANTS, _LEVELS, _ADJACENT, _HIERARCHICAL, _SIDE, _GAPS = range(8)
_LAPSE, _PERSON_SIDE, _PERSON_SCALE, _POSITION = range(8, HEADER)
N_REALS = 10
"""Scales of the priors, which follow the header: of the abilities and those below, in that order."""
_ABILITY_SD, _SIDE_EFFECT_SD, _GAP, _LOG_NU_SD, _SUBJECT = range(5)
_BETA, _DRIFT, _LEARN, _SIDE_SD, _WIDTH = range(5, N_REALS)

Floats = NDArray[np.float64]


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
        the cut-points). With any option another 4 * cells: the participant of each cell, and bits of float64,
        its order (zeros where the model has no position).
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
        model.lapse,
        model.person_side,
        model.person_scale,
        model.position,
    ]
    scales = [
        model.prior_sd,
        SIDE_EFFECT_SD,
        CUT_GAP_SCALE,
        LOG_NU_SD,
        SUBJECT_SD_SCALE,
        LAPSE_BETA,
        SIDE_DRIFT_SD,
        LEARNING_SD,
        SIDE_SD_SCALE,
        SCALE_SD_SCALE,
    ]
    ascending = counts.responses[:, ::-1].T
    form = form or non_centred(len(counts.participants), len(counts.modes) - 1)
    stand = [form.centring, form.information, form.pull.ravel()]
    reals = np.concatenate([scales, ascending.sum(axis=1), *stand])
    first = counts.participant * len(counts.modes)
    places = np.stack([first + counts.mode_a, first + counts.mode_b]).astype(np.uint32)
    blocks = [
        np.array(header, dtype=np.int64),
        reals.view(np.int64),
        places.ravel().view(np.int64),
        ascending.astype(np.float64).ravel().view(np.int64),
    ]
    if model != model.plain:
        order = np.zeros((len(counts.mode_a), 3)) if counts.order is None else counts.order
        blocks += [counts.participant, np.ascontiguousarray(order.T).ravel().view(np.int64)]
    return np.concatenate(blocks)


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
def _logit_beta(logit: float, beta: float, gradient: Floats, at: int) -> float:
    """Log density of Beta(1, beta) in the logit, Jacobian included, its slope added."""
    value = 1.0 / (1.0 + np.exp(-logit))
    gradient[at] += 1.0 - value - beta * value
    # log(value) + beta log(1 - value), without a difference of near equals.
    return -np.log1p(np.exp(-abs(logit))) * (1.0 + beta) + min(logit, 0.0) - beta * max(logit, 0.0)


@compiled(REGROUPED)
def _standard_normal(v: Floats, gradient: Floats) -> float:
    """Log density of Normal(0, 1) values, their slopes added."""
    squares = 0.0
    for j in range(v.shape[0]):
        squares += v[j] * v[j]
        gradient[j] -= v[j]
    return -0.5 * squares


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
    has_lapse, has_position = data[_LAPSE] == 1, data[_POSITION] == 1
    has_own_side, has_own_scale = data[_PERSON_SIDE] == 1, data[_PERSON_SCALE] == 1
    at_form = HEADER + N_REALS + levels
    at_places = at_form + (n_modes + 1) * n_participants
    at_counts = at_places + n_cells
    at_person = at_counts + levels * n_cells
    scales = data[HEADER : HEADER + N_REALS].view(np.float64)
    totals = data[HEADER + N_REALS : at_form].view(np.float64)
    form = data[at_form:at_places].view(np.float64)
    places = data[at_places:at_counts].view(np.uint32)
    a, b = places[:n_cells], places[n_cells:]
    counts = data[at_counts:at_person].view(np.float64)
    person, order = data[at_person : at_person + n_cells], data[at_person + n_cells :].view(np.float64)
    free = n_modes - 1
    at_shape = free + (1 if has_side else 0)
    at_lapse = at_shape + (1 if is_adjacent else n_gaps)
    at_drift = at_lapse + (1 if has_lapse else 0)
    at_spread = at_drift + (n_modes if has_position else 0)
    at_side_sd = at_spread + 1
    at_scale_sd = at_side_sd + (1 if has_own_side else 0)
    at_own = at_scale_sd + (1 if has_own_scale else 0)
    at_s = at_own + n_participants * free
    at_w = at_s + (n_participants if has_own_side else 0)

    u, v = x[:free], x[at_own:at_s]
    side = x[free] if has_side else 0.0
    common, zero = np.empty(n_modes), np.zeros(n_modes)
    logp = -0.5 * spread(u, zero, 1.0, zero, common) / scales[_ABILITY_SD] ** 2
    own = common
    if is_hierarchical:
        own = np.empty(n_participants * n_modes)
        logp += set_own(v, u, form, n_participants, x[at_spread], common, own)
    eta, d_eta = np.empty(n_cells), np.empty(n_cells)
    set_leads(own, a, b, side, eta)
    learning, own_side = np.zeros(0), np.zeros(0)
    if has_position:
        learning = np.empty(n_modes)
        gains = x[at_drift + 1 : at_spread]
        logp -= 0.5 * spread(gains, zero, 1.0, zero, learning) / scales[_LEARN] ** 2
    if has_own_side:
        own_side = np.exp(x[at_side_sd]) * x[at_s : at_s + n_participants]
    if has_own_side or has_position:
        add_options(eta, a, b, person, order, n_modes, own_side, x[at_drift], learning)

    gradient[free : at_own if is_hierarchical else at_spread] = 0.0
    gradient[at_s:] = 0.0
    is_mixed = has_lapse or has_own_scale
    lapse = 1.0 / (1.0 + np.exp(-x[at_lapse])) if has_lapse else 0.0
    # The log of how wide the scale is: of each participant, or of all.
    width = np.zeros(1)
    if has_own_scale:
        width = np.exp(x[at_scale_sd]) * x[at_w:]
    d_width, d_lapse = np.zeros(width.shape[0]), np.zeros(1)
    if is_adjacent:
        log_nu = x[at_shape]
        d_log_nu = gradient[at_shape : at_shape + 1]
        if is_mixed:
            logp += mixed_adjacent(
                eta, counts, log_nu, lapse, width, person, d_eta, d_log_nu, d_lapse, d_width
            )
        else:
            logp += adjacent(eta, counts, log_nu, d_eta, d_log_nu)
        logp += _normal(log_nu, scales[_LOG_NU_SD], gradient, at_shape)
    else:
        # An even number of levels has a cut-point at 0 between the two halves.
        upper, lower = levels // 2, (levels - 1) // 2 - 1
        theta, d_theta = np.zeros(levels - 1), np.zeros(levels - 1)
        cut = 0.0
        for j in range(n_gaps):
            cut += np.exp(x[at_shape + j])
            theta[upper + j], theta[lower - j] = cut, -cut
            logp += _log_half_normal(x[at_shape + j], scales[_GAP], gradient, at_shape + j)
        if is_mixed:
            logp += mixed_cumulative(
                eta, counts, theta, lapse, width, person, d_eta, d_theta, d_lapse, d_width
            )
        else:
            logp += cumulative(eta, counts, totals, theta, d_eta, d_theta)
        outward = 0.0
        for j in range(n_gaps - 1, -1, -1):
            outward += d_theta[upper + j] - d_theta[lower - j]
            gradient[at_shape + j] += np.exp(x[at_shape + j]) * outward

    d_own = np.zeros(own.shape[0])
    d_side = add_slopes(d_eta, a, b, d_own)
    d_common, d_u = d_own, np.zeros(free)
    if is_hierarchical:
        d_common = np.zeros(n_modes)
        gradient[at_spread] += set_own_slopes(
            d_own, v, u, form, n_participants, x[at_spread], d_common, gradient[at_own:at_s], d_u
        )
        logp += _log_half_normal(x[at_spread], scales[_SUBJECT], gradient, at_spread)
    if has_side:
        gradient[free] += d_side
        logp += _normal(side, scales[_SIDE_EFFECT_SD], gradient, free)
    gather(d_common, 1.0, u, zero, 0.0, 1.0 / scales[_ABILITY_SD] ** 2, gradient[:free])
    gradient[:free] += d_u

    if has_lapse:
        gradient[at_lapse] += d_lapse[0] * lapse * (1.0 - lapse)
        logp += _logit_beta(x[at_lapse], scales[_BETA], gradient, at_lapse)
    if has_own_side or has_position:
        d_own_side, d_learning = np.zeros(own_side.shape[0]), np.zeros(learning.shape[0])
        d_drift = add_option_slopes(d_eta, a, b, person, order, n_modes, d_own_side, d_learning)
        if has_position:
            gradient[at_drift] += d_drift
            logp += _normal(x[at_drift], scales[_DRIFT], gradient, at_drift)
            d_gains = gradient[at_drift + 1 : at_spread]
            gather(d_learning, 1.0, gains, zero, 0.0, 1.0 / scales[_LEARN] ** 2, d_gains)
        if has_own_side:
            logp += _add_own(x, d_own_side, own_side, at_s, at_side_sd, scales[_SIDE_SD], gradient)
    if has_own_scale:
        logp += _add_own(x, d_width, width, at_w, at_scale_sd, scales[_WIDTH], gradient)
    return logp


@compiled(REGROUPED)
def _add_own(
    x: Floats, d_values: Floats, values: Floats, at: int, at_sd: int, scale: float, gradient: Floats
) -> float:
    """Slopes of ``values = sd * x[at:]``, one a participant, and the priors of both."""
    n, sd = values.shape[0], np.exp(x[at_sd])
    for s in range(n):
        gradient[at + s] += sd * d_values[s]
        gradient[at_sd] += values[s] * d_values[s]
    logp = _standard_normal(x[at : at + n], gradient[at : at + n])
    return logp + _log_half_normal(x[at_sd], scale, gradient, at_sd)
