#include "engines.hpp"

#include <pybind11/eigen.h>
#include <pybind11/stl.h>

#include <limits>
#include <memory>
#include <optional>
#include <tuple>
#include <utility>

#include "bind.hpp"
#include "ebac/model/environment.hpp"
#include "ebac/world/engine/bridge.hpp"
#include "engine_numbers.hpp"
#include "fields.hpp"
#include "others_run.hpp"

namespace ebac::python {

namespace {

using namespace ebac::world;

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

/// A Python object that is called with two vectors, from any thread, and never lets an exception out: `ebac.worlds` gives
/// one that keeps it. Each run has a deep copy.
class Called {
 public:
  explicit Called(py::object object) : object_(std::move(object)) {}
  Called(const Called& other) {
    const Held held;
    object_ = py::module_::import("copy").attr("deepcopy")(other.object_);
  }
  Called& operator=(const Called&) = delete;
  ~Called() {
    const Held held;
    object_ = py::object();
  }

  /// False where it failed; what it answers is None or the numbers of `T`.
  template <class T>
  bool ask(const Axes& x, const Axes& v, std::optional<T>& answer) const noexcept {
    const Held held;
    try {
      answer = object_(x, v).template cast<std::optional<T>>();
      return true;
    } catch (...) {
      return false;
    }
  }

 private:
  py::object object_;
};

/// A world that is a Python function; for simulation.
class PythonWorld final : public World {
 public:
  using Numbers = std::tuple<Axes, Axes, double, double, Axes>;

  explicit PythonWorld(const py::object& function) : function_(function) {}

  ContactForce contact(const Axes& x, const Axes& v, double) EBAC_RT override {
    std::optional<Numbers> answer;
    if (!function_.ask(x, v, answer)) return ContactForce::straight(Axes::Constant(kNone));
    if (!answer) return {};
    const auto& [force, normal, depth, stiffness, velocity] = *answer;
    ContactForce made{.force = force,
                      .frame = frame_.along(&normal, 1),
                      .velocity = velocity,
                      .depth = depth,
                      .stiffness = stiffness};
    made.along = made.frame * force;
    made.turned = !made.frame.isIdentity(0);
    return made;
  }
  std::unique_ptr<World> fresh() const override { return std::make_unique<PythonWorld>(*this); }

 private:
  Called function_;
  TransportedFrame frame_;
};

/// An engine that is a Python function; for simulation.
class PythonEngine final : public Engine {
 public:
  explicit PythonEngine(const py::object& function) : function_(function) {}

  LocalModel answer(const Axes& x, const Axes& v, double t) EBAC_RT override {
    std::optional<ModelNumbers> answer;
    if (!function_.ask(x, v, answer)) return {.stiffness = kNone, .t = t};
    return model_of(answer, t);
  }
  std::unique_ptr<Engine> fresh() const override { return std::make_unique<PythonEngine>(*this); }

 private:
  Called function_;
};

/// The engine's end of a channel, in one Python thread at a time.
struct EngineEnd {
  std::shared_ptr<EngineChannel> channel = std::make_shared<EngineChannel>();
  EnginePose last;
};

External scheduled(std::unique_ptr<Engine> engine, const EngineTiming& timing,
                   const BridgeParams& params, bool held) {
  return {make_scheduled(std::move(engine), timing, params, held)};
}

Values numbers_of(const BridgeReport& report) {
  using namespace py::literals;
  return py::dict("models"_a = report.models(), "oldest_s"_a = report.oldest(),
                  "faded_s"_a = report.faded(), "faded_at_s"_a = report.faded_at(),
                  "given_J"_a = report.given(), "moved_J"_a = report.moved());
}

}  // namespace

void bind_engines(py::module_& m) {
  bind_fields<BridgeParams>(m, "BridgeParams", "How models of an engine are rendered.");
  bind_fields<EngineTiming>(m, "EngineTiming", "When an engine is called, and when it answers.");
  m.def(
      "_function_world",
      [](const py::object& function) { return External{std::make_shared<PythonWorld>(function)}; },
      py::arg("function"));
  m.def(
      "_scheduled_function",
      [](const py::object& function, const EngineTiming& timing, const BridgeParams& params,
         bool held) {
        return scheduled(std::make_unique<PythonEngine>(function), timing, params, held);
      },
      py::arg("function"), py::arg("timing"), py::arg("params"), py::arg("held"));
  m.def(
      "_scheduled_world",
      [](const External& world, const EngineTiming& timing, const BridgeParams& params, bool held) {
        const std::unique_ptr<World> bodies = world.world->fresh();
        return scheduled(std::make_unique<SceneEngine>(dynamic_cast<const Scene&>(*bodies)), timing,
                         params, held);
      },
      py::arg("world"), py::arg("timing"), py::arg("params"), py::arg("held"));
  py::class_<EngineEnd>(m, "_EngineEnd")
      .def(py::init<>())
      .def("pose",
           [](EngineEnd& end) -> std::optional<std::tuple<Axes, Axes, double>> {
             const EnginePose* pose = end.channel->take_pose();
             if (pose == nullptr) return std::nullopt;
             end.last = *pose;
             return std::tuple(pose->x, pose->v, pose->t);
           })
      .def(
          "post",
          [](const EngineEnd& end, const std::optional<ModelNumbers>& model) {
            end.channel->post(model_of(model, end.last.t), end.last.x);
          },
          py::arg("model"))
      .def(
          "world",
          [](const EngineEnd& end, const BridgeParams& params) {
            return External{make_posted(end.channel, params)};
          },
          py::arg("params"));
  m.def(
      "_bridge_report",
      [](const External& world) -> std::optional<Values> {
        const auto* bridge = dynamic_cast<const Bridge*>(world.world.get());
        if (bridge == nullptr) return std::nullopt;
        return numbers_of(bridge->report());
      },
      py::arg("world"));
}

}  // namespace ebac::python
