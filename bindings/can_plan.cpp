#include <pybind11/stl.h>

#include "bind.hpp"
#include "ebac/canopen/pdo_plan.hpp"
#include "ebac/simulated_drives/exchange_benchmark.hpp"
#include "others_run.hpp"

namespace ebac::python {

namespace py = pybind11;

void bind_can_plan(py::module_& m) {
  using can::BusLoad;
  using can::PlannedFrame;
  py::class_<PlannedFrame>(m, "PlannedFrame", "One kind of frame that is sent in every period.")
      .def(py::init([](std::string what, std::uint32_t id, int size, int count) {
             return PlannedFrame{std::move(what), id, size, count};
           }),
           py::kw_only(), py::arg("what"), py::arg("id"), py::arg("size"), py::arg("count") = 1)
      .def_readonly("what", &PlannedFrame::what, "Sender and content.")
      .def_readonly("id", &PlannedFrame::id, "COB-ID.")
      .def_readonly("size", &PlannedFrame::size, "Bytes of data.")
      .def_readonly("count", &PlannedFrame::count, "Frames per period.");
  py::class_<BusLoad>(m, "BusLoad", "Worst-case load of a bus by frames sent in every period.")
      .def(py::init([](std::vector<PlannedFrame> frames, double bit_rate, double period) {
             return BusLoad{std::move(frames), bit_rate, period};
           }),
           py::kw_only(), py::arg("frames"), py::arg("bit_rate") = 1e6, py::arg("period") = 1e-3)
      .def_readonly("frames", &BusLoad::frames, "The frames.")
      .def_readonly("bit_rate", &BusLoad::bit_rate, "Bit rate of the bus [bit/s].")
      .def_readonly("period", &BusLoad::period, "Time between two SYNC frames [s].")
      .def("bits", py::overload_cast<const PlannedFrame&>(&BusLoad::bits, py::const_),
           py::arg("frame"),
           "Return the bits of one kind of frame per period, stuff bits included.")
      .def("frame_share", py::overload_cast<const PlannedFrame&>(&BusLoad::share, py::const_),
           py::arg("frame"), "Return the share of the bus used by one kind of frame, 0 to 1.")
      .def_property_readonly(
          "seconds", [](const BusLoad& load) { return load.seconds(); },
          "Time used by all frames in every period [s].")
      .def_property_readonly(
          "share", [](const BusLoad& load) { return load.share(); },
          "Share of the bus used by all frames, 0 to 1.")
      .def_property_readonly("highest_rate", &BusLoad::highest_rate,
                             "Highest rate at which the same frames fit on the bus [Hz].")
      .def("check", &can::check_load,
           "Return a warning over 70 % of the bus, else an empty text.\n\n"
           "Raises\n------\nValueError\n    Over 90 %, or for numbers no CAN bus has; with the "
           "remedy.");
  m.def("worst_bits", &can::worst_bits, py::arg("size"));
  m.attr("WARNED_LOAD") = can::kWarnedLoad;
  m.attr("REFUSED_LOAD") = can::kRefusedLoad;
  m.def(
      "pdo_plan", [](const std::vector<int>& nodes) { return can::pdo_plan(nodes); },
      py::arg("nodes"),
      "SYNC, and for every node an RPDO (controlword, target torque) and a TPDO (statusword,\n"
      "position, actual torque): the frames of one tick (CiA 301, CiA 402).");
  const py::call_guard<OthersRun> others_run;
  m.def("_time_exchange", &can::time_exchange, py::arg("ticks"), py::arg("repeats"), others_run);
  m.def("_time_own_exchange", &can::time_own_exchange, py::arg("ticks"), py::arg("repeats"),
        others_run);
}

}  // namespace ebac::python
