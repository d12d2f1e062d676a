#pragma once

#include <atomic>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <memory>
#include <utility>

#include "ebac/loop/mailbox.hpp"
#include "ebac/world/engine/scheduled_models.hpp"

namespace ebac::world {

/// The handle, as an engine gets it.
struct EnginePose {
  Axes x = Axes::Zero();  // m
  Axes v = Axes::Zero();  // m/s
  double t = 0;           // s of the run
};

/// What passes between a tick and an engine, without a pointer in it: it may lie in memory of two processes.
struct EngineMail {
  Mailbox<EnginePose> poses;
  Mailbox<Answer> models;
};

/// Between the tick and an engine in a thread or a process of its own: the newest pose there, the newest model back.
/// Neither waits.
class EngineChannel {
 public:
  EngineChannel() : EngineChannel(std::make_shared<EngineMail>()) {}
  explicit EngineChannel(std::shared_ptr<EngineMail> mail) : mail_(std::move(mail)) {}

  /// Of the engine's thread, and of no other at the same time.
  const EnginePose* take_pose() EBAC_RT { return mail_->poses.take(); }
  void post(const LocalModel& model, const Axes& asked_at) EBAC_RT {
    mail_->models.post({.model = model, .x = asked_at});
  }

  /// Of the tick.
  void tell(const EnginePose& pose) EBAC_RT { mail_->poses.post(pose); }
  const Answer* take() EBAC_RT { return mail_->models.take(); }

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
  std::shared_ptr<EngineMail> mail_;
  std::atomic<const void*> owner_{nullptr};
};

/// A copy of what lies in memory that another process may write at any time: its `surface` is a bool whatever its byte is,
/// and a model out of range has a stiffness that is no number, which the bridge makes a fault.
inline Answer received(const Answer& shared) EBAC_RT {
  Answer own;
  std::memcpy(static_cast<void*>(&own), &shared, sizeof(own));
  unsigned char surface = 0;
  auto* flag = reinterpret_cast<unsigned char*>(&own) + offsetof(Answer, model) +
               offsetof(LocalModel, surface);
  std::memcpy(&surface, flag, 1);
  own.model.surface = surface != 0;
  if (!own.model.in_range()) own.model.stiffness = NAN;
  return own;
}

/// Answers of an engine in a thread or a process of its own.
class PostedModels {
 public:
  explicit PostedModels(std::shared_ptr<EngineChannel> channel) : channel_(std::move(channel)) {}
  PostedModels(const PostedModels&) = default;
  PostedModels& operator=(const PostedModels&) = delete;
  ~PostedModels() { channel_->release(this); }

  const Answer* take(const Axes& x, const Axes& v, double t) EBAC_RT {
    if (!channel_->claim(this)) return nullptr;
    channel_->tell({.x = x, .v = v, .t = t});
    const Answer* shared = channel_->take();
    if (shared == nullptr) return nullptr;
    answer_ = received(*shared);
    // One to a pose of an earlier run, whose time was later, would never grow old.
    return answer_.model.t > t ? nullptr : &answer_;
  }

 private:
  std::shared_ptr<EngineChannel> channel_;
  Answer answer_;  // the newest
};

}  // namespace ebac::world
