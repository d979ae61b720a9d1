"""Groot2's live protocol and log files, compatible with BehaviorTree.CPP v4."""

from task_layer.bt.groot.btlog import BtLog, BtLogWriter, Transition, read_btlog
from task_layer.bt.groot.publisher import DEFAULT_PORT, GrootPublisher
from task_layer.bt.groot.transition import StatusCode

__all__ = ["DEFAULT_PORT", "BtLog", "BtLogWriter", "GrootPublisher", "StatusCode", "Transition", "read_btlog"]
