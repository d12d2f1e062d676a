// Nothing on the tick path allocates: counted by the program's own operator new.
#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <new>
#include <string>
#include <thread>
#include <tuple>
#include <vector>

#include "ebac/control/law_type.hpp"
#include "ebac/control/laws.hpp"
#include "ebac/rt/thread.hpp"
#include "ebac/sensor/with_force_sensor.hpp"
#include "ebac/sim/simulate.hpp"
#include "ebac/simulated_drives/joystick.hpp"
#include "ebac/simulated_drives/through_can.hpp"
#include "ebac/world/engine/bridge.hpp"
#include "ebac/world/make.hpp"
#include "through_udp.hpp"

namespace {
std::size_t allocations = 0;  // of one thread, as most tests have
std::size_t frees = 0;
std::atomic<bool> others_get_none = false;  // no memory but for the first thread
const std::thread::id first_thread = std::this_thread::get_id();

void* counted(std::size_t size, std::size_t alignment) {
  if (others_get_none && std::this_thread::get_id() != first_thread) throw std::bad_alloc();
  ++allocations;
  // aligned_alloc wants a whole multiple of the alignment.
  void* memory = std::aligned_alloc(alignment, (size + alignment) / alignment * alignment);
  if (memory == nullptr) throw std::bad_alloc();
  return memory;
}
}  // namespace

