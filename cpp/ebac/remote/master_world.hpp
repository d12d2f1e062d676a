#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <utility>

#include "ebac/gastroscope/master.hpp"
#include "ebac/model/world.hpp"
#include "ebac/remote/link_end.hpp"

namespace ebac::remote {

/// Longest time from tick to tick that moves anything [s].
inline constexpr double kLongestStep = 0.1;

/// The world of the joystick: its place goes to the slave, and the force comes from there. The force is 0 until the link
/// runs, and fades where it is lost. Insertion is told from where the session began.
class MasterWorld final : public World {
 public:
  MasterWorld(std::shared_ptr<LinkEnd> link, const gastroscope::MasterParams& params)
      : link_(std::move(link)), params_(checked(params, "Master")), master_(params, kFar) {}

  ContactForce contact(const Axes& x, const Axes&, double t) EBAC_RT override {
    const double elapsed = begun_ ? std::max(t - t_, 0.0) : 0.0;
    link_->begin(t, elapsed);
    LinkReport& report = link_->report();
    const gastroscope::Handle handle{x[0], x[1], x[2]};
    if (begun_) {
      double work = 0;
      for (std::size_t i = 0; i < felt_.size(); ++i) work += felt_[i] * (handle[i] - at_[i]);
      (work > 0 ? report.energy_in : report.energy_out) += std::abs(work);
    }
    at_ = handle;
    t_ = t;
    begun_ = true;

    const bool running = link_->running();
    const double step = running ? std::min(elapsed, kLongestStep) : 0.0;
    if (!running) master_.restart(kFar);  // what is asked while nobody follows is not made up for
    const bool clutched = running && step > 0;
    const gastroscope::Command& asked = master_.command(handle, 0, clutched, step > 0 ? step : kNo);
    const Four wanted{running ? asked.insertion - kFar : 0.0, asked.rotation, asked.bend_x,
                      asked.bend_y};
    feel(clutched);
    describe(wanted);
    link_->end(wanted, {});
    return ContactForce::straight({felt_[0], felt_[1], felt_[2]});
  }

  std::unique_ptr<World> fresh() const override {
    return std::make_unique<MasterWorld>(link_, params_);
  }

 private:
  static constexpr double kFar = 10;    // m, from where insertion is counted: it may be withdrawn
  static constexpr double kNo = 1e-12;  // s
  static constexpr double kSettled = 0.05;  // s, after the fade

  /// The newest force, faded where the link is lost.
  void feel(bool clutched) EBAC_RT {
    const teleop::Packet& in = link_->heard();
    // Of a lost session the last one fades.
    if (in.sequence > 0) answer_ = {in.value, in.more[1], in.more[2]};
    felt_ = master_.felt(answer_, clutched || link_->lost());
    const double share = link_->share();
    for (double& force : felt_) force *= share;
  }

  void describe(const Four& wanted) EBAC_RT {
    LinkReport& report = link_->report();
    const teleop::Packet& in = link_->heard();
    double most = 0;
    for (const double force : felt_) most = std::max(most, std::abs(force));
    report.most_force = std::max(report.most_force, most);
    calm_ = link_->share() == 0 && link_->lost() ? calm_ + 1 : 0;
    if (calm_ > 0) report.force_when_lost = std::max(report.force_when_lost, most);
    report.asked = wanted;
    report.load = {in.value, in.more[0], in.more[1], in.more[2]};
    for (std::size_t i = 0; i < wanted.size(); ++i) {
      report.most_load[i] = std::max(report.most_load[i], std::abs(report.load[i]));
      if (in.sequence == 0 || !link_->running()) continue;
      report.at[i] = in.at[i];
      report.error[i] = wanted[i] - in.at[i];
      report.most_error[i] = std::max(report.most_error[i], std::abs(report.error[i]));
    }
  }

  std::shared_ptr<LinkEnd> link_;
  gastroscope::MasterParams params_;
  gastroscope::Master master_;
  gastroscope::Answer answer_{};
  gastroscope::Handle felt_{};  // N
  gastroscope::Handle at_{};    // m
  double t_ = 0;                // s
  int calm_ = 0;
  bool begun_ = false;
};

}  // namespace ebac::remote
