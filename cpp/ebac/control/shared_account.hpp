#pragma once

#include <array>
#include <cstddef>

#include "ebac/core/sample.hpp"
#include "ebac/model/contact_force.hpp"

namespace ebac {

/// The accounts of directions that turn, as one: what is paid along one direction is given back along another. So it is
/// where several surfaces share the push, and where a hand slides around a body: it pays across the push, for the device's
/// damping, and what the late force gives out is charged along it.
///
/// What all hold beyond their reserves is where the force is, by its square. What they lack of them is lacking in each:
/// together they lend about as much as one.
class SharedAccount {
 public:
  /// Of the first `axes` of `laws`, where they have accounts.
  template <class Law>
  void share(std::array<Law, kMaxAxes>& laws, std::size_t axes,
             const ContactForce& contact) EBAC_RT {
    if constexpr (requires(Law law) { law.settle(law.surplus()); }) {
      for (std::size_t i = 0; i < axes; ++i) surplus_ += laws[i].surplus() - shown_[i];
      const double square = contact.force.squaredNorm();
      for (std::size_t i = 0; i < axes; ++i) {
        const double along = contact.along[static_cast<Eigen::Index>(i)];
        if (square > 0) laws[i].settle(surplus_ > 0 ? surplus_ * along * along / square : surplus_);
        shown_[i] = laws[i].surplus();
      }
    }
  }

 private:
  double surplus_ = 0;                    // J, of all
  std::array<double, kMaxAxes> shown_{};  // J, of each
};

}  // namespace ebac
