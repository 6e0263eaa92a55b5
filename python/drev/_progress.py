"""Progress of a computation: in a terminal drev's own line on stderr, in a notebook a bar, otherwise nothing."""
import sys


def in_notebook():
    """Whether a notebook's kernel shows the results. IPython in a terminal is not a notebook."""
    module = sys.modules.get("IPython")
    shell = module.get_ipython() if module else None
    return shell is not None and hasattr(shell, "kernel")


def _left(seconds):
    if seconds < 90:
        return f"{seconds:.0f} s left"
    return f"{seconds / 60:.0f} min left" if seconds < 5400 else f"{seconds / 3600:.1f} h left"


class NotebookBar:
    """A progress bar that disappears when the computation has ended."""

    def __init__(self):
        self._handle = None

    def __call__(self, part, left):
        from IPython.display import HTML, display

        if self._handle is None and left < 1.0:
            return
        bar = HTML(f'<progress max="1" value="{part:.4f}" style="width:60%"></progress> {part:.1%}, {_left(left)}')
        if self._handle is None:
            self._handle = display(bar, display_id=True)
        else:
            self._handle.update(bar)

    def close(self):
        if self._handle is not None:
            from IPython.display import HTML

            self._handle.update(HTML(""))


class _Nothing:
    def __call__(self, part, left):
        pass


def told(progress):
    """The callable that the extension module calls; None: it draws its own line if stderr is a terminal."""
    if callable(progress):
        return progress
    if progress is False:
        return _Nothing()
    return NotebookBar() if in_notebook() else None


def close(bar):
    if isinstance(bar, NotebookBar):
        bar.close()
