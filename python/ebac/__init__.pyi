from ebac import (
    can as can,
)
from ebac import (
    datasets as datasets,
)
from ebac import (
    drives as drives,
)
from ebac import (
    explore as explore,
)
from ebac import (
    faults as faults,
)
from ebac import (
    gastroscope as gastroscope,
)
from ebac import (
    hands as hands,
)
from ebac import (
    hardware as hardware,
)
from ebac import (
    identify as identify,
)
from ebac import (
    laws as laws,
)
from ebac import (
    live as live,
)
from ebac import (
    logs as logs,
)
from ebac import (
    metrics as metrics,
)
from ebac import (
    operators as operators,
)
from ebac import (
    paper as paper,
)
from ebac import (
    peers as peers,
)
from ebac import (
    plot as plot,
)
from ebac import (
    presets as presets,
)
from ebac import (
    realtime as realtime,
)
from ebac import (
    scenario as scenario,
)
from ebac import (
    sensor as sensor,
)
from ebac import (
    simulation as simulation,
)
from ebac import (
    specs as specs,
)
from ebac import (
    studies as studies,
)
from ebac import (
    teleop as teleop,
)
from ebac import (
    testing as testing,
)
from ebac import (
    trace as trace,
)
from ebac import (
    tracking as tracking,
)
from ebac import (
    worlds as worlds,
)
from ebac._core import (
    EBA as EBA,
)
from ebac._core import (
    EBAC as EBAC,
)
from ebac._core import (
    ISS as ISS,
)
from ebac._core import (
    SFA as SFA,
)
from ebac._core import (
    TCA as TCA,
)
from ebac._core import (
    AdaptiveWindow as AdaptiveWindow,
)
from ebac._core import (
    BackwardDifference as BackwardDifference,
)
from ebac._core import (
    Capstan as Capstan,
)
from ebac._core import (
    Compensation as Compensation,
)
from ebac._core import (
    Corner as Corner,
)
from ebac._core import (
    Device as Device,
)
from ebac._core import (
    DeviceFacts as DeviceFacts,
)
from ebac._core import (
    Direct as Direct,
)
from ebac._core import (
    Disc as Disc,
)
from ebac._core import (
    Drive as Drive,
)
from ebac._core import (
    EBAAccount as EBAAccount,
)
from ebac._core import (
    EBACPrinted as EBACPrinted,
)
from ebac._core import (
    Encoder as Encoder,
)
from ebac._core import (
    Estimate as Estimate,
)
from ebac._core import (
    ExactPlant as ExactPlant,
)
from ebac._core import (
    Fallback as Fallback,
)
from ebac._core import (
    Fault as Fault,
)
from ebac._core import (
    ForceBounding as ForceBounding,
)
from ebac._core import (
    ForceSensor as ForceSensor,
)
from ebac._core import (
    Free as Free,
)
from ebac._core import (
    Gimbal as Gimbal,
)
from ebac._core import (
    Hand as Hand,
)
from ebac._core import (
    LagCompensator as LagCompensator,
)
from ebac._core import (
    Limited as Limited,
)
from ebac._core import (
    Limits as Limits,
)
from ebac._core import (
    Linear as Linear,
)
from ebac._core import (
    LoopState as LoopState,
)
from ebac._core import (
    LowPass as LowPass,
)
from ebac._core import (
    Mechanics as Mechanics,
)
from ebac._core import (
    MinimumJerk as MinimumJerk,
)
from ebac._core import (
    Motor as Motor,
)
from ebac._core import (
    Observer as Observer,
)
from ebac._core import (
    PassivityControl as PassivityControl,
)
from ebac._core import (
    Port as Port,
)
from ebac._core import (
    Recorded as Recorded,
)
from ebac._core import (
    RunLimits as RunLimits,
)
from ebac._core import (
    Sine as Sine,
)
from ebac._core import (
    SlidingGimbal as SlidingGimbal,
)
from ebac._core import (
    Step as Step,
)
from ebac._core import (
    SteppedPlant as SteppedPlant,
)
from ebac._core import (
    Tapping as Tapping,
)
from ebac._core import (
    TCADamped as TCADamped,
)
from ebac._core import (
    Timing as Timing,
)
from ebac._core import (
    VirtualCoupling as VirtualCoupling,
)
from ebac._core import (
    Wall as Wall,
)
from ebac._core import (
    copley_current as copley_current,
)
from ebac._core import (
    estimate_velocity as estimate_velocity,
)
from ebac._util.version import __version__ as __version__
from ebac.laws import (
    LAWS as LAWS,
)
from ebac.laws import (
    PythonLaw as PythonLaw,
)
from ebac.laws import (
    Variant as Variant,
)
from ebac.laws import (
    design as design,
)
from ebac.logs import (
    load as load,
)
from ebac.logs import (
    replay as replay,
)
from ebac.metrics import (
    Contact as Contact,
)
from ebac.metrics import (
    ObserverUse as ObserverUse,
)
from ebac.metrics import (
    contact as contact,
)
from ebac.metrics import (
    ideal_rest as ideal_rest,
)
from ebac.metrics import (
    observer_use as observer_use,
)
from ebac.operators import (
    Operators as Operators,
)
from ebac.scenario import (
    Scenario as Scenario,
)
from ebac.simulation import (
    DoubtWarning as DoubtWarning,
)
from ebac.simulation import (
    LoopFault as LoopFault,
)
from ebac.simulation import (
    simulate as simulate,
)
from ebac.specs import (
    Spec as Spec,
)
from ebac.specs import (
    spec_sheet as spec_sheet,
)
from ebac.studies import (
    CONDITIONS as CONDITIONS,
)
from ebac.studies import (
    Ablation as Ablation,
)
from ebac.studies import (
    Condition as Condition,
)
from ebac.studies import (
    Engines as Engines,
)
from ebac.studies import (
    RandomWorlds as RandomWorlds,
)
from ebac.studies import (
    Shapes as Shapes,
)
from ebac.studies import (
    Stiffest as Stiffest,
)
from ebac.studies import (
    Study as Study,
)
from ebac.studies import (
    Tissue as Tissue,
)
from ebac.studies import (
    Tuned as Tuned,
)
from ebac.studies import (
    TunedRow as TunedRow,
)
from ebac.studies import (
    TuningInterrupted as TuningInterrupted,
)
from ebac.studies import (
    Worst as Worst,
)
from ebac.studies import (
    ablation as ablation,
)
from ebac.studies import (
    engines as engines,
)
from ebac.studies import (
    random_worlds as random_worlds,
)
from ebac.studies import (
    shapes as shapes,
)
from ebac.studies import (
    stiffest as stiffest,
)
from ebac.studies import (
    study as study,
)
from ebac.studies import (
    tissue as tissue,
)
from ebac.studies import (
    tune as tune,
)
from ebac.studies import (
    worst as worst,
)
from ebac.studies.maps import (
    StabilityMap as StabilityMap,
)
from ebac.studies.maps import (
    stability_map as stability_map,
)
from ebac.studies.sweeps import (
    SweepInterrupted as SweepInterrupted,
)
from ebac.studies.sweeps import (
    SweepResult as SweepResult,
)
from ebac.studies.sweeps import (
    sweep as sweep,
)
from ebac.studies.zwidth import (
    ZWidth as ZWidth,
)
from ebac.studies.zwidth import (
    zwidth as zwidth,
)
from ebac.trace import (
    Trace as Trace,
)
from ebac.trace.columns import (
    ColumnInfo as ColumnInfo,
)
