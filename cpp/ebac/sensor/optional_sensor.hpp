#pragma once

#include <array>
#include <optional>
#include <string_view>
#include <utility>

#include "ebac/sensor/rdt_client.hpp"

namespace ebac::sensor {

/// A force sensor on the network, or none: then the device's own force, if it has one, stands.
class OptionalSensor {
 public:
  using State = RdtClient::State;
  static constexpr std::string_view kPrefix = RdtClient::kPrefix;

  OptionalSensor() = default;
  explicit OptionalSensor(RdtClient client) : client_(std::move(client)) {}

  bool poll(double elapsed) EBAC_RT { return !client_ || client_->poll(elapsed); }
  void fill(Reading& reading) const EBAC_RT {
    if (client_) client_->fill(reading);
  }
  SensorStatus health() const EBAC_RT { return client_ ? client_->health() : SensorStatus::kGood; }
  const State& state(std::size_t axis) const EBAC_RT {
    return client_ ? client_->state(axis) : none_[axis];
  }

  RdtClient* client() EBAC_RT { return client_ ? &*client_ : nullptr; }

 private:
  std::optional<RdtClient> client_;
  std::array<State, kMaxAxes> none_{};
};

}  // namespace ebac::sensor
