#pragma once

#include <array>
#include <span>
#include <utility>

#include "ebac/core/concepts.hpp"

namespace ebac {

/// A scalar law on every port.
template <Controller Law>
class PerAxis {
 public:
  using State = Law::State;

  explicit PerAxis(const Law& law) : laws_{law, law, law} {
    static_assert(kMaxAxes == 3);
    reset();
  }

  void step(std::span<Axis> axes) EBAC_RT {
    for (std::size_t i = 0; i < axes.size(); ++i) {
      axes[i].port.f_cmd = laws_[i].step(axes[i].port);
    }
  }
  void reset() EBAC_RT {
    for (Law& law : laws_) law.reset();
  }
  const State& state(std::size_t i) const EBAC_RT { return laws_[i].state(); }

 private:
  std::array<Law, kMaxAxes> laws_;
};

}  // namespace ebac
