#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "ebac/core/realtime.hpp"

/// What travels between master and slave, and a line that delays it. Another channel takes the
/// place of the line: it carries a `Command` one way and an `Answer` back.
namespace ebac::gastroscope {

/// Where the slave's four axes shall be.
struct Command {
  double insertion = 0;  // m
  double rotation = 0;   // rad
  double bend_x = 0;     // rad
  double bend_y = 0;     // rad
};

/// What the slave meets, along its axes; positive resists a larger value of the axis.
struct Answer {
  double push = 0;      // N, against insertion
  double torque_x = 0;  // N m
  double torque_y = 0;  // N m
};

/// What is put in comes out after as many ticks; before that, what it was made with.
template <class T>
class DelayLine {
 public:
  DelayLine(std::size_t ticks, const T& first) : kept_(ticks, first) {}

  T pass(const T& in) EBAC_RT {
    if (kept_.empty()) return in;
    const T out = kept_[at_];
    kept_[at_] = in;
    if (++at_ == kept_.size()) at_ = 0;
    return out;
  }

 private:
  std::vector<T> kept_;
  std::size_t at_ = 0;
};

}  // namespace ebac::gastroscope
