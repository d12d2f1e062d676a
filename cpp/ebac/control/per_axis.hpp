#pragma once

#include <algorithm>
#include <array>
#include <concepts>
#include <span>
#include <type_traits>
#include <utility>

#include "ebac/control/any_law.hpp"
#include "ebac/control/eased_frame.hpp"
#include "ebac/control/shared_account.hpp"
#include "ebac/control/take_over.hpp"
#include "ebac/control/turned_ports.hpp"
#include "ebac/core/controller.hpp"

namespace ebac {

/// A law for all ports of a device at once: writes `f_cmd` of every axis.
template <class L>
concept AxesController = requires(L law, std::span<Axis> axes, const ContactForce& contact) {
  typename L::State;
  { law.step(axes, contact) } noexcept;
  { law.reset() } noexcept;
};

/// What `ParameterUpdates` sends of a law whose type is known at run time only: one for each axis.
template <class Law>
struct Replaceable {};
template <>
struct Replaceable<AnyLaw> {
  using Replacement = std::array<AnyLaw, kMaxAxes>;
};

/// A scalar law on every direction the world acts in.
template <ScalarLaw Law>
class PerAxis : public Replaceable<Law> {
  struct Nothing {};

 public:
  using State = Law::State;
  using Scalar = Law;

  explicit PerAxis(const Law& law) : laws_{law, law, law} {
    static_assert(kMaxAxes == 3);
    reset();
  }

  template <std::size_t N>
  void step(std::span<Axis, N> axes, const ContactForce& contact) EBAC_RT {
    if constexpr (std::same_as<Law, AnyLaw>) {
      if (take_over_.on()) return step_taking_over(axes, contact);
    }
    step_laws(axes, contact);
    if constexpr (std::same_as<Law, AnyLaw>) take_over_.watch(axes);
  }
  void reset() EBAC_RT {
    for (Law& law : laws_) law.reset();
    turned_ = {};
    frame_ = {};
    account_ = {};
    take_over_ = {};
  }
  /// Takes the gains of `next`; the memory and the device parameters of the law stay.
  void retune(const Law& next) EBAC_RT
    requires requires(Law law) { law.retune(next); }
  {
    for (Law& law : laws_) law.retune(next);
  }
  /// Takes the gains of `next`, where it differs in nothing else; otherwise `next` takes over, without memory, from
  /// the force of the last tick. The laws that go are left in `next`: none is freed here.
  void adopt(std::array<Law, kMaxAxes>& next) EBAC_RT
    requires std::same_as<Law, AnyLaw>
  {
    if (laws_[0].same_but_gains(next[0])) return retune(next[0]);
    std::swap(laws_, next);
    account_ = {};  // of those that went
    take_over_.law();
  }
  /// Another world takes over; `before` and `now` are its forces at the place of the last tick.
  void meet_another(const Axes& before, const Axes& now) EBAC_RT
    requires std::same_as<Law, AnyLaw>
  {
    take_over_.world(before, now);
  }
  /// Of the force that is sent, `part` has come in with this tick, as at a soft start, and with it of what each contact
  /// stores; below zero where it went. `whole`: all is sent now.
  void come_in(double part, bool whole) EBAC_RT
    requires requires(Law law) { law.store(part, 0.0); }
  {
    for (Law& law : laws_) law.store(part, whole ? 1 : 0);
  }
  static std::array<Law, kMaxAxes> replacement(const Law& law)
    requires std::same_as<Law, AnyLaw>
  {
    return {law, law, law};
  }
  const Timing& timing() const EBAC_RT { return laws_[0].timing(); }
  /// Whether it is made for the observer's estimate.
  bool observed() const EBAC_RT { return observed_of(laws_[0]); }
  double starved() const EBAC_RT {
    double longest = 0;
    for (const Law& law : laws_) longest = std::max(longest, starved_of(law));
    return longest;
  }
  bool drained() const EBAC_RT { return std::ranges::any_of(laws_, drained_of<Law>); }
  decltype(auto) state(std::size_t i) const EBAC_RT { return laws_[i].state(); }
  /// Of a law whose type is known at run time only.
  const FieldTable& state_table() const EBAC_RT
    requires std::same_as<Law, AnyLaw>
  {
    return laws_[0].state_table();
  }

 private:
  template <std::size_t N>
  void step_laws(std::span<Axis, N> axes, const ContactForce& contact) EBAC_RT {
    const auto ask = [this](std::size_t i, const Port& port, double misplaced) EBAC_RT {
      Law& law = laws_[i];
      if constexpr (requires { law.settle(law.surplus()); }) {
        if (misplaced != 0) law.settle(law.surplus() + misplaced);
      }
      return law.step(port);
    };
    const int delay = laws_[0].timing().delay;
    if (N == 1 || axes.size() == 1) {
      turned_.step(axes, contact, delay, ask);
    } else if (contact.shared) {
      const ContactForce eased = frame_.ease(contact, axes[0].port.dt);
      account_.share(laws_, axes.size(), eased);
      if constexpr (requires(double change) { laws_[0].shift(change); }) {
        for (std::size_t i = 0; i < axes.size(); ++i)
          laws_[i].shift(frame_.turned()[static_cast<Eigen::Index>(i)]);
      }
      turned_.step(axes, eased, delay, ask);
    } else {
      if (frame_.turns(contact)) account_.share(laws_, axes.size(), contact);
      turned_.step(axes, frame_.follow(contact), delay, ask);
    }
  }

  /// What a contact stores by a change from outside has come from nobody's hand. Nor did a motion make it stiffer.
  [[gnu::noinline]] void step_taking_over(std::span<Axis> axes, const ContactForce& contact) EBAC_RT
    requires std::same_as<Law, AnyLaw>
  {
    const ContactForce shown = take_over_.shown(contact, axes);
    for (Law& law : laws_) law.scale(take_over_.scaled());
    show(axes, shown);
    step_laws(axes, shown);
    show(axes, contact);
    take_over_.pass(axes);
    take_over_.watch(axes);
    for (Law& law : laws_) {
      if (take_over_.another_law())
        law.begin_account();
      else
        law.store(take_over_.came(), take_over_.in_all());
    }
  }
  static void show(std::span<Axis> axes, const ContactForce& contact) EBAC_RT {
    for (std::size_t i = 0; i < axes.size(); ++i)
      axes[i].port.f_env = contact.force[static_cast<Eigen::Index>(i)];
  }

  std::array<Law, kMaxAxes> laws_;
  TurnedPorts turned_{};
  EasedFrame frame_{};
  SharedAccount account_{};
  [[no_unique_address]] std::conditional_t<std::same_as<Law, AnyLaw>, TakeOver, Nothing>
      take_over_{};
};

}  // namespace ebac
