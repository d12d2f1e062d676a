#include <pybind11/eigen.h>
#include <pybind11/stl.h>

#include <memory>
#include <variant>

#include "bind.hpp"
#include "fields.hpp"
#include "worlds.hpp"
#include "ebac/world/scene.hpp"
#include "ebac/world/shapes.hpp"

namespace ebac::python {

namespace {

using namespace ebac::world;

using AnyShape = std::variant<Plane, Sphere, Box, Cylinder, Capsule, Torus>;

SolidPtr solid_of(const AnyShape& shape) {
  return std::visit(
      [](const auto& one) -> SolidPtr {
        return std::make_shared<SolidOf<std::decay_t<decltype(one)>>>(one);
      },
      shape);
}

/// Distance and normal at each row of `points`, shape (n, 3).
py::tuple distances(const SolidPtr& solid, const Eigen::Ref<const Eigen::MatrixX3d>& points) {
  Eigen::VectorXd d(points.rows());
  Eigen::MatrixX3d out(points.rows(), 3);
  for (Eigen::Index i = 0; i < points.rows(); ++i) {
    const Distance at = solid->distance(points.row(i));
    d[i] = at.d;
    out.row(i) = at.out;
  }
  return py::make_tuple(d, out);
}

}  // namespace

void bind_worlds(py::module_& m) {
  bind_fields<Plane>(m, "Plane", "All that lies behind the plane x = 0.");
  bind_fields<Sphere>(m, "Sphere", "A ball about the origin.");
  bind_fields<Box>(m, "Box", "A box about the origin, along the axes.");
  bind_fields<Cylinder>(m, "Cylinder", "A cylinder about the z axis.");
  bind_fields<Capsule>(m, "Capsule", "A cylinder about the z axis with half a sphere on each end.");
  bind_fields<Torus>(m, "Torus", "A ring about the z axis.");
  bind_fields<Elastic>(m, "Elastic", "A spring and damper, eq. (12); a Kelvin-Voigt body.");
  bind_fields<HuntCrossley>(m, "HuntCrossley", "Soft tissue after Hunt and Crossley (1975).");
  bind_fields<Layer>(m, "Layer", "One layer of tissue.");
  bind_fields<Swing>(m, "Swing", "A body's motion: to and fro along a direction, turning about another.");
  py::class_<Layered>(m, "_Layered").def(py::init([](const std::vector<Layer>& layers) {
    if (layers.empty() || layers.size() > Layered::kMost)
      throw std::invalid_argument("Layered: " + std::to_string(layers.size()) +
                                  " layers: must be 1 to " + std::to_string(Layered::kMost));
    std::array<Layer, Layered::kMost> made{};
    std::copy(layers.begin(), layers.end(), made.begin());
    return Layered(made, layers.size());
  }));
  py::class_<Solid, std::shared_ptr<Solid>>(m, "_Solid")
      .def("distances", [](const std::shared_ptr<Solid>& solid,
                           const Eigen::Ref<const Eigen::MatrixX3d>& points) {
        return distances(solid, points);
      });
  const auto shared = [](const SolidPtr& solid) { return std::const_pointer_cast<Solid>(solid); };
  m.def("_solid", [shared](const AnyShape& shape) { return shared(solid_of(shape)); });
  m.def("_inverted", [](const std::shared_ptr<Solid>& solid) -> std::shared_ptr<Solid> {
    return std::make_shared<Inverted>(solid);
  });
  m.def("_union", [](const std::vector<std::shared_ptr<Solid>>& all) -> std::shared_ptr<Solid> {
    return std::make_shared<Union>(std::vector<SolidPtr>(all.begin(), all.end()));
  });
  m.def("_intersection", [](const std::vector<std::shared_ptr<Solid>>& all) -> std::shared_ptr<Solid> {
    return std::make_shared<Intersection>(std::vector<SolidPtr>(all.begin(), all.end()));
  });
  m.def("_placed", [](const std::shared_ptr<Solid>& solid, const Axes& at,
                      const Axes& turned) -> std::shared_ptr<Solid> {
    const double angle = turned.norm();
    const Axes axis = angle > 0 ? Axes(turned / angle) : Axes::UnitX();
    return std::make_shared<Placed>(solid, at, Eigen::Quaterniond(Eigen::AngleAxisd(angle, axis)));
  });
  py::class_<External>(m, "_External");
  py::class_<HeldWorld, External>(m, "_World")
      .def("contact", [](const HeldWorld& world, const Axes& x, const Axes& v, double t) {
        const ContactForce touch = world.world->contact(x, v, t);
        return py::make_tuple(touch.force, Axes(touch.frame.row(0)), touch.depth, touch.stiffness);
      }, py::arg("x"), py::arg("v"), py::arg("t") = 0.0)
      .def("fresh", [](const HeldWorld& world) { return HeldWorld(world.world->fresh()); });
  using Made = std::tuple<std::shared_ptr<Solid>, Material, double, Swing>;
  m.def("_scene", [](const std::vector<Made>& bodies) {
    std::vector<Body> all;
    for (const auto& [solid, material, friction, motion] : bodies)
      all.emplace_back(solid, material, friction, motion);
    return HeldWorld(std::make_unique<Scene>(std::move(all)));
  });
}

}  // namespace ebac::python
