"""``studio link check``: what can be found out of a robot in ten minutes, before it is used."""

import sys
import threading
from dataclasses import asdict, dataclass
from typing import Annotated, Literal

import tyro

from studio.console import as_json_text, log
from studio.engine.clock import now, wait_until
from studio.engine.errors import StudioError
from studio.engine.links.address import EXAMPLES, link_at
from studio.engine.links.check import Finding, Looking, look
from studio.engine.links.driver import LinkThread
from studio.engine.links.moving_check import MovingCheck
from studio.engine.robot import CONTROL_PERIOD
from studio.engine.skeleton import Side

_SIGNS = {True: "pass", False: "FAIL", None: "look"}
_QUESTION = (
    "The {side} arm will move, one joint after the other by 6 degrees, slowly. Is nobody within "
    "its reach, is the way free, is the emergency stop in your hand? Type yes: "
)


@dataclass(frozen=True)
class Link:
    """Look at a robot beyond the simulator: connection, joints, limits, stops. Moves nothing."""

    what: Annotated[Literal["check"], tyro.conf.Positional]
    """check: step by step, what can be found out of it before it is used."""
    robot: Annotated[str, tyro.conf.Positional, tyro.conf.arg(metavar="URL", help=EXAMPLES)]
    move: bool = False
    """Then move each joint of an arm by 6 degrees and back, once you have confirmed it."""
    arm: Side = "left"
    """The arm that --move moves."""
    json: bool = False
    """Print one JSON object."""

    def run(self) -> int:
        """Check; the status is 1 where something failed."""
        thread = LinkThread(link_at(self.robot, now), now)
        try:
            findings = self._findings(Looking(thread, now, _tick))
        finally:
            thread.close()
        passed = all(each.passed is not False for each in findings)
        if self.json:
            told = {"robot": self.robot, "passed": passed}
            print(as_json_text(told | {"findings": [asdict(each) for each in findings]}))
        else:
            print(_table(findings))
        return 0 if passed else 1

    def _findings(self, looking: Looking) -> list[Finding]:
        findings = []
        for finding in look(looking):
            findings.append(_told(finding))
        if not self.move:
            log("nothing was moved: --move tries each joint, the watchdog and the stops")
            return findings
        if any(each.passed is False for each in findings):
            log("nothing is moved, for something failed")
            return findings
        if _answer(_QUESTION.format(side=self.arm)) != "yes":
            raise StudioError("nothing was moved: that was no yes")
        for finding in MovingCheck(looking, self.arm, _ask).findings():
            findings.append(_told(finding))
        return findings


def _table(findings: list[Finding]) -> str:
    """Return all findings as lines of words."""
    width = max(len(each.name) for each in findings)
    return "\n".join(
        f"{_SIGNS[each.passed]}  {each.name:<{width}}  {each.words}" for each in findings
    )


def _told(finding: Finding) -> Finding:
    """Tell a finding as soon as there is one."""
    log(f"{finding.name}: {_SIGNS[finding.passed]}")
    return finding


def _ask(question: str) -> bool | None:
    """Ask a person; None where none sits there."""
    if not sys.stdin.isatty():
        return None
    return _answer(f"{question} [y/n] ").startswith("y")


def _answer(question: str) -> str:
    print(f"studio: {question}", end="", file=sys.stderr, flush=True)
    return sys.stdin.readline().strip().lower()


def _tick() -> None:
    wait_until(now() + CONTROL_PERIOD, threading.Event())
