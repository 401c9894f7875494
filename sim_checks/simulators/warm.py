"""Imported by the fork server once per job, since SAPIEN takes over a second to import."""

import warnings
from contextlib import suppress

with warnings.catch_warnings(), suppress(ImportError):
    # That there is no Vulkan is no news for physics.
    warnings.simplefilter("ignore")
    import sapien  # noqa: F401 - importing it is the purpose
