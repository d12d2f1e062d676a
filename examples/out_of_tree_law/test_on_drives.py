"""A law of this folder on drives, as `ebac run` has it: simulated, on a virtual clock and in real time."""

from my_laws import Damped, Tank

from ebac import datasets
from ebac.hardware import Configuration, OpenDevice
from ebac.hardware.patience import patient

JOYSTICK = Configuration.from_toml(datasets.joystick_text("joystick"), name="joystick")


def test_on_a_virtual_clock() -> None:
    trace = JOYSTICK.replace(law=Damped).simulate(seconds=0.5)
    assert trace.law == "damped"
    assert "law.injected" in trace


def test_in_real_time_with_changes_while_it_runs() -> None:
    known = patient(JOYSTICK.replace(law=Damped), pause=0.5)  # a machine that tests may be late
    with OpenDevice.open(known, simulate=True) as device:
        run = device.start(seconds=60)
        assert run.retune(virtual_damping=40.0).virtual_damping == 40
        assert run.replace_law(Tank.design(known.device, known.timing)).name == "tank"
        run.stop()
        run.wait()
        run.end()
        assert "law.injected" in run.trace()
    assert device.report is not None
    assert device.report.ended_by == "stop"
