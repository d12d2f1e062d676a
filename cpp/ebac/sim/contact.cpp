#include "ebac/sim/contact.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "ebac/model/port_space.hpp"
#include "ebac/sim/perceived_ripple.hpp"

namespace ebac {

namespace {

using Values = std::span<const double>;

double mean(Values values) {
  double sum = 0;
  for (const double value : values) sum += value;
  return sum / static_cast<double>(values.size());
}

double width(Values values) {
  const auto [low, high] = std::ranges::minmax(values);
  return high - low;
}

/// The row from which on values stay within a band around their rest, their number if the last does
/// not.
std::size_t settling(Values values, double rest, double band) {
  std::size_t i = values.size();
  while (i > 0 && std::abs(values[i - 1] - rest) <= band) --i;
  return i;
}

/// Upward crossings of the rest per second. A crossing counts after a dip of a quarter of the
/// swing, so that noise and encoder counts around the rest do not.
double frequency(Values t, Values x, double rest, double swing) {
  double first = WallContact::kNone;
  double last = WallContact::kNone;
  int cycles = -1;
  bool armed = false;
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (x[i] < rest - swing / 4) armed = true;
    if (!armed || x[i] < rest) continue;
    armed = false;
    // Armed and now at the rest, so the row before exists and lies below it.
    const double share = (rest - x[i - 1]) / (x[i] - x[i - 1]);
    last = t[i - 1] + share * (t[i] - t[i - 1]);
    if (++cycles == 0) first = last;
  }
  return cycles > 0 ? cycles / (last - first) : WallContact::kNone;
}

/// max over t1 < t2 of W(t1) - W(t2) - stored(t1), at least 0: one pass with the best start so far.
double drawn(Values energy, Values stored) {
  double start = -std::numeric_limits<double>::infinity();
  double most = 0;
  for (std::size_t i = 0; i < energy.size(); ++i) {
    most = std::max(most, start - energy[i]);
    start = std::max(start, energy[i] - stored[i]);
  }
  return most;
}

double largest_step(Values values) {
  double largest = 0;
  for (std::size_t i = 1; i < values.size(); ++i) {
    largest = std::max(largest, std::abs(values[i] - values[i - 1]));
  }
  return largest;
}

/// Changes by more than a jump between two rows, both from `first` on.
double jumps_from(std::size_t first, Values values) {
  int jumps = 0;
  for (std::size_t i = first + 1; i < values.size(); ++i) {
    jumps += std::abs(values[i] - values[i - 1]) > kForceJump ? 1 : 0;
  }
  return jumps;
}

/// Root mean square around the mean, in one pass; `near` is a value close to the mean.
double deviation(Values values, double near) {
  double sum = 0;
  double squares = 0;
  for (const double value : values) {
    sum += value - near;
    squares += (value - near) * (value - near);
  }
  const auto rows = static_cast<double>(values.size());
  return std::sqrt(std::max(0.0, squares / rows - sum / rows * (sum / rows)));
}

/// How the force settles and ripples; `still_from` is the row from which on the position is settled,
/// the first of the tail where it is not.
void measure_force(const ContactRecord& r, std::size_t tail, std::size_t still_from,
                   WallContact& c) {
  const std::size_t rows = r.force.size();
  c.force_rest = mean(r.force.subspan(tail));
  const double band = std::max(kForceShare * std::abs(c.force_rest), kForceBand);
  const std::size_t from = settling(r.force, c.force_rest, band);
  if (from <= tail) c.force_settled = r.t[from] - r.t.front();
  const std::size_t settled = std::max(std::min(from, tail), still_from);
  const Values after = r.force.subspan(settled);
  c.ripple = width(after);
  c.ripple_rms = deviation(after, c.force_rest);
  c.jumps = jumps_from(still_from, r.force);
  const double rate = static_cast<double>(rows - 1) / (r.t.back() - r.t.front());
  const auto least = static_cast<std::size_t>(std::min(std::ceil(kRingsLeast * rate), 1e9));
  const std::size_t perceived_from = std::max(kRingsDown * still_from, still_from + least);
  const PerceivedRipple perceived = perceived_ripple(r.force, rate, std::min(perceived_from, tail));
  c.ripple_high = perceived.high;
  c.perceived = perceived.perceived;
}

std::size_t tail_rows(const ContactRecord& r) {
  const auto share =
      static_cast<std::size_t>(std::lround(kTailShare * static_cast<double>(r.x.size())));
  return std::max<std::size_t>(2, share);
}

void check_rows(const ContactRecord& r) {
  const std::size_t rows = r.x.size();
  if (rows < kFewestRows) {
    throw std::invalid_argument("the recording has " + std::to_string(rows) +
                                " rows: a contact needs at least " + std::to_string(kFewestRows));
  }
  const auto refuse_other = [&](Values column) {
    if (column.size() == rows) return;
    throw std::invalid_argument("a column of the recording has " + std::to_string(column.size()) +
                                " rows, its position " + std::to_string(rows));
  };
  for (const Values column : {r.t, r.force}) refuse_other(column);
  for (const Values column : {r.energy, r.stored, r.clamped, r.pull, r.wall}) {
    if (!column.empty()) refuse_other(column);
  }
}

}  // namespace

