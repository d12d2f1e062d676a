"""What a design computes and cannot be is blamed on what it comes from; what the user gave, on the user."""

import pytest

import ebac
from ebac.laws import design

LIGHT = ebac.Device(mechanics=ebac.Mechanics(handle_mass=0.02), motor=ebac.Motor(rotor_inertia=0.0))


def test_a_number_that_a_design_computed_is_blamed_on_the_timing() -> None:
    """It named a parameter that nobody had given, and took its seconds for milliseconds."""
    with pytest.raises(
        ValueError, match=r"^Timing\.dt = 0\.05 s \(20 Hz\): for it, 0 samples"
    ) as refused:
        design("lag-compensator", LIGHT, ebac.Timing(dt=0.05, delay=0))
    said = str(refused.value)
    assert "gives recovery_time = 12.09 s, which must lie in [0.001, 10] s" in said
    assert "ms is" not in said


def test_a_number_that_was_given_is_named_with_its_unit() -> None:
    with pytest.raises(
        ValueError, match=r"^LagCompensator\.recovery_time = 300 s: .*; 300 ms is 0.3 s$"
    ):
        design("lag-compensator", LIGHT, ebac.Timing(), recovery_time=300)


def test_a_device_without_damping_is_named_itself() -> None:
    device = ebac.Device(mechanics=ebac.Mechanics(damping=0.0))
    with pytest.raises(ValueError, match=r"^Mechanics\.damping = 0 N s/m: must lie in \[0\.01,"):
        ebac.design("ebac", device, ebac.Timing())


def test_a_motor_in_wrong_units_is_named_with_both_of_its_torques() -> None:
    """Where both are a thousand times too large, the rated current is that of a motor."""
    device = ebac.Device(motor=ebac.Motor(rated_torque=53.0, torque_constant=53.8))
    with pytest.raises(
        ValueError, match=r"^Motor\.rated_torque = 53 N m, torque_constant = 53\.8 N m/A"
    ) as refused:
        ebac.design("ebac", device, ebac.Timing())
    assert "EBAC.peak_force = 4.24e+04 N" in str(refused.value)
    text = "[device]\n[device.motor]\nrated_torque = 53.0\ntorque_constant = 53.8\n[law]\n"
    with pytest.raises(
        ebac.hardware.ConfigurationError, match=r"line 3: device\.motor\.rated_torque = 53 N m, "
    ):
        ebac.hardware.Configuration.from_toml(text, device_alone=True)
