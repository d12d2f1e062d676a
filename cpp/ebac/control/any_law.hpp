#pragma once

#include <concepts>
#include <memory>
#include <string_view>
#include <utility>

#include "ebac/control/fixed_params.hpp"
#include "ebac/core/controller.hpp"

/// A law whose type is known at run time only: one virtual call for each port and tick. What runs
/// laws is compiled once for all of them; who knows the type uses the law itself and pays nothing.
namespace ebac {

class AnyLaw;

/// What there is to know of a law: one record for each.
struct LawType {
  std::string_view name;
  std::string_view summary;
  bool passive = false;
  bool tunable = false;  // whether its gains may change while it runs
  FieldTable params;
  FieldTable state;
  void (*design)(void* params, const DeviceFacts& facts, const Timing& timing) = nullptr;
  AnyLaw (*make)(const void* params, const Timing& timing) = nullptr;  // may throw
};

/// A law behind its virtual functions. Where parameters, state and timing lie never changes.
class LawObject {
 public:
  explicit LawObject(const LawType& type) : type_(&type) {}
  LawObject(const LawObject&) = delete;
  LawObject& operator=(const LawObject&) = delete;
  LawObject(LawObject&&) = delete;
  LawObject& operator=(LawObject&&) = delete;
  virtual ~LawObject() = default;

  virtual double step(const Port& port) EBAC_RT = 0;
  virtual void reset() EBAC_RT = 0;
  /// The gains of `next`, a law of the same type.
  virtual void retune(const LawObject& next) EBAC_RT = 0;
  /// Its energy account, if it has one, gets what the contact it is in stores.
  virtual void begin_account() EBAC_RT {}
  virtual void store(double, double) EBAC_RT {}
  /// What its energy account, if it has one, holds beyond its reserve [J], and another such amount for it.
  virtual double surplus() const EBAC_RT { return 0; }
  virtual void settle(double) EBAC_RT {}
  /// The force of the last tick has changed by so much [N] without a motion: its direction has turned.
  virtual void shift(double) EBAC_RT {}
  /// The contact has become so many times as stiff, without a motion, and its force with it.
  virtual void scale(double) EBAC_RT {}
  /// How long its energy account has held its force back [s]; 0 for a law without one.
  virtual double starved() const EBAC_RT = 0;
  /// Whether its energy account is low with the observer.
  virtual bool drained() const EBAC_RT { return false; }
  /// Whether it uses the observer's estimate where a run has one.
  virtual bool observed() const EBAC_RT = 0;
  virtual std::unique_ptr<LawObject> clone() const = 0;

  const LawType& type() const EBAC_RT { return *type_; }
  const void* params() const EBAC_RT { return params_; }
  const void* state() const EBAC_RT { return state_; }
  const Timing& timing() const EBAC_RT { return *timing_; }

 protected:
  void lies_at(const void* params, const void* state, const Timing* timing) {
    params_ = params;
    state_ = state;
    timing_ = timing;
  }

 private:
  const LawType* type_;
  const void* params_ = nullptr;
  const void* state_ = nullptr;
  const Timing* timing_ = nullptr;
};

/// Any law for one port, as a value. Copying allocates; nothing else does.
class AnyLaw {
 public:
  using State = void;  // known by `state_table` only

  explicit AnyLaw(std::unique_ptr<LawObject> law) : law_(std::move(law)) {}
  AnyLaw(const AnyLaw& other) : law_(other.law_->clone()) {}
  AnyLaw& operator=(const AnyLaw& other) {
    if (this != &other) law_ = other.law_->clone();
    return *this;
  }
  AnyLaw(AnyLaw&&) noexcept = default;
  AnyLaw& operator=(AnyLaw&&) noexcept = default;
  ~AnyLaw() = default;

  double step(const Port& port) EBAC_RT { return law_->step(port); }
  void reset() EBAC_RT { law_->reset(); }
  void retune(const AnyLaw& next) EBAC_RT { law_->retune(*next.law_); }
  /// Whether `next` differs in its gains only and this one can take them, so that it keeps its memory.
  bool same_but_gains(const AnyLaw& next) const EBAC_RT {
    return type().tunable && &type() == &next.type() && timing() == next.timing() &&
           fixed_change(type().params, params(), next.params()) == nullptr;
  }

  void begin_account() EBAC_RT { law_->begin_account(); }
  void store(double part, double in_all) EBAC_RT { law_->store(part, in_all); }
  double surplus() const EBAC_RT { return law_->surplus(); }
  void settle(double surplus) EBAC_RT { law_->settle(surplus); }
  void shift(double change) EBAC_RT { law_->shift(change); }
  void scale(double by) EBAC_RT { law_->scale(by); }
  double starved() const EBAC_RT { return law_->starved(); }
  bool drained() const EBAC_RT { return law_->drained(); }
  bool observed() const EBAC_RT { return law_->observed(); }
  const LawType& type() const EBAC_RT { return law_->type(); }
  const void* params() const EBAC_RT { return law_->params(); }
  const void* state() const EBAC_RT { return law_->state(); }
  const FieldTable& state_table() const EBAC_RT { return law_->type().state; }
  const Timing& timing() const EBAC_RT { return law_->timing(); }
  const LawObject& object() const EBAC_RT { return *law_; }

 private:
  std::unique_ptr<LawObject> law_;
};

/// A law for one port, of a type known now or later.
template <class L>
concept ScalarLaw = Controller<L> || std::same_as<L, AnyLaw>;

}  // namespace ebac
