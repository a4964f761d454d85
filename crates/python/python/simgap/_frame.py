"""Tables for people: data frames and pages in a notebook."""

from __future__ import annotations

import html
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    import pandas

#: Height of a page in a notebook, pixels.
_HEIGHT = 720


def frame(columns: list[tuple[str, np.ndarray]]) -> pandas.DataFrame:
    """A data frame of the columns, which it keeps without a copy."""
    import pandas

    return pandas.DataFrame(dict(columns), copy=False)


def page_in_notebook(page: str) -> str:
    """A whole page inside a notebook: in a frame of its own, so that neither changes how the
    other looks.
    """
    source = html.escape(page, quote=True)
    return (
        f'<iframe srcdoc="{source}" sandbox="allow-scripts allow-popups allow-downloads" '
        f'style="width:100%;height:{_HEIGHT}px;border:1px solid #ccc"></iframe>'
    )
