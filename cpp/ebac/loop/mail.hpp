#pragma once

#include <array>
#include <atomic>
#include <concepts>
#include <cstdint>
#include <type_traits>

#include "ebac/loop/changes.hpp"
#include "ebac/loop/mailbox.hpp"
#include "ebac/model/environment.hpp"

namespace ebac {

/// The scalar law inside a law for all axes, where there is one: what can be sent to a running loop.
template <class Law>
struct ScalarOf {
  struct Type {};  // nothing to send
};
template <class Law>
  requires requires(Law law, const typename Law::Scalar& scalar) { law.retune(scalar); } &&
           std::is_trivially_copyable_v<typename Law::Scalar>
struct ScalarOf<Law> {
  using Type = Law::Scalar;
};

/// Where a hand should go.
struct Aim {
  std::array<double, kMaxAxes> target{};  // m
};

/// What somebody outside may tell a running loop: one writer, nobody waits. Values are checked
/// before they are posted; the loop takes them at the start of a tick and notes that it did.
template <class Law>
class Mail {
 public:
  using Scalar = ScalarOf<Law>::Type;

  /// Needs a law to fill the places with; it is not sent.
  explicit Mail(const Scalar& law) : law_({0, law}) {}

  /// The law's gains from now on; its memory stays. Each returns the serial number of the value.
  std::uint64_t post(const Scalar& law) EBAC_RT { return send(law_, law); }
  std::uint64_t post(const Environment& world) EBAC_RT { return send(world_, world); }
  std::uint64_t post(const Aim& aim) EBAC_RT { return send(aim_, aim); }
  void stop() EBAC_RT { stop_.store(true, std::memory_order_release); }

  bool stop_asked() const EBAC_RT { return stop_.load(std::memory_order_acquire); }
  const Changes& changes() const EBAC_RT { return changes_; }

  /// The loop's side: hands every new value to `law`, `rig` or `device`.
  template <class AnyLaw, class Rig, class Device>
  void deliver(std::int64_t tick, AnyLaw& law, Rig& rig, Device& device) EBAC_RT {
    if constexpr (requires(const Scalar& s) { law.retune(s); }) {
      if (const auto* letter = law_.take()) {
        law.retune(letter->value);
        changes_.add({tick, letter->serial, ChangeOf::kLaw});
      }
    }
    if (const auto* letter = world_.take()) {
      rig.change(letter->value);
      changes_.add({tick, letter->serial, ChangeOf::kEnvironment});
    }
    if constexpr (requires { device.aim(std::size_t{}, 0.0); }) {
      if (const auto* letter = aim_.take()) {
        for (std::size_t i = 0; i < kMaxAxes; ++i) device.aim(i, letter->value.target[i]);
        changes_.add({tick, letter->serial, ChangeOf::kTarget});
      }
    }
  }

 private:
  template <class T>
  struct Letter {
    std::uint64_t serial;
    T value;
  };
  template <class T>
  std::uint64_t send(Mailbox<Letter<T>>& box, const T& value) EBAC_RT {
    box.post({++serial_, value});
    return serial_;
  }

  Mailbox<Letter<Scalar>> law_;
  Mailbox<Letter<Environment>> world_{{0, Free{}}};
  Mailbox<Letter<Aim>> aim_{{0, Aim{}}};
  std::uint64_t serial_ = 0;  // the writer's
  Changes changes_;
  std::atomic<bool> stop_{false};
};

}  // namespace ebac
