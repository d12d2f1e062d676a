#include "ebac/gastroscope/physician.hpp"

#include <algorithm>
#include <numbers>

#include "ebac/core/check.hpp"

namespace ebac::gastroscope {

namespace {

constexpr double kStroke = 0.03;   // m, of the third axis, either way
constexpr double kBegin = 0.05;    // m, before a target at which it is looked for
constexpr double kAimed = 0.3;     // rad
constexpr double kBackTime = 1.5;  // s
constexpr double kTight = 15;      // N: a hand pulls no harder at what does not give

std::size_t ticks(double seconds, double dt) {
  return static_cast<std::size_t>(std::lround(seconds / dt));
}

}  // namespace

Physician::Physician(const PhysicianParams& params, const MasterParams& master, const Lumen& lumen,
                     std::vector<Target> targets, std::uint64_t seed, double dt)
    : params_(checked(params, "Physician")),
      master_(checked(master, "Master")),
      lumen_(&lumen),
      targets_(std::move(targets)),
      random_(seed, /*stream=*/7),
      dt_(dt),
      gain_(params.crossover / (params.reaction + 2 * master.delay)),
      every_(std::max(1, static_cast<int>(std::lround(kPicture / dt)))),
      pictures_(ticks(params.reaction + master.delay, dt), {}),
      feels_(ticks(0.6 * params.reaction, dt), 0) {
  std::ranges::sort(targets_, {}, &Target::place);
}

Vec Physician::target_at(std::size_t i, const LumenMotion& motion) const EBAC_RT {
  const Target& target = targets_[i];
  const Frame frame = lumen_->frame(target.place);
  const Vec out = std::cos(target.angle) * frame.x + std::sin(target.angle) * frame.y;
  return lumen_->middle(target.place, motion) + lumen_->radius(target.place, motion.t) * out;
}

bool Physician::touches(const Slave& slave) const EBAC_RT {
  if (next_ >= targets_.size() || slave.tip_force() < 0.05) return false;
  return norm(slave.camera().at - target_at(next_, slave.motion())) < kReach;
}

View Physician::look(const Slave& slave) EBAC_RT {
  const bool aims = phase_ == Phase::kAim && next_ < targets_.size();
  const double ahead = slave.place() + params_.look_ahead;
  const Vec goal = aims ? target_at(next_, slave.motion()) : lumen_->middle(ahead, slave.motion());
  const Vec own = slave.camera().camera.in(goal - slave.camera().at);
  const double aside = std::hypot(own.x, own.y);
  const double off = std::atan2(aside, own.z);
  const double share = aside > 0 ? off / aside : 0.0;
  return {share * own.x + params_.noise * random_.normal(),
          share * own.y + params_.noise * random_.normal(), slave.gap(), slave.place(),
          touches(slave)};
}

void Physician::change(Phase phase, double t) EBAC_RT {
  phase_ = phase;
  since_ = t;
}

void Physician::decide(double t) EBAC_RT {
  const bool more = next_ < targets_.size();
  if (phase_ == Phase::kGo) {
    if (more && seen_.place > targets_[next_].place - kBegin) change(Phase::kAim, t);
    if (!more && seen_.place > lumen_->landmarks().behind) change(Phase::kDone, t);
  } else if (phase_ == Phase::kAim) {
    if (!seen_.touches && t - since_ < params_.patience) return;
    touched_ += seen_.touches ? 1 : 0;
    ++next_;
    change(Phase::kBack, t);
  } else if (phase_ == Phase::kBack && t - since_ > kBackTime) {
    change(Phase::kGo, t);
  }
}

/// Of insertion [m/s]: forwards where the goal is ahead, back where it is out of sight.
double Physician::speed(double off, double felt) const EBAC_RT {
  const PhysicianParams& p = params_;
  if (phase_ == Phase::kDone) return 0;
  if (phase_ == Phase::kBack || off > 0.5 * p.field_of_view) return -p.retreat;
  const bool aims = phase_ == Phase::kAim;
  const double wide = aims ? kAimed : 0.8;
  const double clear = std::max(0.0, 1 - off * off / (wide * wide));
  const double heeded = p.heed > 0 ? std::max(-0.3, 1 - felt / p.heed) : 1.0;
  return (aims ? p.approach : p.advance) * clear * heeded;
}

void Physician::turn(const Handle& x) EBAC_RT {
  const double bearing[2] = {seen_.right, seen_.down};
  for (std::size_t i = 0; i < 2; ++i) {
    double& aim = wish_.aim[i];
    if (master_.bend_by_rate) {
      const double wanted = std::clamp(gain_ * bearing[i] / master_.bend_rate, -0.02, 0.02);
      aim += std::clamp(wanted - aim, -params_.hand_speed * dt_, params_.hand_speed * dt_);
    } else {
      const double rate = gain_ * bearing[i] / master_.bend_scale;
      aim += dt_ * std::clamp(rate, -params_.hand_speed, params_.hand_speed);
    }
    aim = std::clamp(std::clamp(aim, x[i] - kTight / 300, x[i] + kTight / 300), -0.045, 0.045);
  }
}

void Physician::insert(double speed, const Handle& x) EBAC_RT {
  wish_.pedal = speed;
  double& aim = wish_.aim[2];
  const double most = params_.hand_speed * dt_;
  if (master_.insertion == MasterParams::kSlideRate) {
    const double dead = speed == 0 ? 0.0 : std::copysign(master_.dead_zone, speed);
    const double wanted = std::clamp(speed / master_.insertion_rate + dead, -kStroke, kStroke);
    aim += std::clamp(wanted - aim, -most, most);
  } else if (master_.insertion == MasterParams::kSlideClutch) {
    if (wish_.clutched) {
      aim = std::clamp(aim + dt_ * speed / master_.insertion_scale, x[2] - kTight / 300,
                       x[2] + kTight / 300);
      if (std::abs(aim) > kStroke) wish_.clutched = false;
    } else {  // back to the other end, in the air
      const double home = speed >= 0 ? -0.8 * kStroke : 0.8 * kStroke;
      aim += std::clamp(home - aim, -4 * most, 4 * most);
      if (std::abs(x[2] - home) < 2e-3) wish_.clutched = true;
    }
  }
}

Wish Physician::step(const Slave& slave, const Handle& x, const Handle& force, double t) EBAC_RT {
  if (--until_ <= 0) {
    until_ = every_;
    now_ = look(slave);
  }
  now_.touches = now_.touches || touches(slave);
  seen_ = pictures_.pass(now_);
  double felt = 0;
  for (const double f : force) felt = std::max(felt, std::abs(f));
  felt = feels_.pass(felt);
  decide(t);
  const double off = std::hypot(seen_.right, seen_.down);
  turn(x);
  insert(speed(off, felt), x);
  return wish_;
}

}  // namespace ebac::gastroscope
