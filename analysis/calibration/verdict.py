"""What a calibration says, in sentences: loud where the engine is miscalibrated, frank where it is blind."""

from analysis.calibration.outcome import Calibration
from analysis.calibration.uniformity import FALSE_ALARM, Coverage, Uniformity

FEW_REPLICATES = 1000
"""Below this a pass is called no more than that no fault was found. Untuned."""


def verdict(result: Calibration) -> str:
    """The conclusion in a sentence or two."""
    n_coverages, n_ecdfs = len(result.coverages), len(result.uniformities)
    chance = f"{100 * FALSE_ALARM:g} %"
    if result.is_calibrated:
        said = "Calibrated" if len(result.replicates) >= FEW_REPLICATES else "No fault found"
        return (
            f"{said}: all {n_coverages} coverages and all {n_ecdfs} ECDFs lie inside bands that a "
            f"calibrated engine leaves anywhere with a chance of at most {chance}."
        )
    wrong = [check for check in result.outside if isinstance(check, Coverage)]
    bent = [check for check in result.outside if isinstance(check, Uniformity)]
    found = "; ".join(sentence for _, sentence in sorted(_faults(result).items()))
    return (
        f"MISCALIBRATED: {len(wrong)} of {n_coverages} coverages and {len(bent)} of {n_ecdfs} ECDFs lie "
        f"outside bands that a calibrated engine leaves anywhere with a chance of at most {chance}: {found}."
    )


def notes(result: Calibration) -> tuple[str, ...]:
    """What a reader of the verdict must know, a sentence each."""
    said = []
    if result.failures:
        counted = result.outside_with_failures
        said.append(
            f"{result.failures} of {len(result.replicates)} replicates did not converge and are left out, as "
            "a report would not rank them; the gate never sees a true value, so those that are left are a "
            f"fair sample. With them, {counted} checks fail instead of {len(result.outside)}."
        )
    else:
        said.append(f"All {len(result.replicates)} replicates converged.")
    if len(result.replicates) < FEW_REPLICATES:
        low, high = next((c.band_low, c.band_high) for c in result.coverages if c.level == 0.9)
        said.append(
            f"{len(result.converged)} replicates show only gross faults: 90 % intervals that hold the truth "
            f"in {100 * low:.0f} to {100 * high:.0f} % of cases would pass."
        )
    return tuple(said)


def _faults(result: Calibration) -> dict[str, str]:
    """What is wrong with each quantity that fails a check."""
    faults = {}
    for shape in result.uniformities:
        failed = [c for c in result.coverages if c.parameter == shape.parameter and not c.inside]
        if shape.inside and not failed:
            continue
        said = []
        if failed:
            worst = max(failed, key=lambda c: abs(c.coverage - c.level))
            how = "narrow" if worst.coverage < worst.level else "wide"
            said.append(f"intervals too {how}, {100 * worst.level:.0f} % hold {100 * worst.coverage:.0f} %")
        if not shape.inside:
            where = "low" if shape.mean_rank > 0.5 else "high"
            said.append(f"ECDF off by {shape.largest_difference:+.3f}, draws rather too {where}")
        faults[shape.parameter] = f"{shape.parameter} ({', '.join(said)})"
    return faults
