#include "ebac/can/socketcan.hpp"

#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstring>
#include <ctime>
#include <utility>

#include "ebac/can/raw_socket.hpp"

namespace ebac::can {

namespace {

using Counter = std::atomic<std::uint64_t>;

/// Longest sleep at a time: how late `close`, or an interface that came back, is noticed.
constexpr std::chrono::nanoseconds kNap = std::chrono::milliseconds{100};

void count(Counter& counter) noexcept { counter.fetch_add(1, std::memory_order_relaxed); }

/// The interface disappeared or went down: reported once, before the frames left in the queue.
bool is_news(int error) noexcept { return error == ENETDOWN || error == ENODEV || error == ENXIO; }

template <class Value>
Value read(const cmsghdr& part) noexcept {
  Value value{};
  std::memcpy(&value, CMSG_DATA(&part), sizeof(value));
  return value;
}

}  // namespace

struct SocketCan::Socket {
  Socket(std::string name, const SocketCanOptions& options)
      : interface(std::move(name)),
        errors(options.errors),
        filters(to_wire(options.filters)),
        fd(open_raw(interface, options)) {}
  ~Socket() { ::close(fd); }
  Socket(const Socket&) = delete;
  Socket& operator=(const Socket&) = delete;

  BusState state() const noexcept { return state_.load(std::memory_order_acquire); }
  /// Closed stays closed.
  void become(BusState next) noexcept {
    BusState before = state();
    while (before != BusState::kClosed && !state_.compare_exchange_weak(before, next)) {
    }
  }
  void close() noexcept { state_.store(BusState::kClosed, std::memory_order_release); }

  /// State of the interface after a failed call.
  void note(int error) noexcept {
    if (!is_news(error)) return;
    if (error != ENETDOWN) bound.store(false, std::memory_order_release);
    become(BusState::kDown);
  }

  /// Whether the interface is there, after looking again where it was not.
  bool ready() noexcept {
    if (state() != BusState::kDown) return state() != BusState::kClosed;
    forget_error(fd);  // it may be older than the interface
    int error = look_up(fd, interface);
    if (error == 0 && !bound.load(std::memory_order_acquire)) {
      error = bind_raw(fd, interface, filters);
    }
    if (error != 0) return false;
    bound.store(true, std::memory_order_release);
    become(BusState::kUp);
    return state() == BusState::kUp;
  }

  /// One frame off the queue: 0, or errno.
  int take(Frame& in) noexcept {
    can_frame wire{};
    iovec into{.iov_base = &wire, .iov_len = sizeof(wire)};
    alignas(cmsghdr) std::array<char, 128> extra{};
    msghdr message{};
    message.msg_iov = &into;
    message.msg_iovlen = 1;
    message.msg_control = extra.data();
    message.msg_controllen = extra.size();
    const ssize_t bytes = ::recvmsg(fd, &message, MSG_DONTWAIT);
    if (bytes < 0) return errno;
    if (bytes != CAN_MTU) return EPROTO;
    in = from_wire(wire);
    in.own = (message.msg_flags & MSG_CONFIRM) != 0;
    for (cmsghdr* part = CMSG_FIRSTHDR(&message); part; part = CMSG_NXTHDR(&message, part)) {
      if (part->cmsg_level != SOL_SOCKET) continue;
      if (part->cmsg_type == SO_TIMESTAMPNS) {
        const auto at = read<timespec>(*part);
        in.stamp = std::int64_t{at.tv_sec} * 1'000'000'000 + at.tv_nsec;
      } else if (part->cmsg_type == SO_RXQ_OVFL) {
        lost.store(read<std::uint32_t>(*part), std::memory_order_relaxed);
      }
    }
    return 0;
  }

  const std::string interface;
  const bool errors;
  const std::vector<can_filter> filters;
  const int fd;
  std::atomic<bool> bound{true};
  Counter sent{0}, refused{0}, received{0}, lost{0};

 private:
  std::atomic<BusState> state_{BusState::kUp};
};

SocketCan::SocketCan() noexcept = default;
SocketCan::SocketCan(const std::string& interface, const SocketCanOptions& options)
    : socket_(std::make_unique<Socket>(interface, options)) {}
SocketCan::~SocketCan() = default;
SocketCan::SocketCan(SocketCan&&) noexcept = default;
SocketCan& SocketCan::operator=(SocketCan&&) noexcept = default;

bool SocketCan::send(const Frame& out) noexcept {
  if (socket_ == nullptr) return false;
  const can_frame wire = to_wire(out);
  // Twice: the first failure may be the news that the interface was away, and is back.
  for (int i = 0; i < 2 && sendable(out) && socket_->ready(); ++i) {
    if (::send(socket_->fd, &wire, sizeof(wire), MSG_DONTWAIT) == CAN_MTU) {
      count(socket_->sent);
      return true;
    }
    socket_->note(errno);
    if (socket_->state() != BusState::kDown) break;
  }
  count(socket_->refused);
  return false;
}

bool SocketCan::receive(Frame& in) noexcept {
  if (socket_ == nullptr) return false;
  Frame next;
  for (int error = 0; socket_->state() != BusState::kClosed;) {
    error = socket_->take(next);
    if (error != 0) socket_->note(error);
    const bool up = socket_->ready();
    if (error == EPROTO || (up && is_news(error))) continue;
    if (error != 0) return false;
    if (next.error) {
      socket_->become(after_error(next, socket_->state()));
      if (!socket_->errors) continue;
    }
    count(socket_->received);
    in = next;
    return true;
  }
  return false;
}

bool SocketCan::receive(Frame& in, std::chrono::nanoseconds timeout) noexcept {
  using Clock = std::chrono::steady_clock;
  const auto start = Clock::now();
  while (!receive(in)) {
    const std::chrono::nanoseconds left = timeout - (Clock::now() - start);
    if (left.count() <= 0 || state() == BusState::kClosed) return false;
    const timespec nap{.tv_sec = 0, .tv_nsec = std::min(left, kNap).count()};
    pollfd one{.fd = socket_->fd, .events = POLLIN, .revents = 0};
    if (::ppoll(&one, 1, &nap, nullptr) < 0) return receive(in);  // a signal came
  }
  return true;
}

BusState SocketCan::state() const noexcept {
  return socket_ == nullptr ? BusState::kClosed : socket_->state();
}

BusCounts SocketCan::counts() const noexcept {
  if (socket_ == nullptr) return {};
  return {.sent = socket_->sent,
          .refused = socket_->refused,
          .received = socket_->received,
          .lost = socket_->lost};
}

void SocketCan::close() noexcept {
  if (socket_ != nullptr) socket_->close();
}

}  // namespace ebac::can
