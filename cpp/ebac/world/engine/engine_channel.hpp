#pragma once

#include <atomic>
#include <memory>
#include <utility>

#include "ebac/loop/mailbox.hpp"
#include "ebac/world/engine/scheduled_models.hpp"

namespace ebac::world {

/// The handle, as an engine's thread is told.
struct EnginePose {
  Axes x = Axes::Zero();  // m
  Axes v = Axes::Zero();  // m/s
  double t = 0;           // s of the run
};

/// Between the tick and an engine in a thread of its own: the newest pose there, the newest model back. Neither waits.
class EngineChannel {
 public:
  /// Of the engine's thread, and of no other at the same time.
  const EnginePose* take_pose() EBAC_RT { return poses_.take(); }
  void post(const LocalModel& model, const Axes& asked_at) EBAC_RT {
    models_.post({.model = model, .x = asked_at});
  }

  /// Of the tick.
  void tell(const EnginePose& pose) EBAC_RT { poses_.post(pose); }
  const Answer* take() EBAC_RT { return models_.take(); }

  /// One world alone may stand at the tick's end: the first that asks, until it is gone.
  bool claim(const void* world) EBAC_RT {
    const void* nobody = nullptr;
    return owner_.compare_exchange_strong(nobody, world, std::memory_order_acq_rel) ||
           nobody == world;
  }
  void release(const void* world) EBAC_RT {
    const void* mine = world;
    owner_.compare_exchange_strong(mine, nullptr, std::memory_order_acq_rel);
  }

 private:
  Mailbox<EnginePose> poses_;
  Mailbox<Answer> models_;
  std::atomic<const void*> owner_{nullptr};
};

/// Answers of an engine in a thread of its own.
class PostedModels {
 public:
  explicit PostedModels(std::shared_ptr<EngineChannel> channel) : channel_(std::move(channel)) {}
  PostedModels(const PostedModels&) = default;
  PostedModels& operator=(const PostedModels&) = delete;
  ~PostedModels() { channel_->release(this); }

  const Answer* take(const Axes& x, const Axes& v, double t) EBAC_RT {
    if (!channel_->claim(this)) return nullptr;
    channel_->tell({.x = x, .v = v, .t = t});
    return channel_->take();
  }

 private:
  std::shared_ptr<EngineChannel> channel_;
};

}  // namespace ebac::world
