"""Reports of campaigns, runs and other people's results: one HTML file that stands on its own, and data files."""

from rosa_evaluation.report.spec import Landmark, Mark, PublishedRow, ReportSpec, adaptations

__all__ = ["Landmark", "Mark", "PublishedRow", "ReportSpec", "adaptations"]
