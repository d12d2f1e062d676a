#pragma once

#include <atomic>
#include <memory>
#include <utility>

#include "ebac/loop/loop.hpp"
#include "ebac/rt/thread.hpp"

namespace ebac::rt {

/// Runs a loop in a thread of its own. While it runs, any thread may read its trace up to `size()`
/// and one may post parameter updates. Whatever ends the thread, the loop stops the device first.
template <Device D, Clock C, AxesController Law>
class LoopThread {
 public:
  /// Starts. `updates` and `trace`, made by the loop, are shared with the caller. Throws as Thread.
  LoopThread(std::unique_ptr<Loop<D, C, Law>> loop, std::shared_ptr<Trace> trace,
             std::shared_ptr<ParameterUpdates<Law>> updates, Mode mode, const Options& options)
      : loop_(std::move(loop)),
        trace_(std::move(trace)),
        updates_(std::move(updates)),
        thread_(mode, options, [this] {
          loop_->run(*trace_, updates_.get());
          done_.store(true, std::memory_order_release);
        }) {}
  ~LoopThread() { stop(); }
  LoopThread(const LoopThread&) = delete;
  LoopThread& operator=(const LoopThread&) = delete;
  LoopThread(LoopThread&&) = delete;
  LoopThread& operator=(LoopThread&&) = delete;

  /// Requests a stop; `join` waits for its end.
  void stop(bool at_once = false) EBAC_RT { updates_->stop(at_once); }
  void join() { thread_.join(); }
  bool done() const EBAC_RT { return done_.load(std::memory_order_acquire); }

  ParameterUpdates<Law>& updates() EBAC_RT { return *updates_; }
  const Trace& trace() const EBAC_RT { return *trace_; }
  const Report& report() const { return thread_.report(); }
  std::int64_t unrecorded() const EBAC_RT { return loop_->unrecorded(); }
  /// The loop itself: only once it is done.
  Loop<D, C, Law>& loop() EBAC_RT { return *loop_; }

 private:
  std::unique_ptr<Loop<D, C, Law>> loop_;
  std::shared_ptr<Trace> trace_;
  std::shared_ptr<ParameterUpdates<Law>> updates_;
  std::atomic<bool> done_{false};
  Thread thread_;  // last: it is joined before the others go
};

}  // namespace ebac::rt
