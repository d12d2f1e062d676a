#include "ebac/faults/case.hpp"

#include <algorithm>
#include <cmath>

#include "ebac/faults/test_bench.hpp"
#include "ebac/loop/loop.hpp"

namespace ebac::faults {

namespace {

constexpr double kDt = 1e-3;             // s
constexpr int kAfter = 150;              // samples that the bus goes on after the loop
constexpr std::size_t kRows = 700;       // more than a case has
constexpr std::int64_t kMostToZero = 2;  // samples
constexpr std::int64_t kMostToOff = 3;   // samples, of a drive that hears the loop

using FaultyLoop = Loop<FaultyDevice, FaultyClock, FaultyLaw>;

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

/// Judges detection and stop by the fault in the rows, the frames on the bus and the motors.
Verdict judge_fault(const InjectedFault& injected, const CaseSetup& made, const Result& result) {
  if (result.fault == Fault::kNone) return injected.fatal() ? Verdict::kMissed : Verdict::kPassed;
  if (injected.harmless()) return Verdict::kFalseAlarm;
  if (!named(injected, result.fault)) return Verdict::kWrongName;
  if (result.detected > facts_of(injected.kind).within) return Verdict::kLate;
  if (result.to_zero > kMostToZero) return Verdict::kNotZero;
  const bool strained = facts_of(injected.kind).strained;
  const std::int64_t let_go = strained ? made.watching.longest() : 0;
  return result.to_off <= kMostToOff + let_go ? Verdict::kPassed : Verdict::kNotOff;
}

/// After the loop: the bus continues, the fault continues or ends, and no drive may restart by itself.
Verdict judge_end(FaultyLoop& loop, TestBench& bench, InjectedFault& injected, Trace& trace,
                  Fault fault) {
  const std::size_t rows = trace.size();
  // Nobody commands the drives from here on but this bench.
  if (!injected.strains() && !bench.off()) return Verdict::kStillOn;
  if (fault != Fault::kNone && loop.run(trace)) return Verdict::kRestarted;
  bool went_off = false;
  for (int i = 0; i < kAfter; ++i) {
    ++injected.tick;
    static_cast<void>(bench.exchange({.elapsed = kDt}));
    if (went_off && !bench.off()) return Verdict::kRestarted;
    went_off = bench.off();
  }
  const bool reset = bench.drive(injected.axis).state() != can::DriveState::kFault;
  if (injected.kind == Kind::kFaultAtStart && reset) return Verdict::kRestarted;
  if (injected.endless) return Verdict::kEndless;
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
  const CaseSetup made = case_setup_of(injected);
  const Setup& setup = made.setup;
  const Ebac law(Ebac::Params::design(setup.device.facts(), setup.timing), setup.timing);
  Referee referee(made, injected);
  TestBench bench(made, injected, referee);
  const auto updates = std::make_unique<ParameterUpdates<FaultyLaw>>(law);
  FaultyLoop loop(
      FaultyDevice(bench), FaultyClock(kDt, injected, law, *updates), FaultyLaw(law, injected),
      SignalChain(made.known, setup.environment, law.timing(), observing(setup.observer, law)),
      setup.device.axes(),
      {.plan = made.plan, .limiter = SafetyLimiter(made.limits, setup.device, kDt)});
  const std::shared_ptr<Trace> trace = loop.make_trace(kRows);
  loop.run(*trace, updates.get());

  Result result;
  std::int64_t tick = 0;
  result.fault = first_fault_of(*trace, tick);
  if (result.fault != Fault::kNone) {
    result.detected = std::max<std::int64_t>(tick - injected.at, 0);
    result.to_zero = std::max<std::int64_t>(injected.last_command + 1 - tick, 0);
  }
  const Verdict end = judge_end(loop, bench, injected, *trace, result.fault);
  if (result.fault != Fault::kNone) {
    result.to_off = std::max<std::int64_t>(injected.last_current + 1 - tick, 0);
  }
  referee.finish();
  result.breach = referee.breach();
  result.verdict = judge_fault(injected, made, result);
  if (result.verdict == Verdict::kPassed) result.verdict = end;
  if (result.verdict == Verdict::kPassed && result.breach.rule != Rule::kNone) {
    result.verdict = Verdict::kBeyondLimit;
  }
  if (injected.kind == Kind::kParameterWrites && updates->applied().size() == 0) {
    result.verdict = Verdict::kNotRecorded;
  }
  if (rows != nullptr) *rows = trace;
  return result;
}

}  // namespace ebac::faults
