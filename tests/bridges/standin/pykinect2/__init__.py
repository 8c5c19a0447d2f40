"""A stand-in for PyKinect2, built from its published names; it plays a file instead of a sensor."""
