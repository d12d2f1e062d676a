#pragma once

#include <pybind11/pybind11.h>

#include <exception>
#include <memory>

#include "ebac/model/hand.hpp"

/// Hands written in Python: any object with `force(t, x, v)`.
namespace ebac::python {

namespace py = pybind11;

/// Calls the object, slowly, with the GIL held only while it runs. What it raises becomes NaN, which
/// ends the run with a fault, and stays in `raised`.
class PythonHand final : public HandForce {
 public:
  using Raised = std::shared_ptr<std::exception_ptr>;

  PythonHand(py::object object, Raised raised);
  ~PythonHand() override;
  PythonHand(const PythonHand&) = delete;
  PythonHand& operator=(const PythonHand&) = delete;

  double force(const HandMotion& at, const HandState& state) const EBAC_RT override;
  void advance(const HandMotion& at) EBAC_RT override;
  /// A deep copy of the object, so that every run begins alike.
  std::unique_ptr<HandForce> clone() const override;
  void start(int axis) override;

  const py::object& object() const { return object_; }
  const Raised& raised() const { return raised_; }

 private:
  py::object object_;
  bool advances_;
  Raised raised_;
};

/// The model that a Python object means: None, a preset, or an object with `force`.
HandModel hand_model(const py::object& given);
py::object model_object(const HandModel& model);

/// The hand of a single run: what it raises is of that run only.
Hand for_one_run(const Hand& hand);
/// What the Python hand of a run raised, if anything.
std::exception_ptr hand_error(const Hand& hand);

}  // namespace ebac::python
