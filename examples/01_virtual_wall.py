"""The paper's virtual wall: three laws against 10 kN/m, as numbers and as a figure."""

import ebac

scenario = ebac.Scenario()  # reference device and hand, wall of 10 kN/m, 1 kHz, one sample of delay
traces = [ebac.simulate(scenario, law) for law in ("tca", "eba", "ebac")]

for trace in traces:
    wall = ebac.contact(trace)
    print(
        f"{wall.law:5s} rests at {1e3 * wall.rest_m:6.3f} mm (ideal {1e3 * wall.ideal_m:.3f} mm), "
        f"swings {1e3 * wall.swing_m:6.3f} mm, least energy {1e3 * wall.least_energy_J:9.3f} mJ"
    )

traces[-1].plot().savefig("ebac.png")
