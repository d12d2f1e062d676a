#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "ebac/teleop/link_watch.hpp"
#include "ebac/teleop/packet.hpp"
#include "ebac/teleop/receiver.hpp"
#include "ebac/teleop/slave.hpp"

namespace ebac::teleop {
namespace {

constexpr double kDt = 1e-3;  // s
constexpr Packet kPacket{.from_slave = true,
                         .lost = true,
                         .session = 3,
                         .sequence = 70000,
                         .echo = 5,
                         .stamp = -1,
                         .value = 0.01,
                         .energy = 2,
                         .wave = -3,
                         .run = 0xFFFFFFFE};

TEST(TeleopPacket, ComesBackAndNoFlippedBitDoes) {
  const Packet::Wire wire = encode(kPacket);
  EXPECT_EQ(decode(wire), kPacket);
  for (std::size_t bit = 0; bit < 8 * wire.size(); ++bit) {
    Packet::Wire broken = wire;
    broken[bit / 8] ^= static_cast<std::uint8_t>(1U << bit % 8);
    EXPECT_FALSE(decode(broken)) << "bit " << bit;
  }
  EXPECT_FALSE(decode(std::span(wire).first(wire.size() - 1)));
}

TEST(TeleopReceiver, CountsWhatIsLateDoubledAndMissing) {
  Receiver receiver;
  const auto take = [&](std::uint32_t n) { receiver.take({.sequence = n, .value = 1.0 * n}); };
  for (const std::uint32_t n : {1U, 2U, 5U, 4U, 4U}) take(n);
  EXPECT_EQ(receiver.arrivals().missing, 1);
  EXPECT_EQ(receiver.arrivals().late, 1);
  EXPECT_EQ(receiver.arrivals().doubled, 1);
  EXPECT_EQ(receiver.play().value, 5);  // the newest, not the last that came
}

TEST(TeleopReceiver, BeforeTheFirstPacketNoneIsMissing) {
  Receiver receiver;
  for (const std::uint32_t n : {5'000U, 5'001U, 4'999U, 5'003U}) receiver.take({.sequence = n});
  EXPECT_EQ(receiver.arrivals().missing, 1);
  EXPECT_EQ(receiver.arrivals().late, 1);
}

TEST(TeleopReceiver, AJumpOfMoreThanAMinuteIsNotTaken) {
  Receiver receiver;
  for (const std::uint32_t n : {70'000U, 70'001U, 0xFFFFFF00U, 70'002U}) {
    receiver.take({.sequence = n, .value = 1.0 * n});
  }
  EXPECT_EQ(receiver.play().value, 70'002);
  EXPECT_EQ(receiver.arrivals().foreign, 1);
}

TEST(TeleopReceiver, AWildNumberThatComesFirstIsForgotten) {
  for (const int buffer : {0, 20}) {
    Receiver receiver(buffer);
    const auto take = [&](std::uint32_t n) { receiver.take({.sequence = n, .value = 1.0 * n}); };
    take(0xFFFFFF00U);
    receiver.play();
    EXPECT_EQ(receiver.newest(), 0) << "told to the other side, it would pass for a restart";
    for (std::uint32_t n = 1; n <= 100; ++n) {
      take(n);
      receiver.play();
    }
    EXPECT_EQ(receiver.newest(), 100);
    EXPECT_NEAR(receiver.play().value, 100 - buffer, 2);
    EXPECT_EQ(receiver.arrivals().received, 100);
    EXPECT_EQ(receiver.arrivals().late, 0);
    EXPECT_EQ(receiver.arrivals().missing, 0);
    EXPECT_EQ(receiver.arrivals().foreign, 1);
  }
}

TEST(TeleopReceiver, TheFirstNumberMayBeAnyOne) {  // the other side has long been sending
  Receiver receiver;
  for (const std::uint32_t n : {700'000U, 700'001U})
    receiver.take({.sequence = n, .value = 1.0 * n});
  EXPECT_EQ(receiver.play().value, 700'001);
  EXPECT_EQ(receiver.newest(), 700'001);
}

TEST(TeleopLink, OnlyAConsentLeadsBackToRunning) {
  LinkWatch watch(Coupling{.timeout = 0.5, .fade = 0.2}, kDt);
  const auto run = [&](double seconds, bool hears) {
    for (int i = 0; i < std::lround(seconds / kDt); ++i) {
      if (hears) watch.heard();
      watch.tick(/*other_lost=*/false);
    }
  };
  run(1, false);
  EXPECT_EQ(watch.state(), LinkState::kWaiting);
  run(0.3, true);
  EXPECT_EQ(watch.state(), LinkState::kRunning);
  EXPECT_EQ(watch.share(), 1);
  run(0.4, false);
  EXPECT_EQ(watch.state(), LinkState::kRunning);
  run(0.4, false);
  EXPECT_EQ(watch.state(), LinkState::kLost);
  EXPECT_EQ(watch.share(), 0);
  run(10, true);
  EXPECT_EQ(watch.state(), LinkState::kBack);
  EXPECT_EQ(watch.share(), 0);
  run(1, false);
  EXPECT_EQ(watch.state(), LinkState::kLost);
  watch.begin();
  run(0.1, true);
  EXPECT_EQ(watch.state(), LinkState::kRunning);
  EXPECT_NEAR(watch.share(), 0.5, 0.01);  // comes back as slowly as it went
  watch.lose();
  EXPECT_EQ(watch.losses(), 3);
}

/// A slave in free motion and a master of which only the place counts.
struct Far {
  Coupling coupling{.timeout = 0.1};
  SlaveSide slave{SlaveModel{.contact_stiffness = 0}, coupling, kDt};
  Packet from{.run = 7};
  double largest_step = 0;  // m

  /// False where the slave does not answer.
  bool hear(double value, double seconds = 0.5) {
    bool answered = false;
    for (int i = 0; i < std::lround(seconds / kDt); ++i) {
      from.value = value;
      ++from.sequence;
      answered = slave.take(from);
      tick();
    }
    return answered;
  }
  void silence(double seconds = 0.2) {
    for (int i = 0; i < std::lround(seconds / kDt); ++i) tick();
  }
  void tick() {
    const double before = slave.state().target;
    slave.step(0);
    largest_step = std::max(largest_step, std::abs(slave.state().target - before));
  }
  void consent() {
    ++from.session;
    from.sequence = 0;
    largest_step = 0;
  }
  void restart() { from = {.run = from.run + 1}; }
  double place() const { return slave.state().target; }
};

TEST(TeleopResume, TheSlaveGoesBackToTheMastersPlaceSlowlyAndStays) {
  Far far;
  far.hear(0.01);
  for (int cut = 0; cut < 20; ++cut) {  // lost at 10 mm, found again at 20 mm
    far.silence();
    far.hear(0.02);
    EXPECT_NEAR(far.place(), 0.01, 1e-6);  // no consent: it holds
    far.consent();
    far.hear(0.02, 1);
    EXPECT_NEAR(far.place(), 0.02, 1e-6);
    // The last half millimetre is followed as ever, with the lag of 5 ms.
    EXPECT_LE(far.largest_step, 1.01e-4);
    far.hear(0.01);
  }
  EXPECT_NEAR(far.place(), 0.01, 1e-6);
}

TEST(TeleopResume, WithoutRealignmentItGoesOnFromWhereBothAre) {
  Far far;
  far.coupling.realign = 0;
  far.slave = {SlaveModel{.contact_stiffness = 0}, far.coupling, kDt};
  far.hear(0.01);
  far.silence();
  far.consent();
  far.hear(0.02);
  EXPECT_NEAR(far.place(), 0.01, 1e-6);
  EXPECT_LT(far.largest_step, 1e-12);
}

TEST(TeleopResume, ARestartedMasterIsHeldOffUntilAHandConsents) {
  Far far;
  far.hear(0.01);
  far.silence(0.05);
  far.restart();
  EXPECT_FALSE(far.hear(0.5, 0.04));  // within the time-out: the old one may come yet
  EXPECT_EQ(far.slave.watch().state(), LinkState::kRunning);
  far.silence();
  EXPECT_TRUE(far.hear(0.5, 2));  // more packets than the first one sent
  EXPECT_EQ(far.slave.watch().state(), LinkState::kBack);
  EXPECT_NEAR(far.place(), 0.01, 1e-6);
  far.consent();
  far.hear(0.5);
  EXPECT_EQ(far.slave.watch().state(), LinkState::kRunning);
  EXPECT_LT(far.largest_step, 1e-12);  // its zero is another: nothing moves
  far.hear(0.502, 1);
  EXPECT_NEAR(far.place(), 0.012, 1e-6);
}

TEST(TeleopResume, ASecondMasterDoesNotTakeARunningSlave) {
  Far far;
  far.hear(0.01);
  EXPECT_FALSE(far.slave.take({.session = 9, .sequence = 1, .value = 0.5, .run = 8}));
  far.hear(0.01);
  EXPECT_EQ(far.slave.watch().state(), LinkState::kRunning);
  EXPECT_NEAR(far.place(), 0.01, 1e-6);
}

TEST(TeleopResume, AForgedSessionIsNone) {
  Far far;
  far.hear(0.01);
  EXPECT_FALSE(far.slave.take({.session = 0xFFFFFFFF, .sequence = 1, .value = 0.5, .run = 7}));
  EXPECT_TRUE(far.hear(0.01));
  EXPECT_EQ(far.slave.watch().state(), LinkState::kRunning);
}

TEST(TeleopResume, ARestartedSlaveWaitsForConsent) {
  Far far;
  far.from.session = 3;
  far.from.echo = 5000;  // of the slave before
  far.hear(0.03);
  EXPECT_EQ(far.slave.watch().state(), LinkState::kBack);
  EXPECT_EQ(far.place(), 0);
  far.from.echo = 0;
  far.consent();
  far.hear(0.03);
  EXPECT_EQ(far.slave.watch().state(), LinkState::kRunning);
  EXPECT_LE(far.largest_step, 1.01e-4);
}

}  // namespace
}  // namespace ebac::teleop
