// A loop in a thread of its own. No test asserts a deadline: the machine decides when it wakes.
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <memory>
#include <stdexcept>
#include <string>
#include <system_error>
#include <thread>

#include "ebac/control/direct.hpp"
#include "ebac/rt/awake_cpus.hpp"
#include "ebac/rt/grants.hpp"
#include "ebac/rt/jitter.hpp"
#include "ebac/rt/loop_thread.hpp"
#include "ebac/rt/monotonic_clock.hpp"
#include "ebac/sim/simulate.hpp"

namespace ebac::rt::rt_test {
namespace {

TEST(MonotonicClock, NeverWakesBeforeItsInstantAndCountsWhatItSkips) {
  constexpr double kDt = 1e-3;
  MonotonicClock clock(kDt);
  EXPECT_EQ(clock.wait().t, 0);
  double t = 0;
  std::int64_t ticks = 0;
  for (int i = 0; i < 60; ++i) {
    if (i == 20) std::this_thread::sleep_for(std::chrono::milliseconds(10));
    const Instant now = clock.wait();
    ticks += 1 + now.skipped;
    EXPECT_GT(now.dt, 0);
    EXPECT_NEAR(now.t, t + now.dt, 1e-12);
    EXPECT_GE(now.lateness, 0);
    EXPECT_LT(now.lateness, kDt);  // a whole tick late is a tick skipped
    EXPECT_NEAR(now.t, static_cast<double>(ticks) * kDt + now.lateness, 1e-9);
    if (i == 20) {
      EXPECT_GE(now.skipped, 8);
    }
    t = now.t;
  }
  EXPECT_EQ(clock.skipped(), ticks - 60);
}

TEST(Thread, ReportsWhatItGotAndHowToGetTheRest) {
  std::atomic<int> runs = 0;
  const Options options{.priority = 10, .cpu = 1023, .stack = 65536};
  {
    Thread thread(Mode::kAuto, options, [&] { ++runs; });
    thread.join();
    ASSERT_EQ(thread.report().grants.size(), 5U);
    for (const Grant& grant : thread.report().grants) {
      EXPECT_EQ(grant.granted, grant.remedy.empty()) << grant.name;
      EXPECT_EQ(grant.granted, grant.why.empty()) << grant.name;
    }
    const Grant& cpu = thread.report().grants[2];
    EXPECT_EQ(cpu.name, "cpu");
    EXPECT_FALSE(cpu.granted);  // no machine of the tests has 1024
    EXPECT_NE(cpu.remedy.find("taskset -c 1023"), std::string::npos) << cpu.remedy;
  }
  EXPECT_EQ(runs, 1);
}

TEST(Thread, SeveralMayWaitForItsEnd) {
  constexpr int kWaiting = 2;
  const auto thread = std::make_shared<Thread>(
      Mode::kOff, Options{}, [] { std::this_thread::sleep_for(std::chrono::milliseconds{50}); });
  const auto ended = std::make_shared<std::atomic<int>>(0);
  for (int i = 0; i < kWaiting; ++i) {
    std::thread([thread, ended] {
      thread->join();
      ++*ended;
    }).detach();  // one that waits for ever is not waited for
  }
  for (int k = 0; k < 1000 && *ended < kWaiting; ++k) {
    std::this_thread::sleep_for(std::chrono::milliseconds{10});
  }
  EXPECT_EQ(*ended, kWaiting);
}

TEST(Thread, KeepsCpusAwakeOnlyWhereThatIsAsked) {
  const auto asked = [](bool awake) {
    Thread thread(Mode::kAuto, {.stay_awake = awake}, [] {});
    thread.join();
    const auto& grants = thread.report().grants;
    return std::ranges::any_of(grants, [](const Grant& one) { return one.name == "sleep"; });
  };
  EXPECT_TRUE(asked(true));
  EXPECT_FALSE(asked(false));
}

/// A file of its own in place of the system's.
class SleepFile {
 public:
  SleepFile() : path_(std::filesystem::temp_directory_path() / "ebac-rt-test-XXXXXX") {
    std::string name = path_.string();
    const int file = mkstemp(name.data());
    if (file >= 0) close(file);
    path_ = name;
  }
  ~SleepFile() { std::filesystem::remove(path_); }
  SleepFile(const SleepFile&) = delete;
  SleepFile& operator=(const SleepFile&) = delete;
  SleepFile(SleepFile&&) = delete;
  SleepFile& operator=(SleepFile&&) = delete;

  const char* path() const { return path_.c_str(); }
  /// Descriptors of this process that hold it.
  int holders() const {
    int found = 0;
    for (const auto& one : std::filesystem::directory_iterator("/proc/self/fd")) {
      std::error_code gone;
      if (std::filesystem::read_symlink(one.path(), gone) == path_) ++found;
    }
    return found;
  }

 private:
  std::filesystem::path path_;
};

TEST(AwakeCpus, HoldTheFileOnceHoweverOftenTheyAreAsked) {
  const SleepFile file;
  {
    AwakeCpus awake(file.path());
    for (int i = 0; i < 3; ++i) {
      EXPECT_TRUE(awake.ask().granted);
      EXPECT_EQ(file.holders(), 1);
    }
  }
  EXPECT_EQ(file.holders(), 0);
}

TEST(AwakeCpus, ARequestThatWasWrittenInPartIsRefusedForThatReason) {
  const SleepFile file;
  AwakeCpus awake(file.path());
  rlimit before{};
  ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &before), 0);
  rlimit two = before;
  two.rlim_cur = 2;  // bytes, of the four
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &two), 0);
  errno = ENOENT;  // of something else, before
  const Grant grant = awake.ask();
  setrlimit(RLIMIT_FSIZE, &before);
  EXPECT_FALSE(grant.granted);
  EXPECT_EQ(grant.why.find(std::strerror(ENOENT)), std::string::npos) << grant.why;
  EXPECT_EQ(file.holders(), 0) << "it asks for nothing and would hold the file";
}

