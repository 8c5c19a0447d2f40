"""The page's colors. None of them speaks alone: each stands beside a word or a shape.

The hand's states wear colors of Okabe and Ito's palette, which color-blind people tell apart.
"""

from studio.engine.skeleton import HandState

Color = tuple[int, int, int]  # red, green, blue, 0 to 255

BRAND: Color = (28, 100, 180)  # not red: that is the robot's, and recording's
BRAND_IN_THE_DARK: Color = (64, 134, 219)
STOP: Color = (96, 104, 118)  # told from all other buttons on a light page and on a dark one
GHOST: Color = (70, 120, 215)
ROBOT: Color = (205, 45, 40)
NETWORK: Color = (230, 140, 0)
MEAN: Color = (118, 118, 118)
ENVELOPE: Color = (140, 140, 140)
PROBLEM: Color = (150, 60, 0)
LIMIT: Color = (185, 90, 30)
SECOND: Color = (120, 70, 170)  # what robot B does
STABLE: Color = (0, 120, 88)
PLAIN: Color = (213, 94, 0)
START: Color = (28, 100, 180)

HANDLE: Color = (28, 100, 180)  # of the puppet: what can be dragged
ARCS: tuple[Color, ...] = (  # of the arm's six angles, each beside its number
    (204, 121, 167),
    (0, 114, 178),
    (213, 94, 0),
    (0, 158, 115),
    (120, 94, 240),
    (90, 90, 90),
)

UNSEEN_HAND: Color = (150, 150, 150)
HAND: dict[HandState, Color] = {
    HandState.LASSO: (230, 159, 0),
    HandState.OPEN: (86, 180, 233),
    HandState.CLOSED: (0, 158, 115),
    HandState.UNKNOWN: UNSEEN_HAND,
    HandState.NOT_TRACKED: UNSEEN_HAND,
}


def css(color: Color, opacity: float = 1.0) -> str:
    """Return a color as a style sheet writes it."""
    red, green, blue = color
    return f"rgba({red},{green},{blue},{opacity:g})"
