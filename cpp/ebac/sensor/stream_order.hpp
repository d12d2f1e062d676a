#pragma once

#include <cstdint>

#include "ebac/core/realtime.hpp"

namespace ebac::sensor {

/// Arrival of a numbered packet relative to its stream.
enum class Arrival : std::uint8_t {
  kNewest,     // newer than all before it
  kLate,       // older than another that came before it, and not seen yet
  kDuplicate,  // seen already
  kStray,      // far from the stream: not believed until the next number follows it
};

/// How many numbers of a stream did not come, came late or came twice. A packet that is late is not
/// lost: it leaves the count again. Numbers are 32 bits wide and wrap.
class StreamOrder {
 public:
  /// Distance behind the newest number within which duplicates are recognised.
  static constexpr std::uint32_t kWindow = 64;
  /// A longer leap ahead is not a loss but another stream.
  static constexpr std::uint32_t kLeap = 1U << 20U;

  /// `sample` is the sensor's own sample number, which continues from stream to stream.
  Arrival take(std::uint32_t number, std::uint32_t sample = 0) EBAC_RT {
    const Arrival arrival = judge(number, sample);
    if (arrival == Arrival::kNewest) sample_ = sample;
    return arrival;
  }

  /// To be called when another stream is requested: the next packet begins it, whatever its number.
  /// That packet may still belong to the stream before, so one leap to any number is accepted.
  void restart() EBAC_RT {
    begun_ = strayed_ = false;
    leaps_ = true;
  }

  std::int64_t lost() const EBAC_RT { return lost_; }
  std::int64_t late() const EBAC_RT { return late_; }
  std::int64_t duplicate() const EBAC_RT { return duplicate_; }
  std::int64_t stray() const EBAC_RT { return stray_count_; }
  std::int64_t restarts() const EBAC_RT { return restarts_; }

 private:
  Arrival judge(std::uint32_t number, std::uint32_t sample) EBAC_RT {
    if (!begun_) return begin(number);
    const std::uint32_t ahead = number - newest_;
    if (ahead == 0) return again();
    if (ahead <= kLeap) return advance(number, ahead);
    const std::uint32_t behind = newest_ - number;
    if (behind >= kWindow) return stray(number);
    const bool later = sample - sample_ - 1 < kLeap;  // taken after the newest, yet numbered before
    if (!leaps_ || !later) return look_back(behind);
    leaps_ = false;
    return begin(number);
  }
  Arrival begin(std::uint32_t number) EBAC_RT {
    begun_ = true;
    strayed_ = false;
    newest_ = number;
    age_ = 0;
    seen_ = 1;
    return Arrival::kNewest;
  }
  Arrival again() EBAC_RT {
    ++duplicate_;
    return Arrival::kDuplicate;
  }
  Arrival advance(std::uint32_t number, std::uint32_t ahead) EBAC_RT {
    seen_ = ahead < kWindow ? seen_ << ahead | 1U : 1U;
    newest_ = number;
    age_ += ahead;
    lost_ += ahead - 1;
    strayed_ = false;
    if (age_ >= kWindow) leaps_ = false;
    return Arrival::kNewest;
  }
  Arrival look_back(std::uint32_t behind) EBAC_RT {
    const std::uint64_t bit = std::uint64_t{1} << behind;
    if ((seen_ & bit) != 0) return again();
    seen_ |= bit;
    ++late_;
    if (behind <= age_)
      --lost_;  // packets before the first of the stream were never counted as lost
    return Arrival::kLate;
  }
  Arrival stray(std::uint32_t number) EBAC_RT {
    if (leaps_) {
      leaps_ = false;
      return begin(number);
    }
    if (strayed_ && number == stray_ + 1) {
      ++restarts_;
      return begin(number);
    }
    strayed_ = true;
    stray_ = number;
    ++stray_count_;
    return Arrival::kStray;
  }

  bool begun_ = false;
  bool strayed_ = false;
  bool leaps_ = false;  // a stream was requested, and the old one may not have ended yet
  std::uint32_t newest_ = 0;
  std::uint32_t sample_ = 0;  // of the newest
  std::uint32_t stray_ = 0;
  std::uint64_t age_ = 0;   // numbers from the first of the stream to the newest
  std::uint64_t seen_ = 0;  // bit i: the number i before the newest came
  std::int64_t lost_ = 0;
  std::int64_t late_ = 0;
  std::int64_t duplicate_ = 0;
  std::int64_t stray_count_ = 0;
  std::int64_t restarts_ = 0;
};

}  // namespace ebac::sensor
