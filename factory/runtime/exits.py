"""Exit codes that all commands share."""

from __future__ import annotations

#: Done.
OK = 0
#: Something was rejected, and the caller asked to be told so.
REJECTED = 1
#: Wrong usage.
USAGE = 2
#: Something could not be judged.
UNJUDGED = 3
#: Stopped by the user, as shells count it.
INTERRUPTED = 130
#: Stopped by whoever ends processes.
TERMINATED = 143
