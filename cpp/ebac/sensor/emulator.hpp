#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>

#include "ebac/model/noise.hpp"
#include "ebac/sensor/emulator_options.hpp"
#include "ebac/sensor/mounting.hpp"
#include "ebac/sensor/rdt.hpp"
#include "ebac/sensor/status.hpp"

namespace ebac::sensor {

/// A sensor that speaks the protocol of the Net F/T, and can be made to do so badly. It knows no
/// socket and no time: `To` is whatever names a client.
template <class To>
class RdtEmulator {
 public:
  static constexpr std::size_t kMostBytes = 40 * RdtRecord::kBytes;

  explicit RdtEmulator(const EmulatorOptions& options = {}, const Mounting& mounting = {},
                       StatusBits bits = StatusBits::of(SensorModel::kNetFt),
                       std::uint64_t seed = 1)
      : options_(checked(options, "EmulatorOptions")),
        mounting_(mounting),
        bits_(bits),
        random_(seed, /*stream=*/3) {
    check_mounting(mounting);
    feel({});
  }

  /// Sets the errors to emulate; `trouble` lies in its ranges.
  void set(const EmulatorTrouble& trouble) EBAC_RT { trouble_ = trouble; }

  /// The hand's force on the handle from now on, in the handle's axes [N].
  void feel(const std::array<double, kMaxAxes>& at_handle) EBAC_RT {
    const Axes f = mounting_.to_sensor({at_handle[0], at_handle[1], at_handle[2]});
    const double l = options_.lever;  // torque: (0, 0, l) x f
    load_ = {f[0], f[1], f[2] + options_.load, -l * f[1], l * f[0], 0};
  }

  /// One packet from a client.
  void hear(std::span<const std::uint8_t> bytes, const To& from) EBAC_RT {
    RdtRequest request;
    if (!decode(bytes, request) || !obey(request, from)) {
      ++counts_.refused;
    } else {
      ++counts_.requests;
    }
  }

  /// Takes one sample and passes outgoing packets to `send(bytes, to)`.
  template <class Send>
  void sample(Send&& send) EBAC_RT {
    ++ft_sequence_;
    if (!streaming_) return;
    if (fill_ == 0) size_ = 0;
    const auto bytes = encode(record());
    std::ranges::copy(bytes, packet_.begin() + static_cast<std::ptrdiff_t>(size_));
    size_ += bytes.size();
    if (samples_ > 0) {
      --samples_;
      if (samples_ == 0) streaming_ = false;
    }
    if (++fill_ < records_ && streaming_) return;
    fill_ = 0;
    leave(send);
  }

  const EmulatorCounts& counts() const EBAC_RT { return counts_; }
  const EmulatorOptions& options() const EBAC_RT { return options_; }

 private:
  bool obey(const RdtRequest& request, const To& from) EBAC_RT {
    switch (static_cast<RdtCommand>(request.command)) {
      case RdtCommand::kStop:
        streaming_ = false;
        return true;
      case RdtCommand::kStart:
        return begin(request, from, 1);
      case RdtCommand::kStartBuffered:
        return begin(request, from, options_.buffer);
      case RdtCommand::kBias:
        for (std::size_t i = 0; i < load_.size(); ++i) {
          if (std::isfinite(load_[i])) zero_[i] = load_[i];
        }
        return true;
    }
    return false;
  }
  bool begin(const RdtRequest& request, const To& from, int records) EBAC_RT {
    client_ = from;
    streaming_ = true;
    held_ = false;
    rdt_sequence_ = 0;
    fill_ = 0;
    records_ = records;
    samples_ = request.samples;
    return true;
  }

  RdtRecord record() EBAC_RT {
    RdtRecord out{.rdt_sequence = ++rdt_sequence_,
                  .ft_sequence = ft_sequence_,
                  .status = static_cast<std::uint32_t>(trouble_.status)};
    bool saturated = false;
    for (std::size_t i = 0; i < 3; ++i) {
      out.force[i] = counts(i, options_.force_range, options_.counts_per_force, saturated);
      out.torque[i] = counts(3 + i, options_.torque_range, options_.counts_per_torque, saturated);
    }
    if (saturated) out.status |= bits_.saturated | StatusBits::kAnyError;
    return out;
  }
  /// The end of the range is that of the sensor, wherever zero was put.
  std::int32_t counts(std::size_t i, double range, double scale, bool& saturated) const EBAC_RT {
    constexpr double kEnd = 2147483647;
    const double held = std::isfinite(load_[i]) ? std::clamp(load_[i], -range, range) : range;
    saturated = saturated || std::abs(held) >= range;
    return static_cast<std::int32_t>(
        std::clamp(std::round((held - zero_[i]) * scale), -kEnd, kEnd));
  }

  bool chance(double share) EBAC_RT { return share > 0 && 0.5 * (random_.symmetric() + 1) < share; }

  template <class Send>
  void leave(Send& send) EBAC_RT {
    const std::span<const std::uint8_t> now(packet_.data(), size_);
    if (trouble_.silent || chance(trouble_.loss)) {
      ++counts_.dropped;
      return;
    }
    if (!held_ && streaming_ && chance(trouble_.reorder)) {
      ++counts_.swapped;
      later_ = packet_;
      later_size_ = size_;
      held_ = true;
      return;
    }
    const bool twice = chance(trouble_.duplicate);
    if (twice) ++counts_.doubled;
    for (int i = 0; i < (twice ? 2 : 1); ++i) give(send, now);
    if (std::exchange(held_, false)) give(send, {later_.data(), later_size_});
  }
  template <class Send>
  void give(Send& send, std::span<const std::uint8_t> bytes) EBAC_RT {
    ++counts_.sent;
    send(bytes, client_);
  }

  EmulatorOptions options_;
  Mounting mounting_;
  StatusBits bits_;
  Noise random_;
  EmulatorTrouble trouble_{};
  EmulatorCounts counts_{};
  std::array<double, 6> load_{};  // N, N m, in the sensor's axes
  std::array<double, 6> zero_{};  // N, N m
  bool streaming_ = false;
  To client_{};
  std::uint32_t rdt_sequence_ = 0;
  std::uint32_t ft_sequence_ = 0;
  std::uint32_t samples_ = 0;  // still to be sent; 0 for no end
  int records_ = 1;            // in a packet
  int fill_ = 0;
  std::size_t size_ = 0;
  std::array<std::uint8_t, kMostBytes> packet_{};
  bool held_ = false;  // a packet waits for the next one to leave first
  std::size_t later_size_ = 0;
  std::array<std::uint8_t, kMostBytes> later_{};
};

}  // namespace ebac::sensor
