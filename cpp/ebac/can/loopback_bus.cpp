#include "ebac/can/loopback_bus.hpp"

#include <atomic>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "ebac/can/mpmc_queue.hpp"
#include "ebac/can/wake_event.hpp"

namespace ebac::can {

namespace {

/// Frames sent while another thread delivers. Fills up only while that thread is held up.
constexpr std::size_t kIntake = 1024;

/// Between two looks whether a delivery is over, which takes microseconds.
constexpr std::chrono::microseconds kNap{20};

struct Message {
  Frame frame{};
  std::uint64_t from = 0;
};

using Counter = std::atomic<std::uint64_t>;

void count(Counter& counter) noexcept { counter.fetch_add(1, std::memory_order_relaxed); }

std::int64_t wall_clock() noexcept {  // ns since 1970
  const auto now = std::chrono::system_clock::now().time_since_epoch();
  return std::chrono::duration_cast<std::chrono::nanoseconds>(now).count();
}

}  // namespace

struct LoopbackBus::End {
  explicit End(const LoopbackOptions& options) : own(options.own), queue(options.frames) {}

  /// Called by the delivering thread.
  void take(const Message& message) noexcept {
    if (message.from == id && !own) return;
    Frame in = message.frame;
    in.own = message.from == id;
    if (queue.push(in)) {
      arrived.signal();
    } else {
      count(lost);
    }
  }

  std::uint64_t id = 0;
  const bool own;
  MpmcQueue<Frame> queue;
  WakeEvent arrived;
  std::atomic<bool> closed{false};
  Counter sent{0}, refused{0}, received{0}, lost{0};
};

/// State shared by hub and ends. The delivering thread owns `ends` and the reading side of `intake`.
struct LoopbackHub::Shared {
  explicit Shared(Stamps which) : stamps(which) {}

  /// Delivers every waiting frame, or leaves them to the thread that is delivering. A thread that
  /// ends its turn looks again: both exchanges act on one variable, so the frame of a sender that
  /// found the turn taken is not missed.
  void deliver() noexcept {
    do {
      if (busy.exchange(true, std::memory_order_acq_rel)) return;
      Message message;
      while (intake.pop(message)) {
        message.frame.stamp = stamps == Stamps::kWallClock ? wall_clock() : 0;
        for (LoopbackBus::End* end : ends) end->take(message);
      }
      busy.exchange(false, std::memory_order_acq_rel);
    } while (intake.ready());
  }

  /// Changes the list of ends while no thread delivers. Sleeps until then, rather than spins: a thread of real time that
  /// yields would let no other of its CPU finish its delivery.
  template <class Work>
  void alone(Work work) {
    while (busy.exchange(true, std::memory_order_acq_rel)) std::this_thread::sleep_for(kNap);
    struct GiveBack {
      Shared& shared;
      ~GiveBack() {
        shared.busy.exchange(false, std::memory_order_acq_rel);
        shared.deliver();
      }
    } const give_back{*this};
    work();
  }

  const Stamps stamps;
  MpmcQueue<Message> intake{kIntake};
  std::atomic<bool> busy{false};  // a thread is delivering
  std::vector<LoopbackBus::End*> ends;
  std::uint64_t last_id = 0;
};

LoopbackHub::LoopbackHub(Stamps stamps) : shared_(std::make_shared<Shared>(stamps)) {}

LoopbackBus LoopbackHub::open(LoopbackOptions options) {
  if (options.frames < 1 || options.frames > LoopbackOptions::kMostFrames) {
    throw std::invalid_argument("LoopbackBus.frames = " + std::to_string(options.frames) +
                                ": must lie in [1, " +
                                std::to_string(LoopbackOptions::kMostFrames) + "]");
  }
  LoopbackBus made;
  made.hub_ = shared_;
  made.end_ = std::make_shared<LoopbackBus::End>(options);
  shared_->alone([&] {
    made.end_->id = ++shared_->last_id;
    shared_->ends.push_back(made.end_.get());
  });
  return made;
}

std::size_t LoopbackHub::ends() const {
  std::size_t n = 0;
  shared_->alone([&] { n = shared_->ends.size(); });
  return n;
}

LoopbackBus::~LoopbackBus() { close(); }

LoopbackBus& LoopbackBus::operator=(LoopbackBus&& other) noexcept {
  if (this != &other) {
    close();
    hub_ = std::move(other.hub_);
    end_ = std::move(other.end_);
  }
  return *this;
}

bool LoopbackBus::send(const Frame& out) noexcept {
  if (end_ == nullptr) return false;
  const bool open = !end_->closed.load(std::memory_order_acquire);
  if (!open || !sendable(out) || !hub_->intake.push({out, end_->id})) {
    count(end_->refused);
    return false;
  }
  hub_->deliver();
  count(end_->sent);
  return true;
}

bool LoopbackBus::receive(Frame& in) noexcept {
  if (state() != BusState::kUp || !end_->queue.pop(in)) return false;
  count(end_->received);
  return true;
}

bool LoopbackBus::receive(Frame& in, std::chrono::nanoseconds timeout) noexcept {
  if (receive(in)) return true;
  if (end_ == nullptr || timeout.count() <= 0) return false;
  bool came = false;
  end_->arrived.wait(timeout, [&] {
    came = receive(in);
    return came || state() == BusState::kClosed;
  });
  return came;
}

BusState LoopbackBus::state() const noexcept {
  const bool open = end_ != nullptr && !end_->closed.load(std::memory_order_acquire);
  return open ? BusState::kUp : BusState::kClosed;
}

BusCounts LoopbackBus::counts() const noexcept {
  if (end_ == nullptr) return {};
  return {
      .sent = end_->sent, .refused = end_->refused, .received = end_->received, .lost = end_->lost};
}

void LoopbackBus::close() noexcept {
  if (end_ == nullptr || end_->closed.exchange(true, std::memory_order_acq_rel)) return;
  hub_->alone([&] { std::erase(hub_->ends, end_.get()); });
  end_->arrived.signal_all();
}

}  // namespace ebac::can
