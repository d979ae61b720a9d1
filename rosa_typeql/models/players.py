"""The players that an insert gives a relation: which role each of them plays, and whether all are there."""

from __future__ import annotations

from collections.abc import Sequence

from rosa_core.errors import InputError
from rosa_typeql.matching.facts import Thing
from rosa_typeql.parsing.problems import Problems
from rosa_typeql.parsing.statements import Player
from rosa_typeql.schema.table import Role, a_or_an, hint_role, may_play, role_named, roles

Cast = dict[str, list[tuple[Thing, int]]]
"""Players by role, each with its line."""
_OPTIONAL_ROLES = frozenset({"parameter", "preference", "qos"})


def cast_players(type_label: str, players: Sequence[tuple[Player, Thing]], line: int, problems: Problems) -> Cast:
    """Who plays what in a relation.

    Args:
        type_label: what the relation is.
        players: what is stated of each, and the thing that it is.
        line: where the relation stands.
        problems: knows the file.

    Raises:
        InputError: for every player that has no role or the wrong one, and every role that nobody plays.
    """
    cast: Cast = {}
    wrong = Problems("", [])
    for player, thing in players:
        with wrong.gathering():
            role = _role(type_label, player, thing, problems)
            if role.label in cast and not role.many:
                what = f"{a_or_an(type_label)} has one {role.label}"
                raise problems.error(player.line, what, "state a relation for each")
            cast.setdefault(role.label, []).append((thing, player.line))
    missing = [] if wrong.found else [name for name in roles(type_label) if name not in {*cast, *_OPTIONAL_ROLES}]
    for name in missing:
        with wrong.gathering():
            raise problems.error(line, f"{a_or_an(type_label)} has no {name}", f"add ({name}: $...)")
    if wrong.found:
        raise InputError(wrong.found)
    return cast


def _role(label: str, player: Player, thing: Thing, problems: Problems) -> Role:
    if player.role is None:
        able = [role for role in roles(label).values() if may_play(role, thing.type)]
        if len(able) != 1:
            what = f"which role {player.variable} plays is not said"
            raise problems.error(player.line, what, hint_role("", label))
        return able[0]
    role = role_named(label, player.role)
    if role is None:
        hint = hint_role(player.role, label)
        raise problems.error(player.line, f"{a_or_an(label)} has no role '{player.role}'", hint)
    if not may_play(role, thing.type):
        what = f"{player.variable} is {a_or_an(thing.type)}, which cannot be the {player.role} of {a_or_an(label)}"
        raise problems.error(player.line, what, f"that is for: {', '.join(role.players)}")
    return role
