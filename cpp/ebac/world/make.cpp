#include "ebac/world/make.hpp"

#include <utility>

#include "ebac/world/scene.hpp"

namespace ebac::world {

SolidPtr make_solid(const AnyShape& shape) {
  return std::visit(
      [](const auto& one) -> SolidPtr {
        return std::make_shared<SolidOf<std::decay_t<decltype(one)>>>(one);
      },
      shape);
}

SolidPtr make_tube(std::vector<Tube::Point> points) {
  return std::make_shared<Tube>(std::move(points));
}

SolidPtr make_grid(const DistanceGrid::Layout& layout, std::vector<float> far,
                   std::vector<std::int32_t> index, std::vector<float> nodes) {
  return std::make_shared<DistanceGrid>(layout, std::move(far), std::move(index), std::move(nodes));
}

SolidPtr inverted(SolidPtr solid) { return std::make_shared<Inverted>(std::move(solid)); }
SolidPtr unite(std::vector<SolidPtr> solids) { return std::make_shared<Union>(std::move(solids)); }
SolidPtr intersect(std::vector<SolidPtr> solids) {
  return std::make_shared<Intersection>(std::move(solids));
}
SolidPtr placed(SolidPtr solid, const Axes& at, const Eigen::Quaterniond& turned) {
  return std::make_shared<Placed>(std::move(solid), at, turned);
}
SolidPtr textured(SolidPtr solid, const Texture& texture) {
  return std::make_shared<Textured>(std::move(solid), texture);
}

std::unique_ptr<World> make_scene(const std::vector<BodyParts>& bodies) {
  std::vector<Body> made;
  made.reserve(bodies.size());
  for (const BodyParts& parts : bodies)
    made.emplace_back(parts.solid, parts.material, parts.friction, parts.motion);
  return std::make_unique<Scene>(std::move(made));
}

}  // namespace ebac::world
