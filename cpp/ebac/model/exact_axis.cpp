#include "ebac/model/exact_axis.hpp"

#include <cmath>

namespace ebac {

namespace {

using enum ExactAxis::Index;

LinearFlow::Vector velocity_row() { return LinearFlow::Vector::Unit(kV); }

/// Rows common to both motions: the lags of current loop and sensor, given how f_hand follows from
/// w.
LinearFlow::Matrix with_lags(LinearFlow::Matrix a, const AxisParameters& p,
                             const LinearFlow::Vector& hand_row) {
  a(kXi, kR) = -1;
  if (p.current_lag > 0) a(kPhi, kPhi) = -1 / p.current_lag;
  if (p.sensor_lag > 0) {
    a.row(kY) = hand_row.transpose() / p.sensor_lag;
    a(kY, kY) -= 1 / p.sensor_lag;
  }
  return a;
}

LinearFlow::Matrix sliding_matrix(const AxisParameters& p) {
  const double m = p.device_mass + p.hand_mass;
  LinearFlow::Matrix a = LinearFlow::Matrix::Zero();
  a(kXi, kV) = 1;
  a(kV, kXi) = -p.hand_stiffness / m;
  a(kV, kV) = -(p.device_damping + p.hand_damping) / m;
  a(kV, kPhi) = a(kV, kF) = -1 / m;
  LinearFlow::Vector hand_row = -p.hand_mass * a.row(kV).transpose();  // eq. (4), (5)
  hand_row[kXi] -= p.hand_stiffness;
  hand_row[kV] -= p.hand_damping;
  return with_lags(a, p, hand_row);
}

LinearFlow::Matrix sticking_matrix(const AxisParameters& p) {
  return with_lags(LinearFlow::Matrix::Zero(), p,
                   -p.hand_stiffness * LinearFlow::Vector::Unit(kXi));
}

}  // namespace

ExactAxis::ExactAxis(const AxisParameters& parameters, double tick)
    : p_(parameters),
      mass_(parameters.device_mass + parameters.hand_mass),
      damping_(parameters.device_damping + parameters.hand_damping),
      tick_(tick),
      slide_(sliding_matrix(parameters), velocity_row(), tick),
      stick_(sticking_matrix(parameters), velocity_row(), tick) {}

void ExactAxis::take_over(const ExactAxis& other) EBAC_RT {
  truth_ = other.truth_;
  direction_ = other.direction_;
}

double ExactAxis::standing_force(const Vector& w) const EBAC_RT {
  return -p_.hand_stiffness * w[kXi] - w[kPhi] - w[kF];
}

double ExactAxis::moving_force(const Vector& w) const EBAC_RT {
  return standing_force(w) - damping_ * w[kV];
}

double ExactAxis::hand_force(const Vector& w) const EBAC_RT {
  const bool stuck = p_.coulomb > 0 && direction_ == 0;
  const double a = stuck ? 0.0 : moving_force(w) / mass_;
  return -p_.hand_stiffness * w[kXi] - p_.hand_damping * w[kV] - p_.hand_mass * a;  // eq. (4)
}

void ExactAxis::advance(double u, double target, double rate, std::int64_t quanta) EBAC_RT {
  const double load = u - p_.weight;
  const double time = tick_ * static_cast<double>(quanta) / static_cast<double>(kQuanta);
  Vector w;
  w << truth_.x - target, truth_.v, p_.current_lag > 0 ? truth_.f_motor - u : 0.0, truth_.f_sensor,
      load, rate;
  if (p_.coulomb == 0) {
    std::int64_t left = quanta;
    slide(w, left);
    truth_.x = w[kXi] + target + rate * time;
  } else if (slide_and_stick(w, quanta)) {
    truth_.x = w[kXi] + target + rate * time;  // else not even the last bit of x changes
  }
  w[kF] = load + direction_ * p_.coulomb;
  truth_.v = w[kV];
  truth_.f_motor = w[kPhi] + u;
  truth_.f_hand = hand_force(w);
  truth_.f_sensor = p_.sensor_lag > 0 ? w[kY] : truth_.f_hand;
}

/// Segment by segment, sliding or stuck; whether it moved at all.
bool ExactAxis::slide_and_stick(Vector& w, std::int64_t left) EBAC_RT {
  constexpr int kMostEvents = 64;  // a rigid axis has one or two in a tick
  const double load = w[kF];
  bool moved = false;
  for (int event = 0; left > 0 && event < kMostEvents; ++event) {
    w[kF] = load + direction_ * p_.coulomb;
    if (direction_ == 0) {
      stick(w, left);
    } else {
      slide(w, left);
      moved = true;
    }
  }
  flow_while(stick_, w, left, [](const Vector&, const Vector&) EBAC_RT { return true; });
  return moved;
}

/// Slides until the time is up or v = 0; then direction_ says what comes next.
void ExactAxis::slide(Vector& w, std::int64_t& left) EBAC_RT {
  const Vector before = w;
  const std::int64_t quanta = left;
  const double s = direction_;
  square_ = 0;
  const auto slides = [&](const Vector& from, const Vector& to) EBAC_RT {
    if (p_.coulomb == 0) return true;
    const bool dips = moving_force(from) * s < 0 && moving_force(to) * s > 0;
    return to[kV] * s >= 0 && !dips;
  };
  flow_while(slide_, w, left, slides);
  while (left > 0 && passes_dip(w, left)) flow_while(slide_, w, left, slides);
  account(before, w, tick_ * static_cast<double>(quanta - left) / static_cast<double>(kQuanta));
  if (left > 0) {
    w[kV] = 0;
    w[kF] -= s * p_.coulomb;
    const double f = standing_force(w);
    direction_ = std::abs(f) <= p_.coulomb ? 0.0 : std::copysign(1.0, f);
  }
}

/// A dip of the speed that ends above zero fails the test of `slide` down to one quantum. Takes
/// that quantum; false when it does end in a stop.
bool ExactAxis::passes_dip(Vector& w, std::int64_t& left) EBAC_RT {
  const LinearFlow::Step& quantum = slide_.level(kQuantaBits);
  const Vector next = quantum.from(w);
  if (!(next[kV] * direction_ > 0)) return false;
  square_ += w.dot(quantum.square * w);
  w = next;
  --left;
  return true;
}

/// Stays until the time is up or friction can no longer hold; then direction_ says where to.
void ExactAxis::stick(Vector& w, std::int64_t& left) EBAC_RT {
  const auto push = [&](const Vector& z) EBAC_RT {  // rate of the standing force
    const double lag = p_.current_lag > 0 ? z[kPhi] / p_.current_lag : 0.0;
    return p_.hand_stiffness * z[kR] + lag;
  };
  if (std::abs(standing_force(w)) <= p_.coulomb) {
    flow_while(stick_, w, left, [&](const Vector& from, const Vector& to) EBAC_RT {
      return std::abs(standing_force(to)) <= p_.coulomb && push(from) * push(to) >= 0;
    });
    if (left > 0) {  // one quantum on, to stand clearly beyond the edge
      w = stick_.level(kQuantaBits).from(w);
      --left;
    }
  }
  const double f = standing_force(w);
  if (std::abs(f) > p_.coulomb) direction_ = std::copysign(1.0, f);
}

/// Follows `flow` for `left` quanta as long as `holds(from, to)`; stops less than a quantum before
/// it fails.
template <class Holds>
void ExactAxis::flow_while(const LinearFlow& flow, Vector& w, std::int64_t& left,
                           Holds holds) EBAC_RT {
  for (int j = 0; j <= kQuantaBits && left > 0; ++j) {
    const std::int64_t size = kQuanta >> j;
    const LinearFlow::Step& step = flow.level(j);
    while (left >= size) {
      const Vector next = step.from(w);
      if (!holds(w, next)) break;
      square_ += w.dot(step.square * w);
      w = next;
      left -= size;
    }
  }
}

/// Energy of one slide, from the equation of motion times v: int (f_motor v + b v^2 + f_coulomb
/// |v|) = -m d(v^2)/2 - B0 int v^2 - k int xi v + weight dx, with int xi v = d(xi^2)/2 + r int xi,
/// and int xi from the equation of motion itself.
void ExactAxis::account(const Vector& before, const Vector& after, double time) EBAC_RT {
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
  truth_.energy += p_.weight * dx - kinetic - p_.hand_damping * square_ - spring;
}

}  // namespace ebac
