"""
The C++ core of ebac. Use it through the package `ebac`.
"""

from __future__ import annotations

import collections.abc
import enum
import os
import typing

import numpy
import numpy.typing

import ebac.hands
import ebac.hardware
import ebac.laws

__all__: list[str] = [
    "EBA",
    "EBAC",
    "FEWEST_ROWS",
    "ISS",
    "QUIET_PERCEIVED",
    "REFUSED_LOAD",
    "SFA",
    "STILL_SWING",
    "TAIL_SHARE",
    "TCA",
    "WARNED_LOAD",
    "AdaptiveWindow",
    "ArmGains",
    "ArmRecord",
    "AxisTruth",
    "BackwardDifference",
    "Box",
    "BridgeParams",
    "BusCounts",
    "BusLoad",
    "BusState",
    "CanFrame",
    "Capstan",
    "Capsule",
    "Column",
    "Compensation",
    "Corner",
    "Coupling",
    "Cylinder",
    "Device",
    "DeviceFacts",
    "Direct",
    "Disc",
    "Drive",
    "DriveCondition",
    "DriveState",
    "DriveWiring",
    "EBAAccount",
    "EBACPrinted",
    "Elastic",
    "EmulatorCounts",
    "EmulatorOptions",
    "EmulatorTrouble",
    "Encoder",
    "EngineTiming",
    "Estimate",
    "ExactPlant",
    "Fallback",
    "FarLink",
    "Fault",
    "Field",
    "FingerPad",
    "Follow",
    "ForceBounding",
    "ForceSensor",
    "Free",
    "FtScale",
    "Gears",
    "Gimbal",
    "Grant",
    "Hand",
    "HuntCrossley",
    "Joystick",
    "LagCompensator",
    "Layer",
    "LetGo",
    "Limited",
    "Limits",
    "Linear",
    "LinearLoop",
    "Link",
    "LinkState",
    "LoopState",
    "LoopbackBus",
    "LoopbackHub",
    "LoopbackJoystick",
    "LowPass",
    "Master",
    "Mechanics",
    "MinimumJerk",
    "Motor",
    "NonlinearGrip",
    "Observer",
    "PassivityControl",
    "Patient",
    "Physician",
    "Plane",
    "PlannedFrame",
    "Polyp",
    "Port",
    "RdtClient",
    "RdtEmulator",
    "RdtSetup",
    "RealTime",
    "RealTimeMode",
    "Recorded",
    "Reflex",
    "ReplayLog",
    "Rows",
    "RunLimits",
    "RunPlan",
    "RunSetup",
    "Running",
    "Scope",
    "SensorModel",
    "SensorStatus",
    "Setup",
    "SharedForce",
    "SharedHandTarget",
    "SimulatedDrive",
    "SimulatedWire",
    "Sine",
    "SlaveModel",
    "SlidingGimbal",
    "SocketCan",
    "SocketCanJoystick",
    "Sphere",
    "Step",
    "SteppedPlant",
    "SteppedRun",
    "SweepProgress",
    "Swing",
    "TCADamped",
    "Tapping",
    "TeleopPacket",
    "Texture",
    "TimedBus",
    "Timing",
    "Torus",
    "VirtualCoupling",
    "Wall",
    "copley_current",
    "estimate_velocity",
    "least_bits",
    "pdo_plan",
    "worst_bits",
]

class Field:
    """
    One parameter or column: name, unit, meaning, default, range.
    """
    def __repr__(self) -> str: ...
    @property
    def default(self) -> typing.Any:
        """
        Default.
        """
    @property
    def high(self) -> float:
        """
        Largest value allowed.
        """
    @property
    def kind(self) -> str:
        """
        Python type.
        """
    @property
    def low(self) -> float:
        """
        Smallest value allowed.
        """
    @property
    def meaning(self) -> str:
        """
        Meaning.
        """
    @property
    def name(self) -> str:
        """
        Name.
        """
    @property
    def unit(self) -> str:
        """
        SI unit; '1' for a pure number.
        """

class Fault(enum.IntEnum):
    """
    Why a loop stopped; the first one latches.
    """

    BUS_DOWN = ...
    DEVICE = ...
    DRIVE_DISABLED = ...
    DRIVE_EMERGENCY = ...
    DRIVE_FAULT = ...
    DRIVE_SILENT = ...
    DUPLICATE_NODE = ...
    ENCODER_FROZEN = ...
    ENCODER_JUMP = ...
    ENVIRONMENT_NOT_FINITE = ...
    FORCE_DISCONNECTED = ...
    FORCE_ERROR = ...
    FORCE_NOT_FINITE = ...
    FORCE_SATURATED = ...
    FORCE_STALE = ...
    HEARTBEAT_LOST = ...
    LAW_NOT_FINITE = ...
    MOTION_IMPLAUSIBLE = ...
    NONE = ...
    OVERRUNS = ...
    OVERSPEED = ...
    POSITION_NOT_FINITE = ...
    SECOND_MASTER = ...
    STARVED = ...
    TORQUE_MISMATCH = ...
    TORQUE_NOT_FINITE = ...
    TORQUE_REVERSED = ...
    WORKSPACE = ...

class LoopState(enum.IntEnum):
    """
    State of a loop.
    """

    ARM = ...
    FAULT = ...
    IDLE = ...
    RUN = ...
    STOP = ...

class Limited(enum.IntFlag):
    """
    Reasons for which a current was limited in a tick.
    """

    EDGE = ...
    NOT_FINITE = ...
    PEAK = ...
    RAMP = ...
    SLEW = ...
    THERMAL = ...

class Fallback(enum.IntEnum):
    """
    Why the observer's estimate is not used in a tick.
    """

    ACCOUNT = ...
    FORCE_STALE = ...
    FORCE_STATUS = ...
    MODEL = ...
    NONE = ...
    OFF = ...

class EngineTiming:
    """
    When an engine is called, and when it answers.

    Parameters
    ----------
    rate : float
        calls of the engine [Hz], 1 to 1000.
    compute : float
        from a call to its answer, at least [s], 0 to 1.
    jitter : float
        more than that, by up to so much at random [s], 0 to 1.
    seed : int
        of the jitter, 0 to 9e+15.
    """

    @staticmethod
    def fields() -> list[Field]:
        """
        Return name, unit, meaning, default and range of every parameter.
        """
    def __eq__(self, other: typing.Any) -> bool: ...
    def __hash__(self) -> int: ...
    def __init__(
        self, *, rate: float = 60.0, compute: float = 0.0, jitter: float = 0.0, seed: int = 1
    ) -> None: ...
    def __reduce__(self) -> tuple[typing.Any, ...]: ...
    def __repr__(self) -> str: ...
    def as_dict(self) -> dict[str, typing.Any]:
        """
        Return the parameters by name.
        """
    def replace(self, **changes: typing.Any) -> typing.Self:
        """
        Return a copy with some parameters changed, checked as at construction.
        """
    @property
    def compute(self) -> float:
        """
        from a call to its answer, at least [s], 0 to 1
        """
    @property
    def jitter(self) -> float:
        """
        more than that, by up to so much at random [s], 0 to 1
        """
    @property
    def rate(self) -> float:
        """
        calls of the engine [Hz], 1 to 1000
        """
    @property
    def seed(self) -> int:
        """
        of the jitter, 0 to 9e+15
        """

class Estimate:
    """
    State of a device at one port, as the observer estimates it.

    Parameters
    ----------
    x : float
        handle position, estimated [m].
    dx : float
        its change since the last tick [m].
    v : float
        handle velocity, estimated [m/s].
    x_act : float
        handle position predicted for the instant at which this tick's command acts [m].
    v_act : float
        handle velocity predicted for that instant [m/s].
    disturbance : float
        force that the model of the device does not explain: friction, weight, sensor bias [N].
    bound : float
        largest error of x that the encoder allows, apart from an offset that stays the same: the phase of its counts, half a count at most, which no reading shows; for a rigid device [m].
    weight : float
        share of the estimate in what the law is given: 1 the observer, 0 the encoder alone.
    fallback : int
        0, or why the weight goes to 0: 1 off, 2 force stale, 3 force sensor status, 4 model contradicted, 5 account drained.
    """

    @staticmethod
    def fields() -> list[Field]:
        """
        Return name, unit, meaning, default and range of every parameter.
        """
    def __eq__(self, other: typing.Any) -> bool: ...
    def __hash__(self) -> int: ...
    def __init__(
        self,
        *,
        x: float = 0.0,
        dx: float = 0.0,
        v: float = 0.0,
        x_act: float = 0.0,
        v_act: float = 0.0,
        disturbance: float = 0.0,
        bound: float = 0.0,
        weight: float = 0.0,
        fallback: int = 1,
    ) -> None: ...
    def __reduce__(self) -> tuple[typing.Any, ...]: ...
    def __repr__(self) -> str: ...
    def as_dict(self) -> dict[str, typing.Any]:
        """
        Return the parameters by name.
        """
    def replace(self, **changes: typing.Any) -> typing.Self:
        """
        Return a copy with some parameters changed, checked as at construction.
        """
    @property
    def bound(self) -> float:
        """
        largest error of x that the encoder allows, apart from an offset that stays the same: the phase of its counts, half a count at most, which no reading shows; for a rigid device [m]
        """
    @property
    def disturbance(self) -> float:
        """
        force that the model of the device does not explain: friction, weight, sensor bias [N]
        """
    @property
    def dx(self) -> float:
        """
        its change since the last tick [m]
        """
    @property
    def fallback(self) -> int:
        """
        0, or why the weight goes to 0: 1 off, 2 force stale, 3 force sensor status, 4 model contradicted, 5 account drained
        """
    @property
    def v(self) -> float:
        """
        handle velocity, estimated [m/s]
        """
    @property
    def v_act(self) -> float:
        """
        handle velocity predicted for that instant [m/s]
        """
    @property
    def weight(self) -> float:
        """
        share of the estimate in what the law is given: 1 the observer, 0 the encoder alone
        """
    @property
    def x(self) -> float:
        """
        handle position, estimated [m]
        """
    @property
    def x_act(self) -> float:
        """
        handle position predicted for the instant at which this tick's command acts [m]
        """

