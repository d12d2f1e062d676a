#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "ebac/control/any_law.hpp"
#include "ebac/loop/tick.hpp"
#include "ebac/sim/simulated_device.hpp"
#include "ebac/teleop/coupling.hpp"
#include "ebac/teleop/packet.hpp"
#include "ebac/teleop/session.hpp"

namespace ebac::teleop {

/// The master: a simulated device of one axis with its hand, the usual chain of a tick, and a law. The force the
/// law is asked for is that of the network. Its energy is counted with the force that was asked for when the
/// command of the last interval was computed; what the law or the passivity controller adds, and what the device's own damping takes at
/// least, is `dissipated`.
class MasterSide {
 public:
  MasterSide(const Setup& setup, const AnyLaw& law, const Coupling& coupling, std::uint32_t run = 0)
      : coupling_(checked_coupling(coupling, setup.timing.dt)),
        dt_(setup.timing.dt),
        lag_(static_cast<std::uint32_t>(setup.timing.delay) + 1),
        device_(setup),
        chain_(setup.device, Free{}, law.timing(), observing(setup)),
        law_(law),
        session_(Role::kMaster, coupling, dt_, run) {
    sample_.axes = 1;
    law_.reset();
  }

  void take(const Packet& packet) EBAC_RT {
    if (session_.judge(packet) == Heed::kTaken) session_.take(packet);
  }

  /// The hand agrees to go on after the link was lost: a new session. What earlier ones spent of the reserve stays
  /// spent, in the law too.
  bool consent() EBAC_RT {
    if (!session_.consent()) return false;
    port_.begin(waves() ? wave_left() : port_.left());
    wave_sum_ = used_wave_ = used_energy_ = smooth_ = last_ = 0;
    return true;
  }

  Packet step(std::int64_t stamp) EBAC_RT {
    const auto axes = only_axis(sample_);
    const Instant now{.t = static_cast<double>(tick_) * dt_, .dt = tick_ > 0 ? dt_ : 0.0};
    const Reading reading = sense(chain_, device_, now, sample_, axes);
    chain_.account(axes);
    chain_.show_own_force(axes);
    Port& port = axes[0].port;
    move(port);
    observe(port);
    session_.tick();
    if (watch().state() == LinkState::kRunning) begun_ = true;
    if (!begun_) origin_ = x_;
    const double net = watch().share() * asked(session_.play());
    net_[tick_ % net_.size()] = net;
    port.f_env = net + inject();
    port.f_cmd = law_.step(port);
    chain_.show_whole_force(axes);
    chain_.heed(law_.drained(), now.dt, axes);
    chain_.drive(now.dt, axes);
    if (sample_.fault == Fault::kNone) sample_.fault = judge(reading, axes);
    if (sample_.fault != Fault::kNone) {
      rest(axes);
      chain_.sent_with(0);
    }
    ++tick_;
    return {
        .from_slave = false,
        .lost = watch().lost() || sample_.fault != Fault::kNone,  // nobody follows a stick at rest
        .session = session_.number(),
        .sequence = session_.next(),
        .echo = receiver().newest(),
        .stamp = stamp,
        .value = x_ - origin_,
        .energy = waves() ? port_.in - port_.out + port_.dissipated + used_energy_ : port_.in,
        .wave = wave_sum_,
        .run = session_.run(),
        .scheme = static_cast<std::uint8_t>(coupling_.scheme)};
  }

  /// Another place for the hand [m].
  void aim(double target) EBAC_RT { device_.aim(0, target); }

  const Sample& sample() const EBAC_RT { return sample_; }
  const Port& device_port() const EBAC_RT { return sample_.axis[0].port; }
  const AxisTruth& truth() const EBAC_RT { return device_.state(0); }
  const PortEnergy& port() const EBAC_RT { return port_; }
  const LinkWatch& watch() const EBAC_RT { return session_.watch(); }
  const Receiver& receiver() const EBAC_RT { return session_.receiver(); }
  std::uint32_t session() const EBAC_RT { return session_.number(); }
  std::int64_t other_scheme() const EBAC_RT { return session_.other_scheme(); }
  double asked_now() const EBAC_RT { return net_[(tick_ + net_.size() - 1) % net_.size()]; }

