"""The same examples every time: a failure that comes and goes with a seed or a busy machine proves nothing."""

from hypothesis import settings

settings.register_profile("repeatable", derandomize=True, deadline=None)
settings.load_profile("repeatable")
