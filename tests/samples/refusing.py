"""The refusal of a file, to be looked at."""

import pytest

from asset_factory.factory.errors import InputRejected
from asset_factory.sim_checks.description import DescriptionError


def refusal(call, *given, **settings):
    """What a call that has to reject its input says."""
    with pytest.raises(InputRejected) as caught:
        call(*given, **settings)
    return caught.value


def judges_refusal(call, *given, **settings):
    """What a reader of the judge's says that has to refuse its file."""
    with pytest.raises(DescriptionError) as caught:
        call(*given, **settings)
    return caught.value
