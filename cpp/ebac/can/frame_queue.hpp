#pragma once

#include <array>
#include <cstdint>

#include "ebac/can/frame.hpp"

namespace ebac::can {

/// Frames on their way out, first in first out. A full queue refuses and counts.
template <std::size_t N>
class FrameQueue {
 public:
  bool push(const Frame& frame) EBAC_RT {
    if (size_ == N) {
      ++refused_;
      return false;
    }
    frames_[(head_ + size_++) % N] = frame;
    return true;
  }
  bool pop(Frame& frame) EBAC_RT {
    if (size_ == 0) return false;
    frame = frames_[head_];
    head_ = (head_ + 1) % N;
    --size_;
    return true;
  }
  /// The next frame; nullptr where none is.
  const Frame* front() const EBAC_RT { return size_ == 0 ? nullptr : &frames_[head_]; }
  void clear() EBAC_RT { size_ = 0; }
  std::uint64_t refused() const EBAC_RT { return refused_; }

 private:
  std::array<Frame, N> frames_{};
  std::size_t head_ = 0;
  std::size_t size_ = 0;
  std::uint64_t refused_ = 0;
};

}  // namespace ebac::can
