#include "ebac/canopen/pdo_plan.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "ebac/core/check.hpp"

namespace ebac::can {

namespace {

constexpr double kSlowestBus = 1e4;       // bit/s
constexpr double kFastestBus = 1e6;       // bit/s, of classical CAN
constexpr double kShortestPeriod = 1e-5;  // s, as Timing.dt
constexpr double kLongestPeriod = 10;     // s
constexpr double kLongestEvery = 1e6;     // s

void check_range(const char* name, double value, const char* unit, double low, double high) {
  const bool inside = value >= low && value <= high;  // NaN is not
  if (!inside) {
    throw std::invalid_argument(range_message("BusLoad", name, value, unit, low, high));
  }
}

void check_node(int node) {
  if (node >= 1 && node <= kLastNode) return;
  throw std::invalid_argument("node " + std::to_string(node) + ": must lie in [1, 127]");
}

/// "515 us of each 1000 us, 51.5 % of a bus at 1000 kbit/s"
std::string describe(const BusLoad& load) {
  const auto rounded = [](double value) { return shortest(std::round(10 * value) / 10); };
  return rounded(1e6 * load.share() * load.period) + " us of each " + rounded(1e6 * load.period) +
         " us, " + rounded(100 * load.share()) + " % of a bus at " + rounded(1e-3 * load.bit_rate) +
         " kbit/s";
}

std::string remedy(const BusLoad& load) {
  std::string text =
      "fewer or shorter frames, a rate up to " + shortest(std::floor(load.highest_rate())) + " Hz";
  if (load.bit_rate < kFastestBus) text += ", a bus of up to 1000 kbit/s";
  const auto several = [](const PlannedFrame& frame) { return frame.count > 1; };
  if (!std::ranges::any_of(load.frames, several)) return text;
  return text + ", or a bus of its own for a part of the nodes";
}

}  // namespace

std::vector<PlannedFrame> pdo_plan(std::span<const int> nodes) {
  std::vector<PlannedFrame> plan{{.what = "SYNC", .id = kSync, .size = 0}};
  for (auto node = nodes.begin(); node != nodes.end(); ++node) {
    const std::string name = "node " + std::to_string(*node);
    check_node(*node);
    if (std::find(nodes.begin(), node, *node) != node) {
      throw std::invalid_argument(name + " is named twice: every drive needs a number of its own");
    }
    const auto id = static_cast<NodeId>(*node);
    plan.push_back(
        {.what = name + ", controlword and target torque", .id = rpdo(1, id), .size = kRpdoSize});
    plan.push_back(
        {.what = name + ", statusword, position and torque", .id = tpdo(1, id), .size = kTpdoSize});
  }
  return plan;
}

std::vector<PlannedFrame> heartbeat_plan(std::span<const int> nodes, double every, int loop,
                                         double loop_every) {
  std::vector<PlannedFrame> plan;
  const auto beat = [&](const std::string& who, int node, double seconds) {
    check_node(node);
    plan.push_back({.what = who + ", heartbeat",
                    .id = heartbeat(static_cast<NodeId>(node)),
                    .size = kHeartbeatSize,
                    .every = seconds});
  };
  if (every > 0) {
    for (const int node : nodes) beat("node " + std::to_string(node), node, every);
  }
  if (loop_every > 0) beat("the loop", loop, loop_every);
  return plan;
}

std::int64_t BusLoad::bits(const PlannedFrame& frame) const {
  const std::int64_t once = std::int64_t{frame.count} * worst_bits(frame.size);
  // Clocks drift: of what comes more often than the period, a period may have one more than fit in it.
  constexpr double kMost = 1e6;
  const double times = frame.every > 0 ? std::min(std::floor(period / frame.every), kMost) : 0;
  return once * (times > 1 ? static_cast<std::int64_t>(times) + 1 : 1);
}

double BusLoad::share(const PlannedFrame& frame) const {
  const double once = static_cast<double>(frame.count) * worst_bits(frame.size);
  return once / bit_rate / (frame.every > 0 ? frame.every : period);
}

std::int64_t BusLoad::bits() const {
  std::int64_t sum = 0;
  for (const PlannedFrame& frame : frames) sum += bits(frame);
  return sum;
}

double BusLoad::share() const {
  std::int64_t each_period = 0;  // bits; summed as whole numbers, so that a limit is met exactly
  double others = 0;
  for (const PlannedFrame& frame : frames) {
    if (frame.every > 0) {
      others += share(frame);
    } else {
      each_period += bits(frame);
    }
  }
  return static_cast<double>(each_period) / bit_rate / period + others;
}

double BusLoad::highest_rate() const {
  double each_period = 0;  // bits
  double others = 0;       // of the bus
  for (const PlannedFrame& frame : frames) {
    if (frame.every > 0) {
      others += share(frame);
    } else {
      each_period += static_cast<double>(bits(frame));
    }
  }
  return std::max(0.0, kRefusedLoad - others) * bit_rate / each_period;
}

std::string check_load(const BusLoad& load) {
  check_range("bit_rate", load.bit_rate, "bit/s", kSlowestBus, kFastestBus);
  check_range("period", load.period, "s", kShortestPeriod, kLongestPeriod);
  for (const PlannedFrame& frame : load.frames) {
    check_range("size", frame.size, "bytes", 0, 8);
    check_range("count", frame.count, "frames", 0, 1e6);
    if (frame.every != 0) check_range("every", frame.every, "s", kShortestPeriod, kLongestEvery);
  }
  if (!(load.share() > kWarnedLoad)) return {};
  if (load.share() > kRefusedLoad) {
    throw std::invalid_argument(
        "the planned frames take " + describe(load) +
        ", at the worst: must be at most 90 %; the remedy: " + remedy(load));
  }
  return "the planned frames take " + describe(load) +
         ", at the worst: over 70 %, little is left for SDO, EMCY and repeated frames; the "
         "remedy: " +
         remedy(load);
}

}  // namespace ebac::can
