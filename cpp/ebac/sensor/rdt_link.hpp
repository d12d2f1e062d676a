#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <span>

#include "ebac/core/device.hpp"
#include "ebac/model/kinematics.hpp"
#include "ebac/sensor/mounting.hpp"
#include "ebac/sensor/rdt.hpp"
#include "ebac/sensor/scale.hpp"
#include "ebac/sensor/status.hpp"
#include "ebac/sensor/stream_order.hpp"

namespace ebac::sensor {

/// Interprets the packets that reach a client, over any transport: order, status, units, axes,
/// bias. Knows neither sockets nor clocks.
class RdtLink {
 public:
  struct Setup {
    FtScale scale{};
    Mounting mounting{};
    StatusBits bits = StatusBits::of(SensorModel::kNetFt);
    std::array<double, 6> bias{};  // counts, taken as zero
  };

  explicit RdtLink(const Setup& setup) : setup_(setup), bias_(setup.bias) {
    check(setup.scale, "FtScale");
    check_mounting(setup.mounting);
  }

  /// One packet of the sensor: whether it is the newest record now.
  bool take(std::span<const std::uint8_t> bytes) EBAC_RT {
    RdtRecord record;
    if (!decode(bytes, record)) {
      ++malformed_;
      return false;
    }
    const Arrival arrival = order_.take(record.rdt_sequence, record.ft_sequence);
    if (arrival != Arrival::kNewest) return false;
    record_ = record;
    health_ = health(record);
    ++received_;
    if (health_ == SensorStatus::kGood) average();
    return true;
  }

  /// The records after this begin a stream of their own.
  void restart() EBAC_RT { order_.restart(); }

  /// Takes the mean of the next `records` good ones as zero.
  void begin_bias(int records) EBAC_RT {
    sum_ = {};
    left_ = wanted_ = records;
  }
  /// Takes no zero after all.
  void cancel_bias() EBAC_RT { left_ = 0; }
  bool biasing() const EBAC_RT { return left_ > 0; }
  /// The zero of the readings [counts].
  const std::array<double, 6>& bias() const EBAC_RT { return bias_; }

  Axes force() const EBAC_RT {  // N, at the handle
    return turned(record_.force, 0, setup_.scale.counts_per_force);
  }
  Axes torque() const EBAC_RT {  // N m, about the handle's axes
    return turned(record_.torque, 3, setup_.scale.counts_per_torque);
  }
  SensorStatus health() const EBAC_RT { return health_; }
  const RdtRecord& record() const EBAC_RT { return record_; }
  const StreamOrder& order() const EBAC_RT { return order_; }
  std::int64_t received() const EBAC_RT { return received_; }
  std::int64_t malformed() const EBAC_RT { return malformed_ + order_.stray(); }

 private:
  Axes turned(const std::array<std::int32_t, 3>& counts, std::size_t bias,
              double scale) const EBAC_RT {
    const auto value = [&](std::size_t i) EBAC_RT { return (counts[i] - bias_[bias + i]) / scale; };
    return setup_.mounting.to_handle({value(0), value(1), value(2)});
  }

  SensorStatus health(const RdtRecord& record) const EBAC_RT {
    const SensorStatus judged = setup_.bits.judge(record.status);
    const bool beyond =
        full(record.force, setup_.scale.force_range, setup_.scale.counts_per_force) ||
        full(record.torque, setup_.scale.torque_range, setup_.scale.counts_per_torque);
    return judged == SensorStatus::kGood && beyond ? SensorStatus::kSaturated : judged;
  }
  /// Whether a count is at the end of its range, or at that of its 32 bits.
  static bool full(const std::array<std::int32_t, 3>& counts, double range, double scale) EBAC_RT {
    constexpr double kEnd = 2147483647;
    const double most = range > 0 ? std::min(range * scale, kEnd) : kEnd;
    return std::ranges::any_of(counts,
                               [&](std::int32_t c) { return std::abs(double{1} * c) >= most; });
  }

  void average() EBAC_RT {
    if (left_ == 0) return;
    for (std::size_t i = 0; i < 3; ++i) {
      sum_[i] += record_.force[i];
      sum_[3 + i] += record_.torque[i];
    }
    if (--left_ > 0) return;
    for (std::size_t i = 0; i < 6; ++i) bias_[i] = sum_[i] / wanted_;
  }

  Setup setup_;
  StreamOrder order_;
  RdtRecord record_{};
  SensorStatus health_ = SensorStatus::kGood;
  std::int64_t received_ = 0;
  std::int64_t malformed_ = 0;
  std::array<double, 6> bias_;   // counts
  std::array<double, 6> sum_{};  // counts
  int wanted_ = 0;
  int left_ = 0;
};

}  // namespace ebac::sensor
