"""The nodes of the aircraft: one that flies it, those that say where to, and those that fold the gripper."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

from rosa_simulation.lifecycle_node import LifecycleNode, Observer
from uav_example.events import UavEvent
from uav_example.world.area import Analysis, Sample, search_path
from uav_example.world.world import World

CONTROL_MOTION = "control_motion_node"
SEARCH_PATH = "generate_search_path_node"
PICK_PATH = "generate_pick_path_node"
ANALYZE_PATH = "generate_analyze_path_node"
HOME_PATH = "generate_home_path_node"
LAND_PATH = "generate_land_path"
FOLD_GRIPPER = "fold_gripper"
RELEASE_SPRING = "release_spring_node"


class UavNode(LifecycleNode):
    """A node that works once every control period while it is active.

    Args:
        name: the component's name in the knowledge model.
        world: what it acts on.
        observer: called after each of its changes.
        begin: what it does when it is activated.
        work: what it then does every period.
    """

    def __init__(
        self,
        name: str,
        world: World,
        observer: Observer,
        *,
        work: Callable[[], None],
        begin: Callable[[], None] = lambda: None,
    ) -> None:
        super().__init__(world.clock, world.parameters.service_time, observer)
        self.name = name
        self._period = world.parameters.control_period
        self._begin = begin
        self._work = work

    def on_activate(self) -> None:
        """Begin, and work from the next period on."""
        self._begin()
        self.every(self._period, self._work)


class Search:
    """Leads over the area in lanes, and goes on where it was when it was interrupted."""

    def __init__(self, world: World) -> None:
        self._world = world
        self._path = search_path(world.parameters)
        self._index = 0

    @property
    def done(self) -> bool:
        """Whether the whole area was searched."""
        return self._index >= len(self._path)

    @property
    def share(self) -> float:
        """How much of the area was searched, 0 to 1."""
        return self._index / len(self._path)

    def begin(self) -> None:
        """Fly to the point that is due."""
        if not self.done:
            self._world.aircraft.target = (*self._path[self._index], self._world.parameters.search_height)

    def work(self) -> None:
        """Look for samples from the height of the search, and fly on to the next point."""
        aircraft = self._world.aircraft
        if self.done or aircraft.position[2] != self._world.parameters.search_height:
            return
        self._world.look_for_samples()
        if aircraft.at_target:
            self._index += 1
            self.begin()
            if self.done:
                self._world.report(UavEvent.AREA_SEARCHED)


class WorkAtSample:
    """Leads to the sample that waits and works there until it is analysed; anew when it was interrupted.

    Args:
        world: what it acts on.
        analysis: which analysis it is.
        height: above the ground, m.
        duration: of the analysis, s.
        device: whether the device that analyses works now; asked once every control period.
    """

    def __init__(
        self, world: World, analysis: Analysis, *, height: float, duration: float, device: Callable[[], bool]
    ) -> None:
        self._world = world
        self._analysis = analysis
        self._height = height
        self._periods = round(duration / world.parameters.control_period)
        self._device = device
        self._sample: Sample | None = None
        self._worked = 0

    def begin(self) -> None:
        """Fly to the sample."""
        self._sample, self._worked = self._world.waiting, 0
        if self._sample is not None:
            self._world.aircraft.target = (self._sample.x, self._sample.y, self._height)

    def work(self) -> None:
        """Work, once the sample is reached."""
        sample = self._sample
        if sample is None or not self._world.aircraft.at_target or not self._device():
            return
        self._worked += 1
        if self._worked >= self._periods:
            self._sample = None
            self._world.analysed(sample, self._analysis)


class Fold:
    """Folds the gripper on the ground.

    Args:
        world: what it acts on.
        duration: how long it takes, s.
        device: whether what folds it works now.
    """

    def __init__(self, world: World, *, duration: float, device: Callable[[], bool]) -> None:
        self._world = world
        self._periods = round(duration / world.parameters.control_period)
        self._device = device
        self._worked = 0

    def begin(self) -> None:
        """Begin anew."""
        self._worked = 0

    def work(self) -> None:
        """Fold, once the aircraft has landed."""
        if self._world.gripper.folded or not self._world.aircraft.landed or not self._device():
            return
        self._worked += 1
        if self._worked >= self._periods:
            self._world.fold_gripper()


def make_nodes(world: World, search: Search, observer: Observer) -> dict[str, UavNode]:
    """The nodes by their names; the spring's only if there is a spring.

    Args:
        world: that the nodes act on.
        search: the path over the area, shared with whoever asks how far it is.
        observer: called when a node changes.
    """
    p, aircraft, gripper = world.parameters, world.aircraft, world.gripper
    node = partial(UavNode, world=world, observer=observer)
    pick = WorkAtSample(world, Analysis.PICKED_UP, height=p.pick_height, duration=p.pick_time, device=world.use_gripper)
    scan = WorkAtSample(
        world, Analysis.IN_SITU, height=p.scan_height, duration=p.scan_time, device=lambda: gripper.folded
    )
    fold = Fold(world, duration=p.fold_time, device=lambda: gripper.works)
    spring = Fold(world, duration=p.spring_time, device=lambda: True)

    def reach_out() -> None:
        world.unfold_gripper()
        pick.begin()

    def fly_home() -> None:
        aircraft.target = (0.0, 0.0, p.home_height)

    def take_charge() -> None:
        if aircraft.at_target:
            world.charge(p.charge_rate * p.control_period)

    def fly_down() -> None:
        x, y, _ = aircraft.position
        aircraft.target = (x, y, 0.0)

    nodes = [
        node(CONTROL_MOTION, work=lambda: aircraft.step(p.control_period)),
        node(SEARCH_PATH, begin=search.begin, work=search.work),
        node(PICK_PATH, begin=reach_out, work=pick.work),
        node(ANALYZE_PATH, begin=scan.begin, work=scan.work),
        node(HOME_PATH, begin=fly_home, work=take_charge),
        node(LAND_PATH, begin=fly_down, work=lambda: None),
        node(FOLD_GRIPPER, begin=fold.begin, work=fold.work),
    ]
    if p.spring:
        nodes.append(node(RELEASE_SPRING, begin=spring.begin, work=spring.work))
    return {node.name: node for node in nodes}
