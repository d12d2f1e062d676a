#pragma once

#include <effects/CEffectSurface.h>
#include <graphics/CPrimitives.h>
#include <world/CMesh.h>
#include <world/CShapeBox.h>
#include <world/CWorld.h>

#include <array>
#include <string_view>

/// Scenes of CHAI3D. The nearest surface lies 10 mm from the origin along x.
namespace chai {

struct Scene {
  std::string_view name;
  double tool;  // m, radius of what touches it
  void (*build)(chai3d::cWorld&, double stiffness);
};

inline constexpr double kSurface = 0.01;  // m
inline constexpr double kSide = 0.1;      // m
inline constexpr double kBall = 0.005;    // m

inline void box_shape(chai3d::cWorld& world, double stiffness) {
  auto* box = new chai3d::cShapeBox(kSide, kSide, kSide);
  box->setLocalPos(kSurface + kSide / 2, 0, 0);
  box->m_material->setStiffness(stiffness);
  box->addEffect(new chai3d::cEffectSurface(box));
  world.addChild(box);
}

/// `tool`: radius of what will touch it [m]; CHAI3D finds no contact of a larger one.
inline void add_mesh(chai3d::cWorld& world, chai3d::cMesh* mesh, double x, double stiffness,
                     double tool = 0) {
  mesh->setLocalPos(x, 0, 0);
  mesh->m_material->setStiffness(stiffness);
  mesh->createAABBCollisionDetector(tool);
  world.addChild(mesh);
}

inline void box_mesh(chai3d::cWorld& world, double stiffness) {
  auto* mesh = new chai3d::cMesh();
  chai3d::cCreateBox(mesh, kSide, kSide, kSide);
  add_mesh(world, mesh, kSurface + kSide / 2, stiffness);
}

/// The scene of the paper, Fig. 10: a ball that the handle moves, and a wall.
inline void ball_and_wall(chai3d::cWorld& world, double stiffness) {
  auto* mesh = new chai3d::cMesh();
  chai3d::cCreateBox(mesh, 0.01, 2 * kSide, 2 * kSide);
  add_mesh(world, mesh, kSurface + kBall + 0.005, stiffness, kBall);
}

inline void sphere_mesh(chai3d::cWorld& world, double stiffness) {
  auto* mesh = new chai3d::cMesh();
  chai3d::cCreateSphere(mesh, 0.05, 32, 32);  // 2048 triangles
  add_mesh(world, mesh, kSurface + 0.05, stiffness);
}

inline constexpr std::array kScenes{
    Scene{"box shape", 0, box_shape},
    Scene{"box mesh", 0, box_mesh},
    Scene{"ball and wall", kBall, ball_and_wall},
    Scene{"sphere mesh", 0, sphere_mesh},
};

}  // namespace chai
