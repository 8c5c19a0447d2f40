"""Skeletons as they come: whoever sends them over a WebSocket, the newest frame wins."""
