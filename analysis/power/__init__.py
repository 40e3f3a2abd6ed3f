"""How many participants and repetitions a study needs, before anybody is invited."""

from analysis.power.answers import draw_answers
from analysis.power.curve import Curve, Enough, fitted_curve
from analysis.power.experiment import power
from analysis.power.files import POWER_TABLE, write_power
from analysis.power.glance import Glance, glance
from analysis.power.outcome import Power, PowerPoint
from analysis.power.plan import Plan, check_plan
from analysis.power.scenario import Conclusion, Scenario, cuts_for_ties, tie_share
from analysis.power.sentences import sentences, showings

__all__ = [
    "POWER_TABLE",
    "Conclusion",
    "Curve",
    "Enough",
    "Glance",
    "Plan",
    "Power",
    "PowerPoint",
    "Scenario",
    "check_plan",
    "cuts_for_ties",
    "draw_answers",
    "fitted_curve",
    "glance",
    "power",
    "sentences",
    "showings",
    "tie_share",
    "write_power",
]
