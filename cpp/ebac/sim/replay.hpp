#pragma once

#include <memory>
#include <utility>

#include "ebac/control/per_axis.hpp"
#include "ebac/loop/loop.hpp"
#include "ebac/sim/replay_device.hpp"

namespace ebac {

/// Drives `law` with a log to its end and returns every row: the commands of the law, tick by tick,
/// for the recorded motion of the handle.
template <AxesController Law>
std::shared_ptr<Trace> replay(std::shared_ptr<const ReplayLog> log, Law law,
                              const DeviceModel& device, const Environment& environment) {
  const std::size_t rows = log->rows();
  const int axes = static_cast<int>(log->axes);
  ReplayClock clock(log);
  const SignalChain chain(device, environment, law.timing(), observing(log->observer, law));
  Loop<ReplayDevice, ReplayClock, Law> loop(ReplayDevice(std::move(log)), std::move(clock),
                                            std::move(law), chain, axes);
  auto trace = loop.make_trace(rows);
  loop.run(*trace);
  return trace;
}

}  // namespace ebac
