"""The first schema of the store."""

import sqlalchemy as sa
from alembic import op

revision = "0001"
down_revision = None
branch_labels = None
depends_on = None


def upgrade() -> None:
    op.create_table(
        "audit",
        sa.Column("number", sa.Integer(), autoincrement=False, nullable=False),
        sa.Column("at", sa.DateTime(timezone=True), nullable=False),
        sa.Column("actor", sa.Text(), nullable=False),
        sa.Column("action", sa.Text(), nullable=False),
        sa.Column("detail", sa.JSON(), nullable=False),
        sa.Column("sha256", sa.String(length=64), nullable=False),
        sa.PrimaryKeyConstraint("number", name="pk_audit"),
    )
    op.create_table(
        "studies",
        sa.Column("id", sa.Integer(), nullable=False),
        sa.Column("name", sa.String(length=40), nullable=False),
        sa.Column("revision", sa.Integer(), nullable=False),
        sa.Column("version", sa.Text(), nullable=False),
        sa.Column("sha256", sa.String(length=64), nullable=False),
        sa.Column("toml", sa.Text(), nullable=False),
        sa.Column("locked", sa.Boolean(), nullable=False),
        sa.PrimaryKeyConstraint("id", name="pk_studies"),
        sa.UniqueConstraint("name", "revision", name="uq_studies_name_revision"),
        sa.UniqueConstraint("name", "sha256", name="uq_studies_name_sha256"),
    )
    op.create_table(
        "allocations",
        sa.Column("study", sa.Integer(), nullable=False),
        sa.Column("source", sa.String(length=20), nullable=False),
        sa.Column("last_number", sa.Integer(), nullable=False),
        sa.ForeignKeyConstraint(["study"], ["studies.id"], name="fk_allocations_study"),
        sa.PrimaryKeyConstraint("study", "source", name="pk_allocations"),
    )
    op.create_table(
        "imports",
        sa.Column("study", sa.Integer(), nullable=False),
        sa.Column("kind", sa.String(length=20), nullable=False),
        sa.Column("sha256", sa.String(length=64), nullable=False),
        sa.Column("at", sa.DateTime(timezone=True), nullable=False),
        sa.Column("rows", sa.Integer(), nullable=False),
        sa.ForeignKeyConstraint(["study"], ["studies.id"], name="fk_imports_study"),
        sa.PrimaryKeyConstraint("study", "kind", "sha256", name="pk_imports"),
    )
    op.create_table(
        "participants",
        sa.Column("id", sa.String(length=120), nullable=False),
        sa.Column("study", sa.Integer(), nullable=False),
        sa.Column("number", sa.Integer(), nullable=False),
        sa.Column("source", sa.String(length=20), nullable=False),
        sa.Column("joined_at", sa.DateTime(timezone=True), nullable=False),
        sa.Column("background", sa.JSON(), nullable=False),
        sa.Column("consent_version", sa.Text(), nullable=True),
        sa.Column("consented_at", sa.DateTime(timezone=True), nullable=True),
        sa.Column("finished_at", sa.DateTime(timezone=True), nullable=True),
        sa.Column("pooled", sa.Boolean(), nullable=False),
        sa.CheckConstraint("source IN ('human', 'simulated')", name="valid_source"),
        sa.ForeignKeyConstraint(["study"], ["studies.id"], name="fk_participants_study"),
        sa.PrimaryKeyConstraint("id", name="pk_participants"),
    )
    op.create_index(
        "uq_participants_human_number",
        "participants",
        ["study", "number"],
        unique=True,
        sqlite_where=sa.text("source = 'human'"),
        postgresql_where=sa.text("source = 'human'"),
    )
    op.create_table(
        "comparisons",
        sa.Column("id", sa.String(length=120), nullable=False),
        sa.Column("participant", sa.String(length=120), nullable=False),
        sa.Column("position", sa.Integer(), nullable=False),
        sa.Column("repetition", sa.Integer(), nullable=False),
        sa.Column("mode_a", sa.String(length=40), nullable=False),
        sa.Column("mode_b", sa.String(length=40), nullable=False),
        sa.Column("check", sa.Boolean(), nullable=False),
        sa.Column("started_at", sa.DateTime(timezone=True), nullable=True),
        sa.Column("answered_at", sa.DateTime(timezone=True), nullable=True),
        sa.ForeignKeyConstraint(["participant"], ["participants.id"], name="fk_comparisons_participant"),
        sa.PrimaryKeyConstraint("id", name="pk_comparisons"),
        sa.UniqueConstraint("participant", "position", name="uq_comparisons_participant_position"),
    )
    op.create_table(
        "links",
        sa.Column("token_sha256", sa.String(length=64), nullable=False),
        sa.Column("study", sa.Integer(), nullable=False),
        sa.Column("kind", sa.String(length=20), nullable=False),
        sa.Column("label", sa.Text(), nullable=False),
        sa.Column("created_at", sa.DateTime(timezone=True), nullable=False),
        sa.Column("expires_at", sa.DateTime(timezone=True), nullable=True),
        sa.Column("used_at", sa.DateTime(timezone=True), nullable=True),
        sa.Column("participant", sa.String(length=120), nullable=True),
        sa.CheckConstraint("kind IN ('participant', 'personal', 'researcher')", name="valid_kind"),
        sa.ForeignKeyConstraint(["participant"], ["participants.id"], name="fk_links_participant"),
        sa.ForeignKeyConstraint(["study"], ["studies.id"], name="fk_links_study"),
        sa.PrimaryKeyConstraint("token_sha256", name="pk_links"),
    )
    op.create_table(
        "sessions",
        sa.Column("token_sha256", sa.String(length=64), nullable=False),
        sa.Column("study", sa.Integer(), nullable=False),
        sa.Column("participant", sa.String(length=120), nullable=True),
        sa.Column("created_at", sa.DateTime(timezone=True), nullable=False),
        sa.ForeignKeyConstraint(["participant"], ["participants.id"], name="fk_sessions_participant"),
        sa.ForeignKeyConstraint(["study"], ["studies.id"], name="fk_sessions_study"),
        sa.PrimaryKeyConstraint("token_sha256", name="pk_sessions"),
    )
    op.create_table(
        "responses",
        sa.Column("comparison", sa.String(length=120), nullable=False),
        sa.Column("question", sa.String(length=40), nullable=False),
        sa.Column("answer", sa.String(length=20), nullable=False),
        sa.Column("answered_at", sa.DateTime(timezone=True), nullable=False),
        sa.CheckConstraint("answer IN ('A>>B', 'A>B', 'A=B', 'B>A', 'B>>A')", name="valid_answer"),
        sa.ForeignKeyConstraint(["comparison"], ["comparisons.id"], name="fk_responses_comparison"),
        sa.PrimaryKeyConstraint("comparison", "question", name="pk_responses"),
    )
    op.create_table(
        "switches",
        sa.Column("comparison", sa.String(length=120), nullable=False),
        sa.Column("number", sa.Integer(), nullable=False),
        sa.Column("slot", sa.String(length=20), nullable=False),
        sa.Column("at", sa.DateTime(timezone=True), nullable=False),
        sa.CheckConstraint("slot IN ('A', 'B')", name="valid_slot"),
        sa.ForeignKeyConstraint(["comparison"], ["comparisons.id"], name="fk_switches_comparison"),
        sa.PrimaryKeyConstraint("comparison", "number", name="pk_switches"),
    )
    op.create_table(
        "trials",
        sa.Column("id", sa.String(length=120), nullable=False),
        sa.Column("comparison", sa.String(length=120), nullable=False),
        sa.Column("slot", sa.String(length=20), nullable=False),
        sa.Column("number", sa.Integer(), nullable=False),
        sa.Column("mode", sa.String(length=40), nullable=False),
        sa.Column("source", sa.String(length=20), nullable=False),
        sa.Column("outcome", sa.String(length=20), nullable=False),
        sa.Column("started_at", sa.DateTime(timezone=True), nullable=False),
        sa.Column("duration_s", sa.Double(), nullable=True),
        sa.Column("seed", sa.BigInteger(), nullable=False),
        sa.Column("metrics", sa.JSON(), nullable=False),
        sa.Column("recording", sa.Text(), nullable=True),
        sa.Column("recording_sha256", sa.String(length=64), nullable=True),
        sa.CheckConstraint("outcome IN ('completed', 'stuck', 'abandoned', 'failed')", name="valid_outcome"),
        sa.CheckConstraint("slot IN ('A', 'B')", name="valid_slot"),
        sa.CheckConstraint("source IN ('observed', 'simulated', 'external')", name="valid_source"),
        sa.ForeignKeyConstraint(["comparison"], ["comparisons.id"], name="fk_trials_comparison"),
        sa.PrimaryKeyConstraint("id", name="pk_trials"),
        sa.UniqueConstraint("comparison", "slot", "number", name="uq_trials_comparison_slot_number"),
    )
    op.create_table(
        "stuck_events",
        sa.Column("trial", sa.String(length=120), nullable=False),
        sa.Column("number", sa.Integer(), nullable=False),
        sa.Column("kind", sa.String(length=20), nullable=False),
        sa.Column("time_s", sa.Double(), nullable=True),
        sa.Column("sigma_min", sa.Double(), nullable=True),
        sa.Column("phase", sa.Text(), nullable=False),
        sa.Column("definition", sa.Text(), nullable=False),
        sa.CheckConstraint("kind IN ('stuck', 'elbow_inversion', 'protective_stop')", name="valid_kind"),
        sa.ForeignKeyConstraint(["trial"], ["trials.id"], name="fk_stuck_events_trial"),
        sa.PrimaryKeyConstraint("trial", "number", name="pk_stuck_events"),
    )

    _seal_the_audit_log()


def _seal_the_audit_log() -> None:
    """Let the database itself refuse any change of what was once written."""
    dialect = op.get_bind().dialect.name
    for event in ("UPDATE", "DELETE"):
        name = f"audit_no_{event.lower()}"
        if dialect == "sqlite":
            refusal = "BEGIN SELECT RAISE(ABORT, 'append-only'); END"
            op.execute(f"CREATE TRIGGER {name} BEFORE {event} ON audit {refusal}")
        else:
            refusal = "BEGIN RAISE EXCEPTION 'append-only'; END"
            op.execute(f"CREATE FUNCTION {name}() RETURNS trigger LANGUAGE plpgsql AS $$ {refusal} $$")
            op.execute(f"CREATE TRIGGER {name} BEFORE {event} ON audit EXECUTE FUNCTION {name}()")
