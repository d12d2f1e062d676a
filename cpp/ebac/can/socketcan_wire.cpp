#include "ebac/can/socketcan_wire.hpp"

#include <linux/can/error.h>

#include <algorithm>

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

}  // namespace ebac::can
