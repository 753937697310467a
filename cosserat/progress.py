"""A progress bar of long work, in terminals and notebooks."""

from __future__ import annotations

import contextlib
import sys
import warnings
from collections.abc import Iterator

from cosserat.problem import Progress, silent

_AFTER, _EVERY = 1.0, 0.1  # seconds before a bar appears, and between its changes
_LOOK = "{desc}: {percentage:3.0f}%|{bar}| {elapsed}<{remaining}{postfix}"


@contextlib.contextmanager
def bar(title: str) -> Iterator[Progress]:
    """A function that reports progress as a bar of tqdm; the bar goes when the block ends.

    It appears after a second, if standard error is a terminal or the code runs in a notebook.  The environment
    variable TQDM_DISABLE=1 switches it off.
    """
    if not (sys.stderr.isatty() or _in_notebook()):
        yield silent
        return
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # that a notebook without ipywidgets has a bar of text
        from tqdm.auto import tqdm
    with tqdm(
        total=1.0,
        desc=title,
        bar_format=_LOOK,
        leave=False,
        delay=_AFTER,
        mininterval=_EVERY,
        miniters=0,
    ) as shown:

        def report(fraction: float, words: str) -> None:
            shown.set_postfix_str(words, refresh=False)
            shown.update(fraction - shown.n)

        yield report


def _in_notebook() -> bool:
    """Whether the code runs in a Jupyter kernel."""
    ipython = sys.modules.get("IPython")
    shell = None if ipython is None else ipython.get_ipython()
    return shell is not None and "IPKernelApp" in shell.config
