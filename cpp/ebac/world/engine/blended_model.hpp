#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "ebac/core/fields.hpp"
#include "ebac/world/engine/local_model.hpp"

namespace ebac::world {

struct BridgeParams {
  double blend = 0.02;   // s
  double slew = 0.1;     // m/s
  double stale = 0.15;   // s
  double fade = 0.1;     // s
  double fastest = 0.5;  // m/s

  static constexpr auto fields() {
    using F = Field<BridgeParams>;
    return std::array{
        F{"blend", &BridgeParams::blend, "s",
          "time constant with which a new model takes over from the one before", 1e-3, 10},
        F{"slew", &BridgeParams::slew, "m/s", "most speed of the surface while it does", 1e-4, 10},
        F{"stale", &BridgeParams::stale, "s", "age of a model from which on its force fades", 1e-3,
          100},
        F{"fade", &BridgeParams::fade, "s", "time in which that force fades to zero, and back",
          1e-3, 100},
        F{"fastest", &BridgeParams::fastest, "m/s", "most speed of a surface that is believed", 0,
          10},
    };
  }
};

/// Local models as one surface without jumps.
///
/// A new model is taken over with its difference to what was rendered: in place along the normal, direction, stiffness,
/// damping and velocity. The differences then fade, so that neither the force nor its direction steps when a model comes.
/// What the change gives to the handle is counted.
class BlendedModel {
 public:
  explicit BlendedModel(const BridgeParams& params) EBAC_RT : params_(params) {}

  /// What is rendered at a place.
  struct Surface {
    double depth = 0;              // m; none outside
    Axes into = Axes::UnitX();     // unit vector
    double stiffness = 0;          // N/m
    double damping = 0;            // N s/m
    Axes velocity = Axes::Zero();  // m/s
    double push = 0;               // N, without damping
  };

  /// Time goes on by `dt` [s] to `t`, with the handle at `x`.
  void advance(const Axes& x, double t, double dt) EBAC_RT {
    given_ += std::max(0.0, -push_ * aside_.dot(x - x_));
    const double before = stored(x);
    since_ = std::clamp(t - target_.t, 0.0, params_.stale + params_.fade);
    const double moved = stored(x);
    moved_ += std::max(0.0, moved - before);
    fade(dt);
    age(t, dt);
    given_ += std::max(0.0, stored(x) - moved);
  }

  /// A new model; the force stays as it is.
  void receive(const LocalModel& model, const Axes& x, double t) EBAC_RT {
    const Surface old = at(x);
    if (!model.surface) {
      target_.t = model.t;  // as old as this; what was there stands, and goes away at `slew`
      target_.at += since_ * target_.velocity;
      rest_.velocity += target_.velocity;
      target_.velocity = Axes::Zero();
      leaving_ = true;
      return;
    }
    leaving_ = false;
    target_ = model;
    const double speed = target_.velocity.norm();
    if (speed > params_.fastest) target_.velocity *= params_.fastest / speed;
    since_ = std::clamp(t - target_.t, 0.0, params_.stale + params_.fade);
    const LocalModel::Depth now = target_.depth(x, since_);
    rest_ = {};
    if (old.depth <= 0) {
      rest_.offset = std::max(0.0, now.d);  // it begins where the handle is
      return;
    }
    rest_ = {.offset = now.d - old.depth,
             .into = old.into - now.into,
             .stiffness = old.stiffness - target_.stiffness,
             .damping = old.damping - target_.damping,
             .velocity = old.velocity - target_.velocity};
  }

  /// At the handle. Remembered for the work of the next interval.
  Surface meet(const Axes& x) EBAC_RT {
    const Surface made = at(x);
    x_ = x;
    push_ = made.depth > 0 ? made.push : 0.0;
    aside_ = made.depth > 0 ? Axes(made.into - target_.depth(x, since_).into) : Axes::Zero();
    return made;
  }

  /// Elastic energy at a place [J].
  double stored(const Axes& x) const EBAC_RT {
    const double d = depth(x);
    return d > 0 ? 0.5 * gain_ * (target_.stiffness + rest_.stiffness) * d * d : 0.0;
  }

  /// Share of the force that age leaves.
  double gain() const EBAC_RT { return gain_; }
  /// Energy that changes of the model can have given to the handle [J].
  double given() const EBAC_RT { return given_; }
  /// Energy that the motion of the surface, as the engine reports it, can have given [J].
  double moved() const EBAC_RT { return moved_; }

 private:
  /// What is left of the model before.
  struct Difference {
    double offset = 0;  // m, of the surface into the body
    Axes into = Axes::Zero();
    double stiffness = 0;
    double damping = 0;
    Axes velocity = Axes::Zero();
  };

  double depth(const Axes& x) const EBAC_RT {
    return target_.surface ? target_.depth(x, since_).d - rest_.offset : 0.0;
  }

  Surface at(const Axes& x) const EBAC_RT {
    if (!target_.surface) return {};
    const LocalModel::Depth now = target_.depth(x, since_);
    Surface made{.depth = now.d - rest_.offset};
    if (!(made.depth > 0)) return made;
    const Axes into = now.into + rest_.into;
    const double length = into.norm();
    made.into = length > kNoDirection ? Axes(into / length) : now.into;
    made.stiffness = target_.stiffness + rest_.stiffness;
    made.damping = target_.damping + rest_.damping;
    made.velocity = target_.velocity + rest_.velocity;
    made.push = gain_ * made.stiffness * made.depth;
    return made;
  }

  void fade(double dt) EBAC_RT {
    const double share = dt / (params_.blend + dt);
    const double most = params_.slew * dt;
    if (leaving_) {
      rest_.offset += most;
    } else {
      rest_.offset -= std::clamp(share * rest_.offset, -most, most);
    }
    rest_.into *= 1 - share;
    rest_.stiffness *= 1 - share;
    rest_.damping *= 1 - share;
    rest_.velocity *= 1 - share;
    if (leaving_ && depth(x_) <= 0) target_.surface = false;
  }

  void age(double t, double dt) EBAC_RT {
    const bool old = t - target_.t > params_.stale;
    gain_ = std::clamp(gain_ + (old ? -dt : dt) / params_.fade, 0.0, 1.0);
  }

  static constexpr double kNoDirection = 1e-3;

  BridgeParams params_;
  LocalModel target_;
  Difference rest_;
  double since_ = 0;           // s, of the model
  double gain_ = 1;            // share
  bool leaving_ = false;       // the engine reports no surface any more
  Axes x_ = Axes::Zero();      // m, the handle in the last tick
  Axes aside_ = Axes::Zero();  // direction of the last force less that of the slope of the energy
  double push_ = 0;            // N, last
  double given_ = 0;           // J
  double moved_ = 0;           // J
};

}  // namespace ebac::world
