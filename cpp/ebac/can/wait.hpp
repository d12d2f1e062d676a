#pragma once

#include <chrono>
#include <concepts>

#include "ebac/core/realtime.hpp"

namespace ebac::can {

/// How a device waits for its drives within one exchange. `begin` is called before anything is
/// sent, with the time since the last exchange [s]; `more` is called whenever nothing is left to
/// read and returns true to look again, false when the budget is spent.
template <class W>
concept Wait = requires(W wait, double elapsed) {
  { wait.begin(elapsed) } noexcept;
  { wait.more() } noexcept -> std::same_as<bool>;
};

/// Sleeps on the bus until a frame arrives or the budget of the exchange is spent, so that the
/// answering thread can run. The caller keeps the bus, which must outlive this object.
template <class B>
  requires requires(B bus, std::chrono::nanoseconds most) {
    { bus.wait(most) } noexcept;
  }
class WaitOn {
 public:
  WaitOn(B& bus, std::chrono::nanoseconds budget) EBAC_RT : bus_(&bus), budget_(budget) {}

  void begin(double) EBAC_RT { end_ = Clock::now() + budget_; }
  bool more() EBAC_RT {
    const auto left = end_ - Clock::now();
    return left.count() > 0 && bus_->wait(left);
  }

 private:
  using Clock = std::chrono::steady_clock;

  B* bus_;
  std::chrono::nanoseconds budget_;
  Clock::time_point end_{};
};

}  // namespace ebac::can
