#include "engine_process.hpp"

#include <pybind11/eigen.h>
#include <pybind11/stl.h>

#include <memory>
#include <optional>
#include <string>
#include <tuple>

#include "bind.hpp"
#include "ebac/model/environment.hpp"
#include "ebac/world/engine/bridge.hpp"
#include "ebac/world/engine/engine_client.hpp"
#include "engine_numbers.hpp"
#include "from_system.hpp"

namespace ebac::python {

namespace {

using namespace ebac::world;

using PoseNumbers = std::tuple<Axes, Axes, double>;

std::optional<PoseNumbers> pose_numbers(const EnginePose* pose) {
  if (pose == nullptr) return std::nullopt;
  return PoseNumbers(pose->x, pose->v, pose->t);
}

}  // namespace

void bind_engine_process(py::module_& m) {
  py::class_<SharedEngineChannel>(m, "_SharedEngineChannel")
      .def(py::init([](const std::string& name) {
             return from_system([&] { return std::make_unique<SharedEngineChannel>(name); });
           }),
           py::arg("name"))
      .def_property_readonly("name", &SharedEngineChannel::name)
      .def_property_readonly("engine", &SharedEngineChannel::engine)
      .def_property_readonly("engine_lives", &SharedEngineChannel::engine_lives)
      .def_property_readonly("posted", &SharedEngineChannel::posted)
      .def(
          "world",
          [](const SharedEngineChannel& channel, const BridgeParams& params) {
            return External{make_posted(channel.channel(), params)};
          },
          py::arg("params"))
      .def("end", &SharedEngineChannel::end);
  py::class_<EngineClient>(m, "_EngineClient")
      .def(py::init([](const std::string& name) {
             return from_system([&] { return std::make_unique<EngineClient>(name); });
           }),
           py::arg("name"))
      .def("pose", [](EngineClient& client) { return pose_numbers(client.take_pose()); })
      .def(
          "post",
          [](EngineClient& client, const std::optional<ModelNumbers>& model) {
            client.post(model_of(model, 0));
          },
          py::arg("model"))
      .def_property_readonly("loop_runs", &EngineClient::loop_runs);
}

}  // namespace ebac::python
