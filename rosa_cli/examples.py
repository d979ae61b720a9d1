"""An example of every command, for its ``--help``."""

from __future__ import annotations

EXAMPLES = {
    "check": "rosa check suave.yaml suave_extended.yaml --mission mission.xml",
    "status": "rosa status suave-extended --measure battery_level=0.2 --require search_pipeline",
    "explain": "rosa explain suave-extended action inspect_pipeline --measure battery_level=0.2",
    "query": "rosa query suave 'match $a isa Action, has name $n; fetch $n;'",
    "effort": "rosa effort suave.yaml",
    "verify": "rosa verify suave.yaml suave_extended.yaml",
    "schema": "rosa schema > model.schema.json",
    "scenarios": "rosa scenarios suave",
    "run": "rosa run suave-extended --manager rosa --seed 3 --set time_limit=250 --out run3",
    "new": "rosa new my_robot",
    "tree": "rosa tree mission.xml --svg mission.svg",
    "replay": "rosa replay mission.btlog --speed 10",
    "plan": "rosa plan domain.pddl problem.pddl --model robot.yaml --measure battery_level=0.2",
    "up": "rosa up examples/real_processes/robot.yaml",
    "campaign": "rosa campaign suave --managers rosa,none --runs 20 --set time_limit=250 --out results",
    "report": "rosa report results --out report.html",
    "compare": "rosa compare run3 run4",
    "bench": "rosa bench --most 1000",
    "journal show": "rosa journal show robot.journal --limit 20",
    "journal compact": "rosa journal compact robot.journal --keep-writes 1000",
    "journal export": "rosa journal export robot.journal",
    "streams check": "rosa streams check streams.yaml",
    "streams match": "rosa streams match streams.yaml",
    "streams plan": "rosa streams plan streams.yaml",
    "streams explain": "rosa streams explain streams.yaml",
    "streams monitor": "rosa streams monitor 'G (lost -> F[0,5] found)' --data drive.csv",
}
"""By what stands after ``rosa`` on the command line."""
