#include "ebac/faults/case.hpp"

#include <algorithm>
#include <cmath>

#include "ebac/faults/test_bench.hpp"
#include "ebac/loop/loop.hpp"

namespace ebac::faults {

namespace {

constexpr double kDt = 1e-3;             // s
constexpr int kRunTicks = 280;           // samples
constexpr int kAfter = 120;              // samples that the bus goes on after the loop
constexpr std::size_t kRows = 400;       // more than a case has
constexpr std::int64_t kMostToZero = 2;  // samples

using FaultyLoop = Loop<FaultyDevice, FaultyClock, FaultyLaw>;

/// A hand that moves into a slanting wall: both axes push.
Setup setup_of(const InjectedFault& injected) {
  Noise random(injected.chance, /*stream=*/7);
  const auto between = [&](double low, double high) {
    return low + (high - low) * (0.5 + 0.5 * random.symmetric());
  };
  Setup setup{.seed = injected.chance};
  setup.device.kinematics = Linear{.axes = 2};
  setup.environment = Wall{.stiffness = between(2e3, 20e3), .position = 0.01, .angle = 0.6};
  const double target = between(0.015, 0.035);
  setup.hand.path[0] = MinimumJerk{.target = target, .at = 0.01, .duration = between(0.1, 0.2)};
  setup.hand.path[1] = MinimumJerk{.target = target, .at = 0.03, .duration = between(0.1, 0.2)};
  if (injected.kind == Kind::kEncoderWrap) {
    setup.device.encoder.counter_bits = 11;  // 1024 counts are 31 mm
    setup.environment = Free{};
    setup.hand.path[0] = MinimumJerk{.target = 0.038, .at = 0.01, .duration = between(0.1, 0.15)};
  }
  if (injected.kind == Kind::kEncoderFrozen) {  // on its way, 0.3 m/s or faster
    setup.environment = Wall{.stiffness = 10e3, .position = 0.02};
    setup.hand.path[0] = MinimumJerk{.target = 0.035, .at = 0.01, .duration = 0.1};
    setup.hand.path[1] = setup.hand.path[0];
  }
  return setup;
}

/// The currents of the rows within the limits, tick for tick.
bool within(const Trace& trace, const Limits& limits, const InjectedFault& injected) {
  constexpr double kRounding = 1 + 1e-9;
  double before[kMaxAxes] = {};
  for (std::size_t row = 0; row < trace.size(); ++row) {
    const Sample s = trace.sample(row);
    for (std::size_t i = 0; i < static_cast<std::size_t>(s.axes); ++i) {
      const double current = s.axis[i].joint.current;
      const double step = std::abs(current - before[i]);
      before[i] = current;
      if (!(std::abs(current) <= limits.peak_current * kRounding)) return false;
      if (current != 0 && !(step <= limits.slew * kDt * kRounding)) return false;
    }
  }
  const double permille = limits.continuous_current / 1000;  // the drives round to it
  return injected.most_current <= limits.peak_current + permille;
}

Fault first_fault_of(const Trace& trace, std::int64_t& tick) {
  for (std::size_t row = 0; row < trace.size(); ++row) {
    const Sample s = trace.sample(row);
    if (s.fault == Fault::kNone) continue;
    tick = s.tick;
    return s.fault;
  }
  return Fault::kNone;
}

bool named(const InjectedFault& injected, Fault fault) {
  return std::ranges::find(facts_of(injected.kind).faults, fault) !=
         facts_of(injected.kind).faults.end();
}

/// Judges detection and stop by the fault in the rows.
Verdict judge_fault(const InjectedFault& injected, const Result& result) {
  if (result.fault == Fault::kNone) return injected.fatal() ? Verdict::kMissed : Verdict::kPassed;
  if (injected.harmless()) return Verdict::kFalseAlarm;
  if (!named(injected, result.fault)) return Verdict::kWrongName;
  return result.to_zero <= kMostToZero ? Verdict::kPassed : Verdict::kNotZero;
}

/// After the loop: the bus continues, the fault continues or ends, and no drive may restart by itself.
Verdict judge_end(FaultyLoop& loop, TestBench& bench, InjectedFault& injected, Trace& trace,
                  Fault fault) {
  const std::size_t rows = trace.size();
  if (fault != Fault::kNone && loop.run(trace)) return Verdict::kRestarted;
  bool went_off = false;
  for (int i = 0; i < kAfter; ++i) {
    ++injected.tick;
    static_cast<void>(bench.exchange({.elapsed = kDt}));
    if (went_off && !bench.off()) return Verdict::kRestarted;
    went_off = bench.off();
  }
  if (trace.size() != rows || rows == kRows) return Verdict::kNotRecorded;
  return went_off ? Verdict::kPassed : Verdict::kStillOn;
}

}  // namespace

InjectedFault injected_fault_of(std::uint64_t seed, std::uint64_t index) {
  Noise random(seed, /*stream=*/index + 16);
  InjectedFault injected{.kind = static_cast<Kind>(index % kKinds)};
  const KindFacts& facts = facts_of(injected.kind);
  const auto whole = [&](std::int64_t low, std::int64_t high) {
    return low +
           static_cast<std::int64_t>(random.bits() % static_cast<std::uint64_t>(high - low + 1));
  };
  injected.at = whole(facts.first, facts.last);
  injected.ticks = static_cast<int>(whole(facts.shortest, facts.longest));
  injected.axis = static_cast<std::size_t>(whole(0, 1));
  injected.chance = random.bits();
  return injected;
}

Result run_case(InjectedFault injected, std::shared_ptr<Trace>* rows) {
  const Setup setup = setup_of(injected);
  const Ebac law(Ebac::Params::design(setup.device.facts(), setup.timing), setup.timing);
  DeviceModel known = setup.device;
  if (injected.kind == Kind::kNanTorque) {
    known.compensation = {.friction = 1, .friction_speed = kNoNumber};
  }
  TestBench bench(setup, injected);
  const auto updates = std::make_unique<ParameterUpdates<FaultyLaw>>(law);
  const Limits limits = Limits::of(setup.device);
  FaultyLoop loop(
      FaultyDevice(bench), FaultyClock(kDt, injected, law, *updates), FaultyLaw(law, injected),
      SignalChain(known, setup.environment, observing(setup.observer, law)), setup.device.axes(),
      {.plan = {.soft_start = 0.02, .ramp_down = 0.02, .arm = true, .ticks = kRunTicks},
       .limiter = SafetyLimiter(limits, setup.device, kDt)});
  const std::shared_ptr<Trace> trace = loop.make_trace(kRows);
  loop.run(*trace, updates.get());

  Result result;
  std::int64_t tick = 0;
  result.fault = first_fault_of(*trace, tick);
  if (result.fault != Fault::kNone) {
    result.detected = std::max<std::int64_t>(tick - injected.at, 0);
    result.to_zero = std::max<std::int64_t>(injected.last_command + 1 - tick, 0);
  }
  result.verdict = judge_fault(injected, result);
  const Verdict end = judge_end(loop, bench, injected, *trace, result.fault);
  if (result.fault != Fault::kNone) {
    result.to_off = std::max<std::int64_t>(injected.last_current + 1 - tick, 0);
  }
  if (result.verdict == Verdict::kPassed) result.verdict = end;
  if (result.verdict == Verdict::kPassed && !within(*trace, limits, injected)) {
    result.verdict = Verdict::kBeyondLimit;
  }
  if (injected.kind == Kind::kParameterWrites && updates->applied().size() == 0) {
    result.verdict = Verdict::kNotRecorded;
  }
  if (rows != nullptr) *rows = trace;
  return result;
}

}  // namespace ebac::faults
