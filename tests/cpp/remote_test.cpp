#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <memory>
#include <stdexcept>
#include <thread>

#include "ebac/remote/link_end.hpp"
#include "ebac/remote/master_world.hpp"
#include "ebac/remote/slave_worlds.hpp"

namespace ebac::remote {
namespace {

constexpr double kDt = 1e-3;  // s
constexpr sensor::Endpoint kHere{.address = sensor::kLoopbackAddress, .port = 0};
using Ptr = std::shared_ptr<LinkEnd>;

Ptr slave_end() {
  return std::make_shared<LinkEnd>(LinkEnd::Role::kSlave, LinkParams{}, kDt, kHere, std::nullopt);
}
Ptr master_end(const LinkEnd& slave) {
  return std::make_shared<LinkEnd>(LinkEnd::Role::kMaster, LinkParams{}, kDt, kHere, slave.local());
}

/// Both ends in turn, tick by tick; time is the loops', the datagrams are real.
class Ends {
 public:
  explicit Ends(Ptr slave) : slave_(std::move(slave)) {}

  void run(LinkEnd* master, double seconds, const Four& asked = {}) {
    for (int i = 0; i < static_cast<int>(seconds / kDt); ++i) {
      t_ += kDt;
      if (master != nullptr) {
        master->begin(t_, kDt);
        master->end(asked, {});
      }
      slave_->begin(t_, kDt);
      slave_->end({2, 0, 0.1, 0}, {0.01, 0, 0, 0});
      if (i % 50 == 0) std::this_thread::sleep_for(std::chrono::microseconds(200));
    }
  }

