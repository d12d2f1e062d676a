#include <pybind11/stl.h>

#include <memory>
#include <string>

#include "bind.hpp"
#include "ebac/teleop/udp_sides.hpp"
#include "endpoint.hpp"
#include "fields.hpp"
#include "from_system.hpp"
#include "others_run.hpp"

namespace ebac::python {

namespace {

using teleop::Report;
using teleop::UdpMaster;
using teleop::UdpNetwork;
using teleop::UdpSlave;

template <class Side>
void add_run(py::class_<Side>& cls) {
  cls.def(
         "run",
         [](Side& side, double seconds) {
           Report report;
           {
             const OthersRun release;
             report = side.run(seconds);
           }
           Values values = values_of(report);
           values["arrivals"] = values_of(report.arrivals);
           return values;
         },
         py::arg("seconds"), "Run for a time [s]; return what it has met since it was made.")
      .def_static("units", &units_of<Report>, "Units of what `run` returns, by name.")
      .def_property_readonly(
          "port", [](const Side& side) { return static_cast<int>(side.local().port); },
          "The UDP port it is bound to.");
}

}  // namespace

void bind_teleop_udp(py::module_& m) {
  py::class_<UdpMaster> master(m, "_UdpMaster");
  master
      .def(py::init([](const Setup& setup, const AnyLaw& law, const teleop::Coupling& coupling,
                       const std::string& host, int port, const std::string& peer, int peer_port,
                       double consent_after) {
             return from_system([&] {
               return std::make_unique<UdpMaster>(
                   setup, law, coupling, endpoint("master", host, port),
                   endpoint("peer of the master", peer, peer_port), consent_after);
             });
           }),
           py::kw_only(), py::arg("setup"), py::arg("law"), py::arg("coupling"), py::arg("host"),
           py::arg("port"), py::arg("peer"), py::arg("peer_port"), py::arg("consent_after"))
      .def("consent", &UdpMaster::consent, "Agree to go on; False where the link is not back.");
  add_run(master);
  py::class_<UdpSlave> slave(m, "_UdpSlave");
  slave.def(py::init([](const teleop::SlaveModel& model, const teleop::Coupling& coupling,
                        const std::string& host, int port) {
              return from_system([&] {
                return std::make_unique<UdpSlave>(model, coupling, endpoint("slave", host, port));
              });
            }),
            py::kw_only(), py::arg("model"), py::arg("coupling"), py::arg("host"), py::arg("port"));
  add_run(slave);
  py::class_<UdpNetwork> network(m, "_UdpNetwork");
  network
      .def(py::init([](const teleop::Link& there, const teleop::Link& back, std::uint64_t seed,
                       const std::string& host, int port, const std::string& slave_host,
                       int slave_port) {
             return from_system([&] {
               return std::make_unique<UdpNetwork>(there, back, seed,
                                                   endpoint("network", host, port),
                                                   endpoint("slave", slave_host, slave_port));
             });
           }),
           py::kw_only(), py::arg("there"), py::arg("back"), py::arg("seed"), py::arg("host"),
           py::arg("port"), py::arg("slave"), py::arg("slave_port"))
      .def("cut", &UdpNetwork::cut, py::arg("on"), "Cut both ways, or mend them.");
  add_run(network);
}

}  // namespace ebac::python
