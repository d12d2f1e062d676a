// An engine in another process: real ones, killed ones, memory of others, and no names left.
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <functional>
#include <set>
#include <stdexcept>
#include <string_view>
#include <system_error>
#include <thread>

#include "ebac/rt/other_process.hpp"
#include "ebac/world/engine/bridge.hpp"
#include "ebac/world/engine/engine_client.hpp"

namespace ebac::engine_process_test {
namespace {

using namespace ebac::world;

constexpr double kDt = 1e-3;  // s
const Axes kStill = Axes::Zero();
const Axes kInside{0.002, 0, 0};  // m

LocalModel plane(double stiffness) { return {.stiffness = stiffness, .surface = true}; }

/// Another process; killed and waited for at the end.
class Child {
 public:
  explicit Child(const std::function<void()>& work) : process_(fork()) {
    if (process_ != 0) return;
    try {
      work();
      _exit(0);
    } catch (...) {
      _exit(1);
    }
  }
  ~Child() {
    if (process_ <= 0) return;
    kill(process_, SIGKILL);
    wait();
  }
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;
  Child(Child&&) = delete;
  Child& operator=(Child&&) = delete;

  int process() const { return process_; }
  void kill_it() const { kill(process_, SIGKILL); }
  /// Its exit code; -1 for one that was killed.
  int wait() {
    int status = 0;
    waitpid(process_, &status, 0);
    process_ = 0;
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }

