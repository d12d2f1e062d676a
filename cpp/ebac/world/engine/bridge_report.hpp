#pragma once

#include <algorithm>
#include <atomic>
#include <cstdint>

#include "ebac/core/realtime.hpp"

namespace ebac::world {

/// How an engine served a run. Written by the tick, read by anybody at any time.
class BridgeReport {
 public:
  std::int64_t models() const EBAC_RT { return models_.load(kRelaxed); }
  /// Oldest model that was rendered [s].
  double oldest() const EBAC_RT { return oldest_.load(kRelaxed); }
  /// Time in which the force was faded because the model was too old [s].
  double faded() const EBAC_RT { return faded_.load(kRelaxed); }
  /// When that began for the first time [s]; below 0: never.
  double faded_at() const EBAC_RT { return faded_at_.load(kRelaxed); }
  /// Energy that changes of the model can have given to the handle [J].
  double given() const EBAC_RT { return given_.load(kRelaxed); }
  /// Energy that the engine's own motion of the surface can have given [J].
  double moved() const EBAC_RT { return moved_.load(kRelaxed); }

  void arrived() EBAC_RT { models_.store(models() + 1, kRelaxed); }
  void rendered(double age, double gain, double t, double dt) EBAC_RT {
    oldest_.store(std::max(oldest(), age), kRelaxed);
    if (gain >= 1) return;
    faded_.store(faded() + dt, kRelaxed);
    if (faded_at() < 0) faded_at_.store(t, kRelaxed);
  }
  void energies(double given, double moved) EBAC_RT {
    given_.store(given, kRelaxed);
    moved_.store(moved, kRelaxed);
  }

 private:
  static constexpr auto kRelaxed = std::memory_order_relaxed;

  std::atomic<std::int64_t> models_{0};
  std::atomic<double> oldest_{0};
  std::atomic<double> faded_{0};
  std::atomic<double> faded_at_{-1};
  std::atomic<double> given_{0};
  std::atomic<double> moved_{0};
};

}  // namespace ebac::world
