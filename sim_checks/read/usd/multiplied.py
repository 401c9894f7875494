"""How many prims a short USD asset becomes once it is composed, counted before."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from typing import Any

from ...description import DescriptionError

#: Prims of a composed stage, those of instances among them.
MOST_PRIMS = 100_000
_LARGEST = 10**12


def refuse_multiplied(
    name: str, main: str, layers: Mapping[str, Any], named: Mapping[tuple[str, str], str]
) -> None:
    """Refuse an asset whose layers refer to each other so often that it becomes too much.

    Args:
        name: of its file, for the sentence.
        main: the layer to begin with, a key of ``layers``.
        layers: every ``Sdf.Layer`` of the asset.
        named: the layer that a reference in a layer means.

    Raises:
        DescriptionError: ``too_large``.
    """
    count = _PrimCount(layers, named).of_layer(main)
    if count > MOST_PRIMS:
        message = f"{name}: {count:,} prims once composed, at most {MOST_PRIMS:,} are read"
        raise DescriptionError("too_large", message)


class _PrimCount:
    """Counts what each prim brings once, however often it is referred to."""

    def __init__(self, layers: Mapping[str, Any], named: Mapping[tuple[str, str], str]) -> None:
        self._layers = layers
        self._named = named
        self._known: dict[tuple[str, str], int] = {}
        self._targets: dict[str, int] = {}

    def of_layer(self, layer: str) -> int:
        """Return how many prims a layer brings, with its sublayers."""
        return self._of(layer, self._layers[layer].pseudoRoot.path)

    def _of(self, layer: str, path: Any) -> int:
        """Return how many prims the one at a path of a layer brings, those below it included."""
        key = (layer, str(path))
        if key not in self._known:
            # What brings itself ends here; composition says what is wrong.
            self._known[key] = 0
            self._known[key] = min(_LARGEST, sum(self._brought(layer, path)))
        return self._known[key]

    def _brought(self, layer: str, path: Any) -> Iterator[int]:
        spec = self._layers[layer].GetObjectAtPath(path)
        yield 1
        yield from (self._of(layer, child.path) for child in spec.nameChildren)
        if path.IsAbsoluteRootPath():
            yield from map(self.of_layer, self._found(layer, self._layers[layer].subLayerPaths))
            return
        for options in spec.variantSets.values():
            variants = (self._of(layer, each.primSpec.path) for each in options.variantList)
            yield max(variants, default=0)
        for arcs in (spec.referenceList, spec.payloadList):
            for arc in arcs.GetAddedOrExplicitItems():
                if not arc.primPath.isEmpty:
                    yield self._target(arc.primPath)
                else:
                    # The default prim, which is one of the layer's.
                    inner = self._found(layer, [arc.assetPath]) if arc.assetPath else [layer]
                    yield from map(self.of_layer, inner)
        for paths in (spec.inheritPathList, spec.specializesList):
            yield from map(self._target, paths.GetAddedOrExplicitItems())

    def _target(self, path: Any) -> int:
        """Return the most that a path brings in any layer: which is meant, composing would tell."""
        key = str(path)
        if key not in self._targets:
            self._targets[key] = 0
            holding: list[str] = []
            while not holding and not path.isEmpty:
                # What a reference brings stands under no path of its own: all that holds it counts.
                holding = [name for name, own in self._layers.items() if own.GetObjectAtPath(path)]
                self._targets[key] = max((self._of(name, path) for name in holding), default=0)
                path = path.GetParentPath()
        return self._targets[key]

    def _found(self, layer: str, assets: Iterable[str]) -> list[str]:
        found = (self._named.get((layer, asset), "") for asset in assets)
        return [name for name in found if name in self._layers]