class Port:
    """
    Input of a law: one axis in one tick.

    Parameters
    ----------
    x : float
        handle position; grows into the wall [m].
    dx : float
        displacement since the last tick [m].
    v : float
        handle velocity, estimated [m/s].
    dt : float
        time since the last tick [s].
    f_env : float
        force the virtual world asks for (F_e) [N].
    f_cmd : float
        force the law commands (F_d, force loop included) [N].
    f_applied : float
        force that acted over the last interval, after limits and delay [N].
    f_meas : float
        force the F/T sensor measures (F_M) [N].
    work : float
        energy the virtual side absorbed, sum of f_applied dx without static compensation; dx of the observer where there is one [J].
    unsure : float
        largest error of work: the position's, half a count or est.bound, times every change of the force; for a rigid device [J].
    damped : float
        energy the device's known damping took: with the observer sum of b v^2 dt, estimated; without at least sum of (b/dt) max(|dx| - count, 0)^2 [J].
    world_v : float
        velocity of the virtual world's surface, where it moves and declares it [m/s].
    """

    @staticmethod
    def fields() -> list[Field]:
        """
        Return name, unit, meaning, default and range of every parameter.
        """
    def __eq__(self, other: typing.Any) -> bool: ...
    def __hash__(self) -> int: ...
    def __init__(
        self,
        *,
        x: float = 0.0,
        dx: float = 0.0,
        v: float = 0.0,
        dt: float = 0.0,
        f_env: float = 0.0,
        f_cmd: float = 0.0,
        f_applied: float = 0.0,
        f_meas: float = 0.0,
        work: float = 0.0,
        unsure: float = 0.0,
        damped: float = 0.0,
        world_v: float = 0.0,
    ) -> None: ...
    def __reduce__(self) -> tuple[typing.Any, ...]: ...
    def __repr__(self) -> str: ...
    def as_dict(self) -> dict[str, typing.Any]:
        """
        Return the parameters by name.
        """
    def replace(self, **changes: typing.Any) -> typing.Self:
        """
        Return a copy with some parameters changed, checked as at construction.
        """
    @property
    def damped(self) -> float:
        """
        energy the device's known damping took: with the observer sum of b v^2 dt, estimated; without at least sum of (b/dt) max(|dx| - count, 0)^2 [J]
        """
    @damped.setter
    def damped(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def dt(self) -> float:
        """
        time since the last tick [s]
        """
    @dt.setter
    def dt(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def dx(self) -> float:
        """
        displacement since the last tick [m]
        """
    @dx.setter
    def dx(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def est(self) -> Estimate:
        """
        State that the observer estimates.
        """
    @est.setter
    def est(self, arg0: Estimate) -> None: ...
    @property
    def f_applied(self) -> float:
        """
        force that acted over the last interval, after limits and delay [N]
        """
    @f_applied.setter
    def f_applied(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def f_cmd(self) -> float:
        """
        force the law commands (F_d, force loop included) [N]
        """
    @f_cmd.setter
    def f_cmd(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def f_env(self) -> float:
        """
        force the virtual world asks for (F_e) [N]
        """
    @f_env.setter
    def f_env(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def f_meas(self) -> float:
        """
        force the F/T sensor measures (F_M) [N]
        """
    @f_meas.setter
    def f_meas(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def unsure(self) -> float:
        """
        largest error of work: the position's, half a count or est.bound, times every change of the force; for a rigid device [J]
        """
    @unsure.setter
    def unsure(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def v(self) -> float:
        """
        handle velocity, estimated [m/s]
        """
    @v.setter
    def v(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def work(self) -> float:
        """
        energy the virtual side absorbed, sum of f_applied dx without static compensation; dx of the observer where there is one [J]
        """
    @work.setter
    def work(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def world_v(self) -> float:
        """
        velocity of the virtual world's surface, where it moves and declares it [m/s]
        """
    @world_v.setter
    def world_v(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def x(self) -> float:
        """
        handle position; grows into the wall [m]
        """
    @x.setter
    def x(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...

class Timing:
    """
    Timing for which a law is designed.

    Parameters
    ----------
    dt : float
        sample time [s], 1e-05 to 0.1.
    delay : int
        ticks from computing a command to its acting; 1 is a synchronous CAN drive [samples], 0 to 8.
    jitter : float
        largest deviation of a tick from its instant, over the sample time, that laws count with, 0 to 0.45.
    """
    @staticmethod
    def fields() -> list[Field]:
        """
        Return name, unit, meaning, default and range of every parameter.
        """
    def __eq__(self, other: typing.Any) -> bool: ...
    def __hash__(self) -> int: ...
    def __init__(self, *, dt: float = 0.001, delay: int = 1, jitter: float = 0.0) -> None: ...
    def __reduce__(self) -> tuple[typing.Any, ...]: ...
    def __repr__(self) -> str: ...
    def as_dict(self) -> dict[str, typing.Any]:
        """
        Return the parameters by name.
        """
    def replace(self, **changes: typing.Any) -> typing.Self:
        """
        Return a copy with some parameters changed, checked as at construction.
        """
    @property
    def delay(self) -> int:
        """
        ticks from computing a command to its acting; 1 is a synchronous CAN drive [samples], 0 to 8
        """
    @property
    def dt(self) -> float:
        """
        sample time [s], 1e-05 to 0.1
        """
    @property
    def jitter(self) -> float:
        """
        largest deviation of a tick from its instant, over the sample time, that laws count with, 0 to 0.45
        """

class DeviceFacts:
    """
    Facts about a device from which laws are designed.

    Parameters
    ----------
    damping : float
        lower bound of the physical viscous damping at the handle, after compensation [N s/m], -500 to 500.
    mass : float
        mass felt at the handle; right to a few per cent [kg], 0.001 to 100.
    count : float
        one encoder count at the handle [m], 0 to 0.01.
    current_lag : float
        time constant of the drive's current loop [s], 0 to 0.1.
    peak_force : float
        largest force the motor can give [N], 0.001 to 10000.
    resonance : float
        first resonance of the structure, handle held; 0 where none is known [Hz], 0 to 10000.
    force_noise : float
        standard deviation of the force sensor's noise; less than 0.03 N counts as that [N], 0 to 10.
    force_sensor : bool
        whether there is a force sensor; without one gains of a force loop are 0.
    """

    @staticmethod
    def fields() -> list[Field]:
        """
        Return name, unit, meaning, default and range of every parameter.
        """
    def __eq__(self, other: typing.Any) -> bool: ...
    def __hash__(self) -> int: ...
    def __init__(
        self,
        *,
        damping: float = 2.0,
        mass: float = 0.25,
        count: float = 3.07e-05,
        current_lag: float = 0.0003,
        peak_force: float = 42.4,
        resonance: float = 0.0,
        force_noise: float = 0.03,
        force_sensor: bool = True,
    ) -> None: ...
    def __reduce__(self) -> tuple[typing.Any, ...]: ...
    def __repr__(self) -> str: ...
    def as_dict(self) -> dict[str, typing.Any]:
        """
        Return the parameters by name.
        """
    def replace(self, **changes: typing.Any) -> typing.Self:
        """
        Return a copy with some parameters changed, checked as at construction.
        """
    @property
    def count(self) -> float:
        """
        one encoder count at the handle [m], 0 to 0.01
        """
    @property
    def current_lag(self) -> float:
        """
        time constant of the drive's current loop [s], 0 to 0.1
        """
    @property
    def damping(self) -> float:
        """
        lower bound of the physical viscous damping at the handle, after compensation [N s/m], -500 to 500
        """
    @property
    def force_noise(self) -> float:
        """
        standard deviation of the force sensor's noise; less than 0.03 N counts as that [N], 0 to 10
        """
    @property
    def force_sensor(self) -> bool:
        """
        whether there is a force sensor; without one gains of a force loop are 0
        """
    @property
    def mass(self) -> float:
        """
        mass felt at the handle; right to a few per cent [kg], 0.001 to 100
        """
    @property
    def peak_force(self) -> float:
        """
        largest force the motor can give [N], 0.001 to 10000
        """
    @property
    def resonance(self) -> float:
        """
        first resonance of the structure, handle held; 0 where none is known [Hz], 0 to 10000
        """

class RealTimeMode(enum.IntEnum):
    """
    Treatment of refused real-time resources.
    """

    AUTO = ...
    ENFORCE = ...
    OFF = ...

class RealTime:
    """
    Real-time resources for the thread of a loop.

    Parameters
    ----------
    priority : int
        priority under SCHED_FIFO, 1 to 99.
    cpu : int
        the CPU it stays on; -1 for any, -1 to 1023.
    lock_memory : bool
        keep all pages of the process in memory (mlockall), 0 to 1.
    stack : int
        stack touched before the start; 0 for none [bytes], 0 to 4194304.
    stay_awake : bool
        keep idle CPUs from sleeping while it runs (/dev/cpu_dma_latency), 0 to 1.
    """
    @staticmethod
    def fields() -> list[Field]:
        """
        Return name, unit, meaning, default and range of every parameter.
        """
    def __eq__(self, other: typing.Any) -> bool: ...
    def __hash__(self) -> int: ...
    def __init__(
        self,
        *,
        priority: int = 80,
        cpu: int = -1,
        lock_memory: bool = True,
        stack: int = 262144,
        stay_awake: bool = True,
    ) -> None: ...
    def __reduce__(self) -> tuple[typing.Any, ...]: ...
    def __repr__(self) -> str: ...
    def as_dict(self) -> dict[str, typing.Any]:
        """
        Return the parameters by name.
        """
    def replace(self, **changes: typing.Any) -> typing.Self:
        """
        Return a copy with some parameters changed, checked as at construction.
        """
    @property
    def cpu(self) -> int:
        """
        the CPU it stays on; -1 for any, -1 to 1023
        """
    @property
    def lock_memory(self) -> bool:
        """
        keep all pages of the process in memory (mlockall), 0 to 1
        """
    @property
    def priority(self) -> int:
        """
        priority under SCHED_FIFO, 1 to 99
        """
    @property
    def stack(self) -> int:
        """
        stack touched before the start; 0 for none [bytes], 0 to 4194304
        """
    @property
    def stay_awake(self) -> bool:
        """
        keep idle CPUs from sleeping while it runs (/dev/cpu_dma_latency), 0 to 1
        """

class Grant:
    """
    One resource that a thread requested from the system.
    """
    def __init__(self, *, name: str, asked: str, granted: bool, why: str, remedy: str) -> None: ...
    def __repr__(self) -> str: ...
    @property
    def asked(self) -> str:
        """
        Requested resource.
        """
    @property
    def granted(self) -> bool:
        """
        Whether it was granted.
        """
    @property
    def name(self) -> str:
        """
        priority, cpu, memory, stack or sleep.
        """
    @property
    def remedy(self) -> str:
        """
        The command that would grant it.
        """
    @property
    def why(self) -> str:
        """
        Reason of a refusal; empty if granted.
        """

class SharedHandTarget:
    """
    Target of a simulated hand, from a loop to the simulation of the hand in another thread
    or another process, which opens it by its descriptor. One writer, one reader.
    """
    @typing.overload
    def __init__(self) -> None: ...
    @typing.overload
    def __init__(self, descriptor: typing.SupportsInt | typing.SupportsIndex) -> None: ...
    def post(
        self,
        target: typing.Annotated[
            collections.abc.Sequence[typing.SupportsFloat | typing.SupportsIndex], "FixedSize(3)"
        ],
    ) -> None:
        """
        Set the target [m] per axis; NaN leaves an axis unchanged.
        """
    @property
    def descriptor(self) -> int:
        """
        File descriptor to pass to another process.
        """

class Linear:
    """
    n independent axes, x = R q: the device of eq. (6).

    Parameters
    ----------
    axes : int
        number of independent axes, 1 to 3.
    radius : float
        lever radius: travel per joint angle [m], 1e-04 to 10.
    limit : float
        largest joint angle either way [rad], 0.001 to 1000.
    """
    @staticmethod
    def fields() -> list[Field]:
        """
        Return name, unit, meaning, default and range of every parameter.
        """
    def __eq__(self, other: typing.Any) -> bool: ...
    def __hash__(self) -> int: ...
    def __init__(
        self, *, axes: int = 1, radius: float = 0.1, limit: float = 0.5235987755982988
    ) -> None: ...
    def __reduce__(self) -> tuple[typing.Any, ...]: ...
    def __repr__(self) -> str: ...
    def as_dict(self) -> dict[str, typing.Any]:
        """
        Return the parameters by name.
        """
    def forward(
        self, q: collections.abc.Sequence[typing.SupportsFloat | typing.SupportsIndex]
    ) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"]:
        """
        Return the handle position [m] at joint angles q [rad], shape (axes,).
        """
    def inverse(
        self, x: collections.abc.Sequence[typing.SupportsFloat | typing.SupportsIndex]
    ) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"]:
        """
        Return the joint angles [rad] at handle position x [m], shape (axes,).
        """
    def jacobian(
        self, q: collections.abc.Sequence[typing.SupportsFloat | typing.SupportsIndex]
    ) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]"]:
        """
        Return the Jacobian dx/dq [m/rad] at q [rad], shape (axes, axes).
        """
    def replace(self, **changes: typing.Any) -> typing.Self:
        """
        Return a copy with some parameters changed, checked as at construction.
        """
    def transpose(
        self,
        q: collections.abc.Sequence[typing.SupportsFloat | typing.SupportsIndex],
        f: collections.abc.Sequence[typing.SupportsFloat | typing.SupportsIndex],
    ) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"]:
        """
        Return the joint torques J^T f [N m] of a handle force f [N].
        """
    def within_limits(
        self, q: collections.abc.Sequence[typing.SupportsFloat | typing.SupportsIndex]
    ) -> bool:
        """
        Return whether every joint is within its limit.
        """
    @property
    def axes(self) -> int:
        """
        Number of axes.
        """
    @property
    def limit(self) -> float:
        """
        largest joint angle either way [rad], 0.001 to 1000
        """
    @property
    def radius(self) -> float:
        """
        lever radius: travel per joint angle [m], 1e-04 to 10
        """
    @property
    def stops(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"]:
        """
        Largest angle of each joint either way [rad], shape (axes,).
        """
    @property
    def travel(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"]:
        """
        Way of the handle per angle of each joint, in the middle [m], shape (axes,).
        """

class Gimbal:
    """
    The paper's joystick: a lever of radius R on two crossed axes.

    x = R sin q1 cos q2, y = R sin q2, z = R cos q1 cos q2.

    Parameters
    ----------
    radius : float
        lever radius (paper, IV.A) [m], 1e-04 to 10.
    limit : float
        largest angle of each joint either way, eq. (11) [rad], 0.001 to 1.5.
    """
    @staticmethod
    def fields() -> list[Field]:
        """
        Return name, unit, meaning, default and range of every parameter.
        """
    def __eq__(self, other: typing.Any) -> bool: ...
    def __hash__(self) -> int: ...
    def __init__(self, *, radius: float = 0.1, limit: float = 0.5235987755982988) -> None: ...
    def __reduce__(self) -> tuple[typing.Any, ...]: ...
    def __repr__(self) -> str: ...
    def as_dict(self) -> dict[str, typing.Any]:
        """
        Return the parameters by name.
        """
    def forward(
        self, q: collections.abc.Sequence[typing.SupportsFloat | typing.SupportsIndex]
    ) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"]:
        """
        Return the handle position [m] at joint angles q [rad], shape (axes,).
        """
    def height(
        self, q: collections.abc.Sequence[typing.SupportsFloat | typing.SupportsIndex]
    ) -> float:
        """
        Return the height z of the handle above the joints [m].
        """
    def inverse(
        self, x: collections.abc.Sequence[typing.SupportsFloat | typing.SupportsIndex]
    ) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"]:
        """
        Return the joint angles [rad] at handle position x [m], shape (axes,).
        """
    def jacobian(
        self, q: collections.abc.Sequence[typing.SupportsFloat | typing.SupportsIndex]
    ) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]"]:
        """
        Return the Jacobian dx/dq [m/rad] at q [rad], shape (axes, axes).
        """
    def replace(self, **changes: typing.Any) -> typing.Self:
        """
        Return a copy with some parameters changed, checked as at construction.
        """
    def transpose(
        self,
        q: collections.abc.Sequence[typing.SupportsFloat | typing.SupportsIndex],
        f: collections.abc.Sequence[typing.SupportsFloat | typing.SupportsIndex],
    ) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"]:
        """
        Return the joint torques J^T f [N m] of a handle force f [N].
        """
    def within_limits(
        self, q: collections.abc.Sequence[typing.SupportsFloat | typing.SupportsIndex]
    ) -> bool:
        """
        Return whether every joint is within its limit.
        """
    @property
    def axes(self) -> int:
        """
        Number of axes.
        """
    @property
    def limit(self) -> float:
        """
        largest angle of each joint either way, eq. (11) [rad], 0.001 to 1.5
        """
    @property
    def radius(self) -> float:
        """
        lever radius (paper, IV.A) [m], 1e-04 to 10
        """
    @property
    def stops(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"]:
        """
        Largest angle of each joint either way [rad], shape (axes,).
        """
    @property
    def travel(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"]:
        """
        Way of the handle per angle of each joint, in the middle [m], shape (axes,).
        """

class Motor:
    """
    A brushed DC motor; defaults: the paper's Maxon RE 30.

    Parameters
    ----------
    torque_constant : float
        torque per current (paper, II.B) [N m/A], 1e-05 to 100.
    rated_torque : float
        continuous torque (paper, II.B) [N m], 1e-05 to 1000.
    rated_current : float
        largest continuous current (paper, II.A) [A], 0.001 to 1000.
    stall_current : float
        stall current (paper, II.A) [A], 0.001 to 10000.
    rotor_inertia : float
        rotor inertia (indicative: RE 30 data sheet, from memory) [kg m^2], 0 to 1.
    ripple : float
        amplitude of the torque ripple, of the torque, 0 to 0.5.
    cogging : float
        amplitude of the cogging torque, without current [N m], 0 to 1000.
    waves : int
        periods of ripple and cogging per turn of the rotor, 1 to 10000.
    """
    @staticmethod
    def fields() -> list[Field]:
        """
        Return name, unit, meaning, default and range of every parameter.
        """
    def __eq__(self, other: typing.Any) -> bool: ...
    def __hash__(self) -> int: ...
    def __init__(
        self,
        *,
        torque_constant: float = 0.0538,
        rated_torque: float = 0.053,
        rated_current: float = 1.0,
        stall_current: float = 7.45,
        rotor_inertia: float = 3.4e-06,
        ripple: float = 0.0,
        cogging: float = 0.0,
        waves: int = 26,
    ) -> None: ...
    def __reduce__(self) -> tuple[typing.Any, ...]: ...
    def __repr__(self) -> str: ...
    def as_dict(self) -> dict[str, typing.Any]:
        """
        Return the parameters by name.
        """
    def current(self, torque: typing.SupportsFloat | typing.SupportsIndex) -> float:
        """
        Return the current [A] for a torque [N m], eq. (1) in SI.
        """
    def replace(self, **changes: typing.Any) -> typing.Self:
        """
        Return a copy with some parameters changed, checked as at construction.
        """
    def torque(self, current: typing.SupportsFloat | typing.SupportsIndex) -> float:
        """
        Return the torque [N m] of a current [A].
        """
    @property
    def cogging(self) -> float:
        """
        amplitude of the cogging torque, without current [N m], 0 to 1000
        """
    @property
    def rated_current(self) -> float:
        """
        largest continuous current (paper, II.A) [A], 0.001 to 1000
        """
    @property
    def rated_torque(self) -> float:
        """
        continuous torque (paper, II.B) [N m], 1e-05 to 1000
        """
    @property
    def ripple(self) -> float:
        """
        amplitude of the torque ripple, of the torque, 0 to 0.5
        """
    @property
    def rotor_inertia(self) -> float:
        """
        rotor inertia (indicative: RE 30 data sheet, from memory) [kg m^2], 0 to 1
        """
    @property
    def stall_current(self) -> float:
        """
        stall current (paper, II.A) [A], 0.001 to 10000
        """
    @property
    def torque_constant(self) -> float:
        """
        torque per current (paper, II.B) [N m/A], 1e-05 to 100
        """
    @property
    def waves(self) -> int:
        """
        periods of ripple and cogging per turn of the rotor, 1 to 10000
        """

class Drive:
    """
    The drive in front of the motor.

    Parameters
    ----------
    current_lag : float
        time constant of the current loop [s], 0 to 0.1.
    peak_ratio : float
        peak over rated torque (42.4 N over 10.6 N), 0.01 to 10.
    permille : bool
        torque quantised to whole thousandths of rated (CiA 402, 0x6071), 0 to 1.
    current_offset : float
        current that flows where none is asked for [A], -10 to 10.
    current_noise : float
        standard deviation of the current's error, another one in every tick [A], 0 to 10.
    """
    @staticmethod
    def fields() -> list[Field]:
        """
        Return name, unit, meaning, default and range of every parameter.
        """
    def __eq__(self, other: typing.Any) -> bool: ...
    def __hash__(self) -> int: ...
    def __init__(
        self,
        *,
        current_lag: float = 0.0003,
        peak_ratio: float = 4.0,
        permille: bool = False,
        current_offset: float = 0.0,
        current_noise: float = 0.0,
    ) -> None: ...
    def __reduce__(self) -> tuple[typing.Any, ...]: ...
    def __repr__(self) -> str: ...
    def as_dict(self) -> dict[str, typing.Any]:
        """
        Return the parameters by name.
        """
    def peak_current(self, motor: Motor) -> float:
        """
        Return the largest current of the drive [A].
        """
    def replace(self, **changes: typing.Any) -> typing.Self:
        """
        Return a copy with some parameters changed, checked as at construction.
        """
    @property
    def current_lag(self) -> float:
        """
        time constant of the current loop [s], 0 to 0.1
        """
    @property
    def current_noise(self) -> float:
        """
        standard deviation of the current's error, another one in every tick [A], 0 to 10
        """
    @property
    def current_offset(self) -> float:
        """
        current that flows where none is asked for [A], -10 to 10
        """
    @property
    def peak_ratio(self) -> float:
        """
        peak over rated torque (42.4 N over 10.6 N), 0.01 to 10
        """
    @property
    def permille(self) -> bool:
        """
        torque quantised to whole thousandths of rated (CiA 402, 0x6071), 0 to 1
        """

class Encoder:
    """
    An incremental encoder on the motor shaft, behind a counter that wraps.

    Parameters
    ----------
    counts_per_turn : int
        counts per motor turn, after any quadrature [counts], 1 to 67108864.
    counter_bits : int
        width of the drive's counter, which wraps [bits], 8 to 63.
    """
    @staticmethod
    def fields() -> list[Field]:
        """
        Return name, unit, meaning, default and range of every parameter.
        """
    def __eq__(self, other: typing.Any) -> bool: ...
    def __hash__(self) -> int: ...
    def __init__(self, *, counts_per_turn: int = 1024, counter_bits: int = 32) -> None: ...
    def __reduce__(self) -> tuple[typing.Any, ...]: ...
    def __repr__(self) -> str: ...
    def as_dict(self) -> dict[str, typing.Any]:
        """
        Return the parameters by name.
        """
    def read(self, angle: typing.SupportsFloat | typing.SupportsIndex) -> int:
        """
        Return the counter at a motor angle [rad].
        """
    def replace(self, **changes: typing.Any) -> typing.Self:
        """
        Return a copy with some parameters changed, checked as at construction.
        """
    def unwrap(
        self,
        raw: typing.SupportsInt | typing.SupportsIndex,
        last: typing.SupportsInt | typing.SupportsIndex,
    ) -> int:
        """
        Return the count nearest to `last` whose wrapped value is `raw`.
        """
    @property
    def count(self) -> float:
        """
        One count [rad] of the motor.
        """
    @property
    def counter_bits(self) -> int:
        """
        width of the drive's counter, which wraps [bits], 8 to 63
        """
    @property
    def counts_per_turn(self) -> int:
        """
        counts per motor turn, after any quadrature [counts], 1 to 67108864
        """

class Capstan:
    """
    A cable from the motor's drum to a sector on the lever.

    Parameters
    ----------
    drum_radius : float
        radius of the drum on the motor (paper, IV.D) [m], 1e-04 to 1.
    sector_radius : float
        radius of the sector on the lever; 42.4 N at the handle needs it equal to the lever [m], 1e-04 to 10.
    """
    @staticmethod
    def fields() -> list[Field]:
        """
        Return name, unit, meaning, default and range of every parameter.
        """
    def __eq__(self, other: typing.Any) -> bool: ...
    def __hash__(self) -> int: ...
    def __init__(self, *, drum_radius: float = 0.005, sector_radius: float = 0.1) -> None: ...
    def __reduce__(self) -> tuple[typing.Any, ...]: ...
    def __repr__(self) -> str: ...
    def as_dict(self) -> dict[str, typing.Any]:
        """
        Return the parameters by name.
        """
    def replace(self, **changes: typing.Any) -> typing.Self:
        """
        Return a copy with some parameters changed, checked as at construction.
        """
    @property
    def drum_radius(self) -> float:
        """
        radius of the drum on the motor (paper, IV.D) [m], 1e-04 to 1
        """
    @property
    def ratio(self) -> float:
        """
        Motor angle over joint angle.
        """
    @property
    def sector_radius(self) -> float:
        """
        radius of the sector on the lever; 42.4 N at the handle needs it equal to the lever [m], 1e-04 to 10
        """

class BackwardDifference:
    """
    v = dx / dt: no lag, one count of noise.
    """
    @staticmethod
    def fields() -> list[Field]:
        """
        Return name, unit, meaning, default and range of every parameter.
        """
    def __eq__(self, other: typing.Any) -> bool: ...
    def __hash__(self) -> int: ...
    def __init__(self) -> None: ...
    def __reduce__(self) -> tuple[typing.Any, ...]: ...
    def __repr__(self) -> str: ...
    def as_dict(self) -> dict[str, typing.Any]:
        """
        Return the parameters by name.
        """
    def replace(self, **changes: typing.Any) -> typing.Self:
        """
        Return a copy with some parameters changed, checked as at construction.
        """

class LowPass:
    """
    Backward difference through a first-order low-pass.

    Parameters
    ----------
    time_constant : float
        time constant of the filter [s], 0 to 1.
    """
    @staticmethod
    def fields() -> list[Field]:
        """
        Return name, unit, meaning, default and range of every parameter.
        """
    def __eq__(self, other: typing.Any) -> bool: ...
    def __hash__(self) -> int: ...
    def __init__(self, *, time_constant: float = 0.005) -> None: ...
    def __reduce__(self) -> tuple[typing.Any, ...]: ...
    def __repr__(self) -> str: ...
    def as_dict(self) -> dict[str, typing.Any]:
        """
        Return the parameters by name.
        """
    def replace(self, **changes: typing.Any) -> typing.Self:
        """
        Return a copy with some parameters changed, checked as at construction.
        """
    @property
    def time_constant(self) -> float:
        """
        time constant of the filter [s], 0 to 1
        """

class AdaptiveWindow:
    """
    First-order adaptive windowing (Janabi-Sharifi, Hayward, Chen 2000).

    Parameters
    ----------
    longest : int
        longest window [samples], 1 to 31.
    band : float
        largest distance of a reading from the line [counts], 0.5 to 100.
    """
    @staticmethod
    def fields() -> list[Field]:
        """
        Return name, unit, meaning, default and range of every parameter.
        """
    def __eq__(self, other: typing.Any) -> bool: ...
    def __hash__(self) -> int: ...
    def __init__(self, *, longest: int = 16, band: float = 1.0) -> None: ...
    def __reduce__(self) -> tuple[typing.Any, ...]: ...
    def __repr__(self) -> str: ...
    def as_dict(self) -> dict[str, typing.Any]:
        """
        Return the parameters by name.
        """
    def replace(self, **changes: typing.Any) -> typing.Self:
        """
        Return a copy with some parameters changed, checked as at construction.
        """
    @property
    def band(self) -> float:
        """
        largest distance of a reading from the line [counts], 0.5 to 100
        """
    @property
    def longest(self) -> int:
        """
        longest window [samples], 1 to 31
        """

class Mechanics:
    """
    Moving parts, referred to the handle; every axis is built alike.

    Parameters
    ----------
    handle_mass : float
        mass of lever and handle, felt at the handle, without the rotor [kg], 0.001 to 100.
    damping : float
        viscous damping B_h of eq. (6) [N s/m], 0 to 500.
    coulomb : float
        Coulomb friction [N], 0 to 100.
    breakaway : float
        friction at standstill when above coulomb (Stribeck) [N], 0 to 100.
    stribeck_speed : float
        speed over which friction falls from breakaway to coulomb [m/s], 1e-05 to 10.
    gravity : float
        Linear: pulls the handle along +x; Gimbal: pulls it down, so that upright is unstable [m/s^2], -100 to 100.
    cable_stiffness : float
        cable between rotor and lever; 0 is rigid [N/m], 0 to 1e+08.
    cable_damping : float
        damping inside the cable [N s/m], 0 to 10000.
    backlash : float
        play of the cable, end to end; needs cable_stiffness [m], 0 to 0.1.
    """
    @staticmethod
    def fields() -> list[Field]:
        """
        Return name, unit, meaning, default and range of every parameter.
        """
    def __eq__(self, other: typing.Any) -> bool: ...
    def __hash__(self) -> int: ...
    def __init__(
        self,
        *,
        handle_mass: float = 0.114,
        damping: float = 2.0,
        coulomb: float = 0.0,
        breakaway: float = 0.0,
        stribeck_speed: float = 0.01,
        gravity: float = 0.0,
        cable_stiffness: float = 0.0,
        cable_damping: float = 2.0,
        backlash: float = 0.0,
    ) -> None: ...
    def __reduce__(self) -> tuple[typing.Any, ...]: ...
    def __repr__(self) -> str: ...
    def as_dict(self) -> dict[str, typing.Any]:
        """
        Return the parameters by name.
        """
    def replace(self, **changes: typing.Any) -> typing.Self:
        """
        Return a copy with some parameters changed, checked as at construction.
        """
    @property
    def backlash(self) -> float:
        """
        play of the cable, end to end; needs cable_stiffness [m], 0 to 0.1
        """
    @property
    def breakaway(self) -> float:
        """
        friction at standstill when above coulomb (Stribeck) [N], 0 to 100
        """
    @property
    def cable_damping(self) -> float:
        """
        damping inside the cable [N s/m], 0 to 10000
        """
    @property
    def cable_stiffness(self) -> float:
        """
        cable between rotor and lever; 0 is rigid [N/m], 0 to 1e+08
        """
    @property
    def coulomb(self) -> float:
        """
        Coulomb friction [N], 0 to 100
        """
    @property
    def damping(self) -> float:
        """
        viscous damping B_h of eq. (6) [N s/m], 0 to 500
        """
    @property
    def gravity(self) -> float:
        """
        Linear: pulls the handle along +x; Gimbal: pulls it down, so that upright is unstable [m/s^2], -100 to 100
        """
    @property
    def handle_mass(self) -> float:
        """
        mass of lever and handle, felt at the handle, without the rotor [kg], 0.001 to 100
        """
    @property
    def stribeck_speed(self) -> float:
        """
        speed over which friction falls from breakaway to coulomb [m/s], 1e-05 to 10
        """

class ForceSensor:
    """
    A force/torque sensor between handle and hand.

    Parameters
    ----------
    lag : float
        time constant of its first-order lag [s], 0 to 0.1.
    noise : float
        standard deviation of its noise [N], 0 to 100.
    quantum : float
        one step of its reading; 0 for none [N], 0 to 100.
    range : float
        largest force it can show; it saturates [N], 0.001 to 1e+05.
    bias : float
        what it shows without a force [N], -1000 to 1000.
    period : float
        time from record to record, of which the loop knows the age; 0 for one in every tick [s], 0 to 0.02.
    delay : float
        time from a force to its record, of which the loop knows nothing [s], 0 to 0.02.
    stops_at : float
        when no new record comes; inf for never [s], at least 0.
    resumes_at : float
        when records come again; inf for never [s], at least 0.
    repeats : bool
        whether it sends its last record over and over meanwhile, so that nothing looks old.
    disconnects : bool
        whether its status says disconnected meanwhile; its reading is the last record.
    scale : float
        what it shows over what acts, of which the loop knows nothing, 0.1 to 10.
    fitted : bool
        whether the device has one; the force reads 0 without.
    """

    @staticmethod
    def fields() -> list[Field]:
        """
        Return name, unit, meaning, default and range of every parameter.
        """
    def __eq__(self, other: typing.Any) -> bool: ...
    def __hash__(self) -> int: ...
    def __init__(
        self,
        *,
        lag: float = 0.0008,
        noise: float = 0.0,
        quantum: float = 0.0,
        range: float = 145.0,
        bias: float = 0.0,
        period: float = 0.0,
        delay: float = 0.0,
        stops_at: float = ...,
        resumes_at: float = ...,
        repeats: bool = False,
        disconnects: bool = False,
        scale: float = 1.0,
        fitted: bool = True,
    ) -> None: ...
    def __reduce__(self) -> tuple[typing.Any, ...]: ...
    def __repr__(self) -> str: ...
    def as_dict(self) -> dict[str, typing.Any]:
        """
        Return the parameters by name.
        """
    def replace(self, **changes: typing.Any) -> typing.Self:
        """
        Return a copy with some parameters changed, checked as at construction.
        """
    @property
    def bias(self) -> float:
        """
        what it shows without a force [N], -1000 to 1000
        """
    @property
    def delay(self) -> float:
        """
        time from a force to its record, of which the loop knows nothing [s], 0 to 0.02
        """
    @property
    def disconnects(self) -> bool:
        """
        whether its status says disconnected meanwhile; its reading is the last record
        """
    @property
    def fitted(self) -> bool:
        """
        whether the device has one; the force reads 0 without
        """
    @property
    def lag(self) -> float:
        """
        time constant of its first-order lag [s], 0 to 0.1
        """
    @property
    def noise(self) -> float:
        """
        standard deviation of its noise [N], 0 to 100
        """
    @property
    def period(self) -> float:
        """
        time from record to record, of which the loop knows the age; 0 for one in every tick [s], 0 to 0.02
        """
    @property
    def quantum(self) -> float:
        """
        one step of its reading; 0 for none [N], 0 to 100
        """
    @property
    def range(self) -> float:
        """
        largest force it can show; it saturates [N], 0.001 to 1e+05
        """
    @property
    def repeats(self) -> bool:
        """
        whether it sends its last record over and over meanwhile, so that nothing looks old
        """
    @property
    def resumes_at(self) -> float:
        """
        when records come again; inf for never [s], at least 0
        """
    @property
    def scale(self) -> float:
        """
        what it shows over what acts, of which the loop knows nothing
        """
    @property
    def stops_at(self) -> float:
        """
        when no new record comes; inf for never [s], at least 0
        """

class Compensation:
    """
    Static compensation (tau_static of eq. (2)): gravity, friction and inertia.

    Parameters
    ----------
    gravity_mass : float
        mass whose weight is carried [kg], 0 to 100.
    friction : float
        Coulomb friction given back [N], 0 to 100.
    friction_speed : float
        speed at which friction is given back in full [m/s], 1e-04 to 10.
    inertia : float
        mass given back [kg], 0 to 100.
    inertia_lag : float
        filter on the acceleration it uses [s], 1e-04 to 1.
    """
    @staticmethod
    def fields() -> list[Field]:
        """
        Return name, unit, meaning, default and range of every parameter.
        """
    def __eq__(self, other: typing.Any) -> bool: ...
    def __hash__(self) -> int: ...
    def __init__(
        self,
        *,
        gravity_mass: float = 0.0,
        friction: float = 0.0,
        friction_speed: float = 0.02,
        inertia: float = 0.0,
        inertia_lag: float = 0.005,
    ) -> None: ...
    def __reduce__(self) -> tuple[typing.Any, ...]: ...
    def __repr__(self) -> str: ...
    def as_dict(self) -> dict[str, typing.Any]:
        """
        Return the parameters by name.
        """
    def damping_left(
        self,
        damping: typing.SupportsFloat | typing.SupportsIndex,
        coulomb: typing.SupportsFloat | typing.SupportsIndex,
    ) -> float:
        """
        Lower bound of the viscous damping left [N s/m], given real damping [N s/m] and friction [N].
        """
    def force(
        self,
        v: typing.SupportsFloat | typing.SupportsIndex,
        a: typing.SupportsFloat | typing.SupportsIndex,
    ) -> float:
        """
        Return the force [N] that helps a motion of v [m/s] and a [m/s^2]; positive resists +x.
        """
    def replace(self, **changes: typing.Any) -> typing.Self:
        """
        Return a copy with some parameters changed, checked as at construction.
        """
    @property
    def friction(self) -> float:
        """
        Coulomb friction given back [N], 0 to 100
        """
    @property
    def friction_speed(self) -> float:
        """
        speed at which friction is given back in full [m/s], 1e-04 to 10
        """
    @property
    def gravity_mass(self) -> float:
        """
        mass whose weight is carried [kg], 0 to 100
        """
    @property
    def inertia(self) -> float:
        """
        mass given back [kg], 0 to 100
        """
    @property
    def inertia_lag(self) -> float:
        """
        filter on the acceleration it uses [s], 1e-04 to 1
        """

class Device:
    """
    One haptic device, part by part. The default is the reference device: one straight axis of 0.25 kg and
    2 N s/m, built from the paper's motor, encoder and capstan.
    """
    @staticmethod
    def open(
        configuration: ebac.hardware.Configuration | str | os.PathLike[str],
        *,
        simulate: bool = False,
        detached: bool = False,
    ) -> ebac.hardware.OpenDevice:
        """
        Opens the drives of a configuration, or of its TOML file: `with Device.open(file) as device`.
        """
    def __eq__(self, other: typing.Any) -> bool: ...
    def __hash__(self) -> int: ...
    def __init__(
        self,
        *,
        kinematics: Linear | Gimbal | SlidingGimbal = ...,
        motor: Motor = ...,
        drive: Drive = ...,
        encoder: Encoder = ...,
        capstan: Capstan = ...,
        mechanics: Mechanics = ...,
        sensor: ForceSensor | None = ...,
        velocity: BackwardDifference | LowPass | AdaptiveWindow = ...,
        compensation: Compensation = ...,
    ) -> None: ...
    def __reduce__(self) -> tuple[typing.Any, ...]: ...
    def __repr__(self) -> str: ...
    def as_dict(self) -> dict[str, typing.Any]:
        """
        Return the parts by name.
        """
    def force(self, current: typing.SupportsFloat | typing.SupportsIndex) -> float:
        """
        Return the handle force [N] of a current [A].
        """
    def replace(self, **changes: typing.Any) -> typing.Self:
        """
        Return a copy with some parameters changed, checked as at construction.
        """
    @property
    def axes(self) -> int:
        """
        Number of axes.
        """
    @property
    def capstan(self) -> Capstan:
        """
        Transmission of each axis.
        """
    @property
    def compensation(self) -> Compensation:
        """
        Static compensation of eq. (2).
        """
    @property
    def continuous_force(self) -> float:
        """
        Force at rated torque [N].
        """
    @property
    def count(self) -> float:
        """
        One encoder count at the handle [m]; this and the next four: in the middle, on the first axis.
        """
    @property
    def drive(self) -> Drive:
        """
        Drive of each axis.
        """
    @property
    def encoder(self) -> Encoder:
        """
        Encoder of each axis.
        """
    @property
    def facts(self) -> DeviceFacts:
        """
        Facts from which laws are designed.
        """
    @property
    def kinematics(self) -> Linear | Gimbal | SlidingGimbal:
        """
        Joints to handle.
        """
    @property
    def mass(self) -> float:
        """
        Mass at the handle, M_h [kg].
        """
    @property
    def mechanics(self) -> Mechanics:
        """
        Masses, damping, friction.
        """
    @property
    def motor(self) -> Motor:
        """
        Motor of each axis.
        """
    @property
    def peak_force(self) -> float:
        """
        Largest force [N].
        """
    @property
    def radius(self) -> float:
        """
        Lever radius [m].
        """
    @property
    def reflected_mass(self) -> float:
        """
        Rotor's part of the mass [kg].
        """
    @property
    def sensor(self) -> ForceSensor:
        """
        Force sensor.
        """
    @property
    def velocity(self) -> BackwardDifference | LowPass | AdaptiveWindow:
        """
        Velocity estimator.
        """

class Step:
    """
    A step: moves to `target` at time `at`.

    Parameters
    ----------
    target : float
        where the hand wants to be [m], -10 to 10.
    at : float
        from when on [s], 0 to 1e+06.
    """
    @staticmethod
    def fields() -> list[Field]:
        """
        Return name, unit, meaning, default and range of every parameter.
        """
    def __eq__(self, other: typing.Any) -> bool: ...
    def __hash__(self) -> int: ...
    def __init__(self, *, target: float = 0.04, at: float = 0.0) -> None: ...
    def __reduce__(self) -> tuple[typing.Any, ...]: ...
    def __repr__(self) -> str: ...
    def as_dict(self) -> dict[str, typing.Any]:
        """
        Return the parameters by name.
        """
    def replace(self, **changes: typing.Any) -> typing.Self:
        """
        Return a copy with some parameters changed, checked as at construction.
        """
    @property
    def at(self) -> float:
        """
        from when on [s], 0 to 1e+06
        """
    @property
    def target(self) -> float:
        """
        where the hand wants to be [m], -10 to 10
        """

class SteppedRun(Running):
    """
    A loop on a virtual clock that takes its ticks when it is asked to.
    """
    def advance(self, ticks: typing.SupportsInt | typing.SupportsIndex) -> int:
        """
        Take so many ticks, fewer where the run ends; return how many.
        """
    def aim_now(
        self,
        target: typing.Annotated[
            collections.abc.Sequence[typing.SupportsFloat | typing.SupportsIndex], "FixedSize(3)"
        ],
    ) -> None:
        """
        Set the target of the hand [m] before the next tick, without a note; NaN leaves an axis unchanged.
        """
    def switch_off(self) -> None:
        """
        Disable the drives. Raises RuntimeError when one stays on.
        """

class MinimumJerk:
    """
    A minimum-jerk motion to `target` (Flash and Hogan 1985).

    Parameters
    ----------
    target : float
        where the movement ends [m], -10 to 10.
    at : float
        when it starts [s], 0 to 1e+06.
    duration : float
        how long it takes [s], 0.001 to 1e+06.
    """
    @staticmethod
    def fields() -> list[Field]:
        """
        Return name, unit, meaning, default and range of every parameter.
        """
    def __eq__(self, other: typing.Any) -> bool: ...
    def __hash__(self) -> int: ...
    def __init__(self, *, target: float = 0.04, at: float = 0.0, duration: float = 0.5) -> None: ...
    def __reduce__(self) -> tuple[typing.Any, ...]: ...
    def __repr__(self) -> str: ...
    def as_dict(self) -> dict[str, typing.Any]:
        """
        Return the parameters by name.
        """
    def replace(self, **changes: typing.Any) -> typing.Self:
        """
        Return a copy with some parameters changed, checked as at construction.
        """
    @property
    def at(self) -> float:
        """
        when it starts [s], 0 to 1e+06
        """
    @property
    def duration(self) -> float:
        """
        how long it takes [s], 0.001 to 1e+06
        """
    @property
    def target(self) -> float:
        """
        where the movement ends [m], -10 to 10
        """

class Sine:
    """
    A sine around a centre.

    Parameters
    ----------
    centre : float
        middle of the swing [m], -10 to 10.
    amplitude : float
        half of the swing [m], 0 to 10.
    frequency : float
        swings a second [Hz], 0 to 500.
    phase : float
        angle at time zero [rad], -10 to 10.
    """
    @staticmethod
    def fields() -> list[Field]:
        """
        Return name, unit, meaning, default and range of every parameter.
        """
    def __eq__(self, other: typing.Any) -> bool: ...
    def __hash__(self) -> int: ...
    def __init__(
        self,
        *,
        centre: float = 0.02,
        amplitude: float = 0.02,
        frequency: float = 1.0,
        phase: float = 0.0,
    ) -> None: ...
    def __reduce__(self) -> tuple[typing.Any, ...]: ...
    def __repr__(self) -> str: ...
    def as_dict(self) -> dict[str, typing.Any]:
        """
        Return the parameters by name.
        """
    def replace(self, **changes: typing.Any) -> typing.Self:
        """
        Return a copy with some parameters changed, checked as at construction.
        """
    @property
    def amplitude(self) -> float:
        """
        half of the swing [m], 0 to 10
        """
    @property
    def centre(self) -> float:
        """
        middle of the swing [m], -10 to 10
        """
    @property
    def frequency(self) -> float:
        """
        swings a second [Hz], 0 to 500
        """
    @property
    def phase(self) -> float:
        """
        angle at time zero [rad], -10 to 10
        """

class SlidingGimbal:
    """
    Three axes: the gimbal, whose lever slides through its joints.

    The drum of the slide is the third joint: the lever is R + slide_radius q3 long. x and y as of a Gimbal; z is the
    height of the handle above where it rests, R' cos q1 cos q2 - R with that length R'.

    Parameters
    ----------
    radius : float
        lever radius with the slide in its middle [m], 1e-04 to 10.
    limit : float
        largest angle of the first two joints either way [rad], 0.001 to 1.5.
    slide_radius : float
        way of the slide per angle of its joint, the third; half to twice the lever radius [m], 1e-04 to 10.
    slide_limit : float
        largest way of the slide either way, at most half of the lever radius [m], 1e-04 to 5.
    """
    @staticmethod
    def fields() -> list[Field]:
        """
        Return name, unit, meaning, default and range of every parameter.
        """
    def __eq__(self, other: typing.Any) -> bool: ...
    def __hash__(self) -> int: ...
    def __init__(
        self,
        *,
        radius: float = 0.1,
        limit: float = 0.5235987755982988,
        slide_radius: float = 0.1,
        slide_limit: float = 0.04,
    ) -> None: ...
    def __reduce__(self) -> tuple[typing.Any, ...]: ...
    def __repr__(self) -> str: ...
    def as_dict(self) -> dict[str, typing.Any]:
        """
        Return the parameters by name.
        """
    def forward(
        self, q: collections.abc.Sequence[typing.SupportsFloat | typing.SupportsIndex]
    ) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"]:
        """
        Return the handle position [m] at joint angles q [rad], shape (axes,).
        """
    def inverse(
        self, x: collections.abc.Sequence[typing.SupportsFloat | typing.SupportsIndex]
    ) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"]:
        """
        Return the joint angles [rad] at handle position x [m], shape (axes,).
        """
    def jacobian(
        self, q: collections.abc.Sequence[typing.SupportsFloat | typing.SupportsIndex]
    ) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]"]:
        """
        Return the Jacobian dx/dq [m/rad] at q [rad], shape (axes, axes).
        """
    def replace(self, **changes: typing.Any) -> typing.Self:
        """
        Return a copy with some parameters changed, checked as at construction.
        """
    def transpose(
        self,
        q: collections.abc.Sequence[typing.SupportsFloat | typing.SupportsIndex],
        f: collections.abc.Sequence[typing.SupportsFloat | typing.SupportsIndex],
    ) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"]:
        """
        Return the joint torques J^T f [N m] of a handle force f [N].
        """
    def within_limits(
        self, q: collections.abc.Sequence[typing.SupportsFloat | typing.SupportsIndex]
    ) -> bool:
        """
        Return whether every joint is within its limit.
        """
    @property
    def axes(self) -> int:
        """
        Number of axes.
        """
    @property
    def limit(self) -> float:
        """
        largest angle of the first two joints either way [rad], 0.001 to 1.5
        """
    @property
    def radius(self) -> float:
        """
        lever radius with the slide in its middle [m], 1e-04 to 10
        """
    @property
    def slide_limit(self) -> float:
        """
        largest way of the slide either way, at most half of the lever radius [m], 1e-04 to 5
        """
    @property
    def slide_radius(self) -> float:
        """
        way of the slide per angle of its joint, the third; half to twice the lever radius [m], 1e-04 to 10
        """
    @property
    def stops(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"]:
        """
        Largest angle of each joint either way [rad], shape (axes,).
        """
    @property
    def travel(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"]:
        """
        Way of the handle per angle of each joint, in the middle [m], shape (axes,).
        """

class Tapping:
    """
    Square tapping: half a period at `target`, half at `rest`.

    Parameters
    ----------
    target : float
        where it taps [m], -10 to 10.
    rest : float
        where it lifts to [m], -10 to 10.
    frequency : float
        taps a second [Hz], 0.001 to 100.
    """
    @staticmethod
    def fields() -> list[Field]:
        """
        Return name, unit, meaning, default and range of every parameter.
        """
    def __eq__(self, other: typing.Any) -> bool: ...
    def __hash__(self) -> int: ...
    def __init__(
        self, *, target: float = 0.04, rest: float = -0.01, frequency: float = 1.5
    ) -> None: ...
    def __reduce__(self) -> tuple[typing.Any, ...]: ...
    def __repr__(self) -> str: ...
    def as_dict(self) -> dict[str, typing.Any]:
        """
        Return the parameters by name.
        """
    def replace(self, **changes: typing.Any) -> typing.Self:
        """
        Return a copy with some parameters changed, checked as at construction.
        """
    @property
    def frequency(self) -> float:
        """
        taps a second [Hz], 0.001 to 100
        """
    @property
    def rest(self) -> float:
        """
        where it lifts to [m], -10 to 10
        """
    @property
    def target(self) -> float:
        """
        where it taps [m], -10 to 10
        """

class Recorded:
    """
    A path from a log: straight between its points, constant beyond.
    """
    def __eq__(self, other: typing.Any) -> bool: ...
    def __hash__(self) -> int: ...
    def __init__(
        self,
        *,
        t: collections.abc.Sequence[typing.SupportsFloat | typing.SupportsIndex],
        x: collections.abc.Sequence[typing.SupportsFloat | typing.SupportsIndex],
    ) -> None:
        """
        Times [s], strictly rising, and positions [m], as many.
        """
    def __reduce__(self) -> tuple[typing.Any, ...]: ...
    def __repr__(self) -> str: ...
    def as_dict(self) -> dict[str, typing.Any]:
        """
        Return the parameters by name.
        """
    def replace(self, **changes: typing.Any) -> typing.Self:
        """
        Return a copy with some parameters changed, checked as at construction.
        """
    @property
    def t(self) -> list[float]:
        """
        Times [s].
        """
    @property
    def x(self) -> list[float]:
        """
        Positions [m].
        """

class Reflex:
    """
    A hand with a stretch reflex: muscle force that answers the motion of `delay` ago.

    F = K0 (X0 - x) - B0 v - M0 a + r; the reflex r is `stretch_gain` K0 (X0 - x) - `velocity_gain` B0 v,
    of `delay` ago, through the activation of the muscle, a low-pass of second order. Model of van der Helm
    et al. 2002 (J. Neurosci. Methods 119); activation of Mugge et al. 2010 (PMC5664365, table 1); delay and gains are from memory of the first.

    Parameters
    ----------
    delay : float
        time from stretch to muscle [s], 0.005 to 0.5.
    stretch_gain : float
        stiffness of the reflex, as a share of K0, 0 to 10.
    velocity_gain : float
        damping of the reflex, as a share of B0, 0 to 10.
    activation : float
        natural frequency of the muscle's activation [Hz], 0.1 to 50.
    activation_damping : float
        damping ratio of the muscle's activation, 0.1 to 10.
    """
    @staticmethod
    def fields() -> list[Field]:
        """
        Return name, unit, meaning, default and range of every parameter.
        """
    def __eq__(self, other: typing.Any) -> bool: ...
    def __hash__(self) -> int: ...
    def __init__(
        self,
        *,
        delay: float = 0.04,
        stretch_gain: float = 0.25,
        velocity_gain: float = 1.0,
        activation: float = 2.7,
        activation_damping: float = 0.99,
    ) -> None: ...
    def __reduce__(self) -> tuple[typing.Any, ...]: ...
    def __repr__(self) -> str: ...
    def as_dict(self) -> dict[str, typing.Any]:
        """
        Return the parameters by name.
        """
    def replace(self, **changes: typing.Any) -> typing.Self:
        """
        Return a copy with some parameters changed, checked as at construction.
        """
    @property
    def activation(self) -> float:
        """
        natural frequency of the muscle's activation [Hz], 0.1 to 50
        """
    @property
    def activation_damping(self) -> float:
        """
        damping ratio of the muscle's activation, 0.1 to 10
        """
    @property
    def delay(self) -> float:
        """
        time from stretch to muscle [s], 0.005 to 0.5
        """
    @property
    def stretch_gain(self) -> float:
        """
        stiffness of the reflex, as a share of K0, 0 to 10
        """
    @property
    def velocity_gain(self) -> float:
        """
        damping of the reflex, as a share of B0, 0 to 10
        """

class FingerPad:
    """
    A hand behind the pulp of its fingers: an exponential spring that relaxes, in series.

    F_e = `stiffness`/`rise` (exp(`rise` d) - 1) at a compression d, straight from `stiffest` on; shares of it relax
    within 4 ms, 70 ms and 1.4 s. Form and times of Pawluk and Howe 1999 (J. Biomech. Eng. 121, 178), up to 2 N;
    numbers from memory of it, beyond 2 N assumed.

    Parameters
    ----------
    stiffness : float
        stiffness at no force [N/m], 1 to 1e+05.
    rise : float
        growth of the stiffness with the force [1/m], 1 to 10000.
    stiffest : float
        largest stiffness [N/m], 1 to 1e+06.
    fast : float
        share of the force that relaxes within 4 ms, 0 to 0.3.
    medium : float
        share that relaxes within 70 ms, 0 to 0.3.
    slow : float
        share that relaxes within 1.4 s, 0 to 0.3.
    """
    @staticmethod
    def fields() -> list[Field]:
        """
        Return name, unit, meaning, default and range of every parameter.
        """
    def __eq__(self, other: typing.Any) -> bool: ...
    def __hash__(self) -> int: ...
    def __init__(
        self,
        *,
        stiffness: float = 200.0,
        rise: float = 2000.0,
        stiffest: float = 20000.0,
        fast: float = 0.3,
        medium: float = 0.2,
        slow: float = 0.1,
    ) -> None: ...
    def __reduce__(self) -> tuple[typing.Any, ...]: ...
    def __repr__(self) -> str: ...
    def as_dict(self) -> dict[str, typing.Any]:
        """
        Return the parameters by name.
        """
    def replace(self, **changes: typing.Any) -> typing.Self:
        """
        Return a copy with some parameters changed, checked as at construction.
        """
    @property
    def fast(self) -> float:
        """
        share of the force that relaxes within 4 ms, 0 to 0.3
        """
    @property
    def medium(self) -> float:
        """
        share that relaxes within 70 ms, 0 to 0.3
        """
    @property
    def rise(self) -> float:
        """
        growth of the stiffness with the force [1/m], 1 to 10000
        """
    @property
    def slow(self) -> float:
        """
        share that relaxes within 1.4 s, 0 to 0.3
        """
    @property
    def stiffest(self) -> float:
        """
        largest stiffness [N/m], 1 to 1e+06
        """
    @property
    def stiffness(self) -> float:
        """
        stiffness at no force [N/m], 1 to 1e+05
        """

class NonlinearGrip:
    """
    A hand that stiffens with its force: K = K0 (1 + |F| / `force`), B = B0 sqrt(K / K0).

    Stiffness linear in force: Van Doren 1998 (Motor Control 2, 352), Hoeppner et al. 2013 (PLOS ONE 8, e80889); damping
    that rises too: Hasser and Cutkosky 2002, Hajian and Howe 1997. The numbers are indicative.

    Parameters
    ----------
    force : float
        force at which the hand is twice as stiff [N], 0.1 to 1000.
    stiffest : float
        largest stiffness, in multiples of K0, 1 to 100.
    """
    @staticmethod
    def fields() -> list[Field]:
        """
        Return name, unit, meaning, default and range of every parameter.
        """
    def __eq__(self, other: typing.Any) -> bool: ...
    def __hash__(self) -> int: ...
    def __init__(self, *, force: float = 20.0, stiffest: float = 3.0) -> None: ...
    def __reduce__(self) -> tuple[typing.Any, ...]: ...
    def __repr__(self) -> str: ...
    def as_dict(self) -> dict[str, typing.Any]:
        """
        Return the parameters by name.
        """
    def replace(self, **changes: typing.Any) -> typing.Self:
        """
        Return a copy with some parameters changed, checked as at construction.
        """
    @property
    def force(self) -> float:
        """
        force at which the hand is twice as stiff [N], 0.1 to 1000
        """
    @property
    def stiffest(self) -> float:
        """
        largest stiffness, in multiples of K0, 1 to 100
        """

class LetGo:
    """
    A hand that lets go of the handle and grips it again.

    Its mass, damper and spring stand behind a grip of `stiffness` and `damping` that opens at `open_at` and closes at
    `closed_at`; an open hand follows the handle. Stiffness and damping are indicative (several fingers of Hajian and
    Howe 1997).

    Parameters
    ----------
    open_at : float
        when the hand starts to open [s], 0 to 1e+06.
    closed_at : float
        when it starts to grip again [s], 0 to 1e+06.
    period : float
        how often; inf for once [s], at least 0.01.
    ramp : float
        time to open, and to close [s], 0.001 to 1.
    stiffness : float
        stiffness of the closed grip [N/m], 1 to 1e+06.
    damping : float
        damping of the closed grip [N s/m], 0 to 10000.
    """
    @staticmethod
    def fields() -> list[Field]:
        """
        Return name, unit, meaning, default and range of every parameter.
        """
    def __eq__(self, other: typing.Any) -> bool: ...
    def __hash__(self) -> int: ...
    def __init__(
        self,
        *,
        open_at: float = 2.0,
        closed_at: float = 2.5,
        period: float = ...,
        ramp: float = 0.03,
        stiffness: float = 3000.0,
        damping: float = 10.0,
    ) -> None: ...
    def __reduce__(self) -> tuple[typing.Any, ...]: ...
    def __repr__(self) -> str: ...
    def as_dict(self) -> dict[str, typing.Any]:
        """
        Return the parameters by name.
        """
    def replace(self, **changes: typing.Any) -> typing.Self:
        """
        Return a copy with some parameters changed, checked as at construction.
        """
    @property
    def closed_at(self) -> float:
        """
        when it starts to grip again [s], 0 to 1e+06
        """
    @property
    def damping(self) -> float:
        """
        damping of the closed grip [N s/m], 0 to 10000
        """
    @property
    def open_at(self) -> float:
        """
        when the hand starts to open [s], 0 to 1e+06
        """
    @property
    def period(self) -> float:
        """
        how often; inf for once [s], at least 0.01
        """
    @property
    def ramp(self) -> float:
        """
        time to open, and to close [s], 0.001 to 1
        """
    @property
    def stiffness(self) -> float:
        """
        stiffness of the closed grip [N/m], 1 to 1e+06
        """

class Hand:
    """
    The operator of eq. (4), (5): mass, damper and spring pulled along an intended path.

    `path` is one path, for the first axis, or one for each axis; the others stay at 0. `target` [m] is
    short for a `Step` to that place, or one for each axis; give one of the two.
    `model` makes another force of these than eq. (4), see `ebac.hands`.

    Parameters
    ----------
    mass : float
        mass of the hand, which moves with the handle: M0 of eq. (4) [kg], 0 to 10.
    damping : float
        damping of the hand, force per speed: B0 of eq. (4) [N s/m], 0 to 1000.
    stiffness : float
        stiffness of the hand, force per distance from its target: K0 of eq. (4) [N/m], 0 to 1e+05.
    tremor_amplitude : float
        tremor on top of the path, on every axis [m], 0 to 0.1.
    tremor_frequency : float
        frequency of the tremor [Hz], 0 to 500.
    release_at : float
        when the hand lets go; inf for never [s], at least 0.
    """
    @staticmethod
    def fields() -> list[Field]:
        """
        Return name, unit, meaning, default and range of every parameter.
        """
    def __eq__(self, other: typing.Any) -> bool: ...
    def __hash__(self) -> int: ...
    def __init__(
        self,
        *,
        mass: float = 0.15,
        damping: float = 6.0,
        stiffness: float = 300.0,
        tremor_amplitude: float = 0.0,
        tremor_frequency: float = 9.0,
        release_at: float = ...,
        path: Step
        | MinimumJerk
        | Sine
        | Tapping
        | Recorded
        | typing.Sequence[Step | MinimumJerk | Sine | Tapping | Recorded] = ...,
        target: float | typing.Sequence[float] | None = None,
        model: ebac.hands.AnyModel = None,
    ) -> None: ...
    def __reduce__(self) -> tuple[typing.Any, ...]: ...
    def __repr__(self) -> str: ...
    def as_dict(self) -> dict[str, typing.Any]:
        """
        Return the parameters by name.
        """
    def pull(
        self,
        t: typing.Annotated[numpy.typing.ArrayLike, numpy.float64],
        x: typing.Annotated[numpy.typing.ArrayLike, numpy.float64],
        axis: typing.SupportsInt | typing.SupportsIndex = 0,
    ) -> typing.Any:
        """
        Return the pulling force |K0 (X0(t) - x)| [N] at times t [s] and positions x [m].
        """
    def replace(self, **changes: typing.Any) -> typing.Self:
        """
        Return a copy with some parameters changed, checked as at construction.
        """
    def steady(self, x: typing.SupportsFloat | typing.SupportsIndex) -> float:
        """
        Return the force [N] on the first axis at rest at x [m], at the end of its path; NaN where none is known.
        """
    def target(
        self,
        t: typing.SupportsFloat | typing.SupportsIndex,
        axis: typing.SupportsInt | typing.SupportsIndex = 0,
    ) -> float:
        """
        Return X0(t) [m], tremor included, at time t [s].
        """
    @property
    def damping(self) -> float:
        """
        damping of the hand, force per speed: B0 of eq. (4) [N s/m], 0 to 1000
        """
    @property
    def mass(self) -> float:
        """
        mass of the hand, which moves with the handle: M0 of eq. (4) [kg], 0 to 10
        """
    @property
    def model(self) -> ebac.hands.AnyModel:
        """
        What makes its force: Reflex, FingerPad, NonlinearGrip, LetGo, a hand of your own, or None for eq. (4).
        """
    @property
    def path(
        self,
    ) -> tuple[
        Step | MinimumJerk | Sine | Tapping | Recorded,
        Step | MinimumJerk | Sine | Tapping | Recorded,
        Step | MinimumJerk | Sine | Tapping | Recorded,
    ]:
        """
        Intended path of each axis.
        """
    @property
    def release_at(self) -> float:
        """
        when the hand lets go; inf for never [s], at least 0
        """
    @property
    def stiffness(self) -> float:
        """
        stiffness of the hand, force per distance from its target: K0 of eq. (4) [N/m], 0 to 1e+05
        """
    @property
    def tremor_amplitude(self) -> float:
        """
        tremor on top of the path, on every axis [m], 0 to 0.1
        """
    @property
    def tremor_frequency(self) -> float:
        """
        frequency of the tremor [Hz], 0 to 500
        """

class Plane:
    """
    All that lies behind the plane x = 0.
    """

    @staticmethod
    def fields() -> list[Field]:
        """
        Return name, unit, meaning, default and range of every parameter.
        """
    def __eq__(self, other: typing.Any) -> bool: ...
    def __hash__(self) -> int: ...
    def __init__(self) -> None: ...
    def __reduce__(self) -> tuple[typing.Any, ...]: ...
    def __repr__(self) -> str: ...
    def as_dict(self) -> dict[str, typing.Any]:
        """
        Return the parameters by name.
        """
    def replace(self, **changes: typing.Any) -> typing.Self:
        """
        Return a copy with some parameters changed, checked as at construction.
        """

class Sphere:
    """
    A ball about the origin.

    Parameters
    ----------
    radius : float
        radius [m], 1e-04 to 10.
    """

    @staticmethod
    def fields() -> list[Field]:
        """
        Return name, unit, meaning, default and range of every parameter.
        """
    def __eq__(self, other: typing.Any) -> bool: ...
    def __hash__(self) -> int: ...
    def __init__(self, *, radius: float = 0.02) -> None: ...
    def __reduce__(self) -> tuple[typing.Any, ...]: ...
    def __repr__(self) -> str: ...
    def as_dict(self) -> dict[str, typing.Any]:
        """
        Return the parameters by name.
        """
    def replace(self, **changes: typing.Any) -> typing.Self:
        """
        Return a copy with some parameters changed, checked as at construction.
        """
    @property
    def radius(self) -> float:
        """
        radius [m], 1e-04 to 10
        """

class Box:
    """
    A box about the origin, along the axes.

    Parameters
    ----------
    width : float
        size along x [m], 1e-04 to 10.
    depth : float
        size along y [m], 1e-04 to 10.
    height : float
        size along z [m], 1e-04 to 10.
    """

    @staticmethod
    def fields() -> list[Field]:
        """
        Return name, unit, meaning, default and range of every parameter.
        """
    def __eq__(self, other: typing.Any) -> bool: ...
    def __hash__(self) -> int: ...
    def __init__(
        self, *, width: float = 0.04, depth: float = 0.04, height: float = 0.04
    ) -> None: ...
    def __reduce__(self) -> tuple[typing.Any, ...]: ...
    def __repr__(self) -> str: ...
    def as_dict(self) -> dict[str, typing.Any]:
        """
        Return the parameters by name.
        """
    def replace(self, **changes: typing.Any) -> typing.Self:
        """
        Return a copy with some parameters changed, checked as at construction.
        """
    @property
    def depth(self) -> float:
        """
        size along y [m], 1e-04 to 10
        """
    @property
    def height(self) -> float:
        """
        size along z [m], 1e-04 to 10
        """
    @property
    def width(self) -> float:
        """
        size along x [m], 1e-04 to 10
        """

class Cylinder:
    """
    A cylinder about the z axis.

    Parameters
    ----------
    radius : float
        radius [m], 1e-04 to 10.
    length : float
        length along z [m], 1e-04 to 100.
    """

    @staticmethod
    def fields() -> list[Field]:
        """
        Return name, unit, meaning, default and range of every parameter.
        """
    def __eq__(self, other: typing.Any) -> bool: ...
    def __hash__(self) -> int: ...
    def __init__(self, *, radius: float = 0.02, length: float = 0.1) -> None: ...
    def __reduce__(self) -> tuple[typing.Any, ...]: ...
    def __repr__(self) -> str: ...
    def as_dict(self) -> dict[str, typing.Any]:
        """
        Return the parameters by name.
        """
    def replace(self, **changes: typing.Any) -> typing.Self:
        """
        Return a copy with some parameters changed, checked as at construction.
        """
    @property
    def length(self) -> float:
        """
        length along z [m], 1e-04 to 100
        """
    @property
    def radius(self) -> float:
        """
        radius [m], 1e-04 to 10
        """

class Capsule:
    """
    A cylinder about the z axis with half a sphere on each end.

    Parameters
    ----------
    radius : float
        radius [m], 1e-04 to 10.
    length : float
        between the centres of its ends [m], 0 to 100.
    """

    @staticmethod
    def fields() -> list[Field]:
        """
        Return name, unit, meaning, default and range of every parameter.
        """
    def __eq__(self, other: typing.Any) -> bool: ...
    def __hash__(self) -> int: ...
    def __init__(self, *, radius: float = 0.02, length: float = 0.1) -> None: ...
    def __reduce__(self) -> tuple[typing.Any, ...]: ...
    def __repr__(self) -> str: ...
    def as_dict(self) -> dict[str, typing.Any]:
        """
        Return the parameters by name.
        """
    def replace(self, **changes: typing.Any) -> typing.Self:
        """
        Return a copy with some parameters changed, checked as at construction.
        """
    @property
    def length(self) -> float:
        """
        between the centres of its ends [m], 0 to 100
        """
    @property
    def radius(self) -> float:
        """
        radius [m], 1e-04 to 10
        """

class Torus:
    """
    A ring about the z axis.

    Parameters
    ----------
    radius : float
        radius of the ring's centre line [m], 1e-04 to 10.
    tube : float
        radius of the tube [m], 1e-04 to 10.
    """

    @staticmethod
    def fields() -> list[Field]:
        """
        Return name, unit, meaning, default and range of every parameter.
        """
    def __eq__(self, other: typing.Any) -> bool: ...
    def __hash__(self) -> int: ...
    def __init__(self, *, radius: float = 0.03, tube: float = 0.01) -> None: ...
    def __reduce__(self) -> tuple[typing.Any, ...]: ...
    def __repr__(self) -> str: ...
    def as_dict(self) -> dict[str, typing.Any]:
        """
        Return the parameters by name.
        """
    def replace(self, **changes: typing.Any) -> typing.Self:
        """
        Return a copy with some parameters changed, checked as at construction.
        """
    @property
    def radius(self) -> float:
        """
        radius of the ring's centre line [m], 1e-04 to 10
        """
    @property
    def tube(self) -> float:
        """
        radius of the tube [m], 1e-04 to 10
        """

class Texture:
    """
    Waves on a surface, the same in all directions.

    Parameters
    ----------
    amplitude : float
        of the waves, above and below the smooth surface [m], 0 to 0.1.
    wavelength : float
        along each axis [m], 1e-04 to 1.
    """

    @staticmethod
    def fields() -> list[Field]:
        """
        Return name, unit, meaning, default and range of every parameter.
        """
    def __eq__(self, other: typing.Any) -> bool: ...
    def __hash__(self) -> int: ...
    def __init__(self, *, amplitude: float = 0.0002, wavelength: float = 0.005) -> None: ...
    def __reduce__(self) -> tuple[typing.Any, ...]: ...
    def __repr__(self) -> str: ...
    def as_dict(self) -> dict[str, typing.Any]:
        """
        Return the parameters by name.
        """
    def replace(self, **changes: typing.Any) -> typing.Self:
        """
        Return a copy with some parameters changed, checked as at construction.
        """
    @property
    def amplitude(self) -> float:
        """
        of the waves, above and below the smooth surface [m], 0 to 0.1
        """
    @property
    def wavelength(self) -> float:
        """
        along each axis [m], 1e-04 to 1
        """

class _Solid:
    def _time(
        self,
        points: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, 3]"],
        repeats: typing.SupportsInt | typing.SupportsIndex,
    ) -> float: ...
    def distances(
        self, points: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, 3]"]
    ) -> tuple[
        typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"],
        typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 3]"],
    ]: ...

class Elastic:
    """
    A spring and damper, eq. (12); a Kelvin-Voigt body.

    Parameters
    ----------
    stiffness : float
        stiffness of the surface, force per depth: K of eq. (12) [N/m], 0 to 1e+07.
    damping : float
        damping of the surface, force per speed in contact: B of eq. (12) [N s/m], 0 to 10000.
    """

    @staticmethod
    def fields() -> list[Field]:
        """
        Return name, unit, meaning, default and range of every parameter.
        """
    def __eq__(self, other: typing.Any) -> bool: ...
    def __hash__(self) -> int: ...
    def __init__(self, *, stiffness: float = 10000.0, damping: float = 0.0) -> None: ...
    def __reduce__(self) -> tuple[typing.Any, ...]: ...
    def __repr__(self) -> str: ...
    def as_dict(self) -> dict[str, typing.Any]:
        """
        Return the parameters by name.
        """
    def replace(self, **changes: typing.Any) -> typing.Self:
        """
        Return a copy with some parameters changed, checked as at construction.
        """
    @property
    def damping(self) -> float:
        """
        damping of the surface, force per speed in contact: B of eq. (12) [N s/m], 0 to 10000
        """
    @property
    def stiffness(self) -> float:
        """
        stiffness of the surface, force per depth: K of eq. (12) [N/m], 0 to 1e+07
        """

class HuntCrossley:
    """
    Soft tissue after Hunt and Crossley (1975).

    Parameters
    ----------
    stiffness : float
        k [N/m^n], 0 to 1e+09.
    exponent : float
        n, 1 to 3.
    dissipation : float
        a: loss at a speed, as a share [s/m], 0 to 100.
    """

    @staticmethod
    def fields() -> list[Field]:
        """
        Return name, unit, meaning, default and range of every parameter.
        """
    def __eq__(self, other: typing.Any) -> bool: ...
    def __hash__(self) -> int: ...
    def __init__(
        self, *, stiffness: float = 20000.0, exponent: float = 1.5, dissipation: float = 0.5
    ) -> None: ...
    def __reduce__(self) -> tuple[typing.Any, ...]: ...
    def __repr__(self) -> str: ...
    def as_dict(self) -> dict[str, typing.Any]:
        """
        Return the parameters by name.
        """
    def replace(self, **changes: typing.Any) -> typing.Self:
        """
        Return a copy with some parameters changed, checked as at construction.
        """
    @property
    def dissipation(self) -> float:
        """
        a: loss at a speed, as a share [s/m], 0 to 100
        """
    @property
    def exponent(self) -> float:
        """
        n, 1 to 3
        """
    @property
    def stiffness(self) -> float:
        """
        k [N/m^n], 0 to 1e+09
        """

class Layer:
    """
    One layer of tissue.

    Parameters
    ----------
    thickness : float
        of the layer at rest [m], 1e-05 to 1.
    stiffness : float
        until it is punctured [N/m], 0 to 1e+07.
    damping : float
        until it is punctured [N s/m], 0 to 10000.
    puncture : float
        force at which it gives way, 0: never [N], 0 to 1000.
    cutting : float
        against motion through it, once it is punctured [N], 0 to 100.
    """

    @staticmethod
    def fields() -> list[Field]:
        """
        Return name, unit, meaning, default and range of every parameter.
        """
    def __eq__(self, other: typing.Any) -> bool: ...
    def __hash__(self) -> int: ...
    def __init__(
        self,
        *,
        thickness: float = 0.005,
        stiffness: float = 500.0,
        damping: float = 0.0,
        puncture: float = 0.0,
        cutting: float = 0.0,
    ) -> None: ...
    def __reduce__(self) -> tuple[typing.Any, ...]: ...
    def __repr__(self) -> str: ...
    def as_dict(self) -> dict[str, typing.Any]:
        """
        Return the parameters by name.
        """
    def replace(self, **changes: typing.Any) -> typing.Self:
        """
        Return a copy with some parameters changed, checked as at construction.
        """
    @property
    def cutting(self) -> float:
        """
        against motion through it, once it is punctured [N], 0 to 100
        """
    @property
    def damping(self) -> float:
        """
        until it is punctured [N s/m], 0 to 10000
        """
    @property
    def puncture(self) -> float:
        """
        force at which it gives way, 0: never [N], 0 to 1000
        """
    @property
    def stiffness(self) -> float:
        """
        until it is punctured [N/m], 0 to 1e+07
        """
    @property
    def thickness(self) -> float:
        """
        of the layer at rest [m], 1e-05 to 1
        """

class Swing:
    """
    A body's motion: to and fro along a direction, turning about another.

    Parameters
    ----------
    amplitude_x : float
        of the swing along x [m], -1 to 1.
    amplitude_y : float
        of the swing along y [m], -1 to 1.
    amplitude_z : float
        of the swing along z [m], -1 to 1.
    frequency : float
        of the swing [Hz], 0 to 100.
    phase : float
        of the swing at the beginning [rad], -6.3 to 6.3.
    turn_x : float
        turning about x [rad/s], -100 to 100.
    turn_y : float
        turning about y [rad/s], -100 to 100.
    turn_z : float
        turning about z [rad/s], -100 to 100.
    """

    @staticmethod
    def fields() -> list[Field]:
        """
        Return name, unit, meaning, default and range of every parameter.
        """
    def __eq__(self, other: typing.Any) -> bool: ...
    def __hash__(self) -> int: ...
    def __init__(
        self,
        *,
        amplitude_x: float = 0.0,
        amplitude_y: float = 0.0,
        amplitude_z: float = 0.0,
        frequency: float = 0.5,
        phase: float = 0.0,
        turn_x: float = 0.0,
        turn_y: float = 0.0,
        turn_z: float = 0.0,
    ) -> None: ...
    def __reduce__(self) -> tuple[typing.Any, ...]: ...
    def __repr__(self) -> str: ...
    def as_dict(self) -> dict[str, typing.Any]:
        """
        Return the parameters by name.
        """
    def replace(self, **changes: typing.Any) -> typing.Self:
        """
        Return a copy with some parameters changed, checked as at construction.
        """
    def still(self) -> bool:
        """
        Return whether it does not move at all.
        """
    @property
    def amplitude_x(self) -> float:
        """
        of the swing along x [m], -1 to 1
        """
    @property
    def amplitude_y(self) -> float:
        """
        of the swing along y [m], -1 to 1
        """
    @property
    def amplitude_z(self) -> float:
        """
        of the swing along z [m], -1 to 1
        """
    @property
    def frequency(self) -> float:
        """
        of the swing [Hz], 0 to 100
        """
    @property
    def phase(self) -> float:
        """
        of the swing at the beginning [rad], -6.3 to 6.3
        """
    @property
    def turn_x(self) -> float:
        """
        turning about x [rad/s], -100 to 100
        """
    @property
    def turn_y(self) -> float:
        """
        turning about y [rad/s], -100 to 100
        """
    @property
    def turn_z(self) -> float:
        """
        turning about z [rad/s], -100 to 100
        """

class _Layered:
    def __init__(self, arg0: collections.abc.Sequence[Layer]) -> None: ...

class _EngineEnd:
    def __init__(self) -> None: ...
    def pose(
        self,
    ) -> (
        tuple[
            typing.Annotated[numpy.typing.NDArray[numpy.float64], "[3, 1]"],
            typing.Annotated[numpy.typing.NDArray[numpy.float64], "[3, 1]"],
            float,
        ]
        | None
    ): ...
    def post(
        self,
        model: tuple[
            typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[3, 1]"],
            typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[3, 1]"],
            typing.SupportsFloat | typing.SupportsIndex,
            typing.SupportsFloat | typing.SupportsIndex,
            typing.SupportsFloat | typing.SupportsIndex,
            typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[3, 1]"],
        ]
        | None,
    ) -> None: ...
    def world(self, params: BridgeParams) -> _World: ...

class _SharedEngineChannel:
    def __init__(self, name: str) -> None: ...
    def end(self) -> None: ...
    def world(self, params: BridgeParams) -> _World: ...
    @property
    def engine(self) -> int: ...
    @property
    def engine_lives(self) -> bool: ...
    @property
    def name(self) -> str: ...
    @property
    def posted(self) -> int: ...

class _EngineClient:
    def __init__(self, name: str) -> None: ...
    def pose(
        self,
    ) -> (
        tuple[
            typing.Annotated[numpy.typing.NDArray[numpy.float64], "[3, 1]"],
            typing.Annotated[numpy.typing.NDArray[numpy.float64], "[3, 1]"],
            float,
        ]
        | None
    ): ...
    def post(
        self,
        model: tuple[
            typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[3, 1]"],
            typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[3, 1]"],
            typing.SupportsFloat | typing.SupportsIndex,
            typing.SupportsFloat | typing.SupportsIndex,
            typing.SupportsFloat | typing.SupportsIndex,
            typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[3, 1]"],
        ]
        | None,
    ) -> None: ...
    @property
    def loop_runs(self) -> bool: ...

class _World:
    @typing.overload
    def __init__(
        self,
        arg0: collections.abc.Sequence[
            tuple[
                _Solid,
                Elastic | HuntCrossley | _Layered,
                typing.SupportsFloat | typing.SupportsIndex,
                Swing,
            ]
        ],
    ) -> None: ...
    @typing.overload
    def __init__(self, other: _World) -> None: ...
    def _time(
        self,
        start: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[3, 1]"],
        path: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, 3]"],
        repeats: typing.SupportsInt | typing.SupportsIndex,
    ) -> float: ...
    def contact(
        self,
        x: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[3, 1]"],
        v: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[3, 1]"],
        t: typing.SupportsFloat | typing.SupportsIndex,
    ) -> tuple[
        typing.Annotated[numpy.typing.NDArray[numpy.float64], "[3, 1]"],
        typing.Annotated[numpy.typing.NDArray[numpy.float64], "[3, 1]"],
        float,
        float,
        float,
    ]: ...
    def reset(self) -> None: ...

class Free:
    """
    Free space: no force.
    """
    @staticmethod
    def fields() -> list[Field]:
        """
        Return name, unit, meaning, default and range of every parameter.
        """
    def __eq__(self, other: typing.Any) -> bool: ...
    def __hash__(self) -> int: ...
    def __init__(self) -> None: ...
    def __reduce__(self) -> tuple[typing.Any, ...]: ...
    def __repr__(self) -> str: ...
    def as_dict(self) -> dict[str, typing.Any]:
        """
        Return the parameters by name.
        """
    def force(
        self,
        x: collections.abc.Sequence[typing.SupportsFloat | typing.SupportsIndex],
        v: collections.abc.Sequence[typing.SupportsFloat | typing.SupportsIndex],
    ) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"]:
        """
        Return the force [N] at position x [m] and velocity v [m/s], shape (axes,).
        """
    def replace(self, **changes: typing.Any) -> typing.Self:
        """
        Return a copy with some parameters changed, checked as at construction.
        """

class Wall:
    """
    A flat wall, eq. (12), which never pulls.

    Parameters
    ----------
    stiffness : float
        stiffness of the surface, force per depth: K of eq. (12) [N/m], 0 to 1e+07.
    damping : float
        damping of the surface, force per speed in contact: B of eq. (12) [N s/m], 0 to 10000.
    position : float
        where its surface cuts the normal through the origin [m], -10 to 10.
    angle : float
        direction into the wall, from +x towards +y [rad], -3.2 to 3.2.
    motion_amplitude : float
        of a sine along the normal; not in a Corner [m], 0 to 0.1.
    motion_frequency : float
        of that motion [Hz], 0 to 100.
    """

    @staticmethod
    def fields() -> list[Field]:
        """
        Return name, unit, meaning, default and range of every parameter.
        """
    def __eq__(self, other: typing.Any) -> bool: ...
    def __hash__(self) -> int: ...
    def __init__(
        self,
        *,
        stiffness: float = 10000.0,
        damping: float = 0.0,
        position: float = 0.0,
        angle: float = 0.0,
        motion_amplitude: float = 0.0,
        motion_frequency: float = 2.0,
    ) -> None: ...
    def __reduce__(self) -> tuple[typing.Any, ...]: ...
    def __repr__(self) -> str: ...
    def as_dict(self) -> dict[str, typing.Any]:
        """
        Return the parameters by name.
        """
    def force(
        self,
        x: collections.abc.Sequence[typing.SupportsFloat | typing.SupportsIndex],
        v: collections.abc.Sequence[typing.SupportsFloat | typing.SupportsIndex],
    ) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"]:
        """
        Return the force [N] at position x [m] and velocity v [m/s], shape (axes,).
        """
    def replace(self, **changes: typing.Any) -> typing.Self:
        """
        Return a copy with some parameters changed, checked as at construction.
        """
    @property
    def angle(self) -> float:
        """
        direction into the wall, from +x towards +y [rad], -3.2 to 3.2
        """
    @property
    def damping(self) -> float:
        """
        damping of the surface, force per speed in contact: B of eq. (12) [N s/m], 0 to 10000
        """
    @property
    def motion_amplitude(self) -> float:
        """
        of a sine along the normal; not in a Corner [m], 0 to 0.1
        """
    @property
    def motion_frequency(self) -> float:
        """
        of that motion [Hz], 0 to 100
        """
    @property
    def position(self) -> float:
        """
        where its surface cuts the normal through the origin [m], -10 to 10
        """
    @property
    def stiffness(self) -> float:
        """
        stiffness of the surface, force per depth: K of eq. (12) [N/m], 0 to 1e+07
        """

class Disc:
    """
    A round pillar in the plane, touched from outside.

    Parameters
    ----------
    stiffness : float
        stiffness of the surface, force per depth: K of eq. (12), along the radius [N/m], 0 to 1e+07.
    damping : float
        damping of the surface, force per speed in contact: B of eq. (12), along the radius [N s/m], 0 to 10000.
    x : float
        centre [m], -10 to 10.
    y : float
        centre [m], -10 to 10.
    radius : float
        radius [m], 1e-04 to 10.
    """
    @staticmethod
    def fields() -> list[Field]:
        """
        Return name, unit, meaning, default and range of every parameter.
        """
    def __eq__(self, other: typing.Any) -> bool: ...
    def __hash__(self) -> int: ...
    def __init__(
        self,
        *,
        stiffness: float = 10000.0,
        damping: float = 0.0,
        x: float = 0.03,
        y: float = 0.0,
        radius: float = 0.02,
    ) -> None: ...
    def __reduce__(self) -> tuple[typing.Any, ...]: ...
    def __repr__(self) -> str: ...
    def as_dict(self) -> dict[str, typing.Any]:
        """
        Return the parameters by name.
        """
    def force(
        self,
        x: collections.abc.Sequence[typing.SupportsFloat | typing.SupportsIndex],
        v: collections.abc.Sequence[typing.SupportsFloat | typing.SupportsIndex],
    ) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"]:
        """
        Return the force [N] at position x [m] and velocity v [m/s], shape (axes,).
        """
    def replace(self, **changes: typing.Any) -> typing.Self:
        """
        Return a copy with some parameters changed, checked as at construction.
        """
    @property
    def damping(self) -> float:
        """
        damping of the surface, force per speed in contact: B of eq. (12), along the radius [N s/m], 0 to 10000
        """
    @property
    def radius(self) -> float:
        """
        radius [m], 1e-04 to 10
        """
    @property
    def stiffness(self) -> float:
        """
        stiffness of the surface, force per depth: K of eq. (12), along the radius [N/m], 0 to 1e+07
        """
    @property
    def x(self) -> float:
        """
        centre [m], -10 to 10
        """
    @property
    def y(self) -> float:
        """
        centre [m], -10 to 10
        """

class Corner:
    """
    Two intersecting walls: each pushes along its own normal.
    """
    def __eq__(self, other: typing.Any) -> bool: ...
    def __hash__(self) -> int: ...
    def __init__(self, *, first: Wall = ..., second: Wall = ...) -> None: ...
    def __reduce__(self) -> tuple[typing.Any, ...]: ...
    def __repr__(self) -> str: ...
    def as_dict(self) -> dict[str, typing.Any]:
        """
        Return the parameters by name.
        """
    def force(
        self,
        x: collections.abc.Sequence[typing.SupportsFloat | typing.SupportsIndex],
        v: collections.abc.Sequence[typing.SupportsFloat | typing.SupportsIndex],
    ) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"]:
        """
        Return the force [N] at position x [m] and velocity v [m/s], shape (axes,).
        """
    def replace(self, **changes: typing.Any) -> typing.Self:
        """
        Return a copy with some parameters changed, checked as at construction.
        """
    @property
    def first(self) -> Wall:
        """
        One wall.
        """
    @property
    def second(self) -> Wall:
        """
        The other wall.
        """

class Column:
    """
    Position of a named quantity in a row.
    """
    @property
    def kind(self) -> str:
        """
        f double, i int64, w int32, u uint32, b bool.
        """
    @property
    def meaning(self) -> str:
        """
        Meaning.
        """
    @property
    def name(self) -> str:
        """
        Name.
        """
    @property
    def offset(self) -> int:
        """
        Bytes from the start of the row to the first axis.
        """
    @property
    def stride(self) -> int:
        """
        Bytes from axis to axis; 0 for one value per row.
        """
    @property
    def unit(self) -> str:
        """
        SI unit; '1' for a pure number.
        """

class RowLayout:
    """
    How rows are laid out; hashable, equal to that of like rows.
    """
    def __eq__(self, arg0: object) -> bool: ...
    def __hash__(self) -> int: ...
    @property
    def axes(self) -> int:
        """
        Number of axes.
        """
    @property
    def columns(self) -> list[Column]:
        """
        Columns in their order.
        """
    @property
    def row_bytes(self) -> int:
        """
        Bytes per row.
        """

class Rows:
    """
    The rows of a run, as written by the loop.
    """
    def __len__(self) -> int: ...
    def append(self, row: typing.Annotated[numpy.typing.ArrayLike, numpy.uint8]) -> None:
        """
        Append one row of `row_bytes` bytes.
        """
    def bytes(self) -> numpy.typing.NDArray[numpy.uint8]:
        """
        Return all rows in memory, read-only; a ring returns a copy, others a view.
        """
    def copy(
        self,
        start: typing.SupportsInt | typing.SupportsIndex,
        stop: typing.SupportsInt | typing.SupportsIndex,
    ) -> tuple[int, numpy.typing.NDArray[numpy.uint8]]:
        """
        Copy the rows start to stop, without rows overwritten by a ring; return (number of the first row, rows).
        """
    def empty_like(
        self, capacity: typing.SupportsInt | typing.SupportsIndex, ring: bool = False
    ) -> Rows:
        """
        Return an empty trace of the same layout.
        """
    def port(
        self,
        row: typing.SupportsInt | typing.SupportsIndex,
        axis: typing.SupportsInt | typing.SupportsIndex = 0,
    ) -> Port:
        """
        Return the port as the law saw it in a tick.
        """
    @property
    def axes(self) -> int:
        """
        Number of axes.
        """
    @property
    def capacity(self) -> int:
        """
        Largest number of rows.
        """
    @property
    def count(self) -> int:
        """
        Rows appended since the start.
        """
    @property
    def first(self) -> int:
        """
        Number of the first row still in memory.
        """
    @property
    def layout(self) -> RowLayout:
        """
        How the rows are laid out.
        """
    @property
    def ring(self) -> bool:
        """
        Whether this is a ring, which keeps the last rows and never fills up.
        """
    @property
    def row_bytes(self) -> int:
        """
        Bytes per row.
        """

class Setup:
    """
    Setup of a simulated run, without the law.
    """
    def __init__(
        self,
        *,
        device: Device,
        hand: Hand,
        environment: Free | Wall | Corner | Disc | _World,
        timing: Timing,
        seconds: typing.SupportsFloat | typing.SupportsIndex,
        jitter: typing.SupportsFloat | typing.SupportsIndex,
        seed: typing.SupportsInt | typing.SupportsIndex,
        observer: Observer | None = None,
    ) -> None: ...
    def _raise_hand_error(self) -> None:
        """
        Raise what a hand in Python raised in the run of this setup.
        """

class AxisTruth:
    """
    True state of an axis, known only in a simulation.

    Parameters
    ----------
    x : float
        true handle position [m].
    v : float
        true handle velocity [m/s].
    f_hand : float
        force of the hand on the handle, towards +x [N].
    f_motor : float
        motor force behind the current loop; resists +x [N].
    f_sensor : float
        hand force behind the sensor's lag [N].
    energy : float
        physical port energy: integral of (f_motor v + b v^2 + friction |v|) dt, without the work that carries the weight of the device [J].
    """
    @staticmethod
    def fields() -> list[Field]:
        """
        Return name, unit, meaning, default and range of every parameter.
        """
    def __eq__(self, other: typing.Any) -> bool: ...
    def __hash__(self) -> int: ...
    def __init__(
        self,
        *,
        x: float = 0.0,
        v: float = 0.0,
        f_hand: float = 0.0,
        f_motor: float = 0.0,
        f_sensor: float = 0.0,
        energy: float = 0.0,
    ) -> None: ...
    def __reduce__(self) -> tuple[typing.Any, ...]: ...
    def __repr__(self) -> str: ...
    def as_dict(self) -> dict[str, typing.Any]:
        """
        Return the parameters by name.
        """
    def replace(self, **changes: typing.Any) -> typing.Self:
        """
        Return a copy with some parameters changed, checked as at construction.
        """
    @property
    def energy(self) -> float:
        """
        physical port energy: integral of (f_motor v + b v^2 + friction |v|) dt, without the work that carries the weight of the device [J]
        """
    @property
    def f_hand(self) -> float:
        """
        force of the hand on the handle, towards +x [N]
        """
    @property
    def f_motor(self) -> float:
        """
        motor force behind the current loop; resists +x [N]
        """
    @property
    def f_sensor(self) -> float:
        """
        hand force behind the sensor's lag [N]
        """
    @property
    def v(self) -> float:
        """
        true handle velocity [m/s]
        """
    @property
    def x(self) -> float:
        """
        true handle position [m]
        """

class ExactPlant:
    """
    Independent rigid axes with a hand on each, integrated exactly.
    """
    def __init__(
        self, *, device: Device, hand: Hand, tick: typing.SupportsFloat | typing.SupportsIndex
    ) -> None: ...
    def advance(
        self,
        current: collections.abc.Sequence[typing.SupportsFloat | typing.SupportsIndex],
        t: typing.SupportsFloat | typing.SupportsIndex,
        share: typing.SupportsFloat | typing.SupportsIndex = 1.0,
    ) -> None:
        """
        Advance by `share` of a tick from time t [s] on, under constant motor currents [A].
        """
    def truth(self, axis: typing.SupportsInt | typing.SupportsIndex = 0) -> AxisTruth:
        """
        Return the state of one axis.
        """

class SteppedPlant:
    """
    Any device with a hand on it, integrated step by step.
    """
    def __init__(
        self, *, device: Device, hand: Hand, tick: typing.SupportsFloat | typing.SupportsIndex
    ) -> None: ...
    def advance(
        self,
        current: collections.abc.Sequence[typing.SupportsFloat | typing.SupportsIndex],
        t: typing.SupportsFloat | typing.SupportsIndex,
        share: typing.SupportsFloat | typing.SupportsIndex = 1.0,
    ) -> None:
        """
        Advance by `share` of a tick from time t [s] on, under constant motor currents [A].
        """
    def truth(self, axis: typing.SupportsInt | typing.SupportsIndex = 0) -> AxisTruth:
        """
        Return the state of one axis.
        """

class ReplayLog:
    """
    A recorded log as a device.
    """
    def __init__(
        self,
        *,
        t: typing.Annotated[numpy.typing.ArrayLike, numpy.float64],
        dt: typing.Annotated[numpy.typing.ArrayLike, numpy.float64],
        lateness: typing.Annotated[numpy.typing.ArrayLike, numpy.float64],
        fault: typing.Annotated[numpy.typing.ArrayLike, numpy.uint32],
        force_age: typing.Annotated[numpy.typing.ArrayLike, numpy.float64],
        force_status: typing.Annotated[numpy.typing.ArrayLike, numpy.uint32],
        counts: typing.Annotated[numpy.typing.ArrayLike, numpy.int64],
        counts_age: typing.Annotated[numpy.typing.ArrayLike, numpy.float64],
        current_applied: typing.Annotated[numpy.typing.ArrayLike, numpy.float64],
        force: typing.Annotated[numpy.typing.ArrayLike, numpy.float64],
        f_env: typing.Annotated[numpy.typing.ArrayLike, numpy.float64],
        f_cmd: typing.Annotated[numpy.typing.ArrayLike, numpy.float64],
        current: typing.Annotated[numpy.typing.ArrayLike, numpy.float64],
        gain: typing.Annotated[numpy.typing.ArrayLike, numpy.float64],
        came: typing.Annotated[numpy.typing.ArrayLike, numpy.float64],
    ) -> None: ...
    def __len__(self) -> int: ...
    @property
    def axes(self) -> int:
        """
        Number of axes.
        """
    @property
    def observer(self) -> Observer | None:
        """
        Observer of the replay, or None.
        """
    @observer.setter
    def observer(self, arg0: Observer | None) -> None: ...

class SensorModel(enum.IntEnum):
    """
    Sensor model, which defines the status bits.
    """

    AXIA = ...
    NET_FT = ...
    OTHER = ...

class SensorStatus(enum.IntEnum):
    """
    Status reported by the force sensor.
    """

    DISCONNECTED = ...
    ERROR = ...
    GOOD = ...
    SATURATED = ...

class LinkState(enum.IntEnum):
    """
    State of the connection to a sensor.
    """

    CLOSED = ...
    REFUSED = ...
    SILENT = ...
    STOPPED = ...
    STREAMING = ...
    UNREACHABLE = ...
    WAITING = ...

class FtScale:
    """
    Units and range of the counts of a force/torque sensor.

    Parameters
    ----------
    counts_per_force : float
        counts of one newton [1/N], 0.001 to 1e+12.
    counts_per_torque : float
        counts of one newton metre [1/(N m)], 0.001 to 1e+12.
    force_range : float
        a force along one of its axes that large is saturated, whatever its status says; 0 to trust the status [N], 0 to 1e+06.
    torque_range : float
        the same of a torque [N m], 0 to 1e+06.
    """
    @staticmethod
    def fields() -> list[Field]:
        """
        Return name, unit, meaning, default and range of every parameter.
        """
    def __eq__(self, other: typing.Any) -> bool: ...
    def __hash__(self) -> int: ...
    def __init__(
        self,
        *,
        counts_per_force: float = 1000000.0,
        counts_per_torque: float = 1000000.0,
        force_range: float = 0.0,
        torque_range: float = 0.0,
    ) -> None: ...
    def __reduce__(self) -> tuple[typing.Any, ...]: ...
    def __repr__(self) -> str: ...
    def as_dict(self) -> dict[str, typing.Any]:
        """
        Return the parameters by name.
        """
    def replace(self, **changes: typing.Any) -> typing.Self:
        """
        Return a copy with some parameters changed, checked as at construction.
        """
    @property
    def counts_per_force(self) -> float:
        """
        counts of one newton [1/N], 0.001 to 1e+12
        """
    @property
    def counts_per_torque(self) -> float:
        """
        counts of one newton metre [1/(N m)], 0.001 to 1e+12
        """
    @property
    def force_range(self) -> float:
        """
        a force along one of its axes that large is saturated, whatever its status says; 0 to trust the status [N], 0 to 1e+06
        """
    @property
    def torque_range(self) -> float:
        """
        the same of a torque [N m], 0 to 1e+06
        """

class RdtSetup:
    """
    Address and mounting of a force sensor.
    """
    def __init__(
        self,
        host: str,
        port: typing.SupportsInt | typing.SupportsIndex,
        *,
        scale: FtScale,
        rotation: typing.Annotated[
            collections.abc.Sequence[typing.SupportsFloat | typing.SupportsIndex], "FixedSize(9)"
        ],
        sign: typing.SupportsInt | typing.SupportsIndex,
        model: SensorModel,
        retry: typing.SupportsFloat | typing.SupportsIndex,
        gone: typing.SupportsFloat | typing.SupportsIndex,
        bias: typing.Annotated[
            collections.abc.Sequence[typing.SupportsFloat | typing.SupportsIndex], "FixedSize(6)"
        ],
    ) -> None: ...

class RdtClient:
    """
    A force/torque sensor on the network.
    """
    def __init__(self, setup: RdtSetup) -> None: ...
    def begin_bias(self, records: typing.SupportsInt | typing.SupportsIndex) -> None:
        """
        Take the mean of the next `records` valid records as zero.
        """
    def bias_sensor(self) -> None:
        """
        Make the sensor take the present load as zero.
        """
    def cancel_bias(self) -> None:
        """
        Take no zero after all; it stays what it was.
        """
    def close(self) -> None:
        """
        Close the connection.
        """
    def poll(self, timeout: typing.SupportsFloat | typing.SupportsIndex = 0.0) -> bool:
        """
        Read all records, waiting up to `timeout` [s] for a new one; return whether one arrived.
        """
    def start(self) -> None:
        """
        Request a stream.
        """
    def stop(self) -> None:
        """
        End the stream.
        """
    @property
    def age(self) -> float:
        """
        Age of the newest record at the last poll [s].
        """
    @property
    def asked(self) -> int:
        """
        Streams requested.
        """
    @property
    def bias(self) -> typing.Annotated[list[float], "FixedSize(6)"]:
        """
        Zero of the readings: force, torque [counts].
        """
    @property
    def biasing(self) -> bool:
        """
        Whether a bias is being taken.
        """
    @property
    def duplicate(self) -> int:
        """
        Duplicate records.
        """
    @property
    def force(self) -> typing.Annotated[list[float], "FixedSize(3)"]:
        """
        Force at the handle [N].
        """
    @property
    def foreign(self) -> int:
        """
        Packets from other senders.
        """
    @property
    def ft_sequence(self) -> int:
        """
        Sample number of the sensor in the newest record.
        """
    @property
    def health(self) -> SensorStatus:
        """
        Status reported by the sensor.
        """
    @property
    def late(self) -> int:
        """
        Records that arrived after a newer one.
        """
    @property
    def lost(self) -> int:
        """
        Lost records.
        """
    @property
    def malformed(self) -> int:
        """
        Packets of the sensor that are not valid records.
        """
    @property
    def rdt_sequence(self) -> int:
        """
        Number of the newest record.
        """
    @property
    def received(self) -> int:
        """
        Records used.
        """
    @property
    def refused(self) -> int:
        """
        Requests that this machine could not send.
        """
    @property
    def state(self) -> LinkState:
        """
        State of the connection.
        """
    @property
    def status(self) -> int:
        """
        Status bits of the newest record.
        """
    @property
    def torque(self) -> typing.Annotated[list[float], "FixedSize(3)"]:
        """
        Torque about the axes of the handle [N m].
        """

class EmulatorOptions:
    """
    Properties of an emulated force sensor.

    Parameters
    ----------
    rate : float
        records a second [Hz], 1 to 7000.
    counts_per_force : float
        counts of one newton [1/N], 0.001 to 1e+07.
    counts_per_torque : float
        counts of one newton metre [1/(N m)], 0.001 to 1e+08.
    force_range : float
        largest force along an axis; it saturates [N], 0.001 to 1e+05.
    torque_range : float
        largest torque about an axis [N m], 0.001 to 1e+05.
    lever : float
        from the sensor to where the hand holds, along its z axis [m], -1 to 1.
    load : float
        what weighs on its z axis besides the hand, until a bias [N], -10000 to 10000.
    buffer : int
        records in a packet of a buffered stream, 1 to 40.
    """
    @staticmethod
    def fields() -> list[Field]:
        """
        Return name, unit, meaning, default and range of every parameter.
        """
    def __eq__(self, other: typing.Any) -> bool: ...
    def __hash__(self) -> int: ...
    def __init__(
        self,
        *,
        rate: float = 1000.0,
        counts_per_force: float = 1000000.0,
        counts_per_torque: float = 1000000.0,
        force_range: float = 145.0,
        torque_range: float = 5.0,
        lever: float = 0.02,
        load: float = 0.0,
        buffer: int = 10,
    ) -> None: ...
    def __reduce__(self) -> tuple[typing.Any, ...]: ...
    def __repr__(self) -> str: ...
    def as_dict(self) -> dict[str, typing.Any]:
        """
        Return the parameters by name.
        """
    def replace(self, **changes: typing.Any) -> typing.Self:
        """
        Return a copy with some parameters changed, checked as at construction.
        """
    @property
    def buffer(self) -> int:
        """
        records in a packet of a buffered stream, 1 to 40
        """
    @property
    def counts_per_force(self) -> float:
        """
        counts of one newton [1/N], 0.001 to 1e+07
        """
    @property
    def counts_per_torque(self) -> float:
        """
        counts of one newton metre [1/(N m)], 0.001 to 1e+08
        """
    @property
    def force_range(self) -> float:
        """
        largest force along an axis; it saturates [N], 0.001 to 1e+05
        """
    @property
    def lever(self) -> float:
        """
        from the sensor to where the hand holds, along its z axis [m], -1 to 1
        """
    @property
    def load(self) -> float:
        """
        what weighs on its z axis besides the hand, until a bias [N], -10000 to 10000
        """
    @property
    def rate(self) -> float:
        """
        records a second [Hz], 1 to 7000
        """
    @property
    def torque_range(self) -> float:
        """
        largest torque about an axis [N m], 0.001 to 1e+05
        """

class EmulatorTrouble:
    """
    Errors of an emulated force sensor.

    Parameters
    ----------
    loss : float
        share of the packets that are not sent, 0 to 1.
    duplicate : float
        share that is sent twice, 0 to 1.
    reorder : float
        share that is sent after the next one, 0 to 1.
    silent : bool
        whether nothing at all is sent, 0 to 1.
    status : int
        bits set in every record, 0 to 4294967295.
    """
    @staticmethod
    def fields() -> list[Field]:
        """
        Return name, unit, meaning, default and range of every parameter.
        """
    def __eq__(self, other: typing.Any) -> bool: ...
    def __hash__(self) -> int: ...
    def __init__(
        self,
        *,
        loss: float = 0.0,
        duplicate: float = 0.0,
        reorder: float = 0.0,
        silent: bool = False,
        status: int = 0,
    ) -> None: ...
    def __reduce__(self) -> tuple[typing.Any, ...]: ...
    def __repr__(self) -> str: ...
    def as_dict(self) -> dict[str, typing.Any]:
        """
        Return the parameters by name.
        """
    def replace(self, **changes: typing.Any) -> typing.Self:
        """
        Return a copy with some parameters changed, checked as at construction.
        """
    @property
    def duplicate(self) -> float:
        """
        share that is sent twice, 0 to 1
        """
    @property
    def loss(self) -> float:
        """
        share of the packets that are not sent, 0 to 1
        """
    @property
    def reorder(self) -> float:
        """
        share that is sent after the next one, 0 to 1
        """
    @property
    def silent(self) -> bool:
        """
        whether nothing at all is sent, 0 to 1
        """
    @property
    def status(self) -> int:
        """
        bits set in every record, 0 to 4294967295
        """

class EmulatorCounts:
    """
    Counts of an emulated sensor.
    """
    @staticmethod
    def fields() -> list[Field]:
        """
        Return name, unit, meaning, default and range of every parameter.
        """
    @property
    def doubled(self) -> int:
        """
        packets sent twice
        """
    @property
    def dropped(self) -> int:
        """
        packets lost on purpose, or while silent
        """
    @property
    def refused(self) -> int:
        """
        packets that are no request it knows
        """
    @property
    def requests(self) -> int:
        """
        requests obeyed
        """
    @property
    def sent(self) -> int:
        """
        packets sent, doubles included
        """
    @property
    def swapped(self) -> int:
        """
        packets sent after the next one
        """

class SharedForce:
    """
    The force at a handle, from a simulated hand to an emulated sensor. One writer, one reader.
    """
    def __init__(
        self,
        force: typing.Annotated[
            collections.abc.Sequence[typing.SupportsFloat | typing.SupportsIndex], "FixedSize(3)"
        ] = [0.0, 0.0, 0.0],
    ) -> None: ...
    def post(
        self,
        force: typing.Annotated[
            collections.abc.Sequence[typing.SupportsFloat | typing.SupportsIndex], "FixedSize(3)"
        ],
    ) -> None:
        """
        Set the force [N].
        """

class RdtEmulator:
    """
    An emulated force/torque sensor on the network, in real time, in a thread of its own that
    never waits for Python. `source` is a shared force, or a setup with device and hand.
    """
    @typing.overload
    def __init__(
        self,
        host: str,
        port: typing.SupportsInt | typing.SupportsIndex,
        source: SharedForce,
        *,
        options: EmulatorOptions,
        rotation: typing.Annotated[
            collections.abc.Sequence[typing.SupportsFloat | typing.SupportsIndex], "FixedSize(9)"
        ],
        sign: typing.SupportsInt | typing.SupportsIndex,
        model: SensorModel,
        seed: typing.SupportsInt | typing.SupportsIndex,
    ) -> None: ...
    @typing.overload
    def __init__(
        self,
        host: str,
        port: typing.SupportsInt | typing.SupportsIndex,
        source: Setup,
        *,
        options: EmulatorOptions,
        rotation: typing.Annotated[
            collections.abc.Sequence[typing.SupportsFloat | typing.SupportsIndex], "FixedSize(9)"
        ],
        sign: typing.SupportsInt | typing.SupportsIndex,
        model: SensorModel,
        seed: typing.SupportsInt | typing.SupportsIndex,
    ) -> None: ...
    def set(self, trouble: EmulatorTrouble) -> None:
        """
        Set the errors to emulate.
        """
    def start(self, mode: RealTimeMode = ..., realtime: RealTime = ...) -> None:
        """
        Start the sensor on the network; possible once.
        """
    def stop(self) -> None:
        """
        Stop the sensor for good.
        """
    @property
    def address(self) -> tuple[str, int]:
        """
        Host and port.
        """
    @property
    def counts(self) -> EmulatorCounts:
        """
        Counts so far.
        """
    @property
    def grants(self) -> list[Grant]:
        """
        Resources that its thread requested and was granted; empty before the start.
        """

class DriveCondition(enum.IntFlag):
    """
    Conditions that can be injected into a simulated drive.
    """

    BRAKE_STUCK = ...
    ENABLE_MISSING = ...
    ENCODER_LOST = ...
    MOTOR_TEMPERATURE = ...
    OVER_TEMPERATURE = ...
    OVER_VOLTAGE = ...
    SHORT_CIRCUIT = ...
    SILENT = ...
    TORQUE_OFF = ...
    UNDER_VOLTAGE = ...

class DriveState(enum.IntEnum):
    """
    State of a simulated drive (CiA 402).
    """

    FAULT = ...
    FAULT_REACTION_ACTIVE = ...
    NOT_READY_TO_SWITCH_ON = ...
    OPERATION_ENABLED = ...
    QUICK_STOP_ACTIVE = ...
    READY_TO_SWITCH_ON = ...
    SWITCHED_ON = ...
    SWITCH_ON_DISABLED = ...

class SimulatedDrive:
    """
    A simulated CANopen servo drive without a motor: receives frames, advances time, answers.
    """
    def __init__(
        self,
        *,
        node: typing.SupportsInt | typing.SupportsIndex = 1,
        motor: Motor = ...,
        drive: Drive = ...,
        peak_time: typing.SupportsFloat | typing.SupportsIndex = 2.0,
        sheet: collections.abc.Sequence[
            tuple[int, int, str, bool, int, int, int, int | None, str]
        ] = [],
    ) -> None: ...
    def eds(self) -> str:
        """
        Electronic data sheet (CiA 306).
        """
    def elapse(self, seconds: typing.SupportsFloat | typing.SupportsIndex) -> None:
        """
        Advance time by `seconds` [s].
        """
    def receive(
        self,
        id: typing.SupportsInt | typing.SupportsIndex,
        data: bytes = b"",
        *,
        remote: bool = False,
    ) -> None:
        """
        Receive one frame from the bus.
        """
    def set_condition(self, condition: DriveCondition, present: bool) -> None:
        """
        Inject a condition, or remove it.
        """
    def set_position(self, counts: typing.SupportsInt | typing.SupportsIndex) -> None:
        """
        Set the encoder to `counts`.
        """
    def take(self) -> list[tuple[int, bytes]]:
        """
        Return all waiting answers as (id, data).
        """
    @property
    def current(self) -> float:
        """
        Motor current [A].
        """
    @property
    def node(self) -> int:
        """
        Node number.
        """
    @property
    def state(self) -> DriveState:
        """
        State of CiA 402.
        """

class DriveWiring:
    """
    How simulated drives are set on their bus and connected to a device: for each axis the node id (1 to
    127; default 1, 2, 3), the rows of an electronic data sheet, the counts shown at the device's zero, and
    the signs of motor and encoder (1 or -1). An empty list leaves the default.
    """
    def __init__(
        self,
        *,
        nodes: collections.abc.Sequence[typing.SupportsInt | typing.SupportsIndex] = [],
        sheets: collections.abc.Sequence[
            collections.abc.Sequence[tuple[int, int, str, bool, int, int, int, int | None, str]]
        ] = [],
        zero: collections.abc.Sequence[typing.SupportsInt | typing.SupportsIndex] = [],
        motor: collections.abc.Sequence[typing.SupportsInt | typing.SupportsIndex] = [],
        encoder: collections.abc.Sequence[typing.SupportsInt | typing.SupportsIndex] = [],
    ) -> None: ...

class Joystick:
    """
    Simulated drives on the axes of one simulated device and hand.
    """
    def __init__(
        self,
        setup: Setup,
        *,
        wiring: DriveWiring = ...,
        peak_time: typing.SupportsFloat | typing.SupportsIndex = 2.0,
        force: SharedForce | None = None,
        wait_for_power: bool = False,
        aim: SharedHandTarget | None = None,
        longest_step: typing.SupportsFloat | typing.SupportsIndex = ...,
    ) -> None: ...
    def drive(self, axis: typing.SupportsInt | typing.SupportsIndex = 0) -> SimulatedDrive:
        """
        Drive of one axis.
        """
    def elapse(self, seconds: typing.SupportsFloat | typing.SupportsIndex) -> None:
        """
        Advance time by `seconds` [s].
        """
    def receive(
        self,
        id: typing.SupportsInt | typing.SupportsIndex,
        data: bytes = b"",
        *,
        remote: bool = False,
    ) -> None:
        """
        Receive one frame from the bus.
        """
    def take(self) -> list[tuple[int, bytes]]:
        """
        Return all waiting answers as (id, data).
        """
    def truth(self, axis: typing.SupportsInt | typing.SupportsIndex = 0) -> AxisTruth:
        """
        Return the true state of one axis.
        """
    @property
    def axes(self) -> int:
        """
        Number of axes.
        """

class RunLimits:
    """
    Bounds beyond which a run of a sweep counts as diverged and ends.

    Parameters
    ----------
    position : float
        a run that goes farther from zero has diverged [m], 0.001 to 1000.
    energy : float
        so has one that takes more energy out of the port [J], 0.001 to 1e+09.
    """
    @staticmethod
    def fields() -> list[Field]:
        """
        Return name, unit, meaning, default and range of every parameter.
        """
    def __eq__(self, other: typing.Any) -> bool: ...
    def __hash__(self) -> int: ...
    def __init__(self, *, position: float = 1.0, energy: float = 1000.0) -> None: ...
    def __reduce__(self) -> tuple[typing.Any, ...]: ...
    def __repr__(self) -> str: ...
    def as_dict(self) -> dict[str, typing.Any]:
        """
        Return the parameters by name.
        """
    def replace(self, **changes: typing.Any) -> typing.Self:
        """
        Return a copy with some parameters changed, checked as at construction.
        """
    @property
    def energy(self) -> float:
        """
        so has one that takes more energy out of the port [J], 0.001 to 1e+09
        """
    @property
    def position(self) -> float:
        """
        a run that goes farther from zero has diverged [m], 0.001 to 1000
        """

class SweepProgress:
    """
    Progress of a sweep in another thread.
    """
    def __init__(self) -> None: ...
    def cancel(self) -> None:
        """
        Cancel the sweep within some hundred ticks; finished runs are kept.
        """
    @property
    def cancelled(self) -> bool:
        """
        Whether it was cancelled.
        """
    @property
    def done(self) -> int:
        """
        Runs done.
        """

class LinearLoop:
    """
    One axis in a virtual spring and damper without a law, linear and exact.
    """
    @staticmethod
    def covers(device: Device) -> bool:
        """
        Return whether a device is linear deep in a wall, apart from friction and encoder counts.
        """
    def __init__(self, setup: Setup) -> None: ...
    def eigenvalues(
        self,
        stiffness: typing.SupportsFloat | typing.SupportsIndex,
        damping: typing.SupportsFloat | typing.SupportsIndex,
    ) -> list[complex]:
        """
        Return the eigenvalues of one tick, for a wall of stiffness [N/m] and damping [N s/m].
        """
    def spectral_radius(
        self,
        stiffness: typing.SupportsFloat | typing.SupportsIndex,
        damping: typing.SupportsFloat | typing.SupportsIndex,
    ) -> float:
        """
        Return the largest modulus of an eigenvalue; the loop is stable below 1.
        """
    def stiffness_limit(self, damping: typing.SupportsFloat | typing.SupportsIndex) -> float:
        """
        Return the largest stable stiffness [N/m]; 0 for none.
        """

class ArmGains:
    """
    Kalman gains: correction of the prediction of eq. (4) by each row.
    """
    @property
    def log_sum(self) -> float:
        """
        Sum of the logarithms of the variances of the errors.
        """

class ArmRecord:
    """
    A log of one hand, and its prediction by eq. (4).

    theta: mass [kg], damping [N s/m], stiffness [N/m], delay [s], onset [s], bend [1], a share for each input, then the levels of the target [m].
    """
    def __init__(
        self,
        *,
        x: typing.Annotated[numpy.typing.ArrayLike, numpy.float64],
        force: typing.Annotated[numpy.typing.ArrayLike, numpy.float64],
        variance: typing.Annotated[numpy.typing.ArrayLike, numpy.float64],
        early: typing.Annotated[numpy.typing.ArrayLike, numpy.float64],
        known: typing.Annotated[numpy.typing.ArrayLike, numpy.float64],
        doubt: typing.Annotated[numpy.typing.ArrayLike, numpy.float64],
        inputs: collections.abc.Sequence[typing.Annotated[numpy.typing.ArrayLike, numpy.float64]],
        switches: collections.abc.Sequence[typing.SupportsFloat | typing.SupportsIndex],
        segments: collections.abc.Sequence[typing.SupportsInt | typing.SupportsIndex],
        dt: typing.SupportsFloat | typing.SupportsIndex,
        lag: typing.SupportsFloat | typing.SupportsIndex,
    ) -> None: ...
    def drifts(
        self, theta: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], gains: ArmGains
    ) -> numpy.typing.NDArray[numpy.float64]:
        """
        Return by how much the force reads too high at each row [N], shape (rows,).
        """
    def gains(
        self,
        theta: typing.Annotated[numpy.typing.ArrayLike, numpy.float64],
        force_noise: typing.SupportsFloat | typing.SupportsIndex,
        drift: typing.SupportsFloat | typing.SupportsIndex = 0.0,
        offset: typing.SupportsFloat | typing.SupportsIndex = 0.0,
    ) -> ArmGains:
        """
        Return the gains for theta and force readings of standard deviation `force_noise` [N] that drift by a random walk of `drift` [N/sqrt(s)] from within `offset` [N].
        """
    def innovations(
        self, theta: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], gains: ArmGains
    ) -> numpy.typing.NDArray[numpy.float64]:
        """
        Return the one-step prediction errors, each divided by its standard deviation.
        """
    def judge(
        self,
        theta: typing.Annotated[numpy.typing.ArrayLike, numpy.float64],
        held: typing.Annotated[numpy.typing.ArrayLike, numpy.float64],
        noise: collections.abc.Sequence[
            typing.Annotated[
                collections.abc.Sequence[typing.SupportsFloat | typing.SupportsIndex],
                "FixedSize(3)",
            ]
        ],
        robust: typing.SupportsFloat | typing.SupportsIndex = 0.0,
    ) -> numpy.typing.NDArray[numpy.float64]:
        """
        Return -2 log of the likelihood of each of some trials, but for a constant, shape (trials,): of theta, shape (trials, parameters), with the gains made for `held`, of the same shape, and `noise` as of `gains`, one of three each. Errors beyond `robust` deviations count linearly, 0 for none.
        """
    def linearised(
        self,
        theta: typing.Annotated[numpy.typing.ArrayLike, numpy.float64],
        gains: ArmGains,
        which: collections.abc.Sequence[typing.SupportsInt | typing.SupportsIndex],
        more: typing.SupportsInt | typing.SupportsIndex = 0,
    ) -> tuple[numpy.typing.NDArray[numpy.float64], numpy.typing.NDArray[numpy.float64]]:
        """
        Return the innovations, shape (rows,), and d innovations / d theta[which], shape (which, rows), exact; with `more` rows of zeros behind them.
        """
    def renewed(
        self,
        theta: typing.Annotated[numpy.typing.ArrayLike, numpy.float64],
        held: typing.Annotated[numpy.typing.ArrayLike, numpy.float64],
        noise: typing.Annotated[
            collections.abc.Sequence[typing.SupportsFloat | typing.SupportsIndex], "FixedSize(3)"
        ],
        which: collections.abc.Sequence[typing.SupportsInt | typing.SupportsIndex],
        kept: typing.SupportsInt | typing.SupportsIndex,
        steps: collections.abc.Sequence[typing.SupportsFloat | typing.SupportsIndex],
        more: typing.SupportsInt | typing.SupportsIndex = 0,
    ) -> tuple[numpy.typing.NDArray[numpy.float64], numpy.typing.NDArray[numpy.float64]]:
        """
        Return the same as `linearised`, with the gains made anew for each change, of theta and but for the last `kept` of `held`, by differences of `steps`; `noise` as of `gains`.
        """
    def resting(self, noise: typing.Annotated[numpy.typing.ArrayLike, numpy.float64]) -> ArmRecord:
        """
        Return the same log of a hand at rest in its place, whose force is but `noise` [N], shape (rows,).
        """
    def simulate(
        self,
        theta: typing.Annotated[numpy.typing.ArrayLike, numpy.float64],
        x: typing.SupportsFloat | typing.SupportsIndex,
        v: typing.SupportsFloat | typing.SupportsIndex,
    ) -> numpy.typing.NDArray[numpy.float64]:
        """
        Return the position [m] simulated from a state [m, m/s] with the recorded force alone.
        """
    @property
    def parameters(self) -> int:
        """
        Length of theta.
        """

class Direct:
    """
    no law: the command is what the virtual world asks.

    Parameters
    ----------
    peak_force : float
        largest command [N], 0.001 to 10000.
    """
    class State:
        """
        State of the law, recorded in a trace.
        """
        @staticmethod
        def fields() -> list[Field]:
            """
            Return name, unit, meaning, default and range of every parameter.
            """
        def __repr__(self) -> str: ...
        def as_dict(self) -> dict[str, typing.Any]:
            """
            Return the values by name.
            """

    name: typing.ClassVar[str] = "direct"
    passive: typing.ClassVar[bool] = False
    summary: typing.ClassVar[str] = "no law: the command is what the virtual world asks"
    @staticmethod
    def _sweep(
        setups: collections.abc.Sequence[Setup],
        laws: collections.abc.Sequence[Direct],
        threads: typing.SupportsInt | typing.SupportsIndex,
        limits: RunLimits,
        progress: SweepProgress,
    ) -> dict[str, typing.Any]: ...
    @staticmethod
    def design(facts: DeviceFacts | Device, timing: Timing, **changes: typing.Any) -> Direct:
        """
        Design the law for a device from facts about it; `changes` override parameters.
        """
    @staticmethod
    def fields() -> list[Field]:
        """
        Return name, unit, meaning, default and range of every parameter.
        """
    def __eq__(self, other: typing.Any) -> bool: ...
    def __hash__(self) -> int: ...
    def __init__(self, *, peak_force: float = 42.4, timing: Timing = ...) -> None: ...
    def __reduce__(self) -> tuple[typing.Any, ...]: ...
    def __repr__(self) -> str: ...
    def _check_retune(self, next: Direct) -> None: ...
    def _replay(
        self, log: ReplayLog, device: Device, environment: Free | Wall | Corner | Disc | _World
    ) -> Rows: ...
    def _simulate(
        self, setup: Setup, through_can: bool = False, bus: TimedBus | None = None
    ) -> Rows: ...
    def _start(self, bus: typing.Any, setup: RunSetup) -> Running: ...
    def _stepped(
        self,
        setup: Setup,
        bus: TimedBus | None,
        rows: typing.SupportsInt | typing.SupportsIndex,
    ) -> SteppedRun: ...
    def _time_step(
        self, setup: Setup, repeats: typing.SupportsInt | typing.SupportsIndex
    ) -> float: ...
    def _time_tick(
        self, setup: Setup, repeats: typing.SupportsInt | typing.SupportsIndex
    ) -> float: ...
    def as_dict(self) -> dict[str, typing.Any]:
        """
        Return the parameters by name, without the state.
        """
    def copy(self) -> Direct:
        """
        Return an independent copy, state included.
        """
    def replace(self, **changes: typing.Any) -> typing.Self:
        """
        Return a copy with some parameters changed, checked as at construction.
        """
    def reset(self) -> None:
        """
        Reset the state; the parameters stay.
        """
    def step(self, port: Port) -> float:
        """
        Compute one tick of one axis; return the commanded force [N].
        """
    @property
    def peak_force(self) -> float:
        """
        largest command [N], 0.001 to 10000
        """
    @property
    def state(self) -> Direct.State:
        """
        State of the law after the last step.
        """
    @property
    def timing(self) -> Timing:
        """
        Sample time and delay for which the law is designed.
        """

class TCA:
    """
    eq. (2): desired force plus PD feedback of the F/T sensor.

    Parameters
    ----------
    kp : float
        gain on the error of the measured force: K_p of eq. (2), 0 to 10.
    kd : float
        gain on the rate of the error of the measured force: K_d of eq. (2) [s], 0 to 1.
    filter : float
        low-pass on the derivative of the force error [s], 0 to 1.
    peak_force : float
        largest command [N], 0.001 to 10000.
    """
    class State:
        """
        State of the law, recorded in a trace.
        """
        @staticmethod
        def fields() -> list[Field]:
            """
            Return name, unit, meaning, default and range of every parameter.
            """
        def __repr__(self) -> str: ...
        def as_dict(self) -> dict[str, typing.Any]:
            """
            Return the values by name.
            """
        @property
        def feedback(self) -> float:
            """
            PD part of eq. (2) [N]
            """

    name: typing.ClassVar[str] = "tca"
    passive: typing.ClassVar[bool] = False
    summary: typing.ClassVar[str] = "eq. (2): desired force plus PD feedback of the F/T sensor"
    @staticmethod
    def _press(
        setups: collections.abc.Sequence[Setup],
        laws: collections.abc.Sequence[TCA],
        goals: collections.abc.Sequence[typing.SupportsFloat | typing.SupportsIndex],
        threads: typing.SupportsInt | typing.SupportsIndex,
        limits: RunLimits,
        progress: SweepProgress,
    ) -> dict[str, typing.Any]: ...
    @staticmethod
    def _sweep(
        setups: collections.abc.Sequence[Setup],
        laws: collections.abc.Sequence[TCA],
        threads: typing.SupportsInt | typing.SupportsIndex,
        limits: RunLimits,
        progress: SweepProgress,
    ) -> dict[str, typing.Any]: ...
    @staticmethod
    def design(facts: DeviceFacts | Device, timing: Timing, **changes: typing.Any) -> TCA:
        """
        Design the law for a device from facts about it; `changes` override parameters.
        """
    @staticmethod
    def fields() -> list[Field]:
        """
        Return name, unit, meaning, default and range of every parameter.
        """
    def __eq__(self, other: typing.Any) -> bool: ...
    def __hash__(self) -> int: ...
    def __init__(
        self,
        *,
        kp: float = 0.5,
        kd: float = 0.0,
        filter: float = 0.005,
        peak_force: float = 42.4,
        timing: Timing = ...,
    ) -> None: ...
    def __reduce__(self) -> tuple[typing.Any, ...]: ...
    def __repr__(self) -> str: ...
    def _check_retune(self, next: TCA) -> None: ...
    def _replay(
        self, log: ReplayLog, device: Device, environment: Free | Wall | Corner | Disc | _World
    ) -> Rows: ...
    def _simulate(
        self, setup: Setup, through_can: bool = False, bus: TimedBus | None = None
    ) -> Rows: ...
    def _start(self, bus: typing.Any, setup: RunSetup) -> Running: ...
    def _stepped(
        self,
        setup: Setup,
        bus: TimedBus | None,
        rows: typing.SupportsInt | typing.SupportsIndex,
    ) -> SteppedRun: ...
    def _time_step(
        self, setup: Setup, repeats: typing.SupportsInt | typing.SupportsIndex
    ) -> float: ...
    def _time_tick(
        self, setup: Setup, repeats: typing.SupportsInt | typing.SupportsIndex
    ) -> float: ...
    def as_dict(self) -> dict[str, typing.Any]:
        """
        Return the parameters by name, without the state.
        """
    def copy(self) -> TCA:
        """
        Return an independent copy, state included.
        """
    def replace(self, **changes: typing.Any) -> typing.Self:
        """
        Return a copy with some parameters changed, checked as at construction.
        """
    def reset(self) -> None:
        """
        Reset the state; the parameters stay.
        """
    def step(self, port: Port) -> float:
        """
        Compute one tick of one axis; return the commanded force [N].
        """
    @property
    def filter(self) -> float:
        """
        low-pass on the derivative of the force error [s], 0 to 1
        """
    @property
    def kd(self) -> float:
        """
        gain on the rate of the error of the measured force: K_d of eq. (2) [s], 0 to 1
        """
    @property
    def kp(self) -> float:
        """
        gain on the error of the measured force: K_p of eq. (2), 0 to 10
        """
    @property
    def peak_force(self) -> float:
        """
        largest command [N], 0.001 to 10000
        """
    @property
    def state(self) -> TCA.State:
        """
        State of the law after the last step.
        """
    @property
    def timing(self) -> Timing:
        """
        Sample time and delay for which the law is designed.
        """

class TCADamped:
    """
    eq. (2) plus a virtual damper in contact.

    Parameters
    ----------
    virtual_damping : float
        virtual damping in contact, B_v; 0 for none [N s/m], 0 to 10000.
    kp : float
        gain on the error of the measured force: K_p of eq. (2), 0 to 10.
    kd : float
        gain on the rate of the error of the measured force: K_d of eq. (2) [s], 0 to 1.
    filter : float
        low-pass on the derivative of the force error [s], 0 to 1.
    peak_force : float
        largest command [N], 0.001 to 10000.
    """
    class State:
        """
        State of the law, recorded in a trace.
        """
        @staticmethod
        def fields() -> list[Field]:
            """
            Return name, unit, meaning, default and range of every parameter.
            """
        def __repr__(self) -> str: ...
        def as_dict(self) -> dict[str, typing.Any]:
            """
            Return the values by name.
            """
        @property
        def feedback(self) -> float:
            """
            PD part of eq. (2) [N]
            """
        @property
        def injected(self) -> float:
            """
            force of the virtual damper [N]
            """

    name: typing.ClassVar[str] = "tca-damped"
    passive: typing.ClassVar[bool] = False
    summary: typing.ClassVar[str] = "eq. (2) plus a virtual damper in contact"
    @staticmethod
    def _press(
        setups: collections.abc.Sequence[Setup],
        laws: collections.abc.Sequence[TCADamped],
        goals: collections.abc.Sequence[typing.SupportsFloat | typing.SupportsIndex],
        threads: typing.SupportsInt | typing.SupportsIndex,
        limits: RunLimits,
        progress: SweepProgress,
    ) -> dict[str, typing.Any]: ...
    @staticmethod
    def _sweep(
        setups: collections.abc.Sequence[Setup],
        laws: collections.abc.Sequence[TCADamped],
        threads: typing.SupportsInt | typing.SupportsIndex,
        limits: RunLimits,
        progress: SweepProgress,
    ) -> dict[str, typing.Any]: ...
    @staticmethod
    def design(facts: DeviceFacts | Device, timing: Timing, **changes: typing.Any) -> TCADamped:
        """
        Design the law for a device from facts about it; `changes` override parameters.
        """
    @staticmethod
    def fields() -> list[Field]:
        """
        Return name, unit, meaning, default and range of every parameter.
        """
    def __eq__(self, other: typing.Any) -> bool: ...
    def __hash__(self) -> int: ...
    def __init__(
        self,
        *,
        virtual_damping: float = 32.6,
        kp: float = 0.5,
        kd: float = 0.0,
        filter: float = 0.005,
        peak_force: float = 42.4,
        timing: Timing = ...,
    ) -> None: ...
    def __reduce__(self) -> tuple[typing.Any, ...]: ...
    def __repr__(self) -> str: ...
    def _check_retune(self, next: TCADamped) -> None: ...
    def _replay(
        self, log: ReplayLog, device: Device, environment: Free | Wall | Corner | Disc | _World
    ) -> Rows: ...
    def _simulate(
        self, setup: Setup, through_can: bool = False, bus: TimedBus | None = None
    ) -> Rows: ...
    def _start(self, bus: typing.Any, setup: RunSetup) -> Running: ...
    def _stepped(
        self,
        setup: Setup,
        bus: TimedBus | None,
        rows: typing.SupportsInt | typing.SupportsIndex,
    ) -> SteppedRun: ...
    def _time_step(
        self, setup: Setup, repeats: typing.SupportsInt | typing.SupportsIndex
    ) -> float: ...
    def _time_tick(
        self, setup: Setup, repeats: typing.SupportsInt | typing.SupportsIndex
    ) -> float: ...
    def as_dict(self) -> dict[str, typing.Any]:
        """
        Return the parameters by name, without the state.
        """
    def copy(self) -> TCADamped:
        """
        Return an independent copy, state included.
        """
    def replace(self, **changes: typing.Any) -> typing.Self:
        """
        Return a copy with some parameters changed, checked as at construction.
        """
    def reset(self) -> None:
        """
        Reset the state; the parameters stay.
        """
    def step(self, port: Port) -> float:
        """
        Compute one tick of one axis; return the commanded force [N].
        """
    @property
    def filter(self) -> float:
        """
        low-pass on the derivative of the force error [s], 0 to 1
        """
    @property
    def kd(self) -> float:
        """
        gain on the rate of the error of the measured force: K_d of eq. (2) [s], 0 to 1
        """
    @property
    def kp(self) -> float:
        """
        gain on the error of the measured force: K_p of eq. (2), 0 to 10
        """
    @property
    def peak_force(self) -> float:
        """
        largest command [N], 0.001 to 10000
        """
    @property
    def state(self) -> TCADamped.State:
        """
        State of the law after the last step.
        """
    @property
    def timing(self) -> Timing:
        """
        Sample time and delay for which the law is designed.
        """
    @property
    def virtual_damping(self) -> float:
        """
        virtual damping in contact, B_v; 0 for none [N s/m], 0 to 10000
        """

class LagCompensator:
    """
    stiffness c_h at once, the wall through a lag, a virtual damper.

    Parameters
    ----------
    stiffness : float
        stiffness shown at once, c_h [N/m], 1 to 1e+06.
    virtual_damping : float
        virtual damping in contact, B_v; 0 for none [N s/m], 0 to 10000.
    recovery_time : float
        T_r: the lag is T_r (K/c_h - 1) for a wall of K, and T_r/4 at least [s], 0.001 to 10.
    count : float
        one encoder count at the handle [m], 0 to 0.01.
    peak_force : float
        largest command [N], 0.001 to 10000.
    """
    class State:
        """
        State of the law, recorded in a trace.
        """
        @staticmethod
        def fields() -> list[Field]:
            """
            Return name, unit, meaning, default and range of every parameter.
            """
        def __repr__(self) -> str: ...
        def as_dict(self) -> dict[str, typing.Any]:
            """
            Return the values by name.
            """
        @property
        def f_d(self) -> float:
            """
            lagged force of the wall, F_d [N]
            """
        @property
        def injected(self) -> float:
            """
            force of the virtual damper [N]
            """
        @property
        def slope(self) -> float:
            """
            stiffness of the wall as seen, K [N/m]
            """

    name: typing.ClassVar[str] = "lag-compensator"
    passive: typing.ClassVar[bool] = False
    summary: typing.ClassVar[str] = (
        "stiffness c_h at once, the wall through a lag, a virtual damper"
    )
    @staticmethod
    def _sweep(
        setups: collections.abc.Sequence[Setup],
        laws: collections.abc.Sequence[LagCompensator],
        threads: typing.SupportsInt | typing.SupportsIndex,
        limits: RunLimits,
        progress: SweepProgress,
    ) -> dict[str, typing.Any]: ...
    @staticmethod
    def design(
        facts: DeviceFacts | Device, timing: Timing, **changes: typing.Any
    ) -> LagCompensator:
        """
        Design the law for a device from facts about it; `changes` override parameters.
        """
    @staticmethod
    def fields() -> list[Field]:
        """
        Return name, unit, meaning, default and range of every parameter.
        """
    def __eq__(self, other: typing.Any) -> bool: ...
    def __hash__(self) -> int: ...
    def __init__(
        self,
        *,
        stiffness: float = 3800.0,
        virtual_damping: float = 32.6,
        recovery_time: float = 0.118,
        count: float = 3.07e-05,
        peak_force: float = 42.4,
        timing: Timing = ...,
    ) -> None: ...
    def __reduce__(self) -> tuple[typing.Any, ...]: ...
    def __repr__(self) -> str: ...
    def _check_retune(self, next: LagCompensator) -> None: ...
    def _replay(
        self, log: ReplayLog, device: Device, environment: Free | Wall | Corner | Disc | _World
    ) -> Rows: ...
    def _simulate(
        self, setup: Setup, through_can: bool = False, bus: TimedBus | None = None
    ) -> Rows: ...
    def _start(self, bus: typing.Any, setup: RunSetup) -> Running: ...
    def _stepped(
        self,
        setup: Setup,
        bus: TimedBus | None,
        rows: typing.SupportsInt | typing.SupportsIndex,
    ) -> SteppedRun: ...
    def _time_step(
        self, setup: Setup, repeats: typing.SupportsInt | typing.SupportsIndex
    ) -> float: ...
    def _time_tick(
        self, setup: Setup, repeats: typing.SupportsInt | typing.SupportsIndex
    ) -> float: ...
    def as_dict(self) -> dict[str, typing.Any]:
        """
        Return the parameters by name, without the state.
        """
    def copy(self) -> LagCompensator:
        """
        Return an independent copy, state included.
        """
    def replace(self, **changes: typing.Any) -> typing.Self:
        """
        Return a copy with some parameters changed, checked as at construction.
        """
    def reset(self) -> None:
        """
        Reset the state; the parameters stay.
        """
    def step(self, port: Port) -> float:
        """
        Compute one tick of one axis; return the commanded force [N].
        """
    @property
    def count(self) -> float:
        """
        one encoder count at the handle [m], 0 to 0.01
        """
    @property
    def peak_force(self) -> float:
        """
        largest command [N], 0.001 to 10000
        """
    @property
    def recovery_time(self) -> float:
        """
        T_r: the lag is T_r (K/c_h - 1) for a wall of K, and T_r/4 at least [s], 0.001 to 10
        """
    @property
    def state(self) -> LagCompensator.State:
        """
        State of the law after the last step.
        """
    @property
    def stiffness(self) -> float:
        """
        stiffness shown at once, c_h [N/m], 1 to 1e+06
        """
    @property
    def timing(self) -> Timing:
        """
        Sample time and delay for which the law is designed.
        """
    @property
    def virtual_damping(self) -> float:
        """
        virtual damping in contact, B_v; 0 for none [N s/m], 0 to 10000
        """

class PassivityControl:
    """
    passivity observer and capped passivity controller.

    Parameters
    ----------
    damping : float
        lower bound of the device's physical damping, b [N s/m], 0 to 500.
    cap : float
        largest alpha over the device's damping, 0 to 100.
    reference : bool
        hold to the energy the environment stores instead of to zero, 0 to 1.
    per_contact : bool
        begin the account anew with each contact, 0 to 1.
    peak_force : float
        largest command [N], 0.001 to 10000.
    """
    class State:
        """
        State of the law, recorded in a trace.
        """
        @staticmethod
        def fields() -> list[Field]:
            """
            Return name, unit, meaning, default and range of every parameter.
            """
        def __repr__(self) -> str: ...
        def as_dict(self) -> dict[str, typing.Any]:
            """
            Return the values by name.
            """
        @property
        def alpha(self) -> float:
            """
            damping the controller injects [N s/m]
            """
        @property
        def clamped(self) -> bool:
            """
            1 where the controller acts
            """
        @property
        def observed(self) -> float:
            """
            energy taken in at the port [J]
            """
        @property
        def reference(self) -> float:
            """
            energy it is held to [J]
            """

    name: typing.ClassVar[str] = "passivity-control"
    passive: typing.ClassVar[bool] = False
    summary: typing.ClassVar[str] = "passivity observer and capped passivity controller"
    @staticmethod
    def _sweep(
        setups: collections.abc.Sequence[Setup],
        laws: collections.abc.Sequence[PassivityControl],
        threads: typing.SupportsInt | typing.SupportsIndex,
        limits: RunLimits,
        progress: SweepProgress,
    ) -> dict[str, typing.Any]: ...
    @staticmethod
    def design(
        facts: DeviceFacts | Device, timing: Timing, **changes: typing.Any
    ) -> PassivityControl:
        """
        Design the law for a device from facts about it; `changes` override parameters.
        """
    @staticmethod
    def fields() -> list[Field]:
        """
        Return name, unit, meaning, default and range of every parameter.
        """
    def __eq__(self, other: typing.Any) -> bool: ...
    def __hash__(self) -> int: ...
    def __init__(
        self,
        *,
        damping: float = 2.0,
        cap: float = 0.9,
        reference: bool = False,
        per_contact: bool = False,
        peak_force: float = 42.4,
        timing: Timing = ...,
    ) -> None: ...
    def __reduce__(self) -> tuple[typing.Any, ...]: ...
    def __repr__(self) -> str: ...
    def _check_retune(self, next: PassivityControl) -> None: ...
    def _replay(
        self, log: ReplayLog, device: Device, environment: Free | Wall | Corner | Disc | _World
    ) -> Rows: ...
    def _simulate(
        self, setup: Setup, through_can: bool = False, bus: TimedBus | None = None
    ) -> Rows: ...
    def _start(self, bus: typing.Any, setup: RunSetup) -> Running: ...
    def _stepped(
        self,
        setup: Setup,
        bus: TimedBus | None,
        rows: typing.SupportsInt | typing.SupportsIndex,
    ) -> SteppedRun: ...
    def _time_step(
        self, setup: Setup, repeats: typing.SupportsInt | typing.SupportsIndex
    ) -> float: ...
    def _time_tick(
        self, setup: Setup, repeats: typing.SupportsInt | typing.SupportsIndex
    ) -> float: ...
    def as_dict(self) -> dict[str, typing.Any]:
        """
        Return the parameters by name, without the state.
        """
    def copy(self) -> PassivityControl:
        """
        Return an independent copy, state included.
        """
    def replace(self, **changes: typing.Any) -> typing.Self:
        """
        Return a copy with some parameters changed, checked as at construction.
        """
    def reset(self) -> None:
        """
        Reset the state; the parameters stay.
        """
    def step(self, port: Port) -> float:
        """
        Compute one tick of one axis; return the commanded force [N].
        """
    @property
    def cap(self) -> float:
        """
        largest alpha over the device's damping, 0 to 100
        """
    @property
    def damping(self) -> float:
        """
        lower bound of the device's physical damping, b [N s/m], 0 to 500
        """
    @property
    def peak_force(self) -> float:
        """
        largest command [N], 0.001 to 10000
        """
    @property
    def per_contact(self) -> bool:
        """
        begin the account anew with each contact, 0 to 1
        """
    @property
    def reference(self) -> bool:
        """
        hold to the energy the environment stores instead of to zero, 0 to 1
        """
    @property
    def state(self) -> PassivityControl.State:
        """
        State of the law after the last step.
        """
    @property
    def timing(self) -> Timing:
        """
        Sample time and delay for which the law is designed.
        """

class ISS:
    """
    energy given out bounded by the size of the hand's force, by a capped damper.

    Parameters
    ----------
    damping : float
        lower bound of the device's physical damping, b [N s/m], 0 to 500.
    gain : float
        energy that may be given out per force squared, gamma [J/N^2], 0 to 100.
    most_damping : float
        largest damping injected, alpha_max [N s/m], 0 to 10000.
    peak_force : float
        largest command [N], 0.001 to 10000.
    """
    class State:
        """
        State of the law, recorded in a trace.
        """
        @staticmethod
        def fields() -> list[Field]:
            """
            Return name, unit, meaning, default and range of every parameter.
            """
        def __repr__(self) -> str: ...
        def as_dict(self) -> dict[str, typing.Any]:
            """
            Return the values by name.
            """
        @property
        def alpha(self) -> float:
            """
            damping the controller injects [N s/m]
            """
        @property
        def clamped(self) -> bool:
            """
            1 where the controller acts
            """
        @property
        def energy(self) -> float:
            """
            port work plus damping in this contact [J]
            """
        @property
        def input(self) -> float:
            """
            largest force of the hand in this contact [N]
            """

    name: typing.ClassVar[str] = "iss"
    passive: typing.ClassVar[bool] = False
    summary: typing.ClassVar[str] = (
        "energy given out bounded by the size of the hand's force, by a capped damper"
    )
    @staticmethod
    def _sweep(
        setups: collections.abc.Sequence[Setup],
        laws: collections.abc.Sequence[ISS],
        threads: typing.SupportsInt | typing.SupportsIndex,
        limits: RunLimits,
        progress: SweepProgress,
    ) -> dict[str, typing.Any]: ...
    @staticmethod
    def design(facts: DeviceFacts | Device, timing: Timing, **changes: typing.Any) -> ISS:
        """
        Design the law for a device from facts about it; `changes` override parameters.
        """
    @staticmethod
    def fields() -> list[Field]:
        """
        Return name, unit, meaning, default and range of every parameter.
        """
    def __eq__(self, other: typing.Any) -> bool: ...
    def __hash__(self) -> int: ...
    def __init__(
        self,
        *,
        damping: float = 2.0,
        gain: float = 0.000375,
        most_damping: float = 32.6,
        peak_force: float = 42.4,
        timing: Timing = ...,
    ) -> None: ...
    def __reduce__(self) -> tuple[typing.Any, ...]: ...
    def __repr__(self) -> str: ...
    def _check_retune(self, next: ISS) -> None: ...
    def _replay(
        self, log: ReplayLog, device: Device, environment: Free | Wall | Corner | Disc | _World
    ) -> Rows: ...
    def _simulate(
        self, setup: Setup, through_can: bool = False, bus: TimedBus | None = None
    ) -> Rows: ...
    def _start(self, bus: typing.Any, setup: RunSetup) -> Running: ...
    def _stepped(
        self,
        setup: Setup,
        bus: TimedBus | None,
        rows: typing.SupportsInt | typing.SupportsIndex,
    ) -> SteppedRun: ...
    def _time_step(
        self, setup: Setup, repeats: typing.SupportsInt | typing.SupportsIndex
    ) -> float: ...
    def _time_tick(
        self, setup: Setup, repeats: typing.SupportsInt | typing.SupportsIndex
    ) -> float: ...
    def as_dict(self) -> dict[str, typing.Any]:
        """
        Return the parameters by name, without the state.
        """
    def copy(self) -> ISS:
        """
        Return an independent copy, state included.
        """
    def replace(self, **changes: typing.Any) -> typing.Self:
        """
        Return a copy with some parameters changed, checked as at construction.
        """
    def reset(self) -> None:
        """
        Reset the state; the parameters stay.
        """
    def step(self, port: Port) -> float:
        """
        Compute one tick of one axis; return the commanded force [N].
        """
    @property
    def damping(self) -> float:
        """
        lower bound of the device's physical damping, b [N s/m], 0 to 500
        """
    @property
    def gain(self) -> float:
        """
        energy that may be given out per force squared, gamma [J/N^2], 0 to 100
        """
    @property
    def most_damping(self) -> float:
        """
        largest damping injected, alpha_max [N s/m], 0 to 10000
        """
    @property
    def peak_force(self) -> float:
        """
        largest command [N], 0.001 to 10000
        """
    @property
    def state(self) -> ISS.State:
        """
        State of the law after the last step.
        """
    @property
    def timing(self) -> Timing:
        """
        Sample time and delay for which the law is designed.
        """

class VirtualCoupling:
    """
    spring and damper in series, to a proxy that obeys the wall.

    Parameters
    ----------
    coupling_stiffness : float
        stiffness of the spring between handle and proxy: K_c [N/m], 0 to 1e+07.
    coupling_damping : float
        damping of the damper between handle and proxy: B_c [N s/m], 0 to 10000.
    count : float
        one encoder count at the handle [m], 0 to 0.01.
    peak_force : float
        largest command [N], 0.001 to 10000.
    """
    class State:
        """
        State of the law, recorded in a trace.
        """
        @staticmethod
        def fields() -> list[Field]:
            """
            Return name, unit, meaning, default and range of every parameter.
            """
        def __repr__(self) -> str: ...
        def as_dict(self) -> dict[str, typing.Any]:
            """
            Return the values by name.
            """
        @property
        def clamped(self) -> bool:
            """
            1 where the coupling gave less than the world asked
            """
        @property
        def proxy(self) -> float:
            """
            where the proxy stands [m]
            """
        @property
        def slope(self) -> float:
            """
            stiffness of the wall as seen, K [N/m]
            """

    name: typing.ClassVar[str] = "virtual-coupling"
    passive: typing.ClassVar[bool] = False
    summary: typing.ClassVar[str] = "spring and damper in series, to a proxy that obeys the wall"
    @staticmethod
    def _sweep(
        setups: collections.abc.Sequence[Setup],
        laws: collections.abc.Sequence[VirtualCoupling],
        threads: typing.SupportsInt | typing.SupportsIndex,
        limits: RunLimits,
        progress: SweepProgress,
    ) -> dict[str, typing.Any]: ...
    @staticmethod
    def design(
        facts: DeviceFacts | Device, timing: Timing, **changes: typing.Any
    ) -> VirtualCoupling:
        """
        Design the law for a device from facts about it; `changes` override parameters.
        """
    @staticmethod
    def fields() -> list[Field]:
        """
        Return name, unit, meaning, default and range of every parameter.
        """
    def __eq__(self, other: typing.Any) -> bool: ...
    def __hash__(self) -> int: ...
    def __init__(
        self,
        *,
        coupling_stiffness: float = 2000.0,
        coupling_damping: float = 1.0,
        count: float = 3.07e-05,
        peak_force: float = 42.4,
        timing: Timing = ...,
    ) -> None: ...
    def __reduce__(self) -> tuple[typing.Any, ...]: ...
    def __repr__(self) -> str: ...
    def _check_retune(self, next: VirtualCoupling) -> None: ...
    def _replay(
        self, log: ReplayLog, device: Device, environment: Free | Wall | Corner | Disc | _World
    ) -> Rows: ...
    def _simulate(
        self, setup: Setup, through_can: bool = False, bus: TimedBus | None = None
    ) -> Rows: ...
    def _start(self, bus: typing.Any, setup: RunSetup) -> Running: ...
    def _stepped(
        self,
        setup: Setup,
        bus: TimedBus | None,
        rows: typing.SupportsInt | typing.SupportsIndex,
    ) -> SteppedRun: ...
    def _time_step(
        self, setup: Setup, repeats: typing.SupportsInt | typing.SupportsIndex
    ) -> float: ...
    def _time_tick(
        self, setup: Setup, repeats: typing.SupportsInt | typing.SupportsIndex
    ) -> float: ...
    def as_dict(self) -> dict[str, typing.Any]:
        """
        Return the parameters by name, without the state.
        """
    def copy(self) -> VirtualCoupling:
        """
        Return an independent copy, state included.
        """
    def replace(self, **changes: typing.Any) -> typing.Self:
        """
        Return a copy with some parameters changed, checked as at construction.
        """
    def reset(self) -> None:
        """
        Reset the state; the parameters stay.
        """
    def step(self, port: Port) -> float:
        """
        Compute one tick of one axis; return the commanded force [N].
        """
    @property
    def count(self) -> float:
        """
        one encoder count at the handle [m], 0 to 0.01
        """
    @property
    def coupling_damping(self) -> float:
        """
        damping of the damper between handle and proxy: B_c [N s/m], 0 to 10000
        """
    @property
    def coupling_stiffness(self) -> float:
        """
        stiffness of the spring between handle and proxy: K_c [N/m], 0 to 1e+07
        """
    @property
    def peak_force(self) -> float:
        """
        largest command [N], 0.001 to 10000
        """
    @property
    def state(self) -> VirtualCoupling.State:
        """
        State of the law after the last step.
        """
    @property
    def timing(self) -> Timing:
        """
        Sample time and delay for which the law is designed.
        """

class SFA:
    """
    low stiffness plus a force offset raised at each reversal of motion.

    Parameters
    ----------
    stiffness : float
        stiffness of the feedback force, K_l [N/m], 1 to 1e+06.
    gain : float
        share of the missing force added at a reversal, g, 0 to 1.
    transient : bool
        render the wall itself until the first reversal, 0 to 1.
    count : float
        one encoder count at the handle [m], 0 to 0.01.
    peak_force : float
        largest command [N], 0.001 to 10000.
    """
    class State:
        """
        State of the law, recorded in a trace.
        """
        @staticmethod
        def fields() -> list[Field]:
            """
            Return name, unit, meaning, default and range of every parameter.
            """
        def __repr__(self) -> str: ...
        def as_dict(self) -> dict[str, typing.Any]:
            """
            Return the values by name.
            """
        @property
        def feedback(self) -> float:
            """
            force of the low stiffness, F_l [N]
            """
        @property
        def offset(self) -> float:
            """
            force offset, F_o [N]
            """

    name: typing.ClassVar[str] = "sfa"
    passive: typing.ClassVar[bool] = False
    summary: typing.ClassVar[str] = (
        "low stiffness plus a force offset raised at each reversal of motion"
    )
    @staticmethod
    def _sweep(
        setups: collections.abc.Sequence[Setup],
        laws: collections.abc.Sequence[SFA],
        threads: typing.SupportsInt | typing.SupportsIndex,
        limits: RunLimits,
        progress: SweepProgress,
    ) -> dict[str, typing.Any]: ...
    @staticmethod
    def design(facts: DeviceFacts | Device, timing: Timing, **changes: typing.Any) -> SFA:
        """
        Design the law for a device from facts about it; `changes` override parameters.
        """
    @staticmethod
    def fields() -> list[Field]:
        """
        Return name, unit, meaning, default and range of every parameter.
        """
    def __eq__(self, other: typing.Any) -> bool: ...
    def __hash__(self) -> int: ...
    def __init__(
        self,
        *,
        stiffness: float = 1300.0,
        gain: float = 0.2,
        transient: bool = False,
        count: float = 3.07e-05,
        peak_force: float = 42.4,
        timing: Timing = ...,
    ) -> None: ...
    def __reduce__(self) -> tuple[typing.Any, ...]: ...
    def __repr__(self) -> str: ...
    def _check_retune(self, next: SFA) -> None: ...
    def _replay(
        self, log: ReplayLog, device: Device, environment: Free | Wall | Corner | Disc | _World
    ) -> Rows: ...
    def _simulate(
        self, setup: Setup, through_can: bool = False, bus: TimedBus | None = None
    ) -> Rows: ...
    def _start(self, bus: typing.Any, setup: RunSetup) -> Running: ...
    def _stepped(
        self,
        setup: Setup,
        bus: TimedBus | None,
        rows: typing.SupportsInt | typing.SupportsIndex,
    ) -> SteppedRun: ...
    def _time_step(
        self, setup: Setup, repeats: typing.SupportsInt | typing.SupportsIndex
    ) -> float: ...
    def _time_tick(
        self, setup: Setup, repeats: typing.SupportsInt | typing.SupportsIndex
    ) -> float: ...
    def as_dict(self) -> dict[str, typing.Any]:
        """
        Return the parameters by name, without the state.
        """
    def copy(self) -> SFA:
        """
        Return an independent copy, state included.
        """
    def replace(self, **changes: typing.Any) -> typing.Self:
        """
        Return a copy with some parameters changed, checked as at construction.
        """
    def reset(self) -> None:
        """
        Reset the state; the parameters stay.
        """
    def step(self, port: Port) -> float:
        """
        Compute one tick of one axis; return the commanded force [N].
        """
    @property
    def count(self) -> float:
        """
        one encoder count at the handle [m], 0 to 0.01
        """
    @property
    def gain(self) -> float:
        """
        share of the missing force added at a reversal, g, 0 to 1
        """
    @property
    def peak_force(self) -> float:
        """
        largest command [N], 0.001 to 10000
        """
    @property
    def state(self) -> SFA.State:
        """
        State of the law after the last step.
        """
    @property
    def stiffness(self) -> float:
        """
        stiffness of the feedback force, K_l [N/m], 1 to 1e+06
        """
    @property
    def timing(self) -> Timing:
        """
        Sample time and delay for which the law is designed.
        """
    @property
    def transient(self) -> bool:
        """
        render the wall itself until the first reversal, 0 to 1
        """

class ForceBounding:
    """
    F^2 <= 4 B E on an accumulated, delay-aware account.

    Parameters
    ----------
    damping : float
        lower bound of the device's physical damping, b [N s/m], 0.01 to 500.
    current_lag : float
        time constant of the drive's current loop [s], 0 to 0.1.
    count : float
        one encoder count at the handle [m], 0 to 0.01.
    peak_force : float
        largest command [N], 0.001 to 10000.
    """
    class State:
        """
        State of the law, recorded in a trace.
        """
        @staticmethod
        def fields() -> list[Field]:
            """
            Return name, unit, meaning, default and range of every parameter.
            """
        def __repr__(self) -> str: ...
        def as_dict(self) -> dict[str, typing.Any]:
            """
            Return the values by name.
            """
        @property
        def account(self) -> float:
            """
            port work plus damping, on the force really applied [J]
            """
        @property
        def clamped(self) -> bool:
            """
            1 where the law gave less than the world asked
            """

    name: typing.ClassVar[str] = "force-bounding"
    passive: typing.ClassVar[bool] = True
    summary: typing.ClassVar[str] = "F^2 <= 4 B E on an accumulated, delay-aware account"
    @staticmethod
    def _sweep(
        setups: collections.abc.Sequence[Setup],
        laws: collections.abc.Sequence[ForceBounding],
        threads: typing.SupportsInt | typing.SupportsIndex,
        limits: RunLimits,
        progress: SweepProgress,
    ) -> dict[str, typing.Any]: ...
    @staticmethod
    def design(facts: DeviceFacts | Device, timing: Timing, **changes: typing.Any) -> ForceBounding:
        """
        Design the law for a device from facts about it; `changes` override parameters.
        """
    @staticmethod
    def fields() -> list[Field]:
        """
        Return name, unit, meaning, default and range of every parameter.
        """
    def __eq__(self, other: typing.Any) -> bool: ...
    def __hash__(self) -> int: ...
    def __init__(
        self,
        *,
        damping: float = 2.0,
        current_lag: float = 0.0003,
        count: float = 3.07e-05,
        peak_force: float = 42.4,
        timing: Timing = ...,
    ) -> None: ...
    def __reduce__(self) -> tuple[typing.Any, ...]: ...
    def __repr__(self) -> str: ...
    def _check_retune(self, next: ForceBounding) -> None: ...
    def _replay(
        self, log: ReplayLog, device: Device, environment: Free | Wall | Corner | Disc | _World
    ) -> Rows: ...
    def _simulate(
        self, setup: Setup, through_can: bool = False, bus: TimedBus | None = None
    ) -> Rows: ...
    def _start(self, bus: typing.Any, setup: RunSetup) -> Running: ...
    def _stepped(
        self,
        setup: Setup,
        bus: TimedBus | None,
        rows: typing.SupportsInt | typing.SupportsIndex,
    ) -> SteppedRun: ...
    def _time_step(
        self, setup: Setup, repeats: typing.SupportsInt | typing.SupportsIndex
    ) -> float: ...
    def _time_tick(
        self, setup: Setup, repeats: typing.SupportsInt | typing.SupportsIndex
    ) -> float: ...
    def as_dict(self) -> dict[str, typing.Any]:
        """
        Return the parameters by name, without the state.
        """
    def copy(self) -> ForceBounding:
        """
        Return an independent copy, state included.
        """
    def replace(self, **changes: typing.Any) -> typing.Self:
        """
        Return a copy with some parameters changed, checked as at construction.
        """
    def reset(self) -> None:
        """
        Reset the state; the parameters stay.
        """
    def step(self, port: Port) -> float:
        """
        Compute one tick of one axis; return the commanded force [N].
        """
    @property
    def count(self) -> float:
        """
        one encoder count at the handle [m], 0 to 0.01
        """
    @property
    def current_lag(self) -> float:
        """
        time constant of the drive's current loop [s], 0 to 0.1
        """
    @property
    def damping(self) -> float:
        """
        lower bound of the device's physical damping, b [N s/m], 0.01 to 500
        """
    @property
    def peak_force(self) -> float:
        """
        largest command [N], 0.001 to 10000
        """
    @property
    def state(self) -> ForceBounding.State:
        """
        State of the law after the last step.
        """
    @property
    def timing(self) -> Timing:
        """
        Sample time and delay for which the law is designed.
        """

class EBA:
    """
    eq. (8), (9) with the state-dependent energy bound.

    Parameters
    ----------
    damping : float
        lower bound of the device's physical damping, b [N s/m], 0.01 to 500.
    share : float
        c over its largest value 2 b / ((1 + 2 d) T), 0.001 to 1.
    peak_force : float
        largest command [N], 0.001 to 10000.
    """
    class State:
        """
        State of the law, recorded in a trace.
        """
        @staticmethod
        def fields() -> list[Field]:
            """
            Return name, unit, meaning, default and range of every parameter.
            """
        def __repr__(self) -> str: ...
        def as_dict(self) -> dict[str, typing.Any]:
            """
            Return the values by name.
            """
        @property
        def beta(self) -> float:
            """
            slope dF/dx taken, eq. (9); NaN where dx = 0 [N/m]
            """
        @property
        def beta_max(self) -> float:
            """
            highest slope the energy bound allows [N/m]
            """
        @property
        def beta_min(self) -> float:
            """
            lowest slope the energy bound allows [N/m]
            """
        @property
        def clamped(self) -> bool:
            """
            1 where the law gave less than the world asked
            """

    name: typing.ClassVar[str] = "eba"
    passive: typing.ClassVar[bool] = False
    summary: typing.ClassVar[str] = "eq. (8), (9) with the state-dependent energy bound"
    @staticmethod
    def _sweep(
        setups: collections.abc.Sequence[Setup],
        laws: collections.abc.Sequence[EBA],
        threads: typing.SupportsInt | typing.SupportsIndex,
        limits: RunLimits,
        progress: SweepProgress,
    ) -> dict[str, typing.Any]: ...
    @staticmethod
    def design(facts: DeviceFacts | Device, timing: Timing, **changes: typing.Any) -> EBA:
        """
        Design the law for a device from facts about it; `changes` override parameters.
        """
    @staticmethod
    def fields() -> list[Field]:
        """
        Return name, unit, meaning, default and range of every parameter.
        """
    def __eq__(self, other: typing.Any) -> bool: ...
    def __hash__(self) -> int: ...
    def __init__(
        self,
        *,
        damping: float = 2.0,
        share: float = 1.0,
        peak_force: float = 42.4,
        timing: Timing = ...,
    ) -> None: ...
    def __reduce__(self) -> tuple[typing.Any, ...]: ...
    def __repr__(self) -> str: ...
    def _check_retune(self, next: EBA) -> None: ...
    def _replay(
        self, log: ReplayLog, device: Device, environment: Free | Wall | Corner | Disc | _World
    ) -> Rows: ...
    def _simulate(
        self, setup: Setup, through_can: bool = False, bus: TimedBus | None = None
    ) -> Rows: ...
    def _start(self, bus: typing.Any, setup: RunSetup) -> Running: ...
    def _stepped(
        self,
        setup: Setup,
        bus: TimedBus | None,
        rows: typing.SupportsInt | typing.SupportsIndex,
    ) -> SteppedRun: ...
    def _time_step(
        self, setup: Setup, repeats: typing.SupportsInt | typing.SupportsIndex
    ) -> float: ...
    def _time_tick(
        self, setup: Setup, repeats: typing.SupportsInt | typing.SupportsIndex
    ) -> float: ...
    def as_dict(self) -> dict[str, typing.Any]:
        """
        Return the parameters by name, without the state.
        """
    def copy(self) -> EBA:
        """
        Return an independent copy, state included.
        """
    def replace(self, **changes: typing.Any) -> typing.Self:
        """
        Return a copy with some parameters changed, checked as at construction.
        """
    def reset(self) -> None:
        """
        Reset the state; the parameters stay.
        """
    def step(self, port: Port) -> float:
        """
        Compute one tick of one axis; return the commanded force [N].
        """
    @property
    def damping(self) -> float:
        """
        lower bound of the device's physical damping, b [N s/m], 0.01 to 500
        """
    @property
    def peak_force(self) -> float:
        """
        largest command [N], 0.001 to 10000
        """
    @property
    def share(self) -> float:
        """
        c over its largest value 2 b / ((1 + 2 d) T), 0.001 to 1
        """
    @property
    def state(self) -> EBA.State:
        """
        State of the law after the last step.
        """
    @property
    def timing(self) -> Timing:
        """
        Sample time and delay for which the law is designed.
        """

class EBAAccount:
    """
    eba, held to an account of the energy at the port.

    Parameters
    ----------
    damping : float
        lower bound of the device's physical damping, b [N s/m], 0.01 to 500.
    share : float
        c over its largest value 2 b / ((1 + 2 d) T), 0.001 to 1.
    current_lag : float
        time constant of the drive's current loop [s], 0 to 0.1.
    count : float
        one encoder count at the handle [m], 0 to 0.01.
    peak_force : float
        largest command [N], 0.001 to 10000.
    """
    class State:
        """
        State of the law, recorded in a trace.
        """
        @staticmethod
        def fields() -> list[Field]:
            """
            Return name, unit, meaning, default and range of every parameter.
            """
        def __repr__(self) -> str: ...
        def as_dict(self) -> dict[str, typing.Any]:
            """
            Return the values by name.
            """
        @property
        def account(self) -> float:
            """
            port work plus damping, on the force really applied [J]
            """
        @property
        def beta(self) -> float:
            """
            slope dF/dx taken, eq. (9); NaN where dx = 0 [N/m]
            """
        @property
        def beta_max(self) -> float:
            """
            highest slope the energy bound allows [N/m]
            """
        @property
        def beta_min(self) -> float:
            """
            lowest slope the energy bound allows [N/m]
            """
        @property
        def clamped(self) -> bool:
            """
            1 where the law gave less than the world asked
            """

    name: typing.ClassVar[str] = "eba-account"
    passive: typing.ClassVar[bool] = True
    summary: typing.ClassVar[str] = "eba, held to an account of the energy at the port"
    @staticmethod
    def _sweep(
        setups: collections.abc.Sequence[Setup],
        laws: collections.abc.Sequence[EBAAccount],
        threads: typing.SupportsInt | typing.SupportsIndex,
        limits: RunLimits,
        progress: SweepProgress,
    ) -> dict[str, typing.Any]: ...
    @staticmethod
    def design(facts: DeviceFacts | Device, timing: Timing, **changes: typing.Any) -> EBAAccount:
        """
        Design the law for a device from facts about it; `changes` override parameters.
        """
    @staticmethod
    def fields() -> list[Field]:
        """
        Return name, unit, meaning, default and range of every parameter.
        """
    def __eq__(self, other: typing.Any) -> bool: ...
    def __hash__(self) -> int: ...
    def __init__(
        self,
        *,
        damping: float = 2.0,
        share: float = 1.0,
        current_lag: float = 0.0003,
        count: float = 3.07e-05,
        peak_force: float = 42.4,
        timing: Timing = ...,
    ) -> None: ...
    def __reduce__(self) -> tuple[typing.Any, ...]: ...
    def __repr__(self) -> str: ...
    def _check_retune(self, next: EBAAccount) -> None: ...
    def _replay(
        self, log: ReplayLog, device: Device, environment: Free | Wall | Corner | Disc | _World
    ) -> Rows: ...
    def _simulate(
        self, setup: Setup, through_can: bool = False, bus: TimedBus | None = None
    ) -> Rows: ...
    def _start(self, bus: typing.Any, setup: RunSetup) -> Running: ...
    def _stepped(
        self,
        setup: Setup,
        bus: TimedBus | None,
        rows: typing.SupportsInt | typing.SupportsIndex,
    ) -> SteppedRun: ...
    def _time_step(
        self, setup: Setup, repeats: typing.SupportsInt | typing.SupportsIndex
    ) -> float: ...
    def _time_tick(
        self, setup: Setup, repeats: typing.SupportsInt | typing.SupportsIndex
    ) -> float: ...
    def as_dict(self) -> dict[str, typing.Any]:
        """
        Return the parameters by name, without the state.
        """
    def copy(self) -> EBAAccount:
        """
        Return an independent copy, state included.
        """
    def replace(self, **changes: typing.Any) -> typing.Self:
        """
        Return a copy with some parameters changed, checked as at construction.
        """
    def reset(self) -> None:
        """
        Reset the state; the parameters stay.
        """
    def step(self, port: Port) -> float:
        """
        Compute one tick of one axis; return the commanded force [N].
        """
    @property
    def count(self) -> float:
        """
        one encoder count at the handle [m], 0 to 0.01
        """
    @property
    def current_lag(self) -> float:
        """
        time constant of the drive's current loop [s], 0 to 0.1
        """
    @property
    def damping(self) -> float:
        """
        lower bound of the device's physical damping, b [N s/m], 0.01 to 500
        """
    @property
    def peak_force(self) -> float:
        """
        largest command [N], 0.001 to 10000
        """
    @property
    def share(self) -> float:
        """
        c over its largest value 2 b / ((1 + 2 d) T), 0.001 to 1
        """
    @property
    def state(self) -> EBAAccount.State:
        """
        State of the law after the last step.
        """
    @property
    def timing(self) -> Timing:
        """
        Sample time and delay for which the law is designed.
        """

class EBACPrinted:
    """
    eq. (8) to (10) and (2), read to the letter.

    Parameters
    ----------
    damping : float
        lower bound of the device's physical damping, b [N s/m], 0 to 500.
    growth : float
        largest beta, as a multiple of that of the last tick: c1 of eq. (10), 1 to 1.2.
    decay : float
        smallest beta, as a multiple of that of the last tick: c2 of eq. (10), 0.8 to 1.
    constant_limit : float
        beta_max = -beta_min as a constant; 0 for the bound of Kim and Ryu [N/m], 0 to 1e+07.
    kp : float
        gain on the error of the measured force: K_p of eq. (2), 0 to 10.
    kd : float
        gain on the rate of the error of the measured force: K_d of eq. (2) [s], 0 to 1.
    filter : float
        low-pass on the derivative of the force error [s], 0 to 1.
    peak_force : float
        largest command [N], 0.001 to 10000.
    """
    class State:
        """
        State of the law, recorded in a trace.
        """
        @staticmethod
        def fields() -> list[Field]:
            """
            Return name, unit, meaning, default and range of every parameter.
            """
        def __repr__(self) -> str: ...
        def as_dict(self) -> dict[str, typing.Any]:
            """
            Return the values by name.
            """
        @property
        def beta(self) -> float:
            """
            slope dF/dx taken, eq. (9); NaN where dx = 0 [N/m]
            """
        @property
        def beta_max(self) -> float:
            """
            highest slope the energy bound allows [N/m]
            """
        @property
        def beta_min(self) -> float:
            """
            lowest slope the energy bound allows [N/m]
            """
        @property
        def clamped(self) -> bool:
            """
            1 where eq. (10) changed beta
            """
        @property
        def f_d(self) -> float:
            """
            F_d of eq. (8) [N]
            """

    name: typing.ClassVar[str] = "ebac-printed"
    passive: typing.ClassVar[bool] = False
    summary: typing.ClassVar[str] = "eq. (8) to (10) and (2), read to the letter"
    @staticmethod
    def _press(
        setups: collections.abc.Sequence[Setup],
        laws: collections.abc.Sequence[EBACPrinted],
        goals: collections.abc.Sequence[typing.SupportsFloat | typing.SupportsIndex],
        threads: typing.SupportsInt | typing.SupportsIndex,
        limits: RunLimits,
        progress: SweepProgress,
    ) -> dict[str, typing.Any]: ...
    @staticmethod
    def _sweep(
        setups: collections.abc.Sequence[Setup],
        laws: collections.abc.Sequence[EBACPrinted],
        threads: typing.SupportsInt | typing.SupportsIndex,
        limits: RunLimits,
        progress: SweepProgress,
    ) -> dict[str, typing.Any]: ...
    @staticmethod
    def design(facts: DeviceFacts | Device, timing: Timing, **changes: typing.Any) -> EBACPrinted:
        """
        Design the law for a device from facts about it; `changes` override parameters.
        """
    @staticmethod
    def fields() -> list[Field]:
        """
        Return name, unit, meaning, default and range of every parameter.
        """
    def __eq__(self, other: typing.Any) -> bool: ...
    def __hash__(self) -> int: ...
    def __init__(
        self,
        *,
        damping: float = 2.0,
        growth: float = 1.2,
        decay: float = 0.8,
        constant_limit: float = 0.0,
        kp: float = 0.5,
        kd: float = 0.0,
        filter: float = 0.005,
        peak_force: float = 42.4,
        timing: Timing = ...,
    ) -> None: ...
    def __reduce__(self) -> tuple[typing.Any, ...]: ...
    def __repr__(self) -> str: ...
    def _check_retune(self, next: EBACPrinted) -> None: ...
    def _replay(
        self, log: ReplayLog, device: Device, environment: Free | Wall | Corner | Disc | _World
    ) -> Rows: ...
    def _simulate(
        self, setup: Setup, through_can: bool = False, bus: TimedBus | None = None
    ) -> Rows: ...
    def _start(self, bus: typing.Any, setup: RunSetup) -> Running: ...
    def _stepped(
        self,
        setup: Setup,
        bus: TimedBus | None,
        rows: typing.SupportsInt | typing.SupportsIndex,
    ) -> SteppedRun: ...
    def _time_step(
        self, setup: Setup, repeats: typing.SupportsInt | typing.SupportsIndex
    ) -> float: ...
    def _time_tick(
        self, setup: Setup, repeats: typing.SupportsInt | typing.SupportsIndex
    ) -> float: ...
    def as_dict(self) -> dict[str, typing.Any]:
        """
        Return the parameters by name, without the state.
        """
    def copy(self) -> EBACPrinted:
        """
        Return an independent copy, state included.
        """
    def replace(self, **changes: typing.Any) -> typing.Self:
        """
        Return a copy with some parameters changed, checked as at construction.
        """
    def reset(self) -> None:
        """
        Reset the state; the parameters stay.
        """
    def step(self, port: Port) -> float:
        """
        Compute one tick of one axis; return the commanded force [N].
        """
    @property
    def constant_limit(self) -> float:
        """
        beta_max = -beta_min as a constant; 0 for the bound of Kim and Ryu [N/m], 0 to 1e+07
        """
    @property
    def damping(self) -> float:
        """
        lower bound of the device's physical damping, b [N s/m], 0 to 500
        """
    @property
    def decay(self) -> float:
        """
        smallest beta, as a multiple of that of the last tick: c2 of eq. (10), 0.8 to 1
        """
    @property
    def filter(self) -> float:
        """
        low-pass on the derivative of the force error [s], 0 to 1
        """
    @property
    def growth(self) -> float:
        """
        largest beta, as a multiple of that of the last tick: c1 of eq. (10), 1 to 1.2
        """
    @property
    def kd(self) -> float:
        """
        gain on the rate of the error of the measured force: K_d of eq. (2) [s], 0 to 1
        """
    @property
    def kp(self) -> float:
        """
        gain on the error of the measured force: K_p of eq. (2), 0 to 10
        """
    @property
    def peak_force(self) -> float:
        """
        largest command [N], 0.001 to 10000
        """
    @property
    def state(self) -> EBACPrinted.State:
        """
        State of the law after the last step.
        """
    @property
    def timing(self) -> Timing:
        """
        Sample time and delay for which the law is designed.
        """

class EBAC:
    """
    observer, damper, energy account; without the observer eq. (2), (8) to (10), completed.

    Parameters
    ----------
    damping : float
        lower bound of the device's physical damping, b [N s/m], 0.01 to 500.
    mass : float
        device mass at the handle, M_h; right to a few per cent [kg], 0.001 to 100.
    current_lag : float
        time constant of the drive's current loop [s], 0 to 0.1.
    count : float
        one encoder count at the handle [m], 0 to 0.01.
    peak_force : float
        largest command [N], 0.001 to 10000.
    resonance : float
        first resonance of the structure, which bounds the virtual damper; 0 where none is known [Hz], 0 to 10000.
    force_noise : float
        with the observer, standard deviation of the force sensor's noise, which the account does not charge; less than 0.03 N counts as that [N], 0 to 10.
    growth : float
        largest beta, as a multiple of that of the last tick: c1 of eq. (10), 1 to 1.2.
    decay : float
        smallest beta, as a multiple of that of the last tick: c2 of eq. (10), 0.8 to 1.
    kp : float
        gain on the error of the measured force: K_p of eq. (2); it divides the device's damping by 1 + K_p, 0 to 0.5.
    kd : float
        gain on the rate of the error of the measured force: K_d of eq. (2) [s], 0 to 0.01.
    filter : float
        low-pass on the derivative of the force error [s], 0 to 1.
    fast_stiffness : float
        with the observer, stiffness for changes of the force by some tenths of a newton that are faster than 1 Hz; 0 shows them with the world's own [N/m], 0 to 1e+06.
    heaviest_hand : float
        heaviest hand that recovery, and on soft walls the damper, are designed for [kg], 0 to 10.
    pull : float
        largest pull of a hand the guard counts with [N], 0 to 1000.
    pull_rate : float
        with the observer, fastest growth of the pull beyond what the force sensor shows [N/s], 0 to 1e+06.
    reserve : float
        reserve of the account, e(0) of eq. (3) [J], 0 to 1.
    observed_reserve : float
        the same with the observer, where less is needed [J], 0 to 1.
    continuity : bool
        whether beta is held between its growth and its decay from tick to tick: ratio rows of eq. (10), 0 to 1.
    recovery : bool
        relaxation towards F_e at dx = 0, 0 to 1.
    injection : bool
        virtual damping while in contact, 0 to 1.
    guard : bool
        hold the command to what the account covers, 0 to 1.
    observer : bool
        meet the world at the observer's estimate, where a run has one, 0 to 1.
    """
    class State:
        """
        State of the law, recorded in a trace.
        """

        @staticmethod
        def fields() -> list[Field]:
            """
            Return name, unit, meaning, default and range of every parameter.
            """
        def __repr__(self) -> str: ...
        def as_dict(self) -> dict[str, typing.Any]:
            """
            Return the values by name.
            """
        @property
        def admitted(self) -> float:
            """
            share of the command the guard let through
            """
        @property
        def beta(self) -> float:
            """
            slope dF/dx taken, eq. (9); NaN where dx = 0, and with the observer [N/m]
            """
        @property
        def beta_max(self) -> float:
            """
            highest slope the energy bound allows [N/m]
            """
        @property
        def beta_min(self) -> float:
            """
            lowest slope the energy bound allows [N/m]
            """
        @property
        def clamped(self) -> bool:
            """
            1 where the energy bound or the guard held the force
            """
        @property
        def energy(self) -> float:
            """
            account: what the virtual side may give back [J]
            """
        @property
        def f_d(self) -> float:
            """
            F_d of eq. (8), before damping and force loop; with the observer the world's force as shown [N]
            """
        @property
        def injected(self) -> float:
            """
            force of the virtual damper [N]
            """
        @property
        def slope(self) -> float:
            """
            stiffness of the environment as seen [N/m]
            """
        @property
        def starved(self) -> float:
            """
            time for which the guard has let less than half of the command through; falls tenfold when it lets more [s]
            """

    name: typing.ClassVar[str] = "ebac"
    passive: typing.ClassVar[bool] = False
    summary: typing.ClassVar[str] = (
        "observer, damper, energy account; without the observer eq. (2), (8) to (10), completed"
    )
    @staticmethod
    def _press(
        setups: collections.abc.Sequence[Setup],
        laws: collections.abc.Sequence[EBAC],
        goals: collections.abc.Sequence[typing.SupportsFloat | typing.SupportsIndex],
        threads: typing.SupportsInt | typing.SupportsIndex,
        limits: RunLimits,
        progress: SweepProgress,
    ) -> dict[str, typing.Any]: ...
    @staticmethod
    def _sweep(
        setups: collections.abc.Sequence[Setup],
        laws: collections.abc.Sequence[EBAC],
        threads: typing.SupportsInt | typing.SupportsIndex,
        limits: RunLimits,
        progress: SweepProgress,
    ) -> dict[str, typing.Any]: ...
    @staticmethod
    def design(facts: DeviceFacts | Device, timing: Timing, **changes: typing.Any) -> EBAC:
        """
        Design the law for a device from facts about it; `changes` override parameters.
        """
    @staticmethod
    def fields() -> list[Field]:
        """
        Return name, unit, meaning, default and range of every parameter.
        """
    def __eq__(self, other: typing.Any) -> bool: ...
    def __hash__(self) -> int: ...
    def __init__(
        self,
        *,
        damping: float = 2.0,
        mass: float = 0.25,
        current_lag: float = 0.0003,
        count: float = 3.07e-05,
        peak_force: float = 42.4,
        resonance: float = 0.0,
        force_noise: float = 0.03,
        growth: float = 1.2,
        decay: float = 0.8,
        kp: float = 0.1,
        kd: float = 0.0,
        filter: float = 0.005,
        fast_stiffness: float = 3000.0,
        heaviest_hand: float = 1.5,
        pull: float = 20.0,
        pull_rate: float = 1000.0,
        reserve: float = 0.01,
        observed_reserve: float = 0.002,
        continuity: bool = True,
        recovery: bool = True,
        injection: bool = True,
        guard: bool = True,
        observer: bool = True,
        timing: Timing = ...,
    ) -> None: ...
    def __reduce__(self) -> tuple[typing.Any, ...]: ...
    def __repr__(self) -> str: ...
    def _check_retune(self, next: EBAC) -> None: ...
    def _replay(
        self, log: ReplayLog, device: Device, environment: Free | Wall | Corner | Disc | _World
    ) -> Rows: ...
    def _simulate(
        self, setup: Setup, through_can: bool = False, bus: TimedBus | None = None
    ) -> Rows: ...
    def _start(self, bus: typing.Any, setup: RunSetup) -> Running: ...
    def _stepped(
        self,
        setup: Setup,
        bus: TimedBus | None,
        rows: typing.SupportsInt | typing.SupportsIndex,
    ) -> SteppedRun: ...
    def _time_step(
        self, setup: Setup, repeats: typing.SupportsInt | typing.SupportsIndex
    ) -> float: ...
    def _time_tick(
        self, setup: Setup, repeats: typing.SupportsInt | typing.SupportsIndex
    ) -> float: ...
    def as_dict(self) -> dict[str, typing.Any]:
        """
        Return the parameters by name, without the state.
        """
    def copy(self) -> EBAC:
        """
        Return an independent copy, state included.
        """
    def replace(self, **changes: typing.Any) -> typing.Self:
        """
        Return a copy with some parameters changed, checked as at construction.
        """
    def reset(self) -> None:
        """
        Reset the state; the parameters stay.
        """
    def step(self, port: Port) -> float:
        """
        Compute one tick of one axis; return the commanded force [N].
        """
    @property
    def continuity(self) -> bool:
        """
        whether beta is held between its growth and its decay from tick to tick: ratio rows of eq. (10), 0 to 1
        """
    @property
    def count(self) -> float:
        """
        one encoder count at the handle [m], 0 to 0.01
        """
    @property
    def current_lag(self) -> float:
        """
        time constant of the drive's current loop [s], 0 to 0.1
        """
    @property
    def damping(self) -> float:
        """
        lower bound of the device's physical damping, b [N s/m], 0.01 to 500
        """
    @property
    def decay(self) -> float:
        """
        smallest beta, as a multiple of that of the last tick: c2 of eq. (10), 0.8 to 1
        """
    @property
    def fast_stiffness(self) -> float:
        """
        with the observer, stiffness for changes of the force by some tenths of a newton that are faster than 1 Hz; 0 shows them with the world's own [N/m], 0 to 1e+06
        """
    @property
    def filter(self) -> float:
        """
        low-pass on the derivative of the force error [s], 0 to 1
        """
    @property
    def force_noise(self) -> float:
        """
        with the observer, standard deviation of the force sensor's noise, which the account does not charge; less than 0.03 N counts as that [N], 0 to 10
        """
    @property
    def growth(self) -> float:
        """
        largest beta, as a multiple of that of the last tick: c1 of eq. (10), 1 to 1.2
        """
    @property
    def guard(self) -> bool:
        """
        hold the command to what the account covers, 0 to 1
        """
    @property
    def heaviest_hand(self) -> float:
        """
        heaviest hand that recovery, and on soft walls the damper, are designed for [kg], 0 to 10
        """
    @property
    def injection(self) -> bool:
        """
        virtual damping while in contact, 0 to 1
        """
    @property
    def kd(self) -> float:
        """
        gain on the rate of the error of the measured force: K_d of eq. (2) [s], 0 to 0.01
        """
    @property
    def kp(self) -> float:
        """
        gain on the error of the measured force: K_p of eq. (2); it divides the device's damping by 1 + K_p, 0 to 0.5
        """
    @property
    def mass(self) -> float:
        """
        device mass at the handle, M_h; right to a few per cent [kg], 0.001 to 100
        """
    @property
    def observed_reserve(self) -> float:
        """
        the same with the observer, where less is needed [J], 0 to 1
        """
    @property
    def observer(self) -> bool:
        """
        meet the world at the observer's estimate, where a run has one, 0 to 1
        """
    @property
    def peak_force(self) -> float:
        """
        largest command [N], 0.001 to 10000
        """
    @property
    def pull(self) -> float:
        """
        largest pull of a hand the guard counts with [N], 0 to 1000
        """
    @property
    def pull_rate(self) -> float:
        """
        with the observer, fastest growth of the pull beyond what the force sensor shows [N/s], 0 to 1e+06
        """
    @property
    def recovery(self) -> bool:
        """
        relaxation towards F_e at dx = 0, 0 to 1
        """
    @property
    def reserve(self) -> float:
        """
        reserve of the account, e(0) of eq. (3) [J], 0 to 1
        """
    @property
    def resonance(self) -> float:
        """
        first resonance of the structure, which bounds the virtual damper; 0 where none is known [Hz], 0 to 10000
        """
    @property
    def state(self) -> EBAC.State:
        """
        State of the law after the last step.
        """
    @property
    def timing(self) -> Timing:
        """
        Sample time and delay for which the law is designed.
        """

class PlannedFrame:
    """
    One kind of frame that is sent in every period, or after a time of its own.
    """
    def __init__(
        self,
        *,
        what: str,
        id: typing.SupportsInt | typing.SupportsIndex,
        size: typing.SupportsInt | typing.SupportsIndex,
        count: typing.SupportsInt | typing.SupportsIndex = 1,
        every: typing.SupportsFloat | typing.SupportsIndex = 0.0,
    ) -> None: ...
    @property
    def count(self) -> int:
        """
        Frames per period, or at a time.
        """
    @property
    def every(self) -> float:
        """
        Time from one to the next [s]; 0 for frames of every period.
        """
    @property
    def id(self) -> int:
        """
        COB-ID.
        """
    @property
    def size(self) -> int:
        """
        Bytes of data.
        """
    @property
    def what(self) -> str:
        """
        Sender and content.
        """

class BridgeParams:
    """
    How models of an engine are rendered.

    Parameters
    ----------
    blend : float
        time constant with which a new model takes over from the one before [s], 0.001 to 10.
    slew : float
        most speed of the surface while it does [m/s], 1e-04 to 10.
    stale : float
        age of a model from which on its force fades [s], 0.001 to 100.
    fade : float
        time in which that force fades to zero, and back [s], 0.001 to 100.
    fastest : float
        most speed of a surface that is believed [m/s], 0 to 10.
    """

    @staticmethod
    def fields() -> list[Field]:
        """
        Return name, unit, meaning, default and range of every parameter.
        """
    def __eq__(self, other: typing.Any) -> bool: ...
    def __hash__(self) -> int: ...
    def __init__(
        self,
        *,
        blend: float = 0.02,
        slew: float = 0.1,
        stale: float = 0.15,
        fade: float = 0.1,
        fastest: float = 0.5,
    ) -> None: ...
    def __reduce__(self) -> tuple[typing.Any, ...]: ...
    def __repr__(self) -> str: ...
    def as_dict(self) -> dict[str, typing.Any]:
        """
        Return the parameters by name.
        """
    def replace(self, **changes: typing.Any) -> typing.Self:
        """
        Return a copy with some parameters changed, checked as at construction.
        """
    @property
    def blend(self) -> float:
        """
        time constant with which a new model takes over from the one before [s], 0.001 to 10
        """
    @property
    def fade(self) -> float:
        """
        time in which that force fades to zero, and back [s], 0.001 to 100
        """
    @property
    def fastest(self) -> float:
        """
        most speed of a surface that is believed [m/s], 0 to 10
        """
    @property
    def slew(self) -> float:
        """
        most speed of the surface while it does [m/s], 1e-04 to 10
        """
    @property
    def stale(self) -> float:
        """
        age of a model from which on its force fades [s], 0.001 to 100
        """

class BusLoad:
    """
    Worst-case load of a bus by frames that are sent again and again.
    """
    def __init__(
        self,
        *,
        frames: collections.abc.Sequence[PlannedFrame],
        bit_rate: typing.SupportsFloat | typing.SupportsIndex = 1000000.0,
        period: typing.SupportsFloat | typing.SupportsIndex = 0.001,
    ) -> None: ...
    def bits(self, frame: PlannedFrame) -> int:
        """
        Return the bits of one kind of frame in a period in which it comes, stuff bits included.
        """
    def check(self) -> str:
        """
        Return a warning over 70 % of the bus, else an empty text.

        Raises
        ------
        ValueError
            Over 90 %, or for numbers no CAN bus has; with the remedy.
        """
    def frame_share(self, frame: PlannedFrame) -> float:
        """
        Return the share of the bus used by one kind of frame, 0 to 1.
        """
    @property
    def bit_rate(self) -> float:
        """
        Bit rate of the bus [bit/s].
        """
    @property
    def frames(self) -> list[PlannedFrame]:
        """
        The frames.
        """
    @property
    def highest_rate(self) -> float:
        """
        Highest rate at which the same frames fit on the bus [Hz].
        """
    @property
    def period(self) -> float:
        """
        Time between two SYNC frames [s].
        """
    @property
    def seconds(self) -> float:
        """
        Time used by all frames in a period in which all of them come [s].
        """
    @property
    def share(self) -> float:
        """
        Share of the bus used by all frames on average, 0 to 1.
        """

class TimedBus:
    """
    A CAN bus that takes time in a simulated run, its drives and the watches on both sides.

    Parameters
    ----------
    bit_rate : float
        bit rate of the bus [bit/s], 10000 to 1e+06.
    answer_share : float
        how long the loop waits for the drives' answers, over the sample time, 0.05 to 0.9.
    response : float
        time a drive takes from a frame to its answer [s], 0 to 0.1.
    error_rate : float
        probability that a frame is destroyed, 0 to 1.
    broken : int
        node whose every frame is destroyed, the first one being 1; 0 for none, 0 to 3.
    broken_from : float
        time from which it is broken [s], 0 to 1e+05.
    silent_ticks : int
        ticks in a row without process data that are a fault [samples], 1 to 1000.
    drive_heartbeat : float
        time between two heartbeats of a drive; 0 sends none [s], 0 to 60.
    loop_silence : float
        time without the loop's heartbeat that is a fault of a drive; 0 watches none [s], 0 to 60.
    torque_silence : float
        time without a torque that is a fault of a drive; 0 watches none [s], 0 to 60.
    peak_ratio : float
        largest torque that the drives let through over the rated one (0x6072, 0x6073); that of the device limits it, too, 0.001 to 65.
    seed : int
        seed of what is destroyed, 0 to 9e+15.
    """
    @staticmethod
    def fields() -> list[Field]:
        """
        Return name, unit, meaning, default and range of every parameter.
        """
    def __eq__(self, other: typing.Any) -> bool: ...
    def __hash__(self) -> int: ...
    def __init__(
        self,
        *,
        bit_rate: float = 1000000.0,
        answer_share: float = 0.7,
        response: float = 5e-05,
        error_rate: float = 0.0,
        broken: int = 0,
        broken_from: float = 0.0,
        silent_ticks: int = 3,
        drive_heartbeat: float = 0.1,
        loop_silence: float = 0.3,
        torque_silence: float = 0.005,
        peak_ratio: float = 10.0,
        seed: int = 0,
    ) -> None: ...
    def __reduce__(self) -> tuple[typing.Any, ...]: ...
    def __repr__(self) -> str: ...
    def as_dict(self) -> dict[str, typing.Any]:
        """
        Return the parameters by name.
        """
    def replace(self, **changes: typing.Any) -> typing.Self:
        """
        Return a copy with some parameters changed, checked as at construction.
        """
    @property
    def answer_share(self) -> float:
        """
        how long the loop waits for the drives' answers, over the sample time, 0.05 to 0.9
        """
    @property
    def bit_rate(self) -> float:
        """
        bit rate of the bus [bit/s], 10000 to 1e+06
        """
    @property
    def broken(self) -> int:
        """
        node whose every frame is destroyed, the first one being 1; 0 for none, 0 to 3
        """
    @property
    def broken_from(self) -> float:
        """
        time from which it is broken [s], 0 to 1e+05
        """
    @property
    def drive_heartbeat(self) -> float:
        """
        time between two heartbeats of a drive; 0 sends none [s], 0 to 60
        """
    @property
    def error_rate(self) -> float:
        """
        probability that a frame is destroyed, 0 to 1
        """
    @property
    def loop_silence(self) -> float:
        """
        time without the loop's heartbeat that is a fault of a drive; 0 watches none [s], 0 to 60
        """
    @property
    def peak_ratio(self) -> float:
        """
        largest torque that the drives let through over the rated one (0x6072, 0x6073); that of the device limits it, too, 0.001 to 65
        """
    @property
    def response(self) -> float:
        """
        time a drive takes from a frame to its answer [s], 0 to 0.1
        """
    @property
    def seed(self) -> int:
        """
        seed of what is destroyed, 0 to 9e+15
        """
    @property
    def silent_ticks(self) -> int:
        """
        ticks in a row without process data that are a fault [samples], 1 to 1000
        """
    @property
    def torque_silence(self) -> float:
        """
        time without a torque that is a fault of a drive; 0 watches none [s], 0 to 60
        """

class SimulatedWire:
    """
    The wire of a CAN bus in virtual time [ns]: stations, their frames, and when they arrive.
    """
    def __init__(
        self,
        *,
        stations: typing.SupportsInt | typing.SupportsIndex,
        bit_rate: typing.SupportsFloat | typing.SupportsIndex,
        error_rate: typing.SupportsFloat | typing.SupportsIndex = 0.0,
        recovers: bool = False,
        seed: typing.SupportsInt | typing.SupportsIndex = 0,
    ) -> None: ...
    def break_station(self, station: typing.SupportsInt | typing.SupportsIndex) -> None:
        """
        Destroy every frame of a station from now on.
        """
    def next(self, until: typing.SupportsInt | typing.SupportsIndex) -> tuple[int, int, int] | None:
        """
        Return station, identifier and time of the next frame that arrives by `until` [ns].
        """
    def off(self, station: typing.SupportsInt | typing.SupportsIndex) -> bool:
        """
        Return whether a station is off the bus.
        """
    def send(
        self,
        station: typing.SupportsInt | typing.SupportsIndex,
        id: typing.SupportsInt | typing.SupportsIndex,
        data: bytes,
        due: typing.SupportsInt | typing.SupportsIndex,
    ) -> bool:
        """
        Queue a frame that may go from `due` [ns] on; False where the station is off, or full.
        """
    def was_passive(self, station: typing.SupportsInt | typing.SupportsIndex) -> bool:
        """
        Return whether a station has ever been error passive.
        """
    @property
    def busy(self) -> int:
        """
        Time in use so far [ns].
        """
    @property
    def destroyed(self) -> int:
        """
        Frames destroyed so far.
        """

class CanFrame:
    """
    A classical CAN frame.
    """
    def __init__(
        self,
        id: typing.SupportsInt | typing.SupportsIndex,
        data: bytes = b"",
        *,
        extended: bool = False,
        remote: bool = False,
        error: bool = False,
        size: typing.SupportsInt | typing.SupportsIndex | None = None,
    ) -> None:
        """
        A frame; a remote frame needs `size`.
        """
    def __repr__(self) -> str: ...
    @property
    def data(self) -> bytes:
        """
        The data; none in a remote frame.
        """
    @property
    def error(self) -> bool:
        """
        Whether this is an error frame of the CAN controller.
        """
    @property
    def extended(self) -> bool:
        """
        Whether the identifier has 29 bits.
        """
    @property
    def id(self) -> int:
        """
        Identifier, 11 bits, or 29 when extended.
        """
    @property
    def own(self) -> bool:
        """
        Whether the receiving end sent this frame itself.
        """
    @property
    def remote(self) -> bool:
        """
        Whether this is a remote frame, which requests data.
        """
    @property
    def size(self) -> int:
        """
        Length of the data [bytes], or of the requested data, 0 to 8.
        """
    @property
    def stamp(self) -> int:
        """
        Time of reception [ns since 1970]; 0 if unknown.
        """

class BusState(enum.IntEnum):
    """
    State of a CAN bus.
    """

    BUS_OFF = ...
    CLOSED = ...
    DOWN = ...
    PASSIVE = ...
    UP = ...
    WARNING = ...

class BusCounts:
    """
    Frame counts of one end of a bus since it was opened.
    """
    @property
    def lost(self) -> int:
        """
        Frames lost because the receive queue was full.
        """
    @property
    def received(self) -> int:
        """
        Frames received.
        """
    @property
    def refused(self) -> int:
        """
        Frames refused by `send`.
        """
    @property
    def sent(self) -> int:
        """
        Frames sent.
        """

class LoopbackBus:
    """
    One end of a CAN bus inside this process.
    """
    def close(self) -> None:
        """
        Leave the bus; a thread waiting in `receive` returns.
        """
    def receive(
        self, timeout: typing.SupportsFloat | typing.SupportsIndex | None = 0.0
    ) -> CanFrame | None:
        """
        Return a frame, waiting up to `timeout` [s], None for ever; None without one or if closed.
        """
    def send(self, frame: CanFrame) -> bool:
        """
        Send a frame; return False if the bus refuses it.
        """
    @property
    def counts(self) -> BusCounts:
        """
        Frame counts of this end.
        """
    @property
    def state(self) -> BusState:
        """
        State of the bus.
        """

class LoopbackHub:
    """
    A CAN bus inside this process.
    """
    def __init__(self, *, stamps: bool = True) -> None: ...
    def open(
        self, *, frames: typing.SupportsInt | typing.SupportsIndex = 1024, own: bool = False
    ) -> LoopbackBus:
        """
        Open a new end with a receive queue of `frames`; frames beyond it are lost and counted.
        """
    @property
    def ends(self) -> int:
        """
        Number of open ends.
        """

class SocketCan:
    """
    One end of a CAN interface of the Linux kernel.
    """
    def __init__(
        self,
        interface: str,
        *,
        filters: collections.abc.Sequence[
            tuple[
                typing.SupportsInt | typing.SupportsIndex,
                typing.SupportsInt | typing.SupportsIndex,
                bool,
            ]
        ] = [],
        own: bool = False,
        errors: bool = False,
    ) -> None:
        """
        Open an interface; `filters` are (id, mask, extended). An OSError contains the remedy.
        """
    def close(self) -> None:
        """
        Leave the bus; a thread waiting in `receive` returns.
        """
    def receive(
        self, timeout: typing.SupportsFloat | typing.SupportsIndex | None = 0.0
    ) -> CanFrame | None:
        """
        Return a frame, waiting up to `timeout` [s], None for ever; None without one or if closed.
        """
    def send(self, frame: CanFrame) -> bool:
        """
        Send a frame; return False if the bus refuses it.
        """
    @property
    def counts(self) -> BusCounts:
        """
        Frame counts of this end.
        """
    @property
    def state(self) -> BusState:
        """
        State of the bus.
        """

class LoopbackJoystick:
    """
    Simulated drives of a joystick on a bus inside this process, in real time, in a thread of
    its own that never waits for Python; their plant moves for `longest_step` [s] at most between
    two SYNCs. A context manager.
    """
    def __enter__(self) -> typing.Self: ...
    def __exit__(
        self, kind: typing.Any = None, error: typing.Any = None, traceback: typing.Any = None
    ) -> None: ...
    def __init__(
        self,
        hub: LoopbackHub,
        setup: Setup,
        *,
        wiring: DriveWiring = ...,
        peak_time: typing.SupportsFloat | typing.SupportsIndex = 2.0,
        force: SharedForce | None = None,
        wait_for_power: bool = False,
        aim: SharedHandTarget | None = None,
        longest_step: typing.SupportsFloat | typing.SupportsIndex = ...,
        load: _DrivenMachine | None = None,
    ) -> None: ...
    def start(self, mode: RealTimeMode = ..., realtime: RealTime = ...) -> typing.Self:
        """
        Start the drives on the bus; possible once.
        """
    def stop(self) -> None:
        """
        Take the drives off the bus for good.
        """
    @property
    def counts(self) -> BusCounts:
        """
        Frame counts of their end of the bus.
        """
    @property
    def grants(self) -> list[Grant]:
        """
        Resources that its thread requested and was granted; empty before the start.
        """
    @property
    def state(self) -> BusState:
        """
        State of the bus.
        """

class SocketCanJoystick:
    """
    Simulated drives of a joystick on a CAN interface of the Linux kernel, in real time, in a
    thread of its own that never waits for Python. A context manager.
    """
    def __enter__(self) -> typing.Self: ...
    def __exit__(
        self, kind: typing.Any = None, error: typing.Any = None, traceback: typing.Any = None
    ) -> None: ...
    def __init__(
        self,
        interface: str,
        setup: Setup,
        *,
        wiring: DriveWiring = ...,
        peak_time: typing.SupportsFloat | typing.SupportsIndex = 2.0,
        force: SharedForce | None = None,
        wait_for_power: bool = False,
        aim: SharedHandTarget | None = None,
    ) -> None: ...
    def start(self, mode: RealTimeMode = ..., realtime: RealTime = ...) -> typing.Self:
        """
        Start the drives on the bus; possible once.
        """
    def stop(self) -> None:
        """
        Take the drives off the bus for good.
        """
    @property
    def counts(self) -> BusCounts:
        """
        Frame counts of their end of the bus.
        """
    @property
    def grants(self) -> list[Grant]:
        """
        Resources that its thread requested and was granted; empty before the start.
        """
    @property
    def state(self) -> BusState:
        """
        State of the bus.
        """

class Observer:
    """
    State of the device from encoder, force sensor and currents, estimated in every tick of a loop.

    Parameters
    ----------
    mass : float
        device mass at the handle, M_h [kg], 0.001 to 100.
    damping : float
        viscous damping of the device, B_h [N s/m], 0 to 500.
    friction : float
        Coulomb friction of the device, no more than there is [N], 0 to 100.
    count : float
        one encoder count at the handle, or of a finer encoder 1.1 N dt^2 / mass [m], 1e-09 to 0.01.
    current_lag : float
        time constant of the drive's current loop [s], 0 to 0.1.
    force_lag : float
        time constant of the force sensor [s], 0 to 0.1.
    force_noise : float
        standard deviation of its noise; sets the bandwidth [N], 1e-04 to 10.
    force_age : float
        an older force is not used: the estimate is faded out [s], 1e-05 to 1.
    delay : int
        ticks from computing a command to its acting [samples], 0 to 8.
    every_law : bool
        laws that are not made for it meet the world at the estimate too, 0 to 1.
    learn_scale : bool
        learn from swings on a world how strong the motor is for the force sensor, to 10 %, 0 to 1.
    """

    @staticmethod
    def fields() -> list[Field]:
        """
        Return name, unit, meaning, default and range of every parameter.
        """
    @staticmethod
    def of(device: Device, timing: Timing) -> Observer:
        """
        Return the observer of a device whose commands act with the delay of `timing`. It counts with 0.8 of the device's Coulomb friction, and of a fine encoder with counts of 1.1 N dt^2 / mass.
        """
    def __eq__(self, other: typing.Any) -> bool: ...
    def __hash__(self) -> int: ...
    def __init__(
        self,
        *,
        mass: float = 0.25,
        damping: float = 2.0,
        friction: float = 0.0,
        count: float = 3.07e-05,
        current_lag: float = 0.0003,
        force_lag: float = 0.0008,
        force_noise: float = 0.03,
        force_age: float = 0.003,
        delay: int = 1,
        every_law: bool = False,
        learn_scale: bool = False,
    ) -> None: ...
    def __reduce__(self) -> tuple[typing.Any, ...]: ...
    def __repr__(self) -> str: ...
    def as_dict(self) -> dict[str, typing.Any]:
        """
        Return the parameters by name.
        """
    def replace(self, **changes: typing.Any) -> typing.Self:
        """
        Return a copy with some parameters changed, checked as at construction.
        """
    @property
    def count(self) -> float:
        """
        one encoder count at the handle, or of a finer encoder 1.1 N dt^2 / mass [m], 1e-09 to 0.01
        """
    @property
    def current_lag(self) -> float:
        """
        time constant of the drive's current loop [s], 0 to 0.1
        """
    @property
    def damping(self) -> float:
        """
        viscous damping of the device, B_h [N s/m], 0 to 500
        """
    @property
    def delay(self) -> int:
        """
        ticks from computing a command to its acting [samples], 0 to 8
        """
    @property
    def every_law(self) -> bool:
        """
        laws that are not made for it meet the world at the estimate too, 0 to 1
        """
    @property
    def force_age(self) -> float:
        """
        an older force is not used: the estimate is faded out [s], 1e-05 to 1
        """
    @property
    def force_lag(self) -> float:
        """
        time constant of the force sensor [s], 0 to 0.1
        """
    @property
    def force_noise(self) -> float:
        """
        standard deviation of its noise; sets the bandwidth [N], 1e-04 to 10
        """
    @property
    def friction(self) -> float:
        """
        Coulomb friction of the device, no more than there is [N], 0 to 100
        """
    @property
    def learn_scale(self) -> bool:
        """
        learn from swings on a world how strong the motor is for the force sensor, to 10 %, 0 to 1
        """
    @property
    def mass(self) -> float:
        """
        device mass at the handle, M_h [kg], 0.001 to 100
        """

class Limits:
    """
    Safety limits of a loop on every axis.

    Parameters
    ----------
    continuous_current : float
        current the motor takes for ever [A], 0.001 to 1000.
    peak_current : float
        largest current at any time [A], 0.001 to 1000.
    thermal_time : float
        time constant of the winding in the i2t model (indicative: RE 30 data sheet, from memory) [s], 0.01 to 10000.
    slew : float
        fastest change of the current [A/s], 1 to 1e+09.
    speed : float
        faster, over 0.9 ms and by more than an encoder count, is a fault [m/s], 0.001 to 100.
    jump : float
        a longer way in one tick is an encoder's fault [m], 1e-06 to 1.
    edge : float
        way from the middle at which a soft wall begins; on a slide less by the way that its stops are closer [m], 0.001 to 10.
    edge_stiffness : float
        stiffness of that wall [N/m], 0 to 1e+05.
    edge_damping : float
        damping of that wall [N s/m], 0 to 500.
    end : float
        way from the middle that is a fault; on a slide as edge [m], 0.001 to 10.
    force_age : float
        an older force is a fault [s], 1e-04 to 10.
    watch_force : bool
        whether a force sensor that is stale, saturated or gone is a fault, 0 to 1.
    watch_motion : bool
        whether an encoder, a force sensor and a motor that contradict each other are a fault; needs a force sensor, 0 to 1.
    unexplained : float
        force at the handle by which they may differ: friction the device model does not know, weight, bias of the sensor [N], 0.01 to 1000.
    overruns : int
        ticks in a row that came a tick or more too late, which are a fault [samples], 1 to 1e+05.
    pause : float
        time lost by late ticks, at once or within a second, that is a fault; after a fifth of it at once the force comes in anew [s], 0.001 to 10000.
    starved : float
        time for which a law's energy account may withhold more than half of its force [s], 0.001 to 1e+06.
    """

    @staticmethod
    def fields() -> list[Field]:
        """
        Return name, unit, meaning, default and range of every parameter.
        """
    @staticmethod
    def of(device: Device) -> Limits:
        """
        Return the limits that follow from motor, drive and stops of a device.
        """
    def __eq__(self, other: typing.Any) -> bool: ...
    def __hash__(self) -> int: ...
    def __init__(
        self,
        *,
        continuous_current: float = 0.985,
        peak_current: float = 3.94,
        thermal_time: float = 16.0,
        slew: float = 8000.0,
        speed: float = 1.5,
        jump: float = 0.005,
        edge: float = 0.0474,
        edge_stiffness: float = 500.0,
        edge_damping: float = 2.0,
        end: float = 0.0574,
        force_age: float = 0.02,
        watch_force: bool = True,
        watch_motion: bool = True,
        unexplained: float = 2.0,
        overruns: int = 10,
        pause: float = 0.05,
        starved: float = 2.0,
    ) -> None: ...
    def __reduce__(self) -> tuple[typing.Any, ...]: ...
    def __repr__(self) -> str: ...
    def as_dict(self) -> dict[str, typing.Any]:
        """
        Return the parameters by name.
        """
    def replace(self, **changes: typing.Any) -> typing.Self:
        """
        Return a copy with some parameters changed, checked as at construction.
        """
    @property
    def continuous_current(self) -> float:
        """
        current the motor takes for ever [A], 0.001 to 1000
        """
    @property
    def edge(self) -> float:
        """
        way from the middle at which a soft wall begins; on a slide less by the way that its stops are closer [m], 0.001 to 10
        """
    @property
    def edge_damping(self) -> float:
        """
        damping of that wall [N s/m], 0 to 500
        """
    @property
    def edge_stiffness(self) -> float:
        """
        stiffness of that wall [N/m], 0 to 1e+05
        """
    @property
    def end(self) -> float:
        """
        way from the middle that is a fault; on a slide as edge [m], 0.001 to 10
        """
    @property
    def force_age(self) -> float:
        """
        an older force is a fault [s], 1e-04 to 10
        """
    @property
    def jump(self) -> float:
        """
        a longer way in one tick is an encoder's fault [m], 1e-06 to 1
        """
    @property
    def overruns(self) -> int:
        """
        ticks in a row that came a tick or more too late, which are a fault [samples], 1 to 1e+05
        """
    @property
    def pause(self) -> float:
        """
        time lost by late ticks, at once or within a second, that is a fault; after a fifth of it at once the force comes in anew [s], 0.001 to 10000
        """
    @property
    def peak_current(self) -> float:
        """
        largest current at any time [A], 0.001 to 1000
        """
    @property
    def slew(self) -> float:
        """
        fastest change of the current [A/s], 1 to 1e+09
        """
    @property
    def speed(self) -> float:
        """
        faster, over 0.9 ms and by more than an encoder count, is a fault [m/s], 0.001 to 100
        """
    @property
    def starved(self) -> float:
        """
        time for which a law's energy account may withhold more than half of its force [s], 0.001 to 1e+06
        """
    @property
    def thermal_time(self) -> float:
        """
        time constant of the winding in the i2t model (indicative: RE 30 data sheet, from memory) [s], 0.01 to 10000
        """
    @property
    def unexplained(self) -> float:
        """
        force at the handle by which they may differ: friction the device model does not know, weight, bias of the sensor [N], 0.01 to 1000
        """
    @property
    def watch_force(self) -> bool:
        """
        whether a force sensor that is stale, saturated or gone is a fault, 0 to 1
        """
    @property
    def watch_motion(self) -> bool:
        """
        whether an encoder, a force sensor and a motor that contradict each other are a fault; needs a force sensor, 0 to 1
        """

class RunPlan:
    """
    Start and end of a run.

    Parameters
    ----------
    soft_start : float
        time in which the force comes in [s], 0 to 60.
    ramp_down : float
        time in which it goes out at a good end [s], 0 to 10.
    stop_ticks : int
        ticks with zero force in which the device is told to stop [samples], 1 to 1e+05.
    rest_ticks : int
        further ticks of that kind for a device that is not at rest yet, at most [samples], 0 to 1e+06.
    arm : bool
        begin by enabling the device; a run that does always ends by a stop, 0 to 1.
    ticks : int
        ticks under the law; 0 for until it is asked [samples], 0 to 9e+15.
    """
    @staticmethod
    def fields() -> list[Field]:
        """
        Return name, unit, meaning, default and range of every parameter.
        """
    def __eq__(self, other: typing.Any) -> bool: ...
    def __hash__(self) -> int: ...
    def __init__(
        self,
        *,
        soft_start: float = 0.0,
        ramp_down: float = 0.0,
        stop_ticks: int = 10,
        rest_ticks: int = 0,
        arm: bool = False,
        ticks: int = 0,
    ) -> None: ...
    def __reduce__(self) -> tuple[typing.Any, ...]: ...
    def __repr__(self) -> str: ...
    def as_dict(self) -> dict[str, typing.Any]:
        """
        Return the parameters by name.
        """
    def replace(self, **changes: typing.Any) -> typing.Self:
        """
        Return a copy with some parameters changed, checked as at construction.
        """
    @property
    def arm(self) -> bool:
        """
        begin by enabling the device; a run that does always ends by a stop, 0 to 1
        """
    @property
    def ramp_down(self) -> float:
        """
        time in which it goes out at a good end [s], 0 to 10
        """
    @property
    def rest_ticks(self) -> int:
        """
        further ticks of that kind for a device that is not at rest yet, at most [samples], 0 to 1e+06
        """
    @property
    def soft_start(self) -> float:
        """
        time in which the force comes in [s], 0 to 60
        """
    @property
    def stop_ticks(self) -> int:
        """
        ticks with zero force in which the device is told to stop [samples], 1 to 1e+05
        """
    @property
    def ticks(self) -> int:
        """
        ticks under the law; 0 for until it is asked [samples], 0 to 9e+15
        """

class RunSetup:
    """
    Setup of a run on hardware, without its bus and its law.
    """
    def __init__(
        self,
        *,
        device: Device,
        environment: Free | Wall | Corner | Disc | _World,
        dt: typing.SupportsFloat | typing.SupportsIndex,
        nodes: collections.abc.Sequence[typing.SupportsInt | typing.SupportsIndex],
        answer_time: typing.SupportsFloat | typing.SupportsIndex,
        plan: RunPlan,
        limits: Limits | None,
        sensor: RdtSetup | None,
        rows: typing.SupportsInt | typing.SupportsIndex,
        ring: bool,
        mode: RealTimeMode,
        realtime: RealTime,
        drives: dict[str, typing.Any],
        aim: SharedHandTarget | None = None,
        observer: Observer | None = None,
        motor_sign: collections.abc.Sequence[typing.SupportsInt | typing.SupportsIndex] = [],
        encoder_sign: collections.abc.Sequence[typing.SupportsInt | typing.SupportsIndex] = [],
        encoder_zero: collections.abc.Sequence[typing.SupportsInt | typing.SupportsIndex] = [],
    ) -> None:
        """
        `drives` are the fields of CanopenSetup by name.
        """

class Running:
    """
    A running loop that never touches Python.
    """
    def aim(
        self,
        target: typing.Annotated[
            collections.abc.Sequence[typing.SupportsFloat | typing.SupportsIndex], "FixedSize(3)"
        ],
    ) -> int:
        """
        Set the target of a simulated hand [m]; NaN leaves an axis unchanged.
        """
    def change_world(self, environment: Free | Wall | Corner | Disc | _World) -> int:
        """
        Apply another environment from the next tick on; return the serial number of the update.
        """
    def changes(
        self, start: typing.SupportsInt | typing.SupportsIndex = 0
    ) -> list[tuple[int, int, str]]:
        """
        Return the applied updates: (tick, serial number, parameter).
        """
    def hold_back(self, ticks: typing.SupportsInt | typing.SupportsIndex) -> int:
        """
        Hold each command back by so many more ticks, 0 to 7; for simulated drives. Return the serial number of the update.
        """
    def join(self) -> None:
        """
        Wait until the loop has ended.
        """
    def replace_law(self, law: ebac.laws.CoreLaw) -> int:
        """
        Let another law take over from the next tick on, its force blended in over 50 ms; return the serial number of the update.
        """
    def retune(self, law: ebac.laws.CoreLaw) -> int:
        """
        Apply the gains of `law` from the next tick on; return the serial number of the update.
        """
    def stop(self, at_once: bool = False) -> None:
        """
        Request a stop; at once: without the ramp of the force.
        """
    def wait(self, seconds: typing.SupportsFloat | typing.SupportsIndex) -> bool:
        """
        Wait up to `seconds` [s]; return whether the loop has ended.
        """
    @property
    def at_rest(self) -> bool:
        """
        Whether every drive reported power off in the last tick. Only after the loop has ended.
        """
    @property
    def bus(self) -> BusCounts:
        """
        Frame counts of its end of the bus.
        """
    @property
    def changes_lost(self) -> int:
        """
        Updates that were applied but not recorded.
        """
    @property
    def done(self) -> bool:
        """
        Whether the loop has ended.
        """
    @property
    def grants(self) -> list[Grant]:
        """
        Resources that its thread requested and was granted.
        """
    @property
    def rows(self) -> Rows:
        """
        Rows of the trace; they grow while the loop runs.
        """
    @property
    def state(self) -> LoopState:
        """
        Final state: idle or fault.
        """
    @property
    def unrecorded(self) -> int:
        """
        Ticks not recorded because the trace was full.
        """

class Coupling:
    """
    How master and slave are coupled; the same on both sides.

    Parameters
    ----------
    scheme : int
        0 position and force, 1 passivity control, 2 waves, 0 to 2.
    impedance : float
        wave impedance b; damping of the slave's controller with waves [N s/m], 0.1 to 1000.
    injection : float
        largest damping of the master's passivity controller [N s/m], 0 to 1000.
    follow : bool
        compensate position drift, with energy that is left over; 0 leaves it, 0 to 1.
    reserve : float
        energy that each port may give out before any has come in: without it nothing begins to move [J], 0 to 1.
    measured : bool
        1 sends the force of the environment back, 0 that of the slave's controller, 0 to 1.
    stiffness : float
        of the slave's position controller [N/m], 1 to 1e+05.
    damping : float
        of the slave's position controller; with waves it is their impedance [N s/m], 0 to 1000.
    catch_up : float
        largest speed at which drift is compensated, on top of the motion [m/s], 0 to 10.
    realign : float
        largest speed at which the slave goes back to the master's place after consent to go on; 0 goes on from where both are [m/s], 0 to 1.
    fastest : float
        position and force: largest speed of the slave's target, after a gap in what comes [m/s], 0.01 to 10.
    buffer : float
        play-out buffer of both receivers, against jitter and loss; it adds to the delay [s], 0 to 0.3.
    timeout : float
        silence after which the link counts as lost [s], 0.01 to 10.
    fade : float
        in which the master's force goes to zero and comes back [s], 0.001 to 10.
    peak_force : float
        largest force of the slave [N], 0.1 to 10000.
    """

    @staticmethod
    def fields() -> list[Field]:
        """
        Return name, unit, meaning, default and range of every parameter.
        """
    def __eq__(self, other: typing.Any) -> bool: ...
    def __hash__(self) -> int: ...
    def __init__(
        self,
        *,
        scheme: int = 0,
        impedance: float = 20.0,
        injection: float = 20.0,
        follow: bool = True,
        reserve: float = 0.005,
        measured: bool = False,
        stiffness: float = 4000.0,
        damping: float = 40.0,
        catch_up: float = 0.1,
        realign: float = 0.02,
        fastest: float = 0.3,
        buffer: float = 0.0,
        timeout: float = 0.5,
        fade: float = 0.2,
        peak_force: float = 30.0,
    ) -> None: ...
    def __reduce__(self) -> tuple[typing.Any, ...]: ...
    def __repr__(self) -> str: ...
    def as_dict(self) -> dict[str, typing.Any]:
        """
        Return the parameters by name.
        """
    def replace(self, **changes: typing.Any) -> typing.Self:
        """
        Return a copy with some parameters changed, checked as at construction.
        """
    @property
    def buffer(self) -> float:
        """
        play-out buffer of both receivers, against jitter and loss; it adds to the delay [s], 0 to 0.3
        """
    @property
    def catch_up(self) -> float:
        """
        largest speed at which drift is compensated, on top of the motion [m/s], 0 to 10
        """
    @property
    def damping(self) -> float:
        """
        of the slave's position controller; with waves it is their impedance [N s/m], 0 to 1000
        """
    @property
    def fade(self) -> float:
        """
        in which the master's force goes to zero and comes back [s], 0.001 to 10
        """
    @property
    def fastest(self) -> float:
        """
        position and force: largest speed of the slave's target, after a gap in what comes [m/s], 0.01 to 10
        """
    @property
    def follow(self) -> bool:
        """
        compensate position drift, with energy that is left over; 0 leaves it, 0 to 1
        """
    @property
    def impedance(self) -> float:
        """
        wave impedance b; damping of the slave's controller with waves [N s/m], 0.1 to 1000
        """
    @property
    def injection(self) -> float:
        """
        largest damping of the master's passivity controller [N s/m], 0 to 1000
        """
    @property
    def measured(self) -> bool:
        """
        1 sends the force of the environment back, 0 that of the slave's controller, 0 to 1
        """
    @property
    def peak_force(self) -> float:
        """
        largest force of the slave [N], 0.1 to 10000
        """
    @property
    def realign(self) -> float:
        """
        largest speed at which the slave goes back to the master's place after consent to go on; 0 goes on from where both are [m/s], 0 to 1
        """
    @property
    def reserve(self) -> float:
        """
        energy that each port may give out before any has come in: without it nothing begins to move [J], 0 to 1
        """
    @property
    def scheme(self) -> int:
        """
        0 position and force, 1 passivity control, 2 waves, 0 to 2
        """
    @property
    def stiffness(self) -> float:
        """
        of the slave's position controller [N/m], 1 to 1e+05
        """
    @property
    def timeout(self) -> float:
        """
        silence after which the link counts as lost [s], 0.01 to 10
        """

class Link:
    """
    One direction of a network, simulated.

    Parameters
    ----------
    delay : float
        least time a packet takes, one way [s], 0 to 0.5.
    jitter : float
        largest time it takes longer; uniform [s], 0 to 0.2.
    loss : float
        share of packets that never arrive, 0 to 1.
    reorder : float
        share of packets that are held back by 5 ms more, so that later ones overtake them, 0 to 1.
    corrupt : float
        share of datagrams with a flipped bit; in the process `network` only, a simulation drops them as the CRC would, 0 to 1.
    cut_every : float
        period of the cuts of the link; 0 for none [s], 0 to 1e+06.
    cut_length : float
        how long each lasts, at the end of its period [s], 0 to 1e+06.
    """

    @staticmethod
    def fields() -> list[Field]:
        """
        Return name, unit, meaning, default and range of every parameter.
        """
    def __eq__(self, other: typing.Any) -> bool: ...
    def __hash__(self) -> int: ...
    def __init__(
        self,
        *,
        delay: float = 0.05,
        jitter: float = 0.0,
        loss: float = 0.0,
        reorder: float = 0.0,
        corrupt: float = 0.0,
        cut_every: float = 0.0,
        cut_length: float = 0.0,
    ) -> None: ...
    def __reduce__(self) -> tuple[typing.Any, ...]: ...
    def __repr__(self) -> str: ...
    def as_dict(self) -> dict[str, typing.Any]:
        """
        Return the parameters by name.
        """
    def replace(self, **changes: typing.Any) -> typing.Self:
        """
        Return a copy with some parameters changed, checked as at construction.
        """
    @property
    def corrupt(self) -> float:
        """
        share of datagrams with a flipped bit; in the process `network` only, a simulation drops them as the CRC would, 0 to 1
        """
    @property
    def cut_every(self) -> float:
        """
        period of the cuts of the link; 0 for none [s], 0 to 1e+06
        """
    @property
    def cut_length(self) -> float:
        """
        how long each lasts, at the end of its period [s], 0 to 1e+06
        """
    @property
    def delay(self) -> float:
        """
        least time a packet takes, one way [s], 0 to 0.5
        """
    @property
    def jitter(self) -> float:
        """
        largest time it takes longer; uniform [s], 0 to 0.2
        """
    @property
    def loss(self) -> float:
        """
        share of packets that never arrive, 0 to 1
        """
    @property
    def reorder(self) -> float:
        """
        share of packets that are held back by 5 ms more, so that later ones overtake them, 0 to 1
        """

class SlaveModel:
    """
    The slave's one axis, and the spring it meets.

    Parameters
    ----------
    mass : float
        of the slave [kg], 0.001 to 100.
    damping : float
        of its bearing [N s/m], 0 to 1000.
    contact : float
        where it meets the environment [m], -1 to 1.
    contact_stiffness : float
        of the environment; 0 for free motion [N/m], 0 to 1e+05.
    contact_damping : float
        of the environment, on the way in [N s/m], 0 to 1000.
    """

    @staticmethod
    def fields() -> list[Field]:
        """
        Return name, unit, meaning, default and range of every parameter.
        """
    def __eq__(self, other: typing.Any) -> bool: ...
    def __hash__(self) -> int: ...
    def __init__(
        self,
        *,
        mass: float = 0.5,
        damping: float = 2.0,
        contact: float = 0.02,
        contact_stiffness: float = 500.0,
        contact_damping: float = 4.0,
    ) -> None: ...
    def __reduce__(self) -> tuple[typing.Any, ...]: ...
    def __repr__(self) -> str: ...
    def as_dict(self) -> dict[str, typing.Any]:
        """
        Return the parameters by name.
        """
    def replace(self, **changes: typing.Any) -> typing.Self:
        """
        Return a copy with some parameters changed, checked as at construction.
        """
    @property
    def contact(self) -> float:
        """
        where it meets the environment [m], -1 to 1
        """
    @property
    def contact_damping(self) -> float:
        """
        of the environment, on the way in [N s/m], 0 to 1000
        """
    @property
    def contact_stiffness(self) -> float:
        """
        of the environment; 0 for free motion [N/m], 0 to 1e+05
        """
    @property
    def damping(self) -> float:
        """
        of its bearing [N s/m], 0 to 1000
        """
    @property
    def mass(self) -> float:
        """
        of the slave [kg], 0.001 to 100
        """

class TeleopPacket:
    """
    A datagram between master and slave; see `ebac.teleop` for the layout.
    """

    __hash__: typing.ClassVar[None] = None  # type: ignore[assignment]
    @staticmethod
    def decode(datagram: bytes) -> TeleopPacket | None:
        """
        Return the packet, or None for a datagram that is damaged or not of this version.
        """
    def __eq__(self, arg0: object) -> bool: ...
    def __init__(
        self,
        *,
        from_slave: bool = False,
        lost: bool = False,
        session: typing.SupportsInt | typing.SupportsIndex = 1,
        sequence: typing.SupportsInt | typing.SupportsIndex = 0,
        echo: typing.SupportsInt | typing.SupportsIndex = 0,
        stamp: typing.SupportsInt | typing.SupportsIndex = 0,
        value: typing.SupportsFloat | typing.SupportsIndex = 0.0,
        energy: typing.SupportsFloat | typing.SupportsIndex = 0.0,
        wave: typing.SupportsFloat | typing.SupportsIndex = 0.0,
        run: typing.SupportsInt | typing.SupportsIndex = 0,
        fault: typing.SupportsInt | typing.SupportsIndex = 0,
        leaving: bool = False,
        scheme: typing.SupportsInt | typing.SupportsIndex = 0,
        more: typing.Annotated[
            collections.abc.Sequence[typing.SupportsFloat | typing.SupportsIndex], "FixedSize(3)"
        ] = [0.0, 0.0, 0.0],
        at: typing.Annotated[
            collections.abc.Sequence[typing.SupportsFloat | typing.SupportsIndex], "FixedSize(4)"
        ] = [0.0, 0.0, 0.0, 0.0],
    ) -> None: ...
    def encode(self) -> bytes:
        """
        Return its 116 bytes.
        """
    @property
    def at(self) -> typing.Annotated[list[float], "FixedSize(4)"]:
        """
        From the slave: where its four axes are [m, rad].
        """
    @property
    def echo(self) -> int:
        """
        Newest number its sender has received.
        """
    @property
    def energy(self) -> float:
        """
        Energy into the network [J].
        """
    @property
    def fault(self) -> int:
        """
        Fault that has stopped the sender's drives; 0 for none.
        """
    @property
    def from_slave(self) -> bool:
        """
        Whether the slave sent it.
        """
    @property
    def leaving(self) -> bool:
        """
        Whether its sender ends.
        """
    @property
    def lost(self) -> bool:
        """
        Whether its sender has lost the link.
        """
    @property
    def more(self) -> typing.Annotated[list[float], "FixedSize(3)"]:
        """
        Rotation, bend to the right and down [rad], or their load [N m].
        """
    @property
    def run(self) -> int:
        """
        Number of the master's run.
        """
    @property
    def scheme(self) -> int:
        """
        `Coupling.scheme` of its sender.
        """
    @property
    def sequence(self) -> int:
        """
        Number within the session, from 1.
        """
    @property
    def session(self) -> int:
        """
        The hand's consents so far.
        """
    @property
    def stamp(self) -> int:
        """
        The sender's clock [ns].
        """
    @property
    def value(self) -> float:
        """
        Position of the master [m], or force [N].
        """
    @property
    def wave(self) -> float:
        """
        Integral of the wave variable [sqrt(W) s].
        """

class _UdpMaster:
    @staticmethod
    def units() -> dict[str, str]:
        """
        Units of what `run` returns, by name.
        """
    def __init__(
        self,
        *,
        setup: Setup,
        law: ebac.laws.CoreLaw,
        coupling: Coupling,
        host: str,
        port: typing.SupportsInt | typing.SupportsIndex,
        peer: str,
        peer_port: typing.SupportsInt | typing.SupportsIndex,
        consent_after: typing.SupportsFloat | typing.SupportsIndex,
    ) -> None: ...
    def consent(self) -> bool:
        """
        Agree to go on; False where the link is not back.
        """
    def run(self, seconds: typing.SupportsFloat | typing.SupportsIndex) -> dict[str, typing.Any]:
        """
        Run for a time [s]; return what it has met since it was made.
        """
    @property
    def port(self) -> int:
        """
        The UDP port it is bound to.
        """

class _UdpNetwork:
    @staticmethod
    def units() -> dict[str, str]:
        """
        Units of what `run` returns, by name.
        """
    def __init__(
        self,
        *,
        there: Link,
        back: Link,
        seed: typing.SupportsInt | typing.SupportsIndex,
        host: str,
        port: typing.SupportsInt | typing.SupportsIndex,
        slave: str,
        slave_port: typing.SupportsInt | typing.SupportsIndex,
    ) -> None: ...
    def cut(self, on: bool) -> None:
        """
        Cut both ways, or mend them.
        """
    def run(self, seconds: typing.SupportsFloat | typing.SupportsIndex) -> dict[str, typing.Any]:
        """
        Run for a time [s]; return what it has met since it was made.
        """
    @property
    def port(self) -> int:
        """
        The UDP port it is bound to.
        """

class _UdpSlave:
    @staticmethod
    def units() -> dict[str, str]:
        """
        Units of what `run` returns, by name.
        """
    def __init__(
        self,
        *,
        model: SlaveModel,
        coupling: Coupling,
        host: str,
        port: typing.SupportsInt | typing.SupportsIndex,
    ) -> None: ...
    def run(self, seconds: typing.SupportsFloat | typing.SupportsIndex) -> dict[str, typing.Any]:
        """
        Run for a time [s]; return what it has met since it was made.
        """
    @property
    def port(self) -> int:
        """
        The UDP port it is bound to.
        """

def _simulate_teleop(
    law: ebac.laws.CoreLaw,
    setup: Setup,
    *,
    coupling: Coupling,
    slave: SlaveModel,
    there: Link,
    back: Link,
    consent_after: typing.SupportsFloat | typing.SupportsIndex,
) -> dict[str, typing.Any]: ...
def _teleop_fields() -> dict[str, typing.Any]: ...

class Scope:
    """
    A gastroscope whose four axes are driven by motors.

    Parameters
    ----------
    diameter : float
        outer diameter [m], 0.001 to 0.02.
    section : float
        length of the bending section [m], 0.01 to 0.2.
    tip : float
        length of the stiff tip ahead of it [m], 0 to 0.05.
    most_bend : float
        largest bend [rad], 0.1 to 4.
    bend_speed : float
        largest speed of a bending motor [rad/s], 0.01 to 50.
    insertion_speed : float
        largest speed of the insertion motor [m/s], 0.001 to 1.
    rotation_speed : float
        largest speed of the rotation motor [rad/s], 0.01 to 50.
    lag : float
        time constant of every motor's position loop [s], 0.001 to 1.
    most_torque : float
        load at which a bending motor stands still [N m], 0.01 to 10.
    most_push : float
        load at which the insertion motor stands still [N], 0.1 to 100.
    backlash : float
        slack of the tendons, from end to end, at the tip [rad], 0 to 1.
    hysteresis : float
        share of the bend that follows through friction in the sheaths, 0 to 0.9.
    hysteresis_width : float
        width of that friction, from end to end, at the tip [rad], 0 to 2.
    bend_stiffness : float
        of the section under a load, motors held [N m/rad], 0.05 to 50.
    bend_damping : float
        of the same [N m s/rad], 0.001 to 10.
    flexural_rigidity : float
        E I of the insertion tube [N m^2], 1e-04 to 1.
    axial_stiffness : float
        of the insertion tube between motor and tip [N/m], 50 to 1e+05.
    axial_damping : float
        of the same [N s/m], 0.1 to 1000.
    friction : float
        Coulomb's coefficient between tube and wall, 0 to 1.
    """

    @staticmethod
    def fields() -> list[Field]:
        """
        Return name, unit, meaning, default and range of every parameter.
        """
    def __eq__(self, other: typing.Any) -> bool: ...
    def __hash__(self) -> int: ...
    def __init__(
        self,
        *,
        diameter: float = 0.0092,
        section: float = 0.07,
        tip: float = 0.012,
        most_bend: float = 2.9,
        bend_speed: float = 2.0,
        insertion_speed: float = 0.08,
        rotation_speed: float = 3.0,
        lag: float = 0.03,
        most_torque: float = 0.6,
        most_push: float = 15.0,
        backlash: float = 0.1,
        hysteresis: float = 0.15,
        hysteresis_width: float = 0.2,
        bend_stiffness: float = 1.0,
        bend_damping: float = 0.05,
        flexural_rigidity: float = 0.015,
        axial_stiffness: float = 1500.0,
        axial_damping: float = 20.0,
        friction: float = 0.1,
    ) -> None: ...
    def __reduce__(self) -> tuple[typing.Any, ...]: ...
    def __repr__(self) -> str: ...
    def as_dict(self) -> dict[str, typing.Any]:
        """
        Return the parameters by name.
        """
    def replace(self, **changes: typing.Any) -> typing.Self:
        """
        Return a copy with some parameters changed, checked as at construction.
        """
    @property
    def axial_damping(self) -> float:
        """
        of the same [N s/m], 0.1 to 1000
        """
    @property
    def axial_stiffness(self) -> float:
        """
        of the insertion tube between motor and tip [N/m], 50 to 1e+05
        """
    @property
    def backlash(self) -> float:
        """
        slack of the tendons, from end to end, at the tip [rad], 0 to 1
        """
    @property
    def bend_damping(self) -> float:
        """
        of the same [N m s/rad], 0.001 to 10
        """
    @property
    def bend_speed(self) -> float:
        """
        largest speed of a bending motor [rad/s], 0.01 to 50
        """
    @property
    def bend_stiffness(self) -> float:
        """
        of the section under a load, motors held [N m/rad], 0.05 to 50
        """
    @property
    def diameter(self) -> float:
        """
        outer diameter [m], 0.001 to 0.02
        """
    @property
    def flexural_rigidity(self) -> float:
        """
        E I of the insertion tube [N m^2], 1e-04 to 1
        """
    @property
    def friction(self) -> float:
        """
        Coulomb's coefficient between tube and wall, 0 to 1
        """
    @property
    def hysteresis(self) -> float:
        """
        share of the bend that follows through friction in the sheaths, 0 to 0.9
        """
    @property
    def hysteresis_width(self) -> float:
        """
        width of that friction, from end to end, at the tip [rad], 0 to 2
        """
    @property
    def insertion_speed(self) -> float:
        """
        largest speed of the insertion motor [m/s], 0.001 to 1
        """
    @property
    def lag(self) -> float:
        """
        time constant of every motor's position loop [s], 0.001 to 1
        """
    @property
    def most_bend(self) -> float:
        """
        largest bend [rad], 0.1 to 4
        """
    @property
    def most_push(self) -> float:
        """
        load at which the insertion motor stands still [N], 0.1 to 100
        """
    @property
    def most_torque(self) -> float:
        """
        load at which a bending motor stands still [N m], 0.01 to 10
        """
    @property
    def rotation_speed(self) -> float:
        """
        largest speed of the rotation motor [rad/s], 0.01 to 50
        """
    @property
    def section(self) -> float:
        """
        length of the bending section [m], 0.01 to 0.2
        """
    @property
    def tip(self) -> float:
        """
        length of the stiff tip ahead of it [m], 0 to 0.05
        """

class Patient:
    """
    The way from the teeth to behind the pylorus.

    Parameters
    ----------
    mouth : float
        straight way from the teeth to the pharynx [m], 0.01 to 0.15.
    pharynx : float
        way from there to the oesophagus [m], 0.05 to 0.3.
    oesophagus : float
        length of the oesophagus [m], 0.1 to 0.4.
    cardia : float
        length of the cardia [m], 0.01 to 0.1.
    stomach : float
        length of the stomach along its middle [m], 0.1 to 0.4.
    pylorus : float
        length of the pylorus [m], 0.01 to 0.06.
    bulb : float
        what is seen of the duodenum [m], 0.02 to 0.1.
    pharynx_radius : float
        radius of the pharynx [m], 0.006 to 0.04.
    oesophagus_radius : float
        radius of the oesophagus, insufflated [m], 0.006 to 0.03.
    cardia_radius : float
        radius of the open cardia [m], 0.005 to 0.03.
    stomach_radius : float
        largest radius of the stomach, insufflated [m], 0.015 to 0.08.
    pylorus_radius : float
        radius of the open pylorus [m], 0.005 to 0.02.
    throat_turn : float
        turn of the pharynx [rad], 0 to 2.5.
    cardia_turn : float
        turn of the cardia to the patient's left [rad], 0 to 1.5.
    stomach_turn : float
        turn of the stomach to the right [rad], 0 to 3.
    stiffness : float
        of the wall below the instrument [N/m], 10 to 10000.
    damping : float
        of the wall [N s/m], 0 to 100.
    bag_stiffness : float
        of the stomach as a whole against its place [N/m], 10 to 1e+05.
    bag_damping : float
        of the same [N s/m], 0.1 to 1000.
    peristalsis : float
        share of the radius that a wave of the oesophagus takes, 0 to 0.5.
    peristalsis_speed : float
        of that wave [m/s], 0.001 to 0.2.
    peristalsis_period : float
        from wave to wave [s], 1 to 600.
    antral_depth : float
        share of the radius that a wave of the antrum takes, 0 to 0.5.
    antral_speed : float
        of that wave [m/s], 1e-04 to 0.1.
    antral_period : float
        from wave to wave [s], 1 to 600.
    breathing : float
        way of the diaphragm up and down, half of it, with all below it [m], 0 to 0.05.
    breathing_rate : float
        breaths a second [Hz], 0 to 2.
    force_limit : float
        largest force that is called safe [N], 0.1 to 100.
    perforation : float
        force that counts as a perforation [N], 0.1 to 200.
    """

    @staticmethod
    def fields() -> list[Field]:
        """
        Return name, unit, meaning, default and range of every parameter.
        """
    def __eq__(self, other: typing.Any) -> bool: ...
    def __hash__(self) -> int: ...
    def __init__(
        self,
        *,
        mouth: float = 0.07,
        pharynx: float = 0.1,
        oesophagus: float = 0.22,
        cardia: float = 0.03,
        stomach: float = 0.24,
        pylorus: float = 0.02,
        bulb: float = 0.04,
        pharynx_radius: float = 0.014,
        oesophagus_radius: float = 0.01,
        cardia_radius: float = 0.009,
        stomach_radius: float = 0.038,
        pylorus_radius: float = 0.007,
        throat_turn: float = 1.2,
        cardia_turn: float = 0.6,
        stomach_turn: float = 1.7,
        stiffness: float = 800.0,
        damping: float = 2.0,
        bag_stiffness: float = 400.0,
        bag_damping: float = 20.0,
        peristalsis: float = 0.15,
        peristalsis_speed: float = 0.03,
        peristalsis_period: float = 10.0,
        antral_depth: float = 0.25,
        antral_speed: float = 0.0025,
        antral_period: float = 20.0,
        breathing: float = 0.01,
        breathing_rate: float = 0.25,
        force_limit: float = 6.0,
        perforation: float = 14.1,
    ) -> None: ...
    def __reduce__(self) -> tuple[typing.Any, ...]: ...
    def __repr__(self) -> str: ...
    def as_dict(self) -> dict[str, typing.Any]:
        """
        Return the parameters by name.
        """
    def replace(self, **changes: typing.Any) -> typing.Self:
        """
        Return a copy with some parameters changed, checked as at construction.
        """
    @property
    def antral_depth(self) -> float:
        """
        share of the radius that a wave of the antrum takes, 0 to 0.5
        """
    @property
    def antral_period(self) -> float:
        """
        from wave to wave [s], 1 to 600
        """
    @property
    def antral_speed(self) -> float:
        """
        of that wave [m/s], 1e-04 to 0.1
        """
    @property
    def bag_damping(self) -> float:
        """
        of the same [N s/m], 0.1 to 1000
        """
    @property
    def bag_stiffness(self) -> float:
        """
        of the stomach as a whole against its place [N/m], 10 to 1e+05
        """
    @property
    def breathing(self) -> float:
        """
        way of the diaphragm up and down, half of it, with all below it [m], 0 to 0.05
        """
    @property
    def breathing_rate(self) -> float:
        """
        breaths a second [Hz], 0 to 2
        """
    @property
    def bulb(self) -> float:
        """
        what is seen of the duodenum [m], 0.02 to 0.1
        """
    @property
    def cardia(self) -> float:
        """
        length of the cardia [m], 0.01 to 0.1
        """
    @property
    def cardia_radius(self) -> float:
        """
        radius of the open cardia [m], 0.005 to 0.03
        """
    @property
    def cardia_turn(self) -> float:
        """
        turn of the cardia to the patient's left [rad], 0 to 1.5
        """
    @property
    def damping(self) -> float:
        """
        of the wall [N s/m], 0 to 100
        """
    @property
    def force_limit(self) -> float:
        """
        largest force that is called safe [N], 0.1 to 100
        """
    @property
    def mouth(self) -> float:
        """
        straight way from the teeth to the pharynx [m], 0.01 to 0.15
        """
    @property
    def oesophagus(self) -> float:
        """
        length of the oesophagus [m], 0.1 to 0.4
        """
    @property
    def oesophagus_radius(self) -> float:
        """
        radius of the oesophagus, insufflated [m], 0.006 to 0.03
        """
    @property
    def perforation(self) -> float:
        """
        force that counts as a perforation [N], 0.1 to 200
        """
    @property
    def peristalsis(self) -> float:
        """
        share of the radius that a wave of the oesophagus takes, 0 to 0.5
        """
    @property
    def peristalsis_period(self) -> float:
        """
        from wave to wave [s], 1 to 600
        """
    @property
    def peristalsis_speed(self) -> float:
        """
        of that wave [m/s], 0.001 to 0.2
        """
    @property
    def pharynx(self) -> float:
        """
        way from there to the oesophagus [m], 0.05 to 0.3
        """
    @property
    def pharynx_radius(self) -> float:
        """
        radius of the pharynx [m], 0.006 to 0.04
        """
    @property
    def pylorus(self) -> float:
        """
        length of the pylorus [m], 0.01 to 0.06
        """
    @property
    def pylorus_radius(self) -> float:
        """
        radius of the open pylorus [m], 0.005 to 0.02
        """
    @property
    def stiffness(self) -> float:
        """
        of the wall below the instrument [N/m], 10 to 10000
        """
    @property
    def stomach(self) -> float:
        """
        length of the stomach along its middle [m], 0.1 to 0.4
        """
    @property
    def stomach_radius(self) -> float:
        """
        largest radius of the stomach, insufflated [m], 0.015 to 0.08
        """
    @property
    def stomach_turn(self) -> float:
        """
        turn of the stomach to the right [rad], 0 to 3
        """
    @property
    def throat_turn(self) -> float:
        """
        turn of the pharynx [rad], 0 to 2.5
        """

class Master:
    """
    How the joystick commands the gastroscope and is pushed back.

    Parameters
    ----------
    bend_by_rate : bool
        whether the handle's place is a rate of bending instead of a bend.
    insertion : int
        0 pedals, 1 third axis as a rate, 2 third axis as a place, with a clutch, 0 to 2.
    bend_scale : float
        bend per way of the handle [rad/m], 1 to 500.
    bend_rate : float
        rate of bending per way of the handle [rad/(s m)], 0.1 to 1000.
    insertion_rate : float
        speed of insertion per way of the handle [1/s], 0.01 to 100.
    insertion_scale : float
        insertion per way of the handle, 0.01 to 100.
    dead_zone : float
        way of the handle that is no rate [m], 0 to 0.02.
    feedback : float
        share of the slave's force that the handle gets; 0 none, 0 to 10.
    push_scale : float
        force at the third axis per force of insertion, 0 to 10.
    most_force : float
        largest force asked of an axis of the handle [N], 0 to 100.
    delay : float
        of the line each way, picture and force alike [s], 0 to 2.
    """

    @staticmethod
    def fields() -> list[Field]:
        """
        Return name, unit, meaning, default and range of every parameter.
        """
    def __eq__(self, other: typing.Any) -> bool: ...
    def __hash__(self) -> int: ...
    def __init__(
        self,
        *,
        bend_by_rate: bool = False,
        insertion: int = 1,
        bend_scale: float = 50.0,
        bend_rate: float = 40.0,
        insertion_rate: float = 1.5,
        insertion_scale: float = 1.0,
        dead_zone: float = 0.001,
        feedback: float = 1.0,
        push_scale: float = 1.0,
        most_force: float = 20.0,
        delay: float = 0.0,
    ) -> None: ...
    def __reduce__(self) -> tuple[typing.Any, ...]: ...
    def __repr__(self) -> str: ...
    def as_dict(self) -> dict[str, typing.Any]:
        """
        Return the parameters by name.
        """
    def replace(self, **changes: typing.Any) -> typing.Self:
        """
        Return a copy with some parameters changed, checked as at construction.
        """
    @property
    def bend_by_rate(self) -> bool:
        """
        whether the handle's place is a rate of bending instead of a bend
        """
    @property
    def bend_rate(self) -> float:
        """
        rate of bending per way of the handle [rad/(s m)], 0.1 to 1000
        """
    @property
    def bend_scale(self) -> float:
        """
        bend per way of the handle [rad/m], 1 to 500
        """
    @property
    def dead_zone(self) -> float:
        """
        way of the handle that is no rate [m], 0 to 0.02
        """
    @property
    def delay(self) -> float:
        """
        of the line each way, picture and force alike [s], 0 to 2
        """
    @property
    def feedback(self) -> float:
        """
        share of the slave's force that the handle gets; 0 none, 0 to 10
        """
    @property
    def insertion(self) -> int:
        """
        0 pedals, 1 third axis as a rate, 2 third axis as a place, with a clutch, 0 to 2
        """
    @property
    def insertion_rate(self) -> float:
        """
        speed of insertion per way of the handle [1/s], 0.01 to 100
        """
    @property
    def insertion_scale(self) -> float:
        """
        insertion per way of the handle, 0.01 to 100
        """
    @property
    def most_force(self) -> float:
        """
        largest force asked of an axis of the handle [N], 0 to 100
        """
    @property
    def push_scale(self) -> float:
        """
        force at the third axis per force of insertion, 0 to 10
        """

class Physician:
    """
    A simulated physician, who steers by the picture.

    Parameters
    ----------
    reaction : float
        from picture to hand [s], 0.02 to 2.
    crossover : float
        speed with which a bearing is corrected, times all delay: below 0.5 it does not swing, 0.01 to 1.5.
    noise : float
        standard deviation of a bearing, in each picture [rad], 0 to 1.
    hand_speed : float
        fastest motion of the hand [m/s], 0.001 to 2.
    advance : float
        speed of insertion along a clear lumen [m/s], 0.001 to 0.5.
    approach : float
        speed of insertion towards a target [m/s], 0.001 to 0.5.
    retreat : float
        speed of withdrawal [m/s], 0.001 to 0.5.
    look_ahead : float
        how far along the lumen it looks [m], 0.005 to 0.2.
    field_of_view : float
        of the camera [rad], 0.5 to 3.1.
    heed : float
        felt force at which it stops to advance; 0 heeds none [N], 0 to 100.
    patience : float
        after which it leaves a target [s], 1 to 600.
    """

    @staticmethod
    def fields() -> list[Field]:
        """
        Return name, unit, meaning, default and range of every parameter.
        """
    def __eq__(self, other: typing.Any) -> bool: ...
    def __hash__(self) -> int: ...
    def __init__(
        self,
        *,
        reaction: float = 0.25,
        crossover: float = 0.35,
        noise: float = 0.03,
        hand_speed: float = 0.06,
        advance: float = 0.03,
        approach: float = 0.012,
        retreat: float = 0.02,
        look_ahead: float = 0.045,
        field_of_view: float = 2.44,
        heed: float = 0.0,
        patience: float = 30.0,
    ) -> None: ...
    def __reduce__(self) -> tuple[typing.Any, ...]: ...
    def __repr__(self) -> str: ...
    def as_dict(self) -> dict[str, typing.Any]:
        """
        Return the parameters by name.
        """
    def replace(self, **changes: typing.Any) -> typing.Self:
        """
        Return a copy with some parameters changed, checked as at construction.
        """
    @property
    def advance(self) -> float:
        """
        speed of insertion along a clear lumen [m/s], 0.001 to 0.5
        """
    @property
    def approach(self) -> float:
        """
        speed of insertion towards a target [m/s], 0.001 to 0.5
        """
    @property
    def crossover(self) -> float:
        """
        speed with which a bearing is corrected, times all delay: below 0.5 it does not swing, 0.01 to 1.5
        """
    @property
    def field_of_view(self) -> float:
        """
        of the camera [rad], 0.5 to 3.1
        """
    @property
    def hand_speed(self) -> float:
        """
        fastest motion of the hand [m/s], 0.001 to 2
        """
    @property
    def heed(self) -> float:
        """
        felt force at which it stops to advance; 0 heeds none [N], 0 to 100
        """
    @property
    def look_ahead(self) -> float:
        """
        how far along the lumen it looks [m], 0.005 to 0.2
        """
    @property
    def noise(self) -> float:
        """
        standard deviation of a bearing, in each picture [rad], 0 to 1
        """
    @property
    def patience(self) -> float:
        """
        after which it leaves a target [s], 1 to 600
        """
    @property
    def reaction(self) -> float:
        """
        from picture to hand [s], 0.02 to 2
        """
    @property
    def retreat(self) -> float:
        """
        speed of withdrawal [m/s], 0.001 to 0.5
        """

class Polyp:
    """
    A target on the wall.

    Parameters
    ----------
    place : float
        along the lumen, from the teeth [m], 0 to 1.2.
    angle : float
        around it, from the camera's right to its down [rad], -6.3 to 6.3.
    """

    @staticmethod
    def fields() -> list[Field]:
        """
        Return name, unit, meaning, default and range of every parameter.
        """
    def __eq__(self, other: typing.Any) -> bool: ...
    def __hash__(self) -> int: ...
    def __init__(self, *, place: float = 0.5, angle: float = 0.0) -> None: ...
    def __reduce__(self) -> tuple[typing.Any, ...]: ...
    def __repr__(self) -> str: ...
    def as_dict(self) -> dict[str, typing.Any]:
        """
        Return the parameters by name.
        """
    def replace(self, **changes: typing.Any) -> typing.Self:
        """
        Return a copy with some parameters changed, checked as at construction.
        """
    @property
    def angle(self) -> float:
        """
        around it, from the camera's right to its down [rad], -6.3 to 6.3
        """
    @property
    def place(self) -> float:
        """
        along the lumen, from the teeth [m], 0 to 1.2
        """

class _Lumen:
    def __init__(
        self,
        patient: Patient,
        points: collections.abc.Sequence[
            typing.Annotated[
                collections.abc.Sequence[typing.SupportsFloat | typing.SupportsIndex],
                "FixedSize(3)",
            ]
        ],
        radii: collections.abc.Sequence[typing.SupportsFloat | typing.SupportsIndex],
        wall: _Solid | None,
    ) -> None: ...
    def at(
        self,
        s: typing.SupportsFloat | typing.SupportsIndex,
        t: typing.SupportsFloat | typing.SupportsIndex,
        bag: typing.Annotated[
            collections.abc.Sequence[typing.SupportsFloat | typing.SupportsIndex], "FixedSize(3)"
        ] = [0.0, 0.0, 0.0],
    ) -> tuple[
        typing.Annotated[list[float], "FixedSize(3)"],
        typing.Annotated[list[float], "FixedSize(3)"],
        typing.Annotated[list[float], "FixedSize(3)"],
        typing.Annotated[list[float], "FixedSize(3)"],
        float,
    ]: ...
    def landmarks(self) -> dict[str, typing.Any]: ...
    def near(
        self,
        x: typing.Annotated[
            collections.abc.Sequence[typing.SupportsFloat | typing.SupportsIndex], "FixedSize(3)"
        ],
        radius: typing.SupportsFloat | typing.SupportsIndex,
        t: typing.SupportsFloat | typing.SupportsIndex,
        station: typing.SupportsInt | typing.SupportsIndex,
    ) -> tuple[float, float, typing.Annotated[list[float], "FixedSize(3)"]]: ...

class _Slave:
    def __init__(
        self, scope: Scope, lumen: _Lumen, start: typing.SupportsFloat | typing.SupportsIndex
    ) -> None: ...
    def state(self) -> dict[str, typing.Any]: ...
    def step(
        self,
        command: typing.Annotated[
            collections.abc.Sequence[typing.SupportsFloat | typing.SupportsIndex], "FixedSize(3)"
        ],
        rotation: typing.SupportsFloat | typing.SupportsIndex,
        dt: typing.SupportsFloat | typing.SupportsIndex,
    ) -> typing.Annotated[list[float], "FixedSize(3)"]: ...

class _Procedure:
    def __init__(
        self,
        *,
        scope: Scope,
        lumen: _Lumen,
        master: Master,
        physician: Physician,
        targets: collections.abc.Sequence[Polyp],
        start: typing.SupportsFloat | typing.SupportsIndex,
    ) -> None: ...

class _Navigation:
    @staticmethod
    def units() -> dict[str, str]: ...
    def __init__(self, procedure: _Procedure, setup: Setup, law: ebac.laws.CoreLaw) -> None: ...
    def advance(self, ticks: typing.SupportsInt | typing.SupportsIndex) -> None: ...
    def findings(self) -> dict[str, typing.Any]: ...
    def row(self) -> dict[str, typing.Any]: ...
    def state(self) -> dict[str, typing.Any]: ...
    @property
    def ended(self) -> bool: ...

def _camera(
    bend_x: typing.SupportsFloat | typing.SupportsIndex,
    bend_y: typing.SupportsFloat | typing.SupportsIndex,
    section: typing.SupportsFloat | typing.SupportsIndex,
    tip: typing.SupportsFloat | typing.SupportsIndex,
) -> tuple[
    typing.Annotated[list[float], "FixedSize(3)"],
    typing.Annotated[list[float], "FixedSize(3)"],
    typing.Annotated[list[float], "FixedSize(3)"],
    typing.Annotated[list[float], "FixedSize(3)"],
    typing.Annotated[list[typing.Annotated[list[float], "FixedSize(3)"]], "FixedSize(4)"],
]: ...
def _procedure_fields() -> list[tuple[str, str, str]]: ...
def _run_procedure(
    procedure: _Procedure,
    setup: Setup,
    law: ebac.laws.CoreLaw,
    every: typing.SupportsInt | typing.SupportsIndex,
    progress: SweepProgress,
) -> tuple[dict[str, typing.Any], dict[str, typing.Any]]: ...
def _run_procedures(
    procedures: collections.abc.Sequence[_Procedure],
    setups: collections.abc.Sequence[Setup],
    laws: collections.abc.Sequence[ebac.laws.CoreLaw],
    threads: typing.SupportsInt | typing.SupportsIndex,
    progress: SweepProgress,
) -> dict[str, typing.Any]: ...
def _ask_realtime(options: RealTime) -> list[Grant]:
    """
    Return the grants for a thread of this process.
    """

def _beat_period(silence: typing.SupportsFloat | typing.SupportsIndex) -> float: ...
def _check_limits(limits: Limits) -> None: ...
def _check_sensor(
    port: typing.SupportsInt | typing.SupportsIndex,
    retry: typing.SupportsFloat | typing.SupportsIndex,
    gone: typing.SupportsFloat | typing.SupportsIndex,
    rotation: typing.Annotated[
        collections.abc.Sequence[typing.SupportsFloat | typing.SupportsIndex], "FixedSize(9)"
    ],
    sign: typing.SupportsInt | typing.SupportsIndex,
) -> None:
    """
    Raise ValueError if a value is out of range.
    """

def _check_watch(
    name: str,
    seconds: typing.SupportsFloat | typing.SupportsIndex,
    ms: typing.SupportsInt | typing.SupportsIndex,
    what: str,
    period: typing.SupportsFloat | typing.SupportsIndex,
    dt: typing.SupportsFloat | typing.SupportsIndex,
) -> None: ...
def _decode_record(
    data: bytes,
) -> tuple[
    int,
    int,
    int,
    typing.Annotated[list[int], "FixedSize(3)"],
    typing.Annotated[list[int], "FixedSize(3)"],
]:
    """
    Return rdt_sequence, ft_sequence, status, force and torque of 36 bytes.
    """

def _drive_transitions() -> list[list[DriveState]]:
    """
    The simulated drive's table: a row per state; none, disable voltage, quick stop, shutdown, switch on, enable operation, fault reset.
    """

def _encode_record(
    rdt_sequence: typing.SupportsInt | typing.SupportsIndex,
    ft_sequence: typing.SupportsInt | typing.SupportsIndex,
    status: typing.SupportsInt | typing.SupportsIndex,
    force: typing.Annotated[
        collections.abc.Sequence[typing.SupportsInt | typing.SupportsIndex], "FixedSize(3)"
    ],
    torque: typing.Annotated[
        collections.abc.Sequence[typing.SupportsInt | typing.SupportsIndex], "FixedSize(3)"
    ],
) -> bytes:
    """
    Return the 36 bytes of a record.
    """

def _encode_request(
    command: typing.SupportsInt | typing.SupportsIndex,
    samples: typing.SupportsInt | typing.SupportsIndex = 0,
) -> bytes:
    """
    Return the 8 bytes of a request.
    """

def _exact_bits(
    id: typing.SupportsInt | typing.SupportsIndex,
    data: bytes,
    remote: bool,
    size: typing.SupportsInt | typing.SupportsIndex,
) -> int: ...
def _fault_campaign(
    cases: typing.SupportsInt | typing.SupportsIndex,
    seed: typing.SupportsInt | typing.SupportsIndex,
    threads: typing.SupportsInt | typing.SupportsIndex,
    progress: SweepProgress,
) -> tuple[dict[str, typing.Any], list[str]]:
    """
    Run a fault campaign; return a column per property of the cases, and the names of verdicts.
    """

def _fault_case(
    seed: typing.SupportsInt | typing.SupportsIndex,
    index: typing.SupportsInt | typing.SupportsIndex,
) -> tuple[Rows, int, int, int, str, str]:
    """
    Run one case; return its rows, first tick, ticks and axis of the fault, its verdict, and the rule that it broke.
    """

def _fault_kinds() -> list[tuple[str, str]]:
    """
    Name and meaning of every kind of fault; case i is of kind i modulo their number.
    """

def _grid(
    *,
    origin: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[3, 1]"],
    cell: typing.SupportsFloat | typing.SupportsIndex,
    margin: typing.SupportsFloat | typing.SupportsIndex,
    far: typing.Annotated[numpy.typing.ArrayLike, numpy.float32],
    index: typing.Annotated[numpy.typing.ArrayLike, numpy.int32],
    nodes: typing.Annotated[numpy.typing.ArrayLike, numpy.float32],
) -> _Solid: ...
def _ideal_contacts(
    setups: collections.abc.Sequence[Setup],
    threads: typing.SupportsInt | typing.SupportsIndex,
    progress: SweepProgress,
) -> dict[str, typing.Any]: ...
def _intersection(arg0: collections.abc.Sequence[_Solid]) -> _Solid: ...
def _inverted(arg0: _Solid) -> _Solid: ...
def _load_on_bus(
    axes: typing.SupportsInt | typing.SupportsIndex,
    dt: typing.SupportsFloat | typing.SupportsIndex,
    bus: TimedBus | None,
) -> BusLoad: ...
def _measure_contact(
    *,
    t: typing.Annotated[numpy.typing.ArrayLike, numpy.float64],
    x: typing.Annotated[numpy.typing.ArrayLike, numpy.float64],
    force: typing.Annotated[numpy.typing.ArrayLike, numpy.float64],
    energy: typing.Annotated[numpy.typing.ArrayLike, numpy.float64] | None = None,
    stored: typing.Annotated[numpy.typing.ArrayLike, numpy.float64] | None = None,
    clamped: typing.Annotated[numpy.typing.ArrayLike, numpy.float64] | None = None,
    pull: typing.Annotated[numpy.typing.ArrayLike, numpy.float64] | None = None,
    wall: typing.Annotated[numpy.typing.ArrayLike, numpy.float64] | None = None,
    others: collections.abc.Sequence[
        tuple[
            typing.Annotated[numpy.typing.ArrayLike, numpy.float64],
            typing.Annotated[numpy.typing.ArrayLike, numpy.float64],
            typing.Annotated[numpy.typing.ArrayLike, numpy.float64],
            typing.Annotated[numpy.typing.ArrayLike, numpy.float64] | None,
        ]
    ] = ...,
) -> dict[str, typing.Any]: ...
def _measure_jitter(
    dt: typing.SupportsFloat | typing.SupportsIndex,
    ticks: typing.SupportsInt | typing.SupportsIndex,
    mode: RealTimeMode,
    options: RealTime,
) -> tuple[numpy.typing.NDArray[numpy.float64], int, list[Grant]]:
    """
    Measure the lateness of every wake-up [s]; return it with skipped ticks and grants.
    """

def _placed(
    arg0: _Solid,
    arg1: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[3, 1]"],
    arg2: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[3, 1]"],
) -> _Solid: ...
def _rebuild(arg0: typing.Any, arg1: dict[str, typing.Any]) -> typing.Any: ...
def _replay_python(
    log: ReplayLog,
    law: ebac.laws.PythonLaw,
    device: Device,
    environment: Free | Wall | Corner | Disc | _World,
) -> Rows: ...
def _simulate_python(
    setup: Setup, law: ebac.laws.PythonLaw, through_can: bool = False, bus: TimedBus | None = None
) -> Rows: ...
def _solid(arg0: Plane | Sphere | Box | Cylinder | Capsule | Torus) -> _Solid: ...
def _stored_energy(
    environment: Free | Wall | Corner | Disc | _World,
    kinematics: Linear | Gimbal | SlidingGimbal,
    x: typing.Annotated[numpy.typing.ArrayLike, numpy.float64],
    t: typing.Annotated[numpy.typing.ArrayLike, numpy.float64],
) -> numpy.typing.NDArray[numpy.float64]: ...
def _textured(arg0: _Solid, arg1: Texture) -> _Solid: ...
def _time_bus(
    frames: typing.SupportsInt | typing.SupportsIndex,
    repeats: typing.SupportsInt | typing.SupportsIndex,
) -> float: ...
def _time_bus_threads(
    frames: typing.SupportsInt | typing.SupportsIndex,
    repeats: typing.SupportsInt | typing.SupportsIndex,
) -> float: ...
def _time_exchange(
    ticks: typing.SupportsInt | typing.SupportsIndex,
    repeats: typing.SupportsInt | typing.SupportsIndex,
) -> float: ...
def _time_own_exchange(
    ticks: typing.SupportsInt | typing.SupportsIndex,
    repeats: typing.SupportsInt | typing.SupportsIndex,
) -> float: ...
def _tube(
    arg0: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, 3]"],
    arg1: collections.abc.Sequence[typing.SupportsFloat | typing.SupportsIndex],
) -> _Solid: ...
def _union(arg0: collections.abc.Sequence[_Solid]) -> _Solid: ...
def _with_loop(
    setup: Setup,
    *,
    soft_start: typing.SupportsFloat | typing.SupportsIndex,
    ramp_down: typing.SupportsFloat | typing.SupportsIndex,
    limits: Limits | None,
) -> Setup:
    """
    Return the same setup with a soft start [s], a ramp to zero force after its seconds [s], and safety limits.
    """

def copley_current(
    torque_permille: typing.SupportsFloat | typing.SupportsIndex,
    continuous_torque_1e5: typing.SupportsFloat | typing.SupportsIndex,
    torque_constant_1e5: typing.SupportsFloat | typing.SupportsIndex,
) -> float:
    """
    Eq. (1) in Copley's units: I = 0.001 T Tc / Ts [A], T in thousandths of the continuous torque,
    Tc in 1e-5 N m, Ts in 1e-5 N m/A.
    """

def estimate_velocity(
    estimator: BackwardDifference | LowPass | AdaptiveWindow,
    x: typing.Annotated[numpy.typing.ArrayLike, numpy.float64],
    dt: typing.SupportsFloat | typing.SupportsIndex,
    count: typing.SupportsFloat | typing.SupportsIndex,
) -> numpy.typing.NDArray[numpy.float64]:
    """
    Velocity [m/s] from positions x [m], shape (n,), sampled every dt [s], 1e-6 to 3600, with an encoder step of count [m], 0 to 1.
    """

def least_bits(size: typing.SupportsInt | typing.SupportsIndex) -> int: ...
def pdo_plan(
    nodes: collections.abc.Sequence[typing.SupportsInt | typing.SupportsIndex],
) -> list[PlannedFrame]:
    """
    SYNC, and for every node an RPDO (controlword, target torque) and a TPDO (statusword,
    position, actual torque): the frames of one tick (CiA 301, CiA 402).
    """

def worst_bits(size: typing.SupportsInt | typing.SupportsIndex) -> int: ...

FEWEST_ROWS: int = 10
QUIET_PERCEIVED: float = 3.0
REFUSED_LOAD: float = 0.9
STILL_SWING: float = 0.00025
TAIL_SHARE: float = 0.3
WARNED_LOAD: float = 0.7

def _function_world(function: typing.Any) -> _World: ...
def _scheduled_function(
    function: typing.Any, timing: EngineTiming, params: BridgeParams, held: bool
) -> _World: ...
def _scheduled_world(
    world: _World, timing: EngineTiming, params: BridgeParams, held: bool
) -> _World: ...
def _bridge_report(world: _World) -> dict[str, typing.Any] | None: ...

class _DrivenMachine:
    pass

class FarLink:
    """
    When a link between loops on drives counts as lost.

    Parameters
    ----------
    timeout : float
        silence after which the link counts as lost [s], 0.01 to 10.
    fade : float
        in which the master's force goes to zero and comes back [s], 0.001 to 10.
    consent_after : float
        a simulated hand consents so long after the link is back; inf for never [s], at least 0.
    """

    @staticmethod
    def fields() -> list[Field]:
        """
        Return name, unit, meaning, default and range of every parameter.
        """
    def __eq__(self, other: typing.Any) -> bool: ...
    def __hash__(self) -> int: ...
    def __init__(
        self, *, timeout: float = 0.5, fade: float = 0.2, consent_after: float = ...
    ) -> None: ...
    def __reduce__(self) -> tuple[typing.Any, ...]: ...
    def __repr__(self) -> str: ...
    def as_dict(self) -> dict[str, typing.Any]:
        """
        Return the parameters by name.
        """
    def replace(self, **changes: typing.Any) -> typing.Self:
        """
        Return a copy with some parameters changed, checked as at construction.
        """
    @property
    def consent_after(self) -> float:
        """
        a simulated hand consents so long after the link is back; inf for never [s], at least 0
        """
    @property
    def fade(self) -> float:
        """
        in which the master's force goes to zero and comes back [s], 0.001 to 10
        """
    @property
    def timeout(self) -> float:
        """
        silence after which the link counts as lost [s], 0.01 to 10
        """

class Follow:
    """
    How the drives of a slave follow what its master asks.

    Parameters
    ----------
    stiffness : float
        of every position controller, at its cable [N/m], 1 to 1e+06.
    damping : float
        of the same [N s/m], 0 to 10000.
    most_force : float
        largest force asked of a drive [N], 0.1 to 1000.
    insertion_speed : float
        fastest insertion [m/s], 0.001 to 1.
    turn_speed : float
        fastest rotation and bend [rad/s], 0.01 to 50.
    realign : float
        fastest rotation and bend back to the stick at the beginning and after consent [rad/s], 0.01 to 50.
    deepest : float
        insertion from where the drives began, at most [m], 0.01 to 2.
    most_bend : float
        largest bend asked of the drives [rad], 0.1 to 4.
    """

    @staticmethod
    def fields() -> list[Field]:
        """
        Return name, unit, meaning, default and range of every parameter.
        """
    def __eq__(self, other: typing.Any) -> bool: ...
    def __hash__(self) -> int: ...
    def __init__(
        self,
        *,
        stiffness: float = 4000.0,
        damping: float = 30.0,
        most_force: float = 25.0,
        insertion_speed: float = 0.08,
        turn_speed: float = 2.0,
        realign: float = 0.5,
        deepest: float = 0.8,
        most_bend: float = 2.6,
    ) -> None: ...
    def __reduce__(self) -> tuple[typing.Any, ...]: ...
    def __repr__(self) -> str: ...
    def as_dict(self) -> dict[str, typing.Any]:
        """
        Return the parameters by name.
        """
    def replace(self, **changes: typing.Any) -> typing.Self:
        """
        Return a copy with some parameters changed, checked as at construction.
        """
    @property
    def damping(self) -> float:
        """
        of the same [N s/m], 0 to 10000
        """
    @property
    def deepest(self) -> float:
        """
        insertion from where the drives began, at most [m], 0.01 to 2
        """
    @property
    def insertion_speed(self) -> float:
        """
        fastest insertion [m/s], 0.001 to 1
        """
    @property
    def most_bend(self) -> float:
        """
        largest bend asked of the drives [rad], 0.1 to 4
        """
    @property
    def most_force(self) -> float:
        """
        largest force asked of a drive [N], 0.1 to 1000
        """
    @property
    def realign(self) -> float:
        """
        fastest rotation and bend back to the stick at the beginning and after consent [rad/s], 0.01 to 50
        """
    @property
    def stiffness(self) -> float:
        """
        of every position controller, at its cable [N/m], 1 to 1e+06
        """
    @property
    def turn_speed(self) -> float:
        """
        fastest rotation and bend [rad/s], 0.01 to 50
        """

class Gears:
    """
    What the cables at the slave's drives move.

    Parameters
    ----------
    insertion : float
        insertion per way of its cable, 0.01 to 100.
    rotation : float
        rotation per way of its cable [rad/m], 0.1 to 10000.
    bend : float
        bend per way of its cable [rad/m], 0.1 to 10000.
    """

    @staticmethod
    def fields() -> list[Field]:
        """
        Return name, unit, meaning, default and range of every parameter.
        """
    def __eq__(self, other: typing.Any) -> bool: ...
    def __hash__(self) -> int: ...
    def __init__(
        self,
        *,
        insertion: float = 1.0,
        rotation: float = 66.66666666666667,
        bend: float = 66.66666666666667,
    ) -> None: ...
    def __reduce__(self) -> tuple[typing.Any, ...]: ...
    def __repr__(self) -> str: ...
    def as_dict(self) -> dict[str, typing.Any]:
        """
        Return the parameters by name.
        """
    def replace(self, **changes: typing.Any) -> typing.Self:
        """
        Return a copy with some parameters changed, checked as at construction.
        """
    @property
    def bend(self) -> float:
        """
        bend per way of its cable [rad/m], 0.1 to 10000
        """
    @property
    def insertion(self) -> float:
        """
        insertion per way of its cable, 0.01 to 100
        """
    @property
    def rotation(self) -> float:
        """
        rotation per way of its cable [rad/m], 0.1 to 10000
        """

class _LinkEnd:
    @staticmethod
    def units() -> dict[str, str]: ...
    def consent(self) -> None: ...
    def events(
        self, start: typing.SupportsInt | typing.SupportsIndex = 0
    ) -> list[tuple[float, int, float]]: ...
    def fail(self, fault: Fault) -> None: ...
    def leave(self) -> None: ...
    def report(self) -> dict[str, typing.Any]: ...
    @property
    def port(self) -> int: ...

class _DrivenScope:
    def __init__(
        self,
        scope: Scope,
        lumen: _Lumen,
        start: typing.SupportsFloat | typing.SupportsIndex,
        gears: Gears,
    ) -> None: ...
    def load(self, group: typing.SupportsInt | typing.SupportsIndex) -> _DrivenMachine: ...
    def report(self) -> dict[str, typing.Any]: ...

def _master_link(
    *,
    params: FarLink,
    dt: typing.SupportsFloat | typing.SupportsIndex,
    host: str,
    port: typing.SupportsInt | typing.SupportsIndex,
    peer: tuple[str, typing.SupportsInt | typing.SupportsIndex],
) -> _LinkEnd: ...
def _master_world(link: _LinkEnd, params: Master) -> _World: ...
def _slave_link(
    *,
    params: FarLink,
    dt: typing.SupportsFloat | typing.SupportsIndex,
    host: str,
    port: typing.SupportsInt | typing.SupportsIndex,
) -> _LinkEnd: ...
def _slave_worlds(link: _LinkEnd, params: Follow, gears: Gears) -> tuple[_World, _World]: ...
def _targets(
    params: Follow,
    asked: collections.abc.Sequence[
        typing.Annotated[
            collections.abc.Sequence[typing.SupportsFloat | typing.SupportsIndex], "FixedSize(4)"
        ]
    ],
    dt: typing.SupportsFloat | typing.SupportsIndex,
) -> list[typing.Annotated[list[float], "FixedSize(4)"]]:
    """
    Return where a slave's targets go, tick by tick.
    """
