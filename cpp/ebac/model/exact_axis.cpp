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
      stick_(parameters.coulomb > 0 ? LinearFlow(sticking_matrix(parameters), velocity_row(), tick)
                                    : slide_) {}  // without friction it never is

void ExactAxis::take_over(const ExactAxis& other) EBAC_RT {
  truth_ = other.truth_;
  direction_ = other.direction_;
}

/// The same with events in it, or over a part of a tick.
void ExactAxis::advance_in_parts(Vector w, double u, double target, std::int64_t quanta) EBAC_RT {
  const double time = tick_ * static_cast<double>(quanta) / static_cast<double>(kQuanta);
  const double load = w[kF];
  const double travel = w[kR] * time;
  const bool moved = move(w, quanta);
  if (moved) truth_.x = w[kXi] + target + travel;  // else not even its last bit changes
  arrive(w, u, load);
}

/// Segment by segment, sliding or stuck; whether it moved at all.
bool ExactAxis::move(Vector& w, std::int64_t left) EBAC_RT {
  if (p_.coulomb == 0) return slide(w, left), true;
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

/// Slides until the time is up or v = 0; direction_ is then the next direction.
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
  account(before, w, square_,
          tick_ * static_cast<double>(quanta - left) / static_cast<double>(kQuanta));
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
  square_ += quantum.along(w);
  w = next;
  --left;
  return true;
}

/// Sticks until the time is up or friction can no longer hold; direction_ is then that of the slip.
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
      square_ += step.along(w);
      w = next;
      left -= size;
    }
  }
}

}  // namespace ebac
