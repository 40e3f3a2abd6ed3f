"""All rows of one study, table by table: what an export holds and a store is rebuilt from."""

from typing import TypeAlias

from sqlalchemy import Connection, RowMapping, Select, select

from data.errors import ElbowroomError
from data.store.rows import every, first, insert_all, same
from data.store.store import Store
from data.store.studies import StoredStudy
from data.store.tables import (
    allocations,
    audit,
    comparisons,
    external_runs,
    imports,
    links,
    participants,
    responses,
    sessions,
    stuck_events,
    studies,
    switches,
    trials,
)

Row: TypeAlias = dict[str, object]
Snapshot: TypeAlias = dict[str, list[Row]]
"""Rows by table. The study's number, which differs from store to store, is left out."""

TABLES = (
    studies,
    allocations,
    participants,
    comparisons,
    trials,
    stuck_events,
    responses,
    switches,
    external_runs,
    links,
    sessions,
    imports,
    audit,
)
"""All tables, each after those that it refers to."""


def take_snapshot(store: Store, study: StoredStudy, include_simulated: bool) -> Snapshot:
    """Read all rows of a study at one moment, in an order that depends on nothing else.

    Raises
    ------
    InputError
        If the study has simulated participants only and they are not asked for.
    """
    sources = store.sources(study, include_simulated)
    mine = (participants.c.study == study.id) & participants.c.source.in_(sources)
    people = [participants.c.source, participants.c.number, participants.c.id]
    of_comparison = comparisons.c.position
    trial_order = [*people, of_comparison, trials.c.slot, trials.c.number]
    asked = select(responses).join_from(responses, comparisons).join(participants).where(mine)
    turned = select(switches).join_from(switches, comparisons).join(participants).where(mine)
    run = select(trials).join_from(trials, comparisons).join(participants).where(mine)
    events = (
        select(stuck_events).join_from(stuck_events, trials).join(comparisons).join(participants).where(mine)
    )
    under_way = select(external_runs).join_from(external_runs, comparisons).join(participants).where(mine)
    shown = select(comparisons).join_from(comparisons, participants).where(mine)
    ours = select(participants.c.id).where(mine)
    queries: dict[str, Select[tuple[object, ...]]] = {
        "studies": select(studies).where(studies.c.id == study.id),
        "allocations": select(allocations)
        .where(allocations.c.study == study.id, allocations.c.source.in_(sources))
        .order_by(allocations.c.source),
        "participants": select(participants).where(mine).order_by(*people),
        "comparisons": shown.order_by(*people, of_comparison),
        "trials": run.order_by(*trial_order),
        "stuck_events": events.order_by(*trial_order, stuck_events.c.number),
        "responses": asked.order_by(*people, of_comparison, responses.c.question),
        "switches": turned.order_by(*people, of_comparison, switches.c.number),
        "external_runs": under_way.order_by(*people, of_comparison),
        "links": select(links)
        .where(links.c.study == study.id, links.c.participant.is_(None) | links.c.participant.in_(ours))
        .order_by(links.c.created_at, links.c.token_sha256),
        "sessions": select(sessions)
        .where(
            sessions.c.study == study.id, sessions.c.participant.is_(None) | sessions.c.participant.in_(ours)
        )
        .order_by(sessions.c.created_at, sessions.c.token_sha256),
        "imports": select(imports)
        .where(imports.c.study == study.id)
        .order_by(imports.c.at, imports.c.kind, imports.c.sha256),
        "audit": select(audit).order_by(audit.c.number),
    }
    with store.reading() as connection:
        return {
            name: [_without_study(row) for row in every(connection, query)] for name, query in queries.items()
        }


def restore_snapshot(store: Store, snapshot: Snapshot) -> int:
    """Write all rows of a snapshot that the store lacks, in one transaction; returns how many.

    Raises
    ------
    ElbowroomError
        If the store has another row in the place of one of them: it then stays as it was.
    """
    with store.transaction() as connection:
        study_id = _restore_study(connection, snapshot["studies"][0])
        added = 0
        for table in TABLES[1:]:
            columns = {column.name for column in table.columns}
            belongs = {"study": study_id} if "study" in columns else {}
            keys = list(table.primary_key.columns)
            missing: list[Row] = []
            for given in snapshot[table.name]:
                row = {**given, **belongs}
                query = select(table).where(*(key == row[key.name] for key in keys))
                stored = first(connection, query)
                if stored is None:
                    missing.append(row)
                elif not same(dict(stored), row):
                    named = ", ".join(str(row[key.name]) for key in keys)
                    raise ElbowroomError(
                        f"{store.address.shown}: {table.name} {named} is there with other contents; "
                        "import into a new store"
                    )
            insert_all(connection, table, missing)
            added += len(missing)
        return added


def _restore_study(connection: Connection, row: Row) -> int:
    here = (studies.c.name == row["name"]) & (studies.c.sha256 == row["sha256"])
    stored = first(connection, select(studies).where(here))
    if stored is None:
        taken = (studies.c.name == row["name"]) & (studies.c.revision == row["revision"])
        if first(connection, select(studies).where(taken)) is not None:
            raise ElbowroomError(
                f"the store has another revision {row['revision']} of {row['name']}; import into a new store"
            )
        connection.execute(studies.insert(), row)
        stored = first(connection, select(studies).where(here))
    assert stored is not None
    if row["locked"]:
        connection.execute(studies.update().where(here).values(locked=True))
    return int(stored["id"])


def _without_study(row: RowMapping) -> Row:
    left_out = "id" if "toml" in row else "study"
    return {name: value for name, value in row.items() if name != left_out}
