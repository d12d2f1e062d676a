#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <ebac/loop/mailbox.hpp>
#include <ebac/model/kinematics.hpp>
#include <semaphore>

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

/// Between the loop and a haptic thread: two mailboxes, in which the newest value replaces an older one. The loop never
/// waits, unless it is a simulation that goes step by step with the other side.
class Exchange {
 public:
  explicit Exchange(bool in_step) : in_step_(in_step) {}

  // The loop's side.
  void moved(const Motion& motion) EBAC_RT {
    motions_.post(motion);
    if (in_step_.load(std::memory_order_relaxed)) motion_there_.release();
  }
  const Asked* asked() EBAC_RT { return forces_.take(); }
  /// In step: until the force of the last motion is there.
  void wait_for_force() noexcept {
    wait(force_there_, [] { return true; });
  }

  // The other side's.
  /// The newest; in step that of the next tick, unless the loop has ended. Who did not ask for a force asks for none.
  template <class Running>
  Motion motion(Running running) {
    if (!answered_) ask({});
    wait(motion_there_, running);
    if (const Motion* newest = motions_.take()) last_ = *newest;
    answered_ = false;
    return last_;
  }
  void ask(const Asked& asked) {
    forces_.post(asked);
    if (answered_) return;
    answered_ = true;
    if (in_step_.load(std::memory_order_relaxed)) force_there_.release();
  }

  /// From now on nobody waits.
  void part() { in_step_.store(false, std::memory_order_relaxed); }

 private:
  using Semaphore = std::counting_semaphore<1 << 20>;
  static constexpr std::chrono::milliseconds kLook{5};  // for whether there is still somebody

  template <class Alive>
  void wait(Semaphore& semaphore, Alive alive) noexcept {
    while (in_step_.load(std::memory_order_relaxed) && alive() &&
           !semaphore.try_acquire_for(kLook)) {
    }
  }

  ebac::Mailbox<Motion> motions_;
  ebac::Mailbox<Asked> forces_;
  std::atomic<bool> in_step_;
  Semaphore motion_there_{0};
  Semaphore force_there_{1};  // the first tick has nothing to wait for
  Motion last_;               // the other side's
  bool answered_ = true;      // the other side's: the motion it saw last
};

}  // namespace chai
