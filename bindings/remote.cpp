#include <pybind11/stl.h>

#include <memory>
#include <optional>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "bind.hpp"
#include "ebac/core/sample.hpp"
#include "ebac/model/environment.hpp"
#include "ebac/remote/master_world.hpp"
#include "ebac/remote/slave_worlds.hpp"
#include "endpoint.hpp"
#include "fields.hpp"
#include "from_system.hpp"

namespace ebac::python {

namespace {

using namespace remote;
using gastroscope::DrivenScope;
using LinkPtr = std::shared_ptr<LinkEnd>;
using Lumens = std::shared_ptr<gastroscope::Lumen>;
using EventRow = std::tuple<double, int, double>;

LinkPtr link_of(LinkEnd::Role role, const LinkParams& params, double dt, const std::string& host,
                int port, const std::optional<std::pair<std::string, int>>& peer) {
  return from_system([&] {
    std::optional<sensor::Endpoint> to;
    if (peer) to = endpoint("the other side", peer->first, peer->second);
    return std::make_shared<LinkEnd>(role, params, dt, endpoint("the link", host, port), to);
  });
}

Values report_of(LinkEnd& link) {
  const LinkReport report = link.look();
  Values values = values_of(report);
  values["arrivals"] = values_of(report.arrivals);
  const std::pair<const char*, const Four&> four[] = {
      {"asked", report.asked},           {"at", report.at},     {"error", report.error},
      {"most_error", report.most_error}, {"load", report.load}, {"most_load", report.most_load}};
  for (const auto& [name, value] : four) values[name] = py::cast(value);
  return values;
}

std::vector<EventRow> events_of(const LinkEnd& link, std::size_t start) {
  std::vector<EventRow> rows;
  for (std::size_t i = start; i < link.events(); ++i) {
    const Event event = link.event(i);
    rows.emplace_back(event.t, static_cast<int>(event.what), event.value);
  }
  return rows;
}

void bind_link(py::module_& m) {
  py::class_<LinkEnd, LinkPtr>(m, "_LinkEnd")
      .def("consent", &LinkEnd::consent)
      .def(
          "fail", [](LinkEnd& link, Fault fault) { link.fail(static_cast<std::uint32_t>(fault)); },
          py::arg("fault"))
      .def("leave", &LinkEnd::leave)
      .def("report", &report_of)
      .def_static("units", &units_of<LinkReport>)
      .def("events", &events_of, py::arg("start") = 0)
      .def_property_readonly(
          "port", [](const LinkEnd& link) { return static_cast<int>(link.local().port); });
}

}  // namespace

void bind_remote(py::module_& m) {
  bind_fields<LinkParams>(m, "FarLink", "When a link between loops on drives counts as lost.");
  bind_fields<FollowParams>(m, "Follow", "How the drives of a slave follow what its master asks.");
  bind_fields<gastroscope::Gears>(m, "Gears", "What the cables at the slave's drives move.");
  bind_link(m);
  m.def(
      "_master_link",
      [](const LinkParams& params, double dt, const std::string& host, int port,
         const std::pair<std::string, int>& peer) {
        return link_of(LinkEnd::Role::kMaster, params, dt, host, port, peer);
      },
      py::kw_only(), py::arg("params"), py::arg("dt"), py::arg("host"), py::arg("port"),
      py::arg("peer"));
  m.def(
      "_slave_link",
      [](const LinkParams& params, double dt, const std::string& host, int port) {
        return link_of(LinkEnd::Role::kSlave, params, dt, host, port, {});
      },
      py::kw_only(), py::arg("params"), py::arg("dt"), py::arg("host"), py::arg("port"));
  m.def(
      "_master_world",
      [](const LinkPtr& link, const gastroscope::MasterParams& params) {
        return External{std::make_shared<MasterWorld>(link, params)};
      },
      py::arg("link"), py::arg("params"));
  m.def(
      "_slave_worlds",
      [](const LinkPtr& link, const FollowParams& params, const gastroscope::Gears& gears) {
        const auto slave = std::make_shared<SlaveLink>(link, params, gears);
        return std::pair(External{SlaveLink::world(slave, 0)},
                         External{SlaveLink::world(slave, 1)});
      },
      py::arg("link"), py::arg("params"), py::arg("gears"));
  py::class_<DrivenScope, std::shared_ptr<DrivenScope>>(m, "_DrivenScope")
      .def(py::init([](const gastroscope::ScopeParams& scope, const Lumens& lumen, double start,
                       const gastroscope::Gears& gears) {
             return std::make_shared<DrivenScope>(scope, lumen, start, gears);
           }),
           py::arg("scope"), py::arg("lumen"), py::arg("start"), py::arg("gears"))
      .def("load", &DrivenScope::load, py::arg("group"))
      .def("report", [](const DrivenScope& scope) { return values_of(scope.report()); });
  m.def(
      "_targets",
      [](const FollowParams& params, const std::vector<Four>& asked, double dt) {
        Targets targets(params);
        targets.begin();
        std::vector<Four> at;
        at.reserve(asked.size());
        for (const Four& one : asked) {
          targets.follow(one, dt);
          at.push_back(targets.at());
        }
        return at;
      },
      py::arg("params"), py::arg("asked"), py::arg("dt"),
      "Return where a slave's targets go, tick by tick.");
}

}  // namespace ebac::python
