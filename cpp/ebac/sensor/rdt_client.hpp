#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <string_view>

#include "ebac/sensor/rdt_link.hpp"
#include "ebac/sensor/rdt_row.hpp"
#include "ebac/sensor/udp.hpp"

namespace ebac::sensor {

/// State of the connection to a sensor. Every value is reported; none is an exception.
enum class LinkState : std::uint8_t {
  kClosed = 0,       // by `close`
  kStopped = 1,      // no stream is wanted
  kWaiting = 2,      // a stream was requested, and nothing has arrived yet
  kStreaming = 3,    // records come
  kSilent = 4,       // they came, and do not come any more
  kRefused = 5,      // no program listens at the sensor's port
  kUnreachable = 6,  // no way leads to its address
};

struct RdtClientSetup {
  Endpoint sensor{};
  RdtLink::Setup link{};
  double retry = 0.25;  // s, of silence, after which the stream is requested again
  double gone = 0.5;    // s, of silence, then the sensor counts as disconnected
  /// Whether a record's age counts from when the kernel had it. Otherwise from the poll that read it,
  /// as time has to be counted where it is virtual.
  bool stamped = true;
};

/// Throws std::invalid_argument for a setup that cannot be; scale and mounting apart.
void check_client(const RdtClientSetup& setup);

/// Age [s] of a record that the kernel stamped at `stamp` on the wall clock, read `since_poll` after
/// the last poll, which had left none. All in ns. The wall clock may step meanwhile: the age is then
/// wrong by no more than that time.
double record_age(std::int64_t stamp, std::int64_t wall, std::int64_t since_poll) EBAC_RT;

/// A force/torque sensor on the network, polled by its owner. No call waits, except `wait`.
class RdtClient {
 public:
  using State = RdtRow;
  static constexpr std::string_view kPrefix = "ft.";
  /// More than a socket's queue holds.
  static constexpr int kMostPackets = 1024;

  /// Throws std::system_error, or std::invalid_argument for a setup that cannot be.
  explicit RdtClient(const RdtClientSetup& setup);
  ~RdtClient() { close(); }
  RdtClient(RdtClient&&) noexcept = default;
  RdtClient& operator=(RdtClient&&) noexcept = default;
  RdtClient(const RdtClient&) = delete;
  RdtClient& operator=(const RdtClient&) = delete;

  /// Requests an endless stream.
  void start() EBAC_RT;
  void stop() EBAC_RT;
  /// Makes the sensor take the present load as zero, for every client, until it loses power.
  void bias_sensor() EBAC_RT { ask(RdtCommand::kBias); }
  /// Takes the mean of the next `records` as zero, here.
  void begin_bias(int records) EBAC_RT { link_.begin_bias(records); }
  void cancel_bias() EBAC_RT { link_.cancel_bias(); }

  /// Reads all that came; `elapsed` seconds after the last poll. Whether a newer record did.
  bool poll(double elapsed) EBAC_RT;
  /// Waits for a packet, for the tick of no loop.
  bool wait(std::chrono::nanoseconds timeout) const noexcept { return socket_.wait(timeout); }
  /// For good. A thread waiting in `wait` returns, and alone that call may run meanwhile; the socket goes with this
  /// object.
  void close() noexcept;

  /// Writes force, age and status into a reading of a device.
  void fill(Reading& reading) const EBAC_RT;

  LinkState state() const EBAC_RT { return state_; }
  const State& state(std::size_t axis) const EBAC_RT { return row_[axis]; }
  const RdtLink& link() const EBAC_RT { return link_; }
  double age() const EBAC_RT { return age_; }  // s, of the newest record, or of the wait for one
  SensorStatus health() const EBAC_RT;
  std::int64_t foreign() const EBAC_RT { return foreign_; }
  std::int64_t asked() const EBAC_RT { return asked_; }      // streams requested
  std::int64_t refused() const EBAC_RT { return refused_; }  // requests that did not leave
  Endpoint local() const noexcept { return socket_.local(); }
  const RdtClientSetup& setup() const EBAC_RT { return setup_; }

 private:
  bool open() const EBAC_RT { return socket_.open() && state_ != LinkState::kClosed; }
  void ask(RdtCommand command) EBAC_RT;
  bool take(const Datagram& in) EBAC_RT;
  void note(int error) EBAC_RT;
  void fill_row() EBAC_RT;

  RdtClientSetup setup_;
  RdtLink link_;
  UdpSocket socket_;
  LinkState state_ = LinkState::kStopped;
  bool wanted_ = false;          // a stream
  double age_ = 0;               // s
  double quiet_ = 0;             // s, since a poll last read a record
  double since_asked_ = 0;       // s
  std::int64_t polled_ = 0;      // ns, monotonic
  std::int64_t since_poll_ = 0;  // ns
  std::int64_t foreign_ = 0;
  std::int64_t asked_ = 0;
  std::int64_t refused_ = 0;
  std::array<RdtRow, kMaxAxes> row_{};
};

}  // namespace ebac::sensor
