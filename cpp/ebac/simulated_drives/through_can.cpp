#include "ebac/simulated_drives/through_can.hpp"

#include <cmath>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "ebac/canopen/pdo_plan.hpp"
#include "ebac/core/check.hpp"
#include "ebac/core/six_digits.hpp"

namespace ebac::can {

namespace {

/// SYNC and process data of a device in every tick.
BusLoad load_of(int axes, const Timing& timing, const TimedBus& bus) {
  std::vector<int> nodes;
  for (int i = 1; i <= axes; ++i) nodes.push_back(i);
  return {.frames = pdo_plan(nodes), .bit_rate = bus.bit_rate, .period = timing.dt};
}

/// From the loop's first frame to the last answer [s], without any stuff bit.
double least_exchange(const BusLoad& load, const TimedBus& bus) {
  int bits = 0;
  for (const PlannedFrame& one : load.frames) bits += one.count * least_bits(one.size);
  return bits / load.bit_rate + bus.response;
}

/// Refuses a watch of the drives that the loop lets run out between two of what it sends every `ticks`: `ms` is what they
/// count, 0 for none.
void check_silence(const char* name, double seconds, std::int64_t ms, const char* what, int ticks,
                   const Timing& timing) {
  const double every = ticks * timing.dt;
  if (ms == 0 || static_cast<double>(ms) / 1e3 > every) return;
  throw std::invalid_argument(
      "TimedBus." + std::string(name) + " = " + shortest(seconds) +
      " s: a drive lets go without a " + what + " for " + std::to_string(ms) +
      " ms, and the next one comes after " +
      (ticks == 1 ? "a tick of" : std::to_string(ticks) + " ticks,") + " " + six_digits(every) +
      " s; must be longer than that in whole milliseconds, or 0, which watches none: shorten "
      "timing.dt, or let the drives watch for longer");
}

}  // namespace

std::string explain_times(int axes, const Timing& timing, const TimedBus& bus) {
  const BusLoad load = load_of(axes, timing, bus);
  const auto us = [](double seconds) { return std::llround(1e6 * seconds); };
  std::ostringstream text;
  text << "the loop waits " << us(bus.answer_share * timing.dt) << " us for answers, of which the "
       << "last comes after " << us(least_exchange(load, bus)) << " to "
       << us(load.seconds() + bus.response) << " us at " << bus.bit_rate / 1e3
       << " kbit/s; raise bus.answer_share or the bit rate, or lengthen timing.dt";
  return text.str();
}

std::size_t exchanges_held(const Timing& timing) {
  constexpr int kMost = 8;
  if (timing.delay >= 1 && timing.delay <= kMost) {
    return static_cast<std::size_t>(timing.delay - 1);
  }
  throw std::invalid_argument("Timing.delay = " + std::to_string(timing.delay) +
                              " samples: over a CAN bus a command acts one tick later at the "
                              "earliest; must lie in [1, " +
                              std::to_string(kMost) + "] samples");
}

void check_through_can(int axes, const Timing& timing, const std::optional<TimedBus>& timed) {
  static_cast<void>(exchanges_held(timing));
  const TimedBus bus = timed.value_or(TimedBus{});
  if (bus.broken > axes) {
    throw std::invalid_argument("TimedBus.broken = " + std::to_string(bus.broken) +
                                ": must lie in [0, " + std::to_string(axes) +
                                "], the nodes of this device; 0 breaks none");
  }
  if (timed) {
    const Watches watches = watches_of(bus);
    const double beat = can_setup({}, bus).heartbeat_period;  // with the first tick that is as late
    const int beats = static_cast<int>(std::ceil(beat / timing.dt));
    check_silence("torque_silence", bus.torque_silence, watches.torque_silence, "torque", 1,
                  timing);
    check_silence("loop_silence", bus.loop_silence, watches.loop_silence, "heartbeat", beats,
                  timing);
  }
  const BusLoad load = load_of(axes, timing, bus);
  static_cast<void>(check_load(load));
  if (!timed || least_exchange(load, bus) <= bus.answer_share * timing.dt) return;
  throw std::invalid_argument("TimedBus.answer_share = " + shortest(bus.answer_share) + ": " +
                              explain_times(axes, timing, bus));
}

}  // namespace ebac::can
