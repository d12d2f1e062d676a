#include "ebac/rt/thread.hpp"

#include <exception>
#include <future>
#include <stdexcept>
#include <string>
#include <utility>

#include "ebac/core/check.hpp"
#include "ebac/rt/awake_cpus.hpp"
#include "ebac/rt/grants.hpp"
#include "ebac/rt/no_signals.hpp"

namespace ebac::rt {

namespace {

/// Requests the resources of the calling thread. Locked memory belongs to the process and CPU sleep
/// to the machine: both are requested separately.
Report ask(const Options& options) {
  Report report;
  if (options.stack > 0) report.grants.push_back(touch_stack(options.stack));
  if (options.cpu >= 0) report.grants.push_back(ask_cpu(options.cpu));
  report.grants.push_back(ask_priority(options.priority));
  return report;
}

}  // namespace

std::string refusals(const Report& report) {
  std::string text;
  for (const Grant& grant : report.grants) {
    if (grant.granted) continue;
    if (!text.empty()) text += '\n';
    text +=
        grant.name + ": " + grant.asked + " was not granted (" + grant.why + "); " + grant.remedy;
  }
  return text;
}

Thread::Thread(Mode mode, const Options& options, std::function<void()> work) {
  check(options, "RealTime");
  if (mode != Mode::kOff && options.lock_memory) {
    report_.grants.push_back(ask_memory());
    locked_ = report_.grants.back().granted;
  }
  try {
    begin(mode, options, std::move(work));
  } catch (...) {
    if (locked_) release_memory();
    throw;
  }
}

void Thread::begin(Mode mode, const Options& options, std::function<void()> work) {
  std::promise<Report> asking;
  std::promise<bool> go;
  auto asked = asking.get_future();
  {
    const NoSignals inherited;
    thread_ = std::thread([mode, options, work = std::move(work), asking = std::move(asking),
                           start = go.get_future()]() mutable {
      AwakeCpus awake;  // as long as it works
      try {
        Report own = mode == Mode::kOff ? Report{} : ask(options);
        if (mode != Mode::kOff && options.stay_awake) own.grants.push_back(awake.ask());
        asking.set_value(std::move(own));
      } catch (...) {  // as without memory: the caller gets it, or the process would end
        return asking.set_exception(std::current_exception());
      }
      if (start.get()) work();
    });
  }
  try {
    Report own = asked.get();
    for (Grant& grant : own.grants) report_.grants.push_back(std::move(grant));
  } catch (...) {
    go.set_value(false);
    thread_.join();
    throw;
  }
  const bool enough = mode != Mode::kEnforce || report_.complete();
  go.set_value(enough);
  if (enough) return;
  thread_.join();
  throw std::runtime_error("a thread did not start, for it must have what it asked:\n" +
                           refusals(report_));
}

Thread::~Thread() {
  join();
  if (locked_) release_memory();
}

void Thread::join() {
  const std::scoped_lock one_by_one(joining_);
  if (thread_.joinable()) thread_.join();
}

}  // namespace ebac::rt
