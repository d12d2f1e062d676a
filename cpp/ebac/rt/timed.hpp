#pragma once

#include <array>
#include <string_view>
#include <tuple>
#include <utility>

#include "ebac/loop/device_around.hpp"
#include "ebac/rt/monotonic_clock.hpp"

namespace ebac::rt {

/// A device that records the duration of its exchange; the rest of a tick is computing time.
template <Device D>
class Timed : public DeviceAround<D> {
  using DeviceAround<D>::device_;

 public:
  struct State {
    double exchange = 0;  // s
    static constexpr auto fields() {
      return std::array{Field<State>{"exchange", &State::exchange, "s",
                                     "time the exchange with the device took, waiting included"}};
    }
  };
  static constexpr std::string_view kPrefix = "time.";

  explicit Timed(D device) : DeviceAround<D>(std::move(device)) {}

  Reading exchange(const Command& command) EBAC_RT {
    const std::int64_t begun = MonotonicClock::now();
    const Reading reading = device_.exchange(command);
    state_.exchange = static_cast<double>(MonotonicClock::now() - begun) * 1e-9;
    return reading;
  }

  const State& state(std::size_t) const EBAC_RT { return state_; }
  auto parts() const EBAC_RT { return std::tuple_cat(row_parts(device_), std::tie(*this)); }

 private:
  State state_{};
};

}  // namespace ebac::rt
