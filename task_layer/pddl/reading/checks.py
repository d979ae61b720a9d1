"""What is wrong with a domain and a problem, said before the reader would stumble over it."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence

from rosa_core.errors import Location, Problem, nearest
from task_layer.pddl.reading.declarations import (
    Declarations,
    Signature,
    check_types,
    declare_objects,
    declare_signatures,
    declare_types,
    declared_twice,
    typed_list,
)
from task_layer.pddl.reading.sections import ACTION_PARTS, ACTIONS, DOMAIN_SECTIONS, PROBLEM_SECTIONS
from task_layer.pddl.reading.source import Form, Symbol, is_number

REQUIREMENTS = (
    ":strips",
    ":typing",
    ":negative-preconditions",
    ":disjunctive-preconditions",
    ":equality",
    ":existential-preconditions",
    ":universal-preconditions",
    ":quantified-preconditions",
    ":conditional-effects",
    ":fluents",
    ":numeric-fluents",
    ":adl",
    ":durative-actions",
    ":duration-inequalities",
    ":action-costs",
)

_NEEDED = (
    (":domain", "it does not say of which domain it is", "add (:domain NAME)"),
    (":init", "there is no initial state", "add (:init), with the facts that hold at the beginning"),
    (":goal", "there is no goal", "add (:goal (and ...))"),
)
_Variables = Mapping[str, tuple[str, ...]]
_CONNECTIVES = {"and", "or", "not", "imply", "when"}
_COMPARISONS = {"=", "<", ">", "<=", ">="}
_NUMERIC = {"+", "-", "*", "/", "increase", "decrease", "assign", "scale-up", "scale-down"}
_TIMES = {"at", "over"}


def check(domain: Form, domain_file: str, problem: Form, problem_file: str) -> list[Problem]:
    """Every problem of the two files that shows in what they declare, in order of appearance."""
    known = Declarations()
    _check_kind(domain, domain_file, "domain", known)
    _check_kind(problem, problem_file, "problem", known)
    if known.problems:
        return known.problems
    _check_sections(domain, domain_file, DOMAIN_SECTIONS, known)
    _check_sections(problem, problem_file, PROBLEM_SECTIONS, known)
    _check_names(domain, domain_file, problem, problem_file, known)
    sections: list[tuple[str, Callable[[Form], None]]] = [
        (":types", lambda form: declare_types(form, domain_file, known)),
        (":constants", lambda form: declare_objects(form, domain_file, known)),
        (":predicates", lambda form: declare_signatures(form, domain_file, known.predicates, known)),
        (":functions", lambda form: declare_signatures(form, domain_file, known.functions, known)),
        (":action", lambda form: _Formulas(domain_file, known).action(form)),
        (":durative-action", lambda form: _Formulas(domain_file, known).action(form)),
    ]
    for head, read in sections:
        for form in (form for form in domain.forms if form.head == head):
            read(form)
    for form in problem.forms:
        if form.head == ":objects":
            declare_objects(form, problem_file, known)
    for form in problem.forms:
        if form.head in (":init", ":goal"):
            for item in form.items[1:]:
                _Formulas(problem_file, known).formula(item, {}, is_initial=form.head == ":init")
    return known.problems


def _check_sections(form: Form, file: str, allowed: tuple[str, ...], known: Declarations) -> None:
    for item in form.items[2:]:
        if isinstance(item, Symbol):
            what = f"a section is expected, not '{item.text}'"
            known.problems.append(Problem(what, Location(file, item.line), "remove it, or put it in parentheses"))
    seen: set[str] = set()
    for section in list(form.forms)[1:]:
        where = Location(file, section.line)
        if section.head in seen and section.head not in ACTIONS:
            what = f"there are two sections '{section.head}'"
            known.problems.append(Problem(what, where, "put what they say into one"))
        seen.add(section.head)
        if section.head == ":derived":
            hint = "let the actions' effects, or a sensed predicate, say what follows"
            known.problems.append(Problem("derived predicates are not supported", where, hint))
        elif section.head not in allowed:
            hint = nearest(section.head, allowed) or f"sections are: {', '.join(allowed)}"
            known.problems.append(Problem(f"there is no section '{section.head}' here", where, hint))
        elif section.head == ":requirements":
            for item in section.items[1:]:
                if isinstance(item, Symbol) and item.key not in REQUIREMENTS:
                    hint = nearest(item.key, REQUIREMENTS) or f"supported are: {' '.join(REQUIREMENTS)}"
                    what = f"the requirement '{item.text}' is not supported"
                    known.problems.append(Problem(what, Location(file, item.line), hint))


def _check_names(domain: Form, domain_file: str, problem: Form, problem_file: str, known: Declarations) -> None:
    _check_actions_names(domain, domain_file, known)
    for head, what, hint in _NEEDED:
        if not any(section.head == head for section in problem.forms):
            known.problems.append(Problem(what, Location(problem_file, problem.line), hint))
    if not any(section.head in ACTIONS for section in domain.forms):
        where = Location(domain_file, domain.line)
        known.problems.append(Problem("there is no action", where, "add (:action ...) or (:durative-action ...)"))
    declared = next(domain.forms, None)
    named = next((section for section in problem.forms if section.head == ":domain"), None)
    if declared is not None and named is not None:
        names = [item.key for form in (declared, named) for item in form.items[1:] if isinstance(item, Symbol)]
        if len(names) == 2 and names[0] != names[1]:
            what = f"the problem is of the domain '{names[1]}', and this domain is '{names[0]}'"
            known.problems.append(
                Problem(what, Location(problem_file, named.line), "give the files that belong together")
            )


def _check_kind(form: Form, file: str, kind: str, known: Declarations) -> None:
    name = form.items[1] if len(form.items) > 1 else None
    found = name.head if isinstance(name, Form) else ""
    if not isinstance(name, Form) or found != kind or len(name.items) != 2 or not isinstance(name.items[1], Symbol):
        given = f", but a {found}" if found in ("domain", "problem") and found != kind else ""
        hint = "give the domain first, then the problem" if given else f"begin with (define ({kind} NAME)"
        known.problems.append(Problem(f"this is not a {kind}{given}", Location(file, form.line), hint))


def _check_actions_names(domain: Form, file: str, known: Declarations) -> None:
    seen: set[str] = set()
    for form in domain.forms:
        name = form.items[1] if form.head in ACTIONS and len(form.items) > 1 else None
        if isinstance(name, Symbol):
            if name.key in seen:
                known.problems.append(declared_twice(name.text, name.line, file))
            seen.add(name.key)


class _Formulas:
    """Checks the conditions and effects of one file: every name declared, with the right arguments."""

    def __init__(self, file: str, known: Declarations) -> None:
        self._file = file
        self._known = known
        self._timed_allowed = True

    def action(self, form: Form) -> None:
        """Check an action."""
        name = form.items[1] if len(form.items) > 1 else None
        if not isinstance(name, Symbol) or name.key.startswith(":"):
            self._add("an action has no name", form.line, "write it as (:action NAME :parameters (...) ...)")
            return
        parameters = form.after(":parameters")
        variables: dict[str, tuple[str, ...]] = {}
        if isinstance(parameters, Form):
            variables = self._variables(parameters)
        else:
            self._add(f"action '{name.text}' has no parameters", name.line, "add :parameters (); they may be empty")
        durative = self._timed_allowed = form.head == ":durative-action"
        self._check_parts(form, name.text)
        for keyword in ACTION_PARTS[form.head][1:]:
            given = form.after(keyword)
            if given is not None:
                self.formula(given, {**variables, "?duration": ("number",)})
                if durative and keyword != ":duration":
                    self._needs_times(given)
        if form.after(":effect") is None:
            self._add(f"action '{name.text}' has no effect", name.line, "add :effect (and ...)")
        duration = form.after(":duration")
        if durative and not (isinstance(duration, Form) and duration.items):
            self._add(f"action '{name.text}' has no duration", name.line, "add :duration (= ?duration 5)")

    def _check_parts(self, form: Form, name: str) -> None:
        seen: set[str] = set()
        for item in form.items[2:]:
            if not isinstance(item, Symbol) or not item.key.startswith(":"):
                continue
            if item.key not in ACTION_PARTS[form.head]:
                hint = f"a {form.head[1:]} has {', '.join(ACTION_PARTS[form.head])}"
                self._add(f"action '{name}' cannot have '{item.text}'", item.line, hint)
            elif item.key in seen:
                self._add(f"action '{name}' has '{item.text}' twice", item.line, "put what they say into one")
            seen.add(item.key)

    def _needs_times(self, item: Symbol | Form) -> None:
        """Check that each condition and effect of a durative action says when."""
        if not isinstance(item, Form) or not item.items or item.head in _NUMERIC or _is_timed(item):
            return
        if item.head in _CONNECTIVES | {"forall", "exists"}:
            for inner in item.items[2:] if item.head in ("forall", "exists") else item.items[1:]:
                self._needs_times(inner)
        else:
            what = f"'({item.head} ...)' does not say when"
            self._add(what, item.line, "put it into (at start ...), (over all ...) or (at end ...)")

    def formula(self, item: Symbol | Form, variables: _Variables, *, is_initial: bool = False) -> None:
        """Check a condition or an effect, or with ``is_initial`` a fact of ``:init``."""
        if isinstance(item, Symbol) or not item.items:
            if isinstance(item, Symbol) and not _is_number(item.key) and item.key not in variables:
                self._add(f"a condition or effect is expected, not '{item.text}'", item.line, "put it in parentheses")
            return
        head, inner = item.head, item.items[1:]
        if head in _COMPARISONS or head in _NUMERIC:
            self._operands(inner, variables, named=head in _COMPARISONS)
        elif head in ("forall", "exists"):
            self._quantified(item, variables)
        elif _is_timed(item) and not is_initial:
            self._timed(item, variables)
        elif head in _CONNECTIVES:
            for argument in inner:
                self.formula(argument, variables)
        else:
            self._atom(item, self._known.predicates, "predicate", variables)

    def _operands(self, operands: Sequence[Symbol | Form], variables: _Variables, *, named: bool) -> None:
        """Check what is compared or computed with; ``named``: it may be objects."""
        for operand in operands:
            if isinstance(operand, Form):
                self._atom(operand, self._known.functions, "function", variables)
            elif named:
                self._term(operand, variables)

    def _quantified(self, item: Form, variables: _Variables) -> None:
        if len(item.items) != 3 or not isinstance(item.items[1], Form):
            self._add(
                f"'{item.head}' needs variables and a formula", item.line, f"write ({item.head} (?x - type) (...))"
            )
            return
        self.formula(item.items[2], {**variables, **self._variables(item.items[1])})

    def _timed(self, item: Form, variables: _Variables) -> None:
        when, inner = item.items[1:]
        if not self._timed_allowed:
            self._add(
                "an :action takes no time, so that there is no start or end", item.line, "make it a :durative-action"
            )
        expected = ("all",) if item.head == "over" else ("start", "end")
        if isinstance(when, Symbol) and when.key not in expected:
            self._add(f"'{item.head} {when.text}' is no time", item.line, "times are: at start, over all, at end")
        self.formula(inner, variables)

    def _atom(self, item: Form, declared: dict[str, Signature], kind: str, variables: _Variables) -> None:
        head = item.items[0]
        if not isinstance(head, Symbol):
            self._add("a name is expected after '('", item.line)
            return
        if kind == "function" and head.key in _NUMERIC:
            self.formula(item, variables)
            return
        signature = declared.get(head.key)
        if signature is None:
            hint = nearest(head.key, declared) or f"declare it in (:{kind}s ...)"
            self._add(f"there is no {kind} '{head.text}'", head.line, hint)
            return
        arguments = item.items[1:]
        if len(arguments) != len(signature.types):
            what = f"'{head.text}' takes {len(signature.types)} arguments, not {len(arguments)}"
            self._add(what, head.line, "see its declaration")
            return
        for argument, wanted in zip(arguments, signature.types, strict=True):
            if isinstance(argument, Form):
                self._add(f"'{head.text}' takes names, not a form", argument.line)
            else:
                self._term(argument, variables, head.text, wanted)

    def _term(self, term: Symbol, variables: _Variables, of: str = "", wanted: tuple[str, ...] | None = None) -> None:
        if _is_number(term.key):
            return
        scope, kind = (variables, "variable") if term.key.startswith("?") else (self._known.objects, "object")
        types = scope.get(term.key)
        if types is None:
            hint = nearest(term.key, scope) or (
                "add it to :parameters" if kind == "variable" else "declare it in (:objects ...)"
            )
            self._add(f"there is no {kind} '{term.text}'", term.line, hint)
        elif wanted is not None and not self._known.is_a(types, wanted):
            what = f"'{term.text}' is of type {' or '.join(types)}, and '{of}' takes {' or '.join(wanted)}"
            self._add(what, term.line, "use one of that type, or change the declaration")

    def _variables(self, form: Form) -> dict[str, tuple[str, ...]]:
        found: dict[str, tuple[str, ...]] = {}
        for symbol, types in typed_list(form.items, self._file, self._known):
            check_types(symbol, types, self._file, self._known)
            if symbol.key in found:
                self._known.problems.append(declared_twice(symbol.text, symbol.line, self._file))
            found[symbol.key] = types
        return found

    def _add(self, what: str, line: int, hint: str | None = None) -> None:
        self._known.problems.append(Problem(what, Location(self._file, line), hint))


def _is_timed(item: Form) -> bool:
    """Whether this is ``(at start (...))`` or the like; ``(at robot place)`` is a predicate that many domains have."""
    if item.head not in _TIMES or len(item.items) != 3:
        return False
    _, when, inner = item.items
    return isinstance(when, Symbol) and not when.key.startswith("?") and isinstance(inner, Form)


def _is_number(text: str) -> bool:
    return is_number(text) or text == "#t"
