#include <pybind11/stl.h>

#include <algorithm>
#include <optional>
#include <tuple>

#include "bind.hpp"
#include "ebac/can/frame_length.hpp"
#include "ebac/canopen/loop_watch.hpp"
#include "ebac/canopen/pdo_plan.hpp"
#include "ebac/simulated_drives/exchange_benchmark.hpp"
#include "ebac/simulated_drives/simulated_wire.hpp"
#include "ebac/simulated_drives/through_can.hpp"
#include "fields.hpp"
#include "others_run.hpp"

namespace ebac::python {

namespace py = pybind11;

namespace {

using can::SimulatedWire;

can::Frame frame_of(std::uint32_t id, const std::string& data, bool remote, int size) {
  can::Frame frame{.id = id, .size = static_cast<std::uint8_t>(size), .remote = remote};
  std::copy_n(data.begin(), std::min(data.size(), frame.data.size()), frame.data.begin());
  return frame;
}

/// `station`, where the wire has it.
std::size_t known(const SimulatedWire& wire, std::size_t station) {
  if (station < wire.stations()) return station;
  throw py::index_error("station = " + std::to_string(station) + ": must lie in [0, " +
                        std::to_string(wire.stations() - 1) + "]");
}

/// The wire, for `drives.bus_timing`: times in nanoseconds.
void bind_wire(py::module_& m) {
  m.def(
      "_exact_bits",
      [](std::uint32_t id, const py::bytes& data, bool remote, int size) {
        return can::exact_bits(frame_of(id, data, remote, size));
      },
      py::arg("id"), py::arg("data"), py::arg("remote"), py::arg("size"));
  py::class_<SimulatedWire>(
      m, "SimulatedWire",
      "The wire of a CAN bus in virtual time [ns]: stations, their frames, and when they arrive.")
      .def(py::init([](std::size_t stations, double bit_rate, double error_rate, bool recovers,
                       std::uint64_t seed) {
             return SimulatedWire({.stations = stations,
                                   .bit_rate = bit_rate,
                                   .error_rate = error_rate,
                                   .recovers = recovers,
                                   .seed = seed});
           }),
           py::kw_only(), py::arg("stations"), py::arg("bit_rate"), py::arg("error_rate") = 0.0,
           py::arg("recovers") = false, py::arg("seed") = 0)
      .def(
          "send",
          [](SimulatedWire& wire, std::size_t station, std::uint32_t id, const py::bytes& data,
             std::int64_t due) {
            const std::string bytes = data;
            if (bytes.size() > can::Frame::kMaxSize) return false;
            return wire.send(known(wire, station),
                             frame_of(id, bytes, false, static_cast<int>(bytes.size())), due);
          },
          py::arg("station"), py::arg("id"), py::arg("data"), py::arg("due"),
          "Queue a frame that may go from `due` [ns] on; False where the station is off, or full.")
      .def(
          "next",
          [](SimulatedWire& wire,
             std::int64_t until) -> std::optional<std::tuple<std::size_t, int, std::int64_t>> {
            SimulatedWire::Delivery came;
            if (!wire.next(until, came)) return std::nullopt;
            return std::tuple(came.from, static_cast<int>(came.frame.id), came.frame.stamp);
          },
          py::arg("until"),
          "Return station, identifier and time of the next frame that arrives by `until` [ns].")
      .def(
          "break_station",
          [](SimulatedWire& wire, std::size_t station) {
            wire.set_error_rate(known(wire, station), 1);
          },
          py::arg("station"), "Destroy every frame of a station from now on.")
      .def(
          "off",
          [](const SimulatedWire& wire, std::size_t station) {
            return wire.off(known(wire, station));
          },
          py::arg("station"), "Return whether a station is off the bus.")
      .def(
          "was_passive",
          [](const SimulatedWire& wire, std::size_t station) {
            return wire.was_passive(known(wire, station));
          },
          py::arg("station"), "Return whether a station has ever been error passive.")
      .def_property_readonly("destroyed", &SimulatedWire::destroyed, "Frames destroyed so far.")
      .def_property_readonly("busy", &SimulatedWire::busy, "Time in use so far [ns].");
}

can::BusLoad load_on_bus(int axes, double dt, const std::optional<can::TimedBus>& bus) {
  return can::load_on_bus(axes, Timing{.dt = dt}, bus);
}

void check_watch(const std::string& name, double seconds, std::int64_t ms, const std::string& what,
                 double period, double dt) {
  can::check_watch({.name = name, .seconds = seconds, .ms = ms, .what = what, .period = period},
                   dt);
}

}  // namespace

void bind_can_plan(py::module_& m) {
  using can::BusLoad;
  using can::PlannedFrame;
  py::class_<PlannedFrame>(
      m, "PlannedFrame",
      "One kind of frame that is sent in every period, or after a time of its own.")
      .def(py::init([](std::string what, std::uint32_t id, int size, int count, double every) {
             return PlannedFrame{std::move(what), id, size, count, every};
           }),
           py::kw_only(), py::arg("what"), py::arg("id"), py::arg("size"), py::arg("count") = 1,
           py::arg("every") = 0.0)
      .def_readonly("what", &PlannedFrame::what, "Sender and content.")
      .def_readonly("id", &PlannedFrame::id, "COB-ID.")
      .def_readonly("size", &PlannedFrame::size, "Bytes of data.")
      .def_readonly("count", &PlannedFrame::count, "Frames per period, or at a time.")
      .def_readonly("every", &PlannedFrame::every,
                    "Time from one to the next [s]; 0 for frames of every period.");
  py::class_<BusLoad>(m, "BusLoad",
                      "Worst-case load of a bus by frames that are sent again and again.")
      .def(py::init([](std::vector<PlannedFrame> frames, double bit_rate, double period) {
             return BusLoad{std::move(frames), bit_rate, period};
           }),
           py::kw_only(), py::arg("frames"), py::arg("bit_rate") = 1e6, py::arg("period") = 1e-3)
      .def_readonly("frames", &BusLoad::frames, "The frames.")
      .def_readonly("bit_rate", &BusLoad::bit_rate, "Bit rate of the bus [bit/s].")
      .def_readonly("period", &BusLoad::period, "Time between two SYNC frames [s].")
      .def("bits", py::overload_cast<const PlannedFrame&>(&BusLoad::bits, py::const_),
           py::arg("frame"),
           "Return the bits of one kind of frame in a period in which it comes, stuff bits "
           "included.")
      .def("frame_share", py::overload_cast<const PlannedFrame&>(&BusLoad::share, py::const_),
           py::arg("frame"), "Return the share of the bus used by one kind of frame, 0 to 1.")
      .def_property_readonly(
          "seconds", [](const BusLoad& load) { return load.seconds(); },
          "Time used by all frames in a period in which all of them come [s].")
      .def_property_readonly(
          "share", [](const BusLoad& load) { return load.share(); },
          "Share of the bus used by all frames on average, 0 to 1.")
      .def_property_readonly("highest_rate", &BusLoad::highest_rate,
                             "Highest rate at which the same frames fit on the bus [Hz].")
      .def("check", &can::check_load,
           "Return a warning over 70 % of the bus, else an empty text.\n\n"
           "Raises\n------\nValueError\n    Over 90 %, or for numbers no CAN bus has; with the "
           "remedy.");
  bind_fields<can::TimedBus>(m, "TimedBus",
                             "A CAN bus that takes time in a simulated run, its drives and the "
                             "watches on both sides.");
  bind_wire(m);
  m.def("worst_bits", &can::worst_bits, py::arg("size"));
  m.def("least_bits", &can::least_bits, py::arg("size"));
  m.attr("WARNED_LOAD") = can::kWarnedLoad;
  m.attr("REFUSED_LOAD") = can::kRefusedLoad;
  m.def(
      "pdo_plan", [](const std::vector<int>& nodes) { return can::pdo_plan(nodes); },
      py::arg("nodes"),
      "SYNC, and for every node an RPDO (controlword, target torque) and a TPDO (statusword,\n"
      "position, actual torque): the frames of one tick (CiA 301, CiA 402).");
  m.def("_load_on_bus", &load_on_bus, py::arg("axes"), py::arg("dt"), py::arg("bus"));
  m.def("_beat_period", &can::beat_period, py::arg("silence"));
  m.def("_check_watch", &check_watch, py::arg("name"), py::arg("seconds"), py::arg("ms"),
        py::arg("what"), py::arg("period"), py::arg("dt"));
  const py::call_guard<OthersRun> others_run;
  m.def("_time_exchange", &can::time_exchange, py::arg("ticks"), py::arg("repeats"), others_run);
  m.def("_time_own_exchange", &can::time_own_exchange, py::arg("ticks"), py::arg("repeats"),
        others_run);
}

}  // namespace ebac::python
