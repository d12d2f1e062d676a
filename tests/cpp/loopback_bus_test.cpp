// A bus inside one process: who gets what, in which order, and what a full queue costs.
#include "ebac/can/loopback_bus.hpp"

#include <gtest/gtest.h>
#include <pthread.h>
#include <sched.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdlib>
#include <new>
#include <stdexcept>
#include <thread>
#include <vector>

#include "ebac/core/realtime.hpp"

#ifndef EBAC_THREAD_SANITIZER  // whose runtime brings an operator new of its own with clang
namespace {
thread_local std::size_t allocations = 0;

[[gnu::noinline]] void* counted(std::size_t size) {
  ++allocations;
  void* memory = std::malloc(size);
  if (memory == nullptr) throw std::bad_alloc();
  return memory;
}
}  // namespace

void* operator new(std::size_t size) { return counted(size); }
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }
#endif

namespace ebac::can::loopback_bus_test {
namespace {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;

/// A frame that carries its sender and its number.
Frame numbered(std::uint32_t sender, std::uint32_t number) {
  Frame out{.id = sender, .size = 8};
  put(out.data, 0, number);
  return out;
}
std::uint32_t number_of(const Frame& in) { return get<std::uint32_t>(in.bytes(), 0); }

std::vector<Frame> all_of(LoopbackBus& end) {
  std::vector<Frame> got;
  for (Frame in; end.receive(in);) got.push_back(in);
  return got;
}

TEST(LoopbackBus, EveryOtherEndReceivesAndTheSenderDoesNot) {
  LoopbackHub hub;
  LoopbackBus a = hub.open();
  LoopbackBus b = hub.open();
  LoopbackBus c = hub.open();
  const Frame out = frame(0x181, {0x37, 0x02, 0, 0xFF});
  EXPECT_TRUE(a.send(out));
  EXPECT_EQ(all_of(b), std::vector{out});
  EXPECT_EQ(all_of(c), std::vector{out});
  EXPECT_TRUE(all_of(a).empty());
}

TEST(LoopbackBus, EveryKindOfFrameArrivesAsItWasSent) {
  LoopbackHub hub;
  LoopbackBus a = hub.open();
  LoopbackBus b = hub.open();
  const std::vector<Frame> sent = {
      frame(0, {}),
      frame(0x7FF, {1, 2, 3, 4, 5, 6, 7, 8}),
      {.id = 0x1FFFFFFF, .size = 2, .extended = true, .data = {9, 8}},
      {.id = 0x701, .size = 1, .remote = true},
      {.id = 0x40, .size = 8, .error = true},
  };
  for (const Frame& out : sent) EXPECT_TRUE(a.send(out));
  EXPECT_EQ(all_of(b), sent);
}

TEST(LoopbackBus, OwnFramesComeBackWhereAskedForAndAreMarked) {
  LoopbackHub hub;
  LoopbackBus a = hub.open({.own = true});
  LoopbackBus b = hub.open();
  a.send(numbered(1, 0));
  b.send(numbered(2, 0));
  const auto got = all_of(a);
  ASSERT_EQ(got.size(), 2);
  EXPECT_TRUE(got[0].own);
  EXPECT_FALSE(got[1].own);
  EXPECT_FALSE(all_of(b).at(0).own);
}

TEST(LoopbackBus, ImpossibleFramesAreRefusedAndCounted) {
  LoopbackHub hub;
  LoopbackBus a = hub.open();
  LoopbackBus b = hub.open();
  EXPECT_FALSE(a.send({.id = 0x800}));
  EXPECT_FALSE(a.send({.id = 0x20000000, .extended = true}));
  EXPECT_FALSE(a.send({.id = 1, .size = 9}));
  EXPECT_TRUE(all_of(b).empty());
  EXPECT_EQ(a.counts().refused, 3);
  EXPECT_EQ(a.counts().sent, 0);
}

TEST(LoopbackBus, AFullQueueKeepsTheOldFramesAndCountsTheLost) {
  for (const std::size_t room : {1U, 2U, 3U, 7U, 64U}) {
    LoopbackHub hub;
    LoopbackBus a = hub.open();
    LoopbackBus narrow = hub.open({.frames = room});
    LoopbackBus wide = hub.open({.frames = 200});
    for (std::uint32_t round = 0; round < 3; ++round) {
      for (std::uint32_t i = 0; i < 100; ++i) EXPECT_TRUE(a.send(numbered(1, i)));
      const auto got = all_of(narrow);
      ASSERT_EQ(got.size(), room);
      for (std::uint32_t i = 0; i < room; ++i) EXPECT_EQ(number_of(got[i]), i);
      EXPECT_EQ(narrow.counts().lost, (round + 1) * (100 - room));
      EXPECT_EQ(all_of(wide).size(), 100);
    }
    EXPECT_EQ(narrow.counts().received, 3 * room);
    EXPECT_EQ(wide.counts().lost, 0);
    EXPECT_EQ(a.counts().sent, 300);
  }
}

TEST(LoopbackBus, ImpossibleQueuesAreRefused) {
  LoopbackHub hub;
  EXPECT_THROW(hub.open({.frames = 0}), std::invalid_argument);
  EXPECT_THROW(hub.open({.frames = LoopbackOptions::kMostFrames + 1}), std::invalid_argument);
  EXPECT_EQ(hub.ends(), 0);
}

TEST(LoopbackBus, AClosedEndIsNoLongerThere) {
  LoopbackHub hub;
  LoopbackBus a = hub.open();
  LoopbackBus b = hub.open();
  a.send(numbered(1, 1));
  b.close();
  b.close();
  Frame in;
  EXPECT_EQ(b.state(), BusState::kClosed);
  EXPECT_FALSE(b.receive(in));
  EXPECT_FALSE(b.receive(in, 10s));
  EXPECT_FALSE(b.send(numbered(2, 1)));
  EXPECT_EQ(hub.ends(), 1);
  EXPECT_TRUE(a.send(numbered(1, 2)));
  EXPECT_TRUE(all_of(a).empty());
  {
    const LoopbackBus c = hub.open();
  }
  EXPECT_EQ(hub.ends(), 1);
}

TEST(LoopbackBus, AnEndOfNothingIsClosed) {
  LoopbackBus none;
  Frame in;
  EXPECT_EQ(none.state(), BusState::kClosed);
  EXPECT_FALSE(none.send(numbered(1, 1)));
  EXPECT_FALSE(none.receive(in));
  EXPECT_FALSE(none.receive(in, 10s));
  EXPECT_EQ(none.counts().refused, 0);
  none.close();
}

TEST(LoopbackBus, AnEndMovesWithWhatItHolds) {
  LoopbackHub hub;
  LoopbackBus a = hub.open();
  LoopbackBus b = hub.open();
  a.send(numbered(1, 7));
  LoopbackBus moved = std::move(b);
  EXPECT_EQ(number_of(all_of(moved).at(0)), 7);
  moved = hub.open();  // the end it was leaves the bus
  EXPECT_EQ(hub.ends(), 2);
  a.send(numbered(1, 8));
  EXPECT_EQ(all_of(moved).size(), 1);
}

TEST(LoopbackBus, EndsOutliveTheHub) {
  LoopbackBus a;
  LoopbackBus b;
  {
    LoopbackHub hub;
    a = hub.open();
    b = LoopbackHub(hub).open();  // a copy is the same bus
  }
  EXPECT_TRUE(a.send(numbered(1, 1)));
  EXPECT_EQ(all_of(b).size(), 1);
}

TEST(LoopbackBus, TwoHubsAreTwoBuses) {
  LoopbackHub one;
  LoopbackHub two;
  LoopbackBus a = one.open();
  LoopbackBus b = two.open();
  a.send(numbered(1, 1));
  EXPECT_TRUE(all_of(b).empty());
}

TEST(LoopbackBus, StampsAreTheTimeOfDayWhereAskedFor) {
  const auto now = [] {
    return std::chrono::nanoseconds(std::chrono::system_clock::now().time_since_epoch()).count();
  };
  for (const auto stamps : {LoopbackHub::Stamps::kNone, LoopbackHub::Stamps::kWallClock}) {
    LoopbackHub hub(stamps);
    LoopbackBus a = hub.open();
    LoopbackBus b = hub.open();
    Frame out = numbered(1, 1);
    out.stamp = 42;
    const std::int64_t before = now();
    a.send(out);
    a.send(out);
    const std::int64_t after = now();
    const auto got = all_of(b);
    if (stamps == LoopbackHub::Stamps::kNone) {
      EXPECT_EQ(got.at(0).stamp, 0);
    } else {
      EXPECT_LE(before, got.at(0).stamp);
      EXPECT_LE(got.at(0).stamp, got.at(1).stamp);
      EXPECT_LE(got.at(1).stamp, after);
    }
  }
}

#ifndef EBAC_THREAD_SANITIZER
TEST(LoopbackBus, SendAndReceiveDoNotAllocate) {
  LoopbackHub hub(LoopbackHub::Stamps::kWallClock);
  LoopbackBus a = hub.open({.frames = 8, .own = true});
  LoopbackBus b = hub.open({.frames = 8});
  const std::size_t before = allocations;
  Frame in;
  for (std::uint32_t i = 0; i < 1000; ++i) {
    a.send(numbered(1, i));
    if (i % 3 == 0) b.receive(in);
    b.receive(in, 1us);
  }
  EXPECT_EQ(allocations, before);
  EXPECT_EQ(number_of(in), 999);
}
#endif

TEST(Waiting, EndsWithItsTime) {
  LoopbackHub hub;
  LoopbackBus a = hub.open();
  Frame in;
  EXPECT_FALSE(a.receive(in, 0ns));
  EXPECT_FALSE(a.receive(in, -1s));
  const auto start = Clock::now();
  EXPECT_FALSE(a.receive(in, 20ms));
  EXPECT_GE(Clock::now() - start, 20ms);
}

TEST(Waiting, EndsWithAFrameOrTheEndOfTheBus) {
  LoopbackHub hub;
  LoopbackBus a = hub.open();
  LoopbackBus b = hub.open();
  std::atomic<bool> first{false};
  std::thread waiting([&] {
    Frame in;
    first = b.receive(in, std::chrono::nanoseconds::max());
    EXPECT_EQ(number_of(in), 5);
    EXPECT_FALSE(b.receive(in, std::chrono::nanoseconds::max()));
  });
  std::this_thread::sleep_for(5ms);
  a.send(numbered(1, 5));
  while (!first) std::this_thread::yield();
  std::this_thread::sleep_for(5ms);
  b.close();
  waiting.join();
}

/// Every frame wakes the other side: a lost one would hang until the time-out.
TEST(Threads, PingPongLosesNoWakeUp) {
  constexpr std::uint32_t kRounds = 5'000;
  LoopbackHub hub;
  LoopbackBus a = hub.open({.frames = 2});
  LoopbackBus b = hub.open({.frames = 2});
  std::thread other([&] {
    Frame in;
    for (std::uint32_t i = 0; i < kRounds; ++i) {
      ASSERT_TRUE(b.receive(in, 10s));
      ASSERT_TRUE(b.send(in));
    }
  });
  Frame in;
  for (std::uint32_t i = 0; i < kRounds; ++i) {
    ASSERT_TRUE(a.send(numbered(1, i)));
    ASSERT_TRUE(a.receive(in, 10s)) << i;
    ASSERT_EQ(number_of(in), i);
  }
  other.join();
}

TEST(Threads, SeveralMayWaitAtOneEnd) {
  constexpr std::uint32_t kFrames = 20'000;
  LoopbackHub hub;
  LoopbackBus a = hub.open();
  LoopbackBus b = hub.open({.frames = kFrames});
  std::atomic<std::uint32_t> got{0};
  std::vector<std::thread> readers;
  readers.reserve(3);
  for (int i = 0; i < 3; ++i) {
    readers.emplace_back([&] {
      for (Frame in; b.receive(in, 10s);) got.fetch_add(1);
    });
  }
  for (std::uint32_t i = 0; i < kFrames; ++i) ASSERT_TRUE(a.send(numbered(1, i)));
  while (got < kFrames) std::this_thread::yield();
  b.close();
  for (auto& reader : readers) reader.join();
  EXPECT_EQ(got, kFrames);
}

/// Many senders at full speed, and all receivers see the same order.
TEST(Threads, ThereIsOneOrderForAll) {
  constexpr std::uint32_t kSenders = 4;
  constexpr std::uint32_t kEach = 10'000;
  constexpr std::size_t kAll = std::size_t{kSenders} * kEach;
  LoopbackHub hub(LoopbackHub::Stamps::kWallClock);
  LoopbackBus one = hub.open({.frames = kAll});
  LoopbackBus two = hub.open({.frames = kAll});
  std::vector<LoopbackBus> ends;
  ends.reserve(kSenders);
  for (std::uint32_t s = 0; s < kSenders; ++s) ends.push_back(hub.open({.frames = kAll}));
  std::vector<std::thread> senders;
  senders.reserve(4);
  for (std::uint32_t s = 0; s < kSenders; ++s) {
    senders.emplace_back([&ends, s] {
      for (std::uint32_t i = 0; i < kEach; ++i) {
        while (!ends[s].send(numbered(s, i))) std::this_thread::yield();
      }
    });
  }
  std::vector<Frame> live;
  for (Frame in; live.size() < kAll && one.receive(in, 10s);) live.push_back(in);
  for (auto& sender : senders) sender.join();

  ASSERT_EQ(live.size(), kAll);
  EXPECT_EQ(live, all_of(two));
  std::vector<std::uint32_t> next(kSenders, 0);
  for (std::size_t i = 0; i < live.size(); ++i) {
    EXPECT_EQ(number_of(live[i]), next[live[i].id]++);
    EXPECT_LE(live[i > 0 ? i - 1 : 0].stamp, live[i].stamp);
  }
  for (std::uint32_t s = 0; s < kSenders; ++s) {
    std::vector<Frame> others;
    for (const Frame& in : live) {
      if (in.id != s) others.push_back(in);
    }
    EXPECT_EQ(all_of(ends[s]), others);
    EXPECT_EQ(ends[s].counts().sent, kEach);
    EXPECT_EQ(ends[s].counts().lost, 0);
  }
}

/// A frame left to a thread that was just about to stop delivering must not stay behind.
TEST(Threads, WhatWasSentIsThereOnceAllSendersAreDone) {
  constexpr int kRounds = 20'000;
  LoopbackHub hub;
  LoopbackBus listener = hub.open();
  LoopbackBus a = hub.open();
  LoopbackBus b = hub.open();
  std::atomic<int> begun{0};
  std::atomic<int> done{0};
  std::thread other([&] {
    for (int round = 1; round <= kRounds; ++round) {
      while (begun < round) std::this_thread::yield();
      b.send(numbered(2, 0));
      done = round;
    }
  });
  int missing = 0;
  for (int round = 1; round <= kRounds; ++round) {
    begun = round;
    for (int i = 0; i < round % 8; ++i) a.send(numbered(1, 0));
    while (done < round) std::this_thread::yield();
    const auto sent = static_cast<std::size_t>(round % 8 + 1);
    if (all_of(listener).size() != sent) ++missing;
  }
  other.join();
  EXPECT_EQ(missing, 0);
}

/// On one CPU, a thread of real time that waited without sleeping would never let the one that delivers go on.
TEST(Threads, AThreadOfRealTimeLetsTheOneThatDeliversFinish) {
  cpu_set_t one;
  CPU_ZERO(&one);
  CPU_SET(0, &one);
  LoopbackHub hub;
  std::vector<LoopbackBus> many(40);
  for (LoopbackBus& end : many) end = hub.open({.frames = 1});
  std::atomic<bool> over = false;
  std::thread sender([&, end = hub.open()]() mutable {
    pthread_setaffinity_np(pthread_self(), sizeof(one), &one);
    while (!over) end.send({.id = 1, .size = 0});
  });
  bool granted = false;
  auto took = std::chrono::steady_clock::duration::zero();
  std::thread urgent([&] {
    const sched_param priority{.sched_priority = 1};
    granted = pthread_setaffinity_np(pthread_self(), sizeof(one), &one) == 0 &&
              pthread_setschedparam(pthread_self(), SCHED_FIFO, &priority) == 0;
    for (int i = 0; i < 10 && granted; ++i) {
      std::this_thread::sleep_for(std::chrono::milliseconds{2});  // the sender is at work again
      const auto start = std::chrono::steady_clock::now();
      hub.open().close();
      took = std::max(took, std::chrono::steady_clock::now() - start);
    }
  });
  urgent.join();
  over = true;
  sender.join();
  if (!granted) GTEST_SKIP() << "no priority here";
  EXPECT_LT(took, std::chrono::seconds{5});
}

TEST(Threads, EndsComeAndGoWhileOthersSend) {
  LoopbackHub hub;
  LoopbackBus listener = hub.open({.frames = 100'000});
  std::atomic<bool> stop{false};
  std::atomic<std::uint32_t> sent{0};
  std::vector<std::thread> senders;
  senders.reserve(4);
  for (std::uint32_t s = 0; s < 2; ++s) {
    senders.emplace_back([&, s] {
      LoopbackBus end = hub.open({.frames = 1});
      while (!stop && sent < 90'000) {
        if (end.send(numbered(s, 0))) sent.fetch_add(1);
      }
    });
  }
  for (int i = 0; i < 2000; ++i) {
    LoopbackBus guest = hub.open({.frames = 4});
    Frame in;
    guest.receive(in);
  }
  stop = true;
  for (auto& sender : senders) sender.join();
  EXPECT_EQ(hub.ends(), 1);
  EXPECT_EQ(all_of(listener).size(), sent);
}

}  // namespace
}  // namespace ebac::can::loopback_bus_test
