"""Bringing stuck events that were seen elsewhere into a store.

An import happens whole or not at all, and the same file again changes nothing. The file is the stuck CSV
(``data.stuck_csv``).
"""

import math
from collections import Counter
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import get_args

from data.importing import comparison_id, participant_id, remember, was_imported
from data.records import Comparison, Slot, StuckEvent, Trial
from data.store import Store, StoredStudy
from data.stuck_csv import StuckStatement, read_stuck_csv
from data.study import Study


def import_stuck(
    path: Path,
    study: Study,
    toml_text: str,
    store: Store,
    *,
    note: Callable[[str], None] = lambda text: None,
) -> int:
    """Add stuck events that were found elsewhere to comparisons in a store.

    The columns are described in ``data.stuck_csv``. Every comparison that the file speaks of becomes
    two trials, one a mode, of unknown duration and with the source ``external``. Events that an earlier file
    brought are not added again.

    Parameters
    ----------
    note : callable, optional
        Called with each sentence on how the file was read.

    Returns
    -------
    int
        Events that were added: 0 for a file that was imported before.

    Raises
    ------
    InputError
        If the file is wrong, or names comparisons that the store does not have.
    """
    found = read_stuck_csv(path, study)
    for text in found.notes:
        note(text)
    with store.transaction():
        stored = store.add_study(study, toml_text)
        if was_imported(store, stored, "stuck", found.file.sha256):
            return 0
        comparisons = {comparison.id: comparison for comparison in store.comparisons(stored)}
        events: dict[str, _Events] = {}
        if found.is_complete:
            events = {c.id: _Events() for c in comparisons.values() if not c.check}
        for said in found.statements():
            comparison = _comparison_of(store, stored, said, comparisons)
            if comparison is None:
                name = repr(said.comparison[:60])
                raise found.file.error(
                    said.row, "comparison", f"{name} is not in the store: import its responses first"
                )
            if said.mode not in (comparison.mode_a, comparison.mode_b):
                valid = f"{comparison.mode_a}, {comparison.mode_b}"
                raise found.file.error(said.row, "mode", f"{said.mode!r} was not shown; valid: {valid}")
            here = events.setdefault(comparison.id, _Events())
            if said.event is not None:
                (here.under_a if said.mode == comparison.mode_a else here.under_b).append(said.event)
        added = sum(_add_external_trials(store, comparisons[key], here) for key, here in events.items())
        named = sum(len(here.under_a) + len(here.under_b) for here in events.values())
        if named > added:
            note(f"{named - added} of {named} events are in the store already, and are not added again.")
        remember(store, stored, "stuck", found.file.sha256, added)
        return added


@dataclass(frozen=True)
class _Events:
    """What happened in one comparison."""

    under_a: list[StuckEvent] = field(default_factory=list)
    under_b: list[StuckEvent] = field(default_factory=list)


def _comparison_of(
    store: Store, study: StoredStudy, said: StuckStatement, comparisons: Mapping[str, Comparison]
) -> Comparison | None:
    if not said.participant and said.comparison in comparisons:
        return comparisons[said.comparison]
    who = participant_id(store, study, said.participant or "pooled-human")
    return comparisons.get(comparison_id(who, said.comparison))


def _add_external_trials(store: Store, comparison: Comparison, events: _Events) -> int:
    """One trial a mode, unless the store has trials already and nothing is new; gives the events added."""
    earlier = store.trials(comparison=comparison.id)
    slots: tuple[Slot, ...] = get_args(Slot)
    added = 0
    for slot in slots:
        own = [trial for trial in earlier if trial.slot == slot]
        before = Counter(_what(e) for trial in own if trial.source == "external" for e in trial.events)
        new = []
        for event in events.under_a if slot == "A" else events.under_b:
            if before[_what(event)]:
                before[_what(event)] -= 1
            else:
                new.append(event)
        if own and not new:
            continue
        added += len(new)
        number = max((trial.number for trial in own), default=0) + 1
        store.add_trial(
            Trial(
                id=f"{comparison.id}.{slot}{number}",
                comparison=comparison.id,
                slot=slot,
                number=number,
                mode=comparison.mode_of(slot),
                source="external",
                outcome="stuck" if any(event.kind == "stuck" for event in new) else "completed",
                started_at=comparison.started_at or store.clock(),
                duration_s=math.nan,
                seed=0,
                events=tuple(new),
            )
        )
    return added


def _what(event: StuckEvent) -> tuple[str, str, float | None]:
    """What tells an event from another under the same mode in the same comparison."""
    return event.kind, event.definition, None if math.isnan(event.time_s) else event.time_s
