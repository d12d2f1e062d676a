#pragma once

#include <algorithm>
#include <array>
#include <span>

#include "ebac/core/realtime.hpp"

namespace ebac::can {

/// Compares the torque a drive reports with the commanded torques of the last ticks, all in
/// thousandths of the rated torque. A torque between the least and the largest of them and zero is
/// right: it lags behind, or the drive limits it. Any other is not the loop's: an offset, a wrong
/// sign, another master.
class TorqueWatch {
 public:
  static constexpr int kMostTicks = 128;

  /// `ticks`, 1 to kMostTicks: the longest lag, and how long a torque may differ.
  TorqueWatch(int ticks, int tolerance) EBAC_RT : ticks_(ticks), tolerance_(tolerance) {}

  void start() EBAC_RT {
    asked_ = {};
    score_ = 0;
  }
  /// A tick's command.
  void ask(int torque) EBAC_RT {
    at_ = (at_ + 1) % ticks_;
    asked_[static_cast<std::size_t>(at_)] = torque;
  }
  /// A tick's answer. One that differs counts twice as much as one that agrees: a torque that is
  /// another's in every second tick is found too.
  void answer(int torque) EBAC_RT {
    const auto asked = std::span(asked_).first(static_cast<std::size_t>(ticks_));
    const int low = std::min(0, *std::ranges::min_element(asked));
    const int high = std::max(0, *std::ranges::max_element(asked));
    const int room = tolerance_ + std::max(-low, high) / kOvershoot;
    const bool agrees = low - room <= torque && torque <= high + room;
    score_ = agrees ? std::max(0, score_ - 1) : std::min(score_ + 2, kMostScore);
  }
  bool differs() const EBAC_RT { return score_ >= 2 * ticks_; }

 private:
  static constexpr int kMostScore = 1'000'000;  // far more than differs
  static constexpr int kOvershoot = 10;         // a tenth: of a current loop, indicative

  int ticks_;
  int tolerance_;
  int at_ = 0;
  int score_ = 0;
  std::array<int, kMostTicks> asked_{};
};

}  // namespace ebac::can
