"""How people who answer in a line were found, for the methods of a paper."""

from analysis.straight_lining import BY_CHANCE, FASTEST_S, SHORTEST_RUN, StraightLining


def methods_of_lines(found: StraightLining | None) -> str:
    """What was done about people who answer in a line; empty if there are none."""
    if found is None or not found.lines:
        return ""
    fast = (
        f", nor answers in a median of less than {FASTEST_S:g} second a question (Wood et al. 2017)"
        if any(line.kind == "fast" for line in found.lines)
        else ""
    )
    return (
        "Participants whose answers all stand on one side as shown, though no order of the modes explains "
        "that, are all the strongest or all “about the same”, or repeat one answer to a question at least "
        f"{SHORTEST_RUN} times running (Johnson 2005), were pointed out where the chance that any of as many "
        f"new participants does so is at most {BY_CHANCE:g} under the fitted model{fast}. The model was "
        "fitted again without them."
    )
