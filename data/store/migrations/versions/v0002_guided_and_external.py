"""People guide the robot themselves, or a robot in the lab: what a session of theirs adds."""

import sqlalchemy as sa
from alembic import op

from data.study_file import with_trial_source

revision = "0002"
down_revision = "0001"
branch_labels = None
depends_on = None

_UTC = sa.DateTime(timezone=True)


def upgrade() -> None:
    for name in ("background_at", "practised_at", "withdrawn_at"):
        op.add_column("participants", sa.Column(name, _UTC, nullable=True))
    # As a constraint of the column, which SQLite can add.
    op.execute(
        "ALTER TABLE participants ADD COLUMN device VARCHAR(20)"
        " CONSTRAINT valid_device CHECK (device IN ('mouse', 'keyboard', 'touch', 'gamepad'))"
    )
    op.add_column("comparisons", sa.Column("restarted_at", _UTC, nullable=True))
    op.create_table(
        "external_runs",
        sa.Column("comparison", sa.String(length=120), nullable=False),
        sa.Column("wanted", sa.String(length=20), nullable=False),
        sa.Column("loaded", sa.String(length=20), nullable=True),
        sa.Column("started_at", _UTC, nullable=True),
        sa.CheckConstraint("wanted IN ('A', 'B')", name="valid_wanted"),
        sa.CheckConstraint("loaded IN ('A', 'B')", name="valid_loaded"),
        sa.ForeignKeyConstraint(["comparison"], ["comparisons.id"], name="fk_external_runs_comparison"),
        sa.PrimaryKeyConstraint("comparison", name="pk_external_runs"),
    )
    _let_trials_be_guided()
    _say_what_studies_meant()


def _say_what_studies_meant() -> None:
    """Laps could only be observed before, and a study that didn't say so must not become a guided one."""
    studies = sa.table("studies", sa.column("id", sa.Integer), sa.column("toml", sa.Text))
    for number, text in op.get_bind().execute(sa.select(studies.c.id, studies.c.toml)).all():
        said = sa.update(studies).where(studies.c.id == number).values(toml=with_trial_source(text))
        op.execute(said)


def _let_trials_be_guided() -> None:
    source = "source IN ('observed', 'simulated', 'external', 'guided')"
    if op.get_bind().dialect.name != "sqlite":
        op.drop_constraint("valid_source", "trials", type_="check")
        op.create_check_constraint("valid_source", "trials", source)
        return
    # SQLite changes a check only by making the table anew; the events that refer to it step aside meanwhile.
    op.execute("CREATE TEMPORARY TABLE kept_events AS SELECT * FROM stuck_events")
    op.execute("DELETE FROM stuck_events")
    trials = sa.Table(
        "trials",
        sa.MetaData(),
        sa.Column("id", sa.String(length=120), nullable=False),
        sa.Column("comparison", sa.String(length=120), nullable=False),
        sa.Column("slot", sa.String(length=20), nullable=False),
        sa.Column("number", sa.Integer(), nullable=False),
        sa.Column("mode", sa.String(length=40), nullable=False),
        sa.Column("source", sa.String(length=20), nullable=False),
        sa.Column("outcome", sa.String(length=20), nullable=False),
        sa.Column("started_at", _UTC, nullable=False),
        sa.Column("duration_s", sa.Double(), nullable=True),
        sa.Column("seed", sa.BigInteger(), nullable=False),
        sa.Column("metrics", sa.JSON(), nullable=False),
        sa.Column("recording", sa.Text(), nullable=True),
        sa.Column("recording_sha256", sa.String(length=64), nullable=True),
        sa.CheckConstraint("outcome IN ('completed', 'stuck', 'abandoned', 'failed')", name="valid_outcome"),
        sa.CheckConstraint("slot IN ('A', 'B')", name="valid_slot"),
        sa.CheckConstraint(source, name="valid_source"),
        sa.ForeignKeyConstraint(["comparison"], ["comparisons.id"], name="fk_trials_comparison"),
        sa.PrimaryKeyConstraint("id", name="pk_trials"),
        sa.UniqueConstraint("comparison", "slot", "number", name="uq_trials_comparison_slot_number"),
    )
    with op.batch_alter_table("trials", copy_from=trials, recreate="always"):
        pass
    op.execute("INSERT INTO stuck_events SELECT * FROM kept_events")
    op.execute("DROP TABLE kept_events")
