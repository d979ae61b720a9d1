"""What every fuzz test holds a reader to: a result or one readable error, in bounded work.

Each test is a property over ``INPUTS`` inputs: 150, or as many as the environment variable ROSA_FUZZ_INPUTS says.
"""

from __future__ import annotations

import itertools
import os
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager, nullcontext
from typing import Any

from hypothesis import HealthCheck, Phase, given, settings
from hypothesis import strategies as st

from rosa_core.errors import LONGEST_TOKEN, MOST_LINES, InputError, RosaError
from tests.fuzz.mutations import Change

INPUTS = int(os.environ.get("ROSA_FUZZ_INPUTS", "150"))
MOST_CALLS = 3_000_000
"""Calls of Python functions that reading one input may take; an input has some kilobytes."""

_LONGEST_MESSAGE = MOST_LINES * 2100

_COUNTED = 8
"""Counting makes Python slow: it is done for one input of so many. Of the others it is seen if they never end."""
_INPUT = itertools.count()


class TooMuchWorkError(BaseException):
    """Reading one input does not come to an end; no handler of errors may catch it."""


@contextmanager
def bounded_work() -> Iterator[None]:
    """Count the calls in the block, and stop it when there are too many."""
    calls = 0

    def count(_frame: Any, event: str, _argument: Any) -> None:
        nonlocal calls
        if event == "call":
            calls += 1
            if calls > MOST_CALLS:
                raise TooMuchWorkError(f"more than {MOST_CALLS} calls")

    sys.setprofile(count)
    try:
        yield
    finally:
        sys.setprofile(None)


def result_or_refusal(read: Callable[[], object], refusal: type[RosaError] = InputError) -> object:
    """What the reader returns; None if it refuses the input, with an error that people can read.

    Args:
        read: reads the input.
        refusal: the only error that it may raise.
    """
    try:
        with bounded_work() if next(_INPUT) % _COUNTED == 0 else nullcontext():
            return read()
    except refusal as error:
        message = str(error)
        assert message.strip()
        assert len(message) <= _LONGEST_MESSAGE
        assert message.count("\n") <= MOST_LINES
        assert max(map(len, message.split())) <= LONGEST_TOKEN
        return None


def fuzzed(test: Callable[..., None]) -> Callable[..., None]:
    """A test of a function with an argument ``changes``, over lists of changes to a good input."""
    profile = settings(
        max_examples=INPUTS,
        deadline=None,
        derandomize=True,
        database=None,
        phases=(Phase.generate, Phase.shrink),
        suppress_health_check=list(HealthCheck),
    )
    number = st.integers(0, 2**16 - 1)
    change = st.builds(Change, number, number, number)
    decorated: Callable[..., None] = profile(given(changes=st.lists(change, min_size=1, max_size=6))(test))
    return decorated
