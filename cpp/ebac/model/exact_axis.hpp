#pragma once

#include <cstdint>

#include "ebac/core/realtime.hpp"
#include "ebac/model/axis_truth.hpp"
#include "ebac/model/linear_flow.hpp"

namespace ebac {

/// One rigid axis with a hand on it, told at the handle.
struct AxisParameters {
  double device_mass = 0.25;    // kg
  double device_damping = 2;    // N s/m
  double coulomb = 0;           // N
  double weight = 0;            // N, along +x
  double current_lag = 3e-4;    // s
  double sensor_lag = 8e-4;     // s
  double hand_mass = 0.15;      // kg
  double hand_damping = 6;      // N s/m
  double hand_stiffness = 300;  // N/m
};

/// Hand and handle between two events are linear, so a tick has a closed form (docs: the plant):
///
///   m v'  = -k xi - b v - phi - F         xi = x - X0,  X0' = r,  phi = f_motor - u
///   phi'  = -phi / current_lag            F = u + friction - weight
///   y'    = (f_hand - y) / sensor_lag
///
/// with m = M_h + M_0, b = B_h + B_0, k = K_0. Coulomb friction is a constant inside a segment; the
/// only event is v = 0, found to 2^-20 of a tick by bisection over the dyadic steps of the flow.
class ExactAxis {
 public:
  ExactAxis(const AxisParameters& parameters, double tick);

  /// Moves by `quanta` of 2^-20 tick under the motor force `u` [N] and a target that starts at
  /// `target` [m] and moves at `rate` [m/s].
  void advance(double u, double target, double rate, std::int64_t quanta) EBAC_RT;

  /// Puts the axis where another one is: the hand let go, the parameters changed.
  void take_over(const ExactAxis& other) EBAC_RT;

  const AxisTruth& truth() const EBAC_RT { return truth_; }

  /// Entries of w: xi, v, phi, y, F, r.
  enum Index { kXi, kV, kPhi, kY, kF, kR };

  /// The flow of w while the axis slides.
  const LinearFlow& sliding() const EBAC_RT { return slide_; }

 private:
  using Vector = LinearFlow::Vector;

  double moving_force(const Vector& w) const EBAC_RT;    // m v' while sliding
  double standing_force(const Vector& w) const EBAC_RT;  // what friction must hold while stuck
  double hand_force(const Vector& w) const EBAC_RT;

  bool slide_and_stick(Vector& w, std::int64_t left) EBAC_RT;
  void slide(Vector& w, std::int64_t& left) EBAC_RT;
  bool passes_dip(Vector& w, std::int64_t& left) EBAC_RT;
  void stick(Vector& w, std::int64_t& left) EBAC_RT;
  template <class Holds>
  void flow_while(const LinearFlow& flow, Vector& w, std::int64_t& left, Holds holds) EBAC_RT;
  void account(const Vector& before, const Vector& after, double time) EBAC_RT;

  AxisParameters p_;
  double mass_;
  double damping_;
  double tick_;
  LinearFlow slide_;
  LinearFlow stick_;
  AxisTruth truth_{};
  double direction_ = 0;  // of sliding: -1, +1, or 0 while stuck
  double square_ = 0;     // int v^2 dt over the current slide
};

}  // namespace ebac
