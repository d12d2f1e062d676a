#include "ebac/gastroscope/lumen.hpp"

#include <algorithm>
#include <array>
#include <numbers>
#include <stdexcept>
#include <string>

#include "ebac/core/check.hpp"
#include "ebac/core/six_digits.hpp"
#include "ebac/world/solid.hpp"

namespace ebac::gastroscope {

namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kWave = 0.02;  // m, half of the length of a peristaltic wave
constexpr double kLeastRadius = 1e-3, kMostRadius = 1;  // m, of a line of the user's own
constexpr double kLeastTurned = 0.2;  // of a length along the centre line, at the inside of a turn

/// A part of the lumen that turns evenly in a plane: 0 towards the camera's right, pi/2 down.
struct Part {
  double length, turn, plane, radius_in, radius_out, bulge;
};

std::array<Part, 8> parts_of(const PatientParams& p) {
  const double half = 0.5 * p.oesophagus;
  return {Part{p.mouth, 0, 0, p.pharynx_radius, p.pharynx_radius, 0},
          Part{p.pharynx, p.throat_turn, 0.5 * kPi, p.pharynx_radius, p.pharynx_radius, 0},
          Part{half, 0.2, 0, p.oesophagus_radius, p.oesophagus_radius, 0},
          Part{half, 0.2, kPi, p.oesophagus_radius, p.oesophagus_radius, 0},
          Part{p.cardia, p.cardia_turn, 0, p.cardia_radius, p.cardia_radius, 0},
          Part{p.stomach, p.stomach_turn, 0.9 * kPi, p.cardia_radius, p.pylorus_radius,
               p.stomach_radius},
          Part{p.pylorus, 0.2, kPi, p.pylorus_radius, p.pylorus_radius, 0},
          Part{p.bulb, 0.3, kPi, p.pylorus_radius, p.pylorus_radius, 2 * p.pylorus_radius}};
}

double radius_in(const Part& part, double u) {
  const double straight = part.radius_in + u * (part.radius_out - part.radius_in);
  return straight + std::max(part.bulge - straight, 0.0) * std::sqrt(std::sin(kPi * u));
}

/// One in the middle, zero from 1 on, smooth in between.
double bump(double x) EBAC_RT {
  const double rest = std::max(1 - x * x, 0.0);
  return rest * rest;
}

double smooth_step(double x) EBAC_RT {
  const double u = std::clamp(x, 0.0, 1.0);
  return u * u * (3 - 2 * u);
}

Landmarks landmarks_of(const PatientParams& p) {
  Landmarks l;
  l.oesophagus = p.mouth + p.pharynx;
  l.cardia = l.oesophagus + p.oesophagus;
  l.stomach = l.cardia + p.cardia;
  l.pylorus = l.stomach + p.stomach;
  l.behind = l.pylorus + p.pylorus;
  l.end = l.behind + p.bulb;
  return l;
}

world::Distance wall_at(const world::Solid& wall, const Vec& x) EBAC_RT {
  return wall.distance({x.x, x.y, x.z});
}

}  // namespace

Lumen::Lumen(const PatientParams& params)
    : params_(checked(params, "Patient")), landmarks_(landmarks_of(params)) {
  // From the teeth backwards; the camera's down is towards the feet, its right the patient's left.
  Frame frame{{0, 1, 0}, {0, 0, -1}, {-1, 0, 0}};
  Vec at{};
  for (const Part& part : parts_of(params)) {
    const auto steps = std::max(1L, std::lround(part.length / kStep));
    const double length = part.length / static_cast<double>(steps);
    const double angle = part.turn / static_cast<double>(steps);
    const double c = std::cos(part.plane), s = std::sin(part.plane);
    for (long i = 0; i < steps; ++i) {
      const double u = (static_cast<double>(i) + 0.5) / static_cast<double>(steps);
      stations_.push_back({.at = at, .frame = frame, .radius = radius_in(part, u)});
      at += length * frame.z;
      const Vec side = c * frame.x + s * frame.y;
      frame = look_along(frame, std::cos(angle) * frame.z + std::sin(angle) * side);
    }
  }
  stations_.push_back({.at = at, .frame = frame, .radius = stations_.back().radius});
  for (int pass = 0; pass < 4; ++pass) {  // so that no radius changes in a step
    double before = stations_.front().radius;
    for (std::size_t i = 1; i + 1 < stations_.size(); ++i) {
      const double own = stations_[i].radius;
      stations_[i].radius = 0.25 * (before + 2 * own + stations_[i + 1].radius);
      before = own;
    }
  }
  finish();
}

