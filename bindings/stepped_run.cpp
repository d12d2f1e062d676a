#include "stepped_run.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace ebac::python {

namespace {

Setup until_asked(Setup setup) {
  setup.loop.plan.ticks = 0;
  return setup;
}

}  // namespace

SteppedRun::SteppedRun(const AnyLaw& law, Setup setup, const std::optional<can::TimedBus>& bus,
                       std::size_t rows)
    : Running(law), dt_(setup.timing.dt), loop_(loop(law, until_asked(std::move(setup)), bus)) {
  loop_.device().device().switch_on();
  trace_ = loop_.make_trace(rows, /*ring=*/true);
  loop_.start();
}

SteppedRun::Work SteppedRun::loop(const AnyLaw& law, const Setup& setup,
                                  const std::optional<can::TimedBus>& bus) {
  All laws(law);
  const SignalChain chain(setup.device, setup.environment, laws.timing(),
                          observing(setup.observer, laws));
  return {Drives(can::device_through_can<SimulatedDevice>(setup, bus)),
          VirtualClock(setup.timing.dt, setup.jitter, setup.seed),
          std::move(laws),
          chain,
          setup.device.axes(),
          setup.loop};
}

std::int64_t SteppedRun::advance(std::int64_t ticks) {
  const std::scoped_lock one_by_one(stepping_);
  std::int64_t taken = 0;
  while (taken < ticks && !done()) {
    ++taken;
    if (!loop_.advance(*trace_, updates_.get())) done_.store(true, std::memory_order_release);
  }
  return taken;
}

void SteppedRun::aim(const std::array<double, kMaxAxes>& target) {
  const std::scoped_lock one_by_one(stepping_);
  for (std::size_t i = 0; i < kMaxAxes; ++i) loop_.device().aim(i, target[i]);
}

void SteppedRun::switch_off() {
  const std::scoped_lock one_by_one(stepping_);
  loop_.device().device().switch_off();
}

bool SteppedRun::wait(double seconds) {
  advance(std::llround(std::clamp(seconds / dt_, 1.0, 1e12)));
  return done();
}

void SteppedRun::join() { advance(std::numeric_limits<std::int64_t>::max()); }

}  // namespace ebac::python
