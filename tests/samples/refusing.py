"""The rejection of an input, to be looked at."""

import pytest

from asset_factory.factory.errors import InputRejected


def refusal(call, *given, **settings):
    """What a call that has to reject its input says."""
    with pytest.raises(InputRejected) as caught:
        call(*given, **settings)
    return caught.value
