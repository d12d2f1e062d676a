#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <string>
#include <string_view>

#include "bind.hpp"
#include "ebac/teleop/packet.hpp"
#include "ebac/teleop/simulate.hpp"
#include "others_run.hpp"
#include "sweep.hpp"

namespace ebac::python {

void bind_teleop_udp(py::module_& m);  // teleop_udp.cpp
void bind_remote(py::module_& m);      // remote.cpp

namespace {

using teleop::Coupling;
using teleop::Link;
using teleop::Packet;
using teleop::SlaveModel;
using teleop::Teleop;

Values simulated(const AnyLaw& law, const Setup& setup, const Coupling& coupling,
                 const SlaveModel& slave, const Link& there, const Link& back,
                 double consent_after) {
  teleop::Outcome outcome;
  {
    const OthersRun release;
    outcome = teleop::simulate({setup, coupling, slave, there, back, consent_after}, law);
  }
  Values columns;
  add_columns<teleop::Row>(columns, outcome.rows,
                           [](const teleop::Row& row) -> const teleop::Row& { return row; });
  columns["whole"] = outcome.whole;
  columns["at_master"] = values_of(outcome.at_master);
  columns["at_slave"] = values_of(outcome.at_slave);
  return columns;
}

py::bytes encoded(const Packet& packet) {
  const Packet::Wire wire = teleop::encode(packet);
  return {reinterpret_cast<const char*>(wire.data()), wire.size()};
}

std::optional<Packet> decoded(const py::bytes& datagram) {
  const std::string_view bytes = datagram;
  return teleop::decode({reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()});
}

void bind_packet(py::module_& m) {
  py::class_<Packet>(m, "TeleopPacket",
                     "A datagram between master and slave; see `ebac.teleop` for the layout.")
      .def(
          py::init([](bool from_slave, bool lost, std::uint32_t session, std::uint32_t sequence,
                      std::uint32_t echo, std::int64_t stamp, double value, double energy,
                      double wave, std::uint32_t run, std::uint32_t fault, bool leaving, int scheme,
                      const std::array<double, 3>& more, const std::array<double, 4>& at) {
            constexpr int kLast = static_cast<int>(teleop::Scheme::kWaves);
            if (scheme < 0 || scheme > kLast) {
              throw py::value_error("TeleopPacket: scheme = " + std::to_string(scheme) +
                                    ": must lie in [0, " + std::to_string(kLast) + "]");
            }
            return Packet{from_slave,
                          lost,
                          session,
                          sequence,
                          echo,
                          stamp,
                          value,
                          energy,
                          wave,
                          run,
                          fault,
                          leaving,
                          static_cast<std::uint8_t>(scheme),
                          more,
                          at};
          }),
          py::kw_only(), py::arg("from_slave") = false, py::arg("lost") = false,
          py::arg("session") = 1, py::arg("sequence") = 0, py::arg("echo") = 0,
          py::arg("stamp") = 0, py::arg("value") = 0.0, py::arg("energy") = 0.0,
          py::arg("wave") = 0.0, py::arg("run") = 0, py::arg("fault") = 0,
          py::arg("leaving") = false, py::arg("scheme") = 0,
          py::arg("more") = std::array<double, 3>{}, py::arg("at") = std::array<double, 4>{})
      .def_readonly("from_slave", &Packet::from_slave, "Whether the slave sent it.")
      .def_readonly("lost", &Packet::lost, "Whether its sender has lost the link.")
      .def_readonly("session", &Packet::session, "The hand's consents so far.")
      .def_readonly("sequence", &Packet::sequence, "Number within the session, from 1.")
      .def_readonly("echo", &Packet::echo, "Newest number its sender has received.")
      .def_readonly("stamp", &Packet::stamp, "The sender's clock [ns].")
      .def_readonly("value", &Packet::value, "Position of the master [m], or force [N].")
      .def_readonly("energy", &Packet::energy, "Energy into the network [J].")
      .def_readonly("wave", &Packet::wave, "Integral of the wave variable [sqrt(W) s].")
      .def_readonly("run", &Packet::run, "Number of the master's run.")
      .def_readonly("fault", &Packet::fault,
                    "Fault that has stopped the sender's drives; 0 for none.")
      .def_readonly("leaving", &Packet::leaving, "Whether its sender ends.")
      .def_readonly("scheme", &Packet::scheme, "`Coupling.scheme` of its sender.")
      .def_readonly("more", &Packet::more,
                    "Rotation, bend to the right and down [rad], or their load [N m].")
      .def_readonly("at", &Packet::at, "From the slave: where its four axes are [m, rad].")
      .def("encode", &encoded, "Return its 116 bytes.")
      .def_static(
          "decode", &decoded, py::arg("datagram"),
          "Return the packet, or None for a datagram that is damaged or not of this version.")
      .def("__eq__", [](const Packet& a, const Packet& b) { return a == b; });
}

}  // namespace

void bind_teleop(py::module_& m) {
  bind_fields<Link>(m, "Link", "One direction of a network, simulated.");
  bind_fields<Coupling>(m, "Coupling", "How master and slave are coupled; the same on both sides.");
  bind_fields<SlaveModel>(m, "SlaveModel", "The slave's one axis, and the spring it meets.");
  bind_packet(m);
  bind_teleop_udp(m);
  bind_remote(m);
  m.def("_simulate_teleop", &simulated, py::arg("law"), py::arg("setup"), py::kw_only(),
        py::arg("coupling"), py::arg("slave"), py::arg("there"), py::arg("back"),
        py::arg("consent_after"));
  m.def("_teleop_fields", [] {
    py::dict units;
    for (const FieldRow& field : field_table<teleop::Row>().rows) {
      units[py::str(std::string(field.name))] =
          py::make_tuple(std::string(field.unit), std::string(field.meaning));
    }
    return units;
  });
}

}  // namespace ebac::python
