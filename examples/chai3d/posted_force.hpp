#pragma once

#include <algorithm>
#include <ebac/model/world.hpp>
#include <memory>
#include <utility>

#include "exchange.hpp"
#include "force_contact.hpp"

namespace chai {

/// The force that a haptic thread asked for last, as a world of the loop.
///
/// A force belongs to where the handle was; with `stiffness` [N/m] it is rendered as a plane of that stiffness through it,
/// so that a late force changes little. Where nothing new has come for 20 ms it fades within 20 ms: the other program has
/// stopped.
class PostedForce final : public ebac::World {
 public:
  static constexpr double kPatience = 0.02;  // s
  static constexpr double kFading = 0.02;    // s

  PostedForce(std::shared_ptr<Exchange> exchange, double stiffness)
      : exchange_(std::move(exchange)), stiffness_(stiffness) {}

  ebac::ContactForce contact(const ebac::Axes& x, const ebac::Axes& v, double t) EBAC_RT override {
    if (const Asked* newest = exchange_->asked()) {
      asked_ = *newest;
      since_ = t;
    }
    exchange_->moved({x, v});
    const double push = asked_.force.norm();
    if (!(push > 0)) return contact_.of(asked_.force);
    const ebac::Axes normal = asked_.force / push;
    const double now = std::max(0.0, push + stiffness_ * normal.dot(x - asked_.x));
    const double share = std::clamp(1 - (t - since_ - kPatience) / kFading, 0.0, 1.0);
    return contact_.of(share * now * normal);
  }

  /// Shares the mailboxes: one loop at a time.
  std::unique_ptr<ebac::World> fresh() const override {
    return std::make_unique<PostedForce>(exchange_, stiffness_);
  }

 private:
  std::shared_ptr<Exchange> exchange_;
  double stiffness_;
  Asked asked_;
  double since_ = 0;  // s, when it came
  ForceContact contact_;
};

}  // namespace chai
