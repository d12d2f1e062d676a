"""Laws over whole populations of hands, under named conditions."""

from ebac.studies.ablation import Ablation, AblationRow, Piece, ablation, pieces
from ebac.studies.condition import Condition
from ebac.studies.conditions import CONDITIONS, GROUPS, conditions
from ebac.studies.engines import EngineRow, Engines, engines
from ebac.studies.hand_search import WorstHand
from ebac.studies.measures import MEASURES, Measure
from ebac.studies.random_worlds import random_worlds
from ebac.studies.random_worlds_result import RandomWorldRow, RandomWorlds
from ebac.studies.result import Failure, Study, StudyRow
from ebac.studies.shapes import ShapeRow, Shapes, shapes
from ebac.studies.stiffest import stiffest
from ebac.studies.stiffest_result import Stiffest, StiffestRow
from ebac.studies.study import study
from ebac.studies.tissue import Tissue, TissueRow, tissue
from ebac.studies.tuning import Tuned, TunedRow, TuningInterrupted, tune
from ebac.studies.worst import Worst, worst

__all__ = [
    "CONDITIONS",
    "GROUPS",
    "MEASURES",
    "Ablation",
    "AblationRow",
    "Condition",
    "EngineRow",
    "Engines",
    "Failure",
    "Measure",
    "Piece",
    "RandomWorldRow",
    "RandomWorlds",
    "ShapeRow",
    "Shapes",
    "Stiffest",
    "StiffestRow",
    "Study",
    "StudyRow",
    "Tissue",
    "TissueRow",
    "Tuned",
    "TunedRow",
    "TuningInterrupted",
    "Worst",
    "WorstHand",
    "ablation",
    "conditions",
    "engines",
    "pieces",
    "random_worlds",
    "shapes",
    "stiffest",
    "study",
    "tissue",
    "tune",
    "worst",
]


def __dir__() -> list[str]:
    return __all__
