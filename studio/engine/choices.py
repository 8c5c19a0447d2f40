"""What the user chose: how Baxter is taught from now on."""

from dataclasses import dataclass, replace

from studio.engine.arms import Arms, learned_joints, sides_of
from studio.engine.calibration import Calibration
from studio.engine.errors import StudioError
from studio.engine.gate import GateMode
from studio.engine.hands import PLAIN, HandOptions
from studio.engine.performance import start_world
from studio.engine.pipeline import Pipeline
from studio.engine.retarget import Mapping
from studio.engine.robot import load_robot
from studio.engine.scene import USUAL, Scene
from studio.engine.skeleton import Side, other_side
from studio.engine.world import World


@dataclass(frozen=True)
class Choices:
    """How Baxter is taught; by default as at every start."""

    arms: Arms = "left"
    mapping: Mapping = "exact"
    gate: GateMode = "sequence"
    mirrored: bool = False  # the robot as in a mirror: its left arm does what the right one does
    hands: HandOptions = PLAIN
    calibration: Calibration | None = None
    scene: Scene = USUAL  # told for the left arm, or for both

    @property
    def joints(self) -> tuple[str, ...]:
        """The joints that are learned; a lesson of other ones is of no use."""
        return learned_joints(self.arms, self.mapping)

    @property
    def persons_sides(self) -> tuple[Side, ...]:
        """The person's arms that are followed, in the order of Baxter's that follow them."""
        sides = sides_of(self.arms)
        return tuple(other_side(side) for side in sides) if self.mirrored else sides

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
            self.scene,
        )

    @property
    def placed_scene(self) -> Scene:
        """The scene for the arms that are taught."""
        return self.scene.taught_by(self.arms)

    def start_world(self, scene: Scene | None = None) -> World:
        """Return a fresh world in which the robot waits, with the chosen scene unless given one."""
        return start_world(self.arms, self.mapping, self.hands, scene or self.scene)

    def starts_as(self, other: "Choices") -> bool:
        """Tell whether the robot waits in the same pose, with the same hands, in the same scene."""
        here = (self.arms, self.mapping, self.hands.gripper, self.scene)
        return here == (other.arms, other.mapping, other.hands.gripper, other.scene)

    def learns_as(self, other: "Choices") -> bool:
        """Tell whether what is learned is of use with both: the same joints, the same scene."""
        return (self.joints, self.scene) == (other.joints, other.scene)

    def in_scene(self, scene: Scene) -> "Choices":
        """Return these choices for another scene: with the arms and the hands that it takes.

        What only the scene before took is taken back.
        """
        before = self.scene
        one = "left" if before.both_arms else self.arms
        hands = self.hands
        if scene.gripper or before.gripper:
            hands = HandOptions(scene.gripper, scene.wrist)
        return replace(self, arms="both" if scene.both_arms else one, hands=hands, scene=scene)

    def configured(self, chosen: "Choices") -> "Choices":
        """Return what was chosen, with the calibration and the scene that there are.

        Raises
        ------
        StudioError
            Where the scene takes both arms, or a gripper, and this would take them away.
        """
        scene = self.scene
        if scene.both_arms and chosen.arms != "both":
            raise StudioError(f"The scene {scene.name} takes both arms: choose another one first")
        if scene.gripper and not chosen.hands.gripper:
            raise StudioError(f"The scene {scene.name} takes a gripper: choose another one first")
        return replace(chosen, calibration=self.calibration, scene=scene)
