"""Simulation-based calibration: are the report's probabilities as good as they say?"""

from analysis.calibration.experiment import calibrate, check_replicates, world_of
from analysis.calibration.files import CALIBRATION_FILES, SUMMARY, write_calibration
from analysis.calibration.outcome import Calibration
from analysis.calibration.verdict import notes, verdict
from analysis.calibration.world import Design

__all__ = [
    "CALIBRATION_FILES",
    "SUMMARY",
    "Calibration",
    "Design",
    "calibrate",
    "check_replicates",
    "notes",
    "verdict",
    "world_of",
    "write_calibration",
]
