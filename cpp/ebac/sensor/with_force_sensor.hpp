#pragma once

#include <tuple>
#include <utility>

#include "ebac/loop/device_around.hpp"

namespace ebac::sensor {

/// A force sensor that can be polled within a tick.
template <class S>
concept PolledSensor = requires(S sensor, const S& view, double elapsed, Reading& reading) {
  { sensor.poll(elapsed) } noexcept -> std::same_as<bool>;
  { view.fill(reading) } noexcept;
  { view.health() } noexcept -> std::same_as<SensorStatus>;
};

/// A device whose force comes from a separate sensor. Enabling it requests the stream of the sensor,
/// again if there was one.
///
/// While it is being enabled, no force is commanded, and the sensor may take `patience` seconds to
/// send a valid record: only then does the device run. Afterwards the limits judge each record.
template <Device D, PolledSensor S>
class WithForceSensor : public DeviceAround<D> {
  using DeviceAround<D>::device_;

 public:
  explicit WithForceSensor(D device, S sensor, double patience = 0.5)
      : DeviceAround<D>(std::move(device)), sensor_(std::move(sensor)), patience_(patience) {}

  Reading exchange(const Command& command) EBAC_RT {
    Reading reading = device_.exchange(command);
    const bool newer = sensor_.poll(command.elapsed);
    sensor_.fill(reading);
    if (awaited_) {
      waited_ += command.elapsed;
      awaited_ = waited_ < patience_ && !(newer && sensor_.health() == SensorStatus::kGood);
      if (awaited_) reading.force_age = 0;
      if (awaited_) reading.force_status = SensorStatus::kGood;
    }
    return reading;
  }

  void enable() EBAC_RT
    requires requires(D& d) { d.enable(); }
  {
    static_assert(noexcept(device_.enable()));
    device_.enable();
    if constexpr (requires { sensor_.start(); }) sensor_.start();
    awaited_ = true;
    waited_ = 0;
  }
  bool running() const EBAC_RT
    requires requires(const D& d) { d.running(); }
  {
    return device_.running() && !awaited_;
  }

  auto parts() const EBAC_RT { return std::tuple_cat(row_parts(device_), std::tie(sensor_)); }

  S& sensor() EBAC_RT { return sensor_; }
  const S& sensor() const EBAC_RT { return sensor_; }

 private:
  S sensor_;
  double patience_;       // s
  double waited_ = 0;     // s
  bool awaited_ = false;  // a first good record
};

}  // namespace ebac::sensor
