#include <array>
#include <exception>
#include <limits>
#include <memory>
#include <string>

#include "bind.hpp"
#include "fields.hpp"
#include "replay.hpp"
#include "simulate_either.hpp"

namespace ebac::python {

namespace {

/// A law written in Python in the same loop, slowly: an object with `step(port) -> float` and
/// `reset()`. What it raises becomes NaN, so the loop stops as for any law, and is raised again
/// after the run.
class PythonLaw final : public LawObject {
 public:
  /// Nothing but the type of any of them: what it has is Python's own.
  struct Nothing {
    static constexpr auto fields() { return std::array<Field<Nothing>, 0>{}; }
  };

  PythonLaw(const py::object& law, std::shared_ptr<std::exception_ptr> raised)
      : LawObject(record()),
        law_(law),
        observed_(py::bool_(py::getattr(law, "observer", py::bool_(false)))),
        raised_(std::move(raised)) {
    lies_at(&nothing_, &nothing_, &timing_);
  }

  double step(const Port& port) noexcept override {
    if (*raised_) return std::numeric_limits<double>::quiet_NaN();
    try {
      return force_of(law_.attr("step")(port));
    } catch (...) {
      *raised_ = std::current_exception();
      return std::numeric_limits<double>::quiet_NaN();
    }
  }
  void reset() noexcept override {
    try {
      law_.attr("reset")();
    } catch (...) {
      *raised_ = std::current_exception();
    }
  }
  void retune(const LawObject&) noexcept override {}
  double starved() const EBAC_RT override { return 0; }
  bool observed() const EBAC_RT override { return observed_; }
  std::unique_ptr<LawObject> clone() const override {
    return std::make_unique<PythonLaw>(py::module_::import("copy").attr("deepcopy")(law_), raised_);
  }

 private:
  double force_of(const py::object& answer) const {
    try {
      return answer.cast<double>();
    } catch (const py::cast_error&) {
      const py::str text("{}.step returned {!r}: must return the force [N] of one axis, a number");
      throw py::type_error(std::string(text.format(py::type::of(law_).attr("__name__"), answer)));
    }
  }
  static const LawType& record() {
    static const LawType kType{.name = "python",
                               .summary = "a law written in Python",
                               .params = field_table<Nothing>(),
                               .state = field_table<Nothing>()};
    return kType;
  }

  py::object law_;
  bool observed_;
  std::shared_ptr<std::exception_ptr> raised_;
  Nothing nothing_{};
  Timing timing_{};
};

/// `run(law)`, then what the law raised.
template <class Run>
std::shared_ptr<Trace> run_python(const py::object& law, Run run) {
  const auto raised = std::make_shared<std::exception_ptr>();
  const AnyLaw wrapped(std::make_unique<PythonLaw>(law, raised));
  const std::shared_ptr<Trace> trace = run(wrapped);
  if (*raised) std::rethrow_exception(*raised);
  return trace;
}

}  // namespace

void bind_python_law(py::module_& m) {
  m.def(
      "_simulate_python",
      [](const Setup& setup, const py::object& law, bool through_can,
         const std::optional<can::TimedBus>& bus) {
        return run_python(
            law, [&](const AnyLaw& any) { return simulate_either(setup, any, through_can, bus); });
      },
      py::arg("setup"), py::arg("law"), py::arg("through_can") = false,
      py::arg("bus") = py::none());
  m.def(
      "_replay_python",
      [](const std::shared_ptr<ReplayLog>& log, const py::object& law, const DeviceModel& device,
         const Environment& environment) {
        return run_python(
            law, [&](const AnyLaw& any) { return replay_on(log, any, device, environment); });
      },
      py::arg("log"), py::arg("law"), py::arg("device"), py::arg("environment"));
}

}  // namespace ebac::python
