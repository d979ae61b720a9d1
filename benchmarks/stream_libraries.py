"""Libraries of transformations made at random, for benchmarks and tests."""

from __future__ import annotations

import random

from rosa_streams.environment import Environment, Port, Target, Transformation
from rosa_streams.tags import Concept, Named, One, Ontology, Some


def structured_library(
    count: int,
    seed: int,
    *,
    branching: int = 4,
    layers: int = 6,
    sharing: float = 0.3,
    targets: int = 1,
    labor: tuple[int, int] = (1, 100),
) -> Environment:
    """Pipelines as robots have them: kinds of data in layers, each kind given by several transformations.

    Args:
        count: of transformations.
        seed: of the random choices.
        branching: how many transformations give each kind, about.
        layers: from sources to results.
        sharing: the part of inputs that are not of the layer just below, so that pipelines share what they need.
        targets: how many kinds of the last layer are asked for.
        labor: the least and the most that starting a unit costs; alike costs make searching hard.
    """
    rng = random.Random(seed)
    kinds_in_layer = max(1, count // (branching * layers))
    kinds = [[f"Kind{layer}x{number}" for number in range(kinds_in_layer)] for layer in range(layers)]
    transformations = []
    for number in range(count):
        layer = number % layers
        kind = kinds[layer][(number // layers) % kinds_in_layer]
        inputs: list[Port] = []
        for place in range(rng.choice([1, 2, 2, 3]) if layer else 0):
            below = layer - 1 if rng.random() >= sharing else rng.randrange(layer)
            inputs.append(Port(f"in{place}", _tag(rng.choice(kinds[below]))))
        distinct = {port.tag: port for port in inputs}
        transformations.append(
            Transformation(
                f"t{number}",
                "none",
                tuple(distinct.values()),
                (Port("out", _tag(kind)),),
                labor=float(rng.randint(*labor)),
                upkeep=0.0,
                quality=float(rng.randint(0, 3)),
            )
        )
    goal = [Target(f"q{number}", _tag(kinds[-1][number % kinds_in_layer]), f"/r{number}") for number in range(targets)]
    return Environment(frozenset(), frozenset(transformations), frozenset(goal), Ontology())


def random_library(count: int, seed: int, *, kinds: int | None = None, most_inputs: int = 3) -> Environment:
    """No layers: any kind may need any other, so that there are loops and kinds that nothing feeds."""
    rng = random.Random(seed)
    names = [f"K{number}" for number in range(kinds or max(2, count // 2))]
    transformations = []
    for number in range(count):
        # Now and then two ports want the same kind, that is, two different streams of it.
        inputs = tuple(
            Port(f"in{place}", _tag(rng.choice(names))) for place in range(rng.choice([0, *range(most_inputs + 1)]))
        )
        outputs = tuple(Port(f"out{place}", _tag(rng.choice(names))) for place in range(rng.choice([1, 1, 1, 2])))
        transformations.append(
            Transformation(
                f"t{number}",
                "none",
                inputs,
                outputs,
                labor=float(rng.randint(0, 9)),
                upkeep=rng.randint(0, 3) / 10,
                quality=float(rng.randint(0, 3)),
            )
        )
    wanted = rng.sample(names, min(len(names), rng.choice([1, 1, 2])))
    goal = [Target(f"q{number}", _tag(name), f"/r{number}") for number, name in enumerate(wanted)]
    return Environment(frozenset(), frozenset(transformations), frozenset(goal), Ontology())


def _tag(kind: str) -> Concept:
    return Concept.of(Named(kind), Some("hasSource", Concept.of(One("field"))))
