#include "bind.hpp"
#include "ebac/control/laws.hpp"
#include "running.hpp"

namespace ebac::python {

namespace {

template <class... Law>
void bind_starts(const std::tuple<Law...>*) {
  (bind_start_of<Law>(), ...);
}

}  // namespace

/// Every law in a loop of real time. After the laws and what a run is made of.
void bind_running_laws(py::module_&) { bind_starts(static_cast<const Laws*>(nullptr)); }

}  // namespace ebac::python
