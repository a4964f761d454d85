"""Progress of a diagnosis: in a terminal and in a notebook, nothing anywhere else."""

from __future__ import annotations

import sys
import time
from collections.abc import Callable
from types import TracebackType


class Steps:
    """Shows the step that is under way and the time that has passed; takes it away at the end."""

    def __init__(self, progress: bool | Callable[[str], object]) -> None:
        self._begun = time.monotonic()
        self._handle = None
        self.call: Callable[[str], object] | None = None
        if callable(progress):
            self.call = progress
        elif progress and _is_notebook():
            self.call = self._in_notebook
        elif progress and sys.stderr is not None and sys.stderr.isatty():
            self.call = self._in_terminal

    def __enter__(self) -> Steps:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        if self.call == self._in_terminal:
            print("\r\x1b[K", end="", file=sys.stderr, flush=True)
        if self._handle is not None:
            self._handle.update({"text/plain": ""}, raw=True)

    def _line(self, step: str) -> str:
        return f"{time.monotonic() - self._begun:.0f} s {step}"

    def _in_terminal(self, step: str) -> None:
        print(f"\r\x1b[K{self._line(step)}", end="", file=sys.stderr, flush=True)

    def _in_notebook(self, step: str) -> None:
        from IPython.display import display

        bundle = {"text/plain": self._line(step)}
        if self._handle is None:
            self._handle = display(bundle, raw=True, display_id=True)
        else:
            self._handle.update(bundle, raw=True)


def _is_notebook() -> bool:
    shell = sys.modules.get("IPython")
    running = shell and shell.get_ipython()
    return bool(running) and hasattr(running, "kernel")
