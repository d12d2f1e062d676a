#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <ebac/loop/mailbox.hpp>
#include <ebac/model/kinematics.hpp>
#include <mutex>

namespace chai {

/// Where the handle was in a tick.
struct Motion {
  ebac::Axes x = ebac::Axes::Zero();  // m
  ebac::Axes v = ebac::Axes::Zero();  // m/s
};

/// What a haptic thread asked for, and where it thought the handle to be.
struct Asked {
  ebac::Axes force = ebac::Axes::Zero();  // N, with which the handle presses
  ebac::Axes x = ebac::Axes::Zero();      // m
};

/// One of two threads that go in turns gives it, the other takes it.
class Turn {
 public:
  explicit Turn(bool given) : given_(given) {}
  void give() noexcept {
    {
      const std::lock_guard lock(mutex_);
      given_ = true;
    }
    changed_.notify_one();
  }
  /// Waits for it as long as `alive()`.
  template <class Alive>
  void take(Alive alive) noexcept {
    std::unique_lock lock(mutex_);
    while (!given_ && alive()) changed_.wait_for(lock, kLook);
    given_ = false;
  }

 private:
  static constexpr std::chrono::milliseconds kLook{5};  // for whether there is still somebody

  std::mutex mutex_;
  std::condition_variable changed_;
  bool given_;
};

/// Between the loop and a haptic thread: two mailboxes, in which the newest value replaces an older one. The loop never
/// waits, unless it is a simulation that goes step by step with the other side.
class Exchange {
 public:
  explicit Exchange(bool in_step) : in_step_(in_step) {}

  // The loop's side.
  void moved(const Motion& motion) EBAC_RT {
    motions_.post(motion);
    if (in_step()) motion_there_.give();
  }
  const Asked* asked() EBAC_RT { return forces_.take(); }
  /// In step: until the force of the last motion is there.
  void wait_for_force() noexcept {
    if (in_step()) force_there_.take([this] { return in_step(); });
  }

  // The other side's.
  /// The newest; in step that of the next tick, unless the loop has ended. Without a new force the last one stands.
  template <class Running>
  Motion motion(Running running) {
    if (!answered_ && in_step()) force_there_.give();
    if (in_step()) motion_there_.take([&] { return in_step() && running(); });
    if (const Motion* newest = motions_.take()) last_ = *newest;
    answered_ = false;
    return last_;
  }
  void ask(const Asked& asked) {
    forces_.post(asked);
    if (answered_) return;
    answered_ = true;
    if (in_step()) force_there_.give();
  }

  /// From now on nobody waits.
  void part() { in_step_.store(false, std::memory_order_relaxed); }

 private:
  bool in_step() const noexcept { return in_step_.load(std::memory_order_relaxed); }

  ebac::Mailbox<Motion> motions_;
  ebac::Mailbox<Asked> forces_;
  std::atomic<bool> in_step_;
  Turn motion_there_{false};
  Turn force_there_{true};  // the first tick has nothing to wait for
  Motion last_;             // the other side's
  bool answered_ = true;    // the other side's: the motion it saw last
};

}  // namespace chai
