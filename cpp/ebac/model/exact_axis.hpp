#pragma once

#include <cmath>
#include <cstdint>

#include "ebac/core/realtime.hpp"
#include "ebac/model/axis_truth.hpp"
#include "ebac/model/linear_flow.hpp"

namespace ebac {

/// One rigid axis with a hand on it, in coordinates of the handle.
struct AxisParameters {
  double device_mass = 0.25;    // kg
  double device_damping = 2;    // N s/m
  double coulomb = 0;           // N
  double weight = 0;            // N, along +x
  double carried = 0;           // N, of it, by the motor
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

  double moving_force(const Vector& w) const EBAC_RT;  // m v' while sliding
  double standing_force(
      const Vector& w) const EBAC_RT;  // force that friction must hold while stuck
  double hand_force(const Vector& w) const EBAC_RT;

  void advance_in_parts(Vector w, double u, double target, std::int64_t quanta) EBAC_RT;
  void arrive(Vector w, double u, double load) EBAC_RT;
  bool move(Vector& w, std::int64_t left) EBAC_RT;
  void slide(Vector& w, std::int64_t& left) EBAC_RT;
  bool passes_dip(Vector& w, std::int64_t& left) EBAC_RT;
  void stick(Vector& w, std::int64_t& left) EBAC_RT;
  template <class Holds>
  void flow_while(const LinearFlow& flow, Vector& w, std::int64_t& left, Holds holds) EBAC_RT;
  void account(const Vector& before, const Vector& after, double square, double time) EBAC_RT;

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

// Inline: a whole tick without friction has no event, so it is one step of the flow.

inline double ExactAxis::standing_force(const Vector& w) const EBAC_RT {
  return -p_.hand_stiffness * w[kXi] - w[kPhi] - w[kF];
}

inline double ExactAxis::moving_force(const Vector& w) const EBAC_RT {
  return standing_force(w) - damping_ * w[kV];
}

inline double ExactAxis::hand_force(const Vector& w) const EBAC_RT {
  const bool stuck = p_.coulomb > 0 && direction_ == 0;
  const double a = stuck ? 0.0 : moving_force(w) / mass_;
  return -p_.hand_stiffness * w[kXi] - p_.hand_damping * w[kV] - p_.hand_mass * a;  // eq. (4)
}

inline void ExactAxis::advance(double u, double target, double rate, std::int64_t quanta) EBAC_RT {
  const double load = u - p_.weight;
  Vector w;
  w << truth_.x - target, truth_.v, p_.current_lag > 0 ? truth_.f_motor - u : 0.0, truth_.f_sensor,
      load, rate;
  if (p_.coulomb > 0 || quanta != kQuanta) return advance_in_parts(w, u, target, quanta);
  const LinearFlow::Step& tick = slide_.level(0);
  const Vector next = tick.from(w);
  account(w, next, tick.along(w), tick_);
  truth_.x = next[kXi] + target + rate * tick_;
  arrive(next, u, load);
}

/// The truth after an interval, but for x.
inline void ExactAxis::arrive(Vector w, double u, double load) EBAC_RT {
  w[kF] = load + direction_ * p_.coulomb;
  truth_.v = w[kV];
  truth_.f_motor = w[kPhi] + u;
  truth_.f_hand = hand_force(w);
  truth_.f_sensor = p_.sensor_lag > 0 ? w[kY] : truth_.f_hand;
}

/// Energy of one slide, from the equation of motion times v: int (f_motor v + b v^2 + f_coulomb
/// |v|) = -m d(v^2)/2 - B0 int v^2 - k int xi v + weight dx, with int xi v = d(xi^2)/2 + r int xi,
/// and int xi from the equation of motion itself. What the motor does to carry weight is left out.
inline void ExactAxis::account(const Vector& before, const Vector& after, double square,
                               double time) EBAC_RT {
  const double r = before[kR];
  const double k = p_.hand_stiffness;
  const double dv = after[kV] - before[kV];
  const double dx = after[kXi] - before[kXi] + r * time;
  double spring = 0.5 * k * (after[kXi] * after[kXi] - before[kXi] * before[kXi]);
  if (r != 0) {
    const double lag = p_.current_lag * (before[kPhi] - after[kPhi]);  // int phi
    spring -= r * (mass_ * dv + damping_ * dx + lag + before[kF] * time);
  }
  const double kinetic = 0.5 * mass_ * (after[kV] * after[kV] - before[kV] * before[kV]);
  truth_.energy += (p_.weight - p_.carried) * dx - kinetic - p_.hand_damping * square - spring;
}

}  // namespace ebac
