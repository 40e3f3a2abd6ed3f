"""Attention checks that show one mode as A and as B: who noticed that there is no difference."""

from dataclasses import dataclass

from data.responses import ResponseTable

SAME = "A=B"


@dataclass(frozen=True)
class CheckShare:
    """One participant's answers to comparisons of a mode with itself.

    Attributes
    ----------
    participant : str
        "" if answers name none.
    answers, same : int
        Answers on scales that can say "about the same", and those that said so.
    """

    participant: str
    answers: int
    same: int

    @property
    def share(self) -> float:
        """Share of answers that said "about the same"."""
        return self.same / self.answers


def check_shares(table: ResponseTable) -> tuple[CheckShare, ...]:
    """Every participant with such answers, in the order of the table.

    A question with an even number of levels has no middle: all its answers are wrong, so it is left out.
    """
    rows = table.rows
    even = [question.name for question in table.questions if question.levels % 2 == 0]
    is_one_mode = rows["check"].astype(bool) & (rows["mode_a"] == rows["mode_b"])
    asked = rows[is_one_mode & ~rows["question"].isin(even)]
    said = asked.assign(same=asked["count"].where(asked["response"] == SAME, 0))
    sums = said.groupby("participant", sort=False)[["count", "same"]].sum()
    return tuple(
        CheckShare(str(who), int(answers), int(same))
        for who, answers, same in sums.itertuples(index=True, name=None)
    )
