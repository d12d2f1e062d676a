"""Files named after a law, a test or anything else that has a name."""

from __future__ import annotations

import re


def file_name(text: str, otherwise: str = "law") -> str:
    """Return a text as part of a file's name: "ebac, kp=0" is "ebac_kp_0"; `otherwise` where nothing is left."""
    return re.sub(r"[^\w.-]+", "_", text).strip("_.") or otherwise
