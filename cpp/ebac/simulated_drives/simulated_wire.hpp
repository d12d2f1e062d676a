#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "ebac/can/bus.hpp"
#include "ebac/can/frame_queue.hpp"
#include "ebac/model/noise.hpp"

namespace ebac::can {

struct WireOptions {
  std::size_t stations = 2;  // CAN controllers on the wire, 1 to 256
  double bit_rate = 1e6;     // bit/s, 1e4 to 1e6
  double error_rate = 0;     // probability that a frame is destroyed, 0 to 1
  bool recovers = true;      // whether a controller that is off the bus comes back by itself
  std::uint64_t seed = 0;    // of what is destroyed
};

/// The wire of a CAN bus in virtual time [ns] (ISO 11898-1). When it is free, the lowest identifier
/// among the frames at the heads of the controllers' queues goes first, and arrives when its last
/// bit has passed. A destroyed frame, or one that nobody acknowledges, costs an error frame and is
/// sent again. Of two frames with one identifier, that of the lower station goes first.
///
/// The sender of a destroyed frame counts 8 errors up, the others 1; each frame that went well
/// counts 1 down. Above 127 a controller is error passive, and pauses for 8 bits after each of its
/// frames; a sender above 255 goes off the bus and loses its queue. It comes back after 128 times 11
/// recessive bits.
class SimulatedWire {
 public:
  struct Delivery {
    Frame frame;           // its stamp is the time of its arrival [ns]
    std::size_t from = 0;  // station
  };

  /// Throws std::invalid_argument for options out of range.
  explicit SimulatedWire(const WireOptions& options);

  /// Queues a frame that may go from `due` [ns] on; false where the station is off the bus, its
  /// queue of 64 frames is full, or that is after the latest time there is, 146 years.
  bool send(std::size_t station, const Frame& frame, std::int64_t due) EBAC_RT;
  /// Goes on to the next frame that arrives, at `until` [ns] at the latest; false where none does.
  /// Frames due before `until` must have been sent.
  bool next(std::int64_t until, Delivery& delivery) EBAC_RT;

  /// Probability that a frame of this station is destroyed.
  void set_error_rate(std::size_t station, double rate) EBAC_RT {
    station_[station].error_rate = rate;
  }
  /// Whether this station comes back to the bus by itself.
  void set_recovers(std::size_t station, bool does) EBAC_RT { station_[station].recovers = does; }

  std::size_t stations() const EBAC_RT { return station_.size(); }
  BusState state(std::size_t station) const EBAC_RT;
  bool off(std::size_t station) const EBAC_RT { return station_[station].off; }
  bool was_passive(std::size_t station) const EBAC_RT { return station_[station].was_passive; }
  std::int64_t destroyed() const EBAC_RT { return destroyed_; }  // frames
  std::int64_t busy() const EBAC_RT { return busy_; }            // ns

 private:
  static constexpr std::int64_t kLatest = std::int64_t{1} << 62;  // ns, with room for a frame

  struct Station {
    FrameQueue<64> queue;  // a stamp is the time from which the frame may go
    double error_rate = 0;
    int sent_errors = 0;
    int received_errors = 0;
    std::int64_t free_at = 0;   // ns, until which it suspends its transmission
    std::int64_t recovery = 0;  // bits still to be recessive
    bool recovers = true;
    bool off = false;
    bool was_passive = false;

    bool passive() const EBAC_RT { return sent_errors > kPassive || received_errors > kPassive; }
    std::optional<std::int64_t> ready() const EBAC_RT;
  };

  static constexpr int kWarning = 96;
  static constexpr int kPassive = 127;
  static constexpr int kOff = 255;
  static constexpr int kRecessive = 11;              // bits
  static constexpr int kRecovery = 128;              // times
  static constexpr int kSuspend = 8;                 // bits
  static constexpr int kErrorFrame = 6 + 6 + 8 + 3;  // bits: two flags, delimiter, space

  std::int64_t time_of(std::int64_t bits) const EBAC_RT;
  bool start(std::int64_t until) EBAC_RT;
  bool acknowledged() const EBAC_RT;
  bool end(Delivery& delivery) EBAC_RT;
  void destroy(Station& sender) EBAC_RT;
  void recover(std::int64_t bits) EBAC_RT;

  std::vector<Station> station_;
  double bit_;  // ns
  Noise random_;
  std::int64_t now_ = 0;   // ns: the wire is free from then on
  std::int64_t ends_ = 0;  // ns, of the frame on the wire
  std::size_t sender_ = 0;
  bool under_way_ = false;
  bool heard_ = false;     // the frame on the wire goes well
  std::int64_t idle_ = 0;  // ns, of recessive bits not yet counted
  std::int64_t destroyed_ = 0;
  std::int64_t busy_ = 0;
};

}  // namespace ebac::can
