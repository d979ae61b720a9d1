"""Reports of campaigns, runs and other people's results: one HTML file that stands on its own, and data files."""

from rosa_evaluation.report.guide import Landmark, Mark, PublishedRow, ReportGuide, adaptations

__all__ = ["Landmark", "Mark", "PublishedRow", "ReportGuide", "adaptations"]
