"""Questions before anything happens: what would be feasible, why not, and what would have to change."""

from pathlib import Path

from rosa_core import KnowledgeBase, KnowledgeModel, Situation

kb = KnowledgeBase(KnowledgeModel.load(Path(__file__).with_name("rover.yaml")))

with kb.supposing(Situation(failed_components=("camera", "lidar"))):
    print("drive is feasible:", kb.is_action_feasible("drive"))
    print(*kb.explain("action", "drive").remedies, sep="\n")
print("and without supposing:", kb.is_action_feasible("drive"))

# prints:
# drive is feasible: False
# one of the components camera, lidar must recover
# and without supposing: True
