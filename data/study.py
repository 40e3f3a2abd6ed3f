"""What a study is: its modes, questions, protocol and task, validated."""

import hashlib
import json
from typing import Annotated, Literal, Self

from pydantic import BaseModel, ConfigDict, Field, StringConstraints, model_validator

from data.answers import SCALES, Answer

Name = Annotated[str, StringConstraints(pattern=r"^[A-Za-z][A-Za-z0-9_.-]{0,39}$")]
Text = Annotated[str, StringConstraints(min_length=1, strip_whitespace=True)]
Polarity = Literal["higher_is_better", "lower_is_better", "neutral"]


class Part(BaseModel):
    """A part of the study file: immutable, and a key it does not know is an error."""

    model_config = ConfigDict(frozen=True, extra="forbid", allow_inf_nan=False)


class Consent(Part):
    """The text a participant agrees to; its version is stored with every session."""

    version: Text
    text: Text


class BackgroundQuestion(Part):
    """One short question about the participant, asked once after consent.

    ``choice`` offers ``choices``; ``number`` takes one from ``lowest`` to ``highest``; ``text`` takes up to
    200 characters.
    """

    name: Name
    wording: Text
    kind: Literal["choice", "number", "text"] = "choice"
    choices: tuple[Text, ...] = ()
    lowest: float = 0.0
    highest: float = 120.0
    required: bool = False

    @model_validator(mode="after")
    def _can_be_answered(self) -> Self:
        if self.kind == "choice" and len(self.choices) < 2:
            raise ValueError("choices: at least two are needed for the kind 'choice'")
        if self.kind != "choice" and self.choices:
            raise ValueError(f"choices: not for the kind {self.kind!r}")
        if len(set(self.choices)) < len(self.choices):
            raise ValueError("choices: one is given twice")
        if self.lowest >= self.highest:
            raise ValueError("lowest must be smaller than highest")
        return self


class Mode(Part):
    """One controller under comparison.

    ``method`` names an entry of the mode registry (``sim_trials.modes``), which also
    validates ``parameters``; ``name`` is what the report calls it. No participant sees either.
    A study with a robot of its own (`Protocol.trial_source` ``external``) needs no method.
    """

    name: Name
    method: Name = "external"
    description: str = ""
    parameters: dict[str, float] = Field(default_factory=dict)


class Question(Part):
    """One question asked after each comparison.

    ``polarity`` says whether the mode that ranks first is thereby good: "most force" is not.
    ``rehearsal`` weighs trial metrics for simulated participants alone; people never meet it.
    """

    name: Name
    wording: Text
    short: Text
    emphasis: str = ""
    levels: Literal[2, 3, 5]
    polarity: Polarity = "higher_is_better"
    answers: tuple[Text, ...] = ()
    rehearsal: dict[str, float] = Field(default_factory=dict)

    @model_validator(mode="after")
    def _answers_fit_the_scale(self) -> Self:
        if self.answers and len(self.answers) != self.levels:
            raise ValueError(f"answers: {len(self.answers)} labels for a scale of {self.levels} levels")
        twice = sorted({label for label in self.answers if self.answers.count(label) > 1})
        if twice:
            raise ValueError(f"answers: the label {twice[0]!r} is given twice")
        if self.emphasis and self.emphasis not in self.wording:
            raise ValueError(f"emphasis: {self.emphasis!r} does not occur in the wording")
        return self

    @property
    def scale(self) -> tuple[Answer, ...]:
        """The answers of this question, in the order A much .. B much."""
        return SCALES[self.levels]

    @property
    def labels(self) -> tuple[str, ...]:
        """What a participant reads for each answer of ``scale``."""
        return self.answers or DEFAULT_LABELS[self.levels]


DEFAULT_LABELS: dict[int, tuple[str, ...]] = {
    2: ("Method A", "Method B"),
    3: ("Method A", "About the same", "Method B"),
    5: ("Much more A", "More A", "About the same", "More B", "Much more B"),
}


class Practice(Part):
    """Laps before the first comparison, to get used to the robot.

    On a narrower rectangle, where the arm doesn't have to stretch: there, damping methods have nothing to do,
    and practice favours none of them.
    """

    laps: int = Field(1, ge=0, le=10)
    right_y_m: float = Field(-0.50, ge=-1.5, le=1.0)
    mode: Name | None = None


