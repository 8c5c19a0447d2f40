"""What a browser gets before viser's page runs, and what it gets instead where it cannot draw."""

TITLE = "Baxter's teaching studio"
NO_WEBGL_PATH = "/no-webgl"

# Three.js, which draws the scene, asks for WebGL 2. We look at what it gets rather than ask first:
# a context of our own would cost a machine without a graphics card as much as the robot does.
_CHECK = f"""<script>
(function () {{
  var asked = HTMLCanvasElement.prototype.getContext;
  HTMLCanvasElement.prototype.getContext = function (kind) {{
    var context = asked.apply(this, arguments);
    if (kind === "webgl2" && context === null) location.replace("{NO_WEBGL_PATH.lstrip("/")}");
    return context;
  }};
}})();
</script>"""

# Keys of the palette are heard at the root element; viser's camera hears them above it, at the
# document, and would turn with every step on the timeline.
_STEPS_ONLY = """<script>
document.documentElement.addEventListener("keydown", function (event) {
  if (event.code === "ArrowLeft" || event.code === "ArrowRight") event.stopPropagation();
});
</script>"""

# A control that was clicked on would keep the keys: Space would press its button again, and Escape
# would not be heard from a box. Who goes through the page by Tab keeps them.
_KEYS_STAY_FREE = """<script>
(function () {
  addEventListener("pointerup", function (event) {
    setTimeout(function () {
      var held = document.activeElement;
      var chosen = event.target.closest && event.target.closest("[role=option]");
      if (held && (chosen || held.matches("button, [type=checkbox], [role=slider]"))) held.blur();
    });
  }, true);
  addEventListener("keydown", function (event) {
    var at = event.target;
    if (event.key !== "Escape" || !at.matches || !at.matches("input, textarea")) return;
    if (at.closest("[role=dialog]")) return;
    at.blur();
    var again = new KeyboardEvent("keydown", {key: "Escape", code: "Escape"});
    document.documentElement.dispatchEvent(again);
  }, true);
})();
</script>"""

NO_WEBGL = f"""<!doctype html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<title>{TITLE}: this browser cannot draw in 3D</title>
<style>
:root {{ color-scheme: light dark; }}
body {{ font: 1.1rem/1.5 system-ui, sans-serif; max-width: 42rem; margin: 8vh auto;
  padding: 0 1rem; }}
h1 {{ font-size: 1.6rem; }}
code {{ background: rgba(127, 127, 127, .2); padding: .1em .3em; border-radius: .2em; }}
a.again {{ display: inline-block; padding: .5em 1em; border-radius: .3em; background: #1c64b4;
  color: #fff; text-decoration: none; font-weight: 700; }}
</style>
</head>
<body>
<h1>⚠ This browser cannot draw Baxter</h1>
<p>The studio shows the robot in 3D, for which a browser needs <b>WebGL 2</b>. In this one it is
switched off or missing. The studio itself runs, and nothing of what was recorded is lost.</p>
<p>What helps, the quickest first:</p>
<ol>
<li>Open this page in another browser: a current Chrome, Edge, Firefox or Safari.</li>
<li>Chrome and Edge: Settings, System, switch on “Use graphics acceleration when available”, and
start the browser anew.</li>
<li>Firefox: open <code>about:config</code> and set <code>webgl.disabled</code> to
<code>false</code>.</li>
<li>On a machine without a graphics card, or far away: open the page on your own machine, through
<code>ssh -L 8080:127.0.0.1:8080 THE-OTHER-MACHINE</code>.</li>
<li>Without any browser: <code>studio demo --headless</code> teaches, learns and prints the
numbers.</li>
</ol>
<p><a class="again" href="./">Try again</a></p>
</body>
</html>
"""


def checked(page: str) -> str:
    """Return viser's page under our title, and first in it our own scripts."""
    head = page.find("<head>")
    if head < 0:
        return page
    begin = head + len("<head>")
    return (
        page[:begin]
        + _CHECK
        + _STEPS_ONLY
        + _KEYS_STAY_FREE
        + page[begin:].replace("<title>Viser</title>", f"<title>{TITLE}</title>", 1)
    )
