#include "ebac/canopen/loop_watch.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "ebac/core/check.hpp"
#include "ebac/core/six_digits.hpp"

namespace ebac::can {

double beat_period(double silence) {
  constexpr double kLongest = 60;  // s, as CanopenSetup.heartbeat_period
  return std::clamp(silence / kBeatsInSilence, kLeastBeat, kLongest);
}

double sent_every(double period, double dt) {
  constexpr double kRounding = 1e-9;  // a period of whole ticks is not one tick more
  return dt * std::max(1.0, std::ceil(period / dt * (1 - kRounding)));
}

void check_watch(const LoopWatch& watch, double dt) {
  const double every = sent_every(watch.period, dt);
  if (watch.ms == 0 || static_cast<double>(watch.ms) / 1e3 > every) return;
  const auto ticks = std::llround(every / dt);
  throw std::invalid_argument(
      watch.name + " = " + shortest(watch.seconds) + " s: a drive lets go without a " + watch.what +
      " for " + std::to_string(watch.ms) + " ms, and the next one comes after " +
      (ticks == 1 ? "a tick of" : std::to_string(ticks) + " ticks,") + " " + six_digits(every) +
      " s; must be longer than that in whole milliseconds, or 0, which watches none: shorten "
      "timing.dt, or let the drives watch for longer");
}

}  // namespace ebac::can
