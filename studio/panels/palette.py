"""The page's colors. None of them speaks alone: each stands beside a word or a shape.

The hand's states wear colors of Okabe and Ito's palette, which color-blind people tell apart.
"""

from studio.engine.skeleton import HandState

Color = tuple[int, int, int]  # red, green, blue, 0 to 255

BRAND: Color = (28, 100, 180)  # not red: that is the robot's, and recording's
GHOST: Color = (70, 120, 215)
ROBOT: Color = (205, 45, 40)
NETWORK: Color = (230, 140, 0)
MEAN: Color = (70, 70, 70)
ENVELOPE: Color = (140, 140, 140)
PROBLEM: Color = (150, 60, 0)

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
