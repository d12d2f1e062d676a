"""A machine that stands still now and then: faults that only it can be the reason of, and a run that bears with it."""

import re

#: Faults of a loop on simulated hardware: a drive, a heartbeat or a force came too late, or the loop's own ticks did,
#: or a drive missed the loop's heartbeat, or skipped ticks gave out what the guard had, or a simulated handle made up
#: for time in which its thread stood still.
LATE = re.compile(
    r"fault (?:9 \(drive silent|10 \(drive emergency|11 \(heartbeat lost|14 \(overspeed"
    r"|16 \(force stale|19 \(overruns)\)"
    r"|error code 0x8130, heartbeat"
    r"|ticks? could not be kept and (?:was|were) skipped(?=[\s\S]*fault 21 \(starved)"
)


def patient_file(text: str) -> str:
    """Return the configuration of an example with limits that a late tick, drive or force does not reach."""
    if "overruns = 100000" in text:
        return text
    limits = "overruns = 100000\npause = 100.0\nforce_age = 10.0\njump = 1.0\nspeed = 100.0"
    for line, patient in ((r"\[bus\]", "[bus]\nsilent = 1000"), (r"speed = [\d.]+", limits)):
        text, found = re.subn(rf"(?m)^{line}", patient, text)
        assert found == 1, f"{line}: stands {found} times in the file, not once"
    return text
