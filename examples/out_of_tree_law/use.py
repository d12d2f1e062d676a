"""The same law from Python: a class like those of the package."""

from my_laws import Damped

import ebac

scenario = ebac.Scenario()
for law in ("tca", Damped, "ebac"):
    result = ebac.contact(ebac.simulate(scenario, law))
    print(
        f"{result.law:8s} swings {1e3 * result.swing_m:.3f} mm, rests at {1e3 * result.rest_m:.3f} mm"
    )

law = Damped.design(scenario.device, scenario.timing)
print(law)
trace = ebac.simulate(scenario, law)
assert "law.injected" in trace
try:
    Damped(virtual_damping=-3)
except ValueError as error:
    print(error)
