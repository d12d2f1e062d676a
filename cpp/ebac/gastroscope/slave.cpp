#include "ebac/gastroscope/slave.hpp"

#include <algorithm>

#include "ebac/core/check.hpp"

namespace ebac::gastroscope {

Slave::Slave(const ScopeParams& params, const Lumen& lumen, double start)
    : params_(checked(params, "Scope")),
      lumen_(&lumen),
      tube_(lumen),
      base_(std::max(0.0, start - params.section - params.tip)) {
  insert_.at = base_;
  // It lies in the lumen as in one that pushes it nowhere: the tube comes to rest before the start.
  double s = 0;
  while (s <= base_) {
    tube_.reach(s);
    for (int i = 0; i < 40; ++i) {
      tube_.relax(params_.flexural_rigidity, 0.5 * params_.diameter, 0, {}, {}, motion_, 0.01);
    }
    s += 0.5 * InsertionTube::kStep;
  }
  at_ = tube_.reach(base_);
  for (Along& hint : hint_) hint.station = static_cast<int>(base_ / 5e-3);
  meet(0);
}

/// The wall at the points of the section: a spring and a damper, which never pull.
Slave::Load Slave::meet(double dt) EBAC_RT {
  Load load;
  const double stiffness = lumen_->params().stiffness, damping = lumen_->params().damping;
  section_force_ = 0;
  for (std::size_t i = 0; i < kPoints; ++i) {
    const bool tip = i + 1 == kPoints;
    const double u = static_cast<double>(i + 1) / static_cast<double>(kPoints);
    const double stiff_end = tip ? params_.tip : 0.0;
    const Bend own{u * bend_.x, u * bend_.y};
    const SectionPoint point = camera_of(own, u * params_.section, stiff_end);
    const Vec at = at_.at + at_.frame.out(point.at);
    const WallNear wall = lumen_->near(at, 0.5 * params_.diameter, motion_, hint_[i]);
    const double before = depth_[i];
    depth_[i] = wall.depth;
    if (tip) {
      const Frame& c = point.camera;
      camera_ = {at, {at_.frame.out(c.x), at_.frame.out(c.y), at_.frame.out(c.z)}};
      place_ = wall.s;
      tip_force_ = 0;
    }
    if (!(wall.depth > 0)) continue;
    const double rate = dt > 0 ? (wall.depth - std::max(before, 0.0)) / dt : 0.0;
    const double push = std::max(0.0, stiffness * wall.depth + damping * rate);
    const Vec force = -push * wall.way;
    const Vec inside = at_.frame.in(force);
    const CameraJacobian j = jacobian_of(own, u * params_.section, stiff_end);
    load.axial -= inside.z;
    load.x -= u * dot(j[2], inside);
    load.y -= u * dot(j[3], inside);
    load.stiffness += stiffness;
    load.force += force;
    load.moment += cross(at - at_.at, force);
    load.on_bag -= wall.moves * force;
    const double size = norm(force);
    load.size += size;
    section_force_ = std::max(section_force_, size);
    if (tip) tip_force_ = size;
  }
  return load;
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

/// Bends and insertion towards rest, each as a spring and a damper; the wall's stiffness is in the
/// step, so that no wall makes it unstable.
void Slave::advance(const Load& load, double dt) EBAC_RT {
  const ScopeParams& p = params_;
  const double reach = p.section + p.tip;
  const double hold = p.bend_damping + dt * (p.bend_stiffness + load.stiffness * reach * reach);
  bend_.x += dt * (p.bend_stiffness * (pulled_.x - bend_.x) - load.x) / hold;
  bend_.y += dt * (p.bend_stiffness * (pulled_.y - bend_.y) - load.y) / hold;

  const double pressed = load.size + tube_.all_forces();
  const double rub = p.friction * pressed;
  const double pull = p.axial_stiffness * (insert_.at - base_) - load.axial;
  const double moving = std::copysign(std::max(std::abs(pull) - rub, 0.0), pull);
  base_ += dt * moving / (p.axial_damping + dt * (p.axial_stiffness + load.stiffness));
  base_ = std::max(base_, 0.0);

  const PatientParams& patient = lumen_->params();
  const Vec on_bag = load.on_bag + tube_on_bag_ - patient.bag_stiffness * motion_.bag;
  const double gives = patient.bag_damping + dt * (patient.bag_stiffness + load.stiffness);
  motion_.bag += (dt / gives) * on_bag;
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
  at_ = tube_.reach(base_, 1 - static_cast<double>(until_tube_) / kTubeEvery);
  at_.frame = rolled(at_.frame, rotate_.at);
  const Load load = meet(dt);
  advance(load, dt);
  if (--until_tube_ <= 0) {
    until_tube_ = kTubeEvery;
    tube_.relax(params_.flexural_rigidity, 0.5 * params_.diameter, params_.section + params_.tip,
                load.force, load.moment, motion_, kTubeEvery * dt);
    tube_on_bag_ = tube_.on_bag();
  }
  return {params_.axial_stiffness * (insert_.at - base_), load.x, load.y};
}

double Slave::stored() const EBAC_RT {
  double energy = 0;
  for (const double depth : depth_) {
    const double pressed = std::max(depth, 0.0);
    energy += 0.5 * lumen_->params().stiffness * pressed * pressed;
  }
  return energy;
}

}  // namespace ebac::gastroscope
