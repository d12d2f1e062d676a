#include "ebac/faults/case.hpp"

#include <algorithm>
#include <cmath>

#include "ebac/faults/desk.hpp"
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
Setup setup_of(const Trouble& trouble) {
  Noise random(trouble.chance, /*stream=*/7);
  const auto between = [&](double low, double high) {
    return low + (high - low) * (0.5 + 0.5 * random.symmetric());
  };
  Setup setup{.seed = trouble.chance};
  setup.device.kinematics = Linear{.axes = 2};
  setup.environment = Wall{.stiffness = between(2e3, 20e3), .position = 0.01, .angle = 0.6};
  const double target = between(0.015, 0.035);
  setup.hand.path[0] = MinimumJerk{.target = target, .at = 0.01, .duration = between(0.1, 0.2)};
  setup.hand.path[1] = MinimumJerk{.target = target, .at = 0.03, .duration = between(0.1, 0.2)};
  if (trouble.kind == Kind::kEncoderWrap) {
    setup.device.encoder.counter_bits = 11;  // 1024 counts are 31 mm
    setup.environment = Free{};
    setup.hand.path[0] = MinimumJerk{.target = 0.038, .at = 0.01, .duration = between(0.1, 0.15)};
  }
  return setup;
}

/// The currents of the rows within the limits, tick for tick.
bool within(const Trace& trace, const Limits& limits, const Trouble& trouble) {
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
  return trouble.most_current <= limits.peak_current + permille;
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

bool named(const Trouble& trouble, Fault fault) {
  return std::ranges::find(facts_of(trouble.kind).faults, fault) !=
         facts_of(trouble.kind).faults.end();
}

/// What the fault in the rows says about detection and stop.
Verdict judge_fault(const Trouble& trouble, const Result& result) {
  if (result.fault == Fault::kNone) return trouble.fatal() ? Verdict::kMissed : Verdict::kPassed;
  if (trouble.harmless()) return Verdict::kFalseAlarm;
  if (!named(trouble, result.fault)) return Verdict::kWrongName;
  return result.to_zero <= kMostToZero ? Verdict::kPassed : Verdict::kNotZero;
}

/// After the loop: the bus goes on, the trouble goes on or ends, nothing starts again by itself.
Verdict judge_end(FaultyLoop& loop, Desk& desk, Trouble& trouble, Trace& trace, Fault fault) {
  const std::size_t rows = trace.size();
  if (fault != Fault::kNone && loop.run(trace)) return Verdict::kRestarted;
  bool went_off = false;
  for (int i = 0; i < kAfter; ++i) {
    ++trouble.tick;
    static_cast<void>(desk.exchange({.elapsed = kDt}));
    if (went_off && !desk.off()) return Verdict::kRestarted;
    went_off = desk.off();
  }
  if (trace.size() != rows || rows == kRows) return Verdict::kNotRecorded;
  return went_off ? Verdict::kPassed : Verdict::kStillOn;
}

}  // namespace

Trouble trouble_of(std::uint64_t seed, std::uint64_t index) {
  Noise random(seed, /*stream=*/index + 16);
  Trouble trouble{.kind = static_cast<Kind>(index % kKinds)};
  const KindFacts& facts = facts_of(trouble.kind);
  const auto whole = [&](std::int64_t low, std::int64_t high) {
    return low +
           static_cast<std::int64_t>(random.bits() % static_cast<std::uint64_t>(high - low + 1));
  };
  trouble.at = whole(30, 180);
  trouble.ticks = static_cast<int>(whole(facts.shortest, facts.longest));
  trouble.axis = static_cast<std::size_t>(whole(0, 1));
  trouble.chance = random.bits();
  return trouble;
}

Result run_case(Trouble trouble, std::shared_ptr<Trace>* rows) {
  const Setup setup = setup_of(trouble);
  const Ebac law(Ebac::Params::design(setup.device.facts(), setup.timing), setup.timing);
  DeviceModel known = setup.device;
  if (trouble.kind == Kind::kNanTorque) {
    known.compensation = {.friction = 1, .friction_speed = kNoNumber};
  }
  Desk desk(setup, trouble);
  const auto mail = std::make_unique<Mail<FaultyLaw>>(law);
  const Limits limits = Limits::of(setup.device);
  FaultyLoop loop(FaultyDevice(desk), FaultyClock(kDt, trouble, law, *mail),
                  FaultyLaw(law, trouble), Rig(known, setup.environment), setup.device.axes(),
                  {.plan = {.soft_start = 0.02, .ramp_down = 0.02, .arm = true, .ticks = kRunTicks},
                   .gate = Gate(limits, setup.device, kDt)});
  const std::shared_ptr<Trace> trace = loop.make_trace(kRows);
  loop.run(*trace, mail.get());

  Result result;
  std::int64_t tick = 0;
  result.fault = first_fault_of(*trace, tick);
  if (result.fault != Fault::kNone) {
    result.detected = std::max<std::int64_t>(tick - trouble.at, 0);
    result.to_zero = std::max<std::int64_t>(trouble.last_command + 1 - tick, 0);
  }
  result.verdict = judge_fault(trouble, result);
  const Verdict end = judge_end(loop, desk, trouble, *trace, result.fault);
  if (result.fault != Fault::kNone) {
    result.to_off = std::max<std::int64_t>(trouble.last_current + 1 - tick, 0);
  }
  if (result.verdict == Verdict::kPassed) result.verdict = end;
  if (result.verdict == Verdict::kPassed && !within(*trace, limits, trouble)) {
    result.verdict = Verdict::kBeyondLimit;
  }
  if (trouble.kind == Kind::kParameterWrites && mail->changes().size() == 0) {
    result.verdict = Verdict::kNotRecorded;
  }
  if (rows != nullptr) *rows = trace;
  return result;
}

}  // namespace ebac::faults
