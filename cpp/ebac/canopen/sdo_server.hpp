#pragma once

#include <algorithm>
#include <array>
#include <concepts>
#include <span>

#include "ebac/can/frame.hpp"
#include "ebac/canopen/crc16.hpp"
#include "ebac/canopen/sdo_abort.hpp"

namespace ebac::can {

/// Object access of an SDO server. `prepare_download` refuses an impossible write before the first
/// byte; `size` is the number of bytes announced, or -1.
template <class O>
concept SdoObjects =
    requires(O objects, std::uint16_t index, std::uint8_t sub, std::span<const std::uint8_t> in,
             std::span<std::uint8_t> out, std::size_t& size, std::int64_t announced) {
      { objects.prepare_download(index, sub, announced) } noexcept -> std::same_as<Abort>;
      { objects.download(index, sub, in) } noexcept -> std::same_as<Abort>;
      { objects.upload(index, sub, out, size) } noexcept -> std::same_as<Abort>;
      { objects.size_of(index, sub) } noexcept -> std::same_as<std::size_t>;
    };

/// One SDO server channel (CiA 301, 7.2.4): expedited, segmented and in blocks, both ways.
class SdoServer {
 public:
  /// Answers the eight bytes of a request; false where the protocol requires no answer.
  template <SdoObjects O>
  bool answer(std::span<const std::uint8_t> request, O& objects, Frame& reply) EBAC_RT {
    if (request.size() != Frame::kMaxSize) return false;
    reply.size = Frame::kMaxSize;
    reply.data = {};
    if (running_ == Running::kBlockIn && request[0] != 0x80) return block_segment(request, reply);
    switch (request[0] >> 5U) {
      case 0:
        return download_segment(request, objects, reply);
      case 1:
        return start_download(request, objects, reply);
      case 2:
        return start_upload(request, objects, reply);
      case 3:
        return upload_segment(request, reply);
      case 4:  // the client gives up
        running_ = Running::kNothing;
        return false;
      case 5:
        return block_upload(request, objects, reply);
      case 6:
        return block_download(request, objects, reply);
      default:
        set_object(request);
        return abort(reply, Abort::kCommand);
    }
  }

  /// The next segment of a block on its way to the client; false where none is.
  bool segment(Frame& reply) EBAC_RT {
    if (running_ != Running::kBlockOut || sequence_ >= block_ || sent_ >= size_) return false;
    reply.size = Frame::kMaxSize;
    reply.data = {};
    const std::size_t count = std::min<std::size_t>(7, size_ - sent_);
    std::copy_n(buffer_.begin() + static_cast<std::ptrdiff_t>(sent_), count,
                reply.data.begin() + 1);
    sent_ += count;
    ++sequence_;
    reply.data[0] = static_cast<std::uint8_t>(sequence_ | (sent_ == size_ ? 0x80U : 0U));
    return true;
  }

  void reset() EBAC_RT { running_ = Running::kNothing; }

 private:
  enum class Running : std::uint8_t {
    kNothing,
    kDownload,
    kUpload,
    kBlockStart,  // a block upload that waits for the client's start
    kBlockOut,
    kBlockEnd,
    kBlockIn,
    kBlockDone,  // the last segment is in; its length and checksum are not
  };
  static constexpr std::size_t kRoom = 64;

  void set_object(std::span<const std::uint8_t> request) EBAC_RT {
    running_ = Running::kNothing;  // a new transfer ends a half-finished one
    index_ = get<std::uint16_t>(request, 1);
    sub_ = request[3];
  }
  void name_object(Frame& reply, std::uint8_t command) const EBAC_RT {
    reply.data[0] = command;
    put<std::uint16_t>(reply.data, 1, index_);
    reply.data[3] = sub_;
  }
  bool abort(Frame& reply, Abort why) EBAC_RT {
    running_ = Running::kNothing;
    reply.data = {};
    name_object(reply, 0x80);
    put<std::uint32_t>(reply.data, 4, static_cast<std::uint32_t>(why));
    return true;
  }

  template <SdoObjects O>
  bool start_download(std::span<const std::uint8_t> request, O& objects, Frame& reply) EBAC_RT {
    set_object(request);
    const bool expedited = (request[0] & 0x02U) != 0;
    const bool sized = (request[0] & 0x01U) != 0;
    if (!expedited) {
      announced_ = sized ? std::int64_t{get<std::uint32_t>(request, 4)} : -1;
      const Abort why = objects.prepare_download(index_, sub_, announced_);
      if (why != Abort::kNone) return abort(reply, why);
      running_ = Running::kDownload;
      toggle_ = 0;
      size_ = 0;
    } else {
      const std::size_t size = sized ? 4U - (request[0] >> 2U & 3U)
                                     : std::min<std::size_t>(4, objects.size_of(index_, sub_));
      const Abort why = objects.download(index_, sub_, request.subspan(4, size));
      if (why != Abort::kNone) return abort(reply, why);
    }
    name_object(reply, 0x60);
    return true;
  }

