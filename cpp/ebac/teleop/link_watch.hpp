#pragma once

#include <algorithm>

#include "ebac/teleop/coupling.hpp"

namespace ebac::teleop {

/// Whether the link carries, from what arrives; and how much of the force is let through.
class LinkWatch {
 public:
  LinkWatch(const Coupling& coupling, double dt) EBAC_RT : timeout_(coupling.timeout),
                                                           step_(dt / coupling.fade),
                                                           dt_(dt) {}

  void heard() EBAC_RT {
    silent_ = 0;
    ++heard_;
  }
  /// At the end of a tick. `other_lost`: the other side says it has lost the link in this session.
  void tick(bool other_lost) EBAC_RT {
    silent_ += dt_;
    if (silent_ > timeout_) heard_ = 0;
    if (state_ == LinkState::kWaiting && heard_ > 0) state_ = LinkState::kRunning;
    if (state_ == LinkState::kWaiting && resumed_ && silent_ > timeout_ + kRoundTrip) {
      state_ = LinkState::kLost;  // consented, but nobody answers
    }
    if (state_ == LinkState::kRunning && (silent_ > timeout_ || other_lost)) {
      state_ = LinkState::kLost;
      ++losses_;
    }
    if (state_ == LinkState::kLost && heard_ >= kSteady) state_ = LinkState::kBack;
    if (state_ == LinkState::kBack && heard_ == 0) {
      state_ = LinkState::kLost;
      ++losses_;
    }
    share_ = std::clamp(share_ + (state_ == LinkState::kRunning ? step_ : -step_), 0.0, 1.0);
    if (state_ != LinkState::kRunning) away_ += dt_;
  }
  /// The other side cannot go on in this session: it takes a hand's consent.
  void lose() EBAC_RT {
    if (state_ != LinkState::kWaiting && state_ != LinkState::kRunning) return;
    state_ = LinkState::kLost;
    heard_ = 0;
    ++losses_;
  }
  bool lost() const EBAC_RT { return state_ == LinkState::kLost || state_ == LinkState::kBack; }
  /// A new session: runs from the first packet on.
  void begin() EBAC_RT {
    state_ = LinkState::kWaiting;
    silent_ = 0;
    heard_ = 0;
    away_ = 0;
    resumed_ = true;
  }

  LinkState state() const EBAC_RT { return state_; }
  double share() const EBAC_RT { return share_; }
  double silent() const EBAC_RT { return silent_; }
  double away() const EBAC_RT { return away_; }
  int losses() const EBAC_RT { return losses_; }

 private:
  static constexpr int kSteady = 100;  // packets before the link counts as back

  static constexpr double kRoundTrip = 2.5;  // s, longer than any of two links and buffers

  double timeout_;
  double step_;
  double dt_;
  LinkState state_ = LinkState::kWaiting;
  double silent_ = 0;  // s
  double away_ = 0;    // s, not running
  double share_ = 0;
  bool resumed_ = false;
  int heard_ = 0;
  int losses_ = 0;
};

}  // namespace ebac::teleop
