// Encoder, force sensor and motor against the model of the device: what must be found, by its name,
// and what must never be.
#include "ebac/loop/plausibility.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "designed_law.hpp"
#include "ebac/control/per_axis.hpp"
#include "ebac/loop/virtual_clock.hpp"
#include "ebac/sim/any_law.hpp"
#include "ebac/sim/simulate.hpp"
#include "rounds.hpp"

namespace ebac::plausibility_test {
namespace {

constexpr double kDt = 1e-3;        // s
constexpr double kUnexplained = 2;  // N
constexpr double kNoise = 0.03;     // N

/// The hands of the study: mass, damping, stiffness, target, up to a pull of 35 N.
std::vector<Hand> hands() {
  std::vector<Hand> all;
  for (const double mass : {0.05, 0.15, 0.5, 1.0}) {
    for (const double damping : {2.0, 6.0, 20.0}) {
      for (const double stiffness : {100.0, 300.0, 1000.0}) {
        for (const double target : {0.02, 0.04}) {
          if (stiffness * target > 35.0 + 1e-9) continue;
          all.push_back({.mass = mass,
                         .damping = damping,
                         .stiffness = stiffness,
                         .path = {Step{.target = 0.01 + target}, Step{}, Step{}}});
        }
      }
    }
  }
  return all;
}

/// Under sanitizers every fourth hand, of which each law has others.
std::vector<Hand> hands_for(std::size_t law) {
  constexpr std::size_t kEvery = 4 / rounds(4);
  const std::vector<Hand> all = hands();
  std::vector<Hand> some;
  for (std::size_t i = law % kEvery; i < all.size(); i += kEvery) some.push_back(all[i]);
  return some;
}

ebac::Setup contact(double stiffness) {
  ebac::Setup setup{.environment = Wall{.stiffness = stiffness, .position = 0.01}, .seconds = 0.7};
  setup.device.sensor.noise = kNoise;
  return setup;
}

/// The first contradiction in the rows of a run, for a loop that believes in `known`.
Fault found_in(const Trace& trace, const DeviceModel& known) {
  Plausibility watch(BalanceFacts::of(known, kUnexplained, kDt));
  for (std::size_t row = 0; row < trace.size(); ++row) {
    const Sample s = trace.sample(row);
    const Fault fault =
        watch.watch({}, {.t = s.t, .dt = row > 0 ? kDt : 0.0}, std::span(s.axis).first(1));
    if (fault != Fault::kNone) return fault;
  }
  return Fault::kNone;
}

class EveryLaw : public testing::TestWithParam<std::size_t> {};

TEST_P(EveryLaw, NeverRaisesAFalseAlarm) {
  for (const double friction : {0.0, 1.0}) {
    ebac::Setup setup = contact(0);
    setup.device.mechanics.coulomb = friction;
    const auto law = designed_law(law_types()[GetParam()]->name, setup);  // knows no wall
    for (const double stiffness : {10e3, 35e3}) {
      setup.environment = contact(stiffness).environment;
      for (const Hand& hand : hands_for(GetParam())) {
        setup.hand = hand;
        const auto trace = simulate_any(setup, law);
        for (const double share : {0.5, 1.0, 1.5}) {  // of the true mass
          DeviceModel known = setup.device;
          known.mechanics.coulomb = 0;
          known.mechanics.handle_mass *= share;
          known.motor.rotor_inertia *= share;
          EXPECT_EQ(found_in(*trace, known), Fault::kNone)
              << law.type().name << ", wall of " << stiffness << " N/m, friction " << friction
              << " N, mass times " << share << ", hand of " << hand.mass << " kg, " << hand.damping
              << " N s/m, " << hand.stiffness << " N/m";
        }
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(, EveryLaw, testing::Range<std::size_t>(0, law_types().size()));

/// What is wrong with a device, from a time on.
struct Wrong {
  double from = 0.4;  // s
  bool reversed = false, frozen = false;
  std::int64_t jump = 0;  // counts
};

/// A simulated device with something wrong.
class WrongDevice {
 public:
  WrongDevice(const ebac::Setup& setup, const Wrong& wrong) : device_(setup), wrong_(wrong) {}

  Reading exchange(Command command) EBAC_RT {
    t_ += command.elapsed;
    const bool now = t_ > wrong_.from;
    double& current = command.current[0];
    if (now && wrong_.reversed) current = -current;
    Reading reading = device_.exchange(command);
    if (now && wrong_.reversed) reading.current_applied[0] *= -1;
    if (now && wrong_.frozen) reading.counts[0] = counts_;
    if (now) reading.counts[0] += wrong_.jump;
    counts_ = reading.counts[0];
    if (now && wrong_.jump != 0) counts_ -= wrong_.jump;
    return reading;
  }

 private:
  SimulatedDevice device_;
  Wrong wrong_;
  double t_ = 0;
  std::int64_t counts_ = 0;
};

struct Found {
  Fault fault = Fault::kNone;
  double after = 0;  // s
};

/// `law` is one for this device: some take long to design.
Found fault_of(const ebac::Setup& setup, const Wrong& wrong, const AnyLaw& law,
               bool watch_motion = true) {
  Limits limits = Limits::of(setup.device);
  limits.speed = limits.end = limits.edge = 10;  // only the forces judge
  limits.watch_motion = watch_motion;
  Loop loop(WrongDevice(setup, wrong), VirtualClock(kDt, 0, 1), PerAxis(law),
            SignalChain(setup.device, setup.environment, setup.timing), 1,
            {.limiter = SafetyLimiter(limits, setup.device, kDt)});
  const auto trace = loop.make_trace(row_count(setup));
  loop.run(*trace);
  for (std::size_t row = 0; row < trace->size(); ++row) {
    const Sample s = trace->sample(row);
    if (s.fault != Fault::kNone) return {s.fault, s.t - wrong.from};
  }
  return {};
}

TEST_P(EveryLaw, FindsATorqueThatIsReversedInContact) {
  const auto law = designed_law(law_types()[GetParam()]->name, contact(0));  // knows no wall
  for (const double stiffness : {10e3, 35e3}) {
    ebac::Setup setup = contact(stiffness);
    for (const Hand& hand : hands_for(GetParam())) {
      setup.hand = hand;
      if (hand.stiffness * std::get<Step>(hand.path[0]).target < 5) continue;
      const Found found = fault_of(setup, {.reversed = true}, law);
      EXPECT_TRUE(found.fault == Fault::kTorqueReversed)
          << law.type().name << stiffness << ' ' << hand.mass << ' ' << hand.damping << ' '
          << hand.stiffness << ' ' << static_cast<int>(found.fault);
      EXPECT_LT(found.after, 0.2);
    }
  }
}

ebac::Setup on_its_way() {
  ebac::Setup setup = contact(10e3);
  setup.hand.path[0] = MinimumJerk{.target = 0.035, .at = 0.05, .duration = 0.15};
  setup.environment = Wall{.stiffness = 10e3, .position = 0.03};
  return setup;
}

AnyLaw ebac_law() { return designed_law("ebac", contact(10e3)); }

TEST(Plausibility, FindsAnEncoderThatFreezesOnItsWay) {
  for (const double from : {0.13, 0.14, 0.15}) {  // 0.19, 0.26 and 0.33 m/s
    const Found found = fault_of(on_its_way(), {.from = from, .frozen = true}, ebac_law());
    EXPECT_EQ(found.fault, Fault::kEncoderFrozen) << from;
    EXPECT_LT(found.after, 0.03);
  }
}

TEST(Plausibility, FindsAnEncoderThatIsFrozenWhenTheHandLetsGoOfTheWall) {
  ebac::Setup setup = contact(10e3);
  setup.hand.release_at = 0.6;
  const Found found = fault_of(setup, {.frozen = true}, ebac_law());
  EXPECT_EQ(found.fault, Fault::kEncoderFrozen);
  EXPECT_LT(found.after, 0.25);
}

TEST(Plausibility, FindsAJumpThatIsSmallerThanTheLimitOfAJump) {
  for (const std::int64_t counts : {64, -64, 128}) {
    EXPECT_EQ(fault_of(on_its_way(), {.from = 0.02, .jump = counts}, ebac_law()).fault,
              Fault::kEncoderJump)
        << counts;
  }
}

TEST(Plausibility, IsOffWhereTheLimitsSaySo) {
  EXPECT_EQ(fault_of(on_its_way(), {.from = 0.12, .frozen = true}, ebac_law(), false).fault,
            Fault::kNone);
}

TEST(Plausibility, FindsAnEncoderThatFreezesUnderAHandleThatGlides) {
  // Nobody pushes: only that the handle would have stopped dead contradicts, and for 10 ms only.
  const DeviceModel device;
  constexpr double kPace = 0.2;  // m/s
  constexpr int kFrozen = 100;   // tick
  Plausibility watch(BalanceFacts::of(device, kUnexplained, kDt));
  Axis axis;
  axis.port.f_meas = device.mechanics.damping * kPace;
  for (int i = 1; i < 300; ++i) {
    const double count = device.count();
    axis.port.x = std::round(kPace * kDt * std::min(i, kFrozen) / count) * count;
    const Fault fault = watch.watch({}, {.dt = kDt}, std::span(&axis, 1));
    if (fault == Fault::kNone) continue;
    EXPECT_EQ(fault, Fault::kEncoderFrozen);
    EXPECT_GT(i, kFrozen);
    EXPECT_LE(i, kFrozen + 10);
    return;
  }
  FAIL() << "not found";
}

/// Ticks at rest with a force that nothing explains, until something is found; 0 for never.
int ticks_until_found(double force, double age, double late = 0, SensorStatus status = {}) {
  Plausibility watch(BalanceFacts::of(DeviceModel{}, kUnexplained, kDt));
  Axis axis;
  axis.port.f_meas = force;
  for (int i = 1; i < 500; ++i) {
    const Instant now{.dt = kDt * (1 + (i % 10 == 0 ? late : 0))};
    const Reading reading{.force_age = age, .force_status = status};
    if (watch.watch(reading, now, std::span(&axis, 1)) != Fault::kNone) return i;
  }
  return 0;
}

TEST(Plausibility, AForceThatIsOldOrBadAndATickOutOfTimeProveNothing) {
  EXPECT_EQ(ticks_until_found(2, 0), 0);
  EXPECT_NEAR(ticks_until_found(4, 0), 46, 2);
  EXPECT_EQ(ticks_until_found(4, 6e-3), 0);
  EXPECT_EQ(ticks_until_found(4, 0, 0.5), 0);
  EXPECT_EQ(ticks_until_found(4, 0, 0, SensorStatus::kDisconnected), 0);
}

}  // namespace
}  // namespace ebac::plausibility_test