  template <SdoObjects O>
  bool download_segment(std::span<const std::uint8_t> request, O& objects, Frame& reply) EBAC_RT {
    if (running_ != Running::kDownload) return abort(reply, Abort::kCommand);
    if ((request[0] & 0x10U) != toggle_) return abort(reply, Abort::kToggle);
    const std::size_t count = 7U - (request[0] >> 1U & 7U);
    const std::size_t most = announced_ < 0 ? kRoom : static_cast<std::size_t>(announced_);
    if (size_ + count > std::min(most, kRoom)) return abort(reply, Abort::kTooLong);
    std::copy_n(request.begin() + 1, count, buffer_.begin() + static_cast<std::ptrdiff_t>(size_));
    size_ += count;
    if ((request[0] & 0x01U) != 0) {
      if (announced_ >= 0 && size_ < most) return abort(reply, Abort::kTooShort);
      const Abort why = objects.download(index_, sub_, std::span(buffer_).first(size_));
      if (why != Abort::kNone) return abort(reply, why);
      running_ = Running::kNothing;
    }
    reply.data[0] = static_cast<std::uint8_t>(0x20U | toggle_);
    toggle_ ^= 0x10U;
    return true;
  }

  template <SdoObjects O>
  bool start_upload(std::span<const std::uint8_t> request, O& objects, Frame& reply) EBAC_RT {
    set_object(request);
    const Abort why = objects.upload(index_, sub_, std::span(buffer_).first(kRoom), size_);
    if (why != Abort::kNone) return abort(reply, why);
    if (size_ >= 1 && size_ <= 4) {
      name_object(reply, static_cast<std::uint8_t>(0x43U | (4U - size_) << 2U));
      std::copy_n(buffer_.begin(), size_, reply.data.begin() + 4);
      return true;
    }
    running_ = Running::kUpload;
    toggle_ = 0;
    sent_ = 0;
    name_object(reply, 0x41);
    put<std::uint32_t>(reply.data, 4, static_cast<std::uint32_t>(size_));
    return true;
  }

  bool upload_segment(std::span<const std::uint8_t> request, Frame& reply) EBAC_RT {
    if (running_ != Running::kUpload) return abort(reply, Abort::kCommand);
    if ((request[0] & 0x10U) != toggle_) return abort(reply, Abort::kToggle);
    const std::size_t count = std::min<std::size_t>(7, size_ - sent_);
    std::copy_n(buffer_.begin() + static_cast<std::ptrdiff_t>(sent_), count,
                reply.data.begin() + 1);
    sent_ += count;
    const bool last = sent_ == size_;
    reply.data[0] = static_cast<std::uint8_t>(toggle_ | (7U - count) << 1U | (last ? 1U : 0U));
    toggle_ ^= 0x10U;
    if (last) running_ = Running::kNothing;
    return true;
  }

  template <SdoObjects O>
  bool block_upload(std::span<const std::uint8_t> request, O& objects, Frame& reply) EBAC_RT {
    switch (request[0] & 0x03U) {
      case 0: {  // initiate
        set_object(request);
        if (request[4] == 0 || request[4] > kMostSegments) return abort(reply, Abort::kBlockSize);
        const Abort why = objects.upload(index_, sub_, std::span(buffer_).first(kRoom), size_);
        if (why != Abort::kNone) return abort(reply, why);
        block_ = request[4];
        checked_ = (request[0] & 0x04U) != 0;
        running_ = Running::kBlockStart;
        sent_ = 0;
        name_object(reply, 0xC6);
        put<std::uint32_t>(reply.data, 4, static_cast<std::uint32_t>(size_));
        return true;
      }
      case 3:  // start: the segments follow
        if (running_ != Running::kBlockStart) return abort(reply, Abort::kCommand);
        running_ = Running::kBlockOut;
        sequence_ = 0;
        first_ = 0;
        return size_ == 0 ? end_upload(reply) : false;
      case 2: {  // acknowledge
        if (running_ != Running::kBlockOut) return abort(reply, Abort::kCommand);
        if (request[1] > sequence_) return abort(reply, Abort::kSequence);
        if (request[2] == 0 || request[2] > kMostSegments) return abort(reply, Abort::kBlockSize);
        first_ = std::min(size_, first_ + std::size_t{7} * request[1]);
        if (first_ == size_) return end_upload(reply);
        sent_ = first_;
        sequence_ = 0;
        block_ = request[2];
        return false;
      }
      default:  // end
        if (running_ != Running::kBlockEnd) return abort(reply, Abort::kCommand);
        running_ = Running::kNothing;
        return false;
    }
  }
  bool end_upload(Frame& reply) EBAC_RT {
    running_ = Running::kBlockEnd;
    const std::size_t rest = size_ % 7;
    const std::size_t unused = size_ == 0 ? 7 : (rest == 0 ? 0 : 7 - rest);
    reply.data[0] = static_cast<std::uint8_t>(0xC1U | unused << 2U);
    if (checked_) put<std::uint16_t>(reply.data, 1, crc16(std::span(buffer_).first(size_)));
    return true;
  }

