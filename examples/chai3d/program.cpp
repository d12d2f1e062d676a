// An ordinary program of CHAI3D on a device of ebac: the haptic loop is the one of its own examples.
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <ebac/sim/simulate.hpp>
#include <ebac/simulated_drives/through_can.hpp>
#include <string>
#include <vector>

#include "engine_device.hpp"
#include "haptic_device.hpp"
#include "result.hpp"
#include "scene_list.hpp"

namespace {

struct Choice {
  std::string law;  // all if empty
  std::string scene = "sphere mesh";
  double stiffness = 2e4;  // N/m
  double seconds = 4;      // s
  bool realtime = false;   // at 1 kHz of the machine's clock
  bool can = false;        // over a CAN bus, through simulated CANopen drives
  bool hold = false;       // forces as they come, no plane through them
  bool engine = false;     // the device is a loop's in another process
  bool json = false, check = false;
};

/// The device: a simulated joystick of three axes, directly or behind drives.
std::shared_ptr<chai::HapticDevice> device_for(const Choice& choice, std::string_view law) {
  const ebac::Setup setup = chai::setup_of(choice.seconds);
  const chai::RunOptions options{.device = setup.device,
                                 .timing = setup.timing,
                                 .loop = setup.loop,
                                 .stiffness = choice.hold ? 0 : choice.stiffness,
                                 .rows = ebac::row_count(setup)};
  const ebac::AnyLaw made = chai::law_of(law, setup);
  const auto with = [&]<class C, class D>(D device) -> std::unique_ptr<chai::Runner> {
    return std::make_unique<chai::LoopRunner<D, C>>(std::move(device), options, made);
  };
  const auto at_its_pace = [&]<class D>(D device) {
    return choice.realtime ? with.operator()<ebac::rt::MonotonicClock>(std::move(device))
                           : with.operator()<chai::SteppedClock>(std::move(device));
  };
  if (!choice.can)
    return std::make_shared<chai::HapticDevice>(at_its_pace(ebac::SimulatedDevice(setup)),
                                                !choice.realtime);
  auto drives = ebac::can::device_through_can<ebac::SimulatedDevice>(setup);
  drives.switch_on();
  return std::make_shared<chai::HapticDevice>(at_its_pace(std::move(drives)), !choice.realtime);
}

chai::Result run(const Choice& choice, const chai::Scene& scene, std::string_view law) {
  const auto device = device_for(choice, law);
  chai3d::cWorld world;
  scene.build(world, choice.stiffness);
  chai3d::cToolCursor* tool = chai::add_tool(world, device, scene.tool);

  const auto start = std::chrono::steady_clock::now();
  while (device->running()) chai::haptic_pass(world, *tool);  // the haptic thread
  const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - start;
  tool->stop();

  chai::Result result{.scene = scene.name, .law = law, .stiffness = choice.stiffness};
  chai::measure(device->trace(), result);
  result.tick = taken.count() / static_cast<double>(result.ticks);
  return result;
}

/// The same program, started by `ebac run --engine-command`: it ends with that loop.
int serve(const Choice& choice, const chai::Scene& scene) {
  const auto device = std::make_shared<chai::EngineDevice>(choice.stiffness);
  chai3d::cWorld world;
  scene.build(world, choice.stiffness);
  chai3d::cToolCursor* tool = nullptr;
  try {
    tool = chai::add_tool(world, device, scene.tool);
  } catch (const std::exception& error) {  // there is no loop
    std::fprintf(stderr, "%s\n", error.what());
    return 2;
  }
  while (device->running()) chai::haptic_pass(world, *tool);  // the haptic thread
  std::printf("%ld forces were posted\n", device->posted());
  return 0;
}

int usage(const char* name) {
  std::fprintf(stderr,
               "usage: %s [--law NAME] [--scene NAME] [--stiffness N_PER_M] [--seconds S] "
               "[--realtime] [--can] [--hold] "
               "[--json | --check]\n"
               "       %s --engine [--scene NAME] [--stiffness N_PER_M], started by `ebac run FILE "
               "--engine-command`\n",
               name, name);
  return 2;
}

bool parse(int count, char** arguments, Choice& choice) {
  for (int i = 1; i < count; ++i) {
    const std::string_view name = arguments[i];
    const char* value = i + 1 < count ? arguments[i + 1] : nullptr;
    if (name == "--realtime")
      choice.realtime = true;
    else if (name == "--can")
      choice.can = true;
    else if (name == "--hold")
      choice.hold = true;
    else if (name == "--engine")
      choice.engine = true;
    else if (name == "--json")
      choice.json = true;
    else if (name == "--check")
      choice.check = true;
    else if (value == nullptr)
      return false;
    else if (name == "--law")
      choice.law = value, ++i;
    else if (name == "--scene")
      choice.scene = value, ++i;
    else if (name == "--stiffness")
      choice.stiffness = std::atof(value), ++i;
    else if (name == "--seconds")
      choice.seconds = std::atof(value), ++i;
    else
      return false;
  }
  return choice.stiffness > 0 && choice.seconds >= 0.1 && choice.seconds <= 3600;
}

}  // namespace

int main(int count, char** arguments) {
  Choice choice;
  if (!parse(count, arguments, choice)) return usage(arguments[0]);
  const chai::Scene* scene = nullptr;
  for (const chai::Scene& one : chai::kScenes) {
    if (one.name == choice.scene) scene = &one;
  }
  if (scene == nullptr) return usage(arguments[0]);
  if (choice.engine) return serve(choice, *scene);
  std::vector<std::string> laws{"direct", "ebac"};
  if (!choice.law.empty()) laws = {choice.law};

  std::vector<chai::Result> results;
  if (!choice.json) chai::print_head();
  bool as_expected = true;
  try {
    for (const std::string& law : laws) {
      results.push_back(run(choice, *scene, law));
      if (!choice.json) chai::print_row(results.back());
      if (law == "ebac") as_expected = as_expected && chai::quiet(results.back());
    }
  } catch (const std::invalid_argument& error) {  // no law of that name
    std::fprintf(stderr, "%s\n", error.what());
    return 2;
  }
  if (choice.json) chai::print_json("chai3d_program", results);
  return choice.check && !as_expected ? 1 : 0;
}
