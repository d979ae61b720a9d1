"""Computations: what runs in a unit. A Python callable, or an object with state."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Protocol, TypeAlias, runtime_checkable

from rosa_core.errors import Problem, nearest
from rosa_streams.environment import ParameterValue, Sample, Transformation, Unit
from rosa_streams.errors import StreamError

Emission: TypeAlias = Mapping[str, Any] | Iterable[Mapping[str, Any]] | None
"""What a computation gives: nothing, values by output port, or several such mappings one after the other."""


@runtime_checkable
class Computation(Protocol):
    """What runs in a unit.

    Optional parts: a source has ``period`` (seconds) and ``produce(now)``; ``max_silence`` (seconds) limits how long it
    may be called without giving anything; ``close()`` is called when the unit is unloaded.
    """

    def receive(self, port: str, sample: Sample) -> Emission:
        """Take a sample from an input port. Called for one sample at a time."""
        ...


Factory: TypeAlias = Callable[[Mapping[str, ParameterValue]], Any]
"""Makes a computation from its parameters."""


class Function:
    """A function as a computation (definition 2): ``f(x1, ..., xn)``, or with state ``f(x1, ..., xn, state)``.

    Args:
        function: takes the latest value of each input port in order and gives the value of the only output port, a
            mapping from output ports to values, or None for nothing. With a state it takes that last, and gives the
            pair of what it gives and the new state.
        inputs, outputs: names of ports.
        when: ``any`` calls it at every sample once each input has had one; ``all`` when each input has a new one.
        state: the first state; with it, the function takes and gives a state.
        period: of a source, in seconds; then ``function`` takes the time.
        max_silence: in seconds; a unit that is called and gives nothing for so long is lost.
    """

    def __init__(
        self,
        function: Callable[..., Any],
        inputs: Sequence[str] = (),
        outputs: Sequence[str] = ("out",),
        *,
        when: str = "any",
        state: Any = None,
        stateful: bool = False,
        period: float | None = None,
        max_silence: float | None = None,
    ) -> None:
        if when not in {"any", "all"}:
            raise StreamError(f"a function is called on 'any' or 'all' inputs, not on '{when}'")
        self._function = function
        self._inputs, self._outputs = tuple(inputs), tuple(outputs)
        self._single = len(self._outputs) == 1
        self._only = self._outputs[0] if self._single else ""
        self._when_all = when == "all"
        self._latest: dict[str, Any] = {}
        self._new: set[str] = set()
        self._stateful = stateful or state is not None
        self._simple = len(self._inputs) == 1 and self._single and not self._stateful
        self.state = state
        if period is not None:
            self.period = period
        if max_silence is not None:
            self.max_silence = max_silence

    def receive(self, port: str, sample: Sample) -> Emission:
        """See :class:`Computation`."""
        if self._simple:
            value = self._function(sample.value)
            return None if value is None else {self._only: value}
        self._latest[port] = sample.value
        if self._when_all:
            self._new.add(port)
            if len(self._new) < len(self._inputs):
                return None
            self._new.clear()
        elif len(self._latest) < len(self._inputs):
            return None
        return self._call(*(self._latest[name] for name in self._inputs))

    def produce(self, now: float) -> Emission:
        """See :class:`Computation`."""
        return self._call(now)

    def _call(self, *values: Any) -> Emission:
        if not self._stateful:
            return self._emission(self._function(*values))
        given, self.state = self._function(*values, self.state)
        return self._emission(given)

    def _emission(self, given: Any) -> Emission:
        if given is None or not self._single:
            return given  # type: ignore[no-any-return]
        return {self._only: given}


@dataclass(frozen=True, slots=True)
class _Known:
    factory: Factory | None
    function: Callable[..., Any] | None
    options: Mapping[str, Any]


class Sources:
    """Implementations by the name that specifications call ``source``.

    Only what is registered here is ever run: a specification from outside names code, it does not bring any.

    >>> sources = Sources()
    >>> sources.function("filters/Double", lambda value: 2 * value)
    >>> @sources.factory("filters/Offset")
    ... def offset(parameters):
    ...     return Function(lambda value: value + parameters["by"], ["in"], ["out"])
    """

    def __init__(self) -> None:
        self._known: dict[str, _Known] = {}

    def function(self, source: str, function: Callable[..., Any], **options: Any) -> None:
        """Register a function; its ports are those of the transformation, in order.

        Args:
            source: the name.
            function: see :class:`Function`.
            options: ``when``, ``state``, ``stateful``, ``period``, ``max_silence`` of :class:`Function`.
        """
        self._known[source] = _Known(None, function, options)

    def factory(self, source: str) -> Callable[[Factory], Factory]:
        """Register what makes a computation from the parameters; a decorator."""

        def register(factory: Factory) -> Factory:
            self._known[source] = _Known(factory, None, {})
            return factory

        return register

    def make(self, unit: Unit, transformation: Transformation) -> Computation:
        """The computation of a unit.

        Raises:
            StreamError: if the source is not registered, or gives no computation. What a factory raises passes through.
        """
        known = self._known.get(transformation.source)
        if known is None:
            hint = nearest(transformation.source, self._known) or "register it with Sources.function or Sources.factory"
            raise StreamError(Problem(f"no implementation '{transformation.source}' is registered", hint=hint))
        if known.function is not None:
            inputs = [port.name for port in transformation.inputs]
            outputs = [port.name for port in transformation.outputs]
            return Function(known.function, inputs, outputs, **dict(known.options))
        parameters = {**dict(transformation.parameters), **dict(unit.parameters), **dict(unit.state)}
        computation = known.factory(parameters) if known.factory is not None else None
        if not isinstance(computation, Computation):
            raise StreamError(f"'{transformation.source}' gives no computation with a method receive(port, sample)")
        return computation
