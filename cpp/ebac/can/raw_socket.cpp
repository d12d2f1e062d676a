#include "ebac/can/raw_socket.hpp"

#include <linux/can.h>
#include <linux/can/error.h>
#include <linux/can/raw.h>
#include <net/if.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <system_error>
#include <utility>

namespace ebac::can {

can_frame to_wire(const Frame& out) noexcept {
  can_frame wire{};
  wire.can_id = out.id;
  if (out.extended) wire.can_id |= CAN_EFF_FLAG;
  if (out.remote) wire.can_id |= CAN_RTR_FLAG;
  if (out.error) wire.can_id |= CAN_ERR_FLAG;
  wire.len = std::min<std::uint8_t>(out.size, CAN_MAX_DLEN);
  std::copy(out.data.begin(), out.data.end(), wire.data);
  return wire;
}

Frame from_wire(const can_frame& in) noexcept {
  Frame frame;
  frame.extended = (in.can_id & CAN_EFF_FLAG) != 0;
  frame.remote = (in.can_id & CAN_RTR_FLAG) != 0;
  frame.error = (in.can_id & CAN_ERR_FLAG) != 0;
  frame.id = in.can_id & (frame.extended || frame.error ? CAN_EFF_MASK : CAN_SFF_MASK);
  frame.size = std::min<std::uint8_t>(in.len, CAN_MAX_DLEN);
  if (!frame.remote) std::copy_n(in.data, frame.size, frame.data.begin());
  return frame;
}

BusState after_error(const Frame& error, BusState before) noexcept {
  if ((error.id & CAN_ERR_BUSOFF) != 0) return BusState::kBusOff;
  if ((error.id & CAN_ERR_CRTL) != 0) {
    const unsigned status = error.data[1];
    if ((status & (CAN_ERR_CRTL_RX_PASSIVE | CAN_ERR_CRTL_TX_PASSIVE)) != 0) {
      return BusState::kPassive;
    }
    if ((status & (CAN_ERR_CRTL_RX_WARNING | CAN_ERR_CRTL_TX_WARNING)) != 0) {
      return BusState::kWarning;
    }
    if ((status & CAN_ERR_CRTL_ACTIVE) != 0) return BusState::kUp;
  }
  return (error.id & CAN_ERR_RESTARTED) != 0 ? BusState::kUp : before;
}

namespace {

/// Request for information on an interface.
ifreq asking_for(const std::string& interface) noexcept {
  ifreq request{};
  interface.copy(request.ifr_name, IFNAMSIZ - 1);
  return request;
}

std::string how_to_bring_up(const std::string& interface) {
  const bool is_virtual = interface.starts_with('v');  // vcan0, vxcan0
  return "ip link set " + interface + " up" + (is_virtual ? "" : " type can bitrate 1000000");
}

/// The error, and the command that repairs it.
std::string remedy(const std::string& interface, int error) {
  switch (error) {
    case EAFNOSUPPORT:
    case EPROTONOSUPPORT:
      return "this kernel has no CAN sockets; load them: modprobe can_raw. Where the kernel was "
             "built without, there is the loopback bus: can.Bus(interface='ebac')";
    case ENODEV:
      return "there is no such interface; plug in the adapter or load its driver, then: " +
             how_to_bring_up(interface) +
             ". To try without hardware: ip link add dev vcan0 type vcan && ip link set vcan0 up";
    case ENETDOWN:
      return "the interface is down; bring it up: " + how_to_bring_up(interface);
    case EMEDIUMTYPE:
      return "this is no CAN interface; ip -details link show type can lists those";
    case EINVAL:
      return "the name of an interface has 1 to " + std::to_string(IFNAMSIZ - 1) + " letters";
    default:
      return "cannot be opened";
  }
}

[[noreturn]] void refuse(const std::string& interface, int error) {
  throw std::system_error(error, std::generic_category(),
                          "CAN interface '" + interface + "': " + remedy(interface, error));
}

/// A file descriptor until it is let go.
class Descriptor {
 public:
  explicit Descriptor(int fd) noexcept : fd_(fd) {}
  ~Descriptor() {
    if (fd_ >= 0) ::close(fd_);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;

  int get() const noexcept { return fd_; }
  int let_go() noexcept { return std::exchange(fd_, -1); }

 private:
  int fd_;
};

template <class Value>
bool set(int socket, int level, int option, const Value& value) noexcept {
  return ::setsockopt(socket, level, option, &value, sizeof(value)) == 0;
}

bool set_options(int socket, const SocketCanOptions& options) {
  // Single bus errors may come by the thousand; the state depends on controller errors only.
  const can_err_mask_t reported =
      options.errors ? CAN_ERR_MASK : CAN_ERR_CRTL | CAN_ERR_BUSOFF | CAN_ERR_RESTARTED;
  return set(socket, SOL_CAN_RAW, CAN_RAW_ERR_FILTER, reported) &&
         set(socket, SOL_CAN_RAW, CAN_RAW_RECV_OWN_MSGS, int{options.own}) &&
         set(socket, SOL_SOCKET, SO_TIMESTAMPNS, 1) && set(socket, SOL_SOCKET, SO_RXQ_OVFL, 1);
}

}  // namespace

int look_up(int socket, const std::string& interface) noexcept {
  ifreq request = asking_for(interface);
  if (::ioctl(socket, SIOCGIFFLAGS, &request) != 0) return errno;
  return (request.ifr_flags & IFF_UP) != 0 ? 0 : ENETDOWN;
}

void forget_error(int socket) noexcept {
  int error = 0;
  socklen_t size = sizeof(error);
  ::getsockopt(socket, SOL_SOCKET, SO_ERROR, &error, &size);
}

std::vector<can_filter> to_wire(const std::vector<CanFilter>& filters) {
  if (filters.empty()) return {{.can_id = 0, .can_mask = 0}};
  std::vector<can_filter> wire;
  wire.reserve(filters.size());
  for (const CanFilter& filter : filters) {
    wire.push_back({.can_id = (filter.id & CAN_EFF_MASK) | (filter.extended ? CAN_EFF_FLAG : 0U),
                    .can_mask = (filter.mask & CAN_EFF_MASK) | CAN_EFF_FLAG});
  }
  return wire;
}

int bind_raw(int socket, const std::string& interface,
             const std::vector<can_filter>& filters) noexcept {
  const auto bytes = static_cast<socklen_t>(filters.size() * sizeof(can_filter));
  if (::setsockopt(socket, SOL_CAN_RAW, CAN_RAW_FILTER, filters.data(), bytes) != 0) return errno;
  ifreq request = asking_for(interface);
  if (::ioctl(socket, SIOCGIFINDEX, &request) != 0) return errno;
  sockaddr_can address{};
  address.can_family = AF_CAN;
  address.can_ifindex = request.ifr_ifindex;
  const auto* as_any = reinterpret_cast<const sockaddr*>(&address);
  return ::bind(socket, as_any, sizeof(address)) == 0 ? 0 : errno;
}

int open_raw(const std::string& interface, const SocketCanOptions& options) {
  if (interface.empty() || interface.size() >= IFNAMSIZ) refuse(interface, EINVAL);
  if (options.filters.size() > CAN_RAW_FILTER_MAX) {
    throw std::system_error(EINVAL, std::generic_category(),
                            "CAN interface '" + interface +
                                "': " + std::to_string(options.filters.size()) +
                                " filters: must be " + std::to_string(CAN_RAW_FILTER_MAX) +
                                " at most; give fewer, with a mask that lets several through");
  }
  Descriptor socket(::socket(PF_CAN, SOCK_RAW | SOCK_NONBLOCK | SOCK_CLOEXEC, CAN_RAW));
  if (socket.get() < 0) refuse(interface, errno);
  if (!set_options(socket.get(), options)) refuse(interface, errno);
  if (const int error = look_up(socket.get(), interface); error != 0) refuse(interface, error);
  if (const int error = bind_raw(socket.get(), interface, to_wire(options.filters)); error != 0) {
    refuse(interface, error == ENODEV ? EMEDIUMTYPE : error);  // it is there, as `look_up` saw
  }
  return socket.let_go();
}

}  // namespace ebac::can