Lumen::Lumen(const PatientParams& params, const std::vector<Vec>& points,
             const std::vector<double>& radii, std::shared_ptr<const world::Solid> wall)
    : params_(checked(params, "Patient")),
      landmarks_(landmarks_of(params)),
      wall_(std::move(wall)) {
  if (points.size() < 2 || points.size() != radii.size()) {
    throw std::invalid_argument("Lumen: " + std::to_string(points.size()) + " points and " +
                                std::to_string(radii.size()) +
                                " radii: needs two points or more, and a radius for each");
  }
  for (std::size_t i = 0; i < radii.size(); ++i) {
    if (radii[i] >= kLeastRadius && radii[i] <= kMostRadius) continue;
    throw std::invalid_argument("Lumen.radii[" + std::to_string(i) + "] = " + six_digits(radii[i]) +
                                " m: must lie in [" + six_digits(kLeastRadius) + ", " +
                                six_digits(kMostRadius) + "] m");
  }
  Frame frame =
      look_along({{0, 1, 0}, {0, 0, -1}, {-1, 0, 0}}, unit(points[1] - points[0], {-1, 0, 0}));
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (i + 1 < points.size()) {
      const Vec way = points[i + 1] - points[i];
      if (!(norm(way) >= kStep)) {
        throw std::invalid_argument("Lumen: points " + std::to_string(i) + " and " +
                                    std::to_string(i + 1) + " are less than 5 mm apart");
      }
      frame = look_along(frame, unit(way, frame.z));
    }
    stations_.push_back({.at = points[i], .frame = frame, .radius = radii[i]});
  }
  finish();
}

void Lumen::finish() {
  double s = 0;
  for (std::size_t i = 0; i + 1 < stations_.size(); ++i) {
    Station& station = stations_[i];
    const Vec way = stations_[i + 1].at - station.at;
    station.s = s;
    station.length = norm(way);
    station.ahead = (1 / station.length) * way;
    const double from = landmarks_.oesophagus, to = landmarks_.cardia;
    station.breathes = smooth_step((s - from) / (to - from));
    s += station.length;
  }
  const Station& before = stations_[stations_.size() - 2];
  Station& last = stations_.back();
  last.s = s;
  last.ahead = before.ahead;
  last.length = before.length;
  last.breathes = before.breathes;
  landmarks_.end = s;
  stations_.front().along = stations_.front().ahead;
  last.along = last.ahead;
  for (std::size_t i = 1; i + 1 < stations_.size(); ++i) {
    const Station &back = stations_[i - 1], &next = stations_[i + 1];
    Station& here = stations_[i];
    here.along = unit(back.ahead + here.ahead, here.ahead);
    const double from = (here.radius - back.radius) / back.length;
    const double to = (next.radius - here.radius) / here.length;
    here.widens = from * to > 0 ? 2 * from * to / (from + to) : 0;  // so that nothing overshoots
  }
}

Lumen::Spot Lumen::spot(double s) const EBAC_RT {
  std::size_t i = 0;
  double rest = std::max(s, 0.0);
  while (i + 2 < stations_.size() && rest > stations_[i].length) rest -= stations_[i++].length;
  return {i, std::min(rest / stations_[i].length, 1.0)};
}

/// Share of the displacement of the stomach as a bag.
double Lumen::moves(double s) const EBAC_RT {
  const double soft = 0.03;  // m, over which the bag hangs on its two ends
  return smooth_step((s - landmarks_.stomach) / soft) *
         smooth_step((landmarks_.pylorus - s) / soft);
}

Vec Lumen::shift(double breathes, double moves, const LumenMotion& motion) const EBAC_RT {
  const double breath = params_.breathing * std::sin(2 * kPi * params_.breathing_rate * motion.t);
  return breathes * breath * down_ + moves * motion.bag;
}

/// Share of the radius that the waves leave.
double Lumen::wave(double s, double t) const EBAC_RT {
  const PatientParams& p = params_;
  if (s < landmarks_.oesophagus) return 1;
  if (s < landmarks_.cardia) {
    if (p.peristalsis == 0) return 1;
    const double at =
        landmarks_.oesophagus + p.peristalsis_speed * std::fmod(t, p.peristalsis_period);
    const double inside = smooth_step((landmarks_.cardia - s) / kWave) *
                          smooth_step((s - landmarks_.oesophagus) / kWave);
    return 1 - p.peristalsis * inside * bump((s - at) / kWave);
  }
  const double antrum = landmarks_.pylorus - 0.4 * p.stomach;
  if (p.antral_depth == 0 || s < antrum || s > landmarks_.pylorus) return 1;
  const double apart = p.antral_speed * p.antral_period;  // m, from wave to wave
  const double at = std::fmod(s - antrum - p.antral_speed * t, apart);
  const double from = at < -0.5 * apart ? at + apart : at;
  const double inside =
      smooth_step((landmarks_.pylorus - s) / kWave) * smooth_step((s - antrum) / kWave);
  return 1 - p.antral_depth * inside * bump(from / kWave);
}