TEST(Thread, EnforceRunsNothingWithoutItAll) {
  std::atomic<int> runs = 0;
  try {
    const Thread thread(Mode::kEnforce, {.cpu = 1023}, [&] { ++runs; });
    FAIL() << "it started";
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find("CPU 1023"), std::string::npos) << error.what();
  }
  EXPECT_EQ(runs, 0);
}

TEST(Grants, AStackLargerThanThatOfTheThreadIsRefusedNotTouched) {
  std::thread([] {
    EXPECT_TRUE(touch_stack(4096).granted);
    const Grant grant = touch_stack(1 << 30);
    EXPECT_FALSE(grant.granted);
    EXPECT_NE(grant.remedy.find("choose at most"), std::string::npos) << grant.remedy;
  }).join();
}

TEST(Grants, MemoryThatIsAskedForAndReleasedAtOnceStaysLocked) {
  const Grant first = ask_memory();
  if (!first.granted) GTEST_SKIP() << first.why;
  const auto locked = [] {
    std::ifstream status("/proc/self/status");
    for (std::string line; std::getline(status, line);) {
      if (line.starts_with("VmLck:")) return std::stol(line.substr(6));
    }
    return 0L;
  };
  const bool locks = locked() > 0;
  release_memory();
  if (!locks) GTEST_SKIP() << "sanitizers lock nothing";
  for (int i = 0; i < 60; ++i) {
    ask_memory();
    std::thread other(release_memory);
    ask_memory();
    other.join();
    EXPECT_GT(locked(), 0) << i;
    release_memory();
  }
}

TEST(Thread, OffAsksForNothing) {
  std::atomic<int> runs = 0;
  Thread thread(Mode::kOff, {.cpu = 1023}, [&] { ++runs; });
  thread.join();
  EXPECT_TRUE(thread.report().grants.empty());
  EXPECT_EQ(runs, 1);
}

TEST(Thread, RefusesOptionsOutOfRange) {
  EXPECT_THROW(Thread(Mode::kAuto, {.priority = 0}, [] {}), std::invalid_argument);
}

TEST(Jitter, HasAWakeUpForEveryTickThatWasKept) {
  const std::atomic<bool> cancelled = false;
  const Jitter jitter = measure_jitter(1e-3, 100, Mode::kOff, {}, cancelled);
  EXPECT_LE(jitter.lateness.size(), 100U);
  EXPECT_GE(static_cast<std::int64_t>(jitter.lateness.size()) + jitter.skipped, 100);
  for (const double late : jitter.lateness) EXPECT_GE(late, 0);
}

using LiveLoop = Loop<SimulatedDevice, MonotonicClock, PerAxis<Direct>>;

struct Live {
  Setup setup{};
  Direct law{Direct::Params{}};
  std::shared_ptr<ParameterUpdates<PerAxis<Direct>>> updates =
      std::make_shared<ParameterUpdates<PerAxis<Direct>>>(law);
  std::unique_ptr<LiveLoop> loop = std::make_unique<LiveLoop>(
      SimulatedDevice(setup), MonotonicClock(1e-3), PerAxis<Direct>(law),
      SignalChain(setup.device, setup.environment, setup.timing), 1,
      LoopOptions{.plan = {.soft_start = 0.01, .ramp_down = 0.01, .arm = true}});
  std::shared_ptr<Trace> trace = loop->make_trace(3000);
};

TEST(LoopThread, IsReadAndToldWhileItRunsAndStops) {
  Live live;
  LoopThread<SimulatedDevice, MonotonicClock, PerAxis<Direct>> thread(
      std::move(live.loop), live.trace, live.updates, Mode::kAuto, {.priority = 1});
  double sum = 0;
  for (int i = 0; i < 30; ++i) {
    while (thread.trace().size() < static_cast<std::size_t>(5 * (i + 1)) && !thread.done()) {
      std::this_thread::yield();
    }
    live.updates->post(Environment(Wall{.stiffness = 1000.0 + i}));
    live.updates->post(Direct({.peak_force = 10.0 + i}));
    sum += thread.trace().sample(thread.trace().size() - 1).t;
  }
  EXPECT_GT(sum, 0);
  thread.stop();
  thread.join();
  EXPECT_TRUE(thread.done());
  EXPECT_EQ(thread.loop().state(), LoopState::kIdle);
  EXPECT_GT(live.updates->applied().size(), 0U);
  EXPECT_EQ(thread.unrecorded(), 0);
  const Sample last = live.trace->sample(live.trace->size() - 1);
  EXPECT_EQ(last.state, static_cast<int>(LoopState::kStop));
  EXPECT_EQ(last.axis[0].joint.current, 0);
}

TEST(LoopThread, AFullTraceIsAStopAndNothingIsSilent) {
  Live live;
  live.trace = live.loop->make_trace(20);
  LoopThread<SimulatedDevice, MonotonicClock, PerAxis<Direct>> thread(
      std::move(live.loop), live.trace, live.updates, Mode::kOff, {});
  thread.join();
  EXPECT_EQ(live.trace->size(), 20U);
  EXPECT_GE(thread.unrecorded(), 10);
  EXPECT_EQ(thread.loop().state(), LoopState::kIdle);
}

}  // namespace
}  // namespace ebac::rt::rt_test
