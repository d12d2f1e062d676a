#pragma once

#include <cmath>
#include <memory>
#include <utility>

#include "ebac/world/engine/blended_model.hpp"
#include "ebac/world/engine/bridge_report.hpp"
#include "ebac/world/engine/engine_channel.hpp"
#include "ebac/world/transported_frame.hpp"

namespace ebac::world {

/// A world whose contacts come from an engine at a rate of its own.
class Bridge : public World {
 public:
  /// Of the last run: copies share it.
  const BridgeReport& report() const { return *report_; }

 protected:
  explicit Bridge(std::shared_ptr<BridgeReport> report) : report_(std::move(report)) {}

  std::shared_ptr<BridgeReport> report_;
};

/// Renders the newest answer of `Source` in every tick: its local model or, `held`, the force that the engine had computed,
/// as a bridge is not to do.
template <class Source>
class BridgeOver final : public Bridge {
 public:
  BridgeOver(const Source& source, const BridgeParams& params, bool held,
             std::shared_ptr<BridgeReport> report)
      : Bridge(std::move(report)),
        source_(source),
        params_(params),
        held_(held),
        surface_(params) {}

  ContactForce contact(const Axes& x, const Axes& v, double t) EBAC_RT override {
    const double dt = begun_ ? std::clamp(t - t_, 0.0, kLongestTick) : 0.0;
    begun_ = true;
    t_ = t;
    surface_.advance(x, t, dt);
    if (const Answer* answer = source_.take(x, v, t)) receive(*answer, x, t);
    if (any_) report_->rendered(t - model_t_, held_ ? 1.0 : surface_.gain(), t, dt);
    report_->energies(surface_.given(), surface_.moved());
    if (broken_) return ContactForce::straight(Axes::Constant(NAN));
    return held_ ? pressed(force_) : rendered(x, v);
  }

  double stored() const EBAC_RT override { return held_ ? 0 : stored_; }

  std::unique_ptr<World> fresh() const override {
    return std::make_unique<BridgeOver>(source_, params_, held_, report_);
  }

 private:
  void receive(const Answer& answer, const Axes& x, double t) EBAC_RT {
    const LocalModel& model = answer.model;
    report_->arrived();
    any_ = true;
    model_t_ = model.t;
    broken_ = broken_ || !model.finite();
    if (!held_) return surface_.receive(model, x, t);
    const LocalModel::Depth at = model.depth(answer.x, 0);
    const double push = model.surface ? model.stiffness * std::max(0.0, at.d) : 0.0;
    force_ = push * at.into;
  }

  ContactForce rendered(const Axes& x, const Axes& v) EBAC_RT {
    const BlendedModel::Surface now = surface_.meet(x);
    stored_ = surface_.stored(x);
    if (!(now.depth > 0)) return {};
    const double damping = surface_.gain() * now.damping;
    const double push = std::max(0.0, now.push + damping * now.into.dot(v - now.velocity));
    ContactForce made = pressed(push * now.into, now.into);
    made.velocity = surface_.gain() * now.velocity;
    made.depth = now.depth;
    made.stiffness = surface_.gain() * now.stiffness;
    return made;
  }

  ContactForce pressed(const Axes& force) EBAC_RT {
    const double size = force.norm();
    return size > 0 ? pressed(force, force / size) : ContactForce{};
  }
  ContactForce pressed(const Axes& force, const Axes& into) EBAC_RT {
    ContactForce made{.force = force, .frame = frame_.along(&into, 1)};
    made.along = made.frame * force;
    made.turned = !made.frame.isIdentity(0);
    return made;
  }

  static constexpr double kLongestTick = 0.1;  // s

  Source source_;
  BridgeParams params_;
  bool held_;
  BlendedModel surface_;
  TransportedFrame frame_;
  Axes force_ = Axes::Zero();  // N, held
  double stored_ = 0;          // J
  double t_ = 0;               // s
  double model_t_ = 0;         // s, of the newest model
  bool begun_ = false;
  bool any_ = false;     // whether a model has come
  bool broken_ = false;  // whether one was not finite
};

std::unique_ptr<Bridge> make_scheduled(std::unique_ptr<Engine> engine, const EngineTiming& timing,
                                       const BridgeParams& params, bool held);
std::unique_ptr<Bridge> make_posted(std::shared_ptr<EngineChannel> channel,
                                    const BridgeParams& params);

}  // namespace ebac::world