 private:
  pid_t process_;
};

void serve(const std::string& name) {
  EngineClient client(name);
  while (client.loop_runs()) {
    if (client.wait_for_pose(0.05) != nullptr) client.post(plane(1000));
  }
}

/// Ticks with the handle inside until the force is what is waited for; the last force [N].
double press(World& world, double& t, const std::function<bool(double)>& enough) {
  double force = 0;
  for (int i = 0; i < 30'000; ++i) {
    force = world.contact(kInside, kStill, t += kDt).force[0];
    if (enough(force)) break;
    std::this_thread::sleep_for(std::chrono::microseconds(500));
  }
  return force;
}

bool there(const std::string& name) { return std::filesystem::exists("/dev/shm" + name); }

/// Processes whose channels have names of their own.
std::set<int> owners() {
  constexpr std::string_view kOwn = "ebac-engine-";
  std::set<int> found;
  for (const auto& file : std::filesystem::directory_iterator("/dev/shm")) {
    const std::string name = file.path().filename().string();
    if (name.starts_with(kOwn)) found.insert(std::stoi(name.substr(kOwn.size())));
  }
  return found;
}

std::string message(const std::function<void()>& work) {
  try {
    work();
  } catch (const std::exception& error) {
    return error.what();
  }
  return "";
}

TEST(SharedEngineChannel, AnEngineInAnotherProcessIsFelt) {
  std::string name;
  {
    SharedEngineChannel channel;
    name = channel.name();
    ASSERT_TRUE(there(name));
    Child engine([&] { serve(name); });
    const auto world = make_posted(channel.channel(), {.stale = 10});
    double t = 0;
    const double force = press(*world, t, [](double f) { return std::abs(f - 2) < 1e-3; });
    EXPECT_NEAR(force, 2, 1e-3);
    EXPECT_EQ(channel.engine(), engine.process());
    EXPECT_TRUE(channel.engine_lives());
    EXPECT_GT(channel.posted(), 0);
    channel.end();
    EXPECT_EQ(engine.wait(), 0);
    EXPECT_FALSE(channel.engine_lives());
  }
  EXPECT_FALSE(there(name));
}

TEST(SharedEngineChannel, TheForceOfAnEngineThatIsKilledInContactFades) {
  SharedEngineChannel channel;
  Child engine([&] { serve(channel.name()); });
  const auto world = make_posted(channel.channel(), {.stale = 1});
  double t = 0;
  EXPECT_NEAR(press(*world, t, [](double f) { return f > 1.9999; }), 2, 1e-3);
  EXPECT_TRUE(channel.engine_lives());
  engine.kill_it();
  EXPECT_EQ(engine.wait(), -1);
  EXPECT_FALSE(channel.engine_lives());
  const double killed = t;
  double before = 3;
  bool falls = true;
  const double end = press(*world, t, [&](double f) {
    falls = falls && f <= before + 1e-3;
    before = f;
    return f == 0;
  });
  EXPECT_EQ(end, 0);
  EXPECT_TRUE(falls);
  EXPECT_LT(t - killed, 1.2);  // stale + fade
  EXPECT_GT(world->report().faded(), 0.09);
}

TEST(SharedEngineChannel, ALoopThatDiesEndsItsEngineAndLeavesNoName) {
  int told[2];
  ASSERT_EQ(pipe(told), 0);
  Child loop([&] {
    const SharedEngineChannel channel;
    const std::string name = channel.name();
    if (write(told[1], name.c_str(), name.size() + 1) < 0) _exit(1);
    pause();
  });
  char name[64];
  ASSERT_GT(read(told[0], name, sizeof name), 0);
  Child engine([&] { serve(name); });
  {
    const rt::SharedMemory memory = rt::SharedMemory::opened(name);
    const auto* segment = static_cast<const EngineSegment*>(memory.at());
    for (int i = 0; i < 5000 && segment->engine == 0; ++i) usleep(1000);
    EXPECT_EQ(segment->engine, engine.process());
  }
  loop.kill_it();
  loop.wait();
  EXPECT_EQ(engine.wait(), 0);
  EXPECT_FALSE(there(name));
  close(told[0]);
  close(told[1]);
}

TEST(SharedEngineChannel, WhatADeadLoopHasLeftIsReplacedAndWhatALivingOneHasIsNot) {
  const std::string mine = "/ebac-test-" + std::to_string(getpid());
  {
    Child loop([&] {
      new SharedEngineChannel(mine);
      new SharedEngineChannel;  // under a name of its own
      const std::string cut = "/dev/shm/ebac-engine-" + std::to_string(getpid()) + "-9";
      std::ofstream{cut};  // as what somebody has truncated
      _exit(0);
    });
    const int process = loop.process();
    EXPECT_EQ(loop.wait(), 0);
    EXPECT_TRUE(there(mine));
    EXPECT_TRUE(owners().contains(process));
    EXPECT_NE(message([&] { const EngineClient client(mine); }).find("has ended"),
              std::string::npos);
  }
  const std::string named =
      "/ebac-engine-" + std::to_string(1 << 30) + "-1";  // as of no living process
  const SharedEngineChannel lives(named);
  const SharedEngineChannel again(mine);
  const SharedEngineChannel cleans;
  EXPECT_TRUE(there(named));
  for (const int process : owners()) {
    EXPECT_TRUE(process == 1 << 30 || rt::process_lives(process)) << process;
  }
  EXPECT_NE(message([&] { const SharedEngineChannel taken(mine); }).find("is taken"),
            std::string::npos);
}

TEST(EngineClient, SaysWhatIsWrongWithAChannel) {
  unsetenv(EngineClient::kVariable);
  EXPECT_NE(message([] { const EngineClient client; }).find("--engine-command"), std::string::npos);
  EXPECT_THROW(EngineClient("no/name"), std::invalid_argument);
  EXPECT_THROW(EngineClient("ebac-nobody"), std::system_error);
  EXPECT_NE(message([] { const EngineClient client("ebac-nobody"); }).find("start the loop first"),
            std::string::npos);

  const std::string name = "/ebac-test-other-" + std::to_string(getpid());
  {
    const rt::SharedMemory foreign = rt::SharedMemory::named(name, 4096);
    EXPECT_NE(message([&] { const EngineClient client(name); }).find("is not one of ebac"),
              std::string::npos);
    auto* segment = new (foreign.at()) EngineSegment();
    segment->layout = EngineSegment::kLayout + 1;
    segment->loop = getpid();
    segment->magic = EngineSegment::kMagic;
    EXPECT_NE(message([&] { const EngineClient client(name); }).find("the same version of ebac"),
              std::string::npos);
    segment->layout = EngineSegment::kLayout;  // but of another size
    EXPECT_NE(message([&] { const EngineClient client(name); }).find("the same version of ebac"),
              std::string::npos);
  }
  {
    const rt::SharedMemory small = rt::SharedMemory::named(name, 8);
    EXPECT_NE(message([&] { const EngineClient client(name); }).find("is not one of ebac"),
              std::string::npos);
  }
  EXPECT_FALSE(there(name));

  SharedEngineChannel channel;
  const EngineClient first(channel.name());
  EXPECT_NE(message([&] { const EngineClient second(channel.name()); }).find("was there first"),
            std::string::npos);
}

TEST(EngineClient, RefusesNumbersThatNoWorldHas) {
  SharedEngineChannel channel;
  EngineClient client(channel.name());
  EXPECT_THROW(client.post(plane(2e7)), std::invalid_argument);
  EXPECT_THROW(client.post(plane(-1)), std::invalid_argument);
  EXPECT_THROW(client.post(plane(std::nan(""))), std::invalid_argument);
  LocalModel slanted = plane(100);
  slanted.into = {1, 1, 0};
  EXPECT_THROW(client.post(slanted), std::invalid_argument);
  EXPECT_EQ(channel.posted(), 0);
  client.post_nothing();
  EXPECT_EQ(channel.posted(), 1);
}

TEST(EngineClient, AForceIsAPlane) {
  const LocalModel made = plane_of_force({0.01, 0, 0}, {0, 3, 4}, 1000);
  EXPECT_NEAR((made.into - Axes{0, 0.6, 0.8}).norm(), 0, 1e-15);
  EXPECT_NEAR(made.stiffness * made.depth({0.01, 0, 0}, 0).d, 5, 1e-12);
  EXPECT_FALSE(plane_of_force(kInside, kStill, 1000).surface);
}

TEST(Process, AnEndedOneDoesNotLiveThoughNobodyHasAsked) {
  EXPECT_TRUE(rt::process_lives(rt::own_process()));
  EXPECT_FALSE(rt::process_lives(0));
  Child child([] {});
  for (int i = 0; i < 1000 && rt::process_lives(child.process()); ++i) usleep(1000);
  EXPECT_FALSE(rt::process_lives(child.process()));
}

}  // namespace
}  // namespace ebac::engine_process_test
