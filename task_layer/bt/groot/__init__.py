"""Groot2: its live protocol and its logs, as BehaviorTree.CPP v4 has them."""

from task_layer.bt.groot.btlog import BtLog, BtLogWriter, Transition, read_btlog
from task_layer.bt.groot.publisher import DEFAULT_PORT, GrootPublisher
from task_layer.bt.groot.transition import StatusCode

__all__ = ["DEFAULT_PORT", "BtLog", "BtLogWriter", "GrootPublisher", "StatusCode", "Transition", "read_btlog"]
