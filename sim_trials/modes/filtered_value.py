"""The filter on singular values that two methods share: it keeps the smallest one away from zero."""

from sim_trials.compiled import compiled


@compiled("float64(float64, float64, float64)")
def filtered_value(sigma: float, sigma0: float, nu: float) -> float:
    """Mulumbwa, eq. (30): h = (s^3 + nu s^2 + 2 s + 2 sigma0) / (s^2 + nu s + 2), as s + a remainder.

    h(0) = sigma0, h never falls below s, and h - s dies away as s grows.

    Parameters
    ----------
    sigma : float
        A singular value, s.
    sigma0 : float
        What stands for a singular value of zero.
    nu : float
        Shape: the larger, the sooner h - s dies away.
    """
    return sigma + 2.0 * sigma0 / (sigma * sigma + nu * sigma + 2.0)
