#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstring>
#include <random>
#include <span>
#include <stdexcept>

#include "designed_law.hpp"
#include "ebac/control/ebac.hpp"
#include "ebac/control/lagged_force.hpp"
#include "ebac/control/observed_work.hpp"
#include "ebac/loop/axis_observer.hpp"
#include "ebac/loop/signal_chain.hpp"
#include "ebac/sim/any_law.hpp"

namespace ebac::observer_test {
namespace {

/// The reference hand against the reference wall, under EBAC with the observer.
Setup observed(double seconds = 2) {
  ebac::Setup setup{.seconds = seconds};
  setup.device.sensor.noise = 0.03;
  setup.observer = ObserverParams::of(setup.device, setup.timing);
  return setup;
}

/// Deviation of errors that all have the offset of the encoder's zero within its first count.
class Deviation {
 public:
  void add(double error) {
    ++n_;
    sum_ += error;
    squares_ += error * error;
  }
  double value() const { return std::sqrt(squares_ / n_ - sum_ * sum_ / (n_ * n_)); }

 private:
  double n_ = 0, sum_ = 0, squares_ = 0;
};

struct Errors {
  double reading = 0;     // counts, largest distance of the estimate from the reading
  Deviation x, v;         // m, m/s
  Deviation ahead;        // m, of the position predicted for when its command acts
  Deviation unpredicted;  // m, the same of the reading
};

double value_in(const Trace& trace, std::size_t row, const char* name) {
  for (const Column& column : trace.columns()) {
    if (column.name != name) continue;
    double value = 0;
    std::memcpy(&value, trace.data() + row * trace.row_bytes() + column.offset, sizeof value);
    return value;
  }
  throw std::invalid_argument(name);
}

Errors errors(const ebac::Setup& setup) {
  const auto trace = simulate_any(setup, designed_law("ebac", setup));
  const auto truth = [&](std::size_t row) { return value_in(*trace, row, "true.x"); };
  Errors e;
  for (std::size_t i = 1; i + 4 < trace->size(); ++i) {
    const Port port = trace->sample(i).axis[0].port;
    e.reading = std::max(e.reading, std::abs(port.est.x - port.x) / setup.device.count());
    e.x.add(port.est.x - truth(i));
    e.v.add(port.est.v - value_in(*trace, i, "true.v"));
    const auto at = i + static_cast<std::size_t>(setup.timing.delay);  // to the middle of a tick
    const double then = 0.5 * (truth(at) + truth(at + 1));
    e.ahead.add(port.est.x_act - then);
    e.unpredicted.add(port.x - then);
  }
  return e;
}

/// The estimate of one tick on readings.
ebac::Estimate observe(SignalChain& chain, Axis& axis, const Reading& reading, double dt) {
  const std::span axes(&axis, 1);
  chain.measure(reading, dt, axes);
  chain.forward(reading, dt, axes);
  chain.observe(reading, dt, axes);
  return axis.port.est;
}

TEST(Observer, KnowsThePositionWithinACountAndTheVelocityWithoutItsNoise) {
  const ebac::Setup setup = observed();
  const Errors e = errors(setup);
  const double count = setup.device.count();
  EXPECT_LE(e.reading, 1.5 + 1e-9);
  EXPECT_LT(e.x.value(), 0.5 * count);
  EXPECT_LT(e.v.value(), 0.1 * count / setup.timing.dt);  // one count of velocity is 31 mm/s
}

TEST(Observer, PredictsWhereTheCommandActs) {
  for (const int delay : {1, 2}) {
    ebac::Setup setup = observed(0.1);  // the impact: later, nothing moves
    setup.timing.delay = delay;
    setup.observer = ObserverParams::of(setup.device, setup.timing);
    const Errors e = errors(setup);
    EXPECT_LT(e.ahead.value(), 0.45 * e.unpredicted.value()) << delay << " samples of delay";
  }
}

/// A sensor of 3 ms: its lag costs a filter of the same form on what is known, and no noise.
TEST(Observer, SeesThroughTheLagOfTheSensor) {
  ebac::Setup slow = observed();
  slow.device.sensor.lag = 3e-3;
  slow.observer = ObserverParams::of(slow.device, slow.timing);
  ebac::Setup unaware = slow;
  unaware.observer->force_lag = 0;
  EXPECT_LT(errors(slow).v.value(), 0.2 * slow.device.count() / slow.timing.dt);
  EXPECT_LT(errors(slow).v.value(), 0.5 * errors(unaware).v.value());
}

/// Records of a sensor that come between the ticks: their age is known, and counts.
TEST(Observer, SeesThroughTheAgeOfTheForce) {
  ebac::Setup setup = observed();
  const double prompt = errors(setup).v.value();
  setup.device.sensor.period = 1.3e-3;  // ages from 0 to 1.3 ms, every one in turn
  const double aged = errors(setup).v.value();
  EXPECT_LT(aged, 2 * prompt);
  setup.device.sensor.period = 0;
  setup.device.sensor.delay = 0.65e-3;  // as old in the mean, and the loop knows nothing of it
  EXPECT_LT(aged, 0.8 * errors(setup).v.value());
}

/// Counts that begin to arrive while a device is armed are no motion, and the estimate begins at
/// them. Counts that fail to arrive correct nothing, and late ones where they were latched.
TEST(Observer, TakesCountsForWhenTheyWereLatched) {
  const DeviceModel device;
  const auto params = ObserverParams::of(device, Timing{});
  SignalChain chain(device, Wall{.position = 1}, {}, {.on = true, .acts = true, .params = params});
  Axis axis;
  const auto tick = [&](const Reading& reading, double dt) {
    return observe(chain, axis, reading, dt);
  };
  tick({}, 0);
  chain.forget();
  tick({.counts = {100'000}}, 1e-3);
  Estimate est = tick({.counts = {100'000}}, 1e-3);
  EXPECT_EQ(est.v, 0);
  EXPECT_EQ(est.x, axis.port.x);
  constexpr double kPace = 20;  // counts in a tick
  const double v = kPace * params.count / 1e-3;
  const double force = params.damping * v;  // keeps that pace
  std::int64_t counts = 100'000;
  for (int k = 0; k < 600; ++k) {
    est = tick({.counts = {counts += 20}, .force = {force}}, 1e-3);
  }
  EXPECT_NEAR(est.v, v, 0.02 * v);
  for (int k = 1; k <= 5; ++k) {
    est = tick({.counts = {counts}, .counts_age = {1e-3 * k}, .force = {force}}, 1e-3);
  }
  EXPECT_NEAR(est.x - axis.port.x, 5 * kPace * params.count, 3 * params.count);
  EXPECT_NEAR(est.v, v, 0.02 * v);
  counts += 100;
  est = tick({.counts = {counts}, .counts_age = {1e-3}, .force = {force}}, 1e-3);
  EXPECT_NEAR(est.x - axis.port.x, kPace * params.count, 2 * params.count);
}

/// The hand lets go while the sensor goes on showing its pull: what the readings prove of the
/// velocity stands against the model.
TEST(Observer, FollowsTheReadingsWhereTheForceIsWrongByFar) {
  ebac::Setup setup = observed(0.62);
  setup.hand.release_at = 0.5;
  setup.device.sensor.stops_at = 0.5;
  setup.device.sensor.repeats = true;
  const auto trace = simulate_any(setup, designed_law("ebac", setup));
  for (std::size_t i = 506; i < trace->size(); ++i) {
    EXPECT_NEAR(trace->sample(i).axis[0].port.est.v, value_in(*trace, i, "true.v"), 0.15) << i;
  }
}

/// The bias of a sensor goes to the disturbance.
TEST(Observer, FindsAConstantForceItIsNotTold) {
  ebac::Setup setup = observed(1);
  setup.device.sensor.bias = 0.3;  // N
  const auto trace = simulate_any(setup, designed_law("ebac", setup));
  EXPECT_NEAR(trace->sample(900).axis[0].port.est.disturbance, -0.3, 0.05);
}

/// The weight is in the disturbance from the first tick, and follows the pose of a gimbal: while it was learned the
/// velocity was off by 0.1 m/s. The handle falls until the motor carries it; the sensor's lag made that 13 mm/s more.
TEST(Observer, KnowsTheWeightOfTheDevice) {
  for (const ebac::Kinematics& kinematics :
       {ebac::Kinematics(ebac::Linear{}), ebac::Kinematics(ebac::Gimbal{})}) {
    for (const double gravity : {9.81, -9.81}) {
      ebac::Setup setup = observed(1);
      setup.device.kinematics = kinematics;
      setup.device.mechanics.handle_mass = 0.5;
      setup.device.mechanics.gravity = gravity;
      setup.observer = ObserverParams::of(setup.device, setup.timing);
      const auto trace = simulate_any(setup, designed_law("ebac", setup));
      for (std::size_t i = 1; i < trace->size(); ++i) {
        const Axis axis = trace->sample(i).axis[0];
        const double pulls = gravity * 0.5 * weight(kinematics, Axes(axis.joint.q, 0, 0), 1)[0] /
                             travel(kinematics)[0];
        ASSERT_NEAR(axis.port.est.disturbance, pulls, 0.1) << i;
        ASSERT_NEAR(axis.port.est.v, value_in(*trace, i, "true.v"), 4e-3) << i;
      }
    }
  }
}

/// A hand that carries the device when the loop begins has done so before.
TEST(Observer, BeginsWithTheForceThatIsThere) {
  ebac::DeviceModel device;
  device.mechanics.handle_mass = 1.5;
  device.mechanics.gravity = 9.81;
  const double weight = 1.5 * 9.81;
  const auto params = ObserverParams::of(device, Timing{});
  SignalChain chain(device, Wall{.position = 1}, {}, {.on = true, .acts = true, .params = params});
  Axis axis;
  for (int k = 0; k < 20; ++k) {
    const Reading reading{.force = {-weight}};
    EXPECT_NEAR(observe(chain, axis, reading, k == 0 ? 0 : 1e-3).v, 0, 1e-9) << k;
  }
}

/// A device that friction holds against a push rests in the estimate, and one that slides against it slides as fast:
/// nothing is left for the disturbance to learn.
TEST(Observer, KnowsTheFrictionOfTheDevice) {
  ebac::DeviceModel device;
  device.mechanics.coulomb = 0.5;
  const auto params = ObserverParams::of(device, Timing{});
  EXPECT_DOUBLE_EQ(params.friction, 0.4);
  SignalChain chain(device, Wall{.position = 1}, {}, {.on = true, .acts = true, .params = params});
  Axis axis;
  std::int64_t counts = 0;
  const auto tick = [&](int way, double force, double dt = 1e-3) {
    const Reading reading{.counts = {counts += way}, .force = {force}};
    return observe(chain, axis, reading, dt);
  };
  tick(0, 0, 0);
  for (const double push : {0.39, -0.39}) {
    ebac::Estimate est;
    for (int k = 0; k < 300; ++k) est = tick(0, push);
    EXPECT_NEAR(est.v, 0, 1e-9) << push;
    EXPECT_NEAR(est.v_act, 0, 1e-9) << push;
    EXPECT_NEAR(est.disturbance, 0, 1e-3 * params.friction) << push;
  }
  for (const int way : {20, -20}) {
    const double v = way * params.count / 1e-3;
    const double push = params.damping * v + std::copysign(params.friction, v);
    ebac::Estimate est;
    for (int k = 0; k < 1000; ++k) est = tick(way, push);
    EXPECT_NEAR(est.v, v, 0.01 * std::abs(v));
    EXPECT_NEAR(est.v_act, v, 0.01 * std::abs(v));
    EXPECT_NEAR(est.disturbance, 0, 0.02 * params.friction);
  }
}

/// What makes the estimate fade, in 20 ms, and what it says of it.
TEST(Observer, FadesWhereTheForceIsOldOrTheSensorSaysSo) {
  const DeviceModel device;
  const auto params = ObserverParams::of(device, Timing{});
  struct Case {
    double age;
    SensorStatus status;
    Fallback says;
  };
  for (const Case& at : {Case{1.5 * params.force_age, SensorStatus::kGood, Fallback::kForceStale},
                         Case{0, SensorStatus::kDisconnected, Fallback::kForceStatus},
                         Case{0, SensorStatus::kSaturated, Fallback::kForceStatus},
                         Case{0.5 * params.force_age, SensorStatus::kGood, Fallback::kNone}}) {
    SignalChain chain(device, Wall{}, {}, {.on = true, .acts = true, .params = params});
    Axis axis;
    const auto tick = [&](const Reading& reading, double dt) {
      return observe(chain, axis, reading, dt);
    };
    EXPECT_EQ(tick({}, 0).weight, 1);
    Estimate est;
    for (int k = 0; k < 20; ++k) {
      const double before = axis.port.est.weight;
      est = tick({.force_age = at.age, .force_status = at.status}, 1e-3);
      EXPECT_NEAR(est.weight, before, 0.05 + 1e-9);
    }
    EXPECT_EQ(est.fallback, static_cast<int>(at.says));
    EXPECT_NEAR(est.weight, at.says == Fallback::kNone ? 1 : 0, 1e-9);
    for (int k = 0; k < 99; ++k) est = tick({}, 1e-3);
    if (at.says != Fallback::kNone) {
      EXPECT_EQ(est.weight, 0) << "less than 0.1 s without a failure";
      EXPECT_EQ(est.fallback, static_cast<int>(at.says));
    }
    for (int k = 0; k < 21; ++k) est = tick({}, 1e-3);
    EXPECT_NEAR(est.weight, 1, 1e-9);
    EXPECT_EQ(est.fallback, static_cast<int>(Fallback::kNone));
  }
}

/// With an estimate within half a count, what is counted exceeds the true work by no more than half a count of the
/// present force and of the changes that are too slow to be charged: half a count of the observer, where that of the
/// encoder is finer.
TEST(ObservedWork, ExceedsTheTruthByNoMoreThanSlowChanges) {
  constexpr double kCount = 3e-5, kSlow = 0.05;
  std::mt19937 random(7);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> beside(-kCount / 2, kCount / 2);
  for (int run = 0; run < 50; ++run) {
    const double count = run % 2 == 0 ? kCount : kCount / 4;
    ObservedWork work(count, kCount, 0.03);
    Port port{.dt = 1e-3};
    const double pace = std::pow(10, -2 + normal(random));  // counts in a tick
    double x = 0, force = 0, truth = 0, counted = 0, slow = 0;
    work.start(port);
    for (int k = 0; k < 5000; ++k) {
      const double change = 0.1 * normal(random) - 0.02 * force;
      force += change;
      slow += std::min(std::abs(change), kSlow);
      const double dx = pace * kCount * normal(random);
      x += dx;
      truth += force * dx;
      const double reading = count * std::round(x / count);
      port.dx = reading - port.x;
      port.x = reading;
      port.est.x = x + beside(random);
      port.f_applied = force;
      counted += work.step(force, /*moment=*/0, port, /*b=*/0);
      ASSERT_LE(counted, truth + kCount / 2 * (std::abs(force) + slow) + 1e-12) << "run " << run;
    }
  }
}

/// A reading that crosses an edge jumps by a whole count: that is no motion that the device has damped. Four times what
/// a slow swing loses was credited, which paid for a limit cycle of 8 counts for ever.
TEST(ObservedWork, CreditsNoMoreDampingThanThereIs) {
  constexpr double kCount = 3e-5, kDt = 1e-3, kDamping = 2;
  for (const double fastest : {1e-3, 4e-3, 20e-3, 100e-3, 400e-3}) {
    ObservedWork work(kCount, kCount, 0.03);
    Port port{.dt = kDt};
    work.start(port);
    double before = 0, damped = 0, credited = 0;
    for (int k = 1; k < 5000; ++k) {
      const double x = fastest / 30 * std::sin(30 * k * kDt);
      damped += kDamping / kDt * (x - before) * (x - before);
      before = x;
      const double reading = kCount * std::round(x / kCount);
      port.dx = reading - port.x;
      port.x = reading;
      port.est.x = x;
      credited += work.step(/*mean=*/0, /*moment=*/0, port, kDamping / kDt);
    }
    EXPECT_LE(credited, damped) << fastest << " m/s";
    EXPECT_GE(credited, 0) << fastest << " m/s";
  }
}

/// A change in one tick is charged half a count, less what noise can cause.
TEST(ObservedWork, ChargesFastChanges) {
  constexpr double kCount = 3e-5, kSlow = 0.05;
  ObservedWork work(kCount, kCount, 0.03);
  Port port{.dt = 1e-3};
  work.start(port);
  EXPECT_DOUBLE_EQ(work.step(0, 0, port, 0), 0);
  EXPECT_DOUBLE_EQ(work.step(1, 0, port, 0), -kCount / 2 * (1 - kSlow));
  EXPECT_DOUBLE_EQ(work.step(1, 0, port, 0), 0);
  EXPECT_DOUBLE_EQ(work.step(0, 0, port, 0), -kCount / 2 * (1 - kSlow));
  ObservedWork noisy(kCount, kCount, 0.3);  // ten times noisier than usual
  noisy.start(port);
  EXPECT_DOUBLE_EQ(noisy.step(1, 0, port, 0), -kCount / 2 * (1 - 10 * kSlow));
  ObservedWork fine(kCount / 10, kCount, 0.03);
  fine.start(port);
  EXPECT_DOUBLE_EQ(fine.step(1, 0, port, 0), -kCount / 2 * (1 - kSlow));
}

/// An estimate beside the reading counts for half a count of the encoder, not for one of the observer.
TEST(ObservedWork, KeepsTheEstimateWithinACountOfTheEncoder) {
  constexpr double kCount = 3e-5, kFine = 3e-6;
  ObservedWork work(kFine, kCount, 0.03);
  Port port{.dt = 1e-3};
  work.start(port);
  work.step(1, 0, port, 0);
  port.est.x = kCount / 2;
  EXPECT_DOUBLE_EQ(work.step(1, 0, port, 0), kFine / 2);
}

/// Mean and moment of a lagged force give its work over any interval in which the velocity changes evenly.
TEST(LaggedForce, DoesWorkOverAChangingVelocity) {
  constexpr double kTick = 1e-3;
  constexpr int kParts = 2000;
  std::mt19937 random(11);
  std::normal_distribution<double> normal;
  for (const double lag : {0.0, 1e-4, 5e-4, 3e-3}) {
    LaggedForce force(lag);
    force.set_tick(kTick);
    for (int run = 0; run < 20; ++run) {
      const double command = 10 * normal(random), v = 0.1 * normal(random), change = normal(random);
      const double transient = force.force() - command;
      double work = 0;
      for (int k = 0; k < kParts; ++k) {
        const double share = (k + 0.5) / kParts;
        const double left = lag > 0 ? std::exp(-share * kTick / lag) : 0.0;
        work += (command + transient * left) * (v + change * share) * kTick / kParts;
      }
      const double moment = force.moment(command);
      const double way = (v + 0.5 * change) * kTick;
      EXPECT_NEAR(force.hold(command) * way + moment * change, work, 1e-7) << "lag " << lag;
    }
  }
}

/// A force that rests costs nothing, however long and whatever the reading does.
TEST(ObservedWork, ChargesNothingForAForceThatRests) {
  constexpr double kCount = 3e-5;
  ObservedWork work(kCount, kCount, 0.03);
  Port port{.dt = 1e-3, .f_applied = 10};
  work.start(port);
  work.step(10, 0, port, 0);
  double counted = 0, start = 0;
  for (int k = 0; k < 10'000; ++k) {
    port.dx = k % 2 == 0 ? kCount : -kCount;
    port.x += port.dx;
    port.est.x = kCount / 2;  // an edge
    counted += work.step(10 + 0.02 * (k % 3), 0, port, 0);
    if (k == 0) start = counted;  // the way to the edge is work
  }
  EXPECT_NEAR(counted, start, 1e-4);
}

Ebac designed() {
  const ebac::Setup setup{};
  return Ebac(EbacParams::design(setup.device.facts(), setup.timing), setup.timing);
}

Port pressed(double weight, int tick) {
  Port port{.x = 1e-3, .dt = 1e-3, .f_env = 10, .f_applied = 10, .f_meas = 10};
  port.est = {.x = 1e-3, .x_act = 1e-3, .weight = weight};
  if (tick == 0) port.dt = 0;
  return port;
}

/// The observer goes during a contact, and comes back: no step of the force.
TEST(Ebac, FadesToTheEncoderAndBackWithoutAJump) {
  Ebac law = designed();
  double before = 0;
  for (int k = 0; k < 1000; ++k) {
    const double off = std::clamp((k - 400) / 20.0, 0.0, 1.0);
    const double on = std::clamp((k - 700) / 20.0, 0.0, 1.0);
    const double force = law.step(pressed(1 - off + on, k));
    if (k > 400) {
      ASSERT_NEAR(force, before, 0.3) << "tick " << k;
    }
    before = force;
  }
  EXPECT_NEAR(before, 10, 0.1);
}

/// A hand that presses before the first tick has not pushed quickly: the guard admits what it admits later.
TEST(Ebac, CountsNoPushBeforeTheFirstTick) {
  std::array<double, 2> admitted{};
  for (const bool later : {false, true}) {
    Ebac law = designed();
    for (int k = 0; k < (later ? 1000 : 1); ++k) {
      Port port = pressed(1, k);
      port.f_env = port.f_applied = 0;
      law.step(port);
    }
    Port port = pressed(1, 1);
    port.f_env = 25;
    port.f_applied = 0;
    admitted.at(later ? 1 : 0) = law.step(port);
  }
  EXPECT_LT(admitted[0], 25);
  EXPECT_DOUBLE_EQ(admitted[0], admitted[1]);
}

/// The reserve is lent once: an observer that comes and goes lends no more each time.
TEST(Ebac, LendsItsReserveOnce) {
  Ebac law = designed();
  double most = 0;
  for (int k = 0; k < 2000; ++k) {
    Port port = pressed(k / 50 % 2, k);
    port.f_env = port.f_applied = port.f_meas = 0;
    law.step(port);
    most = std::max(most, law.state().energy);
  }
  EXPECT_LE(most, law.params().reserve + 1e-12);
}

}  // namespace
}  // namespace ebac::observer_test
