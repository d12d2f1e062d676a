// Scenes of CHAI3D under the laws of ebac: scene x law x stiffness.
#include <chrono>
#include <cstring>
#include <ebac/sim/simulate.hpp>
#include <vector>

#include "chai_world.hpp"
#include "result.hpp"
#include "scene_list.hpp"

namespace {

chai::Result run(const chai::Scene& scene, std::string_view law, double stiffness) {
  ebac::Setup setup = chai::setup_of(4);
  const auto build = [&](chai3d::cWorld& world) { scene.build(world, stiffness); };
  setup.environment = ebac::External{std::make_shared<chai::ChaiWorld>(build, scene.tool)};
  auto loop = ebac::simulated_loop(setup, ebac::PerAxis<ebac::AnyLaw>(chai::law_of(law, setup)));
  const auto trace = loop.make_trace(ebac::row_count(setup));

  const auto start = std::chrono::steady_clock::now();
  loop.run(*trace);
  const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - start;
  chai::Result result{.scene = scene.name, .law = law, .stiffness = stiffness};
  chai::measure(*trace, result);
  result.tick = taken.count() / static_cast<double>(result.ticks);
  return result;
}

}  // namespace

int main(int count, char** arguments) {
  const bool json = count > 1 && std::strcmp(arguments[1], "--json") == 0;
  const bool check = count > 1 && std::strcmp(arguments[1], "--check") == 0;
  if (count > 1 && !json && !check) {
    std::fprintf(stderr, "usage: %s [--json | --check]\n", arguments[0]);
    return 2;
  }
  if (!json) chai::print_head();
  bool as_expected = true;
  std::vector<chai::Result> results;
  for (const chai::Scene& scene : chai::kScenes) {
    for (const double stiffness : {2e3, 1e4, 2e4}) {
      for (const std::string_view law : {"direct", "tca", "eba", "passivity-control", "ebac"}) {
        if (check && law != "direct" && law != "ebac") continue;
        results.push_back(run(scene, law, stiffness));
        if (!json) chai::print_row(results.back());
        if (law == "ebac") as_expected = as_expected && chai::quiet(results.back());
        if (law == "direct" && stiffness == 2e4)
          as_expected = as_expected && !chai::quiet(results.back());
      }
    }
  }
  if (json) chai::print_json("chai3d_scenes", results);
  if (check && !as_expected)
    std::fprintf(stderr, "ebac must be quiet in all scenes, and direct not at 20 kN/m\n");
  return check && !as_expected ? 1 : 0;
}
