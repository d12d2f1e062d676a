#include "ebac/gastroscope/slave.hpp"

#include <algorithm>

#include "ebac/core/check.hpp"

namespace ebac::gastroscope {

Slave::Slave(const ScopeParams& params, const Lumen& lumen, double start)
    : params_(checked(params, "Scope")), lumen_(&lumen), tube_(lumen) {
  settle(std::max(0.0, start - params.section - params.tip));
}

/// It lies in the patient as if it had been advanced slowly, with straight tendons.
void Slave::settle(double base) EBAC_RT {
  constexpr double kAdvance = 0.01;  // m
  const auto wait = [&](int times) EBAC_RT {
    for (int i = 0; i < times; ++i) {
      at_ = tube_.reach(base_);
      look();
      advance(kTubeEvery);
      lead(kTubeEvery);
    }
  };
  for (double s = 0; s < base; s += kAdvance) {
    base_ = insert_.at = s;
    wait(40);
  }
  base_ = insert_.at = base;
  wait(1000);
  at_ = tube_.reach(base_);
  look();
  since_tube_ = kTubeEvery;
}

/// The points of the section at the wall.
void Slave::look() EBAC_RT {
  for (std::size_t i = 0; i < kPoints; ++i) {
    const bool tip = i + 1 == kPoints;
    const double u = static_cast<double>(i + 1) / static_cast<double>(kPoints);
    const double stiff_end = tip ? params_.tip : 0.0;
    const Bend own{u * bend_.x, u * bend_.y};
    const SectionPoint point = camera_of(own, u * params_.section, stiff_end);
    Touch& touch = touch_[i];
    touch.arm = at_.frame.out(point.at);
    const Vec at = at_.at + touch.arm;
    const WallNear wall = lumen_->near(at, 0.5 * params_.diameter, motion_, hint_[i]);
    touch.depth = wall.depth;
    touch.way = wall.way;
    touch.moves = wall.moves;
    const Vec inside = at_.frame.in(wall.way);
    const CameraJacobian j = jacobian_of(own, u * params_.section, stiff_end);
    const double turns = dot(touch.arm, at_.frame.z) * dot(wall.way, at_.turns) -
                         dot(touch.arm, at_.turns) * inside.z;
    const Vec bag = -wall.moves * wall.way;
    touch.per = {u * dot(j[2], inside),
                 u * dot(j[3], inside),
                 dot(wall.way, at_.along) + turns,
                 bag.x,
                 bag.y,
                 bag.z};
    if (tip) {
      const Frame& c = point.camera;
      camera_ = {at, {at_.frame.out(c.x), at_.frame.out(c.y), at_.frame.out(c.z)}};
      place_ = wall.s;
    }
  }
}

double Slave::Balance::step(std::size_t i) const EBAC_RT {
  double left = force[i] - wall[i];
  if (i == 2) left = std::copysign(std::max(std::abs(left) - rub, 0.0), left);
  return left / holds[i];
}

/// The wall at the points of the section: a spring and a damper, which never pull, as they are at
/// the end of the step. Each force in turn is given what the others leave, until none changes; what
/// sticks by friction is taken as free there, which only makes it slower.
void Slave::press(Balance& balance, double dt) EBAC_RT {
  constexpr int kMost = 60;
  constexpr double kSame = 1e-10;  // N
  const double damping = lumen_->params().damping / dt;
  const double stiffness = lumen_->params().stiffness + damping;
  const auto put = [&](const Touch& touch, double force) EBAC_RT {
    for (std::size_t k = 0; k < kMoved; ++k) balance.wall[k] += force * touch.per[k];
  };
  std::array<double, kPoints> gives{};
  for (std::size_t i = 0; i < kPoints; ++i) {
    const Touch& touch = touch_[i];
    gives[i] = 1;
    for (std::size_t k = 0; k < kMoved; ++k) {
      gives[i] += stiffness * touch.per[k] * touch.per[k] / balance.holds[k];
    }
    put(touch, touch.force);
  }
  const auto ends = [&](const Touch& touch) EBAC_RT {
    double depth = touch.depth;
    for (std::size_t k = 0; k < kMoved; ++k) depth += touch.per[k] * balance.step(k);
    return depth;
  };
  for (int round = 0; round < kMost; ++round) {
    double change = 0;
    for (std::size_t i = 0; i < kPoints; ++i) {
      Touch& touch = touch_[i];
      const double wanted = stiffness * ends(touch) - damping * std::max(touch.before, 0.0);
      const double force = std::max(0.0, touch.force + (wanted - touch.force) / gives[i]);
      put(touch, force - touch.force);
      change = std::max(change, std::abs(force - touch.force));
      touch.force = force;
    }
    if (change < kSame) break;
  }
  for (Touch& touch : touch_) touch.before = ends(touch);
}

void Slave::drive(const Command& command, double dt) EBAC_RT {
  const ScopeParams& p = params_;
  const double push = p.axial_stiffness * (insert_.at - base_);
  insert_.step(std::max(command.insertion, 0.0), push, p.lag, p.insertion_speed, p.most_push, dt);
  rotate_.step(command.rotation, 0, p.lag, p.rotation_speed, 1, dt);
  const double ask = std::hypot(command.bend_x, command.bend_y);
  const double share = ask > p.most_bend ? p.most_bend / ask : 1.0;
  motor_x_.step(share * command.bend_x, p.bend_stiffness * (pulled_.x - bend_.x), p.lag,
                p.bend_speed, p.most_torque, dt);
  motor_y_.step(share * command.bend_y, p.bend_stiffness * (pulled_.y - bend_.y), p.lag,
                p.bend_speed, p.most_torque, dt);
  pull();
}

void Slave::pull() EBAC_RT {
  const ScopeParams& p = params_;
  pulled_ = {tendon_x_.follow(motor_x_.at, p.backlash, p.hysteresis, p.hysteresis_width),
             tendon_y_.follow(motor_y_.at, p.backlash, p.hysteresis, p.hysteresis_width)};
}

/// Bends, insertion and bag towards rest, each as a spring and a damper. The wall's stiffness and
/// damping are in the step, so that no wall makes it unstable.
void Slave::advance(double dt) EBAC_RT {
  const ScopeParams& p = params_;
  const PatientParams& patient = lumen_->params();
  const Vec tube = tube_on_bag_ - tube_.holds_bag() * (motion_.bag - bag_then_);
  const Vec on_bag = tube - patient.bag_stiffness * motion_.bag;
  const double bends = p.bend_damping / dt + p.bend_stiffness;
  const double gives = patient.bag_damping / dt + patient.bag_stiffness + tube_.holds_bag();
  Balance balance{
      .force = {p.bend_stiffness * (pulled_.x - bend_.x), p.bend_stiffness * (pulled_.y - bend_.y),
                p.axial_stiffness * (insert_.at - base_), on_bag.x, on_bag.y, on_bag.z},
      .holds = {bends, bends, p.axial_damping / dt + p.axial_stiffness, gives, gives, gives},
      .rub = p.friction * (pressed_ + tube_.all_forces())};
  press(balance, dt);
  bend_.x += balance.step(0);
  bend_.y += balance.step(1);
  base_ = std::max(base_ + balance.step(2), 0.0);
  motion_.bag += {balance.step(3), balance.step(4), balance.step(5)};
  for (std::size_t i = 0; i < resists_.size(); ++i) resists_[i] = balance.wall[i];
  pressed_ = section_force_ = 0;
  for (const Touch& touch : touch_) {
    tip_force_ = touch.force * norm(touch.way);
    pressed_ += tip_force_;
    section_force_ = std::max(section_force_, tip_force_);
  }
}

/// The tube, over `dt`. It gets the springs of the wall at the section, whose dampers are in its own
/// step: with their force of the last tick it would be thrown from wall to wall.
void Slave::lead(double dt) EBAC_RT {
  const PatientParams& patient = lumen_->params();
  std::array<InsertionTube::Pressed, kPoints> pressed;
  for (std::size_t i = 0; i < kPoints; ++i) {
    const Touch& touch = touch_[i];
    const double spring = patient.stiffness * std::max(touch.before, 0.0);
    pressed[i] = {.arm = touch.arm,
                  .way = touch.way,
                  .force = std::min(touch.force, spring),
                  .stiffness = patient.stiffness + patient.damping / dt};
  }
  tube_.relax(params_.flexural_rigidity, 0.5 * params_.diameter, pressed, motion_, dt);
  tube_on_bag_ = tube_.on_bag();
  bag_then_ = motion_.bag;
  since_tube_ = 0;
}

Answer Slave::step(const Command& command, double t, double dt) EBAC_RT {
  drive(command, dt);
  return move(t, dt);
}

Answer Slave::carry(const Command& motors, double t, double dt) EBAC_RT {
  insert_.at = std::max(motors.insertion, 0.0);
  rotate_.at = motors.rotation;
  motor_x_.at = motors.bend_x;
  motor_y_.at = motors.bend_y;
  pull();
  return move(t, dt);
}

Answer Slave::move(double t, double dt) EBAC_RT {
  motion_.t = t;
  since_tube_ += dt;
  at_ = tube_.reach(base_, std::min(since_tube_ / kTubeEvery, 1.0));
  at_.frame = rolled(at_.frame, rotate_.at);
  look();
  if (dt > 0) advance(dt);
  if (since_tube_ > kTubeEvery - 0.5 * dt) lead(std::max(kTubeEvery, dt));
  return {params_.axial_stiffness * (insert_.at - base_), resists_[0], resists_[1]};
}

double Slave::stored() const EBAC_RT {
  double energy = 0;
  for (const Touch& touch : touch_) {
    const double pressed = std::max(touch.before, 0.0);
    energy += 0.5 * lumen_->params().stiffness * pressed * pressed;
  }
  return energy;
}

}  // namespace ebac::gastroscope
