#include "ebac/gastroscope/driven_scope.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "ebac/core/check.hpp"

namespace ebac::gastroscope {

namespace {

class GroupLoad final : public DrivenMachine {
 public:
  GroupLoad(std::shared_ptr<DrivenScope> scope, std::size_t group)
      : scope_(std::move(scope)), group_(group) {}

  std::array<double, kMaxAxes> meet(const std::array<double, kMaxAxes>& x,
                                    double elapsed) EBAC_RT override {
    return scope_->meet(group_, x, elapsed);
  }

 private:
  std::shared_ptr<DrivenScope> scope_;
  std::size_t group_;
};

}  // namespace

DrivenScope::DrivenScope(const ScopeParams& scope, std::shared_ptr<const Lumen> lumen, double start,
                         const Gears& gears)
    : params_(checked(scope, "Scope")),
      lumen_(std::move(lumen)),
      slave_(scope, *lumen_, start),
      base_(slave_.insertion()),
      gears_(checked(gears, "Gears").each()) {
  move(0);
}

std::shared_ptr<DrivenMachine> DrivenScope::load(std::shared_ptr<DrivenScope> scope,
                                                 std::size_t group) {
  return std::make_shared<GroupLoad>(std::move(scope), group);
}

std::array<double, kMaxAxes> DrivenScope::meet(std::size_t group,
                                               const std::array<double, kMaxAxes>& x,
                                               double elapsed) EBAC_RT {
  const std::size_t first = 2 * group;
  for (std::size_t i = 0; i < 2; ++i) x_[first + i].store(x[i], std::memory_order_relaxed);
  if (group == 0) move(std::min(elapsed, kLongest));
  return {load_[first].load(std::memory_order_relaxed),
          load_[first + 1].load(std::memory_order_relaxed), 0};
}

void DrivenScope::move(double elapsed) EBAC_RT {
  std::array<double, 4> at{};
  for (std::size_t i = 0; i < at.size(); ++i) {
    at[i] = gears_[i] * x_[i].load(std::memory_order_relaxed);
  }
  const Command motors{base_ + at[0], at[1], at[2], at[3]};
  const int steps = std::max(1, static_cast<int>(std::ceil(elapsed / kStep)));
  double push = 0;
  for (int i = 0; i < steps && elapsed > 0; ++i) {
    t_ += elapsed / steps;
    push = slave_.carry(motors, t_, elapsed / steps).push;
  }
  // What the tendons pull with: at rest, what the wall pushes with.
  const Bend held = slave_.pulled();
  const double k = params_.bend_stiffness;
  const std::array<double, 4> load{push, 0, k * (held.x - slave_.bend().x),
                                   k * (held.y - slave_.bend().y)};
  for (std::size_t i = 0; i < load.size(); ++i) {
    load_[i].store(gears_[i] * load[i], std::memory_order_relaxed);
  }
  const auto put = [this](std::size_t i, double value)
                       EBAC_RT { report_[i].store(value, std::memory_order_relaxed); };
  const auto most = [&](std::size_t i, double value) EBAC_RT {
    put(i, std::max(value, report_[i].load(std::memory_order_relaxed)));
  };
  put(0, t_);
  put(1, slave_.place());
  put(2, slave_.inserted());
  put(3, slave_.tip_force());
  most(4, slave_.section_force());
  most(5, slave_.tube_force());
}

ScopeReport DrivenScope::report() const {
  const auto get = [this](std::size_t i) { return report_[i].load(std::memory_order_relaxed); };
  return {get(0), get(1), get(2), get(3), get(4), get(5)};
}

}  // namespace ebac::gastroscope
