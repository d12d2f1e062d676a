#pragma once

#include <functional>
#include <mutex>
#include <thread>

#include "ebac/rt/options.hpp"
#include "ebac/rt/report.hpp"

namespace ebac::rt {

/// A thread for a loop: priority, CPU, locked memory, prefaulted stack, a machine that stays awake,
/// and no signals, which belong to the main thread. Its work must not touch Python.
class Thread {
 public:
  /// Requests the resources in `options`, then runs `work`. Returns when the grants are known.
  /// Throws std::invalid_argument for options out of range; with `kEnforce` std::runtime_error for
  /// a refused resource, and then `work` never runs.
  Thread(Mode mode, const Options& options, std::function<void()> work);
  ~Thread();
  Thread(const Thread&) = delete;
  Thread& operator=(const Thread&) = delete;
  Thread(Thread&&) = delete;
  Thread& operator=(Thread&&) = delete;

  /// Waits for the end of the work; from any thread, and from several.
  void join();
  const Report& report() const { return report_; }

 private:
  void begin(Mode mode, const Options& options, std::function<void()> work);

  Report report_;
  bool locked_ = false;
  std::mutex joining_;
  std::thread thread_;
};

/// Refused resources with reasons and remedies; empty if all were granted.
std::string refusals(const Report& report);

}  // namespace ebac::rt
