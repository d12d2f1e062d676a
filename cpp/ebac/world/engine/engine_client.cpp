#include "ebac/world/engine/engine_client.hpp"

#include <cmath>
#include <cstdlib>
#include <stdexcept>
#include <system_error>
#include <thread>

#include "ebac/core/six_digits.hpp"
#include "ebac/rt/other_process.hpp"

namespace ebac::world {

namespace {

using std::chrono::steady_clock;

constexpr std::chrono::milliseconds kLook{100};  // between two looks after the loop's process
constexpr std::chrono::microseconds kNap{50};    // between two looks for a pose

std::string asked_name(const std::string& given) {
  if (!given.empty()) return channel_name(given);
  const char* named = std::getenv(EngineClient::kVariable);
  if (named != nullptr && *named != '\0') return channel_name(named);
  throw std::invalid_argument(
      "no channel to a loop is named: start this program by `ebac run FILE --engine-command`, or "
      "by "
      "worlds.EngineProcess, or set " +
      std::string(EngineClient::kVariable));
}

[[noreturn]] void refuse(const std::string& name, const std::string& what) {
  throw std::invalid_argument("channel " + name + ": " + what);
}

std::shared_ptr<rt::SharedMemory> opened(const std::string& name) {
  try {
    return std::shared_ptr<rt::SharedMemory>(new rt::SharedMemory(rt::SharedMemory::opened(name)));
  } catch (const std::system_error& error) {
    if (error.code() != std::errc::no_such_file_or_directory) throw;
    throw std::system_error(error.code(), "no loop has opened the channel " + name +
                                              ", or it has ended; start the loop first");
  }
}

EngineSegment* checked(const rt::SharedMemory& memory, const std::string& name) {
  auto* segment = static_cast<EngineSegment*>(memory.at());
  if (memory.bytes() < offsetof(EngineSegment, mail) || !segment->valid())
    refuse(name, "is not one of ebac, or is not ready yet");
  if (segment->layout != EngineSegment::kLayout || segment->bytes != sizeof(EngineSegment) ||
      memory.bytes() != sizeof(EngineSegment)) {
    refuse(name, "has layout " + std::to_string(segment->layout) + " of " +
                     std::to_string(segment->bytes) + " bytes, this program " +
                     std::to_string(EngineSegment::kLayout) + " of " +
                     std::to_string(sizeof(EngineSegment)) +
                     "; loop and engine must be of the same version of ebac");
  }
  return segment;
}

void check(const char* name, double value, const char* unit, double least, double most) {
  if (value >= least && value <= most) return;
  const std::string in = std::string(unit).empty() ? "" : " " + std::string(unit);
  throw std::invalid_argument("LocalModel." + std::string(name) + " = " + six_digits(value) + in +
                              ": must lie in [" + six_digits(least) + ", " + six_digits(most) +
                              "]" + in);
}

void check(const LocalModel& model) {
  using M = LocalModel;
  for (const double value : model.at) check("at", value, "m", -M::kFarthest, M::kFarthest);
  for (const double value : model.velocity)
    check("velocity", value, "m/s", -M::kFastest, M::kFastest);
  check("length of into", model.into.norm(), "", 1 - M::kOffUnit, 1 + M::kOffUnit);
  check("curvature", model.curvature, "1/m", -M::kMostCurvature, M::kMostCurvature);
  check("stiffness", model.stiffness, "N/m", 0, M::kStiffest);
  check("damping", model.damping, "N s/m", 0, M::kMostDamping);
}

}  // namespace

EngineClient::EngineClient(const std::string& name)
    : name_(asked_name(name)), memory_(opened(name_)), segment_(checked(*memory_, name_)) {
  if (!segment_->loop_runs())
    throw std::runtime_error("channel " + name_ + ": its loop has ended; start another one");
  std::int32_t nobody = 0;
  if (!segment_->engine.compare_exchange_strong(nobody, rt::own_process())) {
    throw std::runtime_error("channel " + name_ + ": the engine of process " +
                             std::to_string(nobody) + " was there first; each loop has one engine");
  }
}

EngineClient::~EngineClient() {
  segment_->left.store(1, std::memory_order_release);
  if (!rt::process_lives(segment_->loop)) rt::SharedMemory::remove(name_);
}

const EnginePose* EngineClient::take_pose() noexcept {
  const EnginePose* newest = segment_->mail.poses.take();
  if (newest == nullptr) return nullptr;
  pose_ = *newest;
  return &pose_;
}

const EnginePose* EngineClient::wait_for_pose(double patience) {
  const auto until = steady_clock::now() + std::chrono::duration<double>(patience);
  for (;;) {
    if (const EnginePose* newest = take_pose()) return newest;
    if (steady_clock::now() >= until || !loop_runs()) return nullptr;
    std::this_thread::sleep_for(kNap);
  }
}

void EngineClient::post(LocalModel model) {
  check(model);
  model.t = pose_.t;
  segment_->mail.models.post({.model = model, .x = pose_.x});
  segment_->posted.fetch_add(1, std::memory_order_relaxed);
}

bool EngineClient::loop_runs() noexcept {
  const auto now = steady_clock::now();
  if (runs_ && now - looked_ > kLook) {
    looked_ = now;
    runs_ = segment_->loop_runs();
  }
  runs_ = runs_ && segment_->over.load(std::memory_order_acquire) == 0;
  return runs_;
}

LocalModel plane_of_force(const Axes& x, const Axes& force, double stiffness) EBAC_RT {
  const double push = force.norm();
  if (!(push > 0) || !(stiffness > 0)) return {};
  const Axes into = force / push;
  return {.at = x - push / stiffness * into, .into = into, .stiffness = stiffness, .surface = true};
}

}  // namespace ebac::world
