"""The head on pairs: the same numbers and gradients as on concatenated pairs."""

import pytest
import torch  # noqa: TID253

from asset_factory.factory.models.network import transformer
from asset_factory.factory.models.network.layers import two_layers


@pytest.mark.parametrize("cached", [1, 1 << 18])
def test_pairs_and_their_gradients_are_those_of_the_concatenated_rows(monkeypatch, cached):
    monkeypatch.setattr(transformer, "_CACHED", cached)
    torch.manual_seed(0)
    head = two_layers(10, 7, 1).double()
    rows = torch.randn(3, 4, 5, dtype=torch.float64, requires_grad=True)
    columns = torch.randn(3, 6, 5, dtype=torch.float64, requires_grad=True)
    above = torch.randn(3, 4, 6, dtype=torch.float64)
    leaves = (rows, columns, *head.parameters())
    found = transformer.pair_logits(head, rows, columns)
    gradients = torch.autograd.grad((found * above).sum(), leaves)
    both = torch.cat(
        [rows[:, :, None].expand(-1, -1, 6, -1), columns[:, None].expand(-1, 4, -1, -1)], dim=-1
    )
    wanted = head(both)[..., 0]
    torch.testing.assert_close(found, wanted)
    torch.testing.assert_close(gradients, torch.autograd.grad((wanted * above).sum(), leaves))
