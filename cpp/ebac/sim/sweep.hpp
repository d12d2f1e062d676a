#pragma once

#include <array>
#include <atomic>
#include <cmath>
#include <functional>
#include <vector>

#include "ebac/loop/tick.hpp"
#include "ebac/sim/recorder.hpp"
#include "ebac/sim/rest_power.hpp"
#include "ebac/sim/simulate.hpp"

/// Many runs over a pool of threads that lives only during the call, metrics instead of traces. A
/// run writes into its own place, so the result does not depend on the number of threads.
namespace ebac {

/// Beyond these a run is called diverged and ends.
struct RunLimits {
  double position = 1;   // m, of any axis
  double energy = 1000;  // J, taken out of the port

  static constexpr auto fields() {
    using F = Field<RunLimits>;
    return std::array{
        F{"position", &RunLimits::position, "m", "a run that goes farther from zero has diverged",
          1e-3, 1e3},
        F{"energy", &RunLimits::energy, "J", "so has one that takes more energy out of the port",
          1e-3, 1e9},
    };
  }
};

struct Outcome {
  WallContact contact{};
  double rest_power = WallContact::kNone;  // W
  std::size_t ticks = 0;  // rows; fewer than requested after a fault or a divergence
  Fault fault = Fault::kNone;
  bool diverged = false;
  bool done = false;  // false when cancelled before its end

  /// Whether the run came to its end; what ended before is neither still nor quiet.
  bool whole() const { return done && !diverged && fault == Fault::kNone; }
};

/// Progress of a sweep, and its cancellation, for a caller in another thread.
struct SweepProgress {
  std::atomic<std::size_t> done = 0;  // runs
  std::atomic<bool> cancelled = false;
};

using SweepWork = std::function<void(std::size_t, ContactRecorder&)>;

/// Calls `work(i, recorder)` for every i < count from `threads` threads, 0 for one per core; a
/// recorder belongs to a thread. An exception of a call ends the sweep and is thrown again here.
void for_each_run(std::size_t count, int threads, SweepProgress& progress, const SweepWork& work);

/// The law's state "clamped" of each axis, or nullptr: whether the law limited its force.
using Clamped = std::array<const bool*, kMaxAxes>;

/// Adds a row of every axis; the energies are those of all. Returns whether the run is within its limits.
inline bool keep_row(const Sample& s, const SimulatedDevice& device, const Clamped& clamped,
                     const Setup& setup, StoredEnergy& stored, const RunLimits& limits,
                     ContactRecorder& recorder) {
  Axes x = Axes::Zero();
  double energy = 0;
  for (std::size_t i = 0; i < static_cast<std::size_t>(s.axes); ++i) {
    x[static_cast<Eigen::Index>(i)] = device.state(i).x;
    energy += device.state(i).energy;
  }
  recorder.add(s.t, energy, stored.at(x, s.t));
  for (std::size_t i = 0; i < static_cast<std::size_t>(s.axes); ++i) {
    const Port& port = s.axis[i].port;
    const double at = device.state(i).x;
    const bool acts = port.f_env != 0 || port.f_cmd != 0 || port.f_applied != 0;
    recorder.add_axis(i, at, port.f_applied);
    recorder.add_world(i, port.f_env, acts ? setup.hand.pull(static_cast<int>(i), s.t, at) : 0.0);
    if (clamped[i] != nullptr) recorder.add_clamped(i, *clamped[i]);
  }
  return x.cwiseAbs().maxCoeff() <= limits.position && energy >= -limits.energy;
}

template <ScalarLaw Law>
Clamped clamped_of(const PerAxis<Law>& law) {
  Clamped clamped{};
  if constexpr (std::same_as<Law, AnyLaw>) {
    const FieldRow* field = law.state_table().find("clamped");
    if (field == nullptr || field->kind != FieldKind::kBool) return clamped;
    for (std::size_t i = 0; i < kMaxAxes; ++i) clamped[i] = &field->in<bool>(law.state(i));
  } else if constexpr (requires { law.state(0).clamped; }) {
    for (std::size_t i = 0; i < kMaxAxes; ++i) clamped[i] = &law.state(i).clamped;
  }
  return clamped;
}

/// Looks at the rows of a run and keeps nothing.
struct NoWatch {
  void operator()(const Sample&, const SimulatedDevice&) const EBAC_RT {}
};

/// Adds to the contact of the first axis what the others do, where the world acts on them at the end.
inline void take_others(const ContactRecorder& recorder, WallContact& contact) {
  for (std::size_t i = 1; i < recorder.axes(); ++i) {
    const ContactRecord record = recorder.record(i);
    if (touched_at_end(record)) contact.take_worse(measure_contact(record));
  }
}

/// One run: the ticks of `simulate`, kept as metrics; `watch` sees every row.
template <ScalarLaw Scalar, class Watch = const NoWatch>
Outcome measure_run(const Setup& setup, const Scalar& scalar, const RunLimits& limits,
                    ContactRecorder& recorder, const std::atomic<bool>& cancelled,
                    Watch& watch = NoWatch{}) {
  constexpr std::size_t kLook = 256;  // ticks between two looks at `cancelled`
  PerAxis<Scalar> law(scalar);
  const Clamped clamped = clamped_of(law);
  SimulatedDevice device(setup);
  VirtualClock clock(setup.timing.dt, setup.jitter, setup.seed);
  SignalChain chain(setup.device, setup.environment, law.timing(), observing(setup.observer, law));
  StoredEnergy stored(setup.environment, setup.device.kinematics);
  Sample sample{};
  sample.axes = setup.device.axes();
  Outcome outcome;
  const std::size_t rows = row_count(setup);
  recorder.start(rows, static_cast<std::size_t>(sample.axes));
  while (outcome.ticks < rows && outcome.fault == Fault::kNone && !outcome.diverged) {
    if (outcome.ticks % kLook == 0 && cancelled.load(std::memory_order_relaxed)) return outcome;
    tick(chain, law, device, clock.wait(), sample);
    outcome.diverged = !keep_row(sample, device, clamped, setup, stored, limits, recorder);
    watch(sample, device);
    outcome.fault = sample.fault;
    ++sample.tick;
    ++outcome.ticks;
  }
  if (recorder.rows() >= kFewestRows) outcome.contact = measure_contact(recorder.record());
  outcome.rest_power = rest_power(recorder.record(), outcome.contact);
  if (recorder.rows() >= kFewestRows) take_others(recorder, outcome.contact);
  if (outcome.ticks < rows) {
    outcome.contact.settled = outcome.contact.force_settled = WallContact::kNone;
  }
  outcome.done = true;
  return outcome;
}

/// Runs setups[i] under *laws[i] for every i. After a cancellation the missing runs are marked as
/// not done.
template <ScalarLaw Law>
std::vector<Outcome> sweep(const std::vector<const Setup*>& setups,
                           const std::vector<const Law*>& laws, int threads,
                           const RunLimits& limits, SweepProgress& progress) {
  std::vector<Outcome> outcomes(setups.size());
  for_each_run(setups.size(), threads, progress, [&](std::size_t i, ContactRecorder& recorder) {
    outcomes[i] = measure_run(*setups[i], *laws[i], limits, recorder, progress.cancelled);
  });
  return outcomes;
}

}  // namespace ebac
