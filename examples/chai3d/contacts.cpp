// Time of a contact with a mesh by CHAI3D's proxy, for `ebac bench --worlds --chai3d PROGRAM`.
#include <world/CMesh.h>

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <ebac/core/best_time.hpp>
#include <fstream>
#include <vector>

#include "chai_world.hpp"

namespace {

/// Numbers of vertices, triangles and places; then these, three numbers each. The first place lies outside.
struct Input {
  std::vector<ebac::Axes> vertices;
  std::vector<std::array<std::int64_t, 3>> triangles;
  std::vector<ebac::Axes> places;
};

template <class T>
bool read(std::ifstream& file, std::vector<T>& values, std::int64_t count) {
  if (count < 1 || count > 100'000'000) return false;
  values.resize(static_cast<std::size_t>(count));
  return static_cast<bool>(file.read(reinterpret_cast<char*>(values.data()),
                                     static_cast<std::streamsize>(values.size() * sizeof(T))));
}

bool read(const char* name, Input& input) {
  std::ifstream file(name, std::ios::binary);
  std::vector<std::int64_t> counts;
  return read(file, counts, 3) && read(file, input.vertices, counts[0]) &&
         read(file, input.triangles, counts[1]) && read(file, input.places, counts[2]) &&
         counts[2] > 1;
}

void build(const Input& input, chai3d::cWorld& world) {
  auto* mesh = new chai3d::cMesh();
  for (const ebac::Axes& at : input.vertices) mesh->newVertex(at[0], at[1], at[2]);
  for (const auto& corner : input.triangles) {
    mesh->newTriangle(static_cast<unsigned>(corner[0]), static_cast<unsigned>(corner[1]),
                      static_cast<unsigned>(corner[2]));
  }
  mesh->m_material->setStiffness(1e4);
  mesh->createAABBCollisionDetector(0);
  world.addChild(mesh);
}

}  // namespace

int main(int count, char** arguments) {
  Input input;
  if (count != 3 || !read(arguments[1], input)) {
    std::fprintf(stderr, "usage: %s FILE REPEATS\n", arguments[0]);
    return 2;
  }
  chai3d::cWorld world;
  build(input, world);
  const auto probe = std::make_shared<chai::Probe>();
  probe->put(input.places.front(), ebac::Axes::Zero());
  chai3d::cToolCursor* tool = chai::add_tool(world, probe, 0);
  chai3d::cAlgorithmFingerProxy& proxy = *tool->m_hapticPoint->m_algorithmFingerProxy;

  const chai3d::cVector3d still(0, 0, 0);
  double depth = 0;
  const double ns =
      ebac::best_nanoseconds(std::max(1, std::atoi(arguments[2])), input.places.size() - 1, [&] {
        depth = 0;
        for (std::size_t i = 1; i < input.places.size(); ++i)
          depth += proxy.computeForces(chai::to_chai(input.places[i]), still).length() / 1e4;
      });
  std::printf("{\"contact_s\": %.6g, \"mean_depth_m\": %.6g}\n", 1e-9 * ns,
              depth / static_cast<double>(input.places.size() - 1));
}
