"""Programs that run beside the studio, each one file for an environment of its own.

They turn a sensor into messages for the studio's socket and import nothing of the studio; nor does
the studio import them: it knows their paths only.
"""
