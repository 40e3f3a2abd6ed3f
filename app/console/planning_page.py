"""Planning: how many participants and repetitions it takes, from what the researcher assumes of people."""

from collections.abc import Mapping
from dataclasses import replace
from itertools import combinations

import streamlit as st

from analysis.power.files import table_csv
from analysis.power.glance import glance
from analysis.power.outcome import Power, PowerPoint
from analysis.power.plan import Plan, mode_pairs
from analysis.power.scenario import LEVELS, tie_share
from analysis.power.sentences import sentences
from app.console.aside_bar import running_bar
from app.console.power_chart import power_chart
from app.console.power_run import PowerRun, power_run
from app.console.style import Mark, card, heading, headline, table
from app.planning import Wish, answers_each, conclusion_of, percent, plan_of
from app.server.desk import Desk
from data.answers import SCALES
from data.errors import InputError
from data.study import Study

_KEPT = "planning-wish"
MOST_STUDIES = 5000
"""Simulated studies of each size that the console takes on; the command line takes more."""
_FOUND = {
    "best": "the best mode",
    "order": "the whole order of the modes",
    "equal": "that all modes are equal in practice",
}


def show(desk: Desk) -> None:
    """What is assumed, what that lets one expect at once, and what came of simulated studies."""
    headline("Planning")
    says = (
        "How many participants and repetitions it takes. Everything here is simulated from what you assume."
    )
    if not desk.store.is_unblinded(desk.stored_study):
        says += " This page names the modes, as the study file does; no answers are read for it."
    st.caption(says)
    run = power_run()
    with card("assumed"):
        heading("What you assume")
        wish = _wish(desk.study, st.session_state.get(_KEPT) or run.wish or _default(desk.study))
        st.session_state[_KEPT] = wish
        try:
            plan = plan_of(desk.study, wish)
        except InputError as error:
            st.error(str(error))
        else:
            _glance(desk.study, plan)
            _start(desk.study, run, wish, plan)
    if run.state != "idle":
        with card("found"):
            _found(run, desk.study.protocol.planned_participants)


def _default(study: Study) -> Wish:
    """The study's own design, written out."""
    plan = plan_of(study, Wish())
    ties = round(tie_share(mode_pairs(study), plan.scenario), 2)
    return Wish(
        worth=_written(plan.scenario.worth),
        participants=_written(plan.participants),
        repetitions=_written(plan.repetitions),
        levels=plan.scenario.levels,
        ties=ties if plan.scenario.levels % 2 else None,
    )


def _wish(study: Study, before: Wish) -> Wish:
    """What the researcher wrote, in the fields."""
    kinds = _conclusions(study)
    # Streamlit forgets fields that are not on the page, so they are filled again on coming back.
    for name, value in (
        ("worth", before.worth),
        ("levels", before.levels or LEVELS),
        ("ties", round(100 * before.ties) if before.ties else 20),
        ("spread", before.subject_sd),
        ("side", before.side_effect),
        ("conclusion", before.conclusion if before.conclusion in kinds else "best"),
        ("confidence", 100 * conclusion_of(study, before.conclusion, before.confidence).confidence),
        ("participants", before.participants),
        ("repetitions", before.repetitions),
        ("replicates", before.replicates),
        ("wanted", round(100 * before.wanted)),
    ):
        st.session_state.setdefault(f"planning-{name}", value)
    first = st.columns([0.5, 0.25, 0.25])
    names = ", ".join(study.mode_names)
    worth = first[0].text_input(f"Worth of {names}, in this order", key="planning-worth")
    levels = first[1].selectbox("Answers to choose from", tuple(SCALES), key="planning-levels")
    ties = first[2].number_input("“About the same” [%]", 1, 90, key="planning-ties", disabled=levels % 2 == 0)
    second = st.columns(4)
    spread = second[0].number_input("People differ, sd [logit]", 0.0, 10.0, step=0.1, key="planning-spread")
    side = second[1].number_input("Pull to side A [logit]", -10.0, 10.0, step=0.1, key="planning-side")
    conclusion = second[2].selectbox(
        "To be found", list(kinds), format_func=kinds.__getitem__, key="planning-conclusion"
    )
    confidence = second[3].number_input(
        "Found if surer than [%]", 50.0, 99.9, step=0.5, format="%.1f", key="planning-confidence"
    )
    third = st.columns(4)
    participants = third[0].text_input("Participants to try", key="planning-participants")
    repetitions = third[1].text_input("Showings of each pair", key="planning-repetitions")
    replicates = third[2].number_input(
        "Studies of each size", 10, MOST_STUDIES, step=50, key="planning-replicates"
    )
    wanted = third[3].number_input("Studies to find it [%]", 1, 99, key="planning-wanted")
    return replace(
        before,
        worth=worth,
        participants=participants,
        repetitions=repetitions,
        levels=levels,
        ties=ties / 100 if levels % 2 else None,
        subject_sd=spread,
        side_effect=side,
        conclusion=conclusion,
        confidence=confidence / 100,
        replicates=replicates,
        wanted=wanted / 100,
    )


