"""The ports of the leaves that are about an action of the knowledge base."""

from __future__ import annotations

from dataclasses import replace

from task_layer.bt.ports.port import InputPort, Port

ACTION_NAME = InputPort("action_name", str, description="the action's name in the knowledge base")
PREFERENCE = InputPort("preference", str, "", "the measure that decides between configurations")


def action_ports(action: str) -> tuple[Port, ...]:
    """The ports of a leaf that performs an action."""
    return replace(ACTION_NAME, default=action), PREFERENCE