void WallContact::take_worse(const WallContact& other) {
  if (!(other.swing <= swing)) limit_cycle = other.limit_cycle;
  for (double WallContact::* of :
       {&WallContact::swing, &WallContact::force_swing, &WallContact::force_step,
        &WallContact::most_pull, &WallContact::ripple, &WallContact::ripple_rms,
        &WallContact::ripple_high, &WallContact::jumps, &WallContact::perceived}) {
    this->*of = std::fmax(this->*of, other.*of);
  }
  for (double WallContact::* of : {&WallContact::settled, &WallContact::force_settled}) {
    this->*of = std::max(this->*of, other.*of);  // never, NaN, is the worst
    if (std::isnan(other.*of)) this->*of = kNone;
  }
}

bool touched_at_end(const ContactRecord& r) {
  return std::ranges::any_of(r.wall.last(std::min(tail_rows(r), r.wall.size())),
                             [](double force) { return force != 0; });
}

WallContact measure_contact(const ContactRecord& r) {
  check_rows(r);
  const std::size_t tail = tail_rows(r);
  const Values x = r.x.last(tail);
  WallContact c{.rest = mean(x),
                .swing = width(x),
                .force_swing = width(r.force.last(tail)),
                .peak = std::ranges::max(r.x),
                .force_step = largest_step(r.force)};
  const std::size_t tail_from = r.x.size() - tail;
  std::size_t still_from = tail_from;
  if (c.still()) {
    const std::size_t from = settling(r.x, c.rest, kStillSwing / 2);
    c.settled = r.t[std::min(from, r.t.size() - 1)] - r.t.front();
    still_from = std::min(from, tail_from);
  } else {
    c.limit_cycle = frequency(r.t.last(tail), x, c.rest, c.swing);
  }
  measure_force(r, tail_from, still_from, c);
  if (!r.energy.empty()) c.least_energy = std::ranges::min(r.energy);
  if (!r.energy.empty() && !r.stored.empty()) c.most_drawn = drawn(r.energy, r.stored);
  if (!r.clamped.empty()) c.clamped_share = mean(r.clamped);
  if (!r.pull.empty()) c.most_pull = std::ranges::max(r.pull);
  if (!r.wall.empty()) {
    const auto deepest = static_cast<std::size_t>(std::ranges::max_element(r.x) - r.x.begin());
    if (r.wall[deepest] != 0) c.impact_share = r.force[deepest] / r.wall[deepest];
  }
  return c;
}

namespace {

double stored_in(const Free&, const Axes&) EBAC_RT { return 0; }

double spring(double stiffness, double depth) EBAC_RT {
  return depth > 0 ? 0.5 * stiffness * depth * depth : 0.0;
}

double stored_in(const Wall& wall, const Axes& x) EBAC_RT {
  return spring(wall.stiffness, wall.depth(x));
}

double stored_in(const Disc& disc, const Axes& x) EBAC_RT {
  return spring(disc.stiffness, disc.radius - std::hypot(disc.x - x[0], disc.y - x[1]));
}

double stored_in(const Corner& corner, const Axes& x) EBAC_RT {
  return stored_in(corner.first, x) + stored_in(corner.second, x);
}

/// A world of another kind has a memory: see `StoredEnergy`.
double stored_in(const External&, const Axes&) EBAC_RT { return 0; }

}  // namespace

double stored_energy(const Environment& environment, const Axes& x) EBAC_RT {
  return std::visit([&](const auto& shape) { return stored_in(shape, x); }, environment);
}

double StoredEnergy::at(const Axes& x, double t) EBAC_RT {
  const auto* external = std::get_if<External>(&environment_);
  if (external == nullptr || external->world == nullptr) return stored_energy(environment_, x);
  external->world->contact(PortSpace(kinematics_, x).at(), Axes::Zero(), t);
  return external->world->stored();
}

}  // namespace ebac
