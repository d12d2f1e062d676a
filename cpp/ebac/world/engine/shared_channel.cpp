#include "ebac/world/engine/shared_channel.hpp"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <filesystem>
#include <new>
#include <stdexcept>
#include <string_view>
#include <system_error>
#include <utility>

#include "ebac/rt/other_process.hpp"

namespace ebac::world {

namespace {

constexpr std::size_t kLongest = 200;
constexpr std::string_view kOwn = "/ebac-engine-";

/// The process of a name that a loop has made for itself, as "/ebac-engine-1234-1"; 0 for another name.
int maker(std::string_view name) {
  int process = 0, count = 0;
  if (!name.starts_with(kOwn)) return 0;
  const char* end = name.data() + name.size();
  const auto first = std::from_chars(name.data() + kOwn.size(), end, process);
  if (first.ptr == end || *first.ptr != '-') return 0;
  return std::from_chars(first.ptr + 1, end, count).ptr == end ? process : 0;
}

/// Whether the process that shared something under that name has died without taking it away. What lies there may be
/// damaged; then the name has the process.
bool left_behind(const std::string& name) {
  int process = maker(name);
  try {
    const rt::SharedMemory memory = rt::SharedMemory::opened(name);
    const auto* segment = static_cast<const EngineSegment*>(memory.at());
    const bool whole = memory.bytes() >= offsetof(EngineSegment, mail);
    if (whole && segment->valid()) process = segment->loop;
  } catch (const std::exception&) {  // it is empty, not ours, or gone
  }
  return process > 0 && !rt::process_lives(process);
}

/// Takes away what loops that were killed have left, under names of their own.
void clean_up() {
  std::error_code none;
  for (const auto& file : std::filesystem::directory_iterator("/dev/shm", none)) {
    const std::string name = "/" + file.path().filename().string();
    if (maker(name) > 0 && left_behind(name)) rt::SharedMemory::remove(name);
  }
}

std::string own_name() {
  static std::atomic<int> count{0};
  return std::string(kOwn) + std::to_string(rt::own_process()) + "-" + std::to_string(++count);
}

rt::SharedMemory made(const std::string& name) {
  try {
    return rt::SharedMemory::named(name, sizeof(EngineSegment));
  } catch (const std::system_error& error) {
    if (error.code() != std::errc::file_exists) throw;
  }
  if (!left_behind(name)) {
    throw std::invalid_argument("channel " + name +
                                ": is taken by another program; end it, or give another name");
  }
  rt::SharedMemory::remove(name);
  return rt::SharedMemory::named(name, sizeof(EngineSegment));
}

/// Memory and what lies in it, for as long as anybody has either.
struct Kept {
  explicit Kept(const std::string& name)
      : memory(made(name)), segment(new (memory.at()) EngineSegment()) {}
  rt::SharedMemory memory;
  EngineSegment* segment;
};

}  // namespace

bool EngineSegment::loop_runs() const noexcept {
  return over.load(std::memory_order_acquire) == 0 && rt::process_lives(loop);
}

std::string channel_name(const std::string& name) {
  const std::string bare = name.starts_with('/') ? name.substr(1) : name;
  const bool fits = !bare.empty() && bare.size() <= kLongest && bare[0] != '.' &&
                    std::ranges::all_of(bare, [](unsigned char one) {
                      return std::isalnum(one) || one == '.' || one == '_' || one == '-';
                    });
  if (fits) return "/" + bare;
  throw std::invalid_argument("channel = \"" + name +
                              "\": must be up to 200 letters, digits, '.', '_' and '-'");
}

SharedEngineChannel::SharedEngineChannel(const std::string& name)
    : name_(name.empty() ? own_name() : channel_name(name)) {
  if (name.empty()) clean_up();
  const auto kept = std::make_shared<Kept>(name_);
  segment_ = std::shared_ptr<EngineSegment>(kept, kept->segment);
  channel_ =
      std::make_shared<EngineChannel>(std::shared_ptr<EngineMail>(kept, &kept->segment->mail));
  segment_->loop = rt::own_process();
  segment_->magic.store(EngineSegment::kMagic, std::memory_order_release);
}

bool SharedEngineChannel::engine_lives() const noexcept {
  return engine() != 0 && segment_->left.load(std::memory_order_acquire) == 0 &&
         rt::process_lives(engine());
}

void SharedEngineChannel::end() noexcept {
  if (segment_->loop != rt::own_process()) return;  // a forked copy of it ends nothing
  if (segment_->over.exchange(1, std::memory_order_acq_rel) == 0) rt::SharedMemory::remove(name_);
}

}  // namespace ebac::world
