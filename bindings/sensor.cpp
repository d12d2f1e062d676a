#include "sensor.hpp"

#include <pybind11/native_enum.h>
#include <pybind11/stl.h>

#include <chrono>
#include <cmath>
#include <tuple>

#include "bind.hpp"
#include "ebac/sensor/rdt_client.hpp"
#include "others_run.hpp"

namespace ebac::python {

namespace {

using sensor::FtScale;
using sensor::LinkState;
using sensor::RdtClientSetup;
using sensor::RdtRecord;
using sensor::SensorModel;
using Steady = std::chrono::steady_clock;

/// How often a long wait looks whether Python wants something, as after Ctrl-C.
constexpr std::chrono::milliseconds kSlice{50};

/// A client with a clock.
struct TimedClient {
  sensor::RdtClient client;
  Steady::time_point last = Steady::now();

  explicit TimedClient(const RdtClientSetup& setup) : client(setup) {}
  bool poll() {
    const auto now = Steady::now();
    const std::chrono::duration<double> elapsed = now - std::exchange(last, now);
    return client.poll(elapsed.count());
  }
};

void bind_sensor_enums(py::module_& m) {
  py::native_enum<SensorModel>(m, "SensorModel", "enum.IntEnum",
                               "Sensor model, which defines the status bits.")
      .value("NET_FT", SensorModel::kNetFt)
      .value("AXIA", SensorModel::kAxia)
      .value("OTHER", SensorModel::kOther)
      .finalize();
  py::native_enum<SensorStatus>(m, "SensorStatus", "enum.IntEnum",
                                "Status reported by the force sensor.")
      .value("GOOD", SensorStatus::kGood)
      .value("SATURATED", SensorStatus::kSaturated)
      .value("DISCONNECTED", SensorStatus::kDisconnected)
      .value("ERROR", SensorStatus::kError)
      .finalize();
  py::native_enum<LinkState>(m, "LinkState", "enum.IntEnum", "State of the connection to a sensor.")
      .value("CLOSED", LinkState::kClosed)
      .value("STOPPED", LinkState::kStopped)
      .value("WAITING", LinkState::kWaiting)
      .value("STREAMING", LinkState::kStreaming)
      .value("SILENT", LinkState::kSilent)
      .value("REFUSED", LinkState::kRefused)
      .value("UNREACHABLE", LinkState::kUnreachable)
      .finalize();
}

using Words = std::tuple<std::uint32_t, std::uint32_t, std::uint32_t, std::array<std::int32_t, 3>,
                         std::array<std::int32_t, 3>>;

template <class Packet>
py::bytes bytes_of(const Packet& packet) {
  const auto bytes = sensor::encode(packet);
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

template <class Packet>
Packet decoded(const py::bytes& data, const char* what) {
  const std::string_view bytes = data;
  Packet packet;
  const auto* first = reinterpret_cast<const std::uint8_t*>(bytes.data());
  if (!sensor::decode(std::span(first, bytes.size()), packet)) {
    throw std::invalid_argument(std::to_string(bytes.size()) + " bytes are no " + what +
                                ": must be " + std::to_string(Packet::kBytes));
  }
  return packet;
}

/// The packets themselves, for who wants to look at the wire.
void bind_wire(py::module_& m) {
  m.def(
      "_encode_record",
      [](std::uint32_t rdt, std::uint32_t ft, std::uint32_t status,
         const std::array<std::int32_t, 3>& force, const std::array<std::int32_t, 3>& torque) {
        return bytes_of(RdtRecord{rdt, ft, status, force, torque});
      },
      py::arg("rdt_sequence"), py::arg("ft_sequence"), py::arg("status"), py::arg("force"),
      py::arg("torque"), "Return the 36 bytes of a record.");
  m.def(
      "_decode_record",
      [](const py::bytes& data) -> Words {
        const auto r = decoded<RdtRecord>(data, "record");
        return {r.rdt_sequence, r.ft_sequence, r.status, r.force, r.torque};
      },
      py::arg("data"), "Return rdt_sequence, ft_sequence, status, force and torque of 36 bytes.");
  m.def(
      "_encode_request",
      [](std::uint16_t command, std::uint32_t samples) {
        return bytes_of(sensor::RdtRequest{command, samples});
      },
      py::arg("command"), py::arg("samples") = 0, "Return the 8 bytes of a request.");
}

/// What `RdtSetup` would refuse, but for the host: that is looked up when it is needed.
void check_sensor(int port, double retry, double gone, const std::array<double, 9>& rotation,
                  int sign) {
  sensor::check_client({.sensor = {.port = checked_port(port, 1)},
                        .link = {.mounting = checked_mounting(rotation, sign)},
                        .retry = retry,
                        .gone = gone});
}

void bind_setup(py::module_& m) {
  bind_fields<FtScale>(m, "FtScale", "Units and range of the counts of a force/torque sensor.");
  py::class_<RdtClientSetup>(m, "RdtSetup", "Address and mounting of a force sensor.")
      .def(py::init([](const std::string& host, int port, const FtScale& scale,
                       const std::array<double, 9>& rotation, int sign, SensorModel model,
                       double retry, double gone, const std::array<double, 6>& bias) {
             return RdtClientSetup{.sensor = resolved(host, checked_port(port, 1)),
                                   .link = {.scale = scale,
                                            .mounting = checked_mounting(rotation, sign),
                                            .bits = sensor::StatusBits::of(model),
                                            .bias = bias},
                                   .retry = retry,
                                   .gone = gone};
           }),
           py::arg("host"), py::arg("port"), py::kw_only(), py::arg("scale"), py::arg("rotation"),
           py::arg("sign"), py::arg("model"), py::arg("retry"), py::arg("gone"), py::arg("bias"));
  m.def("_check_sensor", &check_sensor, py::arg("port"), py::arg("retry"), py::arg("gone"),
        py::arg("rotation"), py::arg("sign"), "Raise ValueError if a value is out of range.");
}

/// Waits for a newer record without the interpreter's lock: false when the time is over.
bool poll(TimedClient& self, double timeout) {
  const bool fits = timeout >= 0 && timeout <= 3600;  // not a NaN
  if (!fits) {
    throw std::invalid_argument(range_message("read", "timeout", timeout, "s", 0, 3600));
  }
  const auto until = Steady::now() + std::chrono::duration_cast<Steady::duration>(
                                         std::chrono::duration<double>(timeout));
  while (!self.poll()) {
    const std::chrono::nanoseconds left = until - Steady::now();
    if (left.count() <= 0 || self.client.state() == LinkState::kClosed) return false;
    {
      const OthersRun others_run;
      self.client.wait(std::min<std::chrono::nanoseconds>(left, kSlice));
    }
    if (PyErr_CheckSignals() != 0) throw py::error_already_set();
  }
  return true;
}

std::array<double, 3> three(const Axes& axes) { return {axes[0], axes[1], axes[2]}; }

void add_work(py::class_<TimedClient>& cls) {
  cls.def(
         "start", [](TimedClient& self) { self.client.start(); }, "Request a stream.")
      .def(
          "stop", [](TimedClient& self) { self.client.stop(); }, "End the stream.")
      .def(
          "close", [](TimedClient& self) { self.client.close(); }, "Close the connection.")
      .def("poll", &poll, py::arg("timeout") = 0.0,
           "Read all records, waiting up to `timeout` [s] for a new one; return whether one "
           "arrived.")
      .def(
          "bias_sensor", [](TimedClient& self) { self.client.bias_sensor(); },
          "Make the sensor take the present load as zero.")
      .def(
          "begin_bias",
          [](TimedClient& self, int records) {
            if (records < 1 || records > 1'000'000) {
              throw std::invalid_argument(
                  range_message("bias", "records", records, "1", 1, 1'000'000));
            }
            self.client.begin_bias(records);
          },
          py::arg("records"), "Take the mean of the next `records` valid records as zero.")
      .def(
          "cancel_bias", [](TimedClient& self) { self.client.cancel_bias(); },
          "Take no zero after all; it stays what it was.");
}

/// A read-only property of the client, and of the link within.
template <class Get>
void add_property(py::class_<TimedClient>& cls, const char* name, Get get, const char* what) {
  cls.def_property_readonly(
      name, [get](const TimedClient& self) { return get(self.client); }, what);
}

void add_readings(py::class_<TimedClient>& cls) {
  using Client = sensor::RdtClient;
  add_property(
      cls, "force", [](const Client& c) { return three(c.link().force()); },
      "Force at the handle [N].");
  add_property(
      cls, "torque", [](const Client& c) { return three(c.link().torque()); },
      "Torque about the axes of the handle [N m].");
  add_property(
      cls, "age", [](const Client& c) { return c.age(); },
      "Age of the newest record at the last poll [s].");
  add_property(
      cls, "health", [](const Client& c) { return c.health(); }, "Status reported by the sensor.");
  add_property(cls, "state", [](const Client& c) { return c.state(); }, "State of the connection.");
  add_property(
      cls, "status", [](const Client& c) { return c.link().record().status; },
      "Status bits of the newest record.");
  add_property(
      cls, "rdt_sequence", [](const Client& c) { return c.link().record().rdt_sequence; },
      "Number of the newest record.");
  add_property(
      cls, "ft_sequence", [](const Client& c) { return c.link().record().ft_sequence; },
      "Sample number of the sensor in the newest record.");
  add_property(
      cls, "biasing", [](const Client& c) { return c.link().biasing(); },
      "Whether a bias is being taken.");
  add_property(
      cls, "bias", [](const Client& c) { return c.link().bias(); },
      "Zero of the readings: force, torque [counts].");
}

void add_counts(py::class_<TimedClient>& cls) {
  using Client = sensor::RdtClient;
  add_property(
      cls, "received", [](const Client& c) { return c.link().received(); }, "Records used.");
  add_property(
      cls, "lost", [](const Client& c) { return c.link().order().lost(); }, "Lost records.");
  add_property(
      cls, "late", [](const Client& c) { return c.link().order().late(); },
      "Records that arrived after a newer one.");
  add_property(
      cls, "duplicate", [](const Client& c) { return c.link().order().duplicate(); },
      "Duplicate records.");
  add_property(
      cls, "malformed", [](const Client& c) { return c.link().malformed(); },
      "Packets of the sensor that are not valid records.");
  add_property(
      cls, "foreign", [](const Client& c) { return c.foreign(); }, "Packets from other senders.");
  add_property(cls, "asked", [](const Client& c) { return c.asked(); }, "Streams requested.");
  add_property(
      cls, "refused", [](const Client& c) { return c.refused(); },
      "Requests that this machine could not send.");
}

}  // namespace

void bind_sensor(py::module_& m) {
  bind_sensor_enums(m);
  bind_wire(m);
  bind_setup(m);
  py::class_<TimedClient> cls(m, "RdtClient", "A force/torque sensor on the network.");
  cls.def(py::init([](const RdtClientSetup& setup) {
            return from_system([&] { return std::make_unique<TimedClient>(setup); });
          }),
          py::arg("setup"));
  add_work(cls);
  add_readings(cls);
  add_counts(cls);
}

}  // namespace ebac::python
