"""Campaigns: many runs of a scenario under several managing systems, in parallel, into one database.

A campaign is planned (:mod:`~rosa_evaluation.campaign.plan`), carried out by workers on this machine or on a Dask
cluster (:mod:`~rosa_evaluation.campaign.execution`), and written by one writer into ``runs.sqlite``
(:mod:`~rosa_evaluation.campaign.schema`). What is there already is not run again.
"""

from rosa_evaluation.campaign.execution import CampaignObserver, CampaignOutcome, execute_campaign
from rosa_evaluation.campaign.experiment import Experiment
from rosa_evaluation.campaign.local_workers import LocalWorkers
from rosa_evaluation.campaign.plan import CampaignPlan, ManagerSpec, PlannedRun, make_plan, read_managers
from rosa_evaluation.campaign.results import Results, StoredCampaign, StoredRun
from rosa_evaluation.campaign.results_writer import ResultsWriter
from rosa_evaluation.campaign.schema import ResultsError, RunState
from rosa_evaluation.campaign.workers import Workers, WorkersError, WorkersGoneError

__all__ = [
    "CampaignObserver",
    "CampaignOutcome",
    "CampaignPlan",
    "Experiment",
    "LocalWorkers",
    "ManagerSpec",
    "PlannedRun",
    "Results",
    "ResultsError",
    "ResultsWriter",
    "RunState",
    "StoredCampaign",
    "StoredRun",
    "Workers",
    "WorkersError",
    "WorkersGoneError",
    "execute_campaign",
    "make_plan",
    "read_managers",
]
