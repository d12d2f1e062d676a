#pragma once

#include <string_view>

#include "ebac/control/any_law.hpp"

namespace ebac {

/// A law whose gains may change while it runs: `retune(next)` takes the parameters of `next` and
/// keeps its memory.
template <class L>
concept Tunable = Controller<L> && requires(L law, const L& next) {
  { law.retune(next) } noexcept;
};

/// What of a law decides whether another one may take its place while it runs.
struct Tuning {
  std::string_view name;
  const FieldTable& table;
  const void* params;
  const Timing& timing;
};

/// Throws std::invalid_argument when `next` is no retuning of `now`, naming what may not change.
void check_tuning(const Tuning& now, const Tuning& next);

template <Tunable Law>
void check_retune(const Law& now, const Law& next) {
  const FieldTable& table = field_table<typename Law::Params>();
  check_tuning({Law::kName, table, &now.params(), now.timing()},
               {Law::kName, table, &next.params(), next.timing()});
}

/// Laws of different types are no retuning of each other.
void check_retune(const AnyLaw& now, const AnyLaw& next);

}  // namespace ebac
