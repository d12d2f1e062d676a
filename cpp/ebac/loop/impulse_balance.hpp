#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "ebac/core/realtime.hpp"
#include "ebac/model/device.hpp"

namespace ebac {

/// Facts about one axis that its impulse balance rests on, referred to the handle.
struct BalanceFacts {
  double mass = 0.25;      // kg
  double damping = 2;      // N s/m
  double count = 3.07e-5;  // m
  double lag = 1e-3;       // s, of the force sensor and the current loop together
  double unexplained = 2;  // N, friction and weight included
  double dt = 1e-3;        // s

  /// `unexplained` [N] is what the model of the device does not know; `dt` is the sample time [s].
  static BalanceFacts of(const DeviceModel& device, double unexplained, double dt, int axis = 0) {
    const Mechanics& mechanics = device.mechanics;
    const double known = std::max(mechanics.coulomb, mechanics.breakaway) +
                         device.mass(axis) * std::abs(mechanics.gravity);
    return {.mass = device.mass(axis),
            .damping = mechanics.damping,
            .count = device.facts().count,
            .lag = device.sensor.lag + device.drive.current_lag,
            .unexplained = unexplained + known,
            .dt = dt};
  }
};

using AllBalanceFacts = std::array<BalanceFacts, kMaxAxes>;

/// Newton's law over the last `2 ticks`: the second difference of the position over n ticks, times
/// the mass, against the forces under the triangle that belongs to it,
///
///   M (x_k - 2 x_(k-n) + x_(k-2n)) / (n dt)^2 = mean(F_hand - b v - f)
///
/// so no velocity is estimated, and an encoder count weighs 2 M count / (n dt)^2: 0.07 N over 15 ms
/// for the reference device. Constant cost a tick: a triangle is two running sums.
///
/// What the two sides may differ by: half to twice the mass; a tenth of the forces (scale of sensor
/// and motor); all of the damping; the forces' change within a lag and a tick; a position that is
/// half a tick older or newer than it seems; and what the caller leaves unexplained.
class ImpulseBalance {
 public:
  static constexpr int kMostTicks = 64;

  ImpulseBalance() = default;
  ImpulseBalance(const BalanceFacts& facts, int ticks) EBAC_RT : facts_(facts), n_(ticks) {}

  void restart() EBAC_RT {
    known_ = 0;
    still_ = 0;
    others_ = motor_ = slack_ = way_ = 0;
  }

  /// Takes one regular tick: position [m]; force of the hand, now, and its age [N, s]; force of the
  /// motor over the last interval [N].
  void step(double x, double hand, double age, double motor) EBAC_RT {
    const Row last = back(1);
    Row row{.x = x, .hand = hand, .motor = motor};
    if (known_ > 0) {
      row.way = x - last.x;
      row.others = 0.5 * (hand + last.hand) - facts_.damping * row.way / facts_.dt;
      const double change = std::abs(hand - last.hand) + std::abs(motor - last.motor);
      const double speed = std::abs(row.way) / facts_.dt;
      row.slack = 0.5 * (kScale * (std::abs(hand) + std::abs(motor)) + facts_.damping * speed) +
                  change * (facts_.lag + age + facts_.dt) / facts_.dt;
    }
    const Row& one = back(n_);
    const Row& two = back(2 * n_);
    row.others_sum = last.others_sum + row.others - one.others;
    row.motor_sum = last.motor_sum + motor - one.motor;
    others_ += row.others_sum - one.others_sum;
    motor_ += row.motor_sum - one.motor_sum;
    slack_ += row.slack - two.slack;
    way_ += std::abs(row.way) - std::abs(two.way);
    bend_ = x - 2 * one.x + two.x;
    still_ = row.way == 0 ? std::min(still_ + 1, kRows) : 0;
    at_ = (at_ + 1) % kRows;
    row_[static_cast<std::size_t>(at_)] = row;
    ++known_;
  }

  /// Force that motion and forces differ by, beyond all bounds [N]: above 0 where the encoder shows
  /// more motion along +x than the forces explain, 0 where they agree or are not known yet.
  double excess() const EBAC_RT { return excess_over(others_ - motor_); }
  /// Whether they would agree if the motor's force acted the other way round.
  bool agrees_reversed() const EBAC_RT { return excess_over(others_ + motor_) == 0; }
  /// Ticks since the encoder last changed, up to more than twice `ticks`.
  int still() const EBAC_RT { return still_; }
  int ticks() const EBAC_RT { return n_; }

 private:
  static constexpr double kScale = 0.1;
  static constexpr double kLeastMass = 0.5;
  static constexpr double kMostMass = 2;
  static constexpr int kRows = 2 * kMostTicks + 1;

  struct Row {
    double x = 0;           // m
    double way = 0;         // m
    double hand = 0;        // N
    double motor = 0;       // N
    double others = 0;      // N, hand and damping
    double others_sum = 0;  // N, of the last n
    double motor_sum = 0;   // N
    double slack = 0;       // N
  };

  const Row& back(int ticks) const EBAC_RT {
    static constexpr Row kNone{};
    if (ticks > known_) return kNone;
    return row_[static_cast<std::size_t>((at_ + 1 - ticks + kRows) % kRows)];
  }

  double excess_over(double sum) const EBAC_RT {
    if (known_ <= std::int64_t{2} * n_) return 0;
    const double n = n_;
    const double span = n * facts_.dt;
    const double impulse = sum / (n * n);
    const double unsure = 2 * facts_.count + way_ / n;
    const double slack = facts_.unexplained + slack_ / n;
    const double low = (bend_ - unsure) * facts_.mass / (span * span);
    const double high = (bend_ + unsure) * facts_.mass / (span * span);
    const double least = low * (low > 0 ? kLeastMass : kMostMass);
    const double most = high * (high > 0 ? kMostMass : kLeastMass);
    if (least - impulse > slack) return least - impulse - slack;
    if (impulse - most > slack) return most - impulse + slack;
    return 0;
  }

  BalanceFacts facts_{};
  int n_ = 1;
  int at_ = 0;
  std::int64_t known_ = 0;  // ticks
  int still_ = 0;
  double others_ = 0;  // N, sums under the triangle
  double motor_ = 0;   // N
  double slack_ = 0;   // N
  double way_ = 0;     // m
  double bend_ = 0;    // m
  std::array<Row, kRows> row_{};
};

}  // namespace ebac