Vec Lumen::middle(double s, const LumenMotion& motion) const EBAC_RT {
  const Spot at = spot(s);
  const Station& here = stations_[at.station];
  return here.at + at.share * here.length * here.ahead + shift(here.breathes, moves(s), motion);
}

Frame Lumen::frame(double s) const EBAC_RT {
  const Station& here = stations_[spot(s).station];
  return look_along(here.frame, here.ahead);
}

/// A cubic from station to station: a wall in steps would push in steps.
Lumen::Width Lumen::width(const Spot& at) const EBAC_RT {
  const Station &here = stations_[at.station], &next = stations_[at.station + 1];
  const double u = at.share, step = next.radius - here.radius;
  const double from = here.length * here.widens, to = here.length * next.widens;
  const double bow = (from - step) * (1 - u) + (step - to) * u;
  return {here.radius + u * step + u * (1 - u) * bow,
          (step + (1 - 2 * u) * bow + u * (1 - u) * (2 * step - from - to)) / here.length};
}

double Lumen::radius(double s, double t) const EBAC_RT {
  return width(spot(s)).radius * wave(s, t);
}

/// The segment between whose ends `x` lies, from the segment `i` on.
int Lumen::segment(const Vec& x, int i) const EBAC_RT {
  const auto last = static_cast<int>(stations_.size()) - 2;
  const auto behind = [&](int k) EBAC_RT {
    const Station& station = stations_[static_cast<std::size_t>(k)];
    return dot(x - station.at, station.along) < 0;
  };
  i = std::clamp(i, 0, last);
  if (behind(i)) {
    while (i > 0 && behind(i)) --i;
  } else {
    while (i < last && !behind(i + 1)) ++i;
  }
  return i;
}

/// Its place is where a section of the lumen passes through `x`; sections turn evenly from station
/// to station, so that neither the place nor the depth jumps between two segments.
WallNear Lumen::near(const Vec& x, double radius, const LumenMotion& motion,
                     Along& hint) const EBAC_RT {
  const auto at =
      static_cast<std::size_t>(std::clamp(hint.station, 0, static_cast<int>(stations_.size()) - 2));
  const Station &before = stations_[at], &behind = stations_[at + 1];
  // The displacement is that of the last place, which changes slowly.
  const double own_moves = moves(before.s + hint.share * before.length);
  const double breathes = before.breathes + hint.share * (behind.breathes - before.breathes);
  const Vec own = x - shift(breathes, own_moves, motion);
  hint.station = segment(own, hint.station);
  const auto i = static_cast<std::size_t>(hint.station);
  const Station &here = stations_[i], &next = stations_[i + 1];

  const Vec off = own - here.at, turns = next.along - here.along;
  const double begins = dot(off, here.along), ends = dot(own - next.at, next.along);
  const bool between = begins >= 0 && ends <= 0;  // not so beyond the two ends of the lumen
  double u = begins < 0 ? 0.0 : 1.0;
  if (between) {
    u = begins > ends ? begins / (begins - ends) : 0.0;
    // off - u length ahead is square to along + u turns: a parabola that is nearly straight.
    const double bow = -here.length * dot(here.ahead, turns);
    const double slope = dot(off, turns) - here.length * dot(here.ahead, here.along);
    for (int look = 0; look < 2; ++look) {
      const double rate = slope + 2 * bow * u;
      if (rate < 0) u = std::clamp(u - (begins + u * (slope + bow * u)) / rate, 0.0, 1.0);
    }
  }
  hint.share = u;
  WallNear near{.s = here.s + u * here.length, .moves = own_moves};
  if (wall_ != nullptr) {
    const world::Distance wall = wall_at(*wall_, own);
    near.depth = radius - wall.d;
    near.way = {-wall.out[0], -wall.out[1], -wall.out[2]};
    return near;
  }
  const Vec aside = off - u * here.length * here.ahead;
  const double waved = wave(near.s, motion.t);
  const Width width = this->width({i, u});
  const double from = norm(aside);
  near.depth = from + radius - width.radius * waved;
  near.way = from > 0 ? (1 / from) * aside : Vec{};
  if (between) {  // the place moves along, too, the faster the nearer to the centre of the turn
    const Vec along = here.along + u * turns;
    const double turned = here.length * dot(here.ahead, along) - dot(aside, turns);
    const double rate = here.length / std::max(turned, kLeastTurned * here.length);
    near.way -= rate * (dot(near.way, here.ahead) + width.slope * waved) * along;
  }
  return near;
}

}  // namespace ebac::gastroscope
