"""The puppet: a stick person whose hands are dragged, for whoever has neither sensor nor camera."""

from studio.engine.puppet.puppet import Puppet, PuppetMemory
from studio.engine.puppet.teacher import PuppetTeacher

__all__ = ["Puppet", "PuppetMemory", "PuppetTeacher"]
