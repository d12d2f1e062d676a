#pragma once

#include <ebac/model/world.hpp>
#include <functional>
#include <memory>
#include <utility>

#include "force_contact.hpp"
#include "tool.hpp"

namespace chai {

/// A device that stands where it is put and keeps the force that it gets.
class Probe final : public chai3d::cGenericHapticDevice {
 public:
  Probe() {
    m_specifications.m_modelName = "ebac probe";
    m_specifications.m_workspaceRadius = kWorkspace;
    m_specifications.m_sensedPosition = m_specifications.m_actuatedPosition = true;
    m_deviceAvailable = true;
  }

  void put(const ebac::Axes& x, const ebac::Axes& v) {
    x_ = to_chai(x);
    v_ = to_chai(v);
  }
  ebac::Axes force() const { return from_chai(force_); }

  bool open() override { return m_deviceReady = true; }
  bool close() override { return !(m_deviceReady = false); }
  bool calibrate(bool) override { return true; }
  bool getPosition(chai3d::cVector3d& x) override { return x = x_, true; }
  bool getLinearVelocity(chai3d::cVector3d& v) override { return v = v_, true; }
  bool getRotation(chai3d::cMatrix3d& turn) override { return turn.identity(), true; }
  bool setForceAndTorqueAndGripperForce(const chai3d::cVector3d& force, const chai3d::cVector3d&,
                                        double) override {
    return force_ = force, true;
  }

 private:
  chai3d::cVector3d x_{0, 0, 0};
  chai3d::cVector3d v_{0, 0, 0};
  chai3d::cVector3d force_{0, 0, 0};
};

/// A scene of CHAI3D as what the handle meets: its forces under the laws of ebac.
///
/// CHAI3D allocates now and then in a contact, so this is for simulation; on hardware its scene belongs into a thread of
/// its own (HapticDevice).
class ChaiWorld final : public ebac::World {
 public:
  using Build = std::function<void(chai3d::cWorld&)>;

  /// `build` fills an empty scene; `tool`: radius of what touches it [m].
  explicit ChaiWorld(Build build, double tool = 0)
      : build_(std::move(build)), radius_(tool), scene_(std::make_unique<chai3d::cWorld>()) {
    build_(*scene_);
    tool_ = add_tool(*scene_, probe_, radius_);
  }
  ~ChaiWorld() override = default;
  ChaiWorld(const ChaiWorld&) = delete;
  ChaiWorld& operator=(const ChaiWorld&) = delete;
  ChaiWorld(ChaiWorld&&) = delete;
  ChaiWorld& operator=(ChaiWorld&&) = delete;

  ebac::ContactForce contact(const ebac::Axes& x, const ebac::Axes& v, double) EBAC_RT override {
    probe_->put(x, v);
    haptic_pass(*scene_, *tool_);
    return contact_.of(-probe_->force());  // CHAI3D's acts on the handle
  }

  std::unique_ptr<ebac::World> fresh() const override {
    return std::make_unique<ChaiWorld>(build_, radius_);
  }

 private:
  Build build_;
  double radius_;
  std::shared_ptr<Probe> probe_ = std::make_shared<Probe>();
  std::unique_ptr<chai3d::cWorld> scene_;
  chai3d::cToolCursor* tool_ = nullptr;  // the scene's
  ForceContact contact_;
};

}  // namespace chai
