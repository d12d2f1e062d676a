#pragma once

#include <chrono>
#include <concepts>
#include <cstdint>
#include <utility>

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

/// Polls until the budget is spent, by the time that `Now` returns in ns.
template <class Now>
  requires requires(Now now) {
    { now() } noexcept -> std::same_as<std::int64_t>;
  }
class PollFor {
 public:
  PollFor(Now now, std::int64_t budget) EBAC_RT : now_(std::move(now)), budget_(budget) {}  // ns

  void begin(double) EBAC_RT { end_ = now_() + budget_; }
  bool more() EBAC_RT { return now_() < end_; }

 private:
  Now now_;
  std::int64_t budget_;   // ns
  std::int64_t end_ = 0;  // ns
};

/// Lets the other side, which lives in the same thread, do its work once; afterwards every answer
/// has arrived. `run(elapsed)` receives the time since the last exchange [s].
template <class Other>
  requires requires(Other other, double elapsed) {
    { other.run(elapsed) } noexcept;
  }
class RunOther {
 public:
  explicit RunOther(Other& other) EBAC_RT : other_(&other) {}

  void begin(double elapsed) EBAC_RT {
    elapsed_ = elapsed;
    ran_ = false;
  }
  bool more() EBAC_RT {
    if (ran_) return false;
    other_->run(elapsed_);
    return ran_ = true;
  }

 private:
  Other* other_;
  double elapsed_ = 0;  // s
  bool ran_ = false;
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
