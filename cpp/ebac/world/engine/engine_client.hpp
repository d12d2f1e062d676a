#pragma once

#include <chrono>
#include <memory>
#include <string>

#include "ebac/world/engine/shared_channel.hpp"

namespace ebac::world {

/// The engine's end of a channel, in a program of its own: reads where the handle is, posts what is near it.
///
///     ebac::world::EngineClient client;                      // the channel that `ebac run --engine-command` names
///     while (client.loop_runs()) {
///       if (const auto* pose = client.wait_for_pose(0.02)) client.post(model_near(pose->x));
///     }
///
/// Of one thread.
class EngineClient {
 public:
  /// The variable of the environment that names the channel.
  static constexpr const char* kVariable = "EBAC_ENGINE_CHANNEL";

  /// Finds a channel by its name; by that of the environment if it is empty. Throws std::invalid_argument where there is no
  /// name, where something else has it, and for a program of another layout; std::system_error where there is no channel;
  /// std::runtime_error where its loop has ended or another engine was there first.
  explicit EngineClient(const std::string& name = {});
  /// Tells the loop; takes the name away where the loop has died.
  ~EngineClient();
  EngineClient(const EngineClient&) = delete;
  EngineClient& operator=(const EngineClient&) = delete;
  EngineClient(EngineClient&&) = delete;
  EngineClient& operator=(EngineClient&&) = delete;

  /// The newest pose that was not taken yet; nullptr if there is none. It stays until the next call.
  const EnginePose* take_pose() noexcept;
  /// The same, and waits for it up to `patience` [s].
  const EnginePose* wait_for_pose(double patience);
  /// The last one that was taken.
  const EnginePose& pose() const noexcept { return pose_; }

  /// What is near the last pose, as of its time. Throws std::invalid_argument for a number out of range.
  void post(LocalModel model);
  /// No surface is near.
  void post_nothing() { post({}); }

  /// False once the loop has ended, or its process has. Looks after the process ten times a second.
  bool loop_runs() noexcept;

 private:
  using Time = std::chrono::steady_clock::time_point;

  std::string name_;
  std::shared_ptr<rt::SharedMemory> memory_;
  EngineSegment* segment_;
  EnginePose pose_;
  Time looked_{};
  bool runs_ = true;
};

/// The plane that presses back with a force of the handle on it [N] at `x` [m], `stiffness` [N/m]: what an engine that
/// knows these only posts. No surface without force.
LocalModel plane_of_force(const Axes& x, const Axes& force, double stiffness) EBAC_RT;

}  // namespace ebac::world
