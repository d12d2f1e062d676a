#pragma once

#include <atomic>
#include <mutex>
#include <optional>
#include <stdexcept>
#include <utility>
#include <vector>

#include "ebac/rt/thread.hpp"

namespace ebac::rt {

/// A thread that is started once and stopped for good. Every call is of any thread, and of several at once: after a
/// `stop` nothing runs, and nothing starts any more.
class OnceThread {
 public:
  /// Throws std::logic_error with `again` the second time or after a stop, and what Thread throws.
  template <class Work>
  void start(const char* again, Mode mode, const Options& options, Work work) {
    const std::scoped_lock one(changing_);
    if (thread_ || over()) throw std::logic_error(again);
    thread_.emplace(mode, options, std::move(work));
  }

  /// Waits for the end of the work, which looks at `over`; then `close`, one call at a time.
  template <class Close>
  void stop(Close close) {
    {
      const std::scoped_lock one(changing_);
      over_.store(true, std::memory_order_relaxed);
    }
    // Without the lock: the work may wait for a lock of Python that the caller of `start` or `grants` holds.
    if (thread_) thread_->join();
    const std::scoped_lock one(changing_);
    close();
  }

  bool over() const noexcept { return over_.load(std::memory_order_relaxed); }

  /// Resources that were granted; empty before the start.
  std::vector<Grant> grants() const {
    const std::scoped_lock one(changing_);
    return thread_ ? thread_->report().grants : std::vector<Grant>{};
  }

 private:
  mutable std::mutex changing_;
  std::atomic<bool> over_{false};
  std::optional<Thread> thread_;  // only changed under the lock, and not once it is over
};

}  // namespace ebac::rt
