#pragma once

#include <array>

#include "ebac/core/fields.hpp"
#include "ebac/sim/recorder.hpp"
#include "ebac/sim/setup.hpp"

namespace ebac {

/// The same hand and device against an ideal wall: continuous, without sampling, delay, encoder or
/// law. A bound that no law can better by much, and the reference for settling.
struct IdealContact {
  double rest = WallContact::kNone;     // m
  double swing = WallContact::kNone;    // m
  double settled = WallContact::kNone;  // s
  double peak = WallContact::kNone;     // m
  bool quiet = false;

  static constexpr auto fields() {
    using F = Field<IdealContact>;
    return std::array{
        F{"rest", &IdealContact::rest, "m",
          "mean position over the last 30 % against an ideal wall"},
        F{"swing", &IdealContact::swing, "m", "position, peak to peak, over the last 30 %"},
        F{"settled", &IdealContact::settled, "s",
          "from when on it stays within 0.125 mm of its rest"},
        F{"peak", &IdealContact::peak, "m", "deepest position of the whole run"},
        F{"quiet", &IdealContact::quiet, "1", "whether it is quiet, as a law's contact is"},
    };
  }
};

/// Measures the first axis. All NaN where the contact has no closed form: another device than
/// ExactPlant covers, another environment than a wall straight across the first axis, a hand that
/// lets go.
IdealContact ideal_contact(const Setup& setup, ContactRecorder& recorder);

}  // namespace ebac