  template <SdoObjects O>
  bool block_download(std::span<const std::uint8_t> request, O& objects, Frame& reply) EBAC_RT {
    if ((request[0] & 0x01U) == 0) {  // initiate
      set_object(request);
      announced_ = (request[0] & 0x02U) != 0 ? std::int64_t{get<std::uint32_t>(request, 4)} : -1;
      const Abort why = objects.prepare_download(index_, sub_, announced_);
      if (why != Abort::kNone) return abort(reply, why);
      checked_ = (request[0] & 0x04U) != 0;
      running_ = Running::kBlockIn;
      size_ = 0;
      sequence_ = 0;
      name_object(reply, 0xA4);
      reply.data[4] = kBlock;
      return true;
    }
    if (running_ != Running::kBlockDone) return abort(reply, Abort::kCommand);  // end
    const std::size_t unused = request[0] >> 2U & 7U;
    if (unused > size_) return abort(reply, Abort::kTooShort);
    size_ -= unused;
    if (size_ > kRoom) return abort(reply, Abort::kTooLong);
    const auto bytes = std::span(buffer_).first(size_);
    if (checked_ && get<std::uint16_t>(request, 1) != crc16(bytes)) {
      return abort(reply, Abort::kChecksum);
    }
    if (announced_ >= 0 && static_cast<std::size_t>(announced_) != size_) {
      return abort(reply, Abort::kLength);
    }
    const Abort why = objects.download(index_, sub_, bytes);
    if (why != Abort::kNone) return abort(reply, why);
    running_ = Running::kNothing;
    reply.data[0] = 0xA1;
    return true;
  }
  /// One segment of a block; the last of a block is acknowledged with the last one in order.
  bool block_segment(std::span<const std::uint8_t> request, Frame& reply) EBAC_RT {
    const std::uint8_t number = request[0] & 0x7FU;
    const bool last = (request[0] & 0x80U) != 0;
    if (number == 0) return abort(reply, Abort::kSequence);
    const bool next = number == sequence_ + 1;
    if (next) {
      if (size_ + 7 > buffer_.size()) return abort(reply, Abort::kTooLong);
      std::copy_n(request.begin() + 1, 7, buffer_.begin() + static_cast<std::ptrdiff_t>(size_));
      size_ += 7;
      sequence_ = number;
    }
    if (!last && number < kBlock) return false;
    if (next && last) running_ = Running::kBlockDone;
    reply.data[0] = 0xA2;
    reply.data[1] = sequence_;
    reply.data[2] = kBlock;
    sequence_ = 0;
    return true;
  }

  static constexpr std::uint8_t kMostSegments = 127;
  static constexpr std::uint8_t kBlock = 16;  // segments of a block it takes

  Running running_ = Running::kNothing;
  bool checked_ = false;       // by a checksum
  std::uint8_t block_ = 0;     // segments the client takes at once
  std::uint8_t sequence_ = 0;  // of the last segment, in its block
  std::size_t first_ = 0;      // bytes the client has acknowledged
  std::uint8_t sub_ = 0;
  std::uint16_t index_ = 0;
  std::uint8_t toggle_ = 0;      // 0 or 0x10
  std::int64_t announced_ = -1;  // bytes, -1 unknown
  std::size_t size_ = 0;         // bytes in the buffer
  std::size_t sent_ = 0;         // of them
  std::array<std::uint8_t, kRoom + 7> buffer_{};
};

}  // namespace ebac::can
