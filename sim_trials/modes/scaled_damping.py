"""Chiaverini's schedule of a damping, which two methods share."""

from sim_trials.compiled import compiled


@compiled("float64(float64, float64, float64)")
def squared_damping(sigma: float, most: float, sigma_t: float) -> float:
    """most^2 (1 - (sigma / sigma_t)^2) below the threshold, zero from there on.

    Parameters
    ----------
    sigma : float
        Smallest singular value of the Jacobian (SI units).
    most : float
        Damping at the singularity, not squared.
    sigma_t : float
        Threshold on sigma, positive.

    References
    ----------
    Chiaverini, Siciliano, Egeland 1994, "Review of the damped least-squares inverse kinematics with
    experiments on an industrial robot manipulator", IEEE Trans. Control Systems Technology 2.
    """
    if sigma >= sigma_t:
        return 0.0
    share = sigma / sigma_t
    return most * most * (1.0 - share * share)
