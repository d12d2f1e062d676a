#pragma once

#include <functional>
#include <thread>

#include "ebac/rt/options.hpp"
#include "ebac/rt/report.hpp"

namespace ebac::rt {

/// A thread for a loop: priority, CPU, locked memory, touched stack, a machine that stays awake, and
/// no signals, which are the main thread's business. What it runs must not touch Python.
class Thread {
 public:
  /// Asks for what `options` name, then runs `work`. Returns when the thread knows what it got.
  /// Throws std::invalid_argument for options out of range; with `kEnforce` std::runtime_error for
  /// what was not granted, and then `work` never runs.
  Thread(Mode mode, const Options& options, std::function<void()> work);
  ~Thread();
  Thread(const Thread&) = delete;
  Thread& operator=(const Thread&) = delete;
  Thread(Thread&&) = delete;
  Thread& operator=(Thread&&) = delete;

  void join();
  const Report& report() const { return report_; }

 private:
  void begin(Mode mode, const Options& options, std::function<void()> work);

  Report report_;
  bool locked_ = false;
  std::thread thread_;
};

/// What was not granted, why, and the command that would grant it; empty when all was.
std::string refusals(const Report& report);

}  // namespace ebac::rt
