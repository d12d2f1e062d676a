#pragma once

#include <devices/CGenericHapticDevice.h>
#include <tools/CToolCursor.h>
#include <world/CWorld.h>

#include <ebac/model/kinematics.hpp>

namespace chai {

inline constexpr double kWorkspace =
    0.1;  // m, of the tool: the device's metres are those of the scene

inline chai3d::cVector3d to_chai(const ebac::Axes& x) { return {x[0], x[1], x[2]}; }
inline ebac::Axes from_chai(const chai3d::cVector3d& x) { return {x(0), x(1), x(2)}; }

/// A tool of that radius [m] in a scene, which owns it. It renders forces from the first contact on, without a ramp: start
/// and safety are the loop's.
inline chai3d::cToolCursor* add_tool(chai3d::cWorld& world,
                                     const chai3d::cGenericHapticDevicePtr& device, double radius) {
  auto* tool = new chai3d::cToolCursor(&world);
  world.addChild(tool);
  tool->setHapticDevice(device);
  tool->setWorkspaceRadius(device->m_specifications.m_workspaceRadius);
  tool->setRadius(radius);
  tool->setUseForceRise(false);
  tool->setWaitForSmallForce(false);
  world.computeGlobalPositions(true);
  tool->start();
  tool->setForcesON();
  // Its default is too coarse for a point: the proxy would stop a tenth of a millimetre off the surface.
  tool->m_hapticPoint->m_algorithmFingerProxy->setEpsilonBaseValue(1e-6);
  return tool;
}

/// One pass of a haptic thread, as in every example of CHAI3D.
inline void haptic_pass(chai3d::cWorld& world, chai3d::cToolCursor& tool) {
  world.computeGlobalPositions(true);
  tool.updateFromDevice();
  tool.computeInteractionForces();
  tool.applyToDevice();
}

}  // namespace chai
