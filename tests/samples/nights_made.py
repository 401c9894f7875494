"""Made-up attempts and nights."""

from asset_factory.factory.report.nightly.night import Night, NightResult, tally


def attempt(name, status="passed", *, digest="aaaaaaaaaa", reason=None, **more):
    """An attempt at ``meshes/<name>.glb``; what did not pass has a reason and a sentence."""
    reason = (
        reason
        if reason is not None
        else {"passed": "", "rejected": "jammed", "unjudged": "build_crashed"}[status]
    )
    said = f"{name} is {reason}" if reason else ""
    more.setdefault("message", said)
    return NightResult(f"{name}-{digest}", f"meshes/{name}.glb", status, reason, **more)


def night(name, attempts=(), **more):
    """The figures of a night with these attempts."""
    more.setdefault(
        "started",
        f"2026-11-{int(name):02d}T01:00:00Z" if name.isdecimal() else "2026-11-01T01:00:00Z",
    )
    return Night(name, found=len(attempts), **{**tally(attempts), **more})


#: One attempt of each kind, names that are hard to write included.
ATTEMPTS = (
    attempt(
        "a",
        seconds=12.345,
        stages={"load": 0.1, "validate": 2.0},
        parts=3,
        joints=2,
        hulls=40,
        license="CC0-1.0",
    ),
    attempt("b", "rejected", stages={"load": 0.2}, key="ab" * 32, started="2026-11-21T01:00:00Z"),
    attempt("c", attempts=0, reused=("build",)),
    attempt("ü\n\"',", "unjudged", attempts=2, reused=("decompose", "articulate")),
)
