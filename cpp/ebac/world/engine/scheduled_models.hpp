#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <stdexcept>
#include <utility>

#include "ebac/core/fields.hpp"
#include "ebac/model/noise.hpp"
#include "ebac/world/engine/engine.hpp"

namespace ebac::world {

/// When an engine is called, and when its answers arrive.
struct EngineTiming {
  double rate = 60;       // Hz
  double compute = 0;     // s
  double jitter = 0;      // s
  std::int64_t seed = 1;  // of the jitter

  static constexpr auto fields() {
    using F = Field<EngineTiming>;
    return std::array{
        F{"rate", &EngineTiming::rate, "Hz", "calls of the engine", 1, 1000},
        F{"compute", &EngineTiming::compute, "s", "from a call to its answer, at least", 0, 1},
        F{"jitter", &EngineTiming::jitter, "s", "more than that, by up to so much at random", 0, 1},
        F{"seed", &EngineTiming::seed, "1", "of the jitter", 0, 9e15},
    };
  }
};

/// An answer, and where the handle was when it was asked for.
struct Answer {
  LocalModel model;
  Axes x = Axes::Zero();
};

/// Answers of an engine in simulated time: called in the first tick at or after each instant, each answer held back until it
/// is due. Answers do not overtake each other.
class ScheduledModels {
 public:
  ScheduledModels(std::unique_ptr<Engine> engine, const EngineTiming& timing)
      : engine_(std::move(engine)),
        timing_(timing),
        random_(static_cast<std::uint64_t>(timing.seed)) {
    if ((timing.compute + timing.jitter) * timing.rate > kMost - 2)
      throw std::invalid_argument(
          "compute + jitter: more than 62 answers would be on their way; give a lower rate or less "
          "time");
  }
  ScheduledModels(const ScheduledModels& other)
      : ScheduledModels(other.engine_->fresh(), other.timing_) {}
  ScheduledModels& operator=(const ScheduledModels&) = delete;

  /// In the tick at time `t`: the newest answer that has become due, or nullptr.
  const Answer* take(const Axes& x, const Axes& v, double t) EBAC_RT {
    if (t + kSameInstant >= static_cast<double>(calls_) / timing_.rate) call(x, v, t);
    const Answer* newest = nullptr;
    while (waiting_ > 0 && on_way_[first_].due <= t + kSameInstant) {
      newest = &on_way_[first_].answer;
      first_ = (first_ + 1) % kMost;
      --waiting_;
    }
    return newest;
  }

 private:
  struct Due {
    Answer answer;
    double due = 0;  // s
  };

  void call(const Axes& x, const Axes& v, double t) EBAC_RT {
    calls_ = static_cast<std::int64_t>(std::floor((t + kSameInstant) * timing_.rate)) + 1;
    if (waiting_ == kMost) return;
    const double later = 0.5 * (1 + random_.symmetric()) * timing_.jitter;
    last_due_ = std::max(last_due_, t + timing_.compute + later);
    on_way_[(first_ + waiting_) % kMost] = {{engine_->answer(x, v, t), x}, last_due_};
    ++waiting_;
  }

  static constexpr std::size_t kMost = 64;
  static constexpr double kSameInstant = 1e-7;  // s

  std::unique_ptr<Engine> engine_;
  EngineTiming timing_;
  Noise random_;
  std::array<Due, kMost> on_way_{};
  std::size_t first_ = 0;
  std::size_t waiting_ = 0;
  std::int64_t calls_ = 0;
  double last_due_ = 0;  // s
};

}  // namespace ebac::world