def _conclusions(study: Study) -> Mapping[str, str]:
    pairs = tuple(combinations(study.mode_names, 2))
    better = {f"{a}:{b}": f"the better of {a} and {b}" for a, b in pairs}
    return _FOUND | better | {f"{a}={b}": f"that {a} and {b} are equal in practice" for a, b in pairs}


def _glance(study: Study, plan: Plan) -> None:
    """What to expect, at once."""
    planned = study.protocol.planned_participants
    lines = []
    for repetitions in sorted(set(plan.repetitions)):
        expected = glance(plan, repetitions)
        enough = expected.enough
        times = answers_each(plan, repetitions)
        needed = (
            f"about {enough} are needed for {percent(plan.wanted)}"
            if enough is not None
            else f"hardly any number reaches {percent(plan.wanted)}"
        )
        reached = percent(expected.share(planned))
        lines.append(f"With {times}, the planned {planned} find it in about {reached} of studies; {needed}.")
    st.markdown("**At a glance.** " + " ".join(lines))
    said = "Estimated at once, from how much such answers tell."
    followers = plan.scenario.followers
    if followers is not None and plan.scenario.best is not None:
        best, second = study.mode_names[plan.scenario.best], study.mode_names[followers[0]]
        share = percent(followers[1])
        said = f"Such people differ: {share} of them would themselves prefer {best} to {second}. {said}"
    st.caption(said)


def _start(study: Study, run: PowerRun, wish: Wish, plan: Plan) -> None:
    studies = len(plan.sizes) * plan.replicates
    text, button = st.columns([0.74, 0.26], vertical_alignment="center")
    if run.state == "running":
        text.caption("A calculation is under way, below. It can be cancelled there.")
    else:
        text.caption(
            "To be sure, whole studies are simulated, and each is fitted as the report would. That takes "
            "minutes, in a process of its own; you can leave this page."
        )
    if button.button(
        f"Simulate {studies:,} studies", type="primary", disabled=run.state == "running", width="stretch"
    ):
        if not run.start(study, wish):
            st.error("A calculation was begun in another tab; wait for it or cancel it.")
            return
        st.rerun()


def _found(run: PowerRun, planned: int) -> None:
    result = run.result
    note = f"{result.plan.replicates} simulated studies of each size" if result else ""
    heading("What came of it", note)
    if run.state == "running":
        running_bar(run, len(result.points) if result else 0)
    elif run.state == "failed":
        st.html(f"<p>{Mark('bad', f'The calculation failed: {run.trouble}').html}</p>")
    elif run.state == "cancelled":
        st.caption(
            "The calculation was cancelled."
            + (" These sizes were done before." if result is not None else "")
        )
    if result is not None:
        _result(result, planned)


def _result(result: Power, planned: int) -> None:
    for sentence in sentences(result):
        st.markdown(f"**{sentence}**")
    st.altair_chart(power_chart(result), width="stretch")
    several = len(result.repetitions) > 1
    head = ("Participants", *(("Showings",) if several else ()), "Answers", "Right", "Wrong", "Open")
    table(head, [_row(p, planned, several) for p in result.points], numbers=tuple(range(1, len(head))))
    plan = result.plan
    st.caption(
        f"Right: {plan.conclusion.sentence(plan.study.mode_names)}. Assumed: {plan.scenario.sentence}. "
        "Brackets, bars and band: 94 % intervals, from the number of simulated studies. Dotted: wanted."
    )
    st.download_button(
        "Download the table", table_csv(result), file_name=f"{plan.study.name}-power.csv", mime="text/csv"
    )


def _row(point: PowerPoint, planned: int, several: bool) -> tuple[str, ...]:
    mark = " (planned)" if point.participants == planned else ""
    left_open = point.open + point.unranked
    return (
        f"{point.participants}{mark}",
        *((str(point.repetitions),) if several else ()),
        str(point.answers),
        _share(point.right_share, point.right_low, point.right_high),
        _share(point.wrong_share, point.wrong_low, point.wrong_high),
        percent(left_open / point.replicates),
    )


def _share(share: float, low: float, high: float) -> str:
    return f"{100 * share:.0f} % [{100 * low:.0f}, {100 * high:.0f}]"


def _written(numbers: tuple[float, ...] | tuple[int, ...]) -> str:
    return ", ".join(f"{x:g}" for x in numbers)
