"""Which comparisons a participant sees, in which order and with which mode as A: pure and seeded."""

from collections import Counter
from dataclasses import dataclass

import numpy as np

from data.study import Study


@dataclass(frozen=True)
class PlannedComparison:
    """One blinded comparison before it is shown.

    Attributes
    ----------
    position : int
        Place in the participant's session, from 1.
    repetition : int
        Which showing of this pair to this participant it is, from 1; 0 for an attention check.
    mode_a, mode_b : str
        Names of the modes shown as A and as B.
    check : bool
        True for a hidden A-against-A attention check, where both are one mode.
    """

    position: int
    repetition: int
    mode_a: str
    mode_b: str
    check: bool = False


def plan_session(study: Study, participant: int) -> tuple[PlannedComparison, ...]:
    """The comparisons of one participant.

    Every pair is shown ``repetitions`` times. Its sides alternate from one repetition to the next,
    and which side comes first alternates between participants, so that each mode stands as A equally
    often: within each participant if the repetitions are even, over two participants if they are odd.
    Which of the two it is, is drawn once per pair and pair of participants; the order is shuffled.

    Parameters
    ----------
    study : Study
    participant : int
        Number of the participant in the study, from 1.

    Returns
    -------
    tuple of PlannedComparison
    """
    block, member = divmod(participant - 1, 2)
    shared = np.random.default_rng([study.seed, 1, block])
    own = np.random.default_rng([study.seed, 2, participant])
    sides: list[tuple[str, str]] = []
    for first, second in study.pairs:
        flip = int(shared.integers(2)) + member
        for repetition in range(study.protocol.repetitions):
            sides.append((first, second) if (flip + repetition) % 2 == 0 else (second, first))
    for _ in range(study.protocol.attention_checks):
        mode = study.mode_names[int(own.integers(len(study.modes)))]
        sides.append((mode, mode))
    planned: list[PlannedComparison] = []
    showings: Counter[frozenset[str]] = Counter()
    for k in own.permutation(len(sides)):
        a, b = sides[k]
        check = a == b
        showings[frozenset((a, b))] += 1
        repetition = 0 if check else showings[frozenset((a, b))]
        planned.append(PlannedComparison(len(planned) + 1, repetition, a, b, check))
    return tuple(planned)