void* operator new(std::size_t size) { return counted(size, alignof(std::max_align_t)); }
void* operator new(std::size_t size, std::align_val_t alignment) {
  return counted(size, static_cast<std::size_t>(alignment));
}
void operator delete(void* memory) noexcept { ++frees, std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { ++frees, std::free(memory); }
void operator delete(void* memory, std::align_val_t) noexcept { ++frees, std::free(memory); }
void operator delete(void* memory, std::size_t, std::align_val_t) noexcept {
  ++frees, std::free(memory);
}

namespace ebac::realtime_test {
namespace {

constexpr int kTicks = 10'000;

/// Into the wall and out of it again, so that every branch of a law runs.
Setup busy() {
  Setup setup;
  setup.hand.path[0] = Tapping{};
  setup.seconds = (kTicks - 1) * setup.timing.dt;
  return setup;
}

template <Controller Law>
Law designed(const Setup& setup) {
  return Law(Law::Params::design(setup.device.facts(), setup.timing), setup.timing);
}

/// Allocations of a closed loop of `kTicks`, its preparation apart.
std::size_t allocations_of_loop(const Setup& setup, const AnyLaw& law) {
  auto loop = simulated_loop(setup, PerAxis<AnyLaw>(law));
  const auto trace = loop.make_trace(row_count(setup));
  const std::size_t before = allocations;
  loop.run(*trace);
  const std::size_t after = allocations;
  EXPECT_EQ(trace->size(), kTicks);
  return after - before;
}

template <Controller Law>
std::size_t allocations_of_loop(const Setup& setup) {
  return allocations_of_loop(setup, any_law(designed<Law>(setup)));
}

template <class Tuple>
struct AsTypes;
template <class... Law>
struct AsTypes<std::tuple<Law...>> {
  using Types = testing::Types<Law...>;
};

struct LawNames {
  template <class Law>
  static std::string GetName(
      int) {  // NOLINT(readability-identifier-naming): GoogleTest asks for it
    return std::string(Law::kName);
  }
};

template <class Law>
class Realtime : public testing::Test {};
TYPED_TEST_SUITE(Realtime, AsTypes<Laws>::Types, LawNames);

TEST(Counting, SeesAnAllocation) {
  const std::size_t before = allocations;
  const std::vector<double> some(10);
  EXPECT_EQ(allocations, before + 1);
}

/// It would end the process, and with it a loop that drives motors.
TEST(Thread, WithoutMemoryForItsReportIsAnExceptionOfTheCaller) {
  int runs = 0;
  others_get_none = true;
  try {
    const rt::Thread thread(rt::Mode::kAuto, {.lock_memory = false}, [&] { ++runs; });
    others_get_none = false;
    ADD_FAILURE() << "it started";
  } catch (const std::bad_alloc&) {
    others_get_none = false;
  }
  EXPECT_EQ(runs, 0);
}

/// Nor does a change of a running loop that has no memory for it.
TEST(ParameterUpdates, WithoutMemoryForALawIsAnExceptionOfTheCaller) {
  const AnyLaw law = any_law(designed<Direct>(busy()));
  ParameterUpdates<PerAxis<AnyLaw>> updates(law);
  bool refused = false;
  std::thread poster([&] {
    others_get_none = true;
    try {
      updates.post(law);
    } catch (const std::bad_alloc&) {
      refused = true;
    }
    others_get_none = false;
  });
  poster.join();
  EXPECT_TRUE(refused);
  EXPECT_EQ(updates.post(law), 1u);  // as if nothing had been
}

TYPED_TEST(Realtime, StepsOfALawDoNotAllocate) {
  const Setup setup = busy();
  auto law = designed<TypeParam>(setup);
  const auto trace = simulate(setup, law);
  law.reset();
  const std::size_t before = allocations;
  double sum = 0;
  for (std::size_t row = 0; row < kTicks; ++row) sum += law.step(trace->sample(row).axis[0].port);
  EXPECT_EQ(allocations, before);
  EXPECT_TRUE(std::isfinite(sum));
}

TYPED_TEST(Realtime, LoopDoesNotAllocate) { EXPECT_EQ(allocations_of_loop<TypeParam>(busy()), 0); }

TEST(Bus, LoopThroughItDoesNotAllocate) {
  ebac::Setup setup = busy();
  setup.device.kinematics = Linear{.axes = 2};
  auto device = can::device_through_can<SimulatedDevice>(setup);
  device.switch_on();
  Loop loop(std::move(device), VirtualClock(setup.timing.dt, 0, 1),
            PerAxis<Ebac>(designed<Ebac>(setup)),
            SignalChain(setup.device, setup.environment, setup.timing), 2);
  const auto trace = loop.make_trace(kTicks);
  const std::size_t before = allocations;
  loop.run(*trace);
  EXPECT_EQ(allocations, before);
  EXPECT_EQ(trace->size(), kTicks);
  EXPECT_EQ(loop.sample().fault, Fault::kNone);
}

TEST(Sensor, LoopWithOneOnTheNetworkDoesNotAllocate) {
  const auto setup = busy();
  auto cell = std::make_shared<sensor::SharedForce>();
  sensor::WithForceSensor device(sensor::ForcePublisher(SimulatedDevice(setup), cell),
                                 sensor::StepSensor(cell));
  Loop loop(std::move(device), VirtualClock(setup.timing.dt, 0, 1),
            PerAxis<Ebac>(designed<Ebac>(setup)),
            SignalChain(setup.device, setup.environment, setup.timing), 1);
  const auto trace = loop.make_trace(kTicks);
  const std::size_t before = allocations;
  loop.run(*trace);
  EXPECT_EQ(allocations, before);
  EXPECT_EQ(loop.device().sensor().state(0).received, kTicks);
}

TYPED_TEST(Realtime, LoopWithEverythingOnDoesNotAllocate) {
  Setup setup = busy();
  setup.device.kinematics = Linear{.axes = 3};
  setup.device.mechanics.coulomb = 1;
  setup.device.mechanics.gravity = 9.81;
  setup.device.sensor = {.noise = 0.2, .quantum = 0.01};
  setup.device.velocity = AdaptiveWindow{};
  setup.device.compensation = {.gravity_mass = 0.1, .friction = 0.5, .inertia = 0.005};
  setup.hand.path = {Recorded({0, 1, 2}, {0, 0.04, -0.01}), Sine{}, MinimumJerk{}};
  setup.hand.tremor_amplitude = 1e-3;
  setup.hand.release_at = 5;
  setup.environment = Corner{};
  setup.jitter = 0.2;
  EXPECT_EQ(allocations_of_loop<TypeParam>(setup), 0);
}

TYPED_TEST(Realtime, LoopOfACoupledDeviceDoesNotAllocate) {
  Setup setup = busy();
  setup.device.kinematics = Gimbal{};
  setup.environment = Wall{.angle = 0.5};
  EXPECT_EQ(allocations_of_loop<TypeParam>(setup), 0);
}

TEST(Hands, ModelsDoNotAllocate) {
  for (const HandModel& model : {HandModel(Reflex{}), HandModel(FingerPad{}),
                                 HandModel(NonlinearGrip{}), HandModel(LetGo{.period = 1})}) {
    ebac::Setup setup = busy();
    setup.hand.model = model;
    EXPECT_EQ(allocations_of_loop<Ebac>(setup), 0) << "model " << model.index();
  }
}

TEST(Realtime, SimulatedDrivesDoNotAllocate) {
  ebac::Setup setup = busy();
  setup.device.kinematics = Gimbal{};
  can::Joystick<SimulatedDevice> joystick(SimulatedDevice(setup), setup.device);
  const std::size_t before = allocations;
  can::Frame said;
  for (int tick = 0; tick < kTicks; ++tick) {
    const auto low = static_cast<std::uint8_t>(tick % 256);
    joystick.elapse(1e-3);
    joystick.receive(can::frame(can::kNmt, {1, 0}));
    joystick.receive(can::frame(can::rpdo(1, 1), {low, 0}));
    joystick.receive(can::frame(can::sdo_request(1), {0x40, 0x08, 0x10, 0, 0, 0, 0, 0}));
    joystick.receive(can::frame(can::sdo_request(1), {0x60, 0, 0, 0, 0, 0, 0, 0}));
    joystick.receive(can::frame(can::sdo_request(2), {0x2F, 0, 0x5F, 0, low, 0, 0, 0}));
    joystick.receive(can::frame(can::kSync, {}));
    while (joystick.take(said)) {
    }
  }
  EXPECT_EQ(allocations, before);
}

/// A body of each kind of solid, some with friction, one that moves.
Environment bodies() {
  using namespace world;
  const SolidPtr ball = make_solid(Sphere{});
  const SolidPtr box = placed(make_solid(Box{}), {0.02, 0, 0}, Eigen::Quaterniond::Identity());
  const SolidPtr tube = inverted(make_tube({{{-0.1, 0, 0}, 0.05}, {{0.1, 0, 0}, 0.06}}));
  const Layered tissue({Layer{.puncture = 1}, Layer{}}, 2);
  return External{make_scene(
      {{.solid = unite({box, textured(ball, Texture{})}), .material = Elastic{}},
       {.solid = tube, .material = HuntCrossley{}, .friction = 0.3},
       {.solid = make_solid(Torus{}), .material = tissue, .motion = {.amplitude_x = 0.01}}})};
}

TEST(Realtime, AWorldOfBodiesDoesNotAllocate) {
  ebac::Setup setup = busy();
  setup.device.kinematics = Linear{.axes = 3};
  setup.environment = bodies();
  EXPECT_EQ(allocations_of_loop<Ebac>(setup), 0);
}

TEST(Realtime, ABridgeToAnEngineDoesNotAllocate) {
  const world::EngineTiming timing{.rate = 60, .compute = 0.01, .jitter = 0.01};
  auto scene = std::get<External>(bodies()).world;
  auto engine = std::make_unique<world::SceneEngine>(dynamic_cast<world::Scene&>(*scene));
  ebac::Setup setup = busy();
  setup.device.kinematics = Linear{.axes = 3};
  setup.environment = External{make_scheduled(std::move(engine), timing, {}, false)};
  EXPECT_EQ(allocations_of_loop<Ebac>(setup), 0);
  setup.environment = External{make_posted(std::make_shared<world::EngineChannel>(), {})};
  EXPECT_EQ(allocations_of_loop<Ebac>(setup), 0);
}

TEST(Realtime, AnotherWorldFreesNothing) {
  SignalChain chain(DeviceModel{}, bodies(), {});
  const Environment next = fresh(bodies());
  const std::size_t before = frees;
  chain.change(next);
  chain.change(Wall{});
  chain.change(next);
  EXPECT_EQ(frees, before);
}

}  // namespace
}  // namespace ebac::realtime_test
