#pragma once

#include <memory>
#include <type_traits>

#include "ebac/control/any_law.hpp"

/// Makes any law an `AnyLaw`. Compiled once for each law: see laws.cpp for those of the library.
namespace ebac {

template <Controller Law>
const LawType& law_type();

template <Controller Law>
class LawOf final : public LawObject {
 public:
  explicit LawOf(const Law& law) : LawObject(law_type<Law>()), law_(law) {
    const Law& view = law_;
    lies_at(&view.params(), &view.state(), &view.timing());
  }

  double step(const Port& port) EBAC_RT override { return law_.step(port); }
  void reset() EBAC_RT override { law_.reset(); }
  void retune(const LawObject& next) EBAC_RT override {
    if constexpr (kTunable) law_.retune(static_cast<const LawOf&>(next).law_);
  }
  void begin_account() EBAC_RT override {
    if constexpr (requires { law_.begin_account(); }) law_.begin_account();
  }
  void store(double part, double in_all) EBAC_RT override {
    if constexpr (requires { law_.store(part, in_all); }) law_.store(part, in_all);
  }
  double surplus() const EBAC_RT override {
    if constexpr (requires { law_.surplus(); }) return law_.surplus();
    return 0;
  }
  void settle(double surplus) EBAC_RT override {
    if constexpr (requires { law_.settle(surplus); }) law_.settle(surplus);
  }
  void shift(double change) EBAC_RT override {
    if constexpr (requires { law_.shift(change); }) law_.shift(change);
  }
  void scale(double by) EBAC_RT override {
    if constexpr (requires { law_.scale(by); }) law_.scale(by);
  }
  double starved() const EBAC_RT override { return starved_of(law_); }
  bool drained() const EBAC_RT override { return drained_of(law_); }
  bool observed() const EBAC_RT override { return observed_of(law_); }
  std::unique_ptr<LawObject> clone() const override { return std::make_unique<LawOf>(law_); }

  const Law& law() const { return law_; }

  static constexpr bool kTunable = requires(Law law, const Law& next) {
    { law.retune(next) } noexcept;
  };

 private:
  Law law_;
};

/// The record of a law.
template <Controller Law>
const LawType& law_type() {
  using Params = Law::Params;
  using State = Law::State;
  static_assert(std::is_trivially_copyable_v<Params> && std::is_trivially_copyable_v<State>,
                "parameters and state are numbers and switches");
  static const LawType kType{
      .name = Law::kName,
      .summary = Law::kSummary,
      .passive = Law::kPassive,
      .tunable = LawOf<Law>::kTunable,
      .params = field_table<Params>(),
      .state = field_table<State>(),
      .design =
          [](void* params, const DeviceFacts& facts, const Timing& timing) {
            *static_cast<Params*>(params) = Params::design(facts, timing);
          },
      .make =
          [](const void* params, const Timing& timing) {
            return AnyLaw(
                std::make_unique<LawOf<Law>>(Law(*static_cast<const Params*>(params), timing)));
          },
  };
  return kType;
}

/// The law itself, where it is of that type, or nullptr.
template <Controller Law>
const Law* law_cast(const AnyLaw& law) {
  if (&law.type() != &law_type<Law>()) return nullptr;
  return &static_cast<const LawOf<Law>&>(law.object()).law();
}

template <Controller Law>
AnyLaw any_law(const Law& law) {
  return AnyLaw(std::make_unique<LawOf<Law>>(law));
}

}  // namespace ebac
