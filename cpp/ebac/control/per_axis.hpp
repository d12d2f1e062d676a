#pragma once

#include <array>
#include <concepts>
#include <span>

#include "ebac/control/turned_ports.hpp"
#include "ebac/core/concepts.hpp"

namespace ebac {

/// A law for all ports of a device at once: writes `f_cmd` of every axis.
template <class L>
concept AxesController = requires(L law, std::span<Axis> axes, const Touch& touch) {
  typename L::State;
  { law.step(axes, touch) } noexcept;
  { law.reset() } noexcept;
};

/// A scalar law on every direction the world acts in.
template <Controller Law>
class PerAxis {
 public:
  using State = Law::State;
  using Scalar = Law;

  explicit PerAxis(const Law& law) : laws_{law, law, law} {
    static_assert(kMaxAxes == 3);
    reset();
  }

  template <std::size_t N>
  void step(std::span<Axis, N> axes, const Touch& touch) EBAC_RT {
    turned_.step(axes, touch,
                 [this](std::size_t i, const Port& port) EBAC_RT { return laws_[i].step(port); });
  }
  void reset() EBAC_RT {
    for (Law& law : laws_) law.reset();
    turned_ = {};
  }
  /// The gains of `next` from now on; memory, and what the law knows of the device, stay.
  void retune(const Law& next) EBAC_RT
    requires requires(Law law) { law.retune(next); }
  {
    for (Law& law : laws_) law.retune(next);
  }
  const State& state(std::size_t i) const EBAC_RT { return laws_[i].state(); }

 private:
  std::array<Law, kMaxAxes> laws_;
  TurnedPorts turned_{};
};

}  // namespace ebac
