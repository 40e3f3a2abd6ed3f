"""What the console calls the modes: X, Y, Z in an order that tells nothing, until the study is unblinded."""

import string
from collections.abc import Mapping

import numpy as np

from app.server.desk import Desk
from data.study import Study

_LETTERS = "XYZ" + string.ascii_uppercase[string.ascii_uppercase.index("K") : -3]


def coded_labels(study: Study) -> dict[str, str]:
    """A letter for each mode, in the letters' order; which mode has which is drawn from the study's hash."""
    rng = np.random.default_rng(int(study.sha256[:16], 16))
    n = len(study.modes)
    letters = [_LETTERS[k] if k < len(_LETTERS) else f"X{k}" for k in range(n)]
    return {study.mode_names[k]: letter for k, letter in zip(rng.permutation(n), letters, strict=True)}


def shown_labels(desk: Desk) -> Mapping[str, str]:
    """What each mode is called now, in the order of display."""
    if desk.store.is_unblinded(desk.stored_study):
        return {name: name for name in desk.study.mode_names}
    return coded_labels(desk.study)
