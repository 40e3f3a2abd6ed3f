"""The report folder: one page, its figures, and the numbers as CSV, JSON and NetCDF."""

from analysis.report.write import MARKER, ReportResult, write_report

__all__ = ["MARKER", "ReportResult", "write_report"]
