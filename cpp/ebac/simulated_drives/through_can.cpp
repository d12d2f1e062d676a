#include "ebac/simulated_drives/through_can.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "ebac/canopen/loop_watch.hpp"
#include "ebac/core/check.hpp"

namespace ebac::can {

namespace {

/// From the loop's first frame to the last answer [s], without any stuff bit: heartbeats come beside it.
double least_exchange(const BusLoad& load, const TimedBus& bus) {
  int bits = 0;
  for (const PlannedFrame& one : load.frames) {
    if (one.every == 0) bits += one.count * least_bits(one.size);
  }
  return bits / load.bit_rate + bus.response;
}

void check_watches(const TimedBus& bus, double dt) {
  const Watches watches = watches_of(bus);
  check_watch({.name = "TimedBus.torque_silence",
               .seconds = bus.torque_silence,
               .ms = watches.torque_silence,
               .what = "torque"},
              dt);
  check_watch({.name = "TimedBus.loop_silence",
               .seconds = bus.loop_silence,
               .ms = watches.loop_silence,
               .what = "heartbeat",
               .period = can_setup({}, bus).heartbeat_period},
              dt);
}

}  // namespace

BusLoad load_on_bus(int axes, const Timing& timing, const std::optional<TimedBus>& timed) {
  const TimedBus bus = timed.value_or(TimedBus{});
  std::vector<int> nodes;
  for (int i = 1; i <= axes; ++i) nodes.push_back(i);
  BusLoad load{.frames = pdo_plan(nodes), .bit_rate = bus.bit_rate, .period = timing.dt};
  if (!timed) return load;
  const double beat = static_cast<double>(watches_of(bus).drive_heartbeat) / 1e3;
  const CanopenSetup setup = can_setup({}, bus);
  const double own = setup.own_node > 0 ? sent_every(setup.heartbeat_period, timing.dt) : 0.0;
  std::ranges::copy(heartbeat_plan(nodes, beat, setup.own_node, own),
                    std::back_inserter(load.frames));
  return load;
}

std::string explain_times(int axes, const Timing& timing, const TimedBus& bus) {
  const BusLoad load = load_on_bus(axes, timing, bus);
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
  if (timed) check_watches(bus, timing.dt);
  const BusLoad load = load_on_bus(axes, timing, timed);
  static_cast<void>(check_load(load));
  if (!timed || least_exchange(load, bus) <= bus.answer_share * timing.dt) return;
  throw std::invalid_argument("TimedBus.answer_share = " + shortest(bus.answer_share) + ": " +
                              explain_times(axes, timing, bus));
}

}  // namespace ebac::can
