#include <pybind11/native_enum.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <optional>
#include <string>

#include "bind.hpp"
#include "ebac/can/bus_benchmark.hpp"
#include "ebac/can/loopback_bus.hpp"
#include "open_socketcan.hpp"
#include "others_run.hpp"

namespace ebac::python {

namespace py = pybind11;
using can::BusCounts;
using can::BusState;
using can::Frame;

namespace {

using Clock = std::chrono::steady_clock;

/// How often a long wait looks whether Python wants something, as after Ctrl-C.
constexpr std::chrono::milliseconds kSlice{50};
/// Longest wait with an end; the sum with the clock's time must not overflow.
constexpr double kLongest = 1e9;  // s

Frame make_frame(std::uint32_t id, const py::bytes& data, bool extended, bool remote, bool error,
                 std::optional<int> size) {
  const std::string_view bytes = data;
  const int length = size.value_or(static_cast<int>(bytes.size()));
  if (bytes.size() > Frame::kMaxSize || length < 0 || length > int{Frame::kMaxSize}) {
    throw std::invalid_argument("CanFrame.size = " + std::to_string(length) + " bytes, with " +
                                std::to_string(bytes.size()) +
                                " given: a classical frame has 0 to 8");
  }
  Frame made{.id = id,
             .size = static_cast<std::uint8_t>(length),
             .extended = extended,
             .remote = remote,
             .error = error};
  if (!remote)
    std::copy_n(bytes.begin(), std::min(bytes.size(), std::size_t{made.size}), made.data.begin());
  if (!can::sendable(made)) {
    throw std::invalid_argument(
        "CanFrame.id = " + std::to_string(id) + ": must lie in [0, " +
        (extended ? "0x1FFFFFFF]" : "0x7FF], or in [0, 0x1FFFFFFF] when extended"));
  }
  return made;
}

py::bytes bytes_of(const Frame& frame) {
  const std::size_t size = frame.remote ? 0 : frame.bytes().size();
  return {reinterpret_cast<const char*>(frame.data.data()), size};
}

void bind_frame(py::module_& m) {
  py::class_<Frame>(m, "CanFrame", "A classical CAN frame.")
      .def(py::init(&make_frame), py::arg("id"), py::arg("data") = py::bytes(), py::kw_only(),
           py::arg("extended") = false, py::arg("remote") = false, py::arg("error") = false,
           py::arg("size") = py::none(), "A frame; a remote frame needs `size`.")
      .def_readonly("id", &Frame::id, "Identifier, 11 bits, or 29 when extended.")
      .def_readonly("size", &Frame::size,
                    "Length of the data [bytes], or of the requested data, 0 to 8.")
      .def_property_readonly("data", &bytes_of, "The data; none in a remote frame.")
      .def_readonly("extended", &Frame::extended, "Whether the identifier has 29 bits.")
      .def_readonly("remote", &Frame::remote,
                    "Whether this is a remote frame, which requests data.")
      .def_readonly("error", &Frame::error, "Whether this is an error frame of the CAN controller.")
      .def_readonly("own", &Frame::own, "Whether the receiving end sent this frame itself.")
      .def_readonly("stamp", &Frame::stamp, "Time of reception [ns since 1970]; 0 if unknown.")
      .def("__repr__", [](const Frame& frame) {
        return py::str("CanFrame(0x{:03X}, {!r})").format(frame.id, bytes_of(frame));
      });
}

void bind_state(py::module_& m) {
  py::native_enum<BusState>(m, "BusState", "enum.IntEnum", "State of a CAN bus.")
      .value("UP", BusState::kUp)
      .value("WARNING", BusState::kWarning)
      .value("PASSIVE", BusState::kPassive)
      .value("BUS_OFF", BusState::kBusOff)
      .value("DOWN", BusState::kDown)
      .value("CLOSED", BusState::kClosed)
      .finalize();
  py::class_<BusCounts>(m, "BusCounts", "Frame counts of one end of a bus since it was opened.")
      .def_readonly("sent", &BusCounts::sent, "Frames sent.")
      .def_readonly("refused", &BusCounts::refused, "Frames refused by `send`.")
      .def_readonly("received", &BusCounts::received, "Frames received.")
      .def_readonly("lost", &BusCounts::lost, "Frames lost because the receive queue was full.");
}

/// Waits without the interpreter's lock; None when the time is over or the end is closed.
template <can::Bus End>
std::optional<Frame> receive(End& end, std::optional<double> timeout) {
  if (timeout && std::isnan(*timeout)) {
    throw std::invalid_argument("timeout = nan s: must be a number of seconds, or None for no end");
  }
  const Clock::time_point start = Clock::now();
  const auto most = std::chrono::duration<double>(std::clamp(timeout.value_or(0.0), 0.0, kLongest));
  const auto until = start + std::chrono::duration_cast<Clock::duration>(most);
  Frame in;
  while (!end.receive(in)) {
    std::chrono::nanoseconds left = kSlice;
    if (timeout) left = std::min<std::chrono::nanoseconds>(left, until - Clock::now());
    if (left.count() <= 0 || end.state() == BusState::kClosed) return std::nullopt;
    {
      const OthersRun others_run;
      if (end.receive(in, left)) return in;
    }
    if (PyErr_CheckSignals() != 0) throw py::error_already_set();
  }
  return in;
}

/// What both kinds of ends have.
template <can::Bus End, class Class>
void add_end(Class& cls) {
  cls.def("send", &End::send, py::arg("frame"), "Send a frame; return False if the bus refuses it.")
      .def("receive", &receive<End>, py::arg("timeout") = 0.0,
           "Return a frame, waiting up to `timeout` [s], None for ever; None without one or if "
           "closed.")
      .def_property_readonly("state", &End::state, "State of the bus.")
      .def_property_readonly("counts", &End::counts, "Frame counts of this end.")
      .def("close", &End::close, "Leave the bus; a thread waiting in `receive` returns.");
}

void bind_loopback(py::module_& m) {
  using can::LoopbackBus;
  using can::LoopbackHub;
  py::class_<LoopbackBus> end(m, "LoopbackBus", "One end of a CAN bus inside this process.");
  add_end<LoopbackBus>(end);
  py::class_<LoopbackHub>(m, "LoopbackHub", "A CAN bus inside this process.")
      .def(py::init([](bool stamps) {
             using Stamps = LoopbackHub::Stamps;
             return LoopbackHub(stamps ? Stamps::kWallClock : Stamps::kNone);
           }),
           py::kw_only(), py::arg("stamps") = true)
      .def(
          "open",
          [](LoopbackHub& hub, std::size_t frames, bool own) {
            return hub.open({.frames = frames, .own = own});
          },
          py::kw_only(), py::arg("frames") = can::LoopbackOptions{}.frames, py::arg("own") = false,
          "Open a new end with a receive queue of `frames`; frames beyond it are lost and counted.")
      .def_property_readonly("ends", &LoopbackHub::ends, "Number of open ends.");
}

void bind_socketcan(py::module_& m) {
  using can::SocketCan;
  using Filter = std::tuple<std::uint32_t, std::uint32_t, bool>;
  py::class_<SocketCan> end(m, "SocketCan", "One end of a CAN interface of the Linux kernel.");
  end.def(py::init([](const std::string& interface, const std::vector<Filter>& filters, bool own,
                      bool errors) {
            can::SocketCanOptions options{.own = own, .errors = errors};
            for (const auto& [id, mask, extended] : filters) {
              options.filters.push_back({.id = id, .mask = mask, .extended = extended});
            }
            return open_socketcan(interface, options);
          }),
          py::arg("interface"), py::kw_only(), py::arg("filters") = std::vector<Filter>{},
          py::arg("own") = false, py::arg("errors") = false,
          "Open an interface; `filters` are (id, mask, extended). An OSError contains the remedy.");
  add_end<SocketCan>(end);
}

}  // namespace

void bind_can(py::module_& m) {
  bind_frame(m);
  bind_state(m);
  bind_loopback(m);
  bind_socketcan(m);
  m.def("_time_bus", &can::time_one_thread, py::arg("frames"), py::arg("repeats"),
        py::call_guard<OthersRun>());
  m.def("_time_bus_threads", &can::time_two_threads, py::arg("frames"), py::arg("repeats"),
        py::call_guard<OthersRun>());
}

}  // namespace ebac::python
