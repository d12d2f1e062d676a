#pragma once

#include <memory>
#include <utility>

#include "runner.hpp"
#include "tool.hpp"

namespace chai {

/// A device of ebac in a program of CHAI3D. Its loop runs in a thread of its own; law, limits and recording are the loop's,
/// and the program's haptic thread reads positions and posts forces, at whatever rate.
///
/// Without torque, rotation, gripper and switches: what it is asked for of these is not rendered.
class HapticDevice final : public chai3d::cGenericHapticDevice {
 public:
  /// `in_step`: the runner's clock is a SteppedClock.
  HapticDevice(std::unique_ptr<Runner> runner, bool in_step)
      : runner_(std::move(runner)), exchange_(std::make_shared<Exchange>(in_step)) {
    const ebac::DeviceModel& model = runner_->model();
    m_specifications.m_manufacturerName = m_specifications.m_modelName = "ebac";
    m_specifications.m_maxLinearForce = model.peak_force();
    m_specifications.m_workspaceRadius = kWorkspace;
    m_specifications.m_sensedPosition = m_specifications.m_actuatedPosition = true;
    m_deviceAvailable = true;
  }
  ~HapticDevice() override { runner_->stop(); }
  HapticDevice(const HapticDevice&) = delete;
  HapticDevice& operator=(const HapticDevice&) = delete;
  HapticDevice(HapticDevice&&) = delete;
  HapticDevice& operator=(HapticDevice&&) = delete;

  bool open() override {
    runner_->start(exchange_);
    return m_deviceReady = runner_->running();
  }
  bool close() override {
    runner_->stop();
    m_deviceReady = false;
    return true;
  }
  /// The handle's zero is the device's own; nothing to do.
  bool calibrate(bool) override { return true; }

  bool getPosition(chai3d::cVector3d& x) override {
    now_ = exchange_->motion([this] { return runner_->running(); });
    x = to_chai(now_.x);
    return runner_->running();
  }
  bool getLinearVelocity(chai3d::cVector3d& v) override { return v = to_chai(now_.v), true; }
  bool getRotation(chai3d::cMatrix3d& turn) override { return turn.identity(), true; }

  /// What the motors did in the last tick, which is what the law made of the force that was set.
  bool getForce(chai3d::cVector3d& force) override {
    force.zero();
    if (!m_deviceReady) return false;
    const ebac::Trace& trace = runner_->trace();
    if (trace.size() == 0) return false;
    const ebac::Sample last = trace.sample(trace.size() - 1);
    for (int i = 0; i < trace.axes(); ++i)
      force(i) = -last.axis[static_cast<std::size_t>(i)].port.f_applied;
    return true;
  }
  bool setForceAndTorqueAndGripperForce(const chai3d::cVector3d& force, const chai3d::cVector3d&,
                                        double) override {
    exchange_->ask({-from_chai(force), now_.x});
    return runner_->running();
  }

  bool running() const { return runner_->running(); }
  const ebac::Trace& trace() const { return runner_->trace(); }

 private:
  std::unique_ptr<Runner> runner_;
  std::shared_ptr<Exchange> exchange_;
  Motion now_;
};

}  // namespace chai