 private:
  Ptr slave_;
  double t_ = 0;
};

int count(const LinkEnd& end, EventOf what) {
  int found = 0;
  for (std::size_t i = 0; i < end.events(); ++i) found += end.event(i).what == what ? 1 : 0;
  return found;
}

TEST(FarLink, CarriesBothWaysAndNeedsConsentAfterSilence) {
  const Ptr slave = slave_end();
  const Ptr master = master_end(*slave);
  Ends ends(slave);
  ends.run(master.get(), 0.3, {0.02, 0, 0.5, 0});
  EXPECT_TRUE(slave->running());
  EXPECT_DOUBLE_EQ(slave->heard().value, 0.02);
  EXPECT_DOUBLE_EQ(slave->heard().more[1], 0.5);
  EXPECT_DOUBLE_EQ(master->heard().value, 2);
  EXPECT_DOUBLE_EQ(master->heard().at[0], 0.01);
  EXPECT_EQ(master->share(), 1);

  ends.run(nullptr, 0.7);  // the master is silent
  EXPECT_TRUE(slave->lost());
  ends.run(master.get(), 0.5);  // and knows by the slave's word
  EXPECT_TRUE(master->lost());
  EXPECT_EQ(master->share(), 0);
  EXPECT_FALSE(slave->running()) << "nothing goes on by itself";
  master->consent();
  ends.run(master.get(), 0.3);
  EXPECT_TRUE(master->running());
  EXPECT_TRUE(slave->running());
  EXPECT_EQ(slave->session(), 2U);
  EXPECT_EQ(count(*slave, EventOf::kLost), 1);
  EXPECT_EQ(count(*master, EventOf::kLost), 1);
}

TEST(FarLink, ARestartedSlaveReportsNoConsentThatNobodyGave) {
  Ptr slave = slave_end();
  const sensor::Endpoint place = slave->local();
  const Ptr master = master_end(*slave);
  {
    Ends ends(slave);
    ends.run(master.get(), 0.1);
    ends.run(nullptr, 0.7);
    ends.run(master.get(), 0.5);
    master->consent();
    ends.run(master.get(), 0.3);
  }
  ASSERT_EQ(slave->session(), 2U);
  EXPECT_EQ(count(*slave, EventOf::kConsent), 1);
  slave.reset();
  slave = std::make_shared<LinkEnd>(LinkEnd::Role::kSlave, LinkParams{}, kDt, place, std::nullopt);
  Ends(slave).run(master.get(), 0.3);
  EXPECT_EQ(slave->session(), 2U);
  EXPECT_EQ(count(*slave, EventOf::kConsent), 0);
}

TEST(FarLink, AMasterThatLeavesBeforeItsFirstTickSaysWhoItIs) {
  const Ptr slave = slave_end();
  const Ptr master = master_end(*slave);
  master->leave();
  std::this_thread::sleep_for(std::chrono::milliseconds(5));
  slave->begin(0, kDt);
  EXPECT_EQ(count(*slave, EventOf::kFarLeft), 1);
  EXPECT_EQ(slave->report().refused, 0);
}

TEST(FarLink, ObeysOneMasterAndAnotherOnlyAfterConsent) {
  const Ptr slave = slave_end();
  const Ptr one = master_end(*slave);
  const Ptr other = master_end(*slave);
  Ends ends(slave);
  ends.run(one.get(), 0.1, {0.02, 0, 0, 0});
  other->begin(0, kDt);
  other->end({0.7, 0, 0, 0}, {});
  ends.run(one.get(), 0.1, {0.02, 0, 0, 0});
  EXPECT_DOUBLE_EQ(slave->heard().value, 0.02);
  ends.run(nullptr, 0.7);
  ends.run(other.get(), 0.3, {0.7, 0, 0, 0});
  EXPECT_FALSE(slave->running());
  other->consent();
  ends.run(other.get(), 0.2, {0.7, 0, 0, 0});
  EXPECT_TRUE(slave->running());
  EXPECT_DOUBLE_EQ(slave->heard().value, 0.7);
}

TEST(FarLink, LearnsOfAFaultAndOfAnEnd) {
  const Ptr slave = slave_end();
  const Ptr master = master_end(*slave);
  Ends ends(slave);
  ends.run(master.get(), 0.2);
  slave->fail(7);
  ends.run(master.get(), 0.1);
  EXPECT_TRUE(master->lost());
  ASSERT_EQ(count(*master, EventOf::kFarFault), 1);
  master->leave();
  std::this_thread::sleep_for(std::chrono::milliseconds(5));
  ends.run(nullptr, 0.01);
  EXPECT_EQ(count(*slave, EventOf::kFarLeft), 1);
}

TEST(FarLink, RefusesATimeOutWithinTwoTicksInWhichNoLinkWouldRun) {
  const auto made = [](double dt) {
    LinkEnd(LinkEnd::Role::kSlave, {.timeout = 0.01}, dt, kHere, {});
  };
  EXPECT_NO_THROW(made(kDt));
  EXPECT_THROW(made(0.01), std::invalid_argument);
}

TEST(MasterWorld, HasNoForceBeforeASlaveAnswersAndFadesAfterIt) {
  const Ptr slave = slave_end();
  const Ptr master = master_end(*slave);
  MasterWorld world(master, {});
  double t = 0;
  const auto tick = [&](bool answered) {
    t += kDt;
    const ContactForce force = world.contact({0.01, 0, 0}, Axes::Zero(), t);
    if (answered) {
      slave->begin(t, kDt);
      slave->end({0, 0, 0.1, 0}, {});
    }
    return force.force[0];
  };
  EXPECT_EQ(tick(false), 0);
  double felt = 0;
  for (int i = 0; i < 400; ++i) felt = tick(true);
  EXPECT_NEAR(felt, 5, 1e-9);  // 50 rad/m times 0.1 N m
  double before = felt;
  for (int i = 0; i < 800; ++i) {
    felt = tick(false);
    EXPECT_LE(felt, before);
    before = felt;
  }
  EXPECT_EQ(felt, 0);
}

TEST(SlaveLink, StandsStillUntilBothPairsKnowWhereTheyAre) {
  const Ptr slave = slave_end();
  const Ptr master = master_end(*slave);
  const auto shared = std::make_shared<SlaveLink>(slave, FollowParams{}, gastroscope::Gears{});
  const auto feed = SlaveLink::world(shared, 0);
  const auto bend = SlaveLink::world(shared, 1);
  const Axes here{0.013, -0.002, 0};
  double t = 0;
  for (int i = 0; i < 100; ++i) {  // the bends have not begun
    t += kDt;
    master->begin(t, kDt);
    master->end({0.1, 0, 0, 0}, {});
    EXPECT_EQ(feed->contact(here, Axes::Zero(), t).force.norm(), 0);
  }
  bend->contact(Axes::Zero(), Axes::Zero(), t);
  t += kDt;
  EXPECT_LT(feed->contact(here, Axes::Zero(), t).force.norm(), 3) << "no jump where they begin";
  for (int i = 0; i < 300; ++i) {  // now they fall silent: nothing moves by itself
    t += kDt;
    master->begin(t, kDt);
    master->end({0.1, 0, 0, 0}, {});
    feed->contact(here, Axes::Zero(), t);
  }
  EXPECT_EQ(count(*slave, EventOf::kGroup), 1);
  EXPECT_TRUE(slave->lost());
  const auto agreed =
      [&](bool bends) {  // the master hears of it, its hand consents, half a second passes
        for (int i = 0; i < 1000; ++i) {
          t += kDt;
          if (i == 500) master->consent();
          master->begin(t, kDt);
          master->end({0.1, 0, 0, 0}, {});
          feed->contact(here, Axes::Zero(), t);
          if (bends) bend->contact(Axes::Zero(), Axes::Zero(), t);
          if (i % 50 == 0) std::this_thread::sleep_for(std::chrono::microseconds(200));
        }
      };
  agreed(false);
  EXPECT_FALSE(slave->running()) << "a consent does not bring the other drives back";
  agreed(true);
  EXPECT_TRUE(slave->running());
  EXPECT_TRUE(master->running());
}

TEST(FarLink, ARepeatedPacketIsNoSignOfLife) {
  const Ptr slave = slave_end();
  sensor::UdpSocket socket(kHere);
  teleop::Packet packet{.session = 1, .sequence = 1, .run = 5};
  const auto sends = [&](double seconds) {
    for (int i = 0; i < static_cast<int>(seconds / kDt); ++i) {
      socket.send(teleop::encode(packet), slave->local());
      slave->begin(i * kDt, kDt);
      slave->end({}, {});
      if (i % 50 == 0) std::this_thread::sleep_for(std::chrono::microseconds(200));
    }
  };
  sends(0.2);
  EXPECT_TRUE(slave->running());
  sends(1);
  EXPECT_TRUE(slave->lost());
}

TEST(FarLink, AForgedSessionIsNone) {
  const Ptr slave = slave_end();
  const Ptr master = master_end(*slave);
  Ends ends(slave);
  ends.run(master.get(), 0.2);
  sensor::UdpSocket socket(kHere);
  socket.send(teleop::encode({.from_slave = true, .lost = true, .session = 0xFFFFFFFF, .run = 9}),
              master->local());
  std::this_thread::sleep_for(std::chrono::milliseconds(5));
  ends.run(master.get(), 0.2);
  EXPECT_TRUE(master->running());
}

}  // namespace
}  // namespace ebac::remote
