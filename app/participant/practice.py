"""Practice: the robot in hand for the first time, before there is anything to compare."""

from app.participant.blinding import practice_data
from app.participant.comparison import to_robot
from app.participant.progress import Progress
from app.server.desk import Desk
from app.stage.stage import guide


def show(desk: Desk, progress: Progress) -> None:
    """The page to guide the robot on; it says that practice is done once that stands in the store."""
    guide(
        practice_data(desk.study, progress),
        key="practice",
        on_answer=to_robot,
        on_moved=to_robot,
        on_practised=to_robot,
    )
