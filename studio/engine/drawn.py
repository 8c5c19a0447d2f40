"""What a session looks like: its parts, each asked for its share of the snapshot."""

from dataclasses import dataclass

from studio.engine.activity import Activity, Follow
from studio.engine.calibrating import Calibrating
from studio.engine.choices import Choices
from studio.engine.collection import Collection
from studio.engine.comparing import Comparing
from studio.engine.driving import Driven, Driving
from studio.engine.exporting import Exporting
from studio.engine.learning import Learning
from studio.engine.links.linked import Linked
from studio.engine.listed import Listed
from studio.engine.pipeline import NO_LAG
from studio.engine.showing import Show
from studio.engine.snapshot import Message, Snapshot
from studio.engine.taking import Taking
from studio.engine.who_teaches import WhoTeaches


@dataclass(frozen=True, eq=False)
class Parts:
    """The parts of a session that a snapshot tells of; `drawn` asks them."""

    who: WhoTeaches
    listed: Listed
    collection: Collection
    learning: Learning
    comparing: Comparing
    exporting: Exporting
    taking: Taking
    linked: Linked
    driving: Driving

    def drawn(
        self, now: Activity, message: Message, choices: Choices, calibrated_with: str
    ) -> Snapshot:
        """Return the snapshot of what goes on ``now``."""
        following = now if isinstance(now, Follow) else None
        newest = following.newest if following else None
        watching = now if isinstance(now, Follow | Calibrating) else None
        shown = watching or self.who.chosen
        show = now if isinstance(now, Show) else None
        seen = show.seen if show else None
        return Snapshot(
            mode=self.learning.mode(now.mode),
            message=message,
            time=now.time,
            duration=now.duration,
            choices=choices,
            calibrated_with=calibrated_with,
            calibrating=now.progress if isinstance(now, Calibrating) else None,
            source=self.who.status(),
            live=self.who.live(watching.teacher if watching else None),
            who=self.who.shown(now),
            skeleton=seen.skeleton if seen else shown.skeleton if shown else None,
            gate=newest.gate if newest else None,
            held=newest.held if newest else "",
            guarded=now.guarded,
            lag=newest.lag if newest else NO_LAG,
            alone=show is not None and show.is_alone and show.is_playing,
            world=seen.world if seen else now.world.state,
            scene=show.film.scene if show else now.world.scene,
            entries=tuple(self.listed.entries),
            chosen=self.listed.index,
            collection=self.collection.status(),
            ghost=seen.ghost if seen else None,
            learning=self.learning.status,
            lesson=self.learning.lesson,
            reproduction=self.learning.reproduction,
            tryout=self.learning.tryout,
            compare=self.comparing.status(show, self.learning, self.listed),
            export=self.exporting.status,
            recorded=len(following.samples) if following else 0,
            saved_as=self.taking.saved_as,
            link=self.linked.status,
            driven=now.status if isinstance(now, Driven) else None,
            stopped=self.driving.is_stopped,
        )
