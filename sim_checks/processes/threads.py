"""One thread of linear algebra in every child: as many children as processors share them."""

import os
from collections.abc import Iterator
from contextlib import contextmanager
from threading import Lock

#: What OpenBLAS, OpenMP (torch, CoACD) and MKL read once, when they are loaded.
VARIABLES = ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS")

_changing = Lock()


def use_one_thread() -> None:
    """Have libraries that this process loads from now on compute with one thread.

    A number that the user has set stays.
    """
    for name in VARIABLES:
        os.environ.setdefault(name, "1")


@contextmanager
def one_thread() -> Iterator[None]:
    """Have processes started within this compute with one thread; this one is not changed."""
    with _changing:
        missing = [name for name in VARIABLES if name not in os.environ]
        use_one_thread()
        try:
            yield
        finally:
            for name in missing:
                del os.environ[name]
