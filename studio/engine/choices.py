"""What the user chose: how Baxter is taught from now on."""

from dataclasses import dataclass

from studio.engine.arms import Arms, learned_joints
from studio.engine.calibration import Calibration
from studio.engine.gate import GateMode
from studio.engine.hands import PLAIN, HandOptions
from studio.engine.performance import start_world
from studio.engine.pipeline import Pipeline
from studio.engine.retarget import Mapping
from studio.engine.robot import load_robot
from studio.engine.world import Scene, World


@dataclass(frozen=True)
class Choices:
    """See the module; as they are at every start."""

    arms: Arms = "left"
    mapping: Mapping = "exact"
    gate: GateMode = "sequence"
    mirrored: bool = False  # the robot as in a mirror: its left arm does what the right one does
    hands: HandOptions = PLAIN
    calibration: Calibration | None = None

    @property
    def joints(self) -> tuple[str, ...]:
        """The joints that are learned; a lesson of other ones is of no use."""
        return learned_joints(self.arms, self.mapping)

    def pipeline(self) -> Pipeline:
        """Return the way from skeletons to commands."""
        return Pipeline.for_robot(
            load_robot(),
            self.arms,
            self.mapping,
            self.gate,
            self.mirrored,
            self.calibration,
            self.hands,
        )

    def start_world(self, scene: Scene | None = None) -> World:
        """Return a fresh world in which the robot waits, with the usual scene unless given one."""
        return start_world(self.arms, self.mapping, self.hands, scene)

    def starts_as(self, other: "Choices") -> bool:
        """Tell whether the robot waits in the same pose, with the same hands."""
        here = (self.arms, self.mapping, self.hands.gripper)
        return here == (other.arms, other.mapping, other.hands.gripper)