class Protocol(Part):
    """How comparisons are put to a participant.

    ``trial_source`` says who moves which robot: ``guided`` by the participant in the browser, ``observed``
    laps of a simulated operator, or ``external``, a robot in the lab that an operator tends.
    ``returning`` says what happens to an open comparison when a participant comes back to it, and
    ``returning_within_h`` for how long after joining they may [h], 0 for ever. ``finish_url`` is where a
    participant is sent at the end; ``{code}`` in it becomes the completion code.
    """

    trial_source: Literal["guided", "observed", "external"] = "guided"
    pairs: Literal["all"] | tuple[tuple[Name, Name], ...] = "all"
    repetitions: int = Field(2, ge=1, le=50)
    laps_per_condition: int = Field(3, ge=1, le=20)
    minimum_exposure_s: float = Field(20.0, ge=0, le=3600)
    attention_checks: int = Field(0, ge=0, le=20)
    planned_participants: int = Field(7, ge=1, le=100_000)
    break_every: int = Field(3, ge=0, le=100)
    returning: Literal["resume", "restart_comparison"] = "resume"
    returning_within_h: float = Field(0.0, ge=0, le=8760)
    finish_url: Annotated[str, StringConstraints(pattern=r"^(https?://\S+)?$")] = ""


class Maze(Part):
    """The rectangle on the wall, in the robot's base frame [m]; y grows to the left, z up."""

    wall_x_m: float = Field(1.30, gt=0.5, lt=2.0)
    left_y_m: float = Field(0.35, ge=-1.0, le=1.0)
    right_y_m: float = Field(-1.045, ge=-1.5, le=1.0)
    top_z_m: float = Field(0.45, ge=0.0, le=1.2)
    bottom_z_m: float = Field(0.05, ge=-0.3, le=1.0)
    corner_tolerance_m: float = Field(0.03, gt=0, le=0.2)
    standoff_m: float = Field(0.30, gt=0.05, le=0.6)

    @model_validator(mode="after")
    def _is_a_rectangle(self) -> Self:
        if self.right_y_m >= self.left_y_m - 2 * self.corner_tolerance_m:
            raise ValueError("right_y_m must be smaller than left_y_m: y grows to the left")
        if self.bottom_z_m >= self.top_z_m - 2 * self.corner_tolerance_m:
            raise ValueError("bottom_z_m must be smaller than top_z_m: z grows upwards")
        return self


class Feedback(Part):
    """What the wall shows the participant: cursor by tilt [deg], path by speed [m/s]."""

    tilt_green_below_deg: float = Field(8.0, gt=0, le=90)
    tilt_red_from_deg: float = Field(16.0, gt=0, le=90)
    tilt_full_ellipse_deg: float = Field(26.0, gt=0, le=90)
    path_solid_up_to_m_s: float = Field(0.15, gt=0, le=2)
    path_faint_from_m_s: float = Field(0.30, gt=0, le=4)

    @model_validator(mode="after")
    def _is_ordered(self) -> Self:
        if not self.tilt_green_below_deg < self.tilt_red_from_deg < self.tilt_full_ellipse_deg:
            raise ValueError("tilt_green_below_deg < tilt_red_from_deg < tilt_full_ellipse_deg must hold")
        if self.path_solid_up_to_m_s >= self.path_faint_from_m_s:
            raise ValueError("path_solid_up_to_m_s must be smaller than path_faint_from_m_s")
        return self


class Stuck(Part):
    """When the robot counts as stuck: sigma_min below a threshold for longer than a dwell time."""

    definition: Literal["sigma-dwell/1"] = "sigma-dwell/1"
    sigma_below: float = Field(0.005, gt=0, lt=0.3)
    dwell_s: float = Field(5.0, gt=0, le=60)


class Controller(Part):
    """The admittance loop around the mode (Carmichael, Aldini, Liu 2017, Figure 3).

    The paper gives no gains. These were chosen on the simulated UR10 and are untuned
    for any real robot.
    """

    translation_gain_m_s_n: float = Field(0.01, gt=0, le=0.1)
    rotation_gain_rad_s_nm: float = Field(0.25, gt=0, le=5)
    wrench_filter_hz: float = Field(10.0, gt=0, le=60)
    extra_damping_n_s_m: float = Field(2.0, ge=0, le=50)
    extra_damping_nm_s_rad: float = Field(0.02, ge=0, le=5)
    joint_acceleration_rad_s2: float = Field(8.0, gt=0, le=100)
    actuator_lag_s: float = Field(0.02, gt=0, le=0.2)


