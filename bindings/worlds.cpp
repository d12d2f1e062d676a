#include <pybind11/eigen.h>
#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <memory>
#include <tuple>
#include <utility>
#include <vector>

#include "bind.hpp"
#include "ebac/core/best_time.hpp"
#include "ebac/model/environment.hpp"
#include "ebac/world/make.hpp"
#include "engine_process.hpp"
#include "engines.hpp"
#include "fields.hpp"
#include "held_solid.hpp"

namespace ebac::python {

namespace {

using namespace ebac::world;

using Points = Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>;
template <class T>
using Array = py::array_t<T, py::array::c_style | py::array::forcecast>;

/// Distance and normal at each row of `points`, shape (n, 3).
std::pair<Eigen::VectorXd, Points> distances(const HeldSolid& held, const Points& points) {
  Eigen::VectorXd d(points.rows());
  Points out(points.rows(), 3);
  for (Eigen::Index i = 0; i < points.rows(); ++i) {
    const Distance at = held.solid->distance(points.row(i));
    d[i] = at.d;
    out.row(i) = at.out;
  }
  return {d, out};
}

std::vector<Axes> rows_of(const Points& points) {
  std::vector<Axes> rows;
  rows.reserve(static_cast<std::size_t>(points.rows()));
  for (Eigen::Index i = 0; i < points.rows(); ++i) rows.emplace_back(points.row(i));
  return rows;
}

/// Of one distance, at each row of `points` in turn [ns].
double time_distances(const HeldSolid& held, const Points& points, int repeats) {
  const std::vector<Axes> places = rows_of(points);
  [[maybe_unused]] volatile double sink = 0;  // so that the work is not optimised away
  return best_nanoseconds(repeats, places.size(), [&] {
    double sum = 0;
    for (const Axes& x : places) {
      const Distance at = held.solid->distance(x);
      sum += at.d + at.out[0];
    }
    sink = sum;
  });
}

/// Of one contact, along a closed path below the surface, which the handle reaches by way of `start` [ns].
double time_contacts(const External& held, const Axes& start, const Points& path, int repeats) {
  const std::vector<Axes> places = rows_of(path);
  const std::unique_ptr<World> world = held.world->fresh();
  world->contact(start, Axes::Zero(), 0);
  [[maybe_unused]] volatile double sink = 0;
  return best_nanoseconds(repeats, places.size(), [&] {
    double sum = 0;
    for (const Axes& x : places) sum += world->contact(x, Axes::Zero(), 0).force[0];
    sink = sum;
  });
}

std::vector<SolidPtr> solids_of(const std::vector<HeldSolid>& held) {
  std::vector<SolidPtr> solids;
  solids.reserve(held.size());
  for (const HeldSolid& one : held) solids.push_back(one.solid);
  return solids;
}

template <class T>
std::vector<T> copy_of(const Array<T>& array) {
  return {array.data(), array.data() + array.size()};
}

HeldSolid grid_of(const Axes& origin, double cell, double margin, const Array<float>& far,
                  const Array<std::int32_t>& index, const Array<float>& nodes) {
  DistanceGrid::Layout layout{.origin = origin, .cell = cell, .margin = margin};
  bool fits = index.ndim() == 3 && far.ndim() == 3;
  for (std::size_t i = 0; fits && i < 3; ++i) {
    const auto axis = static_cast<py::ssize_t>(i);
    layout.bricks[i] = static_cast<int>(index.shape(axis));
    fits = far.shape(axis) == index.shape(axis) + 1;
  }
  const auto bricks =
      static_cast<py::ssize_t>(nodes.size()) / static_cast<py::ssize_t>(DistanceGrid::kBrick);
  for (py::ssize_t i = 0; fits && i < index.size(); ++i)
    fits = index.data()[i] >= DistanceGrid::kFar && index.data()[i] < bricks;
  if (!fits) throw std::invalid_argument("_grid: the arrays do not belong together");
  return {make_grid(layout, copy_of(far), copy_of(index), copy_of(nodes))};
}

void bind_solids(py::module_& m) {
  bind_fields<Plane>(m, "Plane", "All that lies behind the plane x = 0.");
  bind_fields<Sphere>(m, "Sphere", "A ball about the origin.");
  bind_fields<Box>(m, "Box", "A box about the origin, along the axes.");
  bind_fields<Cylinder>(m, "Cylinder", "A cylinder about the z axis.");
  bind_fields<Capsule>(m, "Capsule", "A cylinder about the z axis with half a sphere on each end.");
  bind_fields<Torus>(m, "Torus", "A ring about the z axis.");
  bind_fields<Texture>(m, "Texture", "Waves on a surface, the same in all directions.");
  py::class_<HeldSolid>(m, "_Solid")
      .def("distances", &distances, py::arg("points"))
      .def("_time", &time_distances, py::arg("points"), py::arg("repeats"));
  m.def("_solid", [](const AnyShape& shape) { return HeldSolid{make_solid(shape)}; });
  m.def("_tube", [](const Points& at, const std::vector<double>& radius) {
    if (at.rows() < 2 || static_cast<std::size_t>(at.rows()) != radius.size())
      throw std::invalid_argument("_tube: the arrays do not belong together");
    std::vector<Tube::Point> points;
    points.reserve(radius.size());
    for (Eigen::Index i = 0; i < at.rows(); ++i)
      points.push_back({at.row(i), radius[static_cast<std::size_t>(i)]});
    return HeldSolid{make_tube(std::move(points))};
  });
  m.def("_grid", &grid_of, py::kw_only(), py::arg("origin"), py::arg("cell"), py::arg("margin"),
        py::arg("far"), py::arg("index"), py::arg("nodes"));
  m.def("_inverted", [](const HeldSolid& held) { return HeldSolid{inverted(held.solid)}; });
  m.def("_union",
        [](const std::vector<HeldSolid>& all) { return HeldSolid{unite(solids_of(all))}; });
  m.def("_intersection",
        [](const std::vector<HeldSolid>& all) { return HeldSolid{intersect(solids_of(all))}; });
  m.def("_placed", [](const HeldSolid& held, const Axes& at, const Axes& turned) {
    const double angle = turned.norm();
    const Axes axis = angle > 0 ? Axes(turned / angle) : Axes::UnitX();
    return HeldSolid{placed(held.solid, at, Eigen::Quaterniond(Eigen::AngleAxisd(angle, axis)))};
  });
  m.def("_textured", [](const HeldSolid& held, const Texture& texture) {
    return HeldSolid{textured(held.solid, texture)};
  });
}

void bind_materials(py::module_& m) {
  bind_fields<Elastic>(m, "Elastic", "A spring and damper, eq. (12); a Kelvin-Voigt body.");
  bind_fields<HuntCrossley>(m, "HuntCrossley", "Soft tissue after Hunt and Crossley (1975).");
  bind_fields<Layer>(m, "Layer", "One layer of tissue.");
  bind_fields<Swing>(m, "Swing",
                     "A body's motion: to and fro along a direction, turning about another.")
      .def("still", &Swing::still, "Return whether it does not move at all.");
  py::class_<Layered>(m, "_Layered").def(py::init([](const std::vector<Layer>& layers) {
    if (layers.empty() || layers.size() > Layered::kMost)
      throw std::invalid_argument("Layered: " + std::to_string(layers.size()) +
                                  " layers: must be 1 to " + std::to_string(Layered::kMost));
    std::array<Layer, Layered::kMost> made{};
    std::ranges::copy(layers, made.begin());
    return Layered(made, layers.size());
  }));
}

}  // namespace

void bind_worlds(py::module_& m) {
  bind_solids(m);
  bind_materials(m);
  using Parts = std::tuple<HeldSolid, Material, double, Swing>;
  py::class_<External>(m, "_World")
      .def(py::init([](const std::vector<Parts>& bodies) {
        std::vector<BodyParts> parts;
        parts.reserve(bodies.size());
        for (const auto& [held, material, friction, motion] : bodies)
          parts.push_back({held.solid, material, friction, motion});
        return External{make_scene(parts)};
      }))
      .def(py::init([](const External& other) { return other; }), py::arg("other"))
      .def(
          "contact",
          [](const External& world, const Axes& x, const Axes& v, double t) {
            const ContactForce touch = world.contact(x, v, t);
            return std::tuple(touch.force, Axes(touch.frame.row(0)), touch.depth, touch.stiffness,
                              world.world->stored());
          },
          py::arg("x"), py::arg("v"), py::arg("t"))
      .def("_time", &time_contacts, py::arg("start"), py::arg("path"), py::arg("repeats"))
      .def("reset", [](External& world) { world.world = world.world->fresh(); });
  bind_engines(m);
  bind_engine_process(m);
}

}  // namespace ebac::python
