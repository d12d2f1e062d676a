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

void check_range(const char* name, double value, const char* unit, double low, double high) {
  const bool inside = value >= low && value <= high;  // NaN is not
  if (!inside) {
    throw std::invalid_argument(range_message("BusLoad", name, value, unit, low, high));
  }
}

/// "515 us of each 1000 us, 51.5 % of a bus at 1000 kbit/s"
std::string describe(const BusLoad& load) {
  const auto rounded = [](double value) { return shortest(std::round(10 * value) / 10); };
  return rounded(1e6 * load.seconds()) + " us of each " + rounded(1e6 * load.period) + " us, " +
         rounded(100 * load.share()) + " % of a bus at " + rounded(1e-3 * load.bit_rate) +
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
    if (*node < 1 || *node > kLastNode) {
      throw std::invalid_argument(name + ": must lie in [1, 127]");
    }
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

std::int64_t BusLoad::bits() const {
  std::int64_t sum = 0;
  for (const PlannedFrame& frame : frames) sum += bits(frame);
  return sum;
}

double BusLoad::highest_rate() const {
  return kRefusedLoad * bit_rate / static_cast<double>(bits());
}

std::string check_load(const BusLoad& load) {
  check_range("bit_rate", load.bit_rate, "bit/s", kSlowestBus, kFastestBus);
  check_range("period", load.period, "s", kShortestPeriod, kLongestPeriod);
  for (const PlannedFrame& frame : load.frames) {
    check_range("size", frame.size, "bytes", 0, 8);
    check_range("count", frame.count, "frames", 0, 1e6);
  }
  if (!(load.share() > kWarnedLoad)) return {};
  if (load.share() > kRefusedLoad) {
    throw std::invalid_argument(
        "the process data take " + describe(load) +
        ", at the worst: must be at most 90 %; the remedy: " + remedy(load));
  }
  return "the process data take " + describe(load) +
         ", at the worst: over 70 %, little is left for SDO, EMCY and repeated frames; the "
         "remedy: " +
         remedy(load);
}

}  // namespace ebac::can
