"""What a page orders that may take a while."""

from __future__ import annotations

from typing import Any

from ebac._util.plural import plural
from ebac.live.session import Session


def carry_out(session: Session, message: dict[str, Any]) -> str:
    """Do what may take a while, one after the other; return a note for the pages."""
    match message["kind"]:
        case "change":
            again = session.change(**{message["name"]: message["value"]})
            return f"{message['name']} = {message['value']}: " + (
                "the loop was restarted" if again else "changed while it runs"
            )
        case "start":
            session.start()
            return ""
        case "pause":
            session.pause()
            return ""
        case "reset":
            session.reset()
            return "begun anew"
        case "record":
            if message["on"]:
                return f"recording to {session.record()}"
            return f"{plural(session.stop_recording(), 'row')} recorded"
        case _:
            return f"scenario saved as {session.save()}"