_LATER_KEYS = (
    ("", "background"),
    ("", "practice"),
    ("protocol", "break_every"),
    ("protocol", "returning"),
    ("protocol", "returning_within_h"),
    ("protocol", "finish_url"),
)
"""Keys younger than the first stores: at their defaults they aren't part of a study's hash, so that a study
stored before them, and recordings that name its hash, stay what they were."""


class Study(Part):
    """A whole study, as its file defines it."""

    format: Literal[1] = 1
    name: Name
    version: Text = "1"
    title: Text
    description: str = ""
    seed: int = Field(2017, ge=0, lt=2**63)
    consent: Consent
    background: tuple[BackgroundQuestion, ...] = ()
    modes: tuple[Mode, ...] = Field(min_length=2)
    questions: tuple[Question, ...] = Field(min_length=1)
    protocol: Protocol = Protocol()
    practice: Practice = Practice()
    maze: Maze = Maze()
    feedback: Feedback = Feedback()
    stuck: Stuck = Stuck()
    controller: Controller = Controller()

    @model_validator(mode="after")
    def _names_are_consistent(self) -> Self:
        named = {
            "modes": self.mode_names,
            "questions": [question.name for question in self.questions],
            "background": [question.name for question in self.background],
        }
        for what, names in named.items():
            twice = sorted({name for name in names if list(names).count(name) > 1})
            if twice:
                raise ValueError(f"{what}: the name {twice[0]!r} is given twice")
        if not self.pairs:
            raise ValueError("protocol.pairs: empty; give at least one pair, or 'all'")
        for pair in self.pairs:
            for name in pair:
                if name not in self.mode_names:
                    raise ValueError(f"protocol.pairs: {name!r} is not one of: {', '.join(self.mode_names)}")
            if pair[0] == pair[1]:
                raise ValueError(f"protocol.pairs: {pair[0]!r} is paired with itself")
        if len({frozenset(pair) for pair in self.pairs}) < len(self.pairs):
            raise ValueError("protocol.pairs: a pair is given twice")
        if self.practice.mode is not None and self.practice.mode not in self.mode_names:
            raise ValueError(
                f"practice.mode: {self.practice.mode!r} is not one of: {', '.join(self.mode_names)}"
            )
        left = self.maze.left_y_m - 2 * self.maze.corner_tolerance_m
        if self.has_practice and self.practice.right_y_m >= left:
            raise ValueError("practice.right_y_m must be smaller than maze.left_y_m: y grows to the left")
        return self

    @property
    def mode_names(self) -> tuple[str, ...]:
        """The modes' names, in the order of the study file."""
        return tuple(mode.name for mode in self.modes)

    @property
    def pairs(self) -> tuple[tuple[str, str], ...]:
        """The unordered pairs of modes that are compared."""
        if self.protocol.pairs == "all":
            names = self.mode_names
            return tuple((a, b) for i, a in enumerate(names) for b in names[i + 1 :])
        return self.protocol.pairs

    @property
    def has_practice(self) -> bool:
        """Whether participants practise first: only those who guide the robot do."""
        return self.protocol.trial_source == "guided" and self.practice.laps > 0

    @property
    def practice_mode(self) -> str:
        """The mode that is practised with."""
        return self.practice.mode or self.mode_names[0]

    @property
    def practice_study(self) -> Self:
        """This study with the rectangle that is practised on, never wider than the maze."""
        right = max(self.practice.right_y_m, self.maze.right_y_m)
        return self.model_copy(update={"maze": self.maze.model_copy(update={"right_y_m": right})})

    @property
    def sha256(self) -> str:
        """Hash of the study's meaning: comments and layout of the file do not change it."""
        content = self.model_dump(mode="json")
        for part, key in _LATER_KEYS:
            owner: Part = getattr(self, part) if part else self
            if getattr(owner, key) == type(owner).model_fields[key].get_default():
                del (content[part] if part else content)[key]
        canonical = json.dumps(content, sort_keys=True, separators=(",", ":"))
        return hashlib.sha256(canonical.encode()).hexdigest()
