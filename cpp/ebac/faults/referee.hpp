#pragma once

#include <array>
#include <optional>
#include <span>

#include "ebac/can/frame.hpp"
#include "ebac/faults/breach.hpp"
#include "ebac/faults/case_setup.hpp"
#include "ebac/faults/injected_fault.hpp"

namespace ebac::faults {

/// What a referee sees of an axis at the end of a tick: not by the loop.
struct Seen {
  double current = 0;    // A, of the drive, in the device's direction
  bool enabled = false;  // the drive is in operation enabled
  double x = 0, v = 0;   // m, m/s, of the handle
};

/// Holds the drives and the handle against the limits by a model of its own: from the data of the
/// device and what is set for the case alone. Keeps the first breach.
class Referee {
 public:
  Referee(const CaseSetup& made, const InjectedFault& injected);

  /// A frame of the loop.
  void hear(const can::Frame& frame) EBAC_RT;
  /// A tick is over, `elapsed` s after the last one.
  void watch(double elapsed, std::span<const Seen> axes) EBAC_RT;
  /// The run is over.
  void finish() EBAC_RT;

  const Breach& breach() const EBAC_RT { return breach_; }

 private:
  struct Axis {
    double before = 0;  // A
    double heat = 0;    // of the continuous current's
    double depth = 0;   // m, over the edge, in the last tick
    double most = 0;    // A, in the direction that the law asks for
    int fast = 0;       // ticks in a row above the limit of the speed
    int out = 0;        // ticks since it was first too fast, or too far
  };

  void note(Rule rule, bool broken, double value, double bound, std::size_t axis) EBAC_RT;
  void power(std::span<const Seen> axes) EBAC_RT;
  void currents(double elapsed, const Seen& seen, std::size_t i) EBAC_RT;
  void stopped(const Seen& seen, std::size_t i) EBAC_RT;
  void motion(const Seen& seen, std::size_t i) EBAC_RT;
  void soft_wall(const Seen& seen, std::size_t i) EBAC_RT;
  void direction(std::span<const Seen> axes) EBAC_RT;

  const InjectedFault* injected_;
  Limits limits_;
  double dt_;                  // s
  double soft_start_;          // s
  double ramp_down_;           // s
  std::int64_t law_ticks_;     // without a fault
  double full_;                // A, that the device can have
  double grain_;               // A, to which a drive rounds
  double newton_per_amp_;      // N/A
  std::optional<Wall> wall_;   // the virtual world
  int pressed_ = 0;            // ticks in a row that the handle is in it
  double longest_gap_;         // s, between two heartbeats or requests of the loop
  double gap_ = 0;             // s, since the last one
  bool heard_ = false;         // a heartbeat or a request, in this tick
  bool all_ = false;           // drives enabled, now
  bool were_ = false;          // all enabled, ever
  int some_off_ = 0;           // ticks since the first drive went off after that
  std::int64_t let_in_ = 0;    // tick from which on the force comes in
  bool lets_in_next_ = false;  // a pause: it comes in anew from the next tick on
  std::array<Axis, kMaxAxes> axis_{};
  Breach breach_{};
};

}  // namespace ebac::faults
