"""Curves of a mode against sigma: closed forms, and that every damping is found again."""

import numpy as np

from data.study import Mode
from sim_trials.mode_atlas import mode_curves
from sim_trials.modes.registry import resolve


def curves_of(method: str, **parameters: float):  # type: ignore[no-untyped-def]
    return mode_curves(resolve(Mode(name="X", method=method, parameters=parameters)))


def test_the_damping_of_constant_damping_is_found_again() -> None:
    curves = curves_of("constant_dls", **{"lambda": 0.3})
    for curve in (curves.towards, curves.away):
        np.testing.assert_allclose(curve.damping, 0.3, rtol=1e-6)
        np.testing.assert_allclose(curve.gain, curves.sigma**2 / (curves.sigma**2 + 0.09), rtol=1e-6)


def test_scheduled_damping_follows_its_schedule() -> None:
    curves = curves_of("dls", lambda0=0.6)
    share = np.clip(1 - curves.sigma / 0.25, 0, None)
    near = share > 0.02
    np.testing.assert_allclose(curves.towards.damping[near], 0.6 * share[near] ** 2, rtol=1e-5)


def test_m3_is_damped_as_m2_towards_and_as_m1_away() -> None:
    m3, m1, m2 = curves_of("asymmetric_dls"), curves_of("dls"), curves_of("dls", lambda0=0.6)
    np.testing.assert_array_equal(m3.towards.gain, m2.towards.gain)
    np.testing.assert_array_equal(m3.away.gain, m1.away.gain)


def test_blended_m3_lies_between_m2_and_m1() -> None:
    blended, m1, m2 = curves_of("blended_asymmetric_dls"), curves_of("dls"), curves_of("dls", lambda0=0.6)
    near = blended.sigma < 0.2
    for curve in (blended.towards, blended.away):
        assert (curve.gain[near] >= m2.towards.gain[near]).all()
        assert (curve.gain[near] <= m1.away.gain[near]).all()
    assert (blended.towards.gain[near] < blended.away.gain[near]).all()


def test_poses_lead_into_the_lock() -> None:
    curves = curves_of("transpose")
    assert curves.sigma[0] > 0.3
    assert curves.sigma[-1] < 0.002
    assert (np.diff(curves.sigma[curves.sigma < 0.25]) < 0).all()
    assert curves.cost_ns > 0
