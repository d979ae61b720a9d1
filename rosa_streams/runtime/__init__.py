"""The computational environment: computations in units, connected by channels; streams synchronised to states."""

from rosa_streams.runtime.computation import Computation, Function, Sources
from rosa_streams.runtime.host import Host
from rosa_streams.runtime.instance import LostUnit
from rosa_streams.runtime.synchronisation import Synchroniser, TimedState

__all__ = ["Computation", "Function", "Host", "LostUnit", "Sources", "Synchroniser", "TimedState"]
