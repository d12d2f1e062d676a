#pragma once

#include <array>
#include <atomic>
#include <concepts>
#include <cstdint>
#include <span>
#include <type_traits>
#include <utility>

#include "ebac/core/realtime.hpp"
#include "ebac/core/sample.hpp"
#include "ebac/loop/applied_updates.hpp"
#include "ebac/loop/mailbox.hpp"
#include "ebac/model/environment.hpp"
#include "ebac/model/of_all.hpp"

namespace ebac {

/// The scalar law inside a law for all axes, if it has one: the type that can be sent to a running loop.
template <class Law>
struct ScalarOf {
  struct Type {};  // nothing to send
};
template <class Law>
  requires requires(Law law, const Law::Scalar& scalar) { law.retune(scalar); }
struct ScalarOf<Law> {
  using Type = Law::Scalar;
};

/// What is sent of a law: one that can be exchanged for another is sent whole.
template <class Law>
struct SentOf {
  using Type = ScalarOf<Law>::Type;
};
template <class Law>
  requires requires { typename Law::Replacement; }
struct SentOf<Law> {
  using Type = Law::Replacement;
};

/// Ticks for which the commands of a loop are held back, on top of what its bus takes.
struct CommandDelay {
  std::size_t ticks = 0;
};

/// Target position of a simulated hand, per axis.
struct HandTarget {
  std::array<double, kMaxAxes> target{};  // m
};

/// Parameter updates for a running loop, from one writer; neither side waits. Values are checked
/// before they are posted; the loop applies them at the start of a tick and records that it did.
template <class Law>
class ParameterUpdates {
 public:
  using Scalar = ScalarOf<Law>::Type;
  using Sent = SentOf<Law>::Type;

  /// `law` only fills the memory; it is not sent.
  explicit ParameterUpdates(const Scalar& law) : law_({0, sent(law)}) {}

  /// Sends new gains of the law (its memory stays) or another law, a new environment, a new hand target or delay.
  /// Returns the serial number of the update. Where a copy takes memory, that of a law of any type, it throws std::bad_alloc
  /// without any, and the loop goes on as before.
  std::uint64_t post(const Scalar& law) { return send(law_, sent(law)); }
  std::uint64_t post(const Environment& world) { return send(world_, world); }
  std::uint64_t post(const HandTarget& aim) EBAC_RT { return send(aim_, aim); }
  std::uint64_t post(const CommandDelay& delay) EBAC_RT { return send(delay_, delay); }
  /// `at_once`: without the ramp of the force.
  void stop(bool at_once = false) EBAC_RT {
    if (at_once) at_once_.store(true, std::memory_order_release);
    stop_.store(true, std::memory_order_release);
  }

  bool at_once() const EBAC_RT { return at_once_.load(std::memory_order_acquire); }
  bool stop_asked() const EBAC_RT { return stop_.load(std::memory_order_acquire); }
  AppliedUpdates& applied() EBAC_RT { return applied_; }
  const AppliedUpdates& applied() const EBAC_RT { return applied_; }

  /// Called by the loop: passes every new value to `law`, `chain` or `device`; `axes` and `t` are those of the last
  /// tick.
  template <class AnyLaw, class Chain, class Device>
  void apply(std::int64_t tick, AnyLaw& law, Chain& chain, Device& device, std::span<Axis> axes,
             double t) EBAC_RT {
    if constexpr (requires(Sent& s) { law.adopt(s); }) {
      if (auto* message = law_.take()) {
        law.adopt(message->value);
        chain.act(law.observed());
        applied_.add({tick, message->serial, UpdateOf::kLaw});
      }
    } else if constexpr (requires(const Scalar& s) { law.retune(s); }) {
      if (const auto* message = law_.take()) {
        law.retune(message->value);
        applied_.add({tick, message->serial, UpdateOf::kLaw});
      }
    }
    if (const auto* message = world_.take()) {
      const Axes before = of_all(axes, &Axis::port, &Port::f_env);
      chain.change(message->value);
      if constexpr (requires { law.meet_another(before, before); })
        law.meet_another(before, chain.contact(t, axes).force);
      applied_.add({tick, message->serial, UpdateOf::kEnvironment});
    }
    if constexpr (requires { device.aim(std::size_t{}, 0.0); }) {
      if (const auto* message = aim_.take()) {
        for (std::size_t i = 0; i < kMaxAxes; ++i) device.aim(i, message->value.target[i]);
        applied_.add({tick, message->serial, UpdateOf::kTarget});
      }
    }
    if constexpr (requires { device.hold_back(std::size_t{}); }) {
      if (const auto* message = delay_.take()) {
        device.hold_back(message->value.ticks);
        applied_.add({tick, message->serial, UpdateOf::kDelay});
      }
    }
  }

 private:
  template <class T>
  struct Message {
    std::uint64_t serial;
    T value;
  };
  template <class T>
  std::uint64_t send(Mailbox<Message<T>>& box, T value) EBAC_RT {
    box.post({++serial_, std::move(value)});
    return serial_;
  }

  static Sent sent(const Scalar& law) {
    if constexpr (std::same_as<Sent, Scalar>) {
      return law;
    } else {
      return Law::replacement(law);
    }
  }

  Mailbox<Message<Sent>> law_;
  Mailbox<Message<Environment>> world_{{0, Free{}}};
  Mailbox<Message<HandTarget>> aim_{{0, HandTarget{}}};
  Mailbox<Message<CommandDelay>> delay_{{0, CommandDelay{}}};
  std::uint64_t serial_ = 0;  // the writer's
  AppliedUpdates applied_;
  std::atomic<bool> stop_{false};
  std::atomic<bool> at_once_{false};
};

}  // namespace ebac
