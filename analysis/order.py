"""When each comparison was made: its place among a participant's own, and how often its modes came before.

Places are counted from the order of the rows: a store's rows stand in the order in which comparisons were
shown, and a CSV's comparisons count from where they first appear. Attention checks are not counted.
"""

from dataclasses import replace

import pandas as pd
from pandas.api.types import is_float_dtype

from data.errors import InputError
from data.responses import ResponseTable

ORDER_COLUMNS = ("order: place", "order: A before", "order: B before")
"""Columns of a table's rows that ``with_order`` adds."""


def with_order(table: ResponseTable) -> ResponseTable:
    """The same table with ``ORDER_COLUMNS``, each from -0.5 to 0.5 within a question.

    ``order: place`` is the place of a comparison among the participant's comparisons of that question, from
    -0.5 for the first to 0.5 for the last of whoever made most. The others say how often the participant had
    the mode that stands as A, and as B, in earlier comparisons of that question, scaled alike by the most
    frequent. A table that has the columns already is returned as it is, so that parts of a table keep the
    places of the whole.

    Raises
    ------
    InputError
        If rows stand for several answers, whose order is not known.
    """
    if all(name in table.rows and is_float_dtype(table.rows[name]) for name in ORDER_COLUMNS):
        return table
    rows = table.rows
    asked = rows.index[~rows["check"].astype(bool)]
    counted = rows.loc[asked]
    several = int((counted["count"] > 1).sum())
    if several:
        raise InputError(
            f"position: the order of answers is not known where rows stand for several (count): {several} do"
        )
    label = counted["comparison"].where(counted["comparison"] != "", counted.index.map("row {}".format))
    key = ["question", "participant"]
    frame = counted[[*key, "mode_a", "mode_b"]].assign(label=label, repetition=counted["repetition"])
    number = frame.groupby([*key, "label", "repetition"], sort=False).ngroup()
    first = frame.assign(number=number).drop_duplicates("number").set_index("number")
    place = first.groupby(key, sort=False).cumcount()
    sides = [first.rename(columns={side: "mode"})[[*key, "mode"]] for side in ("mode_a", "mode_b")]
    both = pd.concat([side.assign(side=k) for k, side in enumerate(sides)]).sort_index(kind="stable")
    before = both.assign(before=both.groupby([*key, "mode"], sort=False).cumcount())
    columns = [place, *(before.loc[before["side"] == k, "before"] for k in (0, 1))]
    question = first["question"]
    longest = place.groupby(question).max()
    most = before["before"].groupby(before["question"]).max()
    ordered = rows.copy()
    for name, values, largest in zip(ORDER_COLUMNS, columns, (longest, most, most), strict=True):
        top = question.map(largest)
        scaled = (values / top.where(top > 0, 1) - 0.5).where(top > 0, 0.0)
        ordered[name] = number.map(scaled).reindex(rows.index).astype(float)
    return replace(table, rows=ordered)
