#include "ebac/remote/slave_worlds.hpp"

#include <algorithm>
#include <utility>

#include "ebac/remote/master_world.hpp"

namespace ebac::remote {

namespace {

class GroupWorld final : public World {
 public:
  GroupWorld(std::shared_ptr<SlaveLink> slave, std::size_t group)
      : slave_(std::move(slave)), group_(group) {}

  ContactForce contact(const Axes& x, const Axes& v, double t) EBAC_RT override {
    return slave_->contact(group_, x, v, t);
  }
  std::unique_ptr<World> fresh() const override {
    return std::make_unique<GroupWorld>(slave_, group_);
  }

 private:
  std::shared_ptr<SlaveLink> slave_;
  std::size_t group_;
};

double load(const std::atomic<double>& value) EBAC_RT {
  return value.load(std::memory_order_relaxed);
}
void put(std::atomic<double>& at, double value) EBAC_RT {
  at.store(value, std::memory_order_relaxed);
}

}  // namespace

void Targets::follow(const Four& asked, double dt) EBAC_RT {
  const FollowParams& p = params_;
  Four goal = asked;
  goal[0] = std::clamp(zero_ + asked[0], -p.deepest, p.deepest);
  const double bend = std::hypot(goal[2], goal[3]);
  if (bend > p.most_bend) {
    goal[2] *= p.most_bend / bend;
    goal[3] *= p.most_bend / bend;
  }
  const double turn = aligned_ ? p.turn_speed : p.realign;
  for (std::size_t i = 0; i < goal.size(); ++i) rate_[i] = (goal[i] - at_[i]) / (kSmooth + dt);
  rate_[0] = std::clamp(rate_[0], -p.insertion_speed, p.insertion_speed);
  rate_[1] = std::clamp(rate_[1], -turn, turn);
  // Both bends slowed alike go straight, and so stay within the largest bend.
  const double bending = std::hypot(rate_[2], rate_[3]);
  if (bending > turn) {
    rate_[2] *= turn / bending;
    rate_[3] *= turn / bending;
  }
  bool near = true;
  for (std::size_t i = 0; i < goal.size(); ++i) {
    at_[i] += rate_[i] * dt;
    near = near && (i == 0 || std::abs(goal[i] - at_[i]) < kAligned);
  }
  aligned_ = aligned_ || near;
}

SlaveLink::SlaveLink(std::shared_ptr<LinkEnd> link, const FollowParams& params,
                     const gastroscope::Gears& gears)
    : link_(std::move(link)),
      params_(params),
      targets_(params),
      gears_(checked(gears, "Gears").each()) {}

std::shared_ptr<World> SlaveLink::world(std::shared_ptr<SlaveLink> slave, std::size_t group) {
  return std::make_shared<GroupWorld>(std::move(slave), group);
}

ContactForce SlaveLink::contact(std::size_t group, const Axes& x, const Axes& v, double t) EBAC_RT {
  const std::size_t first = 2 * group;
  for (std::size_t i = 0; i < 2; ++i) put(at_[first + i], x[static_cast<Eigen::Index>(i)]);
  bool moves = true;
  if (group == 0) {
    lead(t);
    led_.fetch_add(1, std::memory_order_relaxed);
  } else {
    beat_.fetch_add(1, std::memory_order_release);  // who sees it sees where its axes are, too
    moves = is_led(t);
  }
  Axes force = Axes::Zero();
  const bool started = started_.load(std::memory_order_acquire);
  for (std::size_t i = 0; i < 2; ++i) {
    const auto e = static_cast<Eigen::Index>(i);
    const double wanted = started ? load(wanted_[first + i]) : x[e];
    const double rate = moves ? load(rate_[first + i]) : 0.0;
    const double pull = params_.stiffness * (wanted - x[e]) + params_.damping * (rate - v[e]);
    const double held = std::clamp(pull, -params_.most_force, params_.most_force);
    put(force_[first + i], held);
    force[e] = -held;  // a world resists
  }
  return ContactForce::straight(force);
}

void SlaveLink::lead(double t) EBAC_RT {
  const double elapsed = begun_ ? std::max(t - t_, 0.0) : 0.0;
  t_ = t;
  begun_ = true;
  link_->begin(t, elapsed);
  const double dt = std::min(elapsed, kLongestStep);
  watch_group(dt);
  if (!started_.load(std::memory_order_relaxed)) start();
  if (link_->session() != session_) {
    session_ = link_->session();
    targets_.begin();
  }
  const teleop::Packet& in = link_->heard();
  const bool may = started_.load(std::memory_order_relaxed) && !alone_;
  if (link_->running() && in.sequence > 0 && may) {
    targets_.follow({in.value, in.more[0], in.more[1], in.more[2]}, dt);
  } else {
    targets_.hold();
  }
  for (std::size_t i = 0; i < gears_.size(); ++i) {
    put(wanted_[i], targets_.at()[i] / gears_[i]);
    put(rate_[i], targets_.rate()[i] / gears_[i]);
  }
  describe(dt);
  Four load_there{}, place{};
  for (std::size_t i = 0; i < gears_.size(); ++i) {
    load_there[i] = load(force_[i]) / gears_[i];
    place[i] = gears_[i] * load(at_[i]);
  }
  place[0] -= targets_.zero();
  link_->end(load_there, place);
}

void SlaveLink::start() EBAC_RT {
  if (beat_.load(std::memory_order_acquire) == 0) return;
  Four at{};
  for (std::size_t i = 0; i < at.size(); ++i) at[i] = gears_[i] * load(at_[i]);
  targets_.start(at);
  targets_.begin();
  for (std::size_t i = 0; i < at.size(); ++i) put(wanted_[i], at[i] / gears_[i]);
  started_.store(true, std::memory_order_release);
}

/// The other loop's drives must go on with these: without them nothing here moves.
void SlaveLink::watch_group(double dt) EBAC_RT {
  const std::int64_t beat = beat_.load(std::memory_order_relaxed);
  silent_ = beat == beats_ && beat > 0 ? silent_ + dt : 0.0;
  beats_ = beat;
  if (silent_ > kSilent) {
    if (!alone_) link_->note(EventOf::kGroup, silent_);
    alone_ = true;
    link_->lose();  // again after every consent, until these drives go on
  } else if (silent_ == 0) {
    alone_ = false;
  }
}

/// Whether the first group goes on; without it the bends stand where they were asked to be last.
bool SlaveLink::is_led(double t) EBAC_RT {
  const std::int64_t led = led_.load(std::memory_order_relaxed);
  if (led != seen_) led_at_ = t;
  seen_ = led;
  return t - led_at_ <= kSilent;
}

void SlaveLink::describe(double dt) EBAC_RT {
  LinkReport& report = link_->report();
  double given = 0;
  double moved = 0;
  const bool holds = link_->lost();
  if (holds && !holding_) held_at_ = targets_.at();
  holding_ = holds;
  for (std::size_t i = 0; i < gears_.size(); ++i) {
    const double force = load(force_[i]);
    given += force * targets_.rate()[i] / gears_[i] * dt;
    report.most_force = std::max(report.most_force, std::abs(force));
    report.asked[i] = targets_.at()[i];
    report.at[i] = gears_[i] * load(at_[i]);
    report.error[i] = report.asked[i] - report.at[i];
    report.load[i] = force / gears_[i];
    report.most_load[i] = std::max(report.most_load[i], std::abs(report.load[i]));
    report.most_error[i] = std::max(report.most_error[i], std::abs(report.error[i]));
    if (holds) moved = std::max(moved, std::abs(targets_.at()[i] - held_at_[i]));
  }
  // What the controllers take, the network gives.
  (given > 0 ? report.energy_out : report.energy_in) += std::abs(given);
  report.moved_when_lost = std::max(report.moved_when_lost, moved);
}

}  // namespace ebac::remote
