"""What every process that the server starts owes it: to leave Ctrl-C alone, and to go when it is gone."""

import multiprocessing
import os
import signal
import threading


def be_a_worker(niceness: int = 0) -> None:
    """Leave Ctrl-C to the parent, and go when the parent is gone however it went.

    Parameters
    ----------
    niceness : int
        Added to the process's own, as far as the system permits: below zero for what must not wait.
    """
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    threading.Thread(target=_follow_the_parent, daemon=True).start()
    if niceness and hasattr(os, "nice"):
        try:
            os.nice(niceness)
        except OSError:
            return


def _follow_the_parent() -> None:
    parent = multiprocessing.parent_process()
    if parent is not None:
        parent.join()
        # At once, whatever the other thread does and whatever a signal would mean to it.
        os._exit(1)