 private:
  bool waves() const EBAC_RT { return coupling_.scheme == static_cast<int>(Scheme::kWaves); }

  /// Whatever the law, the network is shown the observer's estimate, in which counts are no blows.
  static Observing observing(const Setup& setup) EBAC_RT {
    if (!setup.observer) return {};
    return {.on = true, .acts = true, .params = *setup.observer};
  }
  /// Where the handle is, and how fast it will be when the command of this tick acts.
  void move(const Port& port) EBAC_RT {
    const Estimate& est = port.est;
    const double x = port.x + est.weight * (est.x - port.x);
    dx_ = port.dt > 0 ? x - x_ : 0.0;
    x_ = x;
    v_ = port.v + est.weight * (est.v_act - port.v);
  }

  /// What the wave that comes in may still carry, before the reserve [J].
  double wave_left() const EBAC_RT { return port_.allowed - port_.debt - used_energy_; }

  /// The energy of the interval that ended now, and the wave that went out over it.
  void observe(const Port& port) EBAC_RT {
    if (!(port.dt > 0)) return;
    const double net = tick_ >= lag_ ? net_[(tick_ - lag_) % net_.size()] : 0.0;
    port_.add(net * dx_);
    port_.dissipated += (port.f_applied - net) * dx_ + port.damped - damped_;
    damped_ = port.damped;
    const double b = coupling_.impedance;
    wave_sum_ += (b * dx_ + net * port.dt) / std::sqrt(2 * b);
  }

  /// The force that comes through the network, before anything holds it back.
  double asked(const Packet& in) EBAC_RT {
    port_.allowed = std::max(port_.allowed, in.energy);
    if (!waves()) return in.value;
    const double b = coupling_.impedance;
    const double most = std::sqrt(2 * std::max(0.0, wave_left() + coupling_.reserve) / dt_);
    smooth_ += (in.wave - last_ - smooth_ * dt_) / kSmooth;
    last_ = in.wave;
    const double wanted = coupling_.follow ? (in.wave - used_wave_) / kSmooth : smooth_;
    const double w = std::clamp(wanted, -most, most);
    used_wave_ += w * dt_;
    used_energy_ += 0.5 * w * w * dt_;
    return b * v_ - std::sqrt(2 * b) * w;
  }

  /// The passivity controller: a damper that takes what is missing in the account within a tick.
  double inject() EBAC_RT {
    if (coupling_.scheme != static_cast<int>(Scheme::kPassivity) || v_ == 0) return 0;
    const double missing = -(port_.left() + coupling_.reserve);
    if (!(missing > 0)) return 0;
    return std::min(coupling_.injection, missing / (v_ * v_ * dt_)) * v_;
  }

  Coupling coupling_;
  double dt_;          // s
  std::uint32_t lag_;  // ticks from a command to the row that shows its force
  SimulatedDevice device_;
  SignalChain chain_;
  AnyLaw law_;
  Session session_;
  Sample sample_{};
  PortEnergy port_{};
  std::array<double, 16> net_{};  // N
  std::uint32_t tick_ = 0;
  bool begun_ = false;
  double origin_ = 0;       // m
  double x_ = 0;            // m, the handle
  double dx_ = 0;           // m, since the last tick
  double v_ = 0;            // m/s, when the command of this tick acts
  double damped_ = 0;       // J
  double wave_sum_ = 0;     // sqrt(W) s
  double used_wave_ = 0;    // sqrt(W) s
  double used_energy_ = 0;  // J
  double smooth_ = 0;       // sqrt(W)
  double last_ = 0;         // sqrt(W) s
};

}  // namespace ebac::teleop
