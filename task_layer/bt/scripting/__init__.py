"""The scripting language of BehaviorTree.CPP v4: parsed with a grammar, compiled once, run on a blackboard."""

from task_layer.bt.scripting.bound import BoundCondition, BoundScript
from task_layer.bt.scripting.parser import Script, compile_script
from task_layer.bt.scripting.scope import Scope, ScriptError

__all__ = ["BoundCondition", "BoundScript", "Scope", "Script", "ScriptError", "compile_script"]
