"""Upper bounds on the score that an unfinished choice can still reach.

The bound is a Lagrangian relaxation. A limit may be exceeded at a price per unit of excess, and earns that price per
unit of slack. A component that designs of several functions share is counted for each of them, in portions such that
no set of functions that use it gets more than it costs, or less than it gains. Any prices and portions give a true
bound, so that the search is exact whatever they are; they are tuned once, so that it is short. All numbers are whole.

Source: the Lagrangian relaxation of the multiple-choice knapsack problem (Kellerer, Pferschy and Pisinger, *Knapsack
Problems*, 2004, chapter 11), with cost splitting for what is shared.
"""

from __future__ import annotations

from rosa_core.choice.additive import AdditiveProblem, Choice

_WHOLE = 1024
"""Portions are counted in parts of this."""
_ROUNDS = 30
_BISECTIONS = 40


def bits(number: int) -> list[int]:
    """The positions of the ones in a number.

    Example:
        >>> bits(0b1101)
        [0, 2, 3]
    """
    return [index for index in range(number.bit_length()) if number >> index & 1]


class Bounds:
    """Bounds for one additive problem.

    Attributes:
        users: for each component, the functions with a design that it is in.
        later: for each depth, the components (bits) that functions from there on can use.
        price: of each limit.
        base: what a bound starts from: the constant, and what the limits earn when nothing is used.
        own: for each function, the score of each design less the price of what it uses.
        worth: for each component, the same for its best option.
    """

    def __init__(self, problem: AdditiveProblem) -> None:
        self.problem = problem
        self._parts = [[bits(choice.parts) for choice in choices] for choices in problem.functions]
        self._used = [_union(choices) for choices in problem.functions]
        self.users = [
            [function for function, used in enumerate(self._used) if used >> component & 1]
            for component in range(len(problem.components))
        ]
        self._shared = [c for c, users in enumerate(self.users) if len(users) > 1]
        self.later = [0] * (len(problem.functions) + 1)
        for depth in range(len(problem.functions) - 1, -1, -1):
            self.later[depth] = self.later[depth + 1] | self._used[depth]
        self.price = [0] * len(problem.limits)
        self._portion = [dict.fromkeys(users, _WHOLE) for users in self.users]
        self._prepaid = [0] * len(self.users)
        self._set_prices()
        self._tune()

    def priced(self, choice: Choice) -> int:
        """The score of a choice less the price of what it uses."""
        return choice.score - sum(map(int.__mul__, self.price, choice.usage))

    def rest(self, depth: int, used: int) -> int:
        """The most that the functions from ``depth`` on can add when the components ``used`` (bits) are there.

        Args:
            depth: how many functions have been decided on, from the first.
            used: the components of the designs chosen, as bits: bit ``c`` for component ``c``.

        Returns:
            an upper bound on the score still to be gained, in the ledger's whole units; kept for the next question.
        """
        used &= self.later[depth]
        known = self._rests.get((depth, used))
        if known is not None:
            return known
        claims, given = self._claims_from(depth)
        total = sum(gain for component, gain in given.items() if not used >> component & 1)
        for function in range(depth, len(self.own)):
            key = (depth, function, used & self._used[function])
            best = self._bests.get(key)
            if best is None:
                best = self._bests[key] = self._best(function, claims, used)[0]
            total += best
        self._rests[depth, used] = total
        return total

    # -- inside --

    def _best(self, function: int, claims: list[dict[int, int]], used: int) -> tuple[int, int]:
        """The most that a design of the function can add, and which it is."""
        values = []
        for own, parts in zip(self.own[function], self._parts[function], strict=True):
            values.append(own + sum(claims[c][function] for c in parts if not used >> c & 1))
        best = max(values)
        return best, values.index(best)

    def _set_prices(self, limit: int = 0, price: int | None = None) -> None:
        if price is not None:
            self.price[limit] = price
        problem = self.problem
        self.own = [list(map(self.priced, choices)) for choices in problem.functions]
        self.worth = [max(map(self.priced, options)) for options in problem.components]
        self.base = problem.constant + sum(map(int.__mul__, self.price, problem.limits))
        self._reset()

    def _reset(self) -> None:
        self._rests: dict[tuple[int, int], int] = {}
        self._bests: dict[tuple[int, int, int], int] = {}
        self._claims: dict[int, tuple[list[dict[int, int]], dict[int, int]]] = {}

    def _claims_from(self, depth: int) -> tuple[list[dict[int, int]], dict[int, int]]:
        """By component: what each function from ``depth`` on counts for it, and what is counted in any case."""
        known = self._claims.get(depth)
        if known is not None:
            return known
        claims: list[dict[int, int]] = []
        given: dict[int, int] = {}
        for component, worth in enumerate(self.worth):
            users = [function for function in self.users[component] if function >= depth]
            if len(users) <= 1:
                claims.append(dict.fromkeys(users, worth))
            elif worth >= 0:
                given[component] = worth * self._prepaid[component] // _WHOLE
                claims.append(dict.fromkeys(users, worth - given[component]))
            else:
                portion = self._portion[component]
                whole = sum(portion[function] for function in users)
                claims.append({function: -(-worth * portion[function] // whole) for function in users})
        self._claims[depth] = claims, given
        return claims, given

    # -- tuning --

    def _tune(self) -> None:
        self._tune_prices()
        if self._shared:
            self._tune_portions()
            self._tune_prices()

    def _relaxed(self) -> tuple[int, list[int]]:
        """The bound on all, and the design of each function that reaches it."""
        claims, given = self._claims_from(0)
        best = [self._best(function, claims, 0) for function in range(len(self.own))]
        return self.base + sum(given.values()) + sum(value for value, _ in best), [design for _, design in best]

    def _tune_prices(self) -> None:
        """Coordinate descent: the bound is convex in each price, and least where the limit is just used up."""
        for limit in range(len(self.price)):
            before = max(self.price[limit], 1)
            if self._slack(limit, 0)[1] >= 0:
                continue
            low, high = 0, before
            while self._slack(limit, high)[1] < 0 and high.bit_length() < 4096:
                low, high = high, high << 4
            for _ in range(_BISECTIONS):
                if high - low <= max(1, high >> 10):
                    break
                # Prices range over many orders of magnitude, so it is the exponents that are bisected first.
                middle = (low + high) >> 1 if high < low * 4 else 1 << ((low.bit_length() + high.bit_length()) >> 1)
                middle = min(max(middle, low + 1), high - 1)
                if self._slack(limit, middle)[1] >= 0:
                    high = middle
                else:
                    low = middle
            self._set_prices(limit, min((low, high), key=lambda price: self._slack(limit, price)[0]))

    def _slack(self, limit: int, price: int) -> tuple[int, float]:
        """The bound at a price, and how much of the limit is left in the relaxed optimum."""
        self._set_prices(limit, price)
        bound, designs = self._relaxed()
        problem = self.problem
        left = problem.limits[limit] * _WHOLE
        for function, design in enumerate(designs):
            left -= problem.functions[function][design].usage[limit] * _WHOLE
        for component, using in self._using(designs).items():
            option = max(problem.components[component], key=self.priced)
            left -= option.usage[limit] * self._times_counted(component, using)
        return bound, left

    def _using(self, designs: list[int]) -> dict[int, list[int]]:
        """For each component, which functions use it when these designs are chosen."""
        using: dict[int, list[int]] = {component: [] for component in self._shared}
        for function, design in enumerate(designs):
            for component in self._parts[function][design]:
                using.setdefault(component, []).append(function)
        return using

    def _times_counted(self, component: int, using: list[int]) -> int:
        if len(self.users[component]) == 1:
            return _WHOLE * len(using)
        if self.worth[component] >= 0:
            prepaid = self._prepaid[component]
            return prepaid + (_WHOLE - prepaid) * len(using)
        portion = self._portion[component]
        return _WHOLE * sum(portion[function] for function in using) // sum(portion.values())

    def _tune_portions(self) -> None:
        """Subgradient steps: gains that several functions count are counted once, costs go to those who use them."""
        best: tuple[int, list[dict[int, int]], list[int]] | None = None
        for round_ in range(_ROUNDS + 1):
            self._reset()
            bound, designs = self._relaxed()
            if best is None or bound < best[0]:
                best = bound, [dict(portion) for portion in self._portion], list(self._prepaid)
            step = 0.5 * 0.9**round_
            using = self._using(designs)
            moved = [self._shift(component, using[component], step) for component in self._shared]
            if not any(moved):
                break
        if best is not None:
            _, self._portion, self._prepaid = best
        self._reset()

    def _shift(self, component: int, using: list[int], step: float) -> bool:
        """Move the portions of a component towards what its use calls for; whether there was anything to move."""
        users = len(self.users[component])
        if self.worth[component] < 0:
            if not using or len(using) == users:
                return False
            portion = self._portion[component]
            for function in using:
                portion[function] = min(portion[function] + int(2 * step * portion[function]), _WHOLE**2)
            return True
        before = self._prepaid[component]
        change = int(_WHOLE * step * (len(using) - 1) / users)
        self._prepaid[component] = min(max(before + change, 0), _WHOLE)
        return self._prepaid[component] != before


def _union(choices: tuple[Choice, ...]) -> int:
    union = 0
    for choice in choices:
        union |= choice.parts
    return union
