"""Atoms over whole columns of values at once, through numpy."""

from __future__ import annotations

import operator
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from rosa_streams.errors import StreamError
from rosa_streams.temporal.formula import TICKS_PER_SECOND, Atom, Comparison, Formula, Holds, Number, Variable, atoms

_OPERATORS = {
    "<": operator.lt, "<=": operator.le, ">": operator.gt, ">=": operator.ge, "==": operator.eq, "!=": operator.ne,
}  # fmt: skip
_LARGEST = 2**62


def valuations(
    formula: Formula, times: Sequence[float], columns: Mapping[str, Sequence[Any]], codes: int, now: int | None
) -> list[int] | None:
    """For each state, the ticks since the state before and the values of the atoms, in one number.

    Args:
        formula: whose atoms are evaluated.
        times: in seconds.
        columns: values by variable.
        codes: how many combinations of values there are.
        now: the ticks of the state before the first, if there is one.

    Returns:
        None if the columns are not numbers, or the atoms not comparisons with numbers: then state by state.

    Raises:
        StreamError: if times do not grow.
    """
    moments = np.asarray(times, dtype=float)
    if not np.isfinite(moments).all():
        raise StreamError("a time is a finite number of seconds")
    ticks = np.rint(moments * TICKS_PER_SECOND).astype(np.int64)
    elapsed = np.diff(ticks, prepend=ticks[0] if now is None else now)
    late = np.flatnonzero(elapsed[(now is None) :] <= 0)
    if late.size:
        index = int(late[0]) + (now is None)
        raise StreamError(f"times grow: {moments[index]:.9g} s does not come after the time before it")
    if codes > _LARGEST or int(elapsed.max()) > _LARGEST // codes:
        return None
    code = np.zeros(len(moments), dtype=np.int64)
    for number, atom in enumerate(atoms(formula)):
        values = _values(atom, columns, len(moments))
        if values is None:
            return None
        code += values * 3**number
    return (elapsed * codes + code).tolist()  # type: ignore[no-any-return]


def _values(atom: Atom, columns: Mapping[str, Sequence[Any]], count: int) -> Any:
    """0 false, 1 true, 2 unknown, for each state; None if the atom or its column is not about numbers."""
    if isinstance(atom, Comparison) and isinstance(atom.left, Variable) and isinstance(atom.right, Number):
        name = atom.left.name
    elif isinstance(atom, Holds):
        name = atom.variable.name
    else:
        return None
    if name not in columns:
        return np.full(count, 2, dtype=np.int64)
    column = np.asarray(columns[name])
    if column.dtype.kind not in "biuf":
        return None
    if isinstance(atom, Comparison) and isinstance(atom.right, Number):
        true = _OPERATORS[atom.operator](column, atom.right.value)
    else:
        true = column.astype(bool)
    unknown = np.isnan(column) if column.dtype.kind == "f" else np.zeros(count, dtype=bool)
    return np.where(unknown, 2, true.astype(np.int64))
