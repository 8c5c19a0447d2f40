"""The studio's page, made with viser: panels send commands to the session and draw its snapshots.

A panel keeps no truth of its own. Its callbacks only put commands into the session's inbox, and its
``draw`` shows a snapshot, so that a reload or a second browser shows the same.
"""
