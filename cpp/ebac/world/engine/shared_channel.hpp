#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>

#include "ebac/rt/shared_memory.hpp"
#include "ebac/world/engine/engine_channel.hpp"

namespace ebac::world {

/// The memory that a loop and an engine in another process share. What stands before `mail` stays where it is in every
/// layout, so that each side can say what the other one is.
struct EngineSegment {
  /// Goes up with every change of what stands in `mail`.
  static constexpr std::uint32_t kLayout = 1;
  static constexpr std::uint64_t kMagic = 0x656e69676e656265;  // "ebengine"; set last

  std::atomic<std::uint64_t> magic{0};
  std::uint32_t layout = kLayout;
  std::uint32_t bytes = sizeof(EngineSegment);
  std::atomic<std::int32_t> loop{0};    // process
  std::atomic<std::int32_t> engine{0};  // process; 0: none has come
  std::atomic<std::uint32_t> over{0};   // the loop has ended
  std::atomic<std::uint32_t> left{0};   // the engine has closed its end
  std::atomic<std::int64_t> posted{0};  // models
  EngineMail mail;

  bool valid() const noexcept { return magic.load(std::memory_order_acquire) == kMagic; }
  /// Whether the process that made it is at work, and has not ended it.
  bool loop_runs() const noexcept;
};

static_assert(std::atomic<std::uint64_t>::is_always_lock_free, "or it is not for two processes");
static_assert(sizeof(EnginePose) == 56 && sizeof(LocalModel) == 112 && sizeof(Answer) == 136 &&
                  offsetof(EngineSegment, mail) == 40,
              "another layout: give it another number");

/// Memory shared with an engine in another process, from the loop's side: made here, found there by its name.
class SharedEngineChannel {
 public:
  /// Under `name`, of letters, digits and ._-, or one of its own. What a loop that has died left there is replaced. Throws
  /// std::invalid_argument for a name that is none or is taken, std::system_error where memory cannot be shared.
  explicit SharedEngineChannel(const std::string& name = {});
  /// As `end`; worlds that are made of it keep the memory.
  ~SharedEngineChannel() { end(); }
  SharedEngineChannel(const SharedEngineChannel&) = delete;
  SharedEngineChannel& operator=(const SharedEngineChannel&) = delete;
  SharedEngineChannel(SharedEngineChannel&&) = delete;
  SharedEngineChannel& operator=(SharedEngineChannel&&) = delete;

  /// What an EngineClient finds it by.
  const std::string& name() const noexcept { return name_; }
  /// For `make_posted`.
  const std::shared_ptr<EngineChannel>& channel() const noexcept { return channel_; }

  /// Process of the engine; 0 where none has come.
  int engine() const noexcept { return segment_->engine.load(std::memory_order_acquire); }
  /// Whether it has come, has not closed its end, and its process is at work.
  bool engine_lives() const noexcept;
  /// Models it has posted.
  std::int64_t posted() const noexcept { return segment_->posted.load(std::memory_order_relaxed); }

  /// Tells the engine that the loop has ended, and takes the name away.
  void end() noexcept;

 private:
  std::string name_;
  std::shared_ptr<EngineSegment> segment_;
  std::shared_ptr<EngineChannel> channel_;
};

/// A name as the system takes it: "/it". Throws std::invalid_argument.
std::string channel_name(const std::string& name);

}  // namespace ebac::world
