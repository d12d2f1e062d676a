#include "python_hand.hpp"

#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "others_run.hpp"

namespace ebac::python {

PythonHand::PythonHand(py::object object, Raised raised)
    : object_(std::move(object)),
      advances_(py::hasattr(object_, "advance")),
      raised_(std::move(raised)) {}

PythonHand::~PythonHand() {
  const Held held;
  object_ = py::object();
}

double PythonHand::force(const HandMotion& at, const HandState&) const EBAC_RT {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  const Held held;
  if (*raised_) return kNone;
  try {
    const py::object answer = object_.attr("force")(at.t, at.x, at.v);
    const auto wrong = [&](const char* wanted) {
      const py::str text("{}.force returned {!r}: must return the force on the handle [N], a {}");
      return std::string(text.format(py::type::of(object_).attr("__name__"), answer, wanted));
    };
    double force = kNone;
    try {
      force = answer.cast<double>();
    } catch (const py::cast_error&) {
      throw py::type_error(wrong("number"));
    }
    if (!std::isfinite(force)) throw py::value_error(wrong("finite number"));
    return force;
  } catch (...) {
    *raised_ = std::current_exception();
    return kNone;
  }
}

void PythonHand::advance(const HandMotion& at) EBAC_RT {
  if (!advances_) return;
  const Held held;
  if (*raised_) return;
  try {
    object_.attr("advance")(at.t, at.x, at.v);
  } catch (...) {
    *raised_ = std::current_exception();
  }
}

std::unique_ptr<HandForce> PythonHand::clone() const {
  const Held held;
  return std::make_unique<PythonHand>(py::module_::import("copy").attr("deepcopy")(object_),
                                      raised_);
}

void PythonHand::start(int axis) {
  const Held held;
  if (py::hasattr(object_, "start")) object_.attr("start")(axis);
}

namespace {

OwnHand own_hand(const py::object& object) {
  return {std::make_shared<PythonHand>(object, std::make_shared<std::exception_ptr>())};
}

const PythonHand* python_hand(const HandModel& model) {
  const auto* own = std::get_if<OwnHand>(&model);
  return own == nullptr ? nullptr : dynamic_cast<const PythonHand*>(own->force.get());
}

template <class Preset>
bool take(const py::object& given, HandModel& model) {
  if (!py::isinstance<Preset>(given)) return false;
  model = given.cast<Preset>();
  return true;
}

}  // namespace

HandModel hand_model(const py::object& given) {
  HandModel model;
  if (given.is_none() || take<Reflex>(given, model) || take<FingerPad>(given, model) ||
      take<NonlinearGrip>(given, model) || take<LetGo>(given, model)) {
    return model;
  }
  if (py::isinstance<py::type>(given) || !py::hasattr(given, "force")) {
    throw py::type_error("Hand.model = " + py::cast<std::string>(py::repr(given)) +
                         ": must be Reflex, FingerPad, NonlinearGrip, LetGo, an object with "
                         "force(t, x, v), or None");
  }
  return own_hand(given);
}

py::object model_object(const HandModel& model) {
  return std::visit(
      [&](const auto& one) -> py::object {
        using Model = std::decay_t<decltype(one)>;
        if constexpr (std::same_as<Model, std::monostate>) {
          return py::none();
        } else if constexpr (std::same_as<Model, OwnHand>) {
          const PythonHand* hand = python_hand(model);
          return hand == nullptr ? py::object(py::none()) : hand->object();
        } else {
          return py::cast(one);
        }
      },
      model);
}

Hand for_one_run(const Hand& hand) {
  Hand own = hand;
  if (const PythonHand* python = python_hand(hand.model)) own.model = own_hand(python->object());
  return own;
}

std::exception_ptr hand_error(const Hand& hand) {
  const PythonHand* python = python_hand(hand.model);
  return python == nullptr ? nullptr : *python->raised();
}

}  // namespace ebac::python
