#pragma once

#include <chrono>

#include "ebac/can/wait.hpp"

namespace ebac::can {

/// Sleeps on the bus until a frame is there or the budget of the exchange is spent, so that whoever
/// answers may run meanwhile. The bus stays the caller's and must outlive it.
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
