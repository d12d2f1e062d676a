#include <exception>
#include <limits>
#include <memory>
#include <span>
#include <vector>

#include "bind.hpp"
#include "fields.hpp"
#include "replay.hpp"
#include "simulate_either.hpp"

namespace ebac::python {

namespace {

/// A law written in Python in the same loop, slowly: an object with `step(port) -> float` and
/// `reset()`. What it raises becomes NaN, so the loop stops as for any law, and is raised again
/// after the run.
class PythonLaw {
 public:
  struct State {
    static constexpr auto fields() { return std::array<Field<State>, 0>{}; }
  };

  PythonLaw(const py::object& law, int axes) : raised_(std::make_shared<std::exception_ptr>()) {
    const py::object deepcopy = py::module_::import("copy").attr("deepcopy");
    for (int i = 0; i < axes; ++i) laws_.push_back(deepcopy(law));
    reset();
  }

  void step(std::span<Axis> axes, const Touch& touch) noexcept {
    turned_.step(axes, touch,
                 [this](std::size_t i, const Port& port) noexcept { return ask(laws_[i], port); });
  }
  void reset() noexcept {
    try {
      for (const py::object& law : laws_) law.attr("reset")();
    } catch (...) {
      *raised_ = std::current_exception();
    }
  }
  const std::shared_ptr<std::exception_ptr>& raised() const { return raised_; }

 private:
  double ask(const py::object& law, const Port& port) noexcept {
    if (*raised_) return std::numeric_limits<double>::quiet_NaN();
    try {
      return law.attr("step")(port).cast<double>();
    } catch (...) {
      *raised_ = std::current_exception();
      return std::numeric_limits<double>::quiet_NaN();
    }
  }

  std::vector<py::object> laws_;
  TurnedPorts turned_{};
  std::shared_ptr<std::exception_ptr> raised_;
};

}  // namespace

void bind_python_law(py::module_& m) {
  m.def(
      "_simulate_python",
      [](const Setup& setup, const py::object& law, bool through_can) {
        PythonLaw wrapped(law, setup.device.axes());
        const auto raised = wrapped.raised();
        const auto trace = simulate_either(setup, std::move(wrapped), through_can);
        if (*raised) std::rethrow_exception(*raised);
        return trace;
      },
      py::arg("setup"), py::arg("law"), py::arg("through_can") = false);
  m.def(
      "_replay_python",
      [](const std::shared_ptr<ReplayLog>& log, const py::object& law, const DeviceModel& device,
         const Environment& environment) {
        PythonLaw wrapped(law, device.axes());
        const auto raised = wrapped.raised();
        const auto trace = replay_on(log, std::move(wrapped), device, environment);
        if (*raised) std::rethrow_exception(*raised);
        return trace;
      },
      py::arg("log"), py::arg("law"), py::arg("device"), py::arg("environment"));
}

}  // namespace ebac::python
