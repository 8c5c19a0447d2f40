"""Programs that reach the studio over a WebSocket, beside the browser or instead of it.

What they say and hear is `studio.remote`, which their side uses too. docs/remote.md is the guide.
"""
