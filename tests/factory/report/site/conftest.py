import pytest
from browser import LAPTOP


@pytest.fixture
def opened(browser):
    """Opens a page; afterwards nothing may have been said on its console."""
    said = []
    contexts = []

    def show(address, *, ready="body.ready", **options):
        context = browser.new_context(viewport=LAPTOP, **options)
        contexts.append(context)
        page = context.new_page()
        page.on("console", lambda each: said.append(each.text) if each.type != "log" else None)
        page.on("pageerror", lambda error: said.append(str(error)))
        page.on(
            "request", lambda asked: said.append(asked.url) if "http" in asked.url[:5] else None
        )
        page.goto(address if isinstance(address, str) else address.as_uri())
        page.wait_for_selector(ready, timeout=60_000)
        return page

    yield show
    for context in contexts:
        context.close()
    assert said == []
