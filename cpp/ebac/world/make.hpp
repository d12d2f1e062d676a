#pragma once

#include <Eigen/Geometry>
#include <memory>
#include <variant>
#include <vector>

#include "ebac/model/world.hpp"
#include "ebac/world/distance_grid.hpp"
#include "ebac/world/material.hpp"
#include "ebac/world/motion.hpp"
#include "ebac/world/shapes.hpp"
#include "ebac/world/textured.hpp"
#include "ebac/world/tube.hpp"

/// Solids and worlds from their parts.
namespace ebac::world {

using AnyShape = std::variant<Plane, Sphere, Box, Cylinder, Capsule, Torus>;

SolidPtr make_solid(const AnyShape& shape);
SolidPtr make_tube(std::vector<Tube::Point> points);
SolidPtr make_grid(const DistanceGrid::Layout& layout, std::vector<float> far,
                   std::vector<std::int32_t> index, std::vector<float> nodes);
SolidPtr inverted(SolidPtr solid);
SolidPtr unite(std::vector<SolidPtr> solids);
SolidPtr intersect(std::vector<SolidPtr> solids);
SolidPtr placed(SolidPtr solid, const Axes& at, const Eigen::Quaterniond& turned);
SolidPtr textured(SolidPtr solid, const Texture& texture);

/// Parts of a body.
struct BodyParts {
  SolidPtr solid;
  Material material;
  double friction = 0;  // Coulomb's coefficient
  Swing motion;
};

std::unique_ptr<World> make_scene(const std::vector<BodyParts>& bodies);

}  // namespace ebac::world
