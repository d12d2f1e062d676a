"""The gains K_p and K_d of eq. (2): choose them, try them, compare them with the defaults."""

from ebac.identify.gains.gains import GainsResult, fit_gains
from ebac.identify.gains.trial import Limits

__all__ = ["GainsResult", "Limits", "fit_gains"]


def __dir__() -> list[str]:
    return __all__
