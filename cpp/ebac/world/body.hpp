#pragma once

#include <cmath>
#include <optional>

#include "ebac/model/contact_force.hpp"
#include "ebac/world/combined.hpp"
#include "ebac/world/material.hpp"
#include "ebac/world/motion.hpp"
#include "ebac/world/proxy.hpp"

namespace ebac::world {

/// What one body does to the handle, in the axes of the device.
struct Touch {
  Axes force = Axes::Zero();     // N, as the handle presses
  Axes velocity = Axes::Zero();  // m/s, of the surface
  double depth = 0;              // m
  double stiffness = 0;          // N/m
  int normals = 0;
  std::array<Axes, kMaxAxes> normal{};  // unit vectors into the body
  std::array<double, kMaxAxes> push{};  // N, along each
};

/// The surface of one body near a handle outside, in the axes of the device.
struct Near {
  double distance = HUGE_VAL;    // m
  Axes out = Axes::UnitX();      // unit vector away from the body
  double stiffness = 0;          // N/m, pressed lightly
  Axes velocity = Axes::Zero();  // m/s
};

/// A solid of some material, which may move, and whose surface may hold by friction.
class Body {
 public:
  Body(SolidPtr solid, const Material& material, double friction, const Swing& motion)
      : solid_(std::move(solid)),
        material_(material),
        friction_(friction),
        motion_(motion),
        still_(motion.still()) {}

  Touch touch(const Axes& x, const Axes& v, double t) EBAC_RT {
    if (still_) return touch(x, v);
    const BodyPose pose = motion_.at(t);
    const Axes surface = pose.velocity_at(x);
    Touch made = touch(pose.into(x), pose.turn.transpose() * (v - surface));
    made.force = pose.turn * made.force;
    made.velocity = surface;
    for (int i = 0; i < made.normals; ++i) {
      Axes& normal = made.normal[static_cast<std::size_t>(i)];
      normal = pose.turn * normal;
    }
    return made;
  }

  Near near(const Axes& x, double t) const EBAC_RT {
    const BodyPose pose = still_ ? BodyPose{} : motion_.at(t);
    const Distance at = solid_->distance(pose.into(x));
    Material material = material_;
    return {.distance = at.d,
            .out = pose.turn * at.out,
            .stiffness = press(material, kLightly, 0).stiffness,
            .velocity = pose.velocity_at(x)};
  }

  /// Elastic energy of the last touch [J].
  double stored() const EBAC_RT { return stored_; }

  void reset() EBAC_RT {
    proxy_ = {};
    last_.reset();
    let_go();
  }

 private:
  /// In the body's own axes; `v` against its surface.
  Touch touch(const Axes& x, const Axes& v) EBAC_RT {
    const Axes moved = last_ ? Axes(x - *last_) : Axes(Axes::Zero());
    last_ = x;
    proxy_.follow(*solid_, x);
    if (!proxy_.touching()) {
      let_go();
      return {};
    }
    const Axes in = x - proxy_.place();
    const double depth = in.norm();
    Axes normal = -proxy_.constraint(0).out;
    if (depth > 0) normal = (1 / depth) * in;
    const Push push = press(material_, depth, normal.dot(v));
    Touch made{.force = push.force * normal,
               .depth = depth,
               .stiffness = push.stiffness,
               .normals = proxy_.constraints()};
    stored_ = world::stored(material_, depth);
    if (friction_ > 0) {
      made.force += hold(moved, normal, push);
      stored_ += 0.5 * push.stiffness * stretch_.squaredNorm();
    }
    for (int i = 0; i < made.normals; ++i) {
      const Proxy::Constraint& plane = proxy_.constraint(i);
      made.normal[static_cast<std::size_t>(i)] = -plane.out;
      made.push[static_cast<std::size_t>(i)] = depth > 0 ? push.force * plane.depth / depth : 0.0;
    }
    return made;
  }

  /// Coulomb friction: the surface holds the handle by a spring as stiff as itself, which is stretched by motion along
  /// the surface, and slips where it would pull with more than the friction coefficient times the push.
  Axes hold(const Axes& moved, const Axes& normal, const Push& push) EBAC_RT {
    stretch_ += moved;
    stretch_ -= normal.dot(stretch_) * normal;
    const double length = stretch_.norm();
    const double most = push.stiffness > 0 ? friction_ * push.force / push.stiffness : 0.0;
    if (length > most) stretch_ *= most / length;
    return push.stiffness * stretch_;
  }

  void let_go() EBAC_RT {
    world::reset(material_);
    stretch_.setZero();
    stored_ = 0;
  }

  static constexpr double kLightly = 5e-4;  // m

  SolidPtr solid_;
  Material material_;
  double friction_;  // Coulomb's coefficient
  Swing motion_;
  bool still_;
  Proxy proxy_;
  std::optional<Axes> last_;     // m, the handle in the body
  Axes stretch_ = Axes::Zero();  // m, along the surface
  double stored_ = 0;            // J
};

}  // namespace ebac::world
