"""What the routes and the Streamlit pages of one server share."""

from dataclasses import dataclass

from app.server.laps import LapKeeper
from app.server.live.sessions import LiveSessions
from app.server.public_url import PublicUrl
from data.records import Clock
from data.store import Store, StoredStudy
from data.study import Study


@dataclass(frozen=True)
class Desk:
    """The study on offer, the store it goes to, the laps that are shown and the robots in people's hands.

    ``live`` is None where participants don't guide the robot themselves, ``public_url`` where browsers reach
    the server at the address it listens on.

    Streamlit runs its script anew for every click and gives it no argument, so the desk is kept in this
    module: `open_desk` puts it there before the first request, `desk` hands it out.
    """

    stored_study: StoredStudy
    store: Store
    laps: LapKeeper
    live: LiveSessions | None = None
    public_url: PublicUrl | None = None

    @property
    def study(self) -> Study:
        """The study's content."""
        return self.stored_study.study

    @property
    def clock(self) -> Clock:
        """The store's clock."""
        return self.store.clock


_open: list[Desk] = []


def open_desk(new: Desk) -> None:
    """Make this the desk of the process."""
    _open[:] = [new]


def desk() -> Desk:
    """The desk of the process."""
    return _open[0]
