#pragma once

#include <array>
#include <span>

#include "ebac/core/concepts.hpp"
#include "ebac/core/realtime.hpp"
#include "ebac/loop/account_watch.hpp"
#include "ebac/loop/axis_observer.hpp"
#include "ebac/loop/observing.hpp"
#include "ebac/model/device.hpp"

namespace ebac {

struct Pose;

/// State of a whole device: an observer for each axis, in the joints, where counts and currents are,
/// and the share of their estimate that is used.
class StateObserver {
 public:
  StateObserver(const DeviceModel& device, const Observing& observing);

  bool on() const EBAC_RT { return observing_.on; }

  /// Share of the estimate in what world and law are given.
  double weight() const EBAC_RT { return observing_.acts ? weight_ : 0.0; }

  /// Time from a tick of `dt` to when its command acts, in the middle of its interval [s].
  double ahead(double dt) const EBAC_RT {
    return (observing_.params.delay + 0.5) * dt + observing_.params.current_lag;
  }

  /// Whether the law uses the estimate; where it begins to, the estimate fades in.
  void act(bool observed) EBAC_RT {
    const bool acts = on() && (observing_.params.every_law || observed);
    if (acts && !observing_.acts) weight_ = 0;
    observing_.acts = acts;
  }

  /// Whether the account of the law is `drained` in this tick, by which the law may give the estimate up.
  void heed(bool drained, double dt, std::span<const Axis> axes) EBAC_RT;

  /// Begins anew in the next tick.
  void forget() EBAC_RT { forgot_ = true; }

  /// counts, f_meas, currents -> est; `counted` tells of every axis whether new counts came.
  void step(const Reading& reading, const std::array<bool, kMaxAxes>& counted, double dt,
            std::span<Axis> axes) EBAC_RT;

 private:
  static constexpr double kUnbroken = 0.1;  // s without a failure, until the estimate is used again

  Fallback failure(const Reading& reading, std::size_t axes) const EBAC_RT;
  void trust(const Reading& reading, double dt, std::size_t axes) EBAC_RT;
  double mass_share(const Pose& at, Eigen::Index axis) const EBAC_RT;
  void step_general(const Reading& reading, const std::array<bool, kMaxAxes>& counted, double dt,
                    std::span<Axis> axes) EBAC_RT;

  const AxisObserver& follow(std::size_t axis, const Joint& joint, double force,
                             const Reading& reading, bool counted, double dt) EBAC_RT;
  void enter(std::size_t axis, Port& port) const EBAC_RT;

  Kinematics kinematics_;
  bool linear_;
  Axes travel_;         // m, way at the handle per joint angle
  Axes force_per_amp_;  // N/A, at the handle
  bool slides_;         // the lever
  double handle_mass_;  // kg
  double slide_mass_;   // kg, on the last axis, in the middle
  Observing observing_;
  std::array<AxisObserver, kMaxAxes> observer_;
  bool forgot_ = false;  // begins in this tick
  AccountWatch account_;
  double weight_ = 1;  // of the estimate
  Fallback fallback_ = Fallback::kNone;
  double unbroken_ = kUnbroken;  // s, without a failure
};

}  // namespace ebac
