#pragma once

#include <array>
#include <string_view>
#include <tuple>
#include <utility>

#include "ebac/core/concepts.hpp"
#include "ebac/loop/row_parts.hpp"
#include "ebac/rt/monotonic_clock.hpp"

namespace ebac::rt {

/// A device that records the duration of its exchange; the rest of a tick is computing time.
template <Device D>
class Timed {
 public:
  struct State {
    double exchange = 0;  // s
    static constexpr auto fields() {
      return std::array{Field<State>{"exchange", &State::exchange, "s",
                                     "time the exchange with the device took, waiting included"}};
    }
  };
  static constexpr std::string_view kPrefix = "time.";

  explicit Timed(D device) : device_(std::move(device)) {}

  Reading exchange(const Command& command) EBAC_RT {
    const std::int64_t begun = MonotonicClock::now();
    const Reading reading = device_.exchange(command);
    state_.exchange = static_cast<double>(MonotonicClock::now() - begun) * 1e-9;
    return reading;
  }
  void enable() EBAC_RT { device_.enable(); }
  void disable() EBAC_RT { device_.disable(); }
  void aim(std::size_t axis, double target) EBAC_RT
    requires requires(D& d) { d.aim(axis, target); }
  {
    device_.aim(axis, target);
  }
  void stop() EBAC_RT { device_.stop(); }
  bool running() const EBAC_RT { return device_.running(); }
  bool at_rest() const EBAC_RT { return device_.at_rest(); }

  D& device() EBAC_RT { return device_; }
  const State& state(std::size_t) const EBAC_RT { return state_; }
  auto parts() const EBAC_RT { return std::tuple_cat(row_parts(device_), std::tie(*this)); }

 private:
  D device_;
  State state_{};
};

}  // namespace ebac::rt
