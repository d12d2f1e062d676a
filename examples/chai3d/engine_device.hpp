#pragma once

#include <ebac/world/engine/engine_client.hpp>
#include <optional>
#include <string>
#include <utility>

#include "tool.hpp"

namespace chai {

/// A device of CHAI3D whose handle is that of a loop in another process, as `ebac run --engine-command` starts this
/// program: drives, limits, law and log are that loop's, the scene is this program's.
///
/// A force becomes the plane of `stiffness` [N/m] that presses so at the place it was computed for. Without torque,
/// rotation, gripper and switches.
class EngineDevice final : public chai3d::cGenericHapticDevice {
 public:
  /// `channel`: of the loop; that of the environment if it is empty.
  explicit EngineDevice(double stiffness, std::string channel = {})
      : stiffness_(stiffness), channel_(std::move(channel)) {
    m_specifications.m_manufacturerName = m_specifications.m_modelName = "ebac";
    m_specifications.m_workspaceRadius = kWorkspace;
    m_specifications.m_sensedPosition = m_specifications.m_actuatedPosition = true;
    m_deviceAvailable = true;
  }

  /// Throws as EngineClient.
  bool open() override {
    if (!client_) client_.emplace(channel_);
    return m_deviceReady = client_->loop_runs();
  }
  bool close() override {
    client_.reset();
    m_deviceReady = false;
    return true;
  }
  /// The handle's zero is the loop's; nothing to do.
  bool calibrate(bool) override { return true; }

  /// Waits for the next tick of the loop, so that the haptic thread has its rate.
  bool getPosition(chai3d::cVector3d& x) override {
    if (!running()) return false;
    client_->wait_for_pose(kPatience);
    x = to_chai(client_->pose().x);
    return true;
  }
  bool getLinearVelocity(chai3d::cVector3d& v) override {
    if (!client_) return false;
    return v = to_chai(client_->pose().v), true;
  }
  bool getRotation(chai3d::cMatrix3d& turn) override { return turn.identity(), true; }

  bool setForceAndTorqueAndGripperForce(const chai3d::cVector3d& force, const chai3d::cVector3d&,
                                        double) override {
    if (!running()) return false;
    client_->post(near(client_->pose().x, -from_chai(force)));
    ++posted_;
    return true;
  }

  bool running() { return client_ && client_->loop_runs(); }
  long posted() const { return posted_; }

 private:
  /// The plane of a force. Where there is none the last plane stays for as long as the handle is before it and near: the
  /// next contact then begins at the surface and not where this program first saw it.
  ebac::world::LocalModel near(const ebac::Axes& x, const ebac::Axes& force) {
    const auto made = ebac::world::plane_of_force(x, force, stiffness_);
    if (made.surface) {
      plane_ = made;
      touched_ = x;
    } else if ((x - touched_).norm() > kNear || plane_.depth(x, 0).d > 0) {
      plane_.surface = false;
    }
    return plane_;
  }

  static constexpr double kPatience = 0.02;  // s
  static constexpr double kNear = 0.002;     // m

  double stiffness_;
  std::string channel_;
  std::optional<ebac::world::EngineClient> client_;
  ebac::world::LocalModel plane_;
  ebac::Axes touched_ = ebac::Axes::Zero();  // m, where the last force was
  long posted_ = 0;
};

}  // namespace chai
